//! The ends of a seam: continuation of the adjacent edges of both pieces across the seam.

use super::{Run, Walk, cloth_is_left, rings};
use crate::{Draft, EdgeOrigin, Pattern, Piece, PieceEdge, Role};
use toile_geometry::{Curve, Vec2};

/// Largest turn of a line across a seam that counts as smooth (deg). A line that is smoothed by hand, from a
/// centimetre before the seam to a centimetre after, deviates by 1 cm tan(1 deg) = 0.17 mm: less than the
/// width of a pencil's line.
pub const SMOOTH: f64 = 2.0;
/// Largest turn of a line across a seam that counts as a slight kink (deg). A line that turns more has a kink
/// that is visible when sewn: smoothing it deviates by 1 cm tan(3 deg) = 0.5 mm, the tolerance of the sides
/// of a seam.
pub const SLIGHT_KINK: f64 = 6.0;
/// Deviation from a straight line below which two edges at the end of a seam do not form a corner (rad): the
/// edge continues beyond the end of the seam.
const STRAIGHT_ON: f64 = std::f64::consts::PI / 6.0;
/// Largest difference between shares of an edge that count as equal (1).
const SAME_SHARE: f64 = 1e-9;

/// A line that crosses a seam at one of its ends. It consists of the two edges that leave the seam there,
/// when the pieces are laid together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// End of the seam: 0 its start, 1 its end.
    pub end: usize,
    /// Indices of the pieces in the draft.
    pub pieces: [usize; 2],
    /// The edges that leave the seam: on the piece of the first side, and on the piece of the second side.
    pub edges: [EdgeOrigin; 2],
    /// The corners at the end of the seam, each in the plane of its piece (m).
    pub corners: [Vec2; 2],
    /// Unit vectors along the edges away from the seam, each in the plane of its piece; darts between the
    /// seam and the edge are closed.
    pub leaving: [Vec2; 2],
    /// Angles between the seam and each edge, measured through the cloth (rad).
    pub angles: [f64; 2],
    /// Turn of the line across the seam (rad), from -pi to pi: 0 smooth, positive a peak that points out of
    /// the cloth, negative a dip into the cloth.
    pub kink: f64,
    /// Length by which the first piece extends beyond the second at this end, when both are laid together at
    /// the start of the seam and neither is stretched (m): the part of the difference in length that neither
    /// ease nor gathers take in. 0 at the start of the seam.
    pub step: f64,
}

/// Smoothness of a line across a seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Smoothness {
    /// The line turns by no more than [`SMOOTH`].
    Smooth,
    /// The line turns by no more than [`SLIGHT_KINK`].
    Slight,
    /// The line turns by more than [`SLIGHT_KINK`].
    Kink,
}

impl Joint {
    /// Smoothness of the line across the seam.
    pub fn smoothness(&self) -> Smoothness {
        let turn = self.kink.abs().to_degrees();
        match () {
            () if turn <= SMOOTH => Smoothness::Smooth,
            () if turn <= SLIGHT_KINK => Smoothness::Slight,
            () => Smoothness::Kink,
        }
    }

    /// Names of the two edges.
    pub fn names(&self, pattern: &Pattern, draft: &Draft) -> [String; 2] {
        [0, 1].map(|k| {
            let piece = draft.pieces.get(self.pieces[k]);
            let name = piece.and_then(|p| pattern.edge_name(p.id.panel, self.edges[k].name));
            name.unwrap_or("edge").to_owned()
        })
    }

    /// Name of the line: the name of both edges if it is the same, else both names.
    pub fn line(&self, pattern: &Pattern, draft: &Draft) -> String {
        match self.names(pattern, draft) {
            [one, other] if one == other => one,
            [one, other] => format!("{one} to {other}"),
        }
    }
}

