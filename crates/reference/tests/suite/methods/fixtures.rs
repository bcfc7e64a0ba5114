//! Small cloths that the tests share.

pub use crate::sheets::{cloth, sheet};
use std::sync::Arc;
use toile_drape::{Collider, Material, Method, MethodKind, MethodSettings, State, System};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// A soft square of 0.3 m, 6 x 6 cells, hanging in the xy plane from its upper row.
pub fn hanging_square() -> (System, State) {
    let mesh = sheet([6, 6], [0.3, 0.3], |u, v| Vec3::new(u, 1.0 - v, 0.0));
    let material = Material {
        stretch: [60.0, 50.0],
        shear: 15.0,
        ..Material::default()
    };
    let (mut system, state) = cloth(&mesh, material);
    system = system.with(|builder| {
        builder.pinned[..7].fill(true);
    });
    (system, state)
}

/// A fixed number in -1..1 for an index.
pub fn scatter(index: usize) -> f64 {
    let x = (index as f64 * 12.9898 + 0.37).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// Moves the free vertices by up to `amplitude` (m).
pub fn shake(system: &System, state: &mut State, amplitude: f64) {
    for (v, x) in state.positions.iter_mut().enumerate() {
        if !system.prescribed.pinned[v] {
            *x += Vec3::from_fn(|axis, _| scatter(3 * v + axis) * amplitude);
        }
    }
}

/// A method with a number of substeps.
pub fn method(kind: MethodKind, substeps: u32) -> Box<dyn Method> {
    let settings = MethodSettings {
        substeps: Some(substeps),
        ..kind.into()
    };
    toile_reference::build(&settings).expect("a method that there is")
}

/// A solid ball at the origin.
pub fn ball(radius: f64) -> Collider {
    Collider::new(Arc::new(SurfaceTree::new(ball_mesh(radius))))
}

/// The surface of a ball at the origin.
pub fn ball_mesh(radius: f64) -> TriangleMesh {
    let (rings, around) = (24u32, 48u32);
    let mut mesh = TriangleMesh::default();
    mesh.positions.push(Vec3::new(0.0, radius, 0.0));
    for ring in 1..rings {
        let down = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        for k in 0..around {
            let turn = std::f64::consts::TAU * f64::from(k) / f64::from(around);
            mesh.positions.push(
                Vec3::new(
                    down.sin() * turn.cos(),
                    down.cos(),
                    -down.sin() * turn.sin(),
                ) * radius,
            );
        }
    }
    mesh.positions.push(Vec3::new(0.0, -radius, 0.0));
    let last = mesh.positions.len() as u32 - 1;
    for k in 0..around {
        let next = (k + 1) % around;
        mesh.triangles.push([0, 1 + k, 1 + next]);
        for ring in 0..rings - 2 {
            let [a, b] = [k, next].map(|k| 1 + ring * around + k);
            mesh.triangles.push([a, a + around, b]);
            mesh.triangles.push([b, a + around, b + around]);
        }
        let [a, b] = [k, next].map(|k| 1 + (rings - 2) * around + k);
        mesh.triangles.push([a, last, b]);
    }
    mesh
}
