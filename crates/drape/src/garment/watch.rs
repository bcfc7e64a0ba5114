//! What a garment's run is watched for: cloth that fell off the body, and a net force that no longer falls.

use super::GarmentRun;
use crate::DrapeError;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Cloth whose highest point is lower than this share of the body's height is off it, if it fell there.
const LOWEST_HOLD: f64 = 0.3;
/// Share of the body's height that it then fell by at least.
const FALLEN: f64 = 0.25;

/// Net force over weight above which a garment that settles must go on falling to it.
const STUCK_ABOVE: f64 = 100.0;
/// Steps in which it must fall by half.
const STUCK_STEPS: usize = 1000;

/// Memory of how the net force falls while a garment settles.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Fall {
    /// Net force over weight that the next half is counted from, and the step it was reached in.
    mark: Option<(f64, usize)>,
    /// Whether it stayed above the limit without falling by half.
    pub is_stuck: bool,
}

impl Fall {
    /// Notes the net force over weight after a step.
    pub fn note(&mut self, residual: f64, step: usize) {
        match self.mark {
            Some((mark, since)) if residual > 0.5 * mark => {
                self.is_stuck = residual > STUCK_ABOVE && step >= since + STUCK_STEPS;
            }
            _ => self.mark = Some((residual, step)),
        }
    }

    /// Notes that the steps are used up: what is far from rest is stuck.
    pub fn end(&mut self, residual: f64) {
        self.is_stuck |= residual > STUCK_ABOVE;
    }
}

impl GarmentRun {
    /// Refuses a garment of which a part that hangs together fell off the body: it is lower than a body holds cloth,
    /// and far below where it was placed.
    pub(super) fn refuse_fallen(&self) -> Result<(), DrapeError> {
        let skin = self
            .setup
            .colliders
            .iter()
            .flat_map(|c| &c.mesh().positions);
        let [low, high] = extent(skin.map(|p| p.y));
        let height = high - low;
        if !height.is_finite() || height <= 0.0 {
            return Ok(());
        }
        let cloth = &self.setup.levels[self.level].cloth;
        let target = self.target();
        // The highest point of each part that hangs together, now and as it was placed.
        let mut tops = Parts::new(self.state.positions.len());
        for triangle in &cloth.triangles {
            let [a, b, c] = triangle.map(|v| target[v as usize] as usize);
            tops.join(a, b);
            tops.join(a, c);
        }
        for &v in cloth.triangles.iter().flatten() {
            let merged = target[v as usize] as usize;
            tops.raise(
                merged,
                [self.state.positions[merged], cloth.positions[v as usize]],
            );
        }
        let fell = tops.highest.iter().find(|[now, placed]| {
            *now < low + LOWEST_HOLD * height && placed - now > FALLEN * height
        });
        match fell {
            Some([now, _]) => Err(DrapeError::LeftBody { top: now - low }),
            None => Ok(()),
        }
    }

    /// The net force on each merged vertex (N) of a garment that was given up because it stayed far from rest; none of
    /// another.
    pub fn forces_of_stuck(&mut self) -> Option<Vec<f64>> {
        if !self.is_stuck() {
            return None;
        }
        let Self {
            simulation,
            workspace,
            ..
        } = self;
        let net = workspace.net_force(&simulation.system, &simulation.state);
        Some(net.iter().map(Vec3::norm).collect())
    }
}

fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(none, |[low, high], x| [low.min(x), high.max(x)])
}

/// Parts of a cloth that hang together with their highest points, now and as placed (m).
struct Parts {
    parent: Vec<usize>,
    highest: Vec<[f64; 2]>,
}

impl Parts {
    fn new(count: usize) -> Self {
        Self {
            parent: (0..count).collect(),
            highest: vec![[f64::INFINITY; 2]; count],
        }
    }

    fn root(&mut self, mut member: usize) -> usize {
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }

    /// Counts a point; parts without one stay infinitely high.
    fn raise(&mut self, member: usize, points: [Vec3; 2]) {
        let root = self.root(member);
        for (highest, point) in self.highest[root].iter_mut().zip(points) {
            *highest = match highest.is_finite() {
                true => highest.max(point.y),
                false => point.y,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_net_force_that_falls_by_half_in_time_is_not_stuck() {
        let mut fall = Fall::default();
        for step in 0..2000 {
            fall.note(1e5 * 0.5f64.powf(step as f64 / 140.0), step);
            assert!(!fall.is_stuck, "{step}");
        }
    }

    #[test]
    fn what_is_far_from_rest_when_its_steps_are_used_up_is_stuck() {
        for (residual, is_stuck) in [(4000.0, true), (3.0, false)] {
            let mut fall = Fall::default();
            fall.note(residual, 399);
            fall.end(residual);
            assert_eq!(fall.is_stuck, is_stuck, "{residual}");
        }
    }

    #[test]
    fn a_large_net_force_that_stays_is_stuck_and_a_small_one_is_not() {
        let [mut large, mut small] = [Fall::default(), Fall::default()];
        for step in 0..=STUCK_STEPS {
            assert!(!large.is_stuck, "{step}");
            large.note(3000.0 + (step % 7) as f64, step);
            small.note(50.0, step);
        }
        assert!(large.is_stuck && !small.is_stuck);
    }
}
