//! Friction on an incline.

use crate::check::{Cases, Expected};
use crate::{Flat, LabError, MeshKind, Tolerance, rectangle};
use std::sync::Arc;
use toile_drape::{Collider, Material, MethodKind, State, SystemBuilder};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};

/// Friction coefficient of the cloth.
const MU: f64 = 0.4;

/// A long board, its upper face through the origin.
pub(super) fn board() -> TriangleMesh {
    let (length, width, depth) = (2.0, 0.4, 0.1);
    let mut mesh = TriangleMesh::default();
    for y in [-depth, 0.0] {
        for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            mesh.positions
                .push(Vec3::new(x * length, y, z * 0.5 * width));
        }
    }
    mesh.triangles = vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]];
    for k in 0..4u32 {
        let next = (k + 1) % 4;
        mesh.triangles
            .extend([[k, k + 4, next], [next, k + 4, next + 4]]);
    }
    mesh
}

/// Acceleration of a cloth down a board inclined by an angle [m/s2], once it lies, and how far it
/// moves in a fifth of a second [m].
fn slide(angle: f64) -> Result<[f64; 2], LabError> {
    let flat: Flat = rectangle(
        MeshKind::Alternating,
        Vec2::new(-0.05, -0.05),
        Vec2::new(0.05, 0.05),
        [4, 4],
    )?;
    let material = Material {
        friction: MU,
        ..Material::default()
    };
    let offset = toile_drape::ContactSettings::default().offset;
    let cloth = flat.cloth(material, |p| Vec3::new(p.x, offset, p.y));
    let mut builder = SystemBuilder::new("cloth", &cloth)?;
    builder
        .colliders
        .push(Collider::new(Arc::new(SurfaceTree::new(board()))));
    // The board stays; gravity is inclined.
    builder.control.gravity = Vec3::new(angle.sin(), -angle.cos(), 0.0) * 9.81;
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    let settings = MethodKind::ImplicitEuler.into();
    let velocity =
        |s: &State| s.velocities.iter().map(|v| v.x).sum::<f64>() / s.velocities.len() as f64;
    let step = 1.0 / 500.0;
    crate::settle::in_time(&system, &mut state, settings, [step, 0.1], |_| {})?;
    let before = velocity(&state);
    let all: Vec<u32> = (0..flat.points.len() as u32).collect();
    let from = crate::settle::mean(&state.positions, &all);
    crate::settle::in_time(&system, &mut state, settings, [step, 0.2], |_| {})?;
    let moved = crate::settle::mean(&state.positions, &all) - from;
    Ok([(velocity(&state) - before) / 0.2, moved.x])
}

/// How far a cloth that sticks moves, and how one that slides gathers speed.
const STICKS: Tolerance = Tolerance::zero("moved/(g t2/2)", "the free fall", 1e-3);
const SLIDES: Tolerance = Tolerance::value("acceleration, m/s2", 0.01);
pub(super) const INCLINE: [Tolerance; 2] = [STICKS, SLIDES];

/// A cloth on a board sticks while tan(angle) <= mu, else slides by g (sin - mu cos).
pub(super) fn incline(cases: &mut Cases) -> Result<(), LabError> {
    for share in [0.5, 0.99] {
        let angle = (share * MU).atan();
        cases.measure(
            format!("tan(angle) {share} of mu"),
            Expected::zero(STICKS, 0.5 * 9.81 * 0.04),
            || slide(angle).map(|[_, moved]| moved),
        )?;
    }
    for share in [1.01, 1.5, 2.5] {
        let angle = (share * MU).atan();
        let expected = 9.81 * (angle.sin() - MU * angle.cos());
        cases.measure(
            format!("tan(angle) {share} of mu"),
            Expected::value(SLIDES, expected),
            || slide(angle).map(|[acceleration, _]| acceleration),
        )?;
    }
    Ok(())
}
