//! Edges of pieces as they are sewn: lengths, shapes with darts closed, angles at both ends.

use crate::plan::seam::SewnEdge;
use crate::{Draft, EdgeOrigin, Evaluation, Name, PartId, Piece, PieceEdge};
use std::f64::consts::{FRAC_PI_2, PI};
use toile_geometry::Vec2;

/// Chords of equal length by which the shape of an edge is compared.
pub(super) const CHORDS: usize = 32;
/// Greatest distance of a curve from the chords that stand for it (m).
const FLAT: f64 = 1e-4;
/// Edges shorter than this are not sewn (m).
const MIN_LENGTH: f64 = 5e-4;
/// Part of a piece's height at its bottom within which an edge counts as the bottom edge (1).
const BOTTOM: f64 = 0.1;
/// Least cosine of the angle between a bottom edge and the direction across the grain (1).
const LEVEL: f64 = 0.8;

/// One edge of a piece, from corner to corner. Its geometry is as seen from the right side of the cloth, so
/// that the cloth lies left of the edge.
#[derive(Clone, Debug)]
pub(super) struct SeamEdge {
    /// Index of the piece in the draft.
    pub piece: usize,
    /// The edge of the document. `None`: an operation made the edge, or the edge is too short, and it cannot
    /// be sewn by name.
    pub sewn: Option<SewnEdge>,
    /// Name of the edge; empty if an operation made it.
    pub name: String,
    /// Length without the mouths of darts (m).
    pub length: f64,
    /// Points at equal arc lengths in the frame of the chord, with the length of the edge as unit (1).
    pub shape: Vec<Vec2>,
    /// Angles of the cloth at the start and the end of the edge (rad).
    pub angles: [f64; 2],
    /// Angle by which the edge turns from its start to its end (rad): above 0 it bulges outwards.
    pub turning: f64,
    /// Direction of the chord (rad), counter-clockwise from the direction across the grain to the right.
    pub direction: f64,
    /// Place across the grain: -1 at the left border of the piece, 1 at its right border (1).
    pub across: f64,
    /// Whether the edge is the lower border of its piece, as hems are.
    pub is_bottom: bool,
    /// Width of the seam allowance (m).
    pub allowance: f64,
    /// Places of notches, as shares of the length from the start (1).
    pub notches: Vec<f64>,
    /// Start, middle and end of the edge in the plane of the piece, with its darts open (m).
    pub laid: [Vec2; 3],
    /// Index of the edge that follows round the piece.
    pub next: usize,
    /// Index of the edge before.
    pub previous: usize,
}

/// All edges of the pieces of a draft.
#[derive(Clone, Debug, Default)]
pub(super) struct SeamEdges {
    /// The edges, piece by piece, each ring in its order.
    pub all: Vec<SeamEdge>,
    /// For each piece and each of its own edges, the index of the edge here; `None` for legs of darts.
    places: Vec<Vec<Option<usize>>>,
}

impl SeamEdges {
    /// The edges of a draft.
    pub fn new(evaluation: &Evaluation, draft: &Draft) -> Self {
        let mut edges = Self::default();
        for (index, piece) in draft.pieces.iter().enumerate() {
            let frame = Frame::new(piece);
            edges.places.push(Vec::new());
            let first = edges.all.len();
            for ring in rings(piece) {
                edges.add_ring(evaluation, (index, piece), &frame, ring);
            }
            frame.find_bottom(&mut edges.all[first..]);
        }
        edges
    }

    /// Number of edges that a draft has.
    pub fn count(draft: &Draft) -> usize {
        let rings = draft.pieces.iter().flat_map(rings);
        rings.map(|ring| groups(ring).len()).sum()
    }

    /// Index of the edge that an edge of a piece belongs to.
    pub fn place(&self, piece: usize, edge: usize) -> Option<usize> {
        *self.places.get(piece)?.get(edge)?
    }

