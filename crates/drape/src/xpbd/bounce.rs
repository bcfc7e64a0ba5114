//! Restitution: what hits comes back with a share of its speed.
//!
//! Positions and velocities are corrected apart (Volino et al. 1996; Müller et al. 2020, section 3.6):
//! contacts move points to where they belong, and the normal relative velocity after is -e times the
//! one before, whatever speed that move would give. Contacts that share a point are gone through
//! together, each by impulses along its normal that never pull.

use super::contact::{ContactStencil, NO_SAMPLE, Touch};
use super::lanes::LANES;
use super::particles::Particles;
use crate::Model;

/// Rounds over contacts that share points.
const ROUNDS: usize = 8;

/// Speeds below that of so many substeps of falling do not bounce: cloth at rest must not hum.
const QUIET_SUBSTEPS: f32 = 2.0;

/// A contact that pressed in the substep.
struct Hit {
    slots: [u32; 4],
    weights: [f32; 4],
    normal: [f32; 3],
    /// Sum of a^2 / m [1/kg].
    yielding: f32,
    /// Speed of the surface along the normal [m/s].
    drift: f32,
    /// Impulse so far [N s].
    impulse: f32,
    /// Speed along the normal that it leaves with [m/s].
    leaving: f32,
}

impl Hit {
    fn speed(&self, velocity: &[[f32; 4]]) -> f32 {
        let mut speed = -self.drift;
        for (&slot, a) in self.slots.iter().zip(self.weights) {
            let v = velocity[slot as usize];
            speed += a * (0..3).map(|k| self.normal[k] * v[k]).sum::<f32>();
        }
        speed
    }
}

/// The numbers of a substep.
#[derive(Clone, Copy)]
pub struct BounceStep {
    /// Substep [s].
    pub step: f32,
    /// Acceleration of gravity [m/s2].
    pub gravity: f32,
}

/// Gives contacts that pressed in the substep the speed they leave with; `stencils` are runs of them
/// with the slot that their points are numbered from.
pub fn bounce<'a>(
    model: &Model,
    stencils: impl Iterator<Item = (usize, &'a [ContactStencil])>,
    particles: &mut Particles,
    step: BounceStep,
) {
    let mut hits = Vec::new();
    for (block, touches) in particles.touch.iter().enumerate() {
        for lane in touches.pressed() {
            let touch = touches.get(lane);
            let slot = (block * LANES + lane) as u32;
            let share = restitution(model, &touch);
            let one = ([slot; 4], [1.0, 0.0, 0.0, 0.0]);
            hits.extend(hit(particles, one, &touch, (share, step)));
        }
    }
    let each = stencils.flat_map(|(first, run)| run.iter().map(move |stencil| (first, stencil)));
    for (first, stencil) in each.filter(|(_, stencil)| stencil.touch.push > 0.0) {
        let share = match stencil.touch.sample {
            NO_SAMPLE => stencil.restitution,
            _ => restitution(model, &stencil.touch),
        };
        let slots = stencil.vertices.map(|v| v + first as u32);
        let four = (slots, stencil.weights);
        hits.extend(hit(particles, four, &stencil.touch, (share, step)));
    }
    for _ in 0..ROUNDS {
        for hit in &mut hits {
            let wanted = (hit.leaving - hit.speed(&particles.velocity)) / hit.yielding;
            let change = wanted.max(-hit.impulse);
            hit.impulse += change;
            for (&slot, a) in hit.slots.iter().zip(hit.weights) {
                let share = change * a * particles.start[slot as usize][3];
                let v = &mut particles.velocity[slot as usize];
                for k in 0..3 {
                    v[k] += hit.normal[k] * share;
                }
            }
        }
    }
}

fn restitution(model: &Model, touch: &Touch) -> f32 {
    match model.samples.get(touch.sample as usize) {
        Some(sample) => sample.restitution as f32,
        None => 0.0,
    }
}

/// A contact of some restitution, from what it did to the points it hangs on.
fn hit(
    particles: &Particles,
    (slots, weights): ([u32; 4], [f32; 4]),
    touch: &Touch,
    (share, step): (f32, BounceStep),
) -> Option<Hit> {
    let each = slots.iter().zip(weights);
    let yielding: f32 = each
        .map(|(&slot, a)| a * a * particles.start[slot as usize][3])
        .sum();
    if share <= 0.0 || touch.push <= 0.0 || yielding <= 0.0 {
        return None;
    }
    let drift = (0..3)
        .map(|k| touch.normal[k] * touch.drift[k])
        .sum::<f32>()
        / step.step;
    let mut hit = Hit {
        slots,
        weights,
        normal: touch.normal,
        yielding,
        drift,
        impulse: touch.push / step.step,
        leaving: 0.0,
    };
    let before = hit.speed(&particles.velocity) - yielding * hit.impulse;
    let quiet = QUIET_SUBSTEPS * step.gravity * step.step;
    hit.leaving = if before < -quiet {
        -share * before
    } else {
        before.max(0.0)
    };
    Some(hit)
}
