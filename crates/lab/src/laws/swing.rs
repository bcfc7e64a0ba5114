//! Frequencies: a hung strip swings, a clamped one vibrates.

use crate::check::{Cases, Expected};
use crate::flat::{STRAIGHT, clamped};
use crate::settle::{converged, in_time, methods_in_time, sound_step};
use crate::{LabError, MeshKind, Tolerance, rectangle};
use toile_drape::{Material, MethodKind, MethodSettings, State, System, SystemBuilder};
use toile_geometry::{Vec2, Vec3};

/// Zeros of the Bessel function J0, halved: circular frequencies of a hanging chain in units of
/// sqrt(g/L) (Daniel Bernoulli 1733).
const CHAIN: [f64; 3] = [1.202_412_778_8, 2.760_039_055_5, 4.326_863_956_0];

/// First root of 1 + cos(k) cosh(k) = 0, squared: a clamped free beam in units of
/// sqrt(D / (rho L^4)).
const BEAM: f64 = 3.516_015_268_5;
/// That root itself.
const BEAM_ROOT: f64 = 1.875_104_068_7;

const DENSITY: f64 = 0.2;
const GRAVITY: f64 = 9.81;

/// Steps in a period: a method of first order damps by a factor 0.95 in it, and the frequency is
/// out by less than 1e-4.
const STEPS: f64 = 400.0;

/// Gradient at which a step counts as solved (N).
const SOLVED: f64 = 1e-13;

/// A strip about to move in a shape.
pub(super) struct Swing {
    system: System,
    rest: Vec<Vec3>,
    shape: Vec<f64>,
    amplitude: f64,
}

impl Swing {
    /// Circular frequency of the motion (rad/s), by the times the projection on the shape
    /// vanishes.
    fn measure(&self, settings: MethodSettings, expected: f64) -> Result<f64, LabError> {
        let mut state = self.displaced();
        let period = std::f64::consts::TAU / expected;
        let step = self.sound_step(settings, period / STEPS)?;
        let mut crossings: Vec<f64> = Vec::new();
        let mut last = (0.0, self.project(&state));
        in_time(
            &self.system,
            &mut state,
            settings,
            [step, 1.3 * period],
            |s| {
                let now = (last.0 + step, self.project(s));
                if now.1 * last.1 < 0.0 {
                    crossings.push(last.0 + step * last.1 / (last.1 - now.1));
                }
                last = now;
            },
        )?;
        let (Some(first), Some(end), true) =
            (crossings.first(), crossings.last(), crossings.len() > 2)
        else {
            return Ok(f64::NAN);
        };
        Ok(std::f64::consts::PI * (crossings.len() - 1) as f64 / (end - first))
    }

    /// Projections on the shape at the start and after each step until `duration` (s); without a `step` (s), the
    /// longest sound one up to that wanted.
    pub(super) fn course(
        &self,
        settings: MethodSettings,
        step: Option<f64>,
        [wanted, duration]: [f64; 2],
    ) -> Result<Vec<f64>, LabError> {
        let mut state = self.displaced();
        let step = match step {
            Some(step) => step,
            None => self.sound_step(settings, wanted)?,
        };
        let mut course = vec![self.project(&state)];
        in_time(&self.system, &mut state, settings, [step, duration], |s| {
            course.push(self.project(s));
        })?;
        Ok(course)
    }

    /// The strip displaced in its shape, at rest.
    fn displaced(&self) -> State {
        let away = Vec3::new(0.0, 0.0, self.amplitude);
        let place = |(p, s): (&Vec3, &f64)| p + away * *s;
        let positions = self.rest.iter().zip(&self.shape).map(place).collect();
        State::at_rest(&self.system, positions)
    }

    /// The longest step that keeps a disturbance of the resting strip small, up to that wanted (s).
    fn sound_step(&self, settings: MethodSettings, wanted: f64) -> Result<f64, LabError> {
        let resting = State::at_rest(&self.system, self.rest.clone());
        sound_step(&self.system, &resting, settings, wanted)
    }

    fn project(&self, state: &State) -> f64 {
        let terms = state.positions.iter().zip(&self.rest).zip(&self.shape);
        terms
            .zip(&self.system.rest.mass)
            .map(|(((p, rest), shape), mass)| mass * shape * (p.z - rest.z))
            .sum()
    }
}

/// J0 by its series; enough for arguments under 12.
fn bessel(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..60 {
        term *= -x * x / (4.0 * f64::from(k * k));
        sum += term;
    }
    sum
}

