//! What a method is, and the closed list of them.

use crate::collision::Tally;
use crate::{DrapeError, State, System};

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
/// [`State`], so that a saved state continues bit for bit with a fresh method. There are two exceptions. With
/// contact of cloth with cloth `xpbd` stores the front of its last search, which decides which distant pairs the next
/// search skips. `implicit-midpoint` stores the energy that its run can have at most, and refuses a step that
/// exceeds ten times as much.
pub trait Method: Send {
    /// Advances the state by `step` [s]. Equilibrium methods take one iteration; their time does
    /// not run and `step` is ignored.
    ///
    /// # Errors
    /// Names vertex and stage; the state is then as it was before.
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError>;

    /// Whether the method has nothing more to do: an equilibrium method at the residual asked
    /// for. Methods in time never have.
    fn finished(&self) -> bool {
        false
    }

    /// What contact of cloth with cloth found and did so far, where the method counts it.
    fn cloth_tally(&self) -> Option<Tally> {
        None
    }

    /// Whether it draws vertices to points of solids that move; a system that asks another for that is refused.
    fn follows_frames(&self) -> bool {
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
    /// Forward Euler: explicit, order 1, never stable without damping.
    ForwardEuler,
    /// Symplectic Euler: explicit, order 1.
    SymplecticEuler,
    /// Velocity Verlet: explicit, order 2.
    VelocityVerlet,
    /// The classical Runge-Kutta method: explicit, order 4.
    RungeKutta4,
    /// The same in patches, for cloth of the plain laws: explicit, order 2, fast.
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
    /// The same with Chebyshev acceleration.
    ChebyshevBlockDescent,
    /// Dynamic relaxation with kinetic damping: to rest without any system; time does not run.
    DynamicRelaxation,
    /// Straight to rest by pseudo-transient continuation; time does not run.
    Rest,
    /// Extended position based dynamics: [`crate::Xpbd`].
    Xpbd,
}

impl MethodKind {
    /// Every method with its name in files. Kept by hand: a method that is not listed cannot be named in a file.
    pub const ALL: [(&'static str, Self); 16] = [
        ("forward-euler", Self::ForwardEuler),
        ("symplectic-euler", Self::SymplecticEuler),
        ("velocity-verlet", Self::VelocityVerlet),
        ("runge-kutta-4", Self::RungeKutta4),
        ("patch-verlet", Self::PatchVerlet),
        ("semi-implicit-euler", Self::SemiImplicitEuler),
        ("implicit-euler", Self::ImplicitEuler),
        ("bdf2", Self::Bdf2),
        ("implicit-midpoint", Self::ImplicitMidpoint),
        ("projective-dynamics", Self::ProjectiveDynamics),
        ("lbfgs", Self::Lbfgs),
        ("vertex-block-descent", Self::VertexBlockDescent),
        ("chebyshev-block-descent", Self::ChebyshevBlockDescent),
        ("dynamic-relaxation", Self::DynamicRelaxation),
        ("rest", Self::Rest),
        ("xpbd", Self::Xpbd),
    ];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(_, kind)| *kind == self)
            .map_or("", |(name, _)| name)
    }

    /// Whether the states it comes to balance the forces of the model: net force over weight then says how
    /// far from rest one is. `xpbd` leaves its constraints unsolved by some compliance of its own, and
    /// keeps friction in no anchor, so at its rest the model's forces are far from balanced.
    pub fn balances_forces(self) -> bool {
        self != Self::Xpbd
    }

    /// What kind of method it is.
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

    /// Largest stable product of angular frequency and substep of an undamped vibration; nothing
    /// for implicit methods, which have no limit, and for forward Euler 0.
    pub fn stability_limit(self) -> Option<f64> {
        match self.family() {
            Family::Explicit { limit } => Some(limit),
            Family::Implicit | Family::Constraints | Family::Equilibrium => None,
        }
    }

    /// The fields of [`MethodSettings`] that it has a use for, by their names.
    pub fn settings(self) -> &'static [&'static str] {
        match self.family() {
            Family::Explicit { .. } => &["substeps"],
            Family::Constraints => &["substeps", "iterations"],
            Family::Equilibrium => &["iterations", "tolerance"],
            Family::Implicit => &["substeps", "iterations", "tolerance"],
        }
    }

    /// Whether it looks for rest rather than running in time.
    pub fn is_equilibrium(self) -> bool {
        matches!(self.family(), Family::Equilibrium)
    }
}

/// Kinds of methods.
enum Family {
    /// Forces at known positions; stable while angular frequency times substep stays below the limit.
    Explicit { limit: f64 },
    /// Each substep minimises a potential.
    Implicit,
    /// Constraints solved one after the other.
    Constraints,
    /// To equilibrium; time does not run.
    Equilibrium,
}

/// A method with its settings; what is not given is the method's own default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MethodSettings {
    /// Which method.
    pub kind: MethodKind,
    /// Substeps a step is cut into; explicit methods left without take what the largest frequency
    /// at the start of each step asks for (0.9 of their limit).
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
