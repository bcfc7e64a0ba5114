//! Contact of cloth with cloth in substeps: found once in a few of them, kept as planes meanwhile.

use super::contact::{ContactStencil, Touch};
use super::{Xpbd, XpbdReport};
use crate::collision::{ClothContact, ClothContacts};
use crate::{DrapeError, Model, State};

/// Some substeps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Substep [s].
    pub substep: f64,
    /// How many.
    pub count: u32,
    /// Drag per mass [1/s].
    pub drag: f64,
}

/// How far the fastest vertex may go before contacts are looked for anew [m].
const LOOK_AGAIN: f64 = 3e-3;

/// Substeps between two looks, at the least.
const FEWEST: u32 = 4;

/// Farther than by where it goes, a pair is kept when it is nearer than this beyond its offset [m].
const MARGIN: f64 = 1e-3;

impl Xpbd {
    /// [`Xpbd::advance`] with contact of cloth with cloth, where the model has it.
    pub(crate) fn advance_touching(
        &mut self,
        model: &Model,
        state: &mut State,
        cloth: &mut ClothContacts,
        span: &Span,
    ) -> Result<XpbdReport, DrapeError> {
        if model.contact.cloth_offset <= 0.0 {
            return self.advance(model, state, span.substep, span.count, span.drag);
        }
        let mut left = span.count;
        let mut report = XpbdReport::default();
        let mut pieces = 1;
        while left > 0 {
            let speed = state.velocities.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt()
                + model.gravity.norm() * span.substep * f64::from(FEWEST);
            let count = (LOOK_AGAIN / (speed * span.substep)).clamp(f64::from(FEWEST), 1e6) as u32;
            let count = count.min(left);
            let time = span.substep * f64::from(count);
            let reach = model.contact.cloth_offset + MARGIN + 2.0 * speed * time;
            cloth.find(model, state, &state.positions, reach);
            let kept = |contact: &&ClothContact| comes_near(contact, state, model, time);
            let contacts: Vec<ClothContact> = cloth.active.iter().filter(kept).copied().collect();
            self.take_up(model);
            self.touch_cloth(&contacts);
            report = self.advance(model, state, span.substep, count, span.drag)?;
            pieces = pieces.max(report.pieces);
            left -= count;
        }
        // Contacts of these substeps do not hold in the next.
        self.touch_cloth(&[]);
        report.pieces = pieces;
        Ok(report)
    }

    /// Holds contacts of cloth with cloth from here on, in place of those held before.
    fn touch_cloth(&mut self, contacts: &[ClothContact]) {
        let slot_of = &self.order.slot_of;
        let stencils = contacts.iter().map(|contact| {
            let plane = &contact.plane;
            ContactStencil {
                vertices: contact.vertices.map(|v| slot_of[v as usize]),
                weights: contact.weights.map(|w| w as f32),
                touch: Touch {
                    normal: [0, 1, 2].map(|k| plane.normal[k] as f32),
                    level: (plane.depth + plane.normal.dot(&plane.point)) as f32,
                    softness: (1.0 / contact.law.normal).min(1e30) as f32,
                    friction: contact.law.friction as f32,
                    ..Touch::none()
                },
            }
        });
        let held = &mut self.regions.rest.contacts;
        held.truncate(self.sample_contacts);
        held.extend(stencils);
    }
}

/// Whether a pair comes within its offset in a time [s] if it goes on as it does.
fn comes_near(contact: &ClothContact, state: &State, model: &Model, time: f64) -> bool {
    let four = contact.vertices.into_iter().zip(contact.weights);
    let opening: f64 = four
        .map(|(v, w)| w * contact.plane.normal.dot(&state.velocities[v as usize]))
        .sum();
    let drop = model.gravity.norm() * time * time;
    contact.plane.depth + MARGIN + drop + 2.0 * (-opening * time).max(0.0) > 0.0
}
