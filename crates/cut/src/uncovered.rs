//! Finds lengths of the seam line that got no cut line of their own, and slits that are shut.

use crate::allowance::Cloth;
use crate::corner::STRAIGHT;
use crate::ring::{FLATNESS, Ring};
use crate::trace::{Sides, Traced};
use crate::{CutRing, Finding};
use toile_geometry::{Bounds2, EdgeTree, Location, Polygon, Vec2};

/// Shortest span that is reported (m): flattening makes shorter ones at bends of tight curves.
const SHORTEST: f64 = 1e-4;
/// Shortest gap between spans that is not mere rounding (m).
const ROUNDING: f64 = 1e-7;
/// Depth from which swallowed spans count as a slit that is shut, over the widest allowance beside it (1).
/// This is the depth to which equal allowances close an inner corner of 60 degrees.
const SLIT_DEPTH: f64 = 2.0;

/// A span of one edge that has no cut line of its own.
#[derive(Clone, Copy, Debug)]
struct Gap {
    edge: usize,
    /// Start along the edge in the ring's direction (m).
    from: f64,
    to: f64,
    /// Whether other cloth lies where the span's cut line would be. If not, the allowance is narrower than
    /// asked.
    swallowed: bool,
    /// Least width of the allowance on the span (m).
    least: f64,
}

/// Findings about lengths of a ring that `covered` leaves without a cut line; `cut` are the rings of the cut
/// line.
pub(crate) fn uncovered_findings(
    ring: &Ring,
    cloth: &Cloth,
    covered: &[Vec<[f64; 2]>],
    cut: &[CutRing],
) -> Vec<Finding> {
    let piece = Piece::new(ring, cut);
    let mut gaps: Vec<Gap> = Vec::new();
    for (k, chord) in ring.chords.iter().enumerate() {
        if cloth.is_leg[chord.edge] {
            continue;
        }
        for [from, to] in uncovered(&covered[k], chord.length) {
            for part in piece.divided(k, [from, to]).windows(2) {
                add(&mut gaps, piece.gap(k, [part[0], part[1]]));
            }
        }
    }
    gaps.retain(|gap| gap.to - gap.from > SHORTEST);
    let mut findings: Vec<Finding> = gaps.iter().map(|gap| finding(ring, cloth, gap)).collect();
    findings.extend(slits(&piece, &gaps));
    findings
}

/// Adds a span to `gaps`, or extends the last span there if `gap` continues it.
fn add(gaps: &mut Vec<Gap>, gap: Gap) {
    match gaps.last_mut() {
        Some(last)
            if last.edge == gap.edge
                && last.swallowed == gap.swallowed
                && gap.from - last.to < 10.0 * ROUNDING =>
        {
            last.to = gap.to;
            last.least = last.least.min(gap.least);
        }
        _ => gaps.push(gap),
    }
}

