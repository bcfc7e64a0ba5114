//! Equilibrium by pseudo-transient continuation, as a method.

use crate::method::{Method, MethodSettings, StepReport};
use crate::{
    DrapeError, Memory, PseudoTransientContinuation, RestSettings, State, System, Workspace,
};

/// Pseudo-transient continuation to equilibrium: see [`PseudoTransientContinuation`]. Its progress is stored in the
/// memory of the state.
pub struct Rest {
    settings: RestSettings,
    run: PseudoTransientContinuation,
    workspace: Workspace,
}

impl Rest {
    /// With the settings, and its defaults where they give none.
    pub fn new(settings: &MethodSettings) -> Self {
        let settings = RestSettings {
            residual: settings.rest_residual(),
            steps: settings.iterations.unwrap_or(2000),
            ..RestSettings::default()
        };
        Self {
            settings,
            run: PseudoTransientContinuation::new(settings),
            workspace: Workspace::default(),
        }
    }
}

impl Method for Rest {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        _step: f64,
    ) -> Result<StepReport, DrapeError> {
        self.run = match std::mem::take(&mut state.memory) {
            Memory::Rest(memory) => PseudoTransientContinuation::resume(self.settings, memory),
            _ => PseudoTransientContinuation::new(self.settings),
        };
        let before = self.run.linear_iterations();
        self.run.advance(system, state, &mut self.workspace)?;
        state.memory = Memory::Rest(self.run.memory().clone());
        Ok(StepReport {
            pieces: 1,
            iterations: 1,
            linear_iterations: self.run.linear_iterations() - before,
        })
    }

    fn finished(&self) -> bool {
        self.run.finished()
    }

    fn residual(&self) -> Option<f64> {
        Some(self.run.residual())
    }
}
