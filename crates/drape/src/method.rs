//! Methods: one trait with a whole step in it, chosen once by name from a closed list.

use crate::{
    DrapeError, Model, NewtonSettings, RestRun, RestSettings, State, StepSettings, Workspace,
    step_in_time,
};

/// What one step of a method took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Pieces the step had to be cut into because it failed whole; 1 when it did not.
    pub pieces: u32,
    /// Iterations of the method's outer loop (Newton, local-global, sweeps, substeps).
    pub iterations: usize,
    /// Iterations of linear solvers inside it.
    pub linear_iterations: usize,
}

/// A time integrator or equilibrium solver.
///
/// It owns its workspace; everything it must remember from step to step to go on is in the
/// [`State`], so that a saved state continues bit for bit with a fresh method.
pub trait Method: Send {
    /// Advances the state by `step` [s]. Equilibrium methods take one iteration; their time does
    /// not run and `step` is ignored.
    ///
    /// # Errors
    /// Names vertex and stage; the state is then as it was before.
    fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError>;

    /// Whether the method has nothing more to do: an equilibrium method at the residual asked
    /// for. Methods in time never have.
    fn finished(&self) -> bool {
        false
    }

    /// Net force over weight after the last step, where the method knows it.
    fn residual(&self) -> Option<f64> {
        None
    }
}

/// The closed list of methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MethodKind {
    /// Implicit Euler by full Newton with line search.
    #[default]
    ImplicitEuler,
    /// Straight to rest by pseudo-transient continuation; time does not run.
    Rest,
}

impl MethodKind {
    /// Every method with its name in files.
    pub const ALL: [(&'static str, Self); 2] = [
        ("implicit-euler", Self::ImplicitEuler),
        ("rest", Self::Rest),
    ];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(_, kind)| *kind == self)
            .map_or("", |(name, _)| name)
    }

    /// Whether it looks for rest rather than running in time.
    pub fn is_equilibrium(self) -> bool {
        matches!(self, Self::Rest)
    }
}

/// A method with its settings; what is not given is the method's own default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MethodSettings {
    /// Which method.
    pub kind: MethodKind,
    /// Substeps a step is cut into.
    pub substeps: Option<u32>,
    /// Iterations in a (sub)step at the most.
    pub iterations: Option<usize>,
    /// Where iterations stop: norm of the gradient [N] in time, net force over weight for rest.
    pub tolerance: Option<f64>,
}

impl From<MethodKind> for MethodSettings {
    fn from(kind: MethodKind) -> Self {
        Self {
            kind,
            ..Self::default()
        }
    }
}

impl MethodSettings {
    /// The method, its memory still empty.
    pub fn build(&self) -> Box<dyn Method> {
        match self.kind {
            MethodKind::ImplicitEuler => Box::new(ImplicitEuler::new(self)),
            MethodKind::Rest => Box::new(Rest::new(self)),
        }
    }
}

/// Implicit Euler: see [`step_in_time`].
struct ImplicitEuler {
    settings: StepSettings,
    substeps: u32,
    workspace: Workspace,
}

impl ImplicitEuler {
    fn new(settings: &MethodSettings) -> Self {
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

/// The way to rest: see [`RestRun`].
struct Rest {
    run: RestRun,
    workspace: Workspace,
}

impl Rest {
    fn new(settings: &MethodSettings) -> Self {
        Self {
            run: RestRun::new(RestSettings {
                residual: settings.tolerance.unwrap_or(1e-3),
                steps: settings.iterations.unwrap_or(2000),
                ..RestSettings::default()
            }),
            workspace: Workspace::default(),
        }
    }
}

impl Method for Rest {
    fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        _step: f64,
    ) -> Result<StepReport, DrapeError> {
        let before = self.run.linear_iterations();
        self.run.advance(model, state, &mut self.workspace)?;
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
