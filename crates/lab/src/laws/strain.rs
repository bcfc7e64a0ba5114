//! Laws of the membrane: patch, rigid motion, uniaxial stretch, picture frame.

use crate::check::{Cases, Expected};
use crate::settle::to_rest;
use crate::{Flat, LabError, MeshKind, Tolerance, rectangle};
use nalgebra::{Matrix2, Rotation3};
use toile_drape::{Material, State, SystemBuilder, Workspace};
use toile_geometry::{Vec2, Vec3};

const LENGTH: f64 = 0.2;
const WIDTH: f64 = 0.1;

/// Rounding of forces against the stiffness times the width.
const EXACT: f64 = 1e-12;

const INSIDE: Tolerance = Tolerance::zero("force/(Y w)", "stiffness times width", EXACT);
const RESULTANT: Tolerance = Tolerance::zero("difference/(Y w)", "stiffness times width", EXACT);
pub(super) const PATCH: [Tolerance; 2] = [INSIDE, RESULTANT];
pub(super) const RIGID: [Tolerance; 1] = [INSIDE];

/// The pull of a strip at rest, and the work of a frame to rounding.
const PULL: Tolerance = Tolerance::value("force/width, N/m", 1e-4);
const WORK: Tolerance = Tolerance::value("force/length, N/m", 1e-10);
pub(super) const UNIAXIAL: [Tolerance; 1] = [PULL];
pub(super) const PICTURE_FRAME: [Tolerance; 1] = [WORK];

fn sheet(kind: MeshKind) -> Result<Flat, LabError> {
    let (from, to) = (Vec2::new(-0.1, -0.05), Vec2::new(0.1, 0.05));
    rectangle(kind, from, to, [16, 8])
}

/// An orthotropic cloth with everything different.
fn weave() -> Material {
    Material {
        density: 0.2,
        stretch: [600.0, 300.0],
        shear: 60.0,
        poisson: 0.3,
        ..Material::default()
    }
}

/// Turned in space, so that no axis is special.
fn turned(p: Vec3) -> Vec3 {
    Rotation3::from_euler_angles(0.3, -0.7, 1.1) * p + Vec3::new(0.05, 0.1, -0.2)
}

/// The forces of a cloth whose points are put somewhere, nothing pinned, no gravity (N).
fn forces(
    flat: &Flat,
    material: Material,
    place: impl Fn(Vec2) -> Vec3,
) -> Result<Vec<Vec3>, LabError> {
    let cloth = flat.cloth(material, place);
    let mut builder = SystemBuilder::new("sheet", &cloth)?;
    builder.control.gravity = Vec3::zeros();
    let system = builder.build();
    let state = State::at_rest(&system, cloth.positions);
    Ok(Workspace::default().net_force(&system, &state).to_vec())
}

fn largest(forces: &[Vec3], chosen: &[u32]) -> f64 {
    chosen
        .iter()
        .map(|&v| forces[v as usize].norm())
        .fold(0.0, f64::max)
}

/// Second Piola-Kirchhoff stress of the weave under a deformation gradient (N/m).
fn stress(f: Matrix2<f64>) -> Matrix2<f64> {
    let Material {
        stretch: [warp, weft],
        shear,
        poisson,
        ..
    } = weave();
    let spread = 1.0 - poisson * poisson;
    let c12 = poisson * (warp * weft).sqrt() / spread;
    let (c11, c22) = (warp / spread, weft / spread);
    let green = (f.transpose() * f - Matrix2::identity()) * 0.5;
    let (uu, vv, gamma) = (green[(0, 0)], green[(1, 1)], 2.0 * green[(0, 1)]);
    Matrix2::new(
        c11 * uu + c12 * vv,
        shear * gamma,
        shear * gamma,
        c22 * vv + c12 * uu,
    )
}

/// A linear displacement gives the same stress everywhere: no force inside, the exact resultant
/// at the edge.
pub(super) fn patch(cases: &mut Cases) -> Result<(), LabError> {
    let f = Matrix2::new(1.05, 0.03, 0.02, 0.97);
    let place = |p: Vec2| {
        let q = f * p;
        turned(Vec3::new(q.x, q.y, 0.0))
    };
    let scale = 600.0 * WIDTH;
    for (name, kind) in MeshKind::ALL {
        let flat = sheet(kind)?;
        let inside = flat.chosen(|p| p.x.abs() < 0.1 - 1e-9 && p.y.abs() < 0.05 - 1e-9);
        let edge = flat.chosen(|p| p.x > 0.1 - 1e-9);
        let found = forces(&flat, weave(), place)?;
        cases.measure(
            format!("{name}, force inside"),
            Expected::zero(INSIDE, scale),
            || Ok(largest(&found, &inside)),
        )?;
        // First Piola-Kirchhoff traction F S e_u on the edge, pulling inwards, but for half of
        // what the two corners carry for the other edges: take the edge's interior and correct.
        let traction = f * stress(f) * Vec2::new(1.0, 0.0) * WIDTH;
        let sum: Vec3 = edge.iter().map(|&v| found[v as usize]).sum();
        let (top, bottom) = (Vec2::new(0.0, 1.0), Vec2::new(0.0, -1.0));
        let half = |side: Vec2| {
            let end = flat.chosen(|p| p.x > 0.1 - 1e-9 && p.y * side.y > 0.05 - 1e-9);
            let lengths: f64 = end.iter().map(|&v| edge_along(&flat, v)).sum();
            f * stress(f) * side * (0.5 * lengths)
        };
        let expected = traction + half(top) + half(bottom);
        let expected = turned(Vec3::new(expected.x, expected.y, 0.0)) - turned(Vec3::zeros());
        cases.measure(
            format!("{name}, resultant at the edge"),
            Expected::zero(RESULTANT, scale),
            || Ok((sum + expected).norm()),
        )?;
    }
    Ok(())
}