/// For each chord, the shares of its length that have a cut line of their own, sorted.
pub(crate) fn covered(ring: &Ring, sides: &Sides, traced: &[Traced]) -> Vec<Vec<[f64; 2]>> {
    let mut covered = vec![Vec::new(); ring.chords.len()];
    for traced in traced {
        for (&side, span) in traced.sides.iter().zip(&traced.spans) {
            if let Some((chord, [from, to])) = sides.tag(side).beside {
                covered[chord].push(span.map(|share| from + (to - from) * share));
            }
        }
    }
    for spans in &mut covered {
        spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    covered
}

/// The spans of a chord (m) that lie outside all `covered` shares, which are sorted.
fn uncovered(covered: &[[f64; 2]], length: f64) -> Vec<[f64; 2]> {
    let mut left = Vec::new();
    let mut at = 0.0;
    for &[from, to] in covered.iter().chain([&[1.0, 1.0]]) {
        if (from - at) * length > ROUNDING {
            left.push([at * length, from * length]);
        }
        at = f64::max(at, to);
    }
    left
}

fn finding(ring: &Ring, cloth: &Cloth, gap: &Gap) -> Finding {
    let edge = ring.index(gap.edge);
    let mut span = [gap.from, gap.to].map(|at| ring.given_place(gap.edge, at));
    if ring.reversed {
        span.reverse();
    }
    if !gap.swallowed {
        let least = gap.least;
        return Finding::Narrow { edge, span, least };
    }
    let overlaps = |edge: usize, leg: usize| is_inner(ring, edge) || cloth.is_leg[leg];
    let (before, after) = (ring.before(gap.edge), ring.after(gap.edge));
    let starts = gap.from < SHORTEST && overlaps(gap.edge, before);
    let length = ring.edges[gap.edge].length;
    let ends = gap.to > length - SHORTEST && overlaps(after, after);
    Finding::Swallowed {
        edge,
        span,
        inner_corner: starts || ends,
    }
}

/// Whether the ring turns away from the cloth at an edge's start.
fn is_inner(ring: &Ring, edge: usize) -> bool {
    let before = ring.edges[ring.before(edge)].ends[1];
    before.perp(&ring.edges[edge].ends[0]) < -STRAIGHT
}

/// The seam line of a ring and the cut line made for it.
struct Piece<'a> {
    ring: &'a Ring,
    /// Segments of the cut line.
    cut: EdgeTree,
}

impl<'a> Piece<'a> {
    fn new(ring: &'a Ring, cut: &[CutRing]) -> Self {
        let mut points = cut.iter().map(|ring| ring.points.clone());
        // Cloth lies all round a hole: for holes, the inside and outside of this polygon are swapped.
        let cut = Polygon {
            outer: points.next().unwrap_or_default(),
            holes: points.collect(),
        };
        Self {
            ring,
            cut: EdgeTree::of(&cut),
        }
    }

    fn is_cloth(&self, p: Vec2) -> bool {
        (self.cut.locate(p) != Location::Outside) == (self.ring.number == 0)
    }

    /// Calls `visit` for the segments of the cut line whose boxes meet the box of a segment.
    fn meeting(&self, [from, to]: [Vec2; 2], visit: &mut dyn FnMut([Vec2; 2])) {
        let near = Bounds2::of([from, to]).grown(ROUNDING);
        let edges = self.cut.edges();
        self.cut
            .visit(&mut |bounds| bounds.meets(&near), &mut |k| visit(edges[k]));
    }

    /// Width of the cloth beside a point of the seam line, measured along `normal`, at most `most` (m).
    fn width(&self, p: Vec2, normal: Vec2, most: f64) -> f64 {
        let mut width = most;
        self.meeting([p - normal * SHORTEST, p + normal * most], &mut |[a, b]| {
            let (from, to) = (normal.perp(&(a - p)), normal.perp(&(b - p)));
            let crosses = (from <= 0.0) != (to <= 0.0);
            let along = (a + (b - a) * (from / (from - to)) - p).dot(&normal);
            if crosses && along > -SHORTEST {
                width = width.min(along.max(0.0));
            }
        });
        width
    }

    /// Ends and dividing points of a span of a chord (m). The span is divided where the chord's line, moved
    /// outwards by the allowance, crosses the cut line.
    fn divided(&self, k: usize, [from, to]: [f64; 2]) -> Vec<f64> {
        let chord = &self.ring.chords[k];
        let width = self.ring.edges[chord.edge].width;
        let start = chord.from + chord.normal * width;
        let along = chord.along();
        let mut parts = vec![from, to];
        let moved = [start + along * from, start + along * to];
        self.meeting(moved, &mut |[a, b]| {
            let (p, q) = (along.perp(&(a - start)), along.perp(&(b - start)));
            let at = (a + (b - a) * (p / (p - q)) - start).dot(&along);
            if (p <= 0.0) != (q <= 0.0) && at > from && at < to {
                parts.push(at);
            }
        });
        parts.sort_by(f64::total_cmp);
        parts
    }

