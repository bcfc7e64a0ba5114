//! Implicit Euler with full Newton and line search.

use super::{Method, MethodSettings, StepReport};
use crate::{DrapeError, Model, NewtonSettings, State, StepSettings, Workspace, step_in_time};

/// Implicit Euler: see [`step_in_time`].
pub struct ImplicitEuler {
    settings: StepSettings,
    substeps: u32,
    workspace: Workspace,
}

impl ImplicitEuler {
    /// With what the settings leave open at its defaults.
    pub fn new(settings: &MethodSettings) -> Self {
        let defaults = StepSettings::default();
        let newton = NewtonSettings {
            iterations: settings.iterations.unwrap_or(defaults.newton.iterations),
            tolerance: settings.tolerance.unwrap_or(defaults.newton.tolerance),
            ..defaults.newton
        };
        Self {
            settings: StepSettings { newton, ..defaults },
            substeps: settings.substeps.unwrap_or(1).max(1),
            workspace: Workspace::default(),
        }
    }
}

impl Method for ImplicitEuler {
    fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        let start = state.clone();
        let settings = StepSettings {
            step: step / f64::from(self.substeps),
            drag: model.air_drag,
            ..self.settings
        };
        let mut total = StepReport::default();
        for _ in 0..self.substeps {
            match step_in_time(model, state, &mut self.workspace, &settings) {
                Ok((report, pieces)) => {
                    total.pieces = total.pieces.max(pieces);
                    total.iterations += report.iterations;
                    total.linear_iterations += report.linear_iterations;
                }
                Err(error) => {
                    *state = start;
                    return Err(error);
                }
            }
        }
        Ok(total)
    }
}
