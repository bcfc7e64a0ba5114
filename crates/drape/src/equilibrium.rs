//! A garment that hangs at rest and stays alive: it says at once where it goes when its rest shapes change,
//! and goes on from there.

use crate::newton::FirstOrder;
use crate::{DrapeError, PseudoTransientContinuation, RestSettings, State, System, Workspace};
use toile_geometry::{Vec2, Vec3};

/// A system at rest with all that led there: the last factor of its matrix, pseudo step and kept curvature.
pub struct Equilibrium {
    pub(crate) system: System,
    pub(crate) state: State,
    pub(crate) workspace: Workspace,
    pub(crate) continuation: PseudoTransientContinuation,
    pub(crate) settings: RestSettings,
    /// The triangle of the panels for each of the surface: those that seams collapsed are none.
    pub(crate) merged: Vec<usize>,
}

/// Where a garment goes when its rest shapes change, to first order. It is shown, never replayed.
pub struct Prediction {
    /// The system with the other rest shapes.
    system: System,
    step: FirstOrder,
}

impl Prediction {
    /// Where the vertices come to lie [m].
    pub fn positions(&self) -> &[Vec3] {
        &self.step.positions
    }

    /// Energy above the new rest as the step measures it [J]: half the square of Newton's decrement.
    pub fn energy(&self) -> f64 {
        self.step.promised
    }

    /// Share of the step that contact, the longest move and the potential let it take, 0..=1.
    pub fn share(&self) -> f64 {
        self.step.share
    }

    /// The system with the other rest shapes.
    pub fn system(&self) -> &System {
        &self.system
    }
}

impl Equilibrium {
    /// What is simulated.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// How it lies.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// How often the structure of its matrix was worked out.
    pub fn structures(&self) -> usize {
        self.workspace.structures()
    }

    /// Net force over weight after the last step.
    pub fn residual(&self) -> f64 {
        self.continuation.residual()
    }

    /// Its system with another rest shape for each triangle of the panels [m].
    ///
    /// # Errors
    /// As [`System::reshaped`].
    pub fn reshaped(&self, rest: &[[Vec2; 3]]) -> Result<System, DrapeError> {
        let merged = self.merged.iter().filter_map(|&t| rest.get(t).copied());
        self.system.reshaped("garment", merged.collect())
    }

    /// Where it goes to first order with another rest shape for each triangle of the panels [m]: one gradient
    /// and one solution with the last factor. Nothing of it changes but its caches.
    ///
    /// # Errors
    /// As [`System::reshaped`]; numbers that are not finite.
    pub fn predict(&mut self, rest: &[[Vec2; 3]]) -> Result<Prediction, DrapeError> {
        let system = self.reshaped(rest)?;
        let step = self.workspace.first_order(
            &system,
            &self.state,
            self.continuation.pseudo_step(),
            self.settings.longest_move,
        );
        match step {
            Some(step) => Ok(Prediction { system, step }),
            None => Err(DrapeError::NotFinite {
                stage: "prediction of a drape",
                vertex: self.state.first_not_finite().unwrap_or(0),
            }),
        }
    }

    /// Goes on from what was predicted: it is at rest no longer.
    pub fn take(&mut self, prediction: Prediction) {
        self.system = prediction.system;
        self.state.follow_shapes(&self.system);
        self.state.positions = prediction.step.positions;
        self.continuation
            .continue_to(self.settings.residual, self.settings.steps);
    }

    /// Takes so many steps towards rest at the most; whether it is there.
    ///
    /// # Errors
    /// As [`PseudoTransientContinuation::advance`].
    pub fn correct(&mut self, steps: usize) -> Result<bool, DrapeError> {
        for _ in 0..steps {
            if self.is_at_rest() {
                break;
            }
            self.continuation
                .advance(&self.system, &mut self.state, &mut self.workspace)?;
        }
        Ok(self.is_at_rest())
    }

    /// Whether its net force is below what was asked for.
    pub fn is_at_rest(&self) -> bool {
        self.continuation.residual() <= self.settings.residual
    }
}
