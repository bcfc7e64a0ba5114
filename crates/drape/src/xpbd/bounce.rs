//! Restitution: an impact leaves with a fraction e of its normal speed.
//!
//! Positions and velocities are corrected separately (Volino et al. 1996; Müller et al. 2020, section 3.6):
//! constraints correct positions, and the normal relative velocity after an impact is set to -e times the one
//! before, whatever velocity the position correction implies. Contacts that share points are solved together by
//! Gauss-Seidel sweeps of normal impulses, which are never attractive in sum.

use super::contact::{ContactConstraint, ContactStencil, NO_SAMPLE};
use super::particles::Particles;
use crate::ContactSample;
use crate::lanes::{LANES, Point};

/// Gauss-Seidel sweeps over the impacts.
const SWEEPS: usize = 8;

/// Impacts slower than the free fall of so many substeps have no restitution, so that resting contacts do not
/// vibrate.
const RESTING_SUBSTEPS: f32 = 2.0;

/// A contact with a normal impulse in the substep.
struct Impact {
    slots: [u32; 4],
    weights: [f32; 4],
    normal: [f32; 3],
    /// Inverse effective mass along the normal: sum of a^2 / m over its points (1/kg).
    inverse_mass: f32,
    /// Speed of the surface along the normal (m/s).
    surface_speed: f32,
    /// Accumulated normal impulse (N s).
    impulse: f32,
    /// Coefficient of restitution e; none where no material gives one.
    restitution: Option<f32>,
    /// Normal relative speed after the impact (m/s).
    target_speed: f32,
}

impl Impact {
    /// From a contact of the substep; surface speed and impulse are still multiplied by the substep.
    fn new(
        particles: &Particles,
        (slots, weights): ([u32; 4], [f32; 4]),
        contact: &ContactConstraint,
        restitution: Option<f32>,
    ) -> Option<Self> {
        let points = slots.iter().zip(weights);
        let inverse_mass: f32 = points
            .map(|(&slot, a)| a * a * particles.start[slot as usize][3])
            .sum();
        (contact.lambda_normal > 0.0 && inverse_mass > 0.0).then(|| Self {
            slots,
            weights,
            normal: contact.normal,
            inverse_mass,
            surface_speed: (0..3)
                .map(|k| contact.normal[k] * contact.surface_displacement[k])
                .sum(),
            impulse: contact.lambda_normal,
            restitution,
            target_speed: 0.0,
        })
    }

    /// Relative speed along the normal (m/s); negative while approaching.
    fn speed(&self, velocity: &[Point]) -> f32 {
        let mut speed = -self.surface_speed;
        for (&slot, a) in self.slots.iter().zip(self.weights) {
            let v = velocity[slot as usize];
            speed += a * (0..3).map(|k| self.normal[k] * v[k]).sum::<f32>();
        }
        speed
    }

    /// Applies an impulse (N s) along the normal; the inverse masses are those of `points`.
    fn apply_impulse(&self, impulse: f32, points: &[Point], velocity: &mut [Point]) {
        for (&slot, a) in self.slots.iter().zip(self.weights) {
            let share = impulse * a * points[slot as usize][3];
            for k in 0..3 {
                velocity[slot as usize][k] += self.normal[k] * share;
            }
        }
    }
}

/// Parameters of a substep.
#[derive(Clone, Copy)]
pub struct BounceStep {
    /// Substep (s).
    pub step: f32,
    /// Acceleration of gravity (m/s2).
    pub gravity: f32,
}

/// Sets the normal velocities after the impacts of a substep. `stencils` are lists of contacts with the first slot
/// of their region, from which their points are numbered.
pub fn bounce<'a>(
    samples: &[ContactSample],
    stencils: impl Iterator<Item = (usize, &'a [ContactStencil])>,
    particles: &mut Particles,
    step: BounceStep,
) {
    let mut impacts = Vec::new();
    for (block, contacts) in particles.contacts.iter().enumerate() {
        for lane in contacts.loaded() {
            let contact = contacts.get(lane);
            let slot = (block * LANES + lane) as u32;
            let point = ([slot; 4], [1.0, 0.0, 0.0, 0.0]);
            impacts.extend(Impact::new(
                particles,
                point,
                &contact,
                sample_restitution(samples, &contact),
            ));
        }
    }
    let stencils =
        stencils.flat_map(|(first, run)| run.iter().map(move |stencil| (first, stencil)));
    for (first, stencil) in stencils.filter(|(_, stencil)| stencil.constraint.lambda_normal > 0.0) {
        let restitution = match stencil.constraint.sample {
            NO_SAMPLE => stencil.restitution,
            _ => sample_restitution(samples, &stencil.constraint),
        };
        let slots = stencil.vertices.map(|v| v + first as u32);
        let points = (slots, stencil.weights);
        impacts.extend(Impact::new(
            particles,
            points,
            &stencil.constraint,
            restitution,
        ));
    }
    let Particles {
        start,
        velocity,
        velocity_without_contact,
        ..
    } = particles;
    velocity_without_contact.clone_from(velocity);
    for impact in &mut impacts {
        impact.surface_speed /= step.step;
        impact.impulse /= step.step;
        impact.apply_impulse(-impact.impulse, start, velocity_without_contact);
    }
    let resting_speed = RESTING_SUBSTEPS * step.gravity * step.step;
    impacts.retain_mut(|impact| {
        let before = impact.speed(velocity_without_contact);
        let Some(restitution) = impact.restitution else {
            return false;
        };
        impact.target_speed = if before < -resting_speed {
            -restitution * before
        } else {
            before.max(0.0)
        };
        true
    });
    for _ in 0..SWEEPS {
        for impact in &mut impacts {
            let correction = (impact.target_speed - impact.speed(velocity)) / impact.inverse_mass;
            let change = correction.max(-impact.impulse);
            impact.impulse += change;
            impact.apply_impulse(change, start, velocity);
        }
    }
}

fn sample_restitution(samples: &[ContactSample], contact: &ContactConstraint) -> Option<f32> {
    let sample = samples.get(contact.sample as usize)?;
    sample.restitution.map(|e| e as f32)
}