/// Length of the outline's edge that leaves a corner along the strip (m).
fn edge_along(flat: &Flat, corner: u32) -> f64 {
    let at = flat.points[corner as usize];
    flat.points
        .iter()
        .filter(|p| p.y == at.y && p.x < at.x)
        .map(|p| at.x - p.x)
        .fold(f64::INFINITY, f64::min)
}

/// A rigid motion makes no force.
pub(super) fn rigid(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in MeshKind::ALL {
        let flat = sheet(kind)?;
        let all = flat.chosen(|_| true);
        let found = forces(&flat, weave(), |p| turned(Vec3::new(p.x, p.y, 0.0)))?;
        cases.measure(name, Expected::zero(INSIDE, 600.0 * WIDTH), || {
            Ok(largest(&found, &all))
        })?;
    }
    Ok(())
}

/// A strip drawn out narrows freely and pulls with Y l (l^2 - 1) / 2 per width.
pub(super) fn uniaxial(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in MeshKind::ALL {
        for stretch in [1.01, 1.1, 1.3] {
            let expected = 600.0 * stretch * (stretch * stretch - 1.0) / 2.0;
            cases.measure(
                format!("{name}, stretched to {stretch}"),
                Expected::value(PULL, expected),
                || pull(kind, stretch),
            )?;
        }
    }
    Ok(())
}

/// Force per width of a strip held at both ends where uniaxial stress puts them; the rest finds
/// its place from a disturbed start.
fn pull(kind: MeshKind, stretch: f64) -> Result<f64, LabError> {
    let material = weave();
    // No stress across: E_vv = -C12/C22 E_uu = -nu sqrt(Y1/Y2) E_uu.
    let green = 0.5 * (stretch * stretch - 1.0);
    let across = -material.poisson * (material.stretch[0] / material.stretch[1]).sqrt() * green;
    let narrow = (1.0 + 2.0 * across).max(0.0).sqrt();
    let flat = sheet(kind)?;
    let cloth = flat.cloth(material, |p| Vec3::new(p.x * stretch, p.y * narrow, 0.0));
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    builder.control.gravity = Vec3::zeros();
    let ends = flat.chosen(|p| p.x.abs() > 0.1 - 1e-9);
    for &v in &ends {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    for (v, p) in state.positions.iter_mut().enumerate() {
        if !system.prescribed.pinned[v] {
            let k = v as f64;
            *p += Vec3::new((1.3 * k).sin(), (1.7 * k).cos(), 0.0) * 5e-5;
        }
    }
    to_rest(&system, &mut state, 1e-6)?;
    let system = system.with(|builder| {
        ends.iter()
            .for_each(|&v| builder.pinned[v as usize] = false);
    });
    let mut workspace = Workspace::default();
    let forces = workspace.net_force(&system, &state);
    let right = flat.chosen(|p| p.x > 0.1 - 1e-9);
    let total: f64 = right.iter().map(|&v| -forces[v as usize].x).sum();
    Ok(total / WIDTH)
}

/// A frame of fixed sides sheared by an angle works with G sin(gamma) cos(gamma) per area.
pub(super) fn picture_frame(cases: &mut Cases) -> Result<(), LabError> {
    let shear = weave().shear;
    for (name, kind) in MeshKind::ALL {
        for angle in [0.1f64, 0.3, 0.6] {
            let expected = shear * angle.sin() * angle.cos();
            cases.measure(
                format!("{name}, sheared by {angle} rad"),
                Expected::value(WORK, expected),
                || {
                    let flat = sheet(kind)?;
                    let found = forces(&flat, weave(), |p| {
                        turned(Vec3::new(p.x + p.y * angle.sin(), p.y * angle.cos(), 0.0))
                    })?;
                    // Virtual work: forces times how places move with the angle.
                    let work: f64 = flat
                        .points
                        .iter()
                        .zip(&found)
                        .map(|(p, force)| {
                            let moved = Vec3::new(p.y * angle.cos(), -p.y * angle.sin(), 0.0);
                            -force.dot(&(turned(moved) - turned(Vec3::zeros())))
                        })
                        .sum();
                    Ok(work / (LENGTH * WIDTH))
                },
            )?;
        }
    }
    Ok(())
}
