//! How far a look for contacts goes: as far as two features may come nearer before the next one.

use super::feature_pair::FeaturePair;
use toile_geometry::Vec3;

/// How far a look goes.
#[derive(Clone, Copy, Debug)]
pub struct Reach<'a> {
    /// Features farther apart than this are none of its contacts [m].
    pub most: f64,
    /// What is known of the time until the next look; nothing where all within the most count.
    pub ahead: Option<Ahead<'a>>,
}

/// The time until the next look.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<'a> {
    /// Of the vertices now [m/s].
    pub velocities: &'a [Vec3],
    /// Which of them are held, and may be led anywhere.
    pub pinned: &'a [bool],
    /// Distance that is kept [m].
    pub kept: f64,
    /// How long features may go on at twice their speed [s].
    pub time: f64,
    /// How far a feature may go in it that does not move now [m]: forces are not known ahead.
    pub least: f64,
}

impl Reach<'_> {
    /// The same for all features [m].
    pub fn all(most: f64) -> Self {
        Self { most, ahead: None }
    }

    /// That of two features [m]: twice as far beyond what is kept as the fastest of their vertices goes at
    /// twice its speed, their common motion left out; the most where one is held.
    pub fn of(&self, pair: FeaturePair) -> f64 {
        let Some(ahead) = &self.ahead else {
            return self.most;
        };
        let vertices = pair.vertices();
        if vertices.iter().any(|&v| ahead.pinned[v as usize]) {
            return self.most;
        }
        let v = vertices.map(|v| ahead.velocities[v as usize]);
        let mean = (v[0] + v[1] + v[2] + v[3]) / 4.0;
        let fastest = v.iter().map(|v| (v - mean).norm_squared());
        let speed = fastest.fold(0.0, f64::max).sqrt();
        let way = (2.0 * speed * ahead.time).max(ahead.least);
        (ahead.kept + 2.0 * way).min(self.most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_goes_as_far_as_features_may_come_nearer() {
        let pair = FeaturePair::VertexFace([0, 1, 2, 3]);
        let held_at = |velocities: &[Vec3; 4], pinned: &[bool; 4]| {
            let ahead = Ahead {
                velocities,
                pinned,
                kept: 2e-3,
                time: 5e-3,
                least: 2e-4,
            };
            let ahead = Some(ahead);
            Reach { most: 6e-3, ahead }.of(pair)
        };
        let reach = |velocities: &[Vec3; 4]| held_at(velocities, &[false; 4]);
        let drift = Vec3::new(3.0, -2.0, 1.0);
        let with = |own: f64| [drift + Vec3::y() * own, drift, drift, drift];
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(
            near(reach(&with(0.0)), 2.4e-3),
            "a common motion brings nothing nearer"
        );
        // Three quarters of the speed against the mean, twice, for both.
        assert!(near(reach(&with(0.1)), 2e-3 + 4.0 * 0.075 * 5e-3));
        assert!(near(reach(&with(9.0)), 6e-3), "no farther than the most");
        let led = held_at(&with(0.0), &[false, false, true, false]);
        assert!(near(led, 6e-3), "what is held may be led");
        assert!(near(Reach::all(4e-3).of(pair), 4e-3));
    }
}
