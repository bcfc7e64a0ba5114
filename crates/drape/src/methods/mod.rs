//! Methods: those of garments and scenes, chosen once by name from a closed list, and the parts of which methods are
//! made.
//!
//! # Decided with
//! - [`crate::methods::implicit::Solver::LIMITS`], in [`crate::methods::newton_solver`]: iterations and residual of Newton's method and of one solve;
//! - [`crate::method::MethodSettings`]: iterations and substeps that a user may set, by family;
//! - [`crate::methods::implicit`] (`CONVERGED_RESIDUAL`): how exactly an implicit step is solved;
//! - [`crate::xpbd::XpbdSettings`]: substeps and iterations of XPBD;
//! - [`crate::methods::rest::Rest::new`]: how a scene is brought to rest;
//! - [`crate::sew::SewRun::advance`], [`crate::pseudo_transient::PseudoTransientContinuation::advance`]:
//!   iterations of a garment.
//!
//! Limits of the methods for comparison: crate `reference`.

mod energy;
pub mod explicit;
mod frequency;
mod guard;
pub mod implicit;
mod newton_solver;
mod rest;
mod rules;
mod velocity_verlet;

pub use energy::{energy_bound, is_possible_speed, whole_energy};
pub use frequency::{damped_contact_frequency, largest_frequency};
pub use guard::Guarded;
pub use rules::Euler;
pub use velocity_verlet::VelocityVerlet;

use crate::DrapeError;
use crate::method::{Method, MethodKind, MethodSettings};
use explicit::Explicit;
use implicit::Implicit;
use newton_solver::{Newton, OneSolve};

impl MethodSettings {
    /// A new method without memory of a run, of those that garments and scenes use.
    ///
    /// # Errors
    /// A method for comparison: crate `reference`, above this one, makes those.
    pub fn build(&self) -> Result<Box<dyn Method>, DrapeError> {
        self.own().ok_or_else(|| {
            let all = MethodKind::ALL.into_iter();
            let own = all.filter(|&(_, kind)| Self::from(kind).own().is_some());
            let names: Vec<_> = own.map(|(name, _)| name).collect();
            DrapeError::Scene {
                place: "method".to_owned(),
                what: format!(
                    "\"{}\" is a method for comparison, which this run cannot make",
                    self.kind.name()
                ),
                remedy: format!(
                    "give the run the builder of crate `reference`, or use one of {}",
                    names.join(", ")
                ),
            }
        })
    }

    /// The method; none where it is one for comparison.
    fn own(&self) -> Option<Box<dyn Method>> {
        Some(match self.kind {
            MethodKind::VelocityVerlet => Guarded::boxed(Explicit::<VelocityVerlet>::new(self)),
            MethodKind::SemiImplicitEuler => {
                Guarded::boxed(Implicit::<rules::Euler, OneSolve>::new(self))
            }
            MethodKind::Bdf2 => Guarded::boxed(Implicit::<rules::Bdf2, Newton<true>>::new(self)),
            MethodKind::ImplicitMidpoint => {
                Guarded::boxed(Implicit::<rules::Midpoint, Newton<true>>::new(self))
            }
            MethodKind::ImplicitEuler => {
                Guarded::boxed(Implicit::<rules::Euler, Newton<false>>::new(self))
            }
            MethodKind::Rest => Guarded::boxed(rest::Rest::new(self)),
            MethodKind::Xpbd => Guarded::boxed(crate::xpbd::XpbdMethod::new(self)),
            MethodKind::ForwardEuler
            | MethodKind::SymplecticEuler
            | MethodKind::RungeKutta4
            | MethodKind::PatchVerlet
            | MethodKind::ProjectiveDynamics
            | MethodKind::Lbfgs
            | MethodKind::VertexBlockDescent
            | MethodKind::ChebyshevBlockDescent
            | MethodKind::DynamicRelaxation => return None,
        })
    }
}
