//! Methods: one trait with a whole step in it, chosen once by name from a closed list.
//!
//! # Decided with
//! - [`crate::methods::newton_solver::Newton::LIMITS`], [`crate::methods::newton_solver::OneSolve::LIMITS`]:
//!   iterations and residual of Newton's method and of one solve;
//! - [`crate::reference::projective`], [`crate::reference::lbfgs`], [`crate::reference::block_descent`]:
//!   limits of the methods for comparison;
//! - [`crate::method::MethodSettings`]: iterations and substeps that a user may set, by family;
//! - [`crate::methods::implicit`] (`CONVERGED_RESIDUAL`): how exactly an implicit step is solved;
//! - [`crate::xpbd::XpbdSettings`]: substeps and iterations of XPBD;
//! - [`crate::methods::rest::Rest::new`]: how a scene is brought to rest;
//! - [`crate::sew::SewRun::advance`], [`crate::pseudo_transient::PseudoTransientContinuation::advance`]:
//!   iterations of a garment.

mod energy;
pub(crate) mod explicit;
mod frequency;
mod guard;
pub(crate) mod implicit;
mod newton_solver;
mod rest;
mod rules;
mod velocity_verlet;

pub use energy::whole_energy;
pub(crate) use energy::{energy_bound, is_possible_speed};
pub(crate) use frequency::damped_contact_frequency;
pub use frequency::largest_frequency;

use crate::method::{Method, MethodKind, MethodSettings};
use crate::patches::PatchVerlet;
use crate::reference::block_descent::BlockDescent;
use crate::reference::lbfgs::Lbfgs;
use crate::reference::projective::Projective;
use crate::reference::{forward_euler, relaxation, runge_kutta, symplectic_euler};
use explicit::Explicit;
use guard::Guarded;
use implicit::{Implicit, Solver};
use newton_solver::{Newton, OneSolve};

impl MethodKind {
    /// Most iterations in a (sub)step where the settings give none; none for explicit methods, which do not iterate,
    /// and for equilibrium methods, whose iterations are their steps.
    pub fn most_iterations(self) -> Option<usize> {
        match self {
            Self::ImplicitEuler => Some(Newton::<false>::LIMITS.iterations),
            Self::Bdf2 | Self::ImplicitMidpoint => Some(Newton::<true>::LIMITS.iterations),
            Self::SemiImplicitEuler => Some(OneSolve::LIMITS.iterations),
            Self::ProjectiveDynamics => Some(Projective::LIMITS.iterations),
            Self::Lbfgs => Some(Lbfgs::LIMITS.iterations),
            Self::VertexBlockDescent => Some(BlockDescent::<false>::LIMITS.iterations),
            Self::ChebyshevBlockDescent => Some(BlockDescent::<true>::LIMITS.iterations),
            Self::Xpbd => Some(crate::XpbdSettings::default().iterations as usize),
            Self::ForwardEuler
            | Self::SymplecticEuler
            | Self::VelocityVerlet
            | Self::RungeKutta4
            | Self::PatchVerlet
            | Self::DynamicRelaxation
            | Self::Rest => None,
        }
    }
}

impl MethodSettings {
    /// A new method without memory of a run.
    pub fn build(&self) -> Box<dyn Method> {
        match self.kind {
            MethodKind::ForwardEuler => {
                Guarded::boxed(Explicit::<forward_euler::ForwardEuler>::new(self))
            }
            MethodKind::SymplecticEuler => {
                Guarded::boxed(Explicit::<symplectic_euler::SymplecticEuler>::new(self))
            }
            MethodKind::VelocityVerlet => {
                Guarded::boxed(Explicit::<velocity_verlet::VelocityVerlet>::new(self))
            }
            MethodKind::RungeKutta4 => {
                Guarded::boxed(Explicit::<runge_kutta::RungeKutta4>::new(self))
            }
            MethodKind::PatchVerlet => {
                let fallback = Explicit::<velocity_verlet::VelocityVerlet>::new(self);
                Guarded::boxed(PatchVerlet::new(self, Box::new(fallback)))
            }
            MethodKind::SemiImplicitEuler => {
                Guarded::boxed(Implicit::<rules::Euler, OneSolve>::new(self))
            }
            MethodKind::Bdf2 => Guarded::boxed(Implicit::<rules::Bdf2, Newton<true>>::new(self)),
            MethodKind::ImplicitMidpoint => {
                Guarded::boxed(Implicit::<rules::Midpoint, Newton<true>>::new(self))
            }
            MethodKind::ProjectiveDynamics => {
                Guarded::boxed(Implicit::<rules::Euler, Projective>::new(self))
            }
            MethodKind::Lbfgs => Guarded::boxed(Implicit::<rules::Euler, Lbfgs>::new(self)),
            MethodKind::VertexBlockDescent => {
                Guarded::boxed(Implicit::<rules::Euler, BlockDescent<false>>::new(self))
            }
            MethodKind::ChebyshevBlockDescent => {
                Guarded::boxed(Implicit::<rules::Euler, BlockDescent<true>>::new(self))
            }
            MethodKind::DynamicRelaxation => Guarded::boxed(relaxation::Relaxation::new(self)),
            MethodKind::ImplicitEuler => {
                Guarded::boxed(Implicit::<rules::Euler, Newton<false>>::new(self))
            }
            MethodKind::Rest => Guarded::boxed(rest::Rest::new(self)),
            MethodKind::Xpbd => Guarded::boxed(crate::xpbd::XpbdMethod::new(self)),
        }
    }
}
