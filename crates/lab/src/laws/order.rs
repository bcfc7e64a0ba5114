//! Orders of convergence in time.

use crate::check::{Cases, Expected};
use crate::settle::{in_time, methods_in_time, sound_step};
use crate::{LabError, MeshKind, Tolerance, rectangle};
use toile_drape::{Material, MethodKind, MethodSettings, State, SystemBuilder};
use toile_geometry::{Vec2, Vec3};

/// Methods whose error falls with the square of the step; the others are of first order, but for
/// Runge and Kutta's, which is of fourth.
const SECOND: [&str; 4] = [
    "velocity-verlet",
    "patch-verlet",
    "bdf2",
    "implicit-midpoint",
];

/// The order by steps h and h/2, of first order in h.
const ORDER: Tolerance = Tolerance::value("order", 0.03);
pub(super) const IN_TIME: [Tolerance; 1] = [ORDER];

fn order_of(name: &str) -> f64 {
    if name.starts_with("runge") || name.starts_with("rk") {
        4.0
    } else if SECOND.contains(&name) {
        2.0
    } else {
        1.0
    }
}

/// A soft strip held at one end swings; steps h, h/2, h/4 give the order by the ratio of the
/// differences.
pub(super) fn in_time_order(cases: &mut Cases) -> Result<(), LabError> {
    let flat = rectangle(
        MeshKind::Right,
        Vec2::zeros(),
        Vec2::new(0.1, 0.025),
        [8, 2],
    )?;
    let material = Material {
        density: 0.2,
        stretch: [20.0; 2],
        shear: 8.0,
        bend: [1e-6; 3],
        ..Material::default()
    };
    let cloth = flat.cloth(material, |p| Vec3::new(p.x, 0.0, p.y));
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    for v in flat.chosen(|p| p.x < 1e-9) {
        builder.pinned[v as usize] = true;
    }
    builder.control.gravity = Vec3::zeros();
    let mut system = builder.build();
    let start = State::at_rest(&system, cloth.positions);
    for (name, kind) in methods_in_time() {
        let settings = MethodSettings {
            tolerance: Some(1e-14),
            iterations: Some(200),
            substeps: Some(1),
            ..kind.into()
        };
        system.control.gravity = Vec3::zeros();
        // Single precision drowns the differences of smaller steps.
        let wanted = if kind == MethodKind::Xpbd { 4e-3 } else { 1e-3 };
        let sound = sound_step(&system, &start, settings, wanted)?;
        system.control.gravity = Vec3::new(0.0, -9.81, 0.0);
        let expected = order_of(name);
        let duration = 0.064;
        // A whole number of steps in the duration, four sizes.
        let coarsest = duration / (duration / sound).ceil();
        cases.measure(
            format!("{name}, steps from {coarsest:.1e} s"),
            Expected::value(ORDER, expected),
            || {
                let mut ends = Vec::new();
                for halvings in 0..4 {
                    let step = coarsest / f64::from(1 << halvings);
                    let mut state = start.clone();
                    in_time(&system, &mut state, settings, [step, duration], |_| {})?;
                    ends.push(state.positions);
                }
                let apart = |a: &[Vec3], b: &[Vec3]| -> f64 {
                    let sum: f64 = a.iter().zip(b).map(|(p, q)| (p - q).norm_squared()).sum();
                    sum.sqrt()
                };
                Ok((apart(&ends[1], &ends[2]) / apart(&ends[2], &ends[3])).log2())
            },
        )?;
    }
    Ok(())
}
