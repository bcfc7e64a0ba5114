//! Velocity Verlet: order 2, bounded energy error for all time below the stability limit.

use super::explicit::{Scheme, forces, forces_and_update_friction};
use crate::{State, System, Workspace};
use toile_geometry::Vec3;

/// v_1/2 = v + h/2 (f(x) / m - c v),  x' = x + h v_1/2,
/// v' = (v_1/2 + h/2 f(x') / m) / (1 + c h/2)
/// (Swope, Andersen, Berens and Wilson 1982; drag by the trapezoidal rule, so the order stays 2).
///
/// Stable while h w < 2. One force evaluation a substep, and one more a step.
#[derive(Default)]
pub struct VelocityVerlet {
    force: Vec<Vec3>,
}

impl Scheme for VelocityVerlet {
    const STAGE: &'static str = "velocity Verlet";
    const LIMIT: f64 = 2.0;

    fn begin(&mut self, system: &System, state: &State, workspace: &mut Workspace, h: f64) {
        self.force.clear();
        self.force.extend(forces(system, state, workspace, h));
    }

    fn substep(&mut self, system: &System, state: &mut State, workspace: &mut Workspace, h: f64) {
        let half = 0.5 * h;
        let decay = 1.0 - system.control.air_drag * half;
        let moving = state.positions.iter_mut().zip(&mut state.velocities);
        for ((x, v), (f, m)) in moving.zip(self.force.iter().zip(&system.rest.mass)) {
            *v = *v * decay + f * (half / m);
            *x += *v * h;
        }
        let drag_factor = 1.0 / (1.0 + system.control.air_drag * half);
        self.force
            .copy_from_slice(forces_and_update_friction(system, state, workspace, h));
        for (v, (f, m)) in state
            .velocities
            .iter_mut()
            .zip(self.force.iter().zip(&system.rest.mass))
        {
            *v = (*v + f * (half / m)) * drag_factor;
        }
    }
}
