//! The room that a notch has between the cut line and the cloth that is sewn.

use crate::notch::{NOTCH_DEPTH, shape};
use toile_geometry::{
    Bounds2, Polygon, Vec2, closest_on_segment, point_segment_distance, segment_distance,
    segments_cross,
};
use toile_pattern::NotchKind;

/// Largest depth of a notch, over the width of the allowance (1): some allowance must be left between notch
/// and seam.
const MAX_ALLOWANCE_SHARE: f64 = 0.6;
/// Least distance between a notch and the sewn cloth, over the depth of the notch (1). The deepest notch
/// leaves 0.4 of the allowance, which is 0.67 of the notch's depth.
const CLEAR: f64 = 0.66;
/// Least distance between the bottom of a notch and the cut line, over the depth of the notch (1).
const WITHIN: f64 = 0.3;
/// Ratio of each depth that is tried to the depth tried before (1).
const SHALLOWER: f64 = 0.85;
/// Least depth of a notch (m): a shallower one is no wider than the cut of a knife.
const LEAST: f64 = 0.000_25;
/// Largest distance from the seam line at which a cut line is looked for (m).
const REACH: f64 = 0.5;
/// Cut lines nearer to the seam line than this count as equal to it (m): the difference comes from
/// flattening.
const ON_SEAM: f64 = 1e-4;
/// Largest distance from the cut line at which a point counts as on it (m).
const ON_CUT: f64 = 2e-5;

/// A piece's cut line, and the cloth inside its seam lines.
pub(crate) struct Room {
    pub cut: Polygon,
    pub sewn: Polygon,
}

/// The cut line and the seam lines near a notch.
struct Near<'a> {
    room: &'a Room,
    cut: Vec<[Vec2; 2]>,
    sewn: Vec<[Vec2; 2]>,
}

impl Room {
    /// Point of the cut line for a notch at `from` on the seam line; the cut line is expected at `from +
    /// outwards` (m). `None`: there is no cut line, or other sewn cloth lies before it.
    pub fn cut_line(&self, from: Vec2, outwards: Vec2) -> Option<Vec2> {
        let at = self
            .there(from + outwards)
            .or_else(|| self.outwards(from, outwards))?;
        let way = at - from;
        let length = way.norm();
        let start = from + way * (ON_SEAM / length.max(ON_SEAM));
        let blocked = |edge: [Vec2; 2]| segments_cross([start, at], edge);
        (length <= ON_SEAM || !self.sewn.edges().any(blocked)).then_some(at)
    }

    /// Point of the cut line nearest to `place`; `None`: the cut line does not pass through `place`.
    fn there(&self, place: Vec2) -> Option<Vec2> {
        let away = |at: &Vec2| (at - place).norm();
        let nearest = self.cut.edges().map(|edge| closest_on_segment(place, edge));
        let nearest = nearest.min_by(|a, b| away(a).total_cmp(&away(b)));
        nearest.filter(|at| away(at) <= ON_CUT)
    }

    /// The first point at which a ray from `from` in the direction `way` meets the cut line.
    fn outwards(&self, from: Vec2, way: Vec2) -> Option<Vec2> {
        let way = way.try_normalize(1e-9)?;
        let mut nearest = REACH;
        for [p, q] in self.cut.edges() {
            let side = q - p;
            let cross = way.perp(&side);
            let (at, share) = (
                (p - from).perp(&side) / cross,
                (p - from).perp(&way) / cross,
            );
            let meets = (-1e-9..=1.0 + 1e-9).contains(&share) && at > -ON_SEAM;
            if meets && at < nearest {
                nearest = at;
            }
        }
        (nearest < REACH).then(|| from + way * nearest.max(0.0))
    }

