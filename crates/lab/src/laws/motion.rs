//! Laws of motion: free flight, free fall, terminal velocity, coming to rest.

use crate::check::{Cases, Expected};
use crate::settle::{converged, in_time, methods_in_time, sound_step, to_rest};
use crate::{LabError, MeshKind, Tolerance, rectangle};
use toile_drape::laws::air::Air;
use toile_drape::{
    Material, MethodKind, MethodSettings, State, System, SystemBuilder, largest_frequency,
};
use toile_geometry::{Vec2, Vec3};

/// A small square of soft cloth, free and without gravity.
fn square(material: Material) -> Result<(System, State), LabError> {
    let flat = rectangle(
        MeshKind::Delaunay,
        Vec2::zeros(),
        Vec2::new(0.2, 0.2),
        [8, 8],
    )?;
    let cloth = flat.cloth(material, |p| Vec3::new(p.x, 1.0, p.y));
    let mut builder = SystemBuilder::new("square", &cloth)?;
    builder.control.gravity = Vec3::zeros();
    let system = builder.build();
    let state = State::at_rest(&system, cloth.positions);
    Ok((system, state))
}

fn soft() -> Material {
    Material {
        density: 0.2,
        stretch: [100.0; 2],
        shear: 30.0,
        bend: [1e-5; 3],
        ..Material::default()
    }
}

fn momentum(system: &System, state: &State) -> Vec3 {
    let terms = state.velocities.iter().zip(&system.rest.mass);
    terms.map(|(v, m)| v * *m).sum()
}

fn angular_momentum(system: &System, state: &State) -> Vec3 {
    let terms = state.positions.iter().zip(&state.velocities);
    terms
        .zip(&system.rest.mass)
        .map(|((x, v), m)| x.cross(v) * *m)
        .sum()
}

/// Methods that keep angular momentum exactly: symplectic, or implicit midpoint.
const SPINNING: [&str; 4] = [
    "symplectic-euler",
    "velocity-verlet",
    "patch-verlet",
    "implicit-midpoint",
];

/// Gradient at which a step of the flight counts as solved (N).
const SOLVED: f64 = 1e-13;

/// The share of its momentum that a method may lose in 1000 steps of 2 ms. Forces of explicit methods
/// cancel to rounding.
const EXPLICIT: Tolerance =
    Tolerance::zero("momentum lost, share", "the momentum", 1e-12).only("explicit methods");
/// One linear solve a step, to the gradient asked for or to rounding.
const ONE_SOLVE: Tolerance = Tolerance {
    share: 1e-9,
    ..EXPLICIT.only("semi-implicit-euler")
};
/// A gradient of that norm over 100 vertices sums to 1e-12 N at the most; for 2 s that is 2e-10 of
/// 9e-3 kg m/s.
const CONVERGED: Tolerance = Tolerance {
    share: 2e-10,
    ..EXPLICIT.only("other implicit methods")
};
/// Single precision rounds positions of 0.2 m to 2^-25 of it; over a substep of 0.1 ms that is
/// 6e-5 m/s a vertex, of either sign: with 20000 substeps and 100 vertices 1e-3 m/s of 1.2 m/s, and
/// contributions of each of the substep's passes.
const SINGLE: Tolerance = Tolerance {
    share: 5e-3,
    ..EXPLICIT.only("xpbd")
};
/// Angular momentum of the methods that keep it.
const SPIN: Tolerance = Tolerance::zero("spin lost, share", "the angular momentum", 1e-8);
pub(super) const FLIGHT: [Tolerance; 5] = [EXPLICIT, ONE_SOLVE, CONVERGED, SINGLE, SPIN];

/// Which of them is a method's.
fn momentum_left(kind: MethodKind) -> Tolerance {
    match kind {
        _ if kind.stability_limit().is_some() => EXPLICIT,
        MethodKind::SemiImplicitEuler => ONE_SOLVE,
        MethodKind::Xpbd => SINGLE,
        _ => CONVERGED,
    }
}