/// A strip hung by its edge, displaced in one of its modes.
fn chain(mesh: MeshKind, mode: usize) -> Result<Swing, LabError> {
    let (length, width) = (0.5, 0.025);
    let flat = rectangle(mesh, Vec2::zeros(), Vec2::new(length, width), [40, 2])?;
    let material = Material {
        density: DENSITY,
        stretch: [1000.0; 2],
        shear: 500.0,
        poisson: 0.0,
        bend: [1e-9; 3],
        ..Material::default()
    };
    let cloth = flat.cloth(material, |p| Vec3::new(p.y, -p.x, 0.0));
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    for v in flat.chosen(|p| p.x < 1e-9) {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    // From its own stretched rest, or it would bounce too.
    let mut state = State::at_rest(&system, cloth.positions);
    crate::settle::to_rest(&system, &mut state, 1e-6)?;
    let shape = |p: &Vec2| bessel(2.0 * CHAIN[mode] * (1.0 - p.x / length).max(0.0).sqrt());
    Ok(Swing {
        shape: flat.points.iter().map(shape).collect(),
        rest: state.positions,
        system,
        amplitude: 1e-3 * length,
    })
}

/// A strip clamped at one end, in some elements along it, without gravity, displaced in its first mode, its bending
/// viscous by a share of critical damping; and its frequency (rad/s).
pub(super) fn beam(
    mesh: MeshKind,
    elements: usize,
    damping_ratio: f64,
) -> Result<(Swing, f64), LabError> {
    let (length, bend) = (0.1f64, 1e-4);
    let frequency = BEAM * (bend / (DENSITY * length.powi(4))).sqrt();
    let cell = length / (elements as f64 + 0.5);
    let from = -(STRAIGHT as f64 - 0.5) * cell;
    let flat = rectangle(
        mesh,
        Vec2::new(from, 0.0),
        Vec2::new(length, 4.0 * cell),
        [elements + STRAIGHT, 4],
    )?;
    let material = Material {
        density: DENSITY,
        stretch: [100.0; 2],
        shear: 50.0,
        poisson: 0.0,
        bend: [bend; 3],
        bend_viscosity: 2.0 * damping_ratio * bend / frequency,
        ..Material::default()
    };
    let cloth = flat.cloth(material, |p| Vec3::new(p.x, p.y, 0.0));
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    builder.control.gravity = Vec3::zeros();
    for v in flat.chosen(|p| clamped(p.x, cell)) {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    let k = BEAM_ROOT;
    let ratio = (k.cosh() + k.cos()) / (k.sinh() + k.sin());
    let shape = |p: &Vec2| {
        let s = match clamped(p.x, cell) {
            true => 0.0,
            false => k * p.x / length,
        };
        0.5 * (s.cosh() - s.cos() - ratio * (s.sinh() - s.sin()))
    };
    let swing = Swing {
        shape: flat.points.iter().map(shape).collect(),
        rest: cloth.positions,
        system,
        amplitude: 1e-3 * length,
    };
    Ok((swing, frequency))
}

/// Frequencies of the modes: the error of second order grows with the square of the wave number.
const MODE: Tolerance = Tolerance::value("frequency, rad/s", 0.005);
pub(super) const HANGING: [Tolerance; 3] = [
    MODE.only("mode 1"),
    Tolerance {
        share: 0.01,
        ..MODE.only("mode 2")
    },
    Tolerance {
        share: 0.02,
        ..MODE.only("mode 3")
    },
];

/// Frequency of the clamped strip.
const VIBRATION: Tolerance = Tolerance::value("frequency, rad/s", 0.02);
pub(super) const VIBRATING: [Tolerance; 1] = [VIBRATION];

/// The hanging strip: every method in its first mode, the default method in three.
pub(super) fn hanging(cases: &mut Cases) -> Result<(), LabError> {
    let usual = MethodKind::default();
    for (mode, factor) in CHAIN.into_iter().enumerate() {
        let expected = factor * (GRAVITY / 0.5).sqrt();
        for (name, kind) in methods_in_time() {
            if mode > 0 && kind != usual {
                continue;
            }
            cases.measure(
                format!("mode {}, {name}", mode + 1),
                Expected::value(HANGING[mode], expected),
                || {
                    let settings = MethodSettings {
                        tolerance: Some(SOLVED),
                        ..kind.into()
                    };
                    chain(MeshKind::Right, mode)?.measure(settings, expected)
                },
            )?;
        }
    }
    Ok(())
}

/// The vibrating cantilever: every method on one mesh, the default method on four.
pub(super) fn vibrating(cases: &mut Cases) -> Result<(), LabError> {
    let usual = MethodKind::default();
    for (mesh_name, mesh) in MeshKind::ALL {
        for (name, kind) in methods_in_time() {
            if mesh != MeshKind::Right && kind != usual {
                continue;
            }
            let (swing, expected) = beam(mesh, 20, 0.0)?;
            cases.measure(
                format!("{mesh_name}, {name}"),
                Expected::value(VIBRATION, expected),
                || swing.measure(converged(kind, SOLVED, 400), expected),
            )?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_frequencies_are_halves_of_the_zeros_of_bessel() {
        for half in CHAIN {
            assert!(bessel(2.0 * half).abs() < 1e-9);
        }
        assert!((BEAM_ROOT * BEAM_ROOT - BEAM).abs() < 1e-8);
        assert!((1.0 + BEAM_ROOT.cos() * BEAM_ROOT.cosh()).abs() < 1e-8);
    }
}
