//! Hanging strips: stretched by their own weight, and between two supports.

use crate::check::{Cases, Expected};
use crate::root::bisect;
use crate::settle::{TIGHT, mean, to_rest};
use crate::{LabError, MeshKind, Tolerance, rectangle};
use toile_drape::{Material, State, SystemBuilder, Workspace};
use toile_geometry::{Vec2, Vec3};

const DENSITY: f64 = 0.2;
const GRAVITY: f64 = 9.81;
const LENGTH: f64 = 0.5;
const WIDTH: f64 = 0.1;

/// A strip that bends next to nothing.
fn limp(stretch: f64) -> Material {
    Material {
        density: DENSITY,
        stretch: [stretch; 2],
        shear: 0.5 * stretch,
        poisson: 0.0,
        bend: [1e-8; 3],
        ..Material::default()
    }
}

/// Lengthening of a hung Saint Venant-Kirchhoff strip (m): at height s above the tip it carries
/// rho g s = Y l (l^2 - 1) / 2 per width at stretch l.
pub(crate) fn lengthening(stretch: f64, length: f64) -> f64 {
    let pieces = 2000;
    (0..pieces)
        .map(|k| {
            let load = DENSITY * GRAVITY * length * (f64::from(k) + 0.5) / f64::from(pieces);
            let l = bisect(1.0, 10.0, |l| stretch * l * (l * l - 1.0) / 2.0 - load);
            (l - 1.0) * length / f64::from(pieces)
        })
        .sum()
}

/// How far the tip sinks, of second order in the cell, and what the edge carries, to the rest.
const SINKS: Tolerance = Tolerance::value("tip sinks, m", 2e-3);
const CARRIES: Tolerance = Tolerance::value("tension at top, N", 1e-4);
pub(super) const ELASTIC: [Tolerance; 2] = [SINKS, CARRIES];

/// A strip hung by its edge: how far its tip sinks, and what its edge carries.
pub(super) fn elastic(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in MeshKind::ALL {
        for stretch in [20.0, 200.0] {
            let outcome = hung(kind, stretch, 40);
            let (sunk, carried) = match outcome {
                Ok([sunk, carried]) => (Ok(sunk), Ok(carried)),
                Err(error) => {
                    let again = error.to_string();
                    let carried = Err(toile_drape::DrapeError::Scene {
                        place: "hang".to_owned(),
                        what: again,
                        remedy: "see the case before".to_owned(),
                    });
                    (Err(error), carried.map_err(LabError::from))
                }
            };
            let expected = lengthening(stretch, LENGTH);
            cases.measure(
                format!("{name}, Y {stretch} N/m"),
                Expected::value(SINKS, expected),
                || sunk,
            )?;
            let weight = DENSITY * GRAVITY * LENGTH * WIDTH;
            cases.measure(
                format!("{name}, Y {stretch} N/m"),
                Expected::value(CARRIES, weight),
                || carried,
            )?;
        }
    }
    Ok(())
}

/// Relative error of the lengthening of a hung strip with Y L^2 / D as given, at a lengthening
/// near one in a hundred.
pub(crate) fn stiffening(kind: MeshKind, stiffness: f64, elements: usize) -> Result<f64, LabError> {
    let stretch = 50.0 * DENSITY * GRAVITY * LENGTH;
    let bend = stretch * LENGTH * LENGTH / stiffness;
    let [sunk, _] = hung_with(
        kind,
        Material {
            bend: [bend; 3],
            ..limp(stretch)
        },
        elements,
    )?;
    Ok(sunk / lengthening(stretch, LENGTH) - 1.0)
}

/// How far the tip of a limp hung strip sinks (m), and what the edge carries (N).
pub(crate) fn hung(kind: MeshKind, stretch: f64, elements: usize) -> Result<[f64; 2], LabError> {
    hung_with(kind, limp(stretch), elements)
}

/// How far the tip of a hung strip sinks (m), and what the edge carries (N).
fn hung_with(kind: MeshKind, material: Material, elements: usize) -> Result<[f64; 2], LabError> {
    let rows = (elements / 5).max(1);
    let flat = rectangle(
        kind,
        Vec2::zeros(),
        Vec2::new(LENGTH, WIDTH),
        [elements, rows],
    )?;
    let cloth = flat.cloth(material, |p| Vec3::new(0.0, -p.x, p.y));
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    let top = flat.chosen(|p| p.x < 1e-9);
    for &v in &top {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    to_rest(&system, &mut state, TIGHT)?;
    let tip = mean(&state.positions, &flat.chosen(|p| p.x > LENGTH - 1e-9)).y;
    let system = system.with(|builder| {
        top.iter().for_each(|&v| builder.pinned[v as usize] = false);
    });
    let mut workspace = Workspace::default();
    let forces = workspace.net_force(&system, &state);
    let carried: f64 = top.iter().map(|&v| -forces[v as usize].y).sum();
    Ok([-tip - LENGTH, carried])
}

/// How far the strip sags.
const SAG: Tolerance = Tolerance::value("sag, m", 5e-3);
pub(super) const CATENARY: [Tolerance; 1] = [SAG];

/// A strip slung between two supports: y = a cosh(x/a), L = 2 a sinh(d/2a).
pub(super) fn catenary(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in MeshKind::ALL {
        for span in [0.4, 0.7, 0.95] {
            let distance = span * LENGTH;
            let a = bisect(0.05 * distance, 50.0 * distance, |a| {
                2.0 * a * (0.5 * distance / a).sinh() - LENGTH
            });
            let expected = a * ((0.5 * distance / a).cosh() - 1.0);
            cases.measure(
                format!("{name}, supports {span} L apart"),
                Expected::value(SAG, expected),
                || sag(kind, distance),
            )?;
        }
    }
    Ok(())
}

fn sag(kind: MeshKind, distance: f64) -> Result<f64, LabError> {
    let flat = rectangle(kind, Vec2::zeros(), Vec2::new(LENGTH, 0.05), [80, 8])?;
    // Start: half a sine wave of the same length.
    let pi = std::f64::consts::PI;
    let arc = |high: f64| -> f64 {
        let pieces = 400;
        (0..pieces)
            .map(|k| {
                let s = (f64::from(k) + 0.5) / f64::from(pieces);
                distance.hypot(high * pi * (pi * s).cos()) / f64::from(pieces)
            })
            .sum()
    };
    let high = bisect(0.0, LENGTH, |high| arc(high) - LENGTH);
    let cloth = flat.cloth(limp(1e4), |p| {
        let s = p.x / LENGTH;
        Vec3::new(distance * s, -high * (pi * s).sin(), p.y)
    });
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    for v in flat.chosen(|p| p.x < 1e-9 || p.x > LENGTH - 1e-9) {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    to_rest(&system, &mut state, 1e-5)?;
    Ok(-state.positions.iter().map(|p| p.y).fold(0.0, f64::min))
}
