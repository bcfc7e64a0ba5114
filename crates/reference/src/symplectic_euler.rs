//! Symplectic (semi-explicit) Euler: order 1, bounded energy error for all time below the stability limit.

use toile_drape::methods::explicit::{Scheme, forces_and_update_friction};
use toile_drape::{State, System, Workspace};

/// v' = (v + h f(x) / m) / (1 + c h),  x' = x + h v'
/// (de Vogelaere 1956; Hairer, Lubich and Wanner 2006, I.1.9).
///
/// Stable while h w < 2. Drag is taken at the new velocity, so it never limits the step and the
/// terminal velocity is exact.
#[derive(Default)]
pub struct SymplecticEuler;

impl Scheme for SymplecticEuler {
    const STAGE: &'static str = "symplectic Euler";
    const LIMIT: f64 = 2.0;

    fn substep(&mut self, system: &System, state: &mut State, workspace: &mut Workspace, h: f64) {
        let drag_factor = 1.0 / (1.0 + system.control.air_drag * h);
        let force = forces_and_update_friction(system, state, workspace, h);
        let moving = state.positions.iter_mut().zip(&mut state.velocities);
        for ((x, v), (f, m)) in moving.zip(force.iter().zip(&system.rest.mass)) {
            *v = (*v + f * (h / m)) * drag_factor;
            *x += *v * h;
        }
    }
}
