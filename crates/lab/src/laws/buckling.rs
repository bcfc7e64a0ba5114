//! Lateral buckling of a strip on edge under its own weight.

use crate::check::{Cases, Expected};
use crate::flat::STRAIGHT;
use crate::settle::to_rest;
use crate::{LabError, MeshKind, rectangle};
use toile_drape::{Material, Model, State};
use toile_geometry::{Vec2, Vec3};

/// q L^3 / sqrt(B C) at which a strip clamped on edge gives way sideways under its own weight
/// (Prandtl 1899, Michell 1899).
const PRANDTL: f64 = 12.85;

/// A strip a twelfth as wide as long.
const LENGTH: f64 = 0.1;
const CELLS: [usize; 2] = [48, 4];

/// With nu = 0: B = D w, C = 2 D w, so Gamma = 12.85 sqrt(2).
pub(super) fn lateral(cases: &mut Cases) -> Result<(), LabError> {
    let expected = PRANDTL * 2.0f64.sqrt();
    for (name, kind) in MeshKind::ALL {
        cases.measure(name, Expected::value("Gamma", expected, 0.03), || {
            critical(kind, expected)
        })?;
    }
    Ok(())
}

/// Beyond the critical load the square of the sideways deflection grows in proportion to the
/// excess (a pitchfork): a parabola through three deflections, drawn back to zero.
fn critical(kind: MeshKind, expected: f64) -> Result<f64, LabError> {
    let loads = [1.06, 1.12, 1.18].map(|share| share * expected);
    let mut squares = [0.0; 3];
    for (square, load) in squares.iter_mut().zip(loads) {
        *square = deflection(kind, load)?.powi(2);
    }
    // Load as a quadratic in the square of the deflection, at zero (Lagrange).
    let [a, b, c] = squares;
    Ok(loads[0] * b * c / ((a - b) * (a - c))
        + loads[1] * a * c / ((b - a) * (b - c))
        + loads[2] * a * b / ((c - a) * (c - b)))
}

/// How far the tip stands off sideways, as a share of the length.
fn deflection(kind: MeshKind, gamma: f64) -> Result<f64, LabError> {
    let (density, gravity) = (0.2, 9.81);
    let [columns, rows] = CELLS;
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
    let mut model = Model::new("strip", &cloth)?;
    for v in flat.chosen(|p| p.x < 0.51 * cell) {
        model.pinned[v as usize] = true;
    }
    let mut positions = cloth.positions;
    for (v, p) in positions.iter_mut().enumerate() {
        if model.pinned[v] {
            p.z = 0.0;
        }
    }
    let mut state = State::at_rest(&model, positions);
    to_rest(&model, &mut state, 1e-6)?;
    let tip = flat.chosen(|p| p.x > LENGTH - 1e-9);
    Ok(crate::settle::mean(&state.positions, &tip).z / LENGTH)
}
