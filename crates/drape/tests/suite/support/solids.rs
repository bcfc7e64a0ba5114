//! Solid bodies that tests share, their surfaces closed and turned outward.

use toile_geometry::{TriangleMesh, Vec3};

/// A block between two corners.
pub fn block(low: Vec3, high: Vec3) -> TriangleMesh {
    let corner = |k: usize| {
        let at = |axis: usize| [low, high][k >> axis & 1][axis];
        Vec3::new(at(0), at(1), at(2))
    };
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: vec![
            [0, 2, 3],
            [0, 3, 1],
            [4, 5, 7],
            [4, 7, 6],
            [0, 1, 5],
            [0, 5, 4],
            [2, 6, 7],
            [2, 7, 3],
            [0, 4, 6],
            [0, 6, 2],
            [1, 3, 7],
            [1, 7, 5],
        ],
    }
}

/// A surface over two angles or an angle and a length: `rows` rings of `around` points, rows joined
/// in a ring where `closed`, else capped.
fn rings(
    rows: usize,
    around: usize,
    closed: bool,
    place: impl Fn(usize, usize) -> Vec3,
) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for j in 0..rows {
        mesh.positions.extend((0..around).map(|i| place(j, i)));
    }
    let at = |j: usize, i: usize| (j % rows * around + i % around) as u32;
    for j in 0..if closed { rows } else { rows - 1 } {
        for i in 0..around {
            let [a, b, c, d] = [at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    if !closed {
        for (j, turned) in [(0, true), (rows - 1, false)] {
            let ring = j * around..(j + 1) * around;
            let middle = mesh.positions[ring].iter().sum::<Vec3>() / around as f64;
            let tip = mesh.positions.len() as u32;
            mesh.positions.push(middle);
            for i in 0..around {
                let (a, b) = (at(j, i), at(j, i + 1));
                mesh.triangles
                    .push(if turned { [a, tip, b] } else { [a, b, tip] });
            }
        }
    }
    mesh
}

fn angle(k: usize, of: usize) -> f64 {
    2.0 * std::f64::consts::PI * k as f64 / of as f64
}

/// A cylinder along z about the origin.
pub fn cylinder(radius: f64, length: f64, around: usize) -> TriangleMesh {
    rings(9, around, false, |j, i| {
        let (sine, cosine) = angle(i, around).sin_cos();
        let z = length * (j as f64 / 8.0 - 0.5);
        Vec3::new(radius * cosine, radius * sine, z)
    })
}

/// A ring about y: the radius of its middle line and of its tube.
pub fn torus(large: f64, small: f64) -> TriangleMesh {
    rings(64, 24, true, |j, i| {
        let (cosine, sine) = angle(j, 64).sin_cos();
        let (up, out) = angle(i, 24).sin_cos();
        let reach = large + small * out;
        Vec3::new(reach * sine, small * up, reach * cosine)
    })
}

/// A sphere.
pub fn sphere(radius: f64, centre: Vec3) -> TriangleMesh {
    let rows = 24;
    rings(rows, 48, false, |j, i| {
        let (sine, cosine) = angle(i, 48).sin_cos();
        // The first and last ring are small, not points.
        let polar = std::f64::consts::PI * (j as f64 + 0.25) / (rows as f64 - 0.5);
        let flat = radius * polar.sin();
        centre + Vec3::new(flat * cosine, flat * sine, -radius * polar.cos())
    })
}
