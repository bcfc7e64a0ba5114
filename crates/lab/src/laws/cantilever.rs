//! The heavy cantilever: the law of bending under weight.

use crate::check::{Cases, Expected};
use crate::elastica::heavy_elastica;
use crate::settle::{TIGHT, mean, to_rest};
use crate::{LabError, MeshKind, rectangle};
use std::time::Instant;
use toile_drape::{Material, Model, State};
use toile_geometry::{Vec2, Vec3};

/// Length of the strip [m], its mass per area [kg/m2], and gravity [m/s2].
const LENGTH: f64 = 0.2;
const DENSITY: f64 = 0.2;
const GRAVITY: f64 = 9.81;

/// Membrane stiffness Y L^2 / D where a case does not say otherwise: the strip stretches by
/// Gamma 1e-6 of its length.
const STIFF: f64 = 1e6;

/// A strip of so many elements, its width a fifth of its length, clamped at x = 0.
///
/// The clamp holds two rows of points, half a cell before and behind x = 0: the strip keeps its
/// slope there to second order.
struct Strip {
    kind: MeshKind,
    elements: usize,
    gamma: f64,
    stiffness: f64,
}

impl Strip {
    /// Gamma = rho g L^3 / D.
    fn bend(&self) -> f64 {
        DENSITY * GRAVITY * LENGTH.powi(3) / self.gamma
    }

    /// Drop and reach of the tip at rest, as shares of the length.
    fn settle(&self) -> Result<[f64; 2], LabError> {
        let cell = LENGTH / (self.elements as f64 + 0.5);
        let rows = (self.elements / 5).max(1);
        let (from, to) = (-0.5 * cell, LENGTH);
        let flat = rectangle(
            self.kind,
            Vec2::new(from, 0.0),
            Vec2::new(to, rows as f64 * cell),
            [self.elements + 1, rows],
        )?;
        let bend = self.bend();
        let stretch = self.stiffness * bend / (LENGTH * LENGTH);
        let material = Material {
            density: DENSITY,
            stretch: [stretch; 2],
            shear: 0.5 * stretch,
            poisson: 0.0,
            bend: [bend; 3],
            ..Material::default()
        };
        let cloth = flat.cloth(material, |p| Vec3::new(p.x, 0.0, p.y));
        let mut model = Model::new("strip", &cloth)?;
        for v in flat.chosen(|p| p.x < 0.51 * cell) {
            model.pinned[v as usize] = true;
        }
        let mut state = State::at_rest(&model, cloth.positions);
        to_rest(&model, &mut state, TIGHT)?;
        let tip = mean(&state.positions, &flat.chosen(|p| p.x > to - 1e-9));
        Ok([-tip.y / LENGTH, tip.x / LENGTH])
    }

    fn ratio(&self) -> Result<f64, LabError> {
        self.settle().map(|[drop, reach]| drop / reach)
    }
}

/// Gamma of the master curve.
const GAMMAS: [f64; 11] = [
    0.01, 0.1, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 300.0, 1000.0,
];

/// Drop over reach at 40 elements on four kinds of mesh, and how far these spread.
pub(super) fn heavy(cases: &mut Cases) -> Result<(), LabError> {
    for (k, gamma) in GAMMAS.into_iter().enumerate() {
        let expected = heavy_elastica(gamma).ratio();
        // Second order at 40 elements; where the strip turns within a few cells (Gamma above
        // 100: over D/(rho g L^2) of its length) the curve is resolved less well.
        let tolerance = if gamma <= 100.0 { 0.01 } else { 0.03 };
        let mut found = Vec::new();
        let start = Instant::now();
        for (m, (name, kind)) in MeshKind::ALL.into_iter().enumerate() {
            let share = (k as f64 + 0.25 * m as f64) / GAMMAS.len() as f64;
            cases.tell(share, &format!("Gamma {gamma}, {name}"))?;
            let case = format!("Gamma {gamma}, {name}");
            let strip = Strip {
                kind,
                elements: 40,
                gamma,
                stiffness: STIFF,
            };
            let measured = cases.measure(
                case,
                Expected::value("h/w", expected, tolerance),
                || strip.ratio(),
            )?;
            found.extend(measured);
        }
        if gamma <= 100.0 && found.len() == MeshKind::ALL.len() {
            let most = found.iter().copied().fold(f64::MIN, f64::max);
            let least = found.iter().copied().fold(f64::MAX, f64::min);
            cases.add(
                format!("Gamma {gamma}, spread between meshes"),
                Expected::zero("(max-min)/mean", 1.0, 0.005),
                Ok((most - least) / expected),
                start,
            )?;
        }
    }
    Ok(())
}

/// Elements along the strip, and the error allowed there: second order from 0.16 at 5.
const ELEMENTS: [usize; 4] = [5, 10, 20, 40];

/// How discretisation stiffens: elements and membrane stiffness.
pub(super) fn resolution(cases: &mut Cases) -> Result<(), LabError> {
    let expected = heavy_elastica(10.0).ratio();
    for (_name, stiffness) in [("1e4", 1e4), ("1e6", 1e6), ("1e8", 1e8)] {
        for elements in ELEMENTS {
            for (name, kind) in MeshKind::ALL {
                let strip = Strip {
                    kind,
                    elements,
                    gamma: 10.0,
                    stiffness,
                };
                cases.measure(
                    format!("{name}, {elements} elements, Y L2/D {stiffness:.0e}"),
                    Expected::value("h/w", expected, 0.03),
                    || strip.ratio(),
                )?;
            }
        }
    }
    Ok(())
}

/// Slope of the error against the cell.
pub(super) fn order(_cases: &mut Cases) -> Result<(), LabError> {
    Ok(())
}

/// The overhang at which the chord falls by 41.5 degrees.
pub(super) fn peirce(_cases: &mut Cases) -> Result<(), LabError> {
    Ok(())
}
