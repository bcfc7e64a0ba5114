//! Where each method is stable: maps of step against stiffness, and the limits measured.

use crate::settle::to_rest;
use crate::{LabError, MeshKind, rectangle};
use serde::Serialize;
use std::ops::ControlFlow;
use toile_drape::{
    Material, MethodKind, MethodSettings, State, System, SystemBuilder, largest_frequency,
    stretch_per_triangle,
};
use toile_geometry::{Vec2, Vec3};
use toile_session::Watcher;

/// The outcome of a method at one step and stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// A hung cloth that was made to swing stretched no more than its energy allows.
    Stable,
    /// It stayed finite but stretched more than three times as far.
    Wrong,
    /// Its energy grew without bound, or the method stopped with an error.
    Unstable,
}

/// One cell of a map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// The method.
    pub method: &'static str,
    /// Stretch stiffness of the cloth (N/m).
    pub stiffness: f64,
    /// The step, not cut into substeps (s).
    pub step: f64,
    /// How it did.
    pub verdict: Verdict,
    /// The error it stopped with, or how far it stretched.
    pub detail: String,
}

/// The limit of an explicit method, in theory and as measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// The method.
    pub method: &'static str,
    /// Stretch stiffness of the cloth (N/m).
    pub stiffness: f64,
    /// Its limit over the largest frequency of the cloth at rest (s).
    pub theory: f64,
    /// The step at which a disturbance begins to grow (s).
    pub measured: f64,
}

/// How near the measured limit must be to theory. The halving leaves 0.14 %, and a disturbance must
/// grow a thousandfold within the trial to be told from one that does not.
const LIMIT_TOLERANCE: f64 = 0.02;

impl Limit {
    /// Whether the method blows up where theory says.
    pub fn holds(&self) -> bool {
        (self.measured / self.theory - 1.0).abs() <= LIMIT_TOLERANCE
    }
}

