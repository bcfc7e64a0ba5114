//! Forward Euler (Euler 1768): order 1, and unstable for every undamped vibration.

use toile_drape::methods::explicit::{Scheme, forces_and_update_friction};
use toile_drape::{State, System, Workspace};

/// x' = x + h v,  v' = v + h (f(x, v) / m - c v).
///
/// An undamped vibration grows by sqrt(1 + h^2 w^2) a step; with damping c it is stable while
/// h <= c / w^2. It is here to show its instability in charts. Automatic substeps are those of
/// symplectic Euler.
#[derive(Default)]
pub struct ForwardEuler;

impl Scheme for ForwardEuler {
    const STAGE: &'static str = "forward Euler";
    const LIMIT: f64 = 2.0;

    fn substep(&mut self, system: &System, state: &mut State, workspace: &mut Workspace, h: f64) {
        let force = forces_and_update_friction(system, state, workspace, h);
        let moving = state.positions.iter_mut().zip(&mut state.velocities);
        for ((x, v), (f, m)) in moving.zip(force.iter().zip(&system.rest.mass)) {
            let acceleration = f / *m - *v * system.control.air_drag;
            *x += *v * h;
            *v += acceleration * h;
        }
    }
}
