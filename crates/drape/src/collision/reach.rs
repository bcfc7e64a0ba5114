//! Reach of a query for contacts: the distance at which two features may still come to press before the next query.

use super::feature_pair::FeaturePair;
use toile_geometry::Vec3;

/// Reach of a query: the same everywhere, or shorter where velocities are small.
#[derive(Clone, Copy, Debug)]
pub struct Reach<'a> {
    /// Largest reach of any pair (m).
    pub max: f64,
    /// Motion expected until the next query; none where every pair has the largest reach.
    pub ahead: Option<Ahead<'a>>,
}

/// Motion expected until the next query.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<'a> {
    /// Present velocities of the vertices (m/s).
    pub velocities: &'a [Vec3],
    /// Vertices whose motion is prescribed: their present velocity says nothing about it.
    pub pinned: &'a [bool],
    /// Contact offset of the cloth (m).
    pub offset: f64,
    /// Time that features are expected to move for at twice their present speed (s).
    pub time: f64,
    /// Shortest path expected of a feature, even if it is at rest (m): forces may accelerate it.
    pub min_path: f64,
}

impl Reach<'_> {
    /// The same reach for all pairs (m).
    pub fn uniform(reach: f64) -> Self {
        Self {
            max: reach,
            ahead: None,
        }
    }

    /// Reach of two features (m): the contact offset and twice the path of the fastest of their vertices, relative
    /// to the mean velocity of the four and at twice that speed. It is the largest reach where a vertex is
    /// prescribed.
    pub fn of(&self, pair: FeaturePair) -> f64 {
        let Some(ahead) = &self.ahead else {
            return self.max;
        };
        let vertices = pair.vertices();
        if vertices.iter().any(|&v| ahead.pinned[v as usize]) {
            return self.max;
        }
        let v = vertices.map(|v| ahead.velocities[v as usize]);
        let mean = (v[0] + v[1] + v[2] + v[3]) / 4.0;
        let fastest = v.iter().map(|v| (v - mean).norm_squared());
        let speed = fastest.fold(0.0, f64::max).sqrt();
        let path = (2.0 * speed * ahead.time).max(ahead.min_path);
        (ahead.offset + 2.0 * path).min(self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reach_follows_relative_speed_within_its_limits() {
        let pair = FeaturePair::VertexFace([0, 1, 2, 3]);
        let reach_at = |velocities: &[Vec3; 4], pinned: &[bool; 4]| {
            let ahead = Ahead {
                velocities,
                pinned,
                offset: 2e-3,
                time: 5e-3,
                min_path: 2e-4,
            };
            let ahead = Some(ahead);
            Reach { max: 6e-3, ahead }.of(pair)
        };
        let reach = |velocities: &[Vec3; 4]| reach_at(velocities, &[false; 4]);
        let common = Vec3::new(3.0, -2.0, 1.0);
        let with = |own: f64| [common + Vec3::y() * own, common, common, common];
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(
            near(reach(&with(0.0)), 2.4e-3),
            "a common motion brings features no nearer"
        );
        // Three quarters of the speed against the mean, twice, for both.
        assert!(near(reach(&with(0.1)), 2e-3 + 4.0 * 0.075 * 5e-3));
        assert!(
            near(reach(&with(9.0)), 6e-3),
            "never more than the largest reach"
        );
        let prescribed = reach_at(&with(0.0), &[false, false, true, false]);
        assert!(
            near(prescribed, 6e-3),
            "a prescribed vertex may take any path"
        );
        assert!(near(Reach::uniform(4e-3).of(pair), 4e-3));
    }
}
