//! Contact of cloth with cloth in substeps: found once in a few of them, kept as planes meanwhile.

use super::contact::{ContactStencil, Touch};
use super::{Xpbd, XpbdReport, middle};
use crate::collision::{Ahead, ClothContact, ClothContacts, Kept, Motions, Reach};
use crate::laws::contact::HARDER;
use crate::{DrapeError, Model, State};
use toile_geometry::Vec3;

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

/// How far the fastest vertex may go, the motion of the whole cloth left out, before contacts are
/// looked for anew [m]: at the most, and where everything is slow. What is looked for reaches twice
/// as far beyond the offset at the most.
const LOOK_AGAIN: f64 = 2e-3;
const LEAST_WAY: f64 = 5e-4;

/// Share of the way of the fastest vertex that any may go whatever its speed is now: what moves pushes what
/// does not.
const UNFORESEEN: f64 = 0.25;

/// Time that contacts are to serve at twice the speed of the fastest vertex [s]: forces are not known ahead.
const SERVES: f64 = 5e-3;

/// Longest time that they are kept where all is slow [s].
const LONGEST: f64 = 1.0 / 60.0;

/// Substeps between two looks, at the least.
const FEWEST: u32 = 2;

/// Contacts of cloth with cloth as they were last found.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClothWatch {
    /// The contacts.
    pub contacts: ClothContacts,
    /// How far the fastest vertex may have gone since [m]; none before the first look.
    travelled: Option<f64>,
    /// How far it may go before the next look [m].
    allowed: f64,
    /// Time since [s].
    time: f64,
    /// Positions before the last substeps [m], and how far they went.
    before: Vec<Vec3>,
    moves: Vec<Vec3>,
    lightness: Vec<f64>,
}

impl ClothWatch {
    /// Looks anew at the next step.
    pub fn forget(&mut self) {
        self.travelled = None;
    }

    /// How long contacts are kept [s].
    fn longest(&self) -> f64 {
        match self.allowed > LEAST_WAY {
            true => SERVES,
            false => LONGEST,
        }
    }

    /// Corrects the way of the last substeps, `span` [s] long, where cloth would have passed through cloth.
    fn keep_apart(&mut self, model: &Model, state: &mut State, span: f64) {
        let ways = state.positions.iter().zip(&self.before);
        self.moves.clear();
        self.moves.extend(ways.map(|(x, from)| x - from));
        let masses = model.mass.iter().zip(&model.pinned);
        self.lightness.clear();
        self.lightness
            .extend(masses.map(|(m, &pinned)| if pinned { 0.0 } else { 1.0 / m }));
        let mut motion = Motions {
            x: &self.before,
            moves: &mut self.moves,
            velocities: &mut state.velocities,
            lightness: &self.lightness,
            span,
        };
        let kept = self.contacts.keep_apart(model, &mut motion);
        if kept != Kept::default() {
            let ends = self.before.iter().zip(&self.moves);
            for (x, (from, way)) in state.positions.iter_mut().zip(ends) {
                *x = from + way;
            }
        }
    }
}

/// Time in which something goes a way [m] that moves at a speed [m/s] and falls freely [m/s2].
fn falling(way: f64, speed: f64, gravity: f64) -> f64 {
    2.0 * way / (speed + (speed * speed + 2.0 * gravity * way).sqrt())
}

/// Speed of the fastest vertex, the mean velocity left out [m/s].
fn spread(state: &State) -> f64 {
    let count = state.velocities.len().max(1) as f64;
    let mean = state.velocities.iter().sum::<Vec3>() / count;
    let speed2 = state.velocities.iter().map(|v| (v - mean).norm_squared());
    speed2.fold(0.0, f64::max).sqrt()
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
        let origin = middle(&state.positions);
        self.forget_surfaces();
        let mut left = span.count;
        let mut report = XpbdReport::default();
        let mut pieces = 1;
        let gravity = model.gravity.norm();
        while left > 0 {
            let fewest = f64::from(FEWEST) * span.substep;
            let speed = spread(state) + gravity * fewest;
            let ahead = watch.travelled.map(|t| t + speed * fewest);
            let longest = watch.longest();
            if ahead.is_none_or(|far| far > watch.allowed) || watch.time + fewest > longest {
                watch.allowed = (2.0 * speed * SERVES).clamp(LEAST_WAY, LOOK_AGAIN);
                let kept = model.contact.cloth_offset;
                let reach = Reach {
                    // Two vertices may come nearer by twice the way.
                    most: kept + 2.0 * watch.allowed,
                    ahead: Some(Ahead {
                        velocities: &state.velocities,
                        kept,
                        pinned: &model.pinned,
                        time: SERVES.max(fewest),
                        least: LEAST_WAY.max(UNFORESEEN * watch.allowed),
                    }),
                };
                watch.contacts.find(model, state, &state.positions, &reach);
                watch.contacts.remember(state);
                watch.travelled = Some(0.0);
                watch.time = 0.0;
                self.touch_cloth(&watch.contacts.active, 2.0 * watch.allowed);
            }
            let travelled = watch.travelled.unwrap_or(0.0);
            let time = falling((watch.allowed - travelled).max(0.0), speed, gravity);
            let time = time.min(watch.longest() - watch.time);
            let count = ((time / span.substep) as u32).max(FEWEST).min(left);
            watch.before.clone_from(&state.positions);
            report = self.advance_about(model, state, origin, &Span { count, ..*span })?;
            watch.keep_apart(model, state, span.substep * f64::from(count));
            pieces = pieces.max(report.pieces);
            let time = span.substep * f64::from(count);
            watch.travelled = Some(travelled + speed.max(spread(state)) * time);
            watch.time += time;
            left -= count;
        }
        report.pieces = pieces;
        Ok(report)
    }

    /// Holds contacts of cloth with cloth from here on, in place of those held before: those that may give
    /// way to their hard depth before the next look, `way` [m] ahead, as two.
    fn touch_cloth(&mut self, contacts: &[ClothContact], way: f64) {
        let slot_of = &self.order.slot_of;
        let stencil = |contact: &ClothContact, depth: f64, stiffness: f64| {
            let plane = &contact.plane;
            ContactStencil {
                vertices: contact.vertices.map(|v| slot_of[v as usize]),
                weights: contact.weights.map(|w| w as f32),
                touch: Touch {
                    normal: [0, 1, 2].map(|k| plane.normal[k] as f32),
                    level: (depth + plane.normal.dot(&plane.point)) as f32,
                    softness: (1.0 / stiffness).min(1e30) as f32,
                    friction: contact.law.friction as f32,
                    ..Touch::none()
                },
                restitution: contact.restitution.map(|e| e as f32),
            }
        };
        let stencils = contacts.iter().flat_map(|contact| {
            let (depth, law) = (contact.plane.depth, &contact.law);
            let soft = stencil(contact, depth, law.normal);
            let hard = depth + way > law.hard_from;
            let hard = hard.then(|| stencil(contact, depth - law.hard_from, HARDER * law.normal));
            std::iter::once(soft).chain(hard)
        });
        let held = &mut self.regions.rest.contacts;
        held.truncate(self.sample_contacts);
        held.extend(stencils);
    }
}
