//! Plane curves in a row: where a length leads, what lies nearest, where two rows cross.

use crate::{Bounds2, Curve, EdgeTree, Vec2, closest_on_segment};
use std::ops::ControlFlow;

/// Chords by which nearest places and crossings are first found stay this near to their curve,
/// as a part of the extent. Newton's method refines what they find.
const CHORD_ERROR: f64 = 1e-4;
/// Steps of Newton's method at most: it converges in three or four from a chord's answer.
const NEWTON_STEPS: usize = 30;
/// Crossings nearer to each other than this part of the extent are one.
const SAME_CROSSING: f64 = 1e-9;

/// Curves that follow each other: each starts where the one before it ends.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Path {
    curves: Vec<Curve>,
    /// Arc length at the end of each curve (m).
    ends: Vec<f64>,
}

/// A place on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPlace {
    /// Index of the curve.
    pub curve: usize,
    /// Parameter on it, 0..=1.
    pub t: f64,
    /// Arc length from the start of the path (m).
    pub along: f64,
}

/// Where two paths cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathCrossing {
    /// Place on the first path.
    pub here: PathPlace,
    /// Place on the second path.
    pub there: PathPlace,
    /// Where (m).
    pub point: Vec2,
    /// Whether the second path goes from the right of the first to its left.
    pub leftwards: bool,
}

/// Chords of a path: ends, curve and parameters of each.
struct Chords {
    tree: EdgeTree,
    parameters: Vec<(usize, [f64; 2])>,
}

impl Path {
    /// A row of curves.
    pub fn new(curves: Vec<Curve>) -> Self {
        let mut total = 0.0;
        let ends = curves
            .iter()
            .map(|curve| {
                total += curve.length();
                total
            })
            .collect();
        Self { curves, ends }
    }

    /// Its curves, in order.
    pub fn curves(&self) -> &[Curve] {
        &self.curves
    }