    fn add_ring(
        &mut self,
        evaluation: &Evaluation,
        (index, piece): (usize, &Piece),
        frame: &Frame,
        ring: &[PieceEdge],
    ) {
        let first = self.all.len();
        let parts: Vec<SeenCurve> = ring.iter().map(|edge| frame.part(edge)).collect();
        let groups = groups(ring);
        let mut places = vec![None; ring.len()];
        for (k, group) in groups.iter().enumerate() {
            for &part in group {
                places[part] = Some(first + k);
            }
        }
        self.places[index].extend(places);
        let count = groups.len();
        for (k, group) in groups.iter().enumerate() {
            let (head, tail) = (group[0], group[group.len() - 1]);
            let before = &groups[(k + count - 1) % count];
            let after = groups[(k + 1) % count][0];
            let corner = |from: usize, to: usize| {
                let turn = parts[to].directions[0] + closing(&parts, ring, from, to)
                    - parts[from].directions[1];
                PI - wrapped(turn)
            };
            let line = joined(&parts, ring, group);
            let length: f64 = group.iter().map(|&part| parts[part].length).sum();
            let origin = ring[head].origin;
            let (sewn, name) = named(evaluation, piece, origin);
            let chord = line[CHORDS] - line[0];
            let open: Vec<Vec2> = group
                .iter()
                .flat_map(|&k| &parts[k].line)
                .copied()
                .collect();
            let middle = resampled(&open)[CHORDS / 2];
            self.all.push(SeamEdge {
                piece: index,
                sewn: sewn.filter(|_| length >= MIN_LENGTH),
                name,
                length,
                angles: [corner(before[before.len() - 1], head), corner(tail, after)],
                turning: turning(&line),
                direction: wrapped(angle(chord) - frame.grain + FRAC_PI_2),
                across: frame.across(middle),
                is_bottom: false,
                allowance: ring[head].seam_allowance,
                notches: notches(piece, origin, group, &parts, frame),
                laid: [
                    frame.seen(parts[head].line[0]),
                    frame.seen(middle),
                    frame.seen(parts[tail].last()),
                ],
                next: first + (k + 1) % count,
                previous: first + (k + count - 1) % count,
                shape: shape(&line, length),
            });
        }
    }
}

/// The view of a piece from the right side of its cloth.
struct Frame {
    /// Whether the piece is drawn from its wrong side.
    is_turned: bool,
    /// Direction of the grain (rad).
    grain: f64,
    /// Least and greatest coordinates across and along the grain (m).
    bounds: [[f64; 2]; 2],
}

impl Frame {
    fn new(piece: &Piece) -> Self {
        let outline = piece.outline.iter();
        let area: f64 = outline.map(|edge| edge.curve.swept_area()).sum();
        let is_turned = area < 0.0;
        let grain = match is_turned {
            true => PI - piece.grain,
            false => piece.grain,
        };
        let mut frame = Self {
            is_turned,
            grain,
            bounds: [[f64::INFINITY, f64::NEG_INFINITY]; 2],
        };
        for point in piece
            .outline
            .iter()
            .flat_map(|edge| edge.curve.flatten(FLAT))
        {
            let place = frame.turned(frame.seen(point));
            for (bounds, value) in frame.bounds.iter_mut().zip([place.x, place.y]) {
                *bounds = [bounds[0].min(value), bounds[1].max(value)];
            }
        }
        frame
    }

    /// A point as seen from the right side of the cloth, and back.
    fn seen(&self, point: Vec2) -> Vec2 {
        match self.is_turned {
            true => Vec2::new(-point.x, point.y),
            false => point,
        }
    }

    /// Coordinates of a seen point across and along the grain (m).
    fn turned(&self, point: Vec2) -> Vec2 {
        let (sine, cosine) = self.grain.sin_cos();
        let up = Vec2::new(cosine, sine);
        Vec2::new(point.dot(&Vec2::new(sine, -cosine)), point.dot(&up))
    }

    /// Place of a seen point across the grain, from -1 to 1 (1).
    fn across(&self, point: Vec2) -> f64 {
        let [low, high] = self.bounds[0];
        let half = (0.5 * (high - low)).max(1e-9);
        (self.turned(point).x - 0.5 * (low + high)) / half
    }