/// Stiffnesses (N/m) and steps (s) of the map.
const STIFFNESSES: [f64; 7] = [1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7];
const STEPS: [f64; 9] = [1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

/// Steps taken in each cell.
const TRIAL: usize = 100;

/// Size of the cloth (m).
const SIZE: f64 = 0.1;

/// A square of cloth hung by an edge, at rest.
pub(crate) fn hung(stiffness: f64, gravity: bool) -> Result<(System, State), LabError> {
    let flat = rectangle(
        MeshKind::Delaunay,
        Vec2::zeros(),
        Vec2::new(SIZE, SIZE),
        [6, 6],
    )?;
    let material = Material {
        density: 0.2,
        stretch: [stiffness; 2],
        shear: 0.3 * stiffness,
        poisson: 0.2,
        bend: [1e-6; 3],
        ..Material::default()
    };
    let cloth = flat.cloth(material, |p| Vec3::new(p.y, -p.x, 0.0));
    let mut builder = SystemBuilder::new("square", &cloth)?;
    for v in flat.chosen(|p| p.x < 1e-9) {
        builder.pinned[v as usize] = true;
    }
    let mut system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    if gravity {
        to_rest(&system, &mut state, 1e-5)?;
    } else {
        system.control.gravity = Vec3::zeros();
    }
    Ok((system, state))
}

/// Gives every free vertex a small velocity that looks random (m/s).
pub(crate) fn shake(system: &System, state: &mut State, speed: f64) {
    for (v, velocity) in state.velocities.iter_mut().enumerate() {
        let k = v as f64;
        let noise = Vec3::new((7.1 * k).sin(), (3.3 * k).cos(), (5.7 * k + 1.0).sin());
        *velocity = if system.prescribed.pinned[v] {
            Vec3::zeros()
        } else {
            noise * speed
        };
    }
}

/// Speed of the tip of the swinging cloth at the start (m/s).
const SWING: f64 = 1.0;

/// Lets the cloth swing about its edge and looks at what energy allows: with the kinetic energy
/// and the fall of its whole weight spent on stretch, E^2 Y / 2 per area, strain stays below a
/// bound. A method that stretches the cloth beyond three times it is wrong.
fn judge(
    system: &System,
    rest: &State,
    settings: MethodSettings,
    step: f64,
) -> Result<(Verdict, String), LabError> {
    let mut state = rest.clone();
    shake(system, &mut state, 1e-3);
    for (v, x) in state.velocities.iter_mut().zip(&rest.positions) {
        v.z += SWING * (-x.y / SIZE).max(0.0);
    }
    let mass: f64 = system.rest.mass.iter().sum();
    let energy = state.kinetic_energy(system) + mass * 9.81 * 2.0 * SIZE;
    let stiffness = system.materials.list[0].stretch[0];
    let bound = 3.0 * (2.0 * energy / (stiffness * SIZE * SIZE)).sqrt() + 1e-6;
    let mut method = toile_reference::build(&settings)?;
    let mut worst = 0.0f64;
    for _ in 0..TRIAL {
        if let Err(error) = method.advance(system, &mut state, step) {
            return Ok((Verdict::Unstable, error.to_string()));
        }
        let kinetic = state.kinetic_energy(system);
        if kinetic.is_nan() || kinetic > 100.0 * energy {
            return Ok((
                Verdict::Unstable,
                "more energy than there can be".to_owned(),
            ));
        }
        let strains = stretch_per_triangle(system, &state.positions);
        let squares: f64 = strains.iter().map(|e| e * e).sum();
        worst = worst.max((squares / strains.len() as f64).sqrt());
        if method.finished() {
            break;
        }
    }
    let verdict = if worst <= bound {
        Verdict::Stable
    } else {
        Verdict::Wrong
    };
    Ok((
        verdict,
        format!("stretched by {worst:.1e}, {bound:.1e} allowed"),
    ))
}

/// Maps every method.
///
/// # Errors
/// The watcher asked to stop.
pub fn stability_map(watcher: &mut dyn Watcher) -> Result<Vec<Cell>, LabError> {
    let mut cells = Vec::new();
    for (s, stiffness) in STIFFNESSES.into_iter().enumerate() {
        let (system, rest) = hung(stiffness, true)?;
        for (name, kind) in MethodKind::ALL {
            let share = s as f64 / STIFFNESSES.len() as f64;
            let detail = format!("{name}, {stiffness:.0e} N/m");
            if watcher.progress("stability", share, &detail) == ControlFlow::Break(()) {
                return Err(LabError::Cancelled);
            }
            for step in STEPS {
                let settings = MethodSettings {
                    substeps: Some(1),
                    ..kind.into()
                };
                let (verdict, detail) = judge(&system, &rest, settings, step)?;
                cells.push(Cell {
                    method: name,
                    stiffness,
                    step,
                    verdict,
                    detail,
                });
            }
        }
    }
    Ok(cells)
}

/// Steps in which a disturbance must show whether it grows.
const LONG_TRIAL: usize = 500;

fn grows(system: &System, rest: &State, kind: MethodKind, step: f64) -> Result<bool, LabError> {
    let mut state = rest.clone();
    // So small that the cloth stays in its linear range.
    shake(system, &mut state, 1e-6);
    let energy = state.kinetic_energy(system);
    let settings = MethodSettings {
        substeps: Some(1),
        ..kind.into()
    };
    let mut method = toile_reference::build(&settings)?;
    for _ in 0..LONG_TRIAL {
        if method.advance(system, &mut state, step).is_err() {
            return Ok(true);
        }
        let kinetic = state.kinetic_energy(system);
        if kinetic.is_nan() || kinetic > 1e3 * energy {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Measures the limit of every explicit method that has one, at three stiffnesses, by halving
/// between a step that is stable and one that is not.
///
/// # Errors
/// The watcher asked to stop.
pub fn limits(watcher: &mut dyn Watcher) -> Result<Vec<Limit>, LabError> {
    let mut found = Vec::new();
    for stiffness in [1e2, 1e4, 1e6] {
        // Flat and without gravity: the frequencies are those of the rest shape.
        let (system, rest) = hung(stiffness, false)?;
        let frequency = largest_frequency(&system, &rest);
        for (name, kind) in MethodKind::ALL {
            let Some(limit) = kind.stability_limit().filter(|l| *l > 0.0) else {
                continue;
            };
            if watcher.progress("limits", 0.5, name) == ControlFlow::Break(()) {
                return Err(LabError::Cancelled);
            }
            let theory = limit / frequency;
            let (mut low, mut high) = (0.5 * theory, 2.0 * theory);
            for _ in 0..9 {
                let middle = (low * high).sqrt();
                if grows(&system, &rest, kind, middle)? {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            found.push(Limit {
                method: name,
                stiffness,
                theory,
                measured: (low * high).sqrt(),
            });
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn implicit_euler_is_stable_where_verlet_is_not() {
        let (system, rest) = hung(1e4, true).unwrap();
        let at = |kind: MethodKind| {
            let settings = MethodSettings {
                substeps: Some(1),
                ..kind.into()
            };
            judge(&system, &rest, settings, 1e-2).unwrap().0
        };
        assert_eq!(at(MethodKind::ImplicitEuler), Verdict::Stable);
        assert_eq!(at(MethodKind::VelocityVerlet), Verdict::Unstable);
    }

    #[test]
    fn a_limit_holds_within_two_per_cent_of_theory() {
        let limit = |measured| Limit {
            method: "velocity-verlet",
            stiffness: 1.0,
            theory: 1.0,
            measured,
        };
        let held = [0.97, 0.99, 1.001, 1.03, f64::NAN].map(|measured| limit(measured).holds());
        assert_eq!(held, [false, true, true, false, false]);
    }

    #[test]
    fn verlet_blows_up_at_its_own_limit() {
        let (system, rest) = hung(1e3, false).unwrap();
        let theory = 2.0 / largest_frequency(&system, &rest);
        let kind = MethodKind::VelocityVerlet;
        assert!(!grows(&system, &rest, kind, 0.95 * theory).unwrap());
        assert!(grows(&system, &rest, kind, 1.05 * theory).unwrap());
    }
}