    /// Depth to which a notch can be cut (m), and the lines to cut. `point` is the notch's place on the seam
    /// line, `at` its place on the cut line; `axes` are unit vectors along the cut line and inwards. `None`:
    /// the allowance is not wide enough.
    pub fn cut(
        &self,
        kind: NotchKind,
        (point, at): (Vec2, Vec2),
        axes: [Vec2; 2],
    ) -> Option<(f64, Vec<Vec<Vec2>>)> {
        let width = (at - point).norm();
        let deepest = NOTCH_DEPTH.min(MAX_ALLOWANCE_SHARE * width);
        let near = Near::new(self, at, 3.0 * deepest);
        let mut depth = deepest;
        while depth >= LEAST {
            if let Some(lines) = near.lines(kind, (at, axes), depth) {
                return Some((depth, lines));
            }
            depth *= SHALLOWER;
        }
        None
    }
}

impl<'a> Near<'a> {
    fn new(room: &'a Room, at: Vec2, reach: f64) -> Self {
        let around = Bounds2::of([at]).grown(reach);
        let near = |polygon: &Polygon| {
            let edges = polygon.edges();
            edges
                .filter(|edge| Bounds2::of(*edge).meets(&around))
                .collect()
        };
        Self {
            cut: near(&room.cut),
            sewn: near(&room.sewn),
            room,
        }
    }

    /// The lines of a notch of this depth; `None`: some of them leave the allowance.
    fn lines(
        &self,
        kind: NotchKind,
        (at, [along, inward]): (Vec2, [Vec2; 2]),
        depth: f64,
    ) -> Option<Vec<Vec<Vec2>>> {
        let mut lines = Vec::new();
        for line in shape(kind) {
            let mut points = Vec::with_capacity(line.len());
            for [aside, deep] in line {
                let place = at + (along * aside + inward * deep) * depth;
                points.push(match (deep == 0.0, aside == 0.0) {
                    (true, true) => at,
                    (true, false) => self.on_cut_line(place, inward * depth)?,
                    (false, _) => place,
                });
                let is_ground = deep > 0.0;
                if is_ground && !self.is_within(place, WITHIN * depth) {
                    return None;
                }
            }
            let fits = |pair: &[Vec2]| self.is_clear([pair[0], pair[1]], CLEAR * depth);
            if !points.windows(2).all(fits) {
                return None;
            }
            lines.push(points);
        }
        Some(lines)
    }

    /// The point of the cut line straight outwards or inwards from `place`, a point expected near the cut
    /// line. `None`: there is none within 0.9 times the length of `inwards`.
    fn on_cut_line(&self, place: Vec2, inwards: Vec2) -> Option<Vec2> {
        let (from, to) = (place + inwards * 0.9, place - inwards * 0.9);
        let way = to - from;
        let meet = |[p, q]: &[Vec2; 2]| {
            let side = q - p;
            let cross = way.perp(&side);
            let (at, share) = (
                (p - from).perp(&side) / cross,
                (p - from).perp(&way) / cross,
            );
            let meets = (0.0..=1.0).contains(&at) && (-1e-9..=1.0 + 1e-9).contains(&share);
            meets.then_some(at)
        };
        let first = self.cut.iter().filter_map(meet).min_by(f64::total_cmp);
        first.map(|at| from + way * at)
    }

    /// Whether a point lies in the piece as cut, at least this far from the cut line (m).
    fn is_within(&self, place: Vec2, far: f64) -> bool {
        let near = |edge: &[Vec2; 2]| point_segment_distance(place, *edge) < far;
        self.room.cut.contains(place) && !self.cut.iter().any(near)
    }

    /// Whether a line that starts or ends on the cut line crosses it nowhere else, and keeps the distance
    /// `far` from the sewn cloth (m).
    fn is_clear(&self, line: [Vec2; 2], far: f64) -> bool {
        let short = (line[1] - line[0]) * 0.02;
        let inner = [line[0] + short, line[1] - short];
        !self.cut.iter().any(|edge| segments_cross(inner, *edge))
            && !self
                .sewn
                .iter()
                .any(|edge| segment_distance(line, *edge) < far)
            && !self.room.sewn.contains(line[0])
    }
}
