//! Directions of the curves of a sew line at its corners, by the corners of the cut line.
//!
//! A sew line of few vertices hardly tells in which direction a curve ends, and the corner of the cut line that is made
//! of it is off by millimetres. The cut line as drawn tells it: where two edges meet, its corner `V` (the edge's own
//! one of two, where the corner is cut off) lies at the width of the allowance from the tangent of each, so that the
//! tangent at the corner `S` of the sew line makes the angle `asin(width / |V - S|)` with `V - S`.

use super::corners::is_kink;
use super::curved::Curved;
use super::cut_fit::{CutFit, TRY_OTHERS, cut_fit, edges_of, ring_of};
use super::piece::{DrawnLine, DrawnPiece};
use super::spline::Tangents;
use toile_geometry::{Curve, Vec2};
use toile_pattern::{Corner, EdgeCorner, MitreLimit};

/// Largest angle by which a tangent is turned besides the turn between the last two chords of its curve, which is as much
/// as few vertices leave open (rad): coordinates are rounded.
const MAX_TURN: f64 = 2.0 / 180.0 * std::f64::consts::PI;
/// Most ways to read a corner of the cut line that are tried (1).
const MAX_TRIES: usize = 3;
/// Share of the error of a corner that may be left where a turn of its tangents is kept (1).
const BETTER: f64 = 0.7;
/// Added to the turn by which readings are put in order, for each vertex of the cut line at which it does not kink (rad).
const NO_KINK: f64 = 0.5;
/// Share by which a vertex of the cut line may be nearer to a corner than the allowance is wide, as it is rounded (1).
const ROUNDED: f64 = 0.01;

/// The cut line of a piece as drawn.
pub(crate) struct DrawnCut<'a> {
    /// Its vertices in all sizes, where the file has them.
    outline: Option<&'a DrawnLine>,
    /// Its vertices in the base size (m).
    vertices: &'a [Vec2],
    /// Points that lie dense on it, as it curves between its vertices.
    dense: Vec<Vec2>,
    base: usize,
    sizes: usize,
}

/// How a corner of the cut line is read.
struct Turned {
    /// In each size the tangent of the edge before the corner and that of the edge after it, where they are known.
    tangents: Vec<Tangents>,
    /// Shape of the corner of the cut line.
    corner: EdgeCorner,
    /// Sum of the turns in the base size (rad).
    turn: f64,
}

impl<'a> DrawnCut<'a> {
    /// The cut line of a piece of some number of sizes; `None` if it has none.
    pub fn of(piece: &'a DrawnPiece, base: usize, sizes: usize) -> Option<Self> {
        let vertices = piece.cut_line.as_deref()?;
        let outline = piece.cut_outline.as_ref();
        let dense = outline.map(|cut| {
            let curved = Curved::new(cut, None, sizes);
            ring_of(&edges_of(cut, (&curved.corners, &curved.curves), base))
        });
        Some(Self {
            outline,
            vertices,
            dense: dense.unwrap_or_else(|| vertices.to_vec()),
            base,
            sizes,
        })
    }

    /// Allowances and corners by which it follows from an outline.
    pub fn fit(&self, outline: &DrawnLine, curved: &Curved) -> CutFit {
        let edges = edges_of(outline, (&curved.corners, &curved.curves), self.base);
        cut_fit(&edges, (self.vertices, &self.dense))
    }

    /// Whether a size has a cut line of its own, and not that of the base size because its own has other vertices.
    fn has_own(&self, outline: &DrawnLine, size: usize) -> bool {
        let is_base = |line: &DrawnLine| line.in_size(size) == line.in_size(self.base);
        self.in_size(size) != self.in_size(self.base) || is_base(outline)
    }

    /// Its vertices in a size.
    fn in_size(&self, size: usize) -> &[Vec2] {
        self.outline.map_or(self.vertices, |cut| cut.in_size(size))
    }

    /// Whether it kinks at a vertex.
    fn is_kink(&self, vertex: usize) -> bool {
        self.outline
            .is_none_or(|cut| is_kink(cut, self.base, vertex))
    }

