//! A garment at rest under changes of its rest shapes: a prediction of the new equilibrium to first order, and its
//! correction by pseudo-transient continuation.

use crate::newton::FirstOrder;
use crate::{DrapeError, PseudoTransientContinuation, RestSettings, State, System, Workspace};
use toile_geometry::{Vec2, Vec3};

/// A system at rest with the memory of the solver: the last factor, the pseudo step and the share of negative
/// curvature.
pub struct Equilibrium {
    pub(crate) system: System,
    pub(crate) state: State,
    pub(crate) workspace: Workspace,
    pub(crate) continuation: PseudoTransientContinuation,
    pub(crate) settings: RestSettings,
    /// For each triangle of the merged surface its triangle of the panels.
    pub(crate) merged: Vec<usize>,
}

/// The new equilibrium under other rest shapes, to first order.
pub struct Prediction {
    /// The system with the other rest shapes.
    system: System,
    step: FirstOrder,
}

impl Prediction {
    /// Predicted positions of the vertices (m).
    pub fn positions(&self) -> &[Vec3] {
        &self.step.positions
    }

    /// Energy above the new equilibrium in the quadratic model (J): half the square of Newton's decrement.
    pub fn energy(&self) -> f64 {
        self.step.predicted_decrease
    }

    /// Share of the Newton step that is left by step truncation, the longest displacement and the line search, 0..=1.
    pub fn share(&self) -> f64 {
        self.step.share
    }

    /// The system with the other rest shapes.
    pub fn system(&self) -> &System {
        &self.system
    }
}

impl Equilibrium {
    /// The system.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Number of symbolic factorisations so far.
    pub fn structures(&self) -> usize {
        self.workspace.symbolic_factorisations()
    }

    /// Net force over weight after the last step.
    pub fn residual(&self) -> f64 {
        self.continuation.residual()
    }

    /// The system with other rest shapes for the triangles of the panels (m).
    ///
    /// # Errors
    /// Those of [`System::reshaped`].
    pub fn reshaped(&self, rest: &[[Vec2; 3]]) -> Result<System, DrapeError> {
        let merged = self.merged.iter().filter_map(|&t| rest.get(t).copied());
        self.system.reshaped("garment", merged.collect())
    }

    /// Predicts the equilibrium under other rest shapes for the triangles of the panels (m), by one gradient and one
    /// solution with the last factor. Only caches change.
    ///
    /// # Errors
    /// Those of [`System::reshaped`]; numbers that are not finite.
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

    /// Takes over a prediction as the present state, which is then to be corrected.
    pub fn take(&mut self, prediction: Prediction) {
        self.system = prediction.system;
        self.state.follow_shapes(&self.system);
        self.state.positions = prediction.step.positions;
        self.continuation
            .continue_to(self.settings.residual, self.settings.steps);
    }

    /// Takes at most `steps` steps to equilibrium; returns whether it is reached.
    ///
    /// # Errors
    /// Those of [`PseudoTransientContinuation::advance`].
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

    /// Whether the residual is that of the settings or less.
    pub fn is_at_rest(&self) -> bool {
        self.continuation.residual() <= self.settings.residual
    }
}
