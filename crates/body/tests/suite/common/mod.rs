//! What several tests need.

pub mod freesewing;
pub mod survey;

use std::path::{Path, PathBuf};
use toile_body::Mannequin;
use toile_geometry::{TriangleMesh, Vec3};

/// A file of the test material, where it is present; says so where it is not.
pub fn shared(file: &str) -> Option<PathBuf> {
    let found = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("shared/data").join(file))
        .find(|path| path.is_file());
    if found.is_none() {
        println!("skipped: no shared data folder");
    }
    found
}

/// Whether a body's skin is one closed, outward surface that nowhere crosses itself.
pub fn is_sound(body: &Mannequin) -> bool {
    survey::is_closed(body.skin()) && body.skin_tree().self_intersections().is_empty()
}

/// Positions and triangles of a plain OBJ file of triangles and quads.
pub fn obj(text: &str) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                mesh.positions.push(Vec3::new(p[0], p[1], p[2]));
            }
            Some("f") => {
                let corner = |w: &str| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
                let f: Vec<u32> = words.map(corner).collect();
                for k in 2..f.len() {
                    mesh.triangles.push([f[0], f[k - 1], f[k]]);
                }
            }
            _ => {}
        }
    }
    mesh
}
