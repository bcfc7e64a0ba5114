//! The interface of methods, and their closed list. Those that garments and scenes use are made in [`crate::methods`],
//! those for comparison in crate `reference`.
//!
//! # Decided with
//! - [`crate::methods`]: makes a method from its kind: a rule and a solver, a scheme, or one of its own;
//! - [`crate::methods`] (`guard.rs`, `Guarded`): wraps every method: refuses states that are not finite,
//!   undoes failed steps;
//! - [`crate::methods`] (`rules.rs`), [`crate::methods::implicit::Solver`],
//!   [`crate::methods::explicit::Scheme`]: what a method is composed of;
//! - [`crate::method::MethodKind::supports`] (`features.rs`): features that a method lacks; the remaining
//!   ones it is taken to have;
//! - [`crate::memory::Memory`]: what a method remembers from step to step; anything it keeps elsewhere is
//!   lost when a run is resumed;
//! - [`crate::scene_run::SceneRun`]: runs a scene by the method, builds it anew after merges and edits;
//! - [`crate::scene_run::SceneRun::has_checkpoints`]: methods that have no checkpoints, by name.
//!
//! The compiler asks a new kind for its family, its maker and its largest number of iterations. By hand:
//! `balances_forces` and the functions of `Method` have defaults; tests list methods in
//! `reference/tests/suite` and `lab/src/laws`, a page in `docs/methods/integrators.md`.

use crate::collision::Tally;
use crate::{DrapeError, State, System};
use strum::{EnumCount, VariantArray, VariantNames};

/// Cost of one step of a method.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Substeps into which the step was divided after a failure; 1 without one.
    pub pieces: u32,
    /// Iterations of the method's outer loop (Newton, local-global, sweeps, substeps).
    pub iterations: usize,
    /// Iterations of linear solvers.
    pub linear_iterations: usize,
}

/// A time integrator or equilibrium solver.
///
/// It owns its workspace; its memory from step to step is in the [`State`], so that a saved state continues bit for bit
/// with a fresh method. There are two exceptions. With
/// contact of cloth with cloth `xpbd` stores the front of its last search, which decides which distant pairs the next
/// search skips. `implicit-midpoint` stores a bound of the energy of its run, and refuses a step with more than ten
/// times as much.
pub trait Method: Send {
    /// Advances the state by `step` (s). Equilibrium methods take one iteration; their time does
    /// not run and `step` is ignored.
    ///
    /// # Errors
    /// A failed step, with vertex and stage; the state is then unchanged.
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError>;

    /// Whether an equilibrium method has reached its residual; false for methods in time.
    fn finished(&self) -> bool {
        false
    }

    /// Counts of contact of cloth with cloth so far; none where the method has no such counts.
    fn cloth_tally(&self) -> Option<Tally> {
        None
    }

    /// Whether it supports attachments to points of moving solids; other methods refuse a system with such attachments.
    fn follows_frames(&self) -> bool {
        false
    }

    /// Net force over weight after the last step; none where the method does not compute it.
    fn residual(&self) -> Option<f64> {
        None
    }

    /// Most iterations in a (sub)step; none for explicit methods, which do not iterate, and for equilibrium methods,
    /// whose iterations are their steps.
    fn most_iterations(&self) -> Option<usize> {
        None
    }
}

/// Makes a method of given settings, without memory of a run: [`MethodSettings::build`] those of garments and scenes,
/// the function `build` of crate `reference` every one.
///
/// # Errors
/// A method that the builder does not have.
pub type MethodBuilder = fn(&MethodSettings) -> Result<Box<dyn Method>, DrapeError>;

/// The closed list of methods.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, EnumCount, VariantArray, VariantNames,
)]
#[strum(serialize_all = "kebab-case")]
pub enum MethodKind {
    /// Forward Euler: explicit, order 1, never stable without damping.
    ForwardEuler,
    /// Symplectic Euler: explicit, order 1.
    SymplecticEuler,
    /// Velocity Verlet: explicit, order 2.
    VelocityVerlet,
    /// The classical Runge-Kutta method: explicit, order 4.
    #[strum(serialize = "runge-kutta-4")]
    RungeKutta4,
    /// Velocity Verlet in patches, for cloth with linear laws: explicit, order 2, fast.
    PatchVerlet,
    /// Semi-implicit Euler: one linear solve a step (Baraff and Witkin 1998), order 1.
    SemiImplicitEuler,
    /// Implicit Euler by full Newton with line search.
    #[default]
    ImplicitEuler,
    /// The two-step backward differentiation formula: implicit, order 2, little damping.
    Bdf2,
    /// Implicit midpoint: order 2, no damping.
    ImplicitMidpoint,
    /// Projective dynamics with Anderson acceleration on implicit Euler.
    ProjectiveDynamics,
    /// L-BFGS from the metric of projective dynamics on implicit Euler.
    Lbfgs,
    /// Vertex block descent (Chen et al. 2024) on implicit Euler.
    VertexBlockDescent,
    /// Vertex block descent with Chebyshev acceleration.
    ChebyshevBlockDescent,
    /// Dynamic relaxation with kinetic damping: equilibrium without a linear system; time does not advance.
    DynamicRelaxation,
    /// Equilibrium by pseudo-transient continuation; time does not advance.
    Rest,
    /// Extended position based dynamics: [`crate::Xpbd`].
    Xpbd,
}

