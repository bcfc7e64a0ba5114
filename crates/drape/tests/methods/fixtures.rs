//! Small cloths that the tests share.

use std::sync::Arc;
use toile_drape::{Cloth, Collider, Material, Method, MethodKind, MethodSettings, Model, State};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// A grid of `cells` over `size` [m] in a plane, alternating diagonals.
pub fn sheet(cells: [usize; 2], size: [f64; 2], place: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for j in 0..=cells[1] {
        for i in 0..=cells[0] {
            mesh.positions.push(place(
                size[0] * i as f64 / cells[0] as f64,
                size[1] * j as f64 / cells[1] as f64,
            ));
        }
    }
    let at = |i: usize, j: usize| (j * (cells[0] + 1) + i) as u32;
    for j in 0..cells[1] {
        for i in 0..cells[0] {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if (i + j) % 2 == 0 {
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                mesh.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    mesh
}

/// The model of a mesh and its state at rest.
pub fn cloth(mesh: &TriangleMesh, material: Material) -> (Model, State) {
    let cloth = Cloth::from_mesh("cloth", mesh, material).expect("sound");
    let model = Model::new("cloth", &cloth).expect("sound");
    let state = State::at_rest(&model, mesh.positions.clone());
    (model, state)
}

/// A soft square of 0.3 m, 6 x 6 cells, hanging in the xy plane from its upper row.
pub fn hanging_square() -> (Model, State) {
    let mesh = sheet([6, 6], [0.3, 0.3], |u, v| Vec3::new(u, 1.0 - v, 0.0));
    let material = Material {
        stretch: [60.0, 50.0],
        shear: 15.0,
        ..Material::default()
    };
    let (mut model, state) = cloth(&mesh, material);
    model.pinned[..7].fill(true);
    (model, state)
}

/// A fixed number in -1..1 for an index.
pub fn scatter(index: usize) -> f64 {
    let x = (index as f64 * 12.9898 + 0.37).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// Moves the free vertices by up to `amplitude` [m].
pub fn shake(model: &Model, state: &mut State, amplitude: f64) {
    for (v, x) in state.positions.iter_mut().enumerate() {
        if !model.pinned[v] {
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
    settings.build()
}

/// A solid ball at the origin.
pub fn ball(radius: f64) -> Collider {
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
    Collider::new(Arc::new(SurfaceTree::new(mesh)))
}
