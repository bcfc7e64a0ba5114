//! Rules of implicit time integration: the inertial target y, its weight b, and the new state from the minimum.
//!
//! c is the drag of the air per mass, a(x) = -grad E(x) / m.

use super::frequency::contact_frequency;
use super::implicit::TimeRule;
use crate::{ContactSample, Memory, State, System};
use toile_geometry::Vec3;

/// Implicit Euler: v' = v + h (a(x') - c v'), x' = x + h v'. Order 1, damps
/// (Baraff and Witkin 1998, equation 2; as a minimum Martin et al. 2011, equation 3):
/// b = (1 + c h) / h^2, y = x + h v / (1 + c h), then v' = (x' - x) / h.
pub struct Euler;

impl TimeRule for Euler {
    fn weight(system: &System, _state: &State, h: f64) -> f64 {
        (1.0 + system.control.air_drag * h) / (h * h)
    }

    fn set_target(system: &System, state: &State, h: f64, target: &mut Vec<Vec3>) {
        let reach = h / (1.0 + system.control.air_drag * h);
        target.clear();
        target.extend(
            state
                .positions
                .iter()
                .zip(&state.velocities)
                .map(|(x, v)| x + v * reach),
        );
    }

    fn finish(before: &State, state: &mut State, h: f64) {
        for (v, (x, old)) in state
            .velocities
            .iter_mut()
            .zip(state.positions.iter().zip(&before.positions))
        {
            *v = (x - old) / h;
        }
    }
}

/// Implicit midpoint: x_m = (x + x') / 2, v_m = (x' - x) / h, v' = v + h (a(x_m) - c v_m). Order 2,
/// conserves linear momentum exactly and angular momentum to the solver's tolerance, has no numerical damping
/// (Hairer, Lubich and Wanner 2006, II.1). The unknown is x_m: b = (4 + 2 c h) / h^2,
/// y = x + (h/2) v / (1 + c h/2), then x' = 2 x_m - x and v' = 2 v_m - v.
///
/// Contact forces act at x_m alone: a step may end inside a solid without a contact force in it, and the next one
/// then gains energy from contact. Where there are solids, automatic substeps therefore resolve the contact:
/// h w <= 1, w^2 = stiffness / density.
pub struct Midpoint;

/// Most automatic substeps; a frame takes 40.
const MAX_SUBSTEPS: f64 = 1000.0;

impl TimeRule for Midpoint {
    /// The rule conserves the energy of a linear vibration exactly and that of bent and stretched cloth nearly. Where
    /// steps do not resolve the vibration it gains energy: a factor of twenty a frame in cloth that a solid was put
    /// over, a tenth a frame in cloth stretched to four times its length.
    const MAX_ENERGY_FACTOR: Option<f64> = Some(10.0);

    fn unknown_time(h: f64) -> f64 {
        0.5 * h
    }

    fn substeps(system: &System, samples: &[ContactSample], step: f64) -> u32 {
        (step * contact_frequency(system, samples))
            .ceil()
            .min(MAX_SUBSTEPS) as u32
    }

    fn weight(system: &System, _state: &State, h: f64) -> f64 {
        (4.0 + 2.0 * system.control.air_drag * h) / (h * h)
    }

    fn set_target(system: &System, state: &State, h: f64, target: &mut Vec<Vec3>) {
        Euler::set_target(system, state, 0.5 * h, target);
    }

    fn finish(before: &State, state: &mut State, h: f64) {
        let moving = state.positions.iter_mut().zip(&mut state.velocities);
        for ((x, v), old) in moving.zip(&before.positions) {
            let speed = (*x - old) * (2.0 / h);
            *x = *x * 2.0 - old;
            *v = speed * 2.0 - *v;
        }
    }
}

/// The two-step backward differentiation formula. Order 2, damps less than implicit Euler
/// (Curtiss and Hirschfelder 1952; Choi and Ko 2002 for cloth).
///
/// With r = h / h_before and a0 = (1 + 2r) / (1 + r), a1 = -(1 + r), a2 = r^2 / (1 + r):
/// h v' = a0 x' + a1 x + a2 x_before and h (a(x') - c v') = a0 v' + a1 v + a2 v_before. As a
/// minimum: b = a0 (a0 + c h) / h^2,
/// y = -(a1 x + a2 x_before) / a0 - h (a1 v + a2 v_before) / (a0 (a0 + c h)).
/// For equal steps b = 9/4 / h^2. The first step, and one more than twice as long as the one
/// before it, is implicit Euler's (the formula is stable up to r = 1 + sqrt 2).
pub struct Bdf2;

/// Largest ratio of a step to the one before it for the two-step formula.
const MAX_RATIO: f64 = 2.0;

/// The coefficients a0, a1, a2 and the previous state; none for a first step or one beyond the largest ratio.
fn two_step<'a>(memory: &'a Memory, count: usize, h: f64) -> Option<Before<'a>> {
    let Memory::Previous {
        positions,
        velocities,
        step,
    } = memory
    else {
        return None;
    };
    let r = h / step;
    (positions.len() == count && velocities.len() == count && r <= MAX_RATIO).then(|| Before {
        coefficients: [(1.0 + 2.0 * r) / (1.0 + r), -(1.0 + r), r * r / (1.0 + r)],
        positions,
        velocities,
    })
}

/// The previous state of the two-step formula, and its coefficients.
struct Before<'a> {
    coefficients: [f64; 3],
    positions: &'a [Vec3],
    velocities: &'a [Vec3],
}

impl TimeRule for Bdf2 {
    fn weight(system: &System, state: &State, h: f64) -> f64 {
        match two_step(&state.memory, state.positions.len(), h) {
            Some(Before {
                coefficients: [a0, ..],
                ..
            }) => a0 * (a0 + system.control.air_drag * h) / (h * h),
            None => Euler::weight(system, state, h),
        }
    }

    fn set_target(system: &System, state: &State, h: f64, target: &mut Vec<Vec3>) {
        let Some(before) = two_step(&state.memory, state.positions.len(), h) else {
            return Euler::set_target(system, state, h, target);
        };
        let [a0, a1, a2] = before.coefficients;
        let reach = h / (a0 * (a0 + system.control.air_drag * h));
        let present = state.positions.iter().zip(&state.velocities);
        let past = before.positions.iter().zip(before.velocities);
        target.clear();
        target.extend(present.zip(past).map(|((x, v), (x_before, v_before))| {
            -(x * a1 + x_before * a2) / a0 - (v * a1 + v_before * a2) * reach
        }));
    }

    fn finish(before: &State, state: &mut State, h: f64) {
        match two_step(&before.memory, state.positions.len(), h) {
            None => Euler::finish(before, state, h),
            Some(past) => {
                let [a0, a1, a2] = past.coefficients;
                for (i, v) in state.velocities.iter_mut().enumerate() {
                    *v = (state.positions[i] * a0
                        + before.positions[i] * a1
                        + past.positions[i] * a2)
                        / h;
                }
            }
        }
        if let Memory::Previous {
            positions,
            velocities,
            step,
        } = &mut state.memory
        {
            positions.clone_from(&before.positions);
            velocities.clone_from(&before.velocities);
            *step = h;
        } else {
            state.memory = Memory::Previous {
                positions: before.positions.clone(),
                velocities: before.velocities.clone(),
                step: h,
            };
        }
    }
}
