//! Lateral buckling of a strip on edge under its own weight.

use crate::check::{Cases, Expected};
use crate::flat::{STRAIGHT, clamped};
use crate::settle::to_rest;
use crate::{LabError, MeshKind, Tolerance, rectangle};
use toile_drape::{Material, State, SystemBuilder};
use toile_geometry::{Vec2, Vec3};

/// q L^3 / sqrt(B C) at which a strip clamped on edge gives way sideways under its own weight
/// (Prandtl 1899, Michell 1899).
const PRANDTL: f64 = 12.85;

/// The critical load: the strip drawn to no width is of first order in it.
const LOAD: Tolerance = Tolerance::value("Gamma", 0.03);
pub(super) const LATERAL: [Tolerance; 1] = [LOAD];

/// Length of the strip (m), and its cells along and across: a twelfth and a 24th as wide as long.
const LENGTH: f64 = 0.1;
const CELLS: [[usize; 2]; 2] = [[48, 4], [96, 4]];

/// With nu = 0: B = D w, C = 2 D w, so Gamma = 12.85 sqrt(2) for a strip that is narrow. The clamp
/// keeps a wide one from warping over a stretch of the order of its width, which raises the load in
/// proportion to w/L: two widths are measured and drawn to none.
pub(super) fn lateral(cases: &mut Cases) -> Result<(), LabError> {
    let expected = PRANDTL * 2.0f64.sqrt();
    for (name, kind) in MeshKind::ALL {
        cases.measure(name, Expected::value(LOAD, expected), || {
            let [wide, narrow] = CELLS.map(|cells| critical(kind, cells, expected));
            Ok(2.0 * narrow? - wide?)
        })?;
    }
    Ok(())
}

/// Loads the first estimate is made from, as shares of the one expected: both beyond the critical
/// load of either strip.
const FIRST: [f64; 2] = [1.14, 1.20];

/// Where the loads measured lie above that estimate.
const ABOVE: [f64; 3] = [0.04, 0.07, 0.10];

/// Beyond the critical load the square of the sideways deflection grows in proportion to the
/// excess (a pitchfork): a line through two deflections, then a parabola through three nearer by,
/// drawn back to zero.
fn critical(kind: MeshKind, cells: [usize; 2], expected: f64) -> Result<f64, LabError> {
    let square = |load: f64| deflection(kind, cells, load * expected).map(|z| z * z);
    let (a, b) = (square(FIRST[0])?, square(FIRST[1])?);
    let near = FIRST[0] - a * (FIRST[1] - FIRST[0]) / (b - a);
    let loads = ABOVE.map(|more| near + more);
    let (a, b, c) = (square(loads[0])?, square(loads[1])?, square(loads[2])?);
    // Load as a quadratic in the square of the deflection, at zero (Lagrange).
    let share = loads[0] * b * c / ((a - b) * (a - c))
        + loads[1] * a * c / ((b - a) * (b - c))
        + loads[2] * a * b / ((c - a) * (c - b));
    Ok(share * expected)
}

/// How far the tip stands off sideways, as a share of the length.
fn deflection(kind: MeshKind, [columns, rows]: [usize; 2], gamma: f64) -> Result<f64, LabError> {
    let (density, gravity) = (0.2, 9.81);
    let cell = LENGTH / (columns as f64 + 0.5);
    let from = -(STRAIGHT as f64 - 0.5) * cell;
    let width = rows as f64 * cell;
    let flat = rectangle(
        kind,
        Vec2::new(from, -0.5 * width),
        Vec2::new(LENGTH, 0.5 * width),
        [columns + STRAIGHT, rows],
    )?;
    let bend = density * gravity * LENGTH.powi(3) / gamma;
    let stretch = 1e6 * bend / (LENGTH * LENGTH);
    let material = Material {
        density,
        stretch: [stretch; 2],
        shear: 0.5 * stretch,
        poisson: 0.0,
        bend: [bend; 3],
        ..Material::default()
    };
    // Started bent sideways by a fifth, so that it falls to the buckled side.
    let cloth = flat.cloth(material, |p| {
        let s = (p.x / LENGTH).max(0.0);
        Vec3::new(p.x, p.y, 0.2 * LENGTH * s * s)
    });
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    for v in flat.chosen(|p| clamped(p.x, cell)) {
        builder.pinned[v as usize] = true;
    }
    let mut positions = cloth.positions;
    for (v, p) in positions.iter_mut().enumerate() {
        if builder.pinned[v] {
            p.z = 0.0;
        }
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, positions);
    to_rest(&system, &mut state, 1e-6)?;
    let tip = flat.chosen(|p| p.x > LENGTH - 1e-9);
    Ok(crate::settle::mean(&state.positions, &tip).z / LENGTH)
}
