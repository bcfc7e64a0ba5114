//! The guard around every method: states that are not finite are refused, failed steps undone, results checked.
//!
//! # Decided with
//! - [`crate::methods::implicit::Implicit::advance_in_pieces`]: an implicit step that fails is divided;
//! - [`crate::xpbd::Xpbd::advance_about`], [`crate::xpbd::Xpbd::advance_with_cloth_contact`] (`cloth.rs`): a
//!   step of XPBD that fails is divided;
//! - [`crate::step::step_in_time`]: a step of sewing that fails is undone and halved;
//! - [`crate::kinetic_damping::KineticDamping::advance`]: a round of the swing that fails is undone;
//! - [`crate::pseudo_transient::PseudoTransientContinuation::advance`]: a step to rest that fails is undone
//!   and taken shorter;
//! - [`crate::scene_run::SceneRun::apply_edit`], [`crate::world::Simulation::edit_all`]: a failed edit leaves
//!   the run as it was;
//! - [`crate::time_settings::TimeSettings`], [`crate::methods::explicit::Explicit::substep_count`],
//!   [`crate::pseudo_transient::PseudoTransientContinuation::adapt`]: how long a step is.
//!
//! A run that slows down is given up by crate `session`, `pace.rs`.

use crate::incremental_potential::relax;
use crate::method::{Method, StepReport};
use crate::{DrapeError, State, System};

/// A method whose steps either end with a finite state or leave the state unchanged.
pub struct Guarded<M> {
    method: M,
    start: State,
}

impl<M: Method + 'static> Guarded<M> {
    /// Wraps a method.
    pub fn boxed(method: M) -> Box<dyn Method> {
        Box::new(Self {
            method,
            start: State::default(),
        })
    }
}

impl<M: Method> Method for Guarded<M> {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        if let Some(vertex) = state.first_not_finite() {
            let stage = "start of a step";
            return Err(DrapeError::NotFinite { stage, vertex });
        }
        if !system.control.frames.is_empty() && !self.method.follows_frames() {
            return Err(DrapeError::Scene {
                place: "attachments".to_owned(),
                what: "the method knows no attachments to solids that move".to_owned(),
                remedy: "attach cloth to places, or use xpbd".to_owned(),
            });
        }
        if !system.control.ties.is_empty() && !self.method.follows_frames() {
            return Err(DrapeError::Scene {
                place: "attachments".to_owned(),
                what: "the method knows no attachments within triangles or to surfaces that bend"
                    .to_owned(),
                remedy: "attach vertices of cloth to places, or use xpbd".to_owned(),
            });
        }
        self.start.clone_from(state);
        // Within the pool: from outside of it every parallel part of the step would wake a thread and wait for it.
        let method = &mut self.method;
        let result = rayon::scope(|_| method.advance(system, state, step));
        if result.is_ok() {
            relax(system, state, state.time - self.start.time);
        }
        let result = match (result, state.first_not_finite()) {
            (Ok(_), Some(vertex)) => {
                let stage = "end of a step";
                Err(DrapeError::NotFinite { stage, vertex })
            }
            (result, _) => result,
        };
        if result.is_err() {
            state.clone_from(&self.start);
        }
        result
    }

    fn finished(&self) -> bool {
        self.method.finished()
    }

    fn residual(&self) -> Option<f64> {
        self.method.residual()
    }

    fn most_iterations(&self) -> Option<usize> {
        self.method.most_iterations()
    }

    fn cloth_tally(&self) -> Option<crate::collision::Tally> {
        self.method.cloth_tally()
    }
}
