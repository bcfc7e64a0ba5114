//! Viscosity (Kelvin and Voigt): a strip that was stretched, and one that was bent, swing out or creep back at their
//! rates.

use super::swing::beam;
use crate::check::{Cases, Expected};
use crate::settle::{converged, in_time, mean, methods_in_time, sound_step};
use crate::{LabError, MeshKind, Tolerance, rectangle};
use std::f64::consts::{FRAC_PI_4, PI};
use toile_drape::{Material, MethodKind, MethodSettings, State, System, SystemBuilder};
use toile_geometry::{Vec2, Vec3};

/// Stretch stiffness (N/m) and mass per area (kg/m2) of the strip.
const STRETCH: f64 = 20.0;
const DENSITY: f64 = 0.2;
/// Cells along it, and their size (m).
const CELLS: usize = 7;
const CELL: f64 = 0.08;

/// Share of critical damping with which it swings, and the one with which it creeps.
const SWINGING: f64 = 0.45;
const CREEPING: f64 = 1.5;

/// Step of methods in double precision (s): a rule of first order adds w h / 2 = 0.0035 to a ratio of damping.
const STEP: f64 = 2.5e-4;
/// How far the end is drawn out at first (m), and by how much more for single precision, which rounds what
/// moves a strip of half a metre by less than 3e-8 m in a substep.
const DRAWN: f64 = 2e-4;
const DRAWN_FAR: f64 = 0.04;
/// Methods that bend: those of second order, whose own damping is far less, and XPBD, which has viscosity in a way of
/// its own.
const BENDERS: [MethodKind; 3] = [
    MethodKind::Bdf2,
    MethodKind::ImplicitMidpoint,
    MethodKind::Xpbd,
];
/// Elements along the bent strip.
const ELEMENTS: usize = 8;
/// Damping ratio of the bent strip: higher modes have more, and have died out after half a period. Steps in a period.
const BENDING_RATIO: f64 = 0.1;
const STEPS: f64 = 300.0;
/// Substeps of XPBD (s): that of its default at 60 frames a second, and a fine one.
const DEFAULT_SUBSTEP: f64 = 1.0 / 1200.0;
const FINE_SUBSTEP: f64 = 1.0 / 4800.0;

const RATIO: Tolerance = Tolerance::value("damping ratio", 0.01);
const RATE: Tolerance = Tolerance::value("rate of creep, 1/s", 0.01);
/// A default substep of XPBD adds w h / 2 = 0.012 to a ratio of damping, as implicit Euler would.
const COARSE_RATIO: Tolerance = Tolerance {
    share: 0.03,
    ..RATIO.only("default substep")
};
const COARSE_RATE: Tolerance = Tolerance {
    share: 0.03,
    ..RATE.only("default substep")
};
pub(super) const STRETCHED: [Tolerance; 4] = [RATIO, RATE, COARSE_RATIO, COARSE_RATE];
pub(super) const BENT: [Tolerance; 1] = [RATIO];

/// Frequency of the first stretching: a quarter of a wave over linear elements with lumped masses (rad/s).
fn frequency() -> f64 {
    2.0 * (STRETCH / DENSITY).sqrt() / CELL * (FRAC_PI_4 / CELLS as f64).sin()
}