impl Walk<'_> {
    /// The lines that cross the seam at its start and at its end; `ease` is the length by which one side may
    /// be longer than the other (m). `None`: no line crosses there, as an edge continues beyond the end of
    /// the seam, within 30 degrees of straight: a slit begins there, or a third piece is sewn on.
    pub fn joints(&self, ease: f64) -> [Option<Joint>; 2] {
        [0, 1].map(|end| self.joint(end, ease))
    }

    fn joint(&self, end: usize, ease: f64) -> Option<Joint> {
        let first = self.corner(0, end)?;
        let second = self.corner(1, end)?;
        let both = [first, second];
        let angles = both.map(|corner| corner.angle);
        let goes_on = |angle: f64| (angle - std::f64::consts::PI).abs() < STRAIGHT_ON;
        if angles.iter().any(|angle| goes_on(*angle)) {
            return None;
        }
        let turn = std::f64::consts::PI - angles[0] - angles[1];
        let kink = turn.sin().atan2(turn.cos());
        let [first, second] = self.lengths();
        let left_over = match self.seam.gathered {
            true => 0.0,
            false => ((first - second).abs() - ease.max(0.0)).max(0.0) * (first - second).signum(),
        };
        Some(Joint {
            end,
            pieces: both.map(|corner| corner.piece),
            edges: both.map(|corner| corner.edge),
            corners: both.map(|corner| corner.at),
            leaving: both.map(|corner| corner.leaving),
            angles,
            kink,
            step: if end == 1 { left_over } else { 0.0 },
        })
    }

    /// The corner of a side at an end of the seam. `None`: the seam ends within an edge.
    fn corner(&self, side: usize, end: usize) -> Option<SeamCorner> {
        let runs = &self.sides.0[side].runs;
        let run = if end == 0 {
            runs.first()?
        } else {
            runs.last()?
        };
        let piece = self.draft.pieces.get(run.span.piece)?;
        let (into_seam, at) = into_run(run, end)?;
        // Whether the edge beyond the end of the seam is the next edge of the ring; if not, it is the one
        // before.
        let forward = (run.span.to > run.span.from) == (end == 1);
        let share = if end == 0 { run.span.from } else { run.span.to };
        let wanted = if forward { 1.0 } else { 0.0 };
        if (share - wanted).abs() > SAME_SHARE {
            return None;
        }
        let (edge, leaving) = neighbour(piece, run.span.edge, forward)?;
        let (arrives, goes) = match forward {
            true => (-into_seam, leaving),
            false => (-leaving, into_seam),
        };
        let turn = arrives.perp(&goes).atan2(arrives.dot(&goes));
        let side = if cloth_is_left(piece) { 1.0 } else { -1.0 };
        Some(SeamCorner {
            piece: run.span.piece,
            edge: edge.origin,
            at,
            leaving,
            angle: std::f64::consts::PI - side * turn,
        })
    }
}

/// A corner of a piece at an end of a seam.
#[derive(Clone, Copy)]
struct SeamCorner {
    piece: usize,
    /// The edge that leaves the seam.
    edge: EdgeOrigin,
    /// Position of the corner (m).
    at: Vec2,
    /// Unit vector along that edge, away from the seam.
    leaving: Vec2,
    /// Angle between the seam and that edge, through the cloth (rad).
    angle: f64,
}

/// Unit vector along a run at one of its ends, towards the inside of the run; and the position of that end
/// (m).
fn into_run(run: &Run, end: usize) -> Option<(Vec2, Vec2)> {
    let curves = run.path.curves();
    Some(match end {
        0 => {
            let first = curves.first()?;
            (leaving(first), first.start())
        }
        _ => {
            let last = curves.last()?.reversed();
            (leaving(&last), last.start())
        }
    })
}

/// The edge next to another on its ring, and the unit vector along it away from the other edge. Darts between
/// the two are closed: both legs are skipped, and the vector is turned by the dart's angle. Underlays of
/// pleats lie folded under: they are skipped without a turn.
fn neighbour(piece: &Piece, edge: usize, forward: bool) -> Option<(&PieceEdge, Vec2)> {
    let mut before = 0;
    let ring = rings(piece).find(|ring| {
        let is_here = edge < before + ring.len();
        if !is_here {
            before += ring.len();
        }
        is_here
    })?;
    let count = ring.len();
    let mut k = edge - before;
    let mut closing = 0.0;
    for _ in 0..count {
        k = next(k, count, forward);
        let found = &ring[k];
        if found.origin.name.role() == Some(Role::Underlay) {
            continue;
        }
        let Some((by, _)) = found.origin.leg() else {
            let way = leaving(&walked(found, forward));
            return Some((found, turned(way, closing)));
        };
        // The second leg is turned onto the first about the apex, where both legs meet.
        let other = next(k, count, forward);
        let is_pair = ring[other].origin.leg().is_some_and(|(own, _)| own == by);
        if !is_pair || other == edge - before {
            return None;
        }
        let there = walked(found, forward);
        let back = walked(&ring[other], forward);
        let [near, far] = [there.start() - there.end(), back.end() - back.start()];
        closing += far.perp(&near).atan2(far.dot(&near));
        k = other;
    }
    None
}

fn next(k: usize, count: usize, forward: bool) -> usize {
    match forward {
        true => (k + 1) % count,
        false => (k + count - 1) % count,
    }
}

/// The curve of an edge in the direction of its ring if `forward`, else against it.
fn walked(edge: &PieceEdge, forward: bool) -> Curve {
    match forward {
        true => edge.curve,
        false => edge.curve.reversed(),
    }
}

fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// Unit vector along a curve at its start; if the derivative vanishes there, towards a point a little further
/// on.
fn leaving(curve: &Curve) -> Vec2 {
    let own = curve.derivative(0.0).try_normalize(1e-12);
    let further = || (curve.point(1e-3) - curve.start()).try_normalize(1e-15);
    own.or_else(further).unwrap_or_else(Vec2::x)
}
