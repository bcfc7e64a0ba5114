//! A strip drawn over a cylinder: tension grows by exp(mu phi) along the arc.

use crate::check::{Cases, Expected};
use crate::{Flat, LabError, MeshKind, Tolerance, rectangle};
use std::f64::consts::PI;
use std::sync::Arc;
use toile_drape::{
    Collider, ContactSettings, Material, MethodKind, MethodSettings, State, System, SystemBuilder,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};

/// Radius of the cylinder (m) and its facets: they lie 4 micrometres inside it.
const RADIUS: f64 = 0.05;
const FACETS: u32 = 256;
/// Free length of the strip on either side (m).
const FREE: f64 = 0.05;
/// Cells along the strip, and across.
const CELLS: [usize; 2] = [80, 2];
/// Membrane stiffness (N/m).
const STRETCH: f64 = 1000.0;
/// How far an end is drawn (m), in how many steps and of what length (s). Tension is read while the
/// end moves, when all the strip slides; its speed, 10 mm/s, is nothing beside that of sound in the
/// cloth, 100 m/s. Friction follows the normal force of the step before, a four-hundredth less at the
/// end.
const DRAWN: f64 = 4e-3;
const STEPS: usize = 400;
const STEP: f64 = 1e-3;

/// A closed cylinder along z.
fn cylinder() -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for z in [-0.1, 0.1] {
        for k in 0..FACETS {
            let angle = 2.0 * PI * f64::from(k) / f64::from(FACETS);
            let (sin, cos) = angle.sin_cos();
            mesh.positions
                .push(Vec3::new(RADIUS * cos, RADIUS * sin, z));
        }
    }
    mesh.positions.push(Vec3::new(0.0, 0.0, -0.1));
    mesh.positions.push(Vec3::new(0.0, 0.0, 0.1));
    let [bottom, top] = [2 * FACETS, 2 * FACETS + 1];
    for k in 0..FACETS {
        let next = (k + 1) % FACETS;
        let (a, b, c, d) = (k, next, k + FACETS, next + FACETS);
        mesh.triangles
            .extend([[a, b, d], [a, d, c], [bottom, b, a], [top, c, d]]);
    }
    mesh
}

/// A strip over the cylinder, half round it, its ends hanging straight down.
fn strip(kind: MeshKind, friction: f64) -> Result<(Flat, System, State), LabError> {
    let radius = RADIUS + ContactSettings::default().offset;
    let half = 0.5 * PI * radius;
    let length = 2.0 * (half + FREE);
    let cell = length / CELLS[0] as f64;
    let flat = rectangle(
        kind,
        Vec2::new(-0.5 * length, 0.0),
        Vec2::new(0.5 * length, cell * CELLS[1] as f64),
        CELLS,
    )?;
    let material = Material {
        density: 0.1,
        stretch: [STRETCH; 2],
        shear: 0.5 * STRETCH,
        poisson: 0.0,
        bend: [1e-7; 3],
        friction,
        ..Material::default()
    };
    let cloth = flat.cloth(material, |p| {
        let beyond = (p.x.abs() - half).max(0.0);
        let (sin, cos) = (p.x.clamp(-half, half) / radius).sin_cos();
        Vec3::new(radius * sin, radius * cos - beyond, p.y)
    });
    let mut builder = SystemBuilder::new("strip", &cloth)?;
    builder.control.gravity = Vec3::zeros();
    let collider = Collider::new(Arc::new(SurfaceTree::new(cylinder())));
    builder.colliders.push(collider);
    for v in flat.chosen(|p| p.x.abs() > 0.5 * length - 1e-9) {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    let state = State::at_rest(&system, cloth.positions);
    Ok((flat, system, state))
}

/// Mean tension along a stretch of the free strip (N/m): S l = Y (l^2 - 1) / 2 l for the stretch l of
/// Saint Venant and Kirchhoff's cloth.
fn tension(flat: &Flat, state: &State, within: [f64; 2]) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for corners in &flat.triangles {
        let rest = corners.map(|v| flat.points[v as usize]);
        if rest.iter().any(|p| p.x < within[0] || p.x > within[1]) {
            continue;
        }
        let [p, q, r] = corners.map(|v| state.positions[v as usize]);
        let (a, b) = (rest[1] - rest[0], rest[2] - rest[0]);
        let twice = a.x * b.y - a.y * b.x;
        // The warp's tangent: the derivative of place along the strip.
        let along = ((q - p) * b.y - (r - p) * a.y) / twice;
        let stretch = along.norm();
        sum += twice.abs() * STRETCH * 0.5 * (stretch * stretch - 1.0) * stretch;
        area += twice.abs();
    }
    sum / area
}

/// Ratio of the tensions at both ends when all of the strip slides to one side.
fn ratio(kind: MeshKind, friction: f64) -> Result<f64, LabError> {
    let (flat, system, mut state) = strip(kind, friction)?;
    let end = flat.points.iter().map(|p| p.x).fold(0.0, f64::max);
    let drawn = flat.chosen(|p| p.x > end - 1e-9);
    let mut method = MethodSettings::from(MethodKind::ImplicitEuler).build()?;
    for _ in 0..STEPS {
        for &v in &drawn {
            state.positions[v as usize].y -= DRAWN / STEPS as f64;
        }
        method.advance(&system, &mut state, STEP)?;
    }
    let [near, far] = [end - 0.8 * FREE, end - 0.2 * FREE];
    Ok(tension(&flat, &state, [near, far]) / tension(&flat, &state, [-far, -near]))
}

/// The coefficient that the tensions tell.
const FRICTION: Tolerance = Tolerance::value("ln(T2/T1)/pi", 0.01);
pub(super) const CAPSTAN: [Tolerance; 1] = [FRICTION];

/// The law of Euler and Eytelwein on two kinds of mesh: T2 / T1 = exp(mu pi), read as mu.
pub(super) fn capstan(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in [("right", MeshKind::Right), ("delaunay", MeshKind::Delaunay)] {
        for friction in [0.1, 0.3, 0.5] {
            cases.measure(
                format!("mu {friction}, {name}"),
                Expected::value(FRICTION, friction),
                || ratio(kind, friction).map(|ratio| ratio.ln() / PI),
            )?;
        }
    }
    Ok(())
}