impl MethodKind {
    /// All methods with their names in files.
    pub const ALL: [(&'static str, Self); Self::COUNT] = toile_geometry::named_variants!();

    /// Its name in files.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(_, kind)| *kind == self)
            .map_or("", |(name, _)| name)
    }

    /// Whether the method converges to states with balanced forces of the model, so that net force over weight measures
    /// the distance from equilibrium. `xpbd` does not: its unconverged constraints act as additional compliance, and
    /// its friction has no anchors.
    pub fn balances_forces(self) -> bool {
        self != Self::Xpbd
    }

    /// The family of the method.
    fn family(self) -> Family {
        match self {
            Self::ForwardEuler => Family::Explicit { limit: 0.0 },
            Self::SymplecticEuler | Self::VelocityVerlet | Self::PatchVerlet => {
                Family::Explicit { limit: 2.0 }
            }
            Self::RungeKutta4 => Family::Explicit {
                limit: 2.0 * std::f64::consts::SQRT_2,
            },
            Self::SemiImplicitEuler
            | Self::ImplicitEuler
            | Self::Bdf2
            | Self::ImplicitMidpoint
            | Self::ProjectiveDynamics
            | Self::Lbfgs
            | Self::VertexBlockDescent
            | Self::ChebyshevBlockDescent => Family::Implicit,
            Self::Xpbd => Family::Constraints,
            Self::DynamicRelaxation | Self::Rest => Family::Equilibrium,
        }
    }

    /// Largest stable product of angular frequency and substep of an undamped vibration: none for implicit methods,
    /// which have no limit, and 0 for forward Euler.
    pub fn stability_limit(self) -> Option<f64> {
        match self.family() {
            Family::Explicit { limit } => Some(limit),
            Family::Implicit | Family::Constraints | Family::Equilibrium => None,
        }
    }

    /// Names of the fields of [`MethodSettings`] that it uses.
    pub fn settings(self) -> &'static [&'static str] {
        match self.family() {
            Family::Explicit { .. } => &["substeps"],
            Family::Constraints => &["substeps", "iterations"],
            Family::Equilibrium => &["iterations", "tolerance"],
            Family::Implicit => &["substeps", "iterations", "tolerance"],
        }
    }

    /// Whether it computes equilibrium instead of motion in time.
    pub fn is_equilibrium(self) -> bool {
        matches!(self.family(), Family::Equilibrium)
    }
}

/// Families of methods.
enum Family {
    /// Explicit in time; stable while angular frequency times substep is below the limit.
    Explicit { limit: f64 },
    /// Each substep minimises a potential.
    Implicit,
    /// Constraints solved one after the other.
    Constraints,
    /// Equilibrium; time does not advance.
    Equilibrium,
}

/// A method with its settings; fields that are none have the method's default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MethodSettings {
    /// The method.
    pub kind: MethodKind,
    /// Substeps of a step; explicit methods without a number take as many as the largest frequency at the start of each
    /// step needs (at 0.9 of their stability limit).
    pub substeps: Option<u32>,
    /// Most iterations in a (sub)step.
    pub iterations: Option<usize>,
    /// Where iterations stop: norm of the gradient (N) in time, net force over weight for rest.
    pub tolerance: Option<f64>,
}

/// Net force over weight at which equilibrium methods end by default.
const REST_RESIDUAL: f64 = 1e-3;

impl MethodSettings {
    /// Net force over weight at which an equilibrium method ends.
    pub fn rest_residual(&self) -> f64 {
        self.tolerance.unwrap_or(REST_RESIDUAL)
    }
}

impl From<MethodKind> for MethodSettings {
    fn from(kind: MethodKind) -> Self {
        Self {
            kind,
            ..Self::default()
        }
    }
}
