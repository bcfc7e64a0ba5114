//! Convex curves round a body in a plane across a limb, at a distance from the body. They are parametrised by
//! arc length so that cloth laid on them is not stretched.

use toile_geometry::{Vec2, convex_hull, half_hull};

/// Smallest width of the folds of a ring (m).
const NARROWEST_FOLD: f64 = 0.04;
/// Angle between neighbouring points of a rounded corner (rad).
const CORNER_STEP: f64 = 0.05;

/// A polyline parametrised by arc length. The first coordinate points to the left of the facing direction,
/// the second along it.
#[derive(Clone, Debug)]
pub(crate) struct OutlineCurve {
    points: Vec<Vec2>,
    /// Arc length at each point, zero at the start of the walk (m).
    lengths: Vec<f64>,
    closed: bool,
}

impl OutlineCurve {
    /// The ring at `distance` (m) round the convex hull of points. The walk starts in front (first coordinate
    /// that of `centre`, second largest) and goes to the left.
    pub fn ring(points: &[Vec2], centre: Vec2, distance: f64) -> Self {
        let mut hull = convex_hull(points);
        if hull.is_empty() {
            hull.push(centre);
        }
        let mut outer = Vec::new();
        for k in 0..hull.len() {
            let before = hull[(k + hull.len() - 1) % hull.len()];
            let (here, after) = (hull[k], hull[(k + 1) % hull.len()]);
            let angle = |d: Vec2| (-d.x).atan2(d.y);
            let (mut from, mut to) = (angle(here - before), angle(after - here));
            if hull.len() == 1 {
                (from, to) = (0.0, std::f64::consts::TAU);
            }
            while to < from {
                to += std::f64::consts::TAU;
            }
            let steps = ((to - from) / CORNER_STEP).ceil().clamp(1.0, 200.0);
            for i in 0..=steps as usize {
                // The outward normal of a counter-clockwise edge is its direction turned to the right.
                let turn = from + (to - from) * i as f64 / steps;
                outer.push(here + Vec2::new(turn.cos(), turn.sin()) * distance);
            }
        }
        outer.reverse();
        let start = (0..outer.len())
            .filter(|&k| {
                let (a, b) = (outer[k], outer[(k + 1) % outer.len()]);
                a.x <= centre.x && b.x > centre.x
            })
            .max_by(|&i, &j| outer[i].y.total_cmp(&outer[j].y))
            .unwrap_or(0);
        let (a, b) = (outer[start], outer[(start + 1) % outer.len()]);
        let share = if b.x > a.x {
            (centre.x - a.x) / (b.x - a.x)
        } else {
            0.0
        };
        let mut points = vec![a + (b - a) * share.clamp(0.0, 1.0)];
        points.extend((1..=outer.len()).map(|k| outer[(start + k) % outer.len()]));
        points.push(points[0]);
        let mut curve = Self {
            points,
            lengths: Vec::new(),
            closed: true,
        };
        curve.measure();
        curve
    }

    /// The ring with even folds that reach up to `amplitude` (m) outward, so that it is `length` (m) long.
    /// Folds are at least [`NARROWEST_FOLD`] wide: the ring may then be shorter than `length`.
    pub fn folded(&self, length: f64, amplitude: f64) -> Self {
        self.in_folds(self.fold_count(length, amplitude), length, amplitude)
    }

    /// Number of folds that [`Self::folded`] uses.
    pub fn fold_count(&self, length: f64, amplitude: f64) -> usize {
        let around = self.length();
        let most = (around / NARROWEST_FOLD).floor().max(2.0) as usize;
        let mut count = 2;
        while count < most && self.with_folds(count, amplitude).length() < length {
            count += 1;
        }
        count
    }

