//! Restitution: what hits comes back with a share of its speed.
//!
//! Positions and velocities are corrected apart (Volino et al. 1996; Müller et al. 2020, section 3.6):
//! contacts move points to where they belong, and the normal relative velocity after is -e times the
//! one before, whatever speed that move would give. Contacts that share a point are gone through
//! together, each by impulses along its normal that never pull.

use super::contact::{ContactConstraint, ContactStencil, NO_SAMPLE};
use super::particles::Particles;
use crate::ContactSample;
use crate::lanes::{LANES, Point};

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
    surface_speed: f32,
    /// Impulse so far [N s].
    impulse: f32,
    /// Share of the speed that comes back, where it is said.
    share: Option<f32>,
    /// Speed along the normal that it leaves with [m/s].
    leaving: f32,
}

impl Hit {
    /// From what a contact did, speed of the surface and impulse still times the substep.
    fn new(
        particles: &Particles,
        (slots, weights): ([u32; 4], [f32; 4]),
        contact: &ContactConstraint,
        share: Option<f32>,
    ) -> Option<Self> {
        let each = slots.iter().zip(weights);
        let yielding: f32 = each
            .map(|(&slot, a)| a * a * particles.start[slot as usize][3])
            .sum();
        (contact.lambda_normal > 0.0 && yielding > 0.0).then(|| Self {
            slots,
            weights,
            normal: contact.normal,
            yielding,
            surface_speed: (0..3)
                .map(|k| contact.normal[k] * contact.surface_displacement[k])
                .sum(),
            impulse: contact.lambda_normal,
            share,
            leaving: 0.0,
        })
    }

    fn speed(&self, velocity: &[Point]) -> f32 {
        let mut speed = -self.surface_speed;
        for (&slot, a) in self.slots.iter().zip(self.weights) {
            let v = velocity[slot as usize];
            speed += a * (0..3).map(|k| self.normal[k] * v[k]).sum::<f32>();
        }
        speed
    }

    /// Adds an impulse [N s] along the normal; `points` hold inverse masses.
    fn push(&self, impulse: f32, points: &[Point], velocity: &mut [Point]) {
        for (&slot, a) in self.slots.iter().zip(self.weights) {
            let share = impulse * a * points[slot as usize][3];
            for k in 0..3 {
                velocity[slot as usize][k] += self.normal[k] * share;
            }
        }
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
    samples: &[ContactSample],
    stencils: impl Iterator<Item = (usize, &'a [ContactStencil])>,
    particles: &mut Particles,
    step: BounceStep,
) {
    let mut hits = Vec::new();
    for (block, contacts) in particles.contacts.iter().enumerate() {
        for lane in contacts.pressed() {
            let contact = contacts.get(lane);
            let slot = (block * LANES + lane) as u32;
            let one = ([slot; 4], [1.0, 0.0, 0.0, 0.0]);
            hits.extend(Hit::new(
                particles,
                one,
                &contact,
                restitution(samples, &contact),
            ));
        }
    }
    let each = stencils.flat_map(|(first, run)| run.iter().map(move |stencil| (first, stencil)));
    for (first, stencil) in each.filter(|(_, stencil)| stencil.constraint.lambda_normal > 0.0) {
        let share = match stencil.constraint.sample {
            NO_SAMPLE => stencil.restitution,
            _ => restitution(samples, &stencil.constraint),
        };
        let slots = stencil.vertices.map(|v| v + first as u32);
        let four = (slots, stencil.weights);
        hits.extend(Hit::new(particles, four, &stencil.constraint, share));
    }
    let Particles {
        start,
        velocity,
        without,
        ..
    } = particles;
    without.clone_from(velocity);
    for hit in &mut hits {
        hit.surface_speed /= step.step;
        hit.impulse /= step.step;
        hit.push(-hit.impulse, start, without);
    }
    let quiet = QUIET_SUBSTEPS * step.gravity * step.step;
    hits.retain_mut(|hit| {
        let before = hit.speed(without);
        let Some(share) = hit.share else {
            return false;
        };
        hit.leaving = if before < -quiet {
            -share * before
        } else {
            before.max(0.0)
        };
        true
    });
    for _ in 0..ROUNDS {
        for hit in &mut hits {
            let wanted = (hit.leaving - hit.speed(velocity)) / hit.yielding;
            let change = wanted.max(-hit.impulse);
            hit.impulse += change;
            hit.push(change, start, velocity);
        }
    }
}

fn restitution(samples: &[ContactSample], contact: &ContactConstraint) -> Option<f32> {
    let sample = samples.get(contact.sample as usize)?;
    sample.restitution.map(|e| e as f32)
}