    /// Ways to read the cut line near a corner, those that turn the tangents least first.
    fn turns(&self, ends: &CornerEnds, reach: f64) -> Vec<Turned> {
        let vertices = self.in_size(self.base);
        let count = vertices.len();
        let at = ends.places[self.base];
        let near: Vec<usize> = (0..count)
            .filter(|&k| (vertices[k] - at).norm() <= reach)
            .collect();
        // Both edges end in one corner of the cut line, or it is cut off between two.
        let pairs = near.iter().flat_map(|&k| {
            let next = (k + 1) % count;
            [[k, k], [k, next], [next, k]]
        });
        let mut turns: Vec<Turned> = pairs.filter_map(|pair| self.turned(ends, pair)).collect();
        turns.sort_by(|a, b| a.turn.total_cmp(&b.turn));
        turns.truncate(MAX_TRIES);
        turns
    }

    /// The tangents of both edges at a corner, by a vertex of the cut line each.
    fn turned(&self, ends: &CornerEnds, vertices: [usize; 2]) -> Option<Turned> {
        let mut turned = Turned {
            tangents: vec![Tangents::default(); self.sizes],
            corner: EdgeCorner::default(),
            turn: 0.0,
        };
        let at = ends.places[self.base];
        let mitre = (self.in_size(self.base)[vertices[0]] - at).norm();
        if vertices[0] != vertices[1] {
            turned.corner.kind = Corner::Bevel;
        } else if mitre > MitreLimit::USUAL * ends.widths[0].max(ends.widths[1]) {
            turned.corner.limit = MitreLimit::None;
        }
        for size in (0..self.sizes).filter(|&size| ends.has_cut[size]) {
            for (side, &vertex) in vertices.iter().enumerate() {
                let own = ends.tangents[size][side];
                let to = *self.in_size(size).get(vertex)? - ends.places[size];
                let tangent = tangent(own, to, ends.widths[side])?;
                let turn = own.perp(&tangent).atan2(own.dot(&tangent)).abs();
                if turn > ends.turns[side] + MAX_TURN {
                    return None;
                }
                if size == self.base {
                    turned.turn += turn;
                    if !self.is_kink(vertex) {
                        turned.turn += NO_KINK;
                    }
                }
                // A straight edge has the direction that it has.
                turned.tangents[size][side] = ends.is_curve[side].then_some(tangent);
            }
        }
        Some(turned)
    }
}

/// The ends of both edges that meet at a corner of the sew line.
struct CornerEnds {
    /// The corner in each size (m).
    places: Vec<Vec2>,
    /// Directions in each size, of length 1.
    tangents: Vec<[Vec2; 2]>,
    is_curve: [bool; 2],
    /// Whether each size has a cut line of its own.
    has_cut: Vec<bool>,
    /// Turns between the last two chords in the base size (rad).
    turns: [f64; 2],
    /// Widths of the allowances (m).
    widths: [f64; 2],
}

impl CornerEnds {
    /// The ends at a corner; `lines` are the curves of all edges in each size. `None` where one has no direction.
    fn of(
        (curved, fit): (&Curved, &CutFit),
        (lines, base): (&[Vec<Vec<Curve>>], usize),
        (corner, has_cut): (usize, &[bool]),
    ) -> Option<Self> {
        let count = curved.corners.len();
        let edges = [(corner + count - 1) % count, corner];
        let base = lines.get(base)?;
        let chord = |curve: &Curve| curve.end() - curve.start();
        let turn = |last: &Curve, other: Option<&Curve>| {
            let [last, other] = [chord(last), other.map_or(chord(last), chord)];
            last.perp(&other).atan2(last.dot(&other)).abs()
        };
        let [before, after] = edges.map(|edge| &base[edge]);
        let turns = [
            turn(before.last()?, before.iter().nth_back(1)),
            turn(after.first()?, after.get(1)),
        ];
        let tangents = lines.iter().map(|lines| {
            let [before, after] = [lines[edges[0]].last()?, lines[edges[1]].first()?];
            let along = [before.derivative(1.0), after.derivative(0.0)];
            let [before, after] = along.map(|along| along.try_normalize(0.0));
            Some([before?, after?])
        });
        Some(Self {
            places: lines.iter().map(|lines| lines[corner][0].start()).collect(),
            tangents: tangents.collect::<Option<_>>()?,
            turns,
            is_curve: edges.map(|edge| curved.is_spline(edge)),
            has_cut: has_cut.to_vec(),
            widths: edges.map(|edge| fit.widths[edge]),
        })
    }
}

