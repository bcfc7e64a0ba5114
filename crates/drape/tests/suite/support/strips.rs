//! Strips of cloth on four kinds of mesh.

use toile_drape::{Cloth, Material};
use toile_geometry::{Vec2, Vec3};

/// A kind of triangle mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Right triangles, every diagonal the same way.
    Right,
    /// Right triangles, the diagonals taking turns.
    Alternating,
    /// Delaunay triangles of jittered points.
    Delaunay,
    /// The same with points a twentieth of an edge apart: slivers.
    Slivers,
}

/// Every kind.
pub const KINDS: [Kind; 4] = [
    Kind::Right,
    Kind::Alternating,
    Kind::Delaunay,
    Kind::Slivers,
];

/// A flat strip from `u = -h/2` to `length` along the first axis with `along` elements, its first
/// two columns of vertices straight: pinned, they clamp it at `u = 0`. Returns the cloth, lying in
/// the plane y = 0, and its pins.
pub fn strip(
    kind: Kind,
    length: f64,
    width: f64,
    along: usize,
    material: Material,
) -> (Cloth, Vec<u32>) {
    let h = length / (along as f64 - 0.5);
    let across = ((width / h).round() as usize).max(2);
    let (mut points, triangles) = mesh(kind, along, across);
    for p in &mut points {
        *p = Vec2::new((p.x - 0.5) * h, p.y * width / across as f64);
    }
    let pins = (0..points.len() as u32)
        .filter(|&v| points[v as usize].x < 0.75 * h)
        .collect();
    let cloth = Cloth {
        positions: points.iter().map(|p| Vec3::new(p.x, 0.0, p.y)).collect(),
        rest: triangles
            .iter()
            .map(|t| t.map(|v| points[v as usize]))
            .collect(),
        material: vec![0; triangles.len()],
        panel: vec![0; triangles.len()],
        materials: vec![material],
        triangles,
    };
    (cloth, pins)
}

/// Points on the unit grid of `along` x `across` cells, and triangles.
fn mesh(kind: Kind, along: usize, across: usize) -> (Vec<Vec2>, Vec<[u32; 3]>) {
    let jitter = match kind {
        Kind::Right | Kind::Alternating => 0.0,
        Kind::Delaunay | Kind::Slivers => 0.3,
    };
    let mut points = Vec::new();
    for i in 0..=along {
        for j in 0..=across {
            let s = (i * 31 + j * 17) as f64;
            let inside_u = if i > 1 && i < along { jitter } else { 0.0 };
            let inside_v = if i > 1 && j > 0 && j < across {
                jitter
            } else {
                0.0
            };
            points.push(Vec2::new(
                i as f64 + inside_u * (s * 1.7).sin(),
                j as f64 + inside_v * (s * 2.3).cos(),
            ));
        }
    }
    let at = |i: usize, j: usize| (i * (across + 1) + j) as u32;
    let mut triangles = Vec::new();
    for i in 0..along {
        for j in 0..across {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if kind == Kind::Alternating && (i + j) % 2 == 1 {
                triangles.extend([[a, b, d], [b, c, d]]);
            } else {
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    if kind == Kind::Slivers {
        // A point close beside the middle of one edge in seven cuts two slivers.
        for i in (2..along - 1).step_by(3) {
            for j in (0..across).step_by(2) {
                let t = 2 * (i * across + j);
                let [a, b, c] = triangles[t].map(|v| points[v as usize]);
                let new = points.len() as u32;
                points.push((a + c) * 0.475 + b * 0.05);
                let [a, b, c] = triangles[t];
                triangles[t] = [a, b, new];
                triangles.extend([[b, c, new], [a, new, c]]);
            }
        }
    }
    if jitter > 0.0 && kind == Kind::Delaunay {
        flip(&points, &mut triangles);
    }
    (points, triangles)
}

/// Lawson's flips (1977): edges whose opposite angles exceed pi in sum are turned until none does.
fn flip(points: &[Vec2], triangles: &mut [[u32; 3]]) {
    let p = |v: u32| points[v as usize];
    let angle = |apex: u32, a: u32, b: u32| {
        let (d, e) = (p(a) - p(apex), p(b) - p(apex));
        d.perp(&e).abs().atan2(d.dot(&e))
    };
    for _ in 0..20 {
        let mut flipped = false;
        for s in 0..triangles.len() {
            for k in 0..3 {
                let [a, b, far] = [0, 1, 2].map(|n| triangles[s][(k + n) % 3]);
                let Some(t) = (0..triangles.len())
                    .find(|&t| t != s && triangles[t].contains(&a) && triangles[t].contains(&b))
                else {
                    continue;
                };
                let other = triangles[t]
                    .into_iter()
                    .find(|&v| v != a && v != b)
                    .unwrap();
                if angle(far, a, b) + angle(other, a, b) > std::f64::consts::PI + 1e-9 {
                    triangles[s] = [far, a, other];
                    triangles[t] = [far, other, b];
                    flipped = true;
                    break;
                }
            }
        }
        if !flipped {
            break;
        }
    }
}
