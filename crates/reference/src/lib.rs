//! Methods of the literature, for comparison: no garment uses them, and a scene only where it gives their name.
//!
//! Their names, what each supports and what is refused with them are in crate `drape`, so that a remedy can name any
//! method; only what they compute is here.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod block_descent;
mod colours;
mod descent;
mod forward_euler;
mod lbfgs;
mod metric;
mod patches;
mod pieces;
mod projective;
mod relaxation;
mod runge_kutta;
mod symplectic_euler;

use block_descent::BlockDescent;
use forward_euler::ForwardEuler;
use lbfgs::Lbfgs;
use patches::PatchVerlet;
use projective::Projective;
use relaxation::Relaxation;
use runge_kutta::RungeKutta4;
use symplectic_euler::SymplecticEuler;
use toile_drape::methods::explicit::Explicit;
use toile_drape::methods::implicit::Implicit;
use toile_drape::methods::{Euler, Guarded, VelocityVerlet};
use toile_drape::{DrapeError, Method, MethodKind, MethodSettings};

/// A new method without memory of a run, any of the list: a [`toile_drape::MethodBuilder`].
///
/// # Errors
/// Those of [`MethodSettings::build`], which makes the methods that are not for comparison.
pub fn build(settings: &MethodSettings) -> Result<Box<dyn Method>, DrapeError> {
    Ok(match settings.kind {
        MethodKind::ForwardEuler => Guarded::boxed(Explicit::<ForwardEuler>::new(settings)),
        MethodKind::SymplecticEuler => Guarded::boxed(Explicit::<SymplecticEuler>::new(settings)),
        MethodKind::RungeKutta4 => Guarded::boxed(Explicit::<RungeKutta4>::new(settings)),
        MethodKind::PatchVerlet => {
            let fallback = Explicit::<VelocityVerlet>::new(settings);
            Guarded::boxed(PatchVerlet::new(settings, Box::new(fallback)))
        }
        MethodKind::ProjectiveDynamics => {
            Guarded::boxed(Implicit::<Euler, Projective>::new(settings))
        }
        MethodKind::Lbfgs => Guarded::boxed(Implicit::<Euler, Lbfgs>::new(settings)),
        MethodKind::VertexBlockDescent => {
            Guarded::boxed(Implicit::<Euler, BlockDescent<false>>::new(settings))
        }
        MethodKind::ChebyshevBlockDescent => {
            Guarded::boxed(Implicit::<Euler, BlockDescent<true>>::new(settings))
        }
        MethodKind::DynamicRelaxation => Guarded::boxed(Relaxation::new(settings)),
        MethodKind::VelocityVerlet
        | MethodKind::SemiImplicitEuler
        | MethodKind::ImplicitEuler
        | MethodKind::Bdf2
        | MethodKind::ImplicitMidpoint
        | MethodKind::Rest
        | MethodKind::Xpbd => return settings.build(),
    })
}