    /// Arc length (m).
    pub fn length(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// Arc length from the start of the path to the start of a curve (m).
    pub fn length_before(&self, curve: usize) -> f64 {
        match curve {
            0 => 0.0,
            k => self.ends.get(k - 1).copied().unwrap_or(self.length()),
        }
    }

    /// The place at an arc length (m), clamped to the path; nothing if the path is empty. Where
    /// two curves meet it is the start of the second.
    pub fn at_length(&self, along: f64) -> Option<PathPlace> {
        let last = self.curves.len().checked_sub(1)?;
        let along = along.clamp(0.0, self.length());
        let curve = self.ends.partition_point(|&end| end <= along).min(last);
        let t = self.curves[curve].parameter_at_length(along - self.length_before(curve));
        Some(PathPlace { curve, t, along })
    }

    /// The place at a parameter of one of its curves.
    pub fn at_parameter(&self, curve: usize, t: f64) -> PathPlace {
        PathPlace {
            curve,
            t,
            along: self.length_before(curve) + self.curves[curve].length_until(t),
        }
    }

    /// Where a place lies (m).
    pub fn point(&self, place: PathPlace) -> Vec2 {
        self.curves[place.curve].point(place.t)
    }

    /// Unit direction of travel at a place; nothing where a curve stands still.
    pub fn direction(&self, place: PathPlace) -> Option<Vec2> {
        let along = self.curves[place.curve].derivative(place.t);
        along.try_normalize(1e-15)
    }

    /// The curves between two arc lengths (m), in order; `from` after `to` gives them walked
    /// backwards. Pieces shorter than 1e-12 of the path are left out.
    pub fn between(&self, from: f64, to: f64) -> Self {
        if from > to {
            return self.between(to, from).reversed();
        }
        let (Some(start), Some(end)) = (self.at_length(from), self.at_length(to)) else {
            return Self::default();
        };
        let mut pieces = Vec::new();
        for k in start.curve..=end.curve {
            let low = if k == start.curve { start.t } else { 0.0 };
            let high = if k == end.curve { end.t } else { 1.0 };
            let whole = low == 0.0 && high == 1.0;
            if !whole && (high - low) * self.curves[k].length() <= 1e-12 * self.length() {
                continue;
            }
            pieces.push(match whole {
                true => self.curves[k],
                false => self.curves[k].between(low, high),
            });
        }
        Self::new(pieces)
    }

    /// The path walked from its end to its start.
    pub fn reversed(&self) -> Self {
        Self::new(self.curves.iter().rev().map(Curve::reversed).collect())
    }

    /// Points along the path, both ends included, whose chords stay within `tolerance` (m).
    pub fn flatten(&self, tolerance: f64) -> Vec<Vec2> {
        let mut points: Vec<Vec2> = Vec::new();
        for curve in &self.curves {
            points.pop();
            points.extend(curve.flatten(tolerance));
        }
        points
    }

    fn chords(&self, extent: f64) -> Chords {
        let mut edges = Vec::new();
        let mut parameters = Vec::new();
        for (k, curve) in self.curves.iter().enumerate() {
            let count = curve.chord_count(CHORD_ERROR * extent);
            let t = |j: usize| j as f64 / count as f64;
            for j in 0..count {
                edges.push([curve.point(t(j)), curve.point(t(j + 1))]);
                parameters.push((k, [t(j), t(j + 1)]));
            }
        }
        Chords {
            tree: EdgeTree::new(edges),
            parameters,
        }
    }

    /// The place nearest to a point, right to about 1e-12 of the extent; nothing if the path is
    /// empty or not finite. Of places equally near it is the first.
    pub fn nearest(&self, to: Vec2) -> Option<PathPlace> {
        let extent = self.extent();
        if !extent.is_finite() {
            return None;
        }
        let chords = self.chords(extent);
        let away = |k: usize| (closest_on_segment(to, chords.tree.edges()[k]) - to).norm();
        let count = chords.parameters.len();
        let least = (0..count).map(away).fold(f64::INFINITY, f64::min);
        let mut best: Option<(f64, usize, f64)> = None;
        for k in (0..count).filter(|&k| away(k) <= least + 2.0 * CHORD_ERROR * extent) {
            let (curve, range) = chords.parameters[k];
            let t = self.curves[curve].nearest_between(to, range);
            let distance = (self.curves[curve].point(t) - to).norm();
            if best.is_none_or(|b| distance < b.0) {
                best = Some((distance, curve, t));
            }
        }
        best.map(|(_, curve, t)| self.at_parameter(curve, t))
    }

    /// Largest side of the bounds of its defining points (m).
    fn extent(&self) -> f64 {
        let points = self.curves.iter().flat_map(Curve::defining_points);
        let size = Bounds2::of(points).size();
        size.x.max(size.y)
    }

    /// Where another path crosses this one, in order along this one. Stretches along which both
    /// run together give nothing; touching without crossing gives at most one place.
    pub fn crossings(&self, other: &Self) -> Vec<PathCrossing> {
        let extent = self.extent().max(other.extent());
        if !(extent.is_finite() && extent > 0.0) {
            return Vec::new();
        }
        let (here, there) = (self.chords(extent), other.chords(extent));
        let mut found: Vec<PathCrossing> = Vec::new();
        let reach = 2.0 * CHORD_ERROR * extent;
        let visited = here.tree.pairs(&there.tree, reach, &mut |a, b| {
            let crossing = self.refine(other, here.parameters[a], there.parameters[b], extent);
            found.extend(crossing);
            ControlFlow::Continue(())
        });
        debug_assert!(visited.is_continue());
        found.sort_by(|a, b| a.here.along.total_cmp(&b.here.along));
        let near = SAME_CROSSING * extent;
        found.dedup_by(|b, a| {
            (a.here.along - b.here.along).abs() < near
                && (a.there.along - b.there.along).abs() < near
        });
        found
    }

    /// The crossing of two curves from the middle of two chords by Newton's method.
    fn refine(
        &self,
        other: &Self,
        (k, here): (usize, [f64; 2]),
        (j, there): (usize, [f64; 2]),
        extent: f64,
    ) -> Option<PathCrossing> {
        let (one, two) = (&self.curves[k], &other.curves[j]);
        let (mut t, mut u) = ((here[0] + here[1]) / 2.0, (there[0] + there[1]) / 2.0);
        for _ in 0..NEWTON_STEPS {
            let gap = two.point(u) - one.point(t);
            let (along, across) = (one.derivative(t), two.derivative(u));
            let turn = along.perp(&across);
            if turn.abs() <= 1e-14 * along.norm() * across.norm() {
                return None;
            }
            let step = [gap.perp(&across) / turn, gap.perp(&along) / turn];
            (t, u) = (t + step[0], u + step[1]);
            if step.iter().all(|s| s.abs() < 1e-15) {
                break;
            }
        }
        // A crossing belongs to the chords it is nearest to; their neighbours find the others.
        let slack = 1e-9;
        let inside = |x: f64, [low, high]: [f64; 2]| {
            let margin = 0.5 * (high - low);
            x >= (low - margin).max(-slack) && x <= (high + margin).min(1.0 + slack)
        };
        let (inside_here, inside_there) = (inside(t, here), inside(u, there));
        (t, u) = (t.clamp(0.0, 1.0), u.clamp(0.0, 1.0));
        let point = one.point(t);
        let met = (two.point(u) - point).norm() <= 1e-10 * extent;
        (inside_here && inside_there && met).then(|| PathCrossing {
            here: self.at_parameter(k, t),
            there: other.at_parameter(j, u),
            point,
            leftwards: one.derivative(t).perp(&two.derivative(u)) > 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn v(x: f64, y: f64) -> Vec2 {
        Vec2::new(x, y)
    }

    /// A quarter circle of radius 1 round the origin, then a line down, then a bow.
    fn row() -> Path {
        Path::new(vec![
            Curve::Arc {
                start: v(1.0, 0.0),
                end: v(0.0, 1.0),
                bulge: (std::f64::consts::PI / 8.0).tan(),
            },
            Curve::Line {
                start: v(0.0, 1.0),
                end: v(-1.0, 1.0),
            },
            Curve::Cubic {
                start: v(-1.0, 1.0),
                controls: [v(-1.5, 0.5), v(-1.0, -0.2)],
                end: v(-0.5, -0.4),
            },
        ])
    }

    #[test]
    fn lengths_lead_to_places() {
        let row = row();
        let quarter = std::f64::consts::FRAC_PI_2;
        let place = row.at_length(quarter / 2.0).unwrap();
        let half = std::f64::consts::FRAC_1_SQRT_2;
        assert!((row.point(place) - v(half, half)).norm() < 1e-12);
        let place = row.at_length(quarter + 0.25).unwrap();
        assert_eq!(place.curve, 1);
        assert!((row.point(place) - v(-0.25, 1.0)).norm() < 1e-12);
        assert!((row.direction(place).unwrap() - v(-1.0, 0.0)).norm() < 1e-12);
        let corner = row.at_length(quarter).unwrap();
        assert_eq!((corner.curve, corner.t), (1, 0.0));
        assert_eq!(row.at_length(99.0).unwrap().t, 1.0);
        assert_eq!(Path::default().at_length(0.0), None);
    }

    #[test]
    fn pieces_have_the_length_they_are_asked_for() {
        let row = row();
        for (from, to) in [(0.2, 2.9), (0.0, row.length()), (1.7, 1.9), (2.9, 0.2)] {
            let piece = row.between(from, to);
            assert!((piece.length() - (to - from).abs()).abs() < 1e-9);
            for pair in piece.curves().windows(2) {
                assert!((pair[0].end() - pair[1].start()).norm() < 1e-12);
            }
            let start = row.point(row.at_length(from).unwrap());
            assert!((piece.curves()[0].start() - start).norm() < 1e-9);
        }
    }

    #[test]
    fn closed_forms_of_crossings() {
        let row = row();
        let line = |a: Vec2, b: Vec2| Path::new(vec![Curve::Line { start: a, end: b }]);
        let found = row.crossings(&line(v(0.0, 0.0), v(2.0, 2.0)));
        let half = std::f64::consts::FRAC_1_SQRT_2;
        assert_eq!(found.len(), 1);
        assert!((found[0].point - v(half, half)).norm() < 1e-12);
        assert!(!found[0].leftwards);
        let found = row.crossings(&line(v(2.0, 0.5), v(-2.0, 0.5)));
        assert_eq!(found.len(), 2);
        assert!((found[0].point - v(0.75_f64.sqrt(), 0.5)).norm() < 1e-12);
        assert!(found[0].leftwards && !found[1].leftwards);
        let found = row.crossings(&line(v(0.0, 0.0), v(0.0, 2.0)));
        assert_eq!(found.len(), 1, "a corner is one crossing: {found:?}");
        assert!(row.crossings(&line(v(3.0, 0.0), v(3.0, 1.0))).is_empty());
        let along = line(v(1.0, 1.0), v(-2.0, 1.0));
        assert!(row.crossings(&along).len() <= 2, "running together");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

        #[test]
        fn nothing_sampled_is_nearer_than_the_nearest(x in -2.0..2.0, y in -2.0..2.0) {
            let row = row();
            let to = v(x, y);
            let place = row.nearest(to).unwrap();
            let distance = (row.point(place) - to).norm();
            for k in 0..=3000 {
                let curve = &row.curves()[k % 3];
                let other = curve.point(k as f64 / 3000.0);
                prop_assert!((other - to).norm() >= distance - 1e-9);
            }
            let again = row.at_length(place.along).unwrap();
            prop_assert!((row.point(again) - row.point(place)).norm() < 1e-9);
        }

        #[test]
        fn all_crossings_of_flattened_curves_are_found(
            p in prop::collection::vec((0.0..1.0, 0.0..1.0), 8),
        ) {
            let at = |k: usize| v(p[k].0, p[k].1);
            let cubic = |k: usize| Path::new(vec![Curve::Cubic {
                start: at(k), controls: [at(k + 1), at(k + 2)], end: at(k + 3),
            }]);
            let (one, two) = (cubic(0), cubic(4));
            let found = one.crossings(&two);
            for crossing in &found {
                let gap = one.point(crossing.here) - two.point(crossing.there);
                prop_assert!(gap.norm() < 1e-9);
            }
            let (a, b) = (one.flatten(1e-5), two.flatten(1e-5));
            let brute: Vec<[Vec2; 2]> = a.windows(2).flat_map(|s| b.windows(2)
                .filter(|r| crate::segments_cross([s[0], s[1]], [r[0], r[1]]))
                .map(|r| [s[0], r[0]])).collect();
            for [near, _] in brute {
                prop_assert!(found.iter().any(|c| (c.point - near).norm() < 0.02), "{found:?}");
            }
        }
    }
}
