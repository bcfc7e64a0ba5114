//! The classical Runge-Kutta method: order 4.

use toile_drape::methods::explicit::{Scheme, forces, forces_and_update_friction};
use toile_drape::{State, System, Workspace};
use toile_geometry::Vec3;

/// With y = (x, v) and y' = F(y) = (v, f(x, v) / m - c v):
/// k1 = F(y), k2 = F(y + h/2 k1), k3 = F(y + h/2 k2), k4 = F(y + h k3),
/// y' = y + h/6 (k1 + 2 k2 + 2 k3 + k4)
/// (Kutta 1901; Hairer, Norsett and Wanner 1993, II.1).
///
/// Stable while h w < 2 sqrt 2, where it damps; four force evaluations a substep. Contact and
/// friction have kinks, across which the order falls to 1 or 2.
#[derive(Default)]
pub struct RungeKutta4 {
    start_positions: Vec<Vec3>,
    start_velocities: Vec<Vec3>,
    velocity_sum: Vec<Vec3>,
    acceleration_sum: Vec<Vec3>,
}

/// For each stage the fraction of h at which the next stage is evaluated, and the weight of its slope in the sum.
const STAGES: [(f64, f64); 4] = [
    (0.5, 1.0 / 6.0),
    (0.5, 1.0 / 3.0),
    (1.0, 1.0 / 3.0),
    (0.0, 1.0 / 6.0),
];

impl Scheme for RungeKutta4 {
    const STAGE: &'static str = "Runge-Kutta 4";
    const LIMIT: f64 = 2.0 * std::f64::consts::SQRT_2;

    fn substep(&mut self, system: &System, state: &mut State, workspace: &mut Workspace, h: f64) {
        self.start_positions.clone_from(&state.positions);
        self.start_velocities.clone_from(&state.velocities);
        for sum in [&mut self.velocity_sum, &mut self.acceleration_sum] {
            sum.clear();
            sum.resize(system.vertex_count(), Vec3::zeros());
        }
        for (stage, (along, weight)) in STAGES.into_iter().enumerate() {
            let force = if stage == 0 {
                forces_and_update_friction(system, state, workspace, h)
            } else {
                forces(system, state, workspace, h)
            };
            for (i, f) in force.iter().enumerate() {
                let v = state.velocities[i];
                let acceleration = f / system.rest.mass[i] - v * system.control.air_drag;
                self.velocity_sum[i] += v * weight;
                self.acceleration_sum[i] += acceleration * weight;
                state.positions[i] = self.start_positions[i] + v * (along * h);
                state.velocities[i] = self.start_velocities[i] + acceleration * (along * h);
            }
        }
        for i in 0..self.start_positions.len() {
            state.positions[i] = self.start_positions[i] + self.velocity_sum[i] * h;
            state.velocities[i] = self.start_velocities[i] + self.acceleration_sum[i] * h;
        }
    }
}