/// A spinning, trembling cloth in free flight keeps its momentum.
pub(super) fn flight(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in methods_in_time() {
        let (system, mut state) = square(soft())?;
        let settings = converged(kind, SOLVED, 100);
        let step = sound_step(&system, &state, settings, 2e-3)?;
        for (k, (v, x)) in state
            .velocities
            .iter_mut()
            .zip(&state.positions)
            .enumerate()
        {
            let k = k as f64;
            let spin = Vec3::new(0.5, 2.0, 1.0).cross(&(x - Vec3::new(0.1, 1.0, 0.1)));
            let tremble = Vec3::new((1.1 * k).sin(), (2.3 * k).cos(), (0.7 * k).sin()) * 0.05;
            *v = Vec3::new(1.0, -0.5, 0.3) + spin + tremble;
        }
        let before = momentum(&system, &state);
        let spin = angular_momentum(&system, &state);
        let outcome = in_time(&system, &mut state, settings, [step, 1000.0 * step], |_| {});
        let failed = outcome.err();
        let word = failed.as_ref().map(ToString::to_string);
        cases.measure(
            format!("{name}, 1000 steps of {step:.1e} s"),
            Expected::zero(momentum_left(kind), before.norm()),
            || match failed {
                Some(error) => Err(error),
                None => Ok((momentum(&system, &state) - before).norm()),
            },
        )?;
        if SPINNING.contains(&name) && word.is_none() {
            let (after, kind) = (angular_momentum(&system, &state), name);
            cases.measure(
                format!("{kind}, 1000 steps of {step:.1e} s"),
                Expected::zero(SPIN, spin.norm()),
                || Ok((after - spin).norm()),
            )?;
        }
    }
    Ok(())
}

/// Time of the fall, and the longest step (s).
const FALLING: f64 = 0.5;
const LONGEST: f64 = 1e-3;

/// A method of first order is out by half to one step of the whole.
const fn half_step(step: f64) -> f64 {
    1.2 * step / FALLING + 1e-6
}

const FALLEN: Tolerance = Tolerance::value("fallen, m", half_step(LONGEST));
pub(super) const FALL: [Tolerance; 1] = [FALLEN];

/// A cloth let go falls by g t^2 / 2; a method of first order is out by half a step.
pub(super) fn fall(cases: &mut Cases) -> Result<(), LabError> {
    let (time, wanted) = (FALLING, LONGEST);
    for (name, kind) in methods_in_time() {
        let (mut system, mut state) = square(soft())?;
        let settings = kind.into();
        let step = sound_step(&system, &state, settings, wanted)?;
        system.control.gravity = Vec3::new(0.0, -9.81, 0.0);
        let drop = 0.5 * 9.81 * time * time;
        cases.measure(
            format!("{name}, steps of {step:.1e} s"),
            Expected::value(FALLEN, drop).within(half_step(step)),
            || {
                in_time(&system, &mut state, settings, [step, time], |_| {})?;
                let mean: f64 = state.positions.iter().map(|p| p.y).sum();
                // The run ends on a whole number of steps.
                let taken = (time / step).round() * step;
                Ok((1.0 - mean / state.positions.len() as f64) * (time / taken).powi(2))
            },
        )?;
    }
    Ok(())
}

/// The velocity at last.
const LAST: Tolerance = Tolerance::value("velocity, m/s", 0.01);
pub(super) const TERMINAL: [Tolerance; 1] = [LAST];

/// A wind that blows across and along.
const WIND: Vec3 = Vec3::new(0.7, 1.1, -0.4);

/// A cloth falling through air that takes a share of its velocity per time ends at g / drag; one
/// falling face on or edge on against drag by the square of its velocity at sqrt(2 rho g / (rho_air C)), relative to the
/// wind where there is one.
pub(super) fn terminal(cases: &mut Cases) -> Result<(), LabError> {
    let linear = |system: &mut System| system.control.air_drag = 4.0;
    fall_at_last(cases, "drag 4 per s", (Vec3::y(), 9.81 / 4.0), linear)?;
    let air = |wind: Vec3| Air {
        density: Air::SEA_LEVEL,
        tangential: 0.5,
        wind,
        ..Air::default()
    };
    for (way, down, coefficient) in [
        ("face on", Vec3::y(), air(WIND).normal),
        ("edge on", Vec3::x(), air(WIND).tangential),
    ] {
        let last = (2.0 * soft().density * 9.81 / (Air::SEA_LEVEL * coefficient)).sqrt();
        for (word, wind) in [("air at sea level", Vec3::zeros()), ("wind", WIND)] {
            let put = |system: &mut System| system.control.air = air(wind);
            let what = format!("{way} through {word}");
            fall_at_last(cases, &what, (down, last - wind.dot(&down)), put)?;
        }
    }
    Ok(())
}