/// The direction nearest to `own` that has a vertex of the cut line, seen from the corner of the sew line, at a width to
/// its right; both lines run counter-clockwise.
fn tangent(own: Vec2, to_vertex: Vec2, width: f64) -> Option<Vec2> {
    let away = to_vertex.norm();
    if away <= 0.0 || width > away * (1.0 + ROUNDED) {
        return None;
    }
    let sine = (width / away).min(1.0);
    let cosine = (1.0 - sine * sine).sqrt();
    let [along, left] = [to_vertex, Vec2::new(-to_vertex.y, to_vertex.x)].map(|v| v / away);
    let [a, b] = [cosine, -cosine].map(|cosine| along * cosine + left * sine);
    Some(if a.dot(&own) >= b.dot(&own) { a } else { b })
}

/// Turns the tangents of curves at those corners at which the cut line that follows is nearer to the one as drawn then.
pub(crate) fn turn_ends(
    outline: &DrawnLine,
    cut: &DrawnCut<'_>,
    (curved, fit): (&mut Curved, &mut CutFit),
) {
    if fit.is_mostly_uneven() {
        return;
    }
    let count = curved.corners.len();
    let mut offs = fit.vertex_offs.clone();
    let wrong: Vec<usize> = (0..offs.len())
        .filter(|&corner| offs[corner] > TRY_OTHERS)
        .collect();
    let in_size = |size| edges_of(outline, (&curved.corners, &curved.curves), size);
    let lines: Vec<Vec<Vec<Curve>>> = (0..cut.sizes).map(in_size).collect();
    let has_cut: Vec<bool> = (0..cut.sizes)
        .map(|size| cut.has_own(outline, size))
        .collect();
    let turns: Vec<Vec<Turned>> = wrong
        .iter()
        .map(|&corner| {
            let ends = CornerEnds::of((curved, fit), (&lines, cut.base), (corner, &has_cut));
            let ends = ends.filter(|ends| ends.is_curve.contains(&true));
            ends.map_or_else(Vec::new, |ends| cut.turns(&ends, fit.reach(corner)))
        })
        .collect();
    let mut known = vec![vec![Tangents::default(); cut.sizes]; count];
    let set = |ends: &mut [Vec<Tangents>], corner: usize, turned: &Turned| {
        for (size, tangents) in turned.tangents.iter().enumerate() {
            ends[(corner + count - 1) % count][size][1] = tangents[0];
            ends[corner][size][0] = tangents[1];
        }
    };
    let mut corners = fit.corners.clone();
    let with = |ends: &[Vec<Tangents>], corners: Vec<EdgeCorner>| {
        let curved = curved.with_tangents(outline, ends);
        let edges = edges_of(outline, (&curved.corners, &curved.curves), cut.base);
        let fit = CutFit {
            corners,
            ..fit.clone()
        };
        let fit = fit.again(&edges, (cut.vertices, &cut.dense));
        (curved, fit)
    };
    let mut is_better = false;
    for rank in 0..MAX_TRIES {
        let tried: Vec<(usize, &Turned)> = wrong
            .iter()
            .zip(&turns)
            .filter_map(|(&corner, turns)| Some((corner, turns.get(rank)?)))
            .collect();
        if tried.is_empty() {
            break;
        }
        let (mut ends, mut shapes) = (known.clone(), corners.clone());
        for (corner, turned) in &tried {
            set(&mut ends, *corner, turned);
            shapes[*corner] = turned.corner;
        }
        let (_, found) = with(&ends, shapes);
        for (corner, turned) in tried {
            let off = found.vertex_offs[corner];
            if off < BETTER * offs[corner] {
                offs[corner] = off;
                set(&mut known, corner, turned);
                corners[corner] = turned.corner;
                is_better = true;
            }
        }
    }
    if is_better {
        let (turned, found) = with(&known, corners);
        if turned.chords() <= curved.chords() {
            (*curved, *fit) = (turned, found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A half disc of radius 0.2 m by few vertices in two sizes, and its cut line with 0.01 m around it: the arc by the
    /// same vertices, its corners where the offset circle meets the offset straight side.
    fn half_disc(steps: usize) -> (DrawnLine, DrawnPiece) {
        let at = |radius: f64, k: usize| {
            let turn = std::f64::consts::PI * k as f64 / steps as f64;
            Vec2::new(turn.cos(), turn.sin()) * radius
        };
        let sew = |radius: f64| (0..=steps).map(|k| at(radius, k)).collect();
        let cut = |radius: f64| -> Vec<Vec2> {
            // The tangents at both ends of the arc are square to the straight side.
            let corner = |side: f64| Vec2::new(side * (radius + 0.01), -0.01);
            let inner = (1..steps).map(|k| at(radius + 0.01, k));
            std::iter::once(corner(1.0))
                .chain(inner)
                .chain([corner(-1.0)])
                .collect()
        };
        let line = |by_size: Vec<Vec<Vec2>>| DrawnLine {
            by_size,
            is_closed: true,
            ..DrawnLine::default()
        };
        let piece = DrawnPiece {
            cut_line: Some(cut(0.2)),
            cut_outline: Some(line(vec![cut(0.2), cut(0.25)])),
            ..DrawnPiece::default()
        };
        (line(vec![sew(0.2), sew(0.25)]), piece)
    }

    #[test]
    fn tangents_at_corners_are_those_that_the_cut_line_tells() {
        let (mut outline, piece) = half_disc(7);
        outline.is_corner = (0..=7).map(|k| k == 0 || k == 7).collect();
        let cut = DrawnCut::of(&piece, 0, 2).unwrap();
        let mut curved = Curved::new(&outline, None, 2);
        let mut fit = cut.fit(&outline, &curved);
        let before = fit.vertex_offs[0];
        turn_ends(&outline, &cut, (&mut curved, &mut fit));
        for size in 0..2 {
            let arc = &edges_of(&outline, (&curved.corners, &curved.curves), size)[0];
            let first = arc[0].derivative(0.0).normalize();
            let last = arc[arc.len() - 1].derivative(1.0).normalize();
            assert!(first.x.abs() < 1e-6, "{first}");
            assert!(last.x.abs() < 1e-6, "{last}");
        }
        assert!(before > TRY_OTHERS, "{before}");
        assert!(fit.vertex_offs[0] < 1e-9, "{:?}", fit.vertex_offs);
        assert_eq!(fit.widths, [0.01, 0.01]);
    }

    #[test]
    fn a_size_without_a_cut_line_of_its_own_keeps_its_tangents() {
        let (mut outline, mut piece) = half_disc(7);
        outline.is_corner = (0..=7).map(|k| k == 0 || k == 7).collect();
        // The other size differs by little, so that the tangents that the base size's cut line tells are no great turns.
        outline.by_size[1] = outline.by_size[0].iter().map(|p| p * 1.01).collect();
        let cut = piece.cut_outline.as_mut().unwrap();
        cut.by_size[1] = cut.by_size[0].clone();
        let cut = DrawnCut::of(&piece, 0, 2).unwrap();
        let mut curved = Curved::new(&outline, None, 2);
        let mut fit = cut.fit(&outline, &curved);
        let in_size =
            |curved: &Curved, size| edges_of(&outline, (&curved.corners, &curved.curves), size);
        let before = [0, 1].map(|size| in_size(&curved, size));
        turn_ends(&outline, &cut, (&mut curved, &mut fit));
        let after = [0, 1].map(|size| in_size(&curved, size));
        assert_ne!(before[0], after[0]);
        assert_eq!(before[1], after[1]);
    }

    #[test]
    fn a_vertex_nearer_than_the_allowance_tells_no_direction() {
        let own = Vec2::new(1.0, 0.0);
        assert_eq!(tangent(own, Vec2::new(0.0, -0.005), 0.01), None);
        assert_eq!(tangent(own, Vec2::zeros(), 0.0), None);
        let square = tangent(own, Vec2::new(0.0, -0.01), 0.01).unwrap();
        assert!((square - own).norm() < 1e-9);
        let mitre = tangent(own, Vec2::new(0.01, -0.01), 0.01).unwrap();
        assert!((mitre - own).norm() < 1e-9);
    }
}
