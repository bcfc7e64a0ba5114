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
const LOOK_AGAIN: f64 = 2e-3;

/// Longest time that contacts are kept [s]: forces are not known ahead.
const LONGEST: f64 = 5e-3;

/// Substeps between two looks, at the least.
const FEWEST: u32 = 2;

/// Contacts of cloth with cloth as they were last found.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClothWatch {
    /// The contacts.
    pub contacts: ClothContacts,
    /// How far the fastest vertex may have gone since [m]; none before the first look.
    travelled: Option<f64>,
    /// Time since [s].
    time: f64,
}

impl ClothWatch {
    /// Looks anew at the next step, whatever was found before.
    pub fn forget(&mut self) {
        self.travelled = None;
    }
}

impl Xpbd {
    /// [`Xpbd::advance`] with contact of cloth with cloth, where the model has it.
    pub(crate) fn advance_touching(
        &mut self,
        model: &Model,
        state: &mut State,
        watch: &mut ClothWatch,
        span: &Span,
    ) -> Result<XpbdReport, DrapeError> {
        if model.contact.cloth_offset <= 0.0 {
            return self.advance(model, state, span.substep, span.count, span.drag);
        }
        self.take_up(model);
        let mut left = span.count;
        let mut report = XpbdReport::default();
        let mut pieces = 1;
        while left > 0 {
            let fewest = f64::from(FEWEST) * span.substep;
            let speed2 = state.velocities.iter().map(|v| v.norm_squared());
            let speed = speed2.fold(0.0, f64::max).sqrt() + model.gravity.norm() * fewest;
            let ahead = watch.travelled.map(|t| t + speed * fewest);
            if ahead.is_none_or(|far| far > LOOK_AGAIN) || watch.time + fewest > LONGEST {
                // Two vertices may come nearer by twice the way.
                let reach = model.contact.cloth_offset + 2.0 * LOOK_AGAIN;
                watch.contacts.find(model, state, &state.positions, reach);
                watch.travelled = Some(0.0);
                watch.time = 0.0;
                self.touch_cloth(&watch.contacts.active);
            }
            let travelled = watch.travelled.unwrap_or(0.0);
            let time = ((LOOK_AGAIN - travelled) / speed).min(LONGEST - watch.time);
            let count = ((time / span.substep) as u32).max(FEWEST).min(left);
            report = self.advance(model, state, span.substep, count, span.drag)?;
            pieces = pieces.max(report.pieces);
            let time = span.substep * f64::from(count);
            watch.travelled = Some(travelled + speed.max(report.fastest) * time);
            watch.time += time;
            left -= count;
        }
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
