//! Synthetic surfaces for the pictures' tests.

use std::f64::consts::PI;
use toile_geometry::{TriangleMesh, Vec3};

/// A surface over a rectangle of parameters 0..=1, wound so that `du x dv` points outward.
pub fn sheet(columns: u32, rows: u32, at: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for j in 0..=rows {
        for i in 0..=columns {
            mesh.positions.push(at(
                f64::from(i) / f64::from(columns),
                f64::from(j) / f64::from(rows),
            ));
        }
    }
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let b = a + columns + 1;
            mesh.triangles.push([a, a + 1, b]);
            mesh.triangles.push([a + 1, b + 1, b]);
        }
    }
    mesh
}

/// A ball.
pub fn sphere(centre: Vec3, radius: f64, rows: u32) -> TriangleMesh {
    sheet(2 * rows, rows, |u, v| {
        let (a, b) = (2.0 * PI * u, PI * (v - 0.5));
        centre + radius * Vec3::new(a.sin() * b.cos(), b.sin(), a.cos() * b.cos())
    })
}

/// An upright tube with half-balls at its ends, standing on the ground.
pub fn capsule(radius: f64, height: f64) -> TriangleMesh {
    sheet(96, 96, |u, v| {
        let a = 2.0 * PI * u;
        let b = PI * (v - 0.5);
        let lift = if v < 0.5 { radius } else { height - radius };
        Vec3::new(
            radius * a.sin() * b.cos(),
            lift + radius * b.sin(),
            radius * a.cos() * b.cos(),
        )
    })
}

/// A flared tube with folds that grow towards the hem, round a capsule.
pub fn skirt(columns: u32, rows: u32) -> TriangleMesh {
    sheet(columns, rows, |u, v| {
        let a = 2.0 * PI * u;
        let down = 1.0 - v;
        let fold = 0.055 * down.powf(1.3) * (11.0 * a + 1.2 * (3.0 * a).sin()).sin();
        let radius = 0.215 + 0.16 * down + fold;
        let hem = 0.015 * (5.0 * a).sin() * down;
        Vec3::new(radius * a.sin(), 0.62 + 0.62 * v + hem, radius * a.cos())
    })
}