fn fall_at_last(
    cases: &mut Cases,
    what: &str,
    (up, expected): (Vec3, f64),
    put: impl Fn(&mut System),
) -> Result<(), LabError> {
    for (name, kind) in methods_in_time() {
        let (mut system, mut state) = square(soft())?;
        let settings: MethodSettings = kind.into();
        let step = sound_step(&system, &state, settings, 5e-3)?;
        system.control.gravity = up * -9.81;
        put(&mut system);
        cases.measure(
            format!("{name}, {what}"),
            Expected::value(LAST, expected),
            || {
                in_time(&system, &mut state, settings, [step, 3.0], |_| {})?;
                let total = momentum(&system, &state).dot(&up);
                Ok(-total / system.rest.mass.iter().sum::<f64>())
            },
        )?;
    }
    Ok(())
}

/// The net force at rest, and the energy that is left of the fall.
const NET_FORCE: Tolerance = Tolerance::zero("net force/weight", "the weight", 1e-5);
const ENERGY_LEFT: Tolerance =
    Tolerance::zero("kinetic energy/fall", "the weight times the size", 1e-6);
pub(super) const CORNER: [Tolerance; 2] = [NET_FORCE, ENERGY_LEFT];

/// A cloth held at one corner comes to rest: by the way to rest, and in time with drag.
pub(super) fn corner(cases: &mut Cases) -> Result<(), LabError> {
    let material = Material {
        poisson: 0.2,
        ..Material::default()
    };
    let (mut system, start) = square(material)?;
    system.control.gravity = Vec3::new(0.0, -9.81, 0.0);
    system = system.with(|builder| builder.pinned[0] = true);
    cases.measure("way to rest", Expected::zero(NET_FORCE, 1.0), || {
        let mut state = start.clone();
        to_rest(&system, &mut state, 1e-6)?;
        let mut workspace = toile_drape::Workspace::default();
        Ok(toile_drape::residual(&system, &state, &mut workspace))
    })?;
    // The energy to lose: the weight times the size.
    let fall = system.rest.mass.iter().sum::<f64>() * 9.81 * 0.2;
    system.control.air_drag = 3.0;
    for (name, kind) in methods_in_time() {
        let settings: MethodSettings = kind.into();
        cases.measure(
            format!("{name}, 6 s with drag 3 per s"),
            Expected::zero(ENERGY_LEFT, fall),
            || swing_out(&system, &start, settings),
        )?;
    }
    Ok(())
}

fn swing_out(system: &System, start: &State, settings: MethodSettings) -> Result<f64, LabError> {
    let mut state = start.clone();
    let mut still = System::new("square", &cloth_of(system, start))?;
    still.control.gravity = Vec3::zeros();
    let mut step = sound_step(&still, start, settings, 5e-3)?;
    if settings.kind == MethodKind::ImplicitMidpoint {
        // It damps nothing itself, and drag damps a vibration w by only 1 / (1 + (h w / 2)^2) of
        // what it should: steps that resolve the fastest one.
        step = step.min(4.0 / largest_frequency(&still, start));
    }
    in_time(system, &mut state, settings, [step, 6.0], |_| {})?;
    Ok(state.kinetic_energy(system))
}

/// The cloth of a flat model, its present shape as rest.
fn cloth_of(system: &System, state: &State) -> toile_drape::Cloth {
    let place = |v: u32| state.positions[v as usize];
    toile_drape::Cloth {
        positions: state.positions.clone(),
        triangles: system.topology.triangles.clone(),
        rest: system
            .topology
            .triangles
            .iter()
            .map(|t| t.map(|v| Vec2::new(place(v).x, place(v).z)))
            .collect(),
        material: system.materials.of_triangle.clone(),
        panel: vec![0; system.topology.triangles.len()],
        materials: system.materials.list.clone(),
    }
}