    fn part(&self, edge: &PieceEdge) -> SeenCurve {
        let points = edge.curve.flatten(FLAT).into_iter();
        let line: Vec<Vec2> = points.map(|point| self.seen(point)).collect();
        let count = line.len();
        let at = |t: f64, chord: Vec2| {
            let way = self.seen(edge.curve.derivative(t));
            angle(if way.norm() > 1e-9 { way } else { chord })
        };
        let ends = [
            line[1.min(count - 1)] - line[0],
            line[count - 1] - line[count.saturating_sub(2)],
        ];
        SeenCurve {
            directions: [at(0.0, ends[0]), at(1.0, ends[1])],
            length: edge.curve.length(),
            line,
        }
    }

    /// Marks those of the edges of a piece that are its lower border.
    fn find_bottom(&self, edges: &mut [SeamEdge]) {
        let [low, high] = self.bounds[1];
        for edge in edges {
            let heights = edge.laid.map(|point| self.turned(self.seen(point)).y);
            let height = heights.iter().sum::<f64>() / 3.0;
            edge.is_bottom = height - low < BOTTOM * (high - low) && edge.direction.cos() > LEVEL;
        }
    }
}

/// One curve of a ring, as seen from the right side.
struct SeenCurve {
    line: Vec<Vec2>,
    length: f64,
    /// Directions at the start and the end (rad).
    directions: [f64; 2],
}

impl SeenCurve {
    fn last(&self) -> Vec2 {
        self.line[self.line.len() - 1]
    }

    fn chord(&self) -> Vec2 {
        self.last() - self.line[0]
    }
}

/// The outline and the holes of a piece.
fn rings(piece: &Piece) -> impl Iterator<Item = &[PieceEdge]> {
    let holes = piece.holes.iter().map(Vec::as_slice);
    std::iter::once(piece.outline.as_slice()).chain(holes)
}

/// Curves of a ring grouped by the named edge that they belong to, in order; legs of darts are left out.
fn groups(ring: &[PieceEdge]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (k, edge) in ring.iter().enumerate() {
        if edge.origin.leg().is_some() {
            continue;
        }
        match groups.last_mut() {
            Some(group) if ring[group[0]].origin == edge.origin => group.push(k),
            _ => groups.push(vec![k]),
        }
    }
    let goes_round =
        groups.len() > 1 && ring[groups[0][0]].origin == ring[groups[groups.len() - 1][0]].origin;
    if goes_round && let Some(last) = groups.pop() {
        let first = std::mem::replace(&mut groups[0], last);
        groups[0].extend(first);
    }
    groups
}

/// Angle by which the cloth after the curve `to` turns when the darts between the curves `from` and `to` are
/// closed (rad).
fn closing(parts: &[SeenCurve], ring: &[PieceEdge], from: usize, to: usize) -> f64 {
    let count = ring.len();
    let between = (to + count - from - 1) % count;
    let legs: Vec<usize> = (1..=between).map(|k| (from + k) % count).collect();
    let pairs = legs.chunks_exact(2);
    pairs
        .map(|pair| wrapped(angle(parts[pair[0]].chord()) - angle(-parts[pair[1]].chord())))
        .sum()
}

/// The curves of an edge joined into one line with the darts between closed, at equal arc lengths (m).
fn joined(parts: &[SeenCurve], ring: &[PieceEdge], group: &[usize]) -> Vec<Vec2> {
    let mut line = parts[group[0]].line.clone();
    let mut turned = 0.0_f64;
    for pair in group.windows(2) {
        turned += closing(parts, ring, pair[0], pair[1]);
        let (sine, cosine) = turned.sin_cos();
        let (start, end) = (parts[pair[1]].line[0], line[line.len() - 1]);
        let moved = parts[pair[1]].line.iter().skip(1).map(|point| {
            let from = point - start;
            end + Vec2::new(
                cosine * from.x - sine * from.y,
                sine * from.x + cosine * from.y,
            )
        });
        let moved: Vec<Vec2> = moved.collect();
        line.extend(moved);
    }
    resampled(&line)
}

