//! Friction on an incline, and of cloth on cloth.

use crate::check::{Cases, Expected};
use crate::{Flat, LabError, MeshKind, Tolerance, rectangle};
use std::sync::Arc;
use toile_drape::{Cloth, Collider, Material, MethodKind, State, System, SystemBuilder};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};

/// Friction coefficient of the cloth.
const MU: f64 = 0.4;
/// Step of implicit Euler (s).
const SHORT_STEP: f64 = 1.0 / 500.0;

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

/// Acceleration of a cloth down a board inclined by an angle (m/s2), once it lies, and how far it
/// moves in a fifth of a second (m).
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
    let all: Vec<u32> = (0..flat.points.len() as u32).collect();
    let state = State::at_rest(&system, cloth.positions);
    motion(
        &system,
        state,
        (MethodKind::ImplicitEuler, SHORT_STEP),
        &all,
    )
}

/// Mean acceleration of some vertices along x (m/s2) in the fifth of a second after the first tenth, and how far they
/// move in it (m).
fn motion(
    system: &System,
    mut state: State,
    (kind, step): (MethodKind, f64),
    vertices: &[u32],
) -> Result<[f64; 2], LabError> {
    let velocity = |s: &State| crate::settle::mean(&s.velocities, vertices).x;
    let place = |s: &State| crate::settle::mean(&s.positions, vertices).x;
    crate::settle::in_time(system, &mut state, kind.into(), [step, 0.1], |_| {})?;
    let before = [velocity(&state), place(&state)];
    crate::settle::in_time(system, &mut state, kind.into(), [step, 0.2], |_| {})?;
    Ok([
        (velocity(&state) - before[0]) / 0.2,
        place(&state) - before[1],
    ])
}

/// [`slide`] of a cloth on another that is held, by a method and its step. The one below is coarse: no edge of it
/// stands in the way.
fn slide_on_cloth(method: (MethodKind, f64), angle: f64) -> Result<[f64; 2], LabError> {
    let sheet = |half: f64, cells| {
        let (low, high) = (Vec2::new(-half, -half), Vec2::new(half, half));
        rectangle(MeshKind::Alternating, low, high, cells)
    };
    let (below, above) = (sheet(0.4, [3, 3])?, sheet(0.05, [4, 4])?);
    let thickness = 1e-3;
    let mut mesh = TriangleMesh::default();
    for (flat, height) in [(&below, 0.0), (&above, thickness)] {
        let first = mesh.positions.len() as u32;
        let places = flat.points.iter().map(|p| Vec3::new(p.x, height, p.y));
        mesh.positions.extend(places);
        let corners = flat.triangles.iter().map(|t| t.map(|v| v + first));
        mesh.triangles.extend(corners);
    }
    let material = Material {
        friction: MU,
        thickness,
        ..Material::default()
    };
    let cloth = Cloth::from_mesh("two", &mesh, material)?;
    let mut builder = SystemBuilder::new("two", &cloth)?;
    builder.contact.cloth_offset = thickness;
    builder.pinned[..below.points.len()].fill(true);
    builder.control.gravity = Vec3::new(angle.sin(), -angle.cos(), 0.0) * 9.81;
    let system = builder.build();
    let moving: Vec<u32> = (below.points.len() as u32..mesh.positions.len() as u32).collect();
    let state = State::at_rest(&system, mesh.positions);
    motion(&system, state, method, &moving)
}

/// How far a cloth that sticks moves, and how one that slides gathers speed.
const STICKS: Tolerance = Tolerance::zero("moved/(g t2/2)", "the free fall", 1e-3);
const SLIDES: Tolerance = Tolerance::value("acceleration, m/s2", 0.01);
pub(super) const INCLINE: [Tolerance; 2] = [STICKS, SLIDES];

/// A cloth on a board sticks while tan(angle) <= mu, else slides by g (sin - mu cos).
pub(super) fn incline(cases: &mut Cases) -> Result<(), LabError> {
    coulomb(cases, "", &[1.01, 1.5, 2.5], slide)
}

/// The same of a cloth on a cloth, by two methods.
pub(super) fn cloth_on_cloth(cases: &mut Cases) -> Result<(), LabError> {
    // A hundredth above the angle gravity and friction nearly cancel, to the rounding of single precision.
    let [all, fast]: [&[f64]; 2] = [&[1.01, 1.5, 2.5], &[1.5, 2.5]];
    for (kind, step, slides) in [
        (MethodKind::ImplicitEuler, SHORT_STEP, all),
        (MethodKind::Xpbd, 1.0 / 120.0, fast),
    ] {
        let name = format!(", {}", kind.name());
        coulomb(cases, &name, slides, |angle| {
            slide_on_cloth((kind, step), angle)
        })?;
    }
    Ok(())
}

/// Sticking below the angle of friction, and sliding at some tangents over its own; `slide` gives acceleration and
/// displacement.
fn coulomb(
    cases: &mut Cases,
    name: &str,
    slides: &[f64],
    slide: impl Fn(f64) -> Result<[f64; 2], LabError>,
) -> Result<(), LabError> {
    for share in [0.5, 0.99] {
        let angle = (share * MU).atan();
        cases.measure(
            format!("tan(angle) {share} of mu{name}"),
            Expected::zero(STICKS, 0.5 * 9.81 * 0.04),
            || slide(angle).map(|[_, moved]| moved),
        )?;
    }
    for share in slides {
        let angle = (share * MU).atan();
        let expected = 9.81 * (angle.sin() - MU * angle.cos());
        cases.measure(
            format!("tan(angle) {share} of mu{name}"),
            Expected::value(SLIDES, expected),
            || slide(angle).map(|[acceleration, _]| acceleration),
        )?;
    }
    Ok(())
}