    fn gap(&self, k: usize, span: [f64; 2]) -> Gap {
        let chord = &self.ring.chords[k];
        let width = self.ring.edges[chord.edge].width;
        let at = |t: f64| chord.from + chord.along() * t;
        let own = at(0.5 * (span[0] + span[1])) + chord.normal * width;
        // Beyond the centre of a tight curve, the offset point may lie on the cut line by chance.
        let is_beside = || self.cut.distance_below(own, 2.0 * FLATNESS) < 2.0 * FLATNESS;
        let swallowed = self.is_cloth(own) || is_beside();
        let least = match swallowed {
            true => width,
            false => span
                .iter()
                .fold(width, |least, &t| self.width(at(t), chord.normal, least)),
        };
        Gap {
            edge: chord.edge,
            from: chord.at + span[0],
            to: chord.at + span[1],
            swallowed,
            least,
        }
    }

    /// Point of an edge at the distance `at` from the edge's start (m).
    fn point(&self, edge: usize, at: f64) -> Vec2 {
        let chords = &self.ring.chords[self.ring.edges[edge].chords.clone()];
        let k = chords.partition_point(|chord| chord.at <= at).max(1) - 1;
        chords[k].from + chords[k].along() * (at - chords[k].at).min(chords[k].length)
    }

    /// Distance of a point from the cut line (m).
    fn depth(&self, p: Vec2) -> f64 {
        self.cut.point_distance(p)
    }
}

/// Findings on slits that are shut: runs of swallowed spans that reach far from the cut line. A run can go on
/// round corners.
fn slits(piece: &Piece, gaps: &[Gap]) -> Vec<Finding> {
    let ring = piece.ring;
    let swallowed: Vec<&Gap> = gaps.iter().filter(|gap| gap.swallowed).collect();
    let follows = |a: &Gap, b: &Gap| {
        let at_end = a.to > ring.edges[a.edge].length - SHORTEST;
        (a.edge == b.edge && (b.from - a.to).abs() < SHORTEST)
            || (ring.after(a.edge) == b.edge && at_end && b.from < SHORTEST)
    };
    let count = swallowed.len();
    let Some(first) =
        (0..count).find(|&k| !follows(swallowed[(k + count - 1) % count], swallowed[k]))
    else {
        return Vec::new();
    };
    let mut runs: Vec<Vec<&Gap>> = Vec::new();
    for k in 0..count {
        let gap = swallowed[(first + k) % count];
        match runs.last_mut() {
            Some(run) if run.last().is_some_and(|last| follows(last, gap)) => run.push(gap),
            _ => runs.push(vec![gap]),
        }
    }
    runs.iter().filter_map(|run| slit(piece, run)).collect()
}

fn slit(piece: &Piece, run: &[&Gap]) -> Option<Finding> {
    let ring = piece.ring;
    let (first, last) = (run.first()?, run.last()?);
    // The edges before and after the run count too: their allowances may cover it.
    let beside = [ring.before(first.edge), ring.after(last.edge)];
    let edges = run.iter().map(|gap| gap.edge).chain(beside);
    let widest = edges.map(|k| ring.edges[k].width).fold(0.0, f64::max);
    let inside = |gap: &Gap, chord: &crate::ring::Chord| {
        chord.edge == gap.edge && chord.at >= gap.from - SHORTEST && chord.at <= gap.to
    };
    let corners = run.iter().flat_map(|gap| {
        let chords = &ring.chords[ring.edges[gap.edge].chords.clone()];
        chords
            .iter()
            .filter(|chord| inside(gap, chord))
            .map(|chord| chord.from)
    });
    let depth = corners.map(|p| piece.depth(p)).fold(0.0, f64::max);
    let mouth = [
        piece.point(first.edge, first.from),
        piece.point(last.edge, last.to),
    ];
    let mut edges = [ring.index(first.edge), ring.index(last.edge)];
    if ring.reversed {
        edges.reverse();
    }
    (depth > SLIT_DEPTH * widest).then(|| Finding::SlitShut {
        edges,
        mouth: (mouth[0] + mouth[1]) * 0.5,
        depth,
        length: run.iter().map(|gap| gap.to - gap.from).sum(),
    })
}
