//! Surfaces with known shape.

use toile_drape::laws::stretch::MembraneLaw;
use toile_flatten::Options;
use toile_geometry::{TriangleMesh, Vec3};

/// A grid of `columns` by `rows` cells, each cut along one diagonal; that of the first cell runs from its first corner.
pub fn grid(columns: usize, rows: usize, place: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
    checkered(columns, rows, 0, place)
}

/// The same with the diagonals of the first cell and every second one from it by a parity, 0 or 1.
pub fn checkered(
    columns: usize,
    rows: usize,
    parity: usize,
    place: impl Fn(f64, f64) -> Vec3,
) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for j in 0..=rows {
        for i in 0..=columns {
            mesh.positions
                .push(place(i as f64 / columns as f64, j as f64 / rows as f64));
        }
    }
    let at = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
    for j in 0..rows {
        for i in 0..columns {
            let (a, b) = (at(i, j), at(i + 1, j));
            let (c, d) = (at(i + 1, j + 1), at(i, j + 1));
            // Diagonals alternate, so that no direction is preferred.
            if (i + j) % 2 == parity {
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                mesh.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    mesh
}

/// A patch of a sphere of 10 cm between meridians and parallels, so many degrees each way about the equator, facing +z.
pub fn sphere(degrees: f64, cells: usize) -> TriangleMesh {
    grid(cells, cells, on_sphere(degrees))
}

/// The same with the other diagonal in every cell.
pub fn sphere_with_other_diagonals(degrees: f64, cells: usize) -> TriangleMesh {
    checkered(cells, cells, 1, on_sphere(degrees))
}

fn on_sphere(degrees: f64) -> impl Fn(f64, f64) -> Vec3 {
    let half = 0.5 * degrees.to_radians();
    move |u, v| {
        let (longitude, latitude) = (half * (2.0 * u - 1.0), half * (2.0 * v - 1.0));
        Vec3::new(
            longitude.sin() * latitude.cos(),
            latitude.sin(),
            longitude.cos() * latitude.cos(),
        ) * 0.1
    }
}

/// The cloth of the reference values: C 600, 600, 120, G 60 N/m.
pub fn options() -> Options {
    Options {
        law: MembraneLaw::linear([600.0, 600.0, 120.0, 60.0]),
        grain: Vec3::y(),
        strain: 0.02,
        darts: 0,
        cuts: Vec::new(),
        stop: None,
    }
}