/// A strip held at one end, viscous by a share of critical damping, drawn out by `drawn` (m) in its first mode.
/// Also its vertices at the other end.
fn strip(ratio: f64, drawn: f64) -> Result<(System, State, Vec<u32>), LabError> {
    let length = CELL * CELLS as f64;
    let to = Vec2::new(length, 2.0 * CELL);
    let flat = rectangle(MeshKind::Right, Vec2::zeros(), to, [CELLS, 2])?;
    let material = Material {
        density: DENSITY,
        stretch: [STRETCH; 2],
        shear: 10.0,
        poisson: 0.0,
        viscosity: STRETCH * 2.0 * ratio / frequency(),
        // Too stiff to buckle where it is pressed.
        bend: [4e-3; 3],
        ..Material::default()
    };
    let cloth = flat.cloth(material, |p| Vec3::new(p.x, 0.0, p.y));
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    builder.control.gravity = Vec3::zeros();
    for v in flat.chosen(|p| p.x < 1e-9) {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    for (x, rest) in state.positions.iter_mut().zip(&flat.points) {
        x.x += drawn * (2.0 * FRAC_PI_4 * rest.x / length).sin();
    }
    Ok((system, state, flat.chosen(|p| p.x > length - 1e-9)))
}

/// Ratio of damping by a course from one turn to the next.
fn damping_ratio(course: &[f64]) -> f64 {
    let mut turns = Vec::new();
    for near in course.windows(3) {
        let [before, turn, after] = [near[0], near[1], near[2]];
        if turn.abs() > before.abs() && turn.abs() >= after.abs() {
            // The top of the parabola through three places.
            turns.push(turn - (after - before).powi(2) / (8.0 * (after - 2.0 * turn + before)));
        }
    }
    let [first, second, ..] = turns[..] else {
        return f64::NAN;
    };
    let decrement = (first / second).abs().ln();
    decrement / (PI * PI + decrement * decrement).sqrt()
}

/// Damping ratio of a strip that swings, or the rate at which one creeps back (1/s).
fn of_strip(settings: MethodSettings, step: f64, ratio: f64, drawn: f64) -> Result<f64, LabError> {
    let (system, mut state, end) = strip(ratio, drawn)?;
    let length = CELL * CELLS as f64;
    let place = |state: &State| mean(&state.positions, &end).x - length;
    let mut course = vec![place(&state)];
    let time = if ratio < 1.0 { 0.2 } else { 4.5 / frequency() };
    in_time(&system, &mut state, settings, [step, time], |state| {
        course.push(place(state));
    })?;
    if ratio < 1.0 {
        // Let go at rest: the motion before is that after it mirrored in time.
        course.insert(0, course[1]);
        return Ok(damping_ratio(&course));
    }
    // Between times at which the faster of the two rates has died out.
    let [from, to] = [2.0, 4.0].map(|t| (t / frequency() / step) as usize);
    Ok((course[from] / course[to]).ln() / ((to - from) as f64 * step))
}

/// A strip held at one end: x'' + 2 z w x' + w^2 x = 0 for its first stretching.
pub(super) fn stretched(cases: &mut Cases) -> Result<(), LabError> {
    for (ratio, word) in [(SWINGING, "swings"), (CREEPING, "creeps")] {
        let (tolerance, coarse, expected) = match ratio < 1.0 {
            true => (RATIO, COARSE_RATIO, ratio),
            false => {
                let rate = frequency() * (ratio - (ratio * ratio - 1.0).sqrt());
                (RATE, COARSE_RATE, rate)
            }
        };
        for (name, kind) in methods_in_time().filter(|(_, kind)| *kind != MethodKind::Xpbd) {
            let settings = converged(kind, 1e-10, 400);
            cases.measure(
                format!("{name}, {word}"),
                Expected::value(tolerance, expected),
                || {
                    let (system, rest, _) = strip(ratio, 0.0)?;
                    let step = sound_step(&system, &rest, settings, STEP)?;
                    of_strip(settings, step, ratio, DRAWN)
                },
            )?;
        }
        // Strains of a tenth, which single precision needs, against double precision.
        let far = of_strip(MethodKind::RungeKutta4.into(), 0.2 * STEP, ratio, DRAWN_FAR)?;
        let settings = MethodSettings {
            substeps: Some(1),
            ..MethodKind::Xpbd.into()
        };
        for (substep, what, tolerance) in [
            (DEFAULT_SUBSTEP, "default substep", coarse),
            (FINE_SUBSTEP, "fine substep", tolerance),
        ] {
            cases.measure(
                format!("xpbd, {what}, {word}"),
                Expected::value(tolerance, far),
                || of_strip(settings, substep, ratio, DRAWN_FAR),
            )?;
        }
    }
    Ok(())
}

/// A clamped strip vibrates with the damping ratio of its viscosity of bending.
pub(super) fn bent(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in methods_in_time().filter(|(_, kind)| BENDERS.contains(kind)) {
        let (swing, frequency) = beam(MeshKind::Right, ELEMENTS, BENDING_RATIO)?;
        let period = std::f64::consts::TAU / frequency;
        let wanted = period / STEPS;
        let mut measure = |case: String, step: Option<f64>| {
            cases.measure(case, Expected::value(RATIO, BENDING_RATIO), || {
                let settings = converged(kind, 1e-11, 100);
                let course = swing.course(settings, step, [wanted, 1.8 * period])?;
                Ok(damping_ratio(&course[course.len() / 3..]))
            })
        };
        measure(name.to_owned(), None)?;
        if kind == MethodKind::Xpbd {
            let frame = 20.0 * DEFAULT_SUBSTEP;
            measure(format!("{name}, default substep"), Some(frame))?;
        }
    }
    Ok(())
}
