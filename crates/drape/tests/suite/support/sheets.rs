//! Sheets of cloth that tests and benchmarks share.

use toile_drape::{Cloth, Material, ObjectKind, SceneObject, State, System};
use toile_geometry::{TriangleMesh, Vec3};

/// A grid of `cells` over `size` (m) in a plane, alternating diagonals.
pub fn sheet(cells: [usize; 2], size: [f64; 2], place: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
    grid(cells, size, true, place)
}

/// [`sheet`], or all diagonals one way.
pub fn grid(
    cells: [usize; 2],
    size: [f64; 2],
    alternate: bool,
    place: impl Fn(f64, f64) -> Vec3,
) -> TriangleMesh {
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
            if !alternate || (i + j) % 2 == 0 {
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                mesh.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    mesh
}

/// The model of a mesh and its state at rest; not for all who share this file.
#[allow(dead_code)]
pub fn cloth(mesh: &TriangleMesh, material: Material) -> (System, State) {
    let cloth = Cloth::from_mesh("cloth", mesh, material).expect("sound");
    let system = System::new("cloth", &cloth).expect("sound");
    let state = State::at_rest(&system, mesh.positions.clone());
    (system, state)
}

/// A cloth of a scene; not for all who share this file.
#[allow(dead_code)]
pub fn object(name: &str, mesh: TriangleMesh, pins: Vec<u32>) -> SceneObject {
    SceneObject {
        name: name.to_owned(),
        kind: ObjectKind::Deformable {
            material: Material::default(),
            pins,
        },
        mesh,
        cloth: None,
        layer: 0,
    }
}