    /// The ring with `count` even folds that reach up to `amplitude` (m) outward, so that it is `length` (m)
    /// long.
    pub fn in_folds(&self, count: usize, length: f64, amplitude: f64) -> Self {
        let (mut low, mut high) = (0.0, amplitude);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if self.with_folds(count, middle).length() < length {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.with_folds(count, high)
    }

    fn with_folds(&self, count: usize, amplitude: f64) -> Self {
        let around = self.length();
        let steps = 24 * count;
        let points = (0..=steps)
            .map(|k| {
                let place = around * (k % steps) as f64 / steps as f64;
                let along = self.at(place + 1e-3) - self.at(place - 1e-3);
                let outward = Vec2::new(-along.y, along.x)
                    .try_normalize(0.0)
                    .unwrap_or_default();
                let phase = std::f64::consts::TAU * k as f64 / 24.0;
                self.at(place) + outward * (0.5 * amplitude * (1.0 - phase.cos()))
            })
            .collect();
        let mut curve = Self {
            points,
            lengths: Vec::new(),
            closed: true,
        };
        curve.measure();
        curve
    }

    /// Largest distance of the points from a centre (m).
    pub fn reach(&self, centre: Vec2) -> f64 {
        self.points
            .iter()
            .map(|p| (p - centre).norm())
            .fold(0.0, f64::max)
    }

    /// The curve in front of points: their upper hull, no steeper than 45 degrees, moved `distance` (m)
    /// forward and walked from first coordinate `middle`.
    pub fn front(points: &[Vec2], middle: f64, distance: f64) -> Self {
        let mut sorted = points.to_vec();
        sorted.sort_by(|a, b| b.x.total_cmp(&a.x).then(b.y.total_cmp(&a.y)));
        let mut chain = half_hull(sorted.into_iter());
        chain.reverse();
        let steep = |a: Vec2, b: Vec2| (b.y - a.y).abs() > (b.x - a.x).abs();
        while chain.len() > 2 && steep(chain[0], chain[1]) {
            chain.remove(0);
        }
        while chain.len() > 2 && steep(chain[chain.len() - 1], chain[chain.len() - 2]) {
            chain.pop();
        }
        if chain.is_empty() {
            chain.push(Vec2::new(middle, 0.0));
        }
        let (first, last) = (chain[0], chain[chain.len() - 1]);
        let far = 10.0;
        chain.insert(0, first + Vec2::new(-far, -far));
        chain.push(last + Vec2::new(far, -far));
        for p in &mut chain {
            p.y += distance;
        }
        let mut curve = Self {
            points: chain,
            lengths: Vec::new(),
            closed: false,
        };
        curve.measure();
        let at = curve.length_at_abscissa(middle);
        for length in &mut curve.lengths {
            *length -= at;
        }
        curve
    }

    fn measure(&mut self) {
        let mut length = 0.0;
        self.lengths = vec![0.0];
        for pair in self.points.windows(2) {
            length += (pair[1] - pair[0]).norm();
            self.lengths.push(length);
        }
    }

    fn length_at_abscissa(&self, x: f64) -> f64 {
        for k in 0..self.points.len() - 1 {
            let (a, b) = (self.points[k], self.points[k + 1]);
            if a.x <= x && b.x > x {
                let share = (x - a.x) / (b.x - a.x);
                return self.lengths[k] + share * (self.lengths[k + 1] - self.lengths[k]);
            }
        }
        0.0
    }

    /// Total length of the ring (m).
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// The point at an arc length from the start of the walk (m), periodic for a ring.
    pub fn at(&self, length: f64) -> Vec2 {
        let total = self.length();
        let wanted = if self.closed && total > 0.0 {
            length.rem_euclid(total)
        } else {
            length
        };
        let last = self.points.len() - 1;
        let k = self
            .lengths
            .partition_point(|&l| l <= wanted)
            .clamp(1, last)
            - 1;
        let span = self.lengths[k + 1] - self.lengths[k];
        if span <= 0.0 {
            return self.points[k];
        }
        let share = (wanted - self.lengths[k]) / span;
        self.points[k] + (self.points[k + 1] - self.points[k]) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_round_a_square_has_the_length_of_the_square_and_a_circle() {
        let square = [
            Vec2::new(-1.0, -1.0),
            Vec2::new(1.0, -1.0),
            Vec2::new(1.0, 1.0),
            Vec2::new(-1.0, 1.0),
            Vec2::zeros(),
        ];
        let ring = OutlineCurve::ring(&square, Vec2::zeros(), 0.5);
        let expected = 8.0 + std::f64::consts::PI;
        assert!((ring.length() - expected).abs() < 1e-3, "{}", ring.length());
        assert!((ring.at(0.0) - Vec2::new(0.0, 1.5)).norm() < 1e-12);
        let quarter = ring.at(ring.length() / 4.0);
        assert!((quarter - Vec2::new(1.5, 0.0)).norm() < 1e-2, "{quarter}");
        assert!(ring.at(0.1).x > 0.0 && ring.at(-0.1).x < 0.0);
        for k in 0..100 {
            let s = f64::from(k) * 0.1;
            let step = (ring.at(s + 0.01) - ring.at(s)).norm();
            assert!(step <= 0.01 + 1e-12 && step > 0.0095, "{step}");
        }
    }

    #[test]
    fn folds_make_a_ring_as_long_as_asked_and_stay_in_reach() {
        let ring = OutlineCurve::ring(&[], Vec2::zeros(), 0.25);
        let folded = ring.folded(4.0, 0.12);
        assert!((folded.length() - 4.0).abs() < 1e-3, "{}", folded.length());
        assert!(folded.reach(Vec2::zeros()) < 0.25 + 0.12 + 1e-3);
        assert!((folded.at(0.0) - ring.at(0.0)).norm() < 1e-6);
    }

    #[test]
    fn a_front_curve_lies_before_all_its_points() {
        let points: Vec<Vec2> = (0..50)
            .map(|k| {
                let t = f64::from(k) * 0.7;
                Vec2::new(t.sin() * 0.2, (1.3 * t).cos() * 0.1)
            })
            .collect();
        let curve = OutlineCurve::front(&points, 0.0, 0.02);
        for p in &points {
            let best = (-400..=400)
                .map(|k| curve.at(f64::from(k) * 1e-3))
                .min_by(|a, b| (a.x - p.x).abs().total_cmp(&(b.x - p.x).abs()))
                .unwrap();
            assert!(best.y >= p.y + 0.015, "{best} {p}");
        }
        assert!(curve.at(0.0).x.abs() < 1e-12);
        assert!(curve.at(0.1).x > 0.0);
    }

    #[test]
    fn curves_of_nothing_still_answer() {
        for points in [&[][..], &[Vec2::zeros()], &[Vec2::zeros(), Vec2::x()]] {
            let ring = OutlineCurve::ring(points, Vec2::zeros(), 0.1);
            assert!(ring.length() > 0.5 && ring.at(0.3).norm().is_finite());
            let front = OutlineCurve::front(points, 0.0, 0.1);
            assert!(front.at(3.0).norm().is_finite());
        }
    }
}