/// Points of a polyline at equal arc lengths.
fn resampled(line: &[Vec2]) -> Vec<Vec2> {
    let mut ends = vec![0.0];
    let mut length = 0.0;
    for pair in line.windows(2) {
        length += (pair[1] - pair[0]).norm();
        ends.push(length);
    }
    let at = |k: usize| {
        let along = length * k as f64 / CHORDS as f64;
        let after = ends
            .partition_point(|end| *end < along)
            .clamp(1, line.len().max(2) - 1);
        let (Some(start), Some(end)) = (line.get(after - 1), line.get(after)) else {
            return line.first().copied().unwrap_or_else(Vec2::zeros);
        };
        let span = (ends[after] - ends[after - 1]).max(f64::MIN_POSITIVE);
        start + (end - start) * ((along - ends[after - 1]) / span).clamp(0.0, 1.0)
    };
    (0..=CHORDS).map(at).collect()
}

/// Angle by which a line of chords turns (rad).
fn turning(line: &[Vec2]) -> f64 {
    let turn = |three: &[Vec2]| wrapped(angle(three[2] - three[1]) - angle(three[1] - three[0]));
    line.windows(3).map(turn).sum()
}

/// A line of chords in the frame of its chord, with its length as unit (1).
fn shape(line: &[Vec2], length: f64) -> Vec<Vec2> {
    let chord = line[CHORDS] - line[0];
    let along = chord
        .try_normalize(0.05 * length.max(1e-9))
        .unwrap_or_else(Vec2::x);
    let left = Vec2::new(-along.y, along.x);
    let unit = length.max(1e-9);
    let from = line.iter().map(|point| (point - line[0]) / unit);
    from.map(|p| Vec2::new(p.dot(&along), p.dot(&left)))
        .collect()
}

/// The edge of the document with its name, if it is drawn and not made by an operation.
fn named(evaluation: &Evaluation, piece: &Piece, origin: EdgeOrigin) -> (Option<SewnEdge>, String) {
    let Name::Drawn(edge) = origin.name else {
        return (None, String::new());
    };
    let pattern = evaluation.pattern();
    let owner = pattern.owner_of(piece.id.panel, PartId::Edge(edge));
    let name = owner
        .and_then(|owner| owner.edge(edge))
        .map(|edge| edge.name.clone());
    let sewn = SewnEdge {
        panel: piece.id.panel,
        copy: piece.id.copy,
        half: origin.half,
        edge,
    };
    (Some(sewn), name.unwrap_or_default())
}

/// Places of the notches of an edge, as shares of its length (1).
fn notches(
    piece: &Piece,
    origin: EdgeOrigin,
    group: &[usize],
    parts: &[SeenCurve],
    frame: &Frame,
) -> Vec<f64> {
    let own = piece.notches.iter().filter(|notch| notch.edge == origin);
    let total: f64 = group.iter().map(|&part| parts[part].length).sum();
    let mut shares: Vec<f64> = own
        .filter_map(|notch| {
            let at = frame.seen(notch.point);
            let (mut best, mut before) = (None::<(f64, f64)>, 0.0);
            for pair in group.iter().flat_map(|&part| parts[part].line.windows(2)) {
                let chord = pair[1] - pair[0];
                let share = (at - pair[0]).dot(&chord) / chord.norm_squared().max(1e-30);
                let share = share.clamp(0.0, 1.0);
                let away = (pair[0] + chord * share - at).norm();
                if best.is_none_or(|(least, _)| away < least) {
                    best = Some((away, before + share * chord.norm()));
                }
                before += chord.norm();
            }
            best.map(|(_, along)| along / total.max(1e-9))
        })
        .collect();
    shares.sort_by(f64::total_cmp);
    shares
}

fn angle(way: Vec2) -> f64 {
    way.y.atan2(way.x)
}

/// An angle brought between -pi and pi (rad).
pub(super) fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(2.0 * PI) - PI
}
