//! The cotangent matrix of a surface, the stiffness of linear functions on its triangles (Duffin 1959).

use crate::{FlattenError, Region};
use toile_geometry::{Vec2, Vec3};
use toile_sparse::factor::{Factor, Graph};

/// Cotangents of a triangle's angles, the k-th at corner k (1).
pub fn cotangents(corners: [Vec2; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let u = corners[(k + 1) % 3] - corners[k];
        let v = corners[(k + 2) % 3] - corners[k];
        u.dot(&v) / u.perp(&v)
    })
}

/// Entries of the matrix at pairs of vertices: row, column, value. A pair comes once for each triangle.
pub fn entries(region: &Region) -> Vec<(u32, u32, f64)> {
    let mut entries = Vec::with_capacity(12 * region.flat().len());
    for (triangle, &corners) in region.mesh().triangles.iter().zip(region.flat()) {
        for (k, cotangent) in cotangents(corners).into_iter().enumerate() {
            let (a, b) = (triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
            let weight = 0.5 * cotangent;
            entries.push((a, b, -weight));
            entries.push((b, a, -weight));
            entries.push((a, a, weight));
            entries.push((b, b, weight));
        }
    }
    entries
}

/// The graph of a surface's edges.
pub fn graph(region: &Region) -> Graph {
    let pairs = (region.mesh().triangles.iter()).flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    Graph::from_pairs(region.vertex_count(), pairs)
}

/// The factorised cotangent matrix with one vertex held at the origin.
pub struct Cotangent {
    factor: Factor<1>,
    held: usize,
    right: Vec<Vec3>,
    result: Vec<Vec3>,
}

impl Cotangent {
    /// Factorises the matrix of a surface.
    ///
    /// # Errors
    /// The triangles are too thin.
    pub fn new(region: &Region) -> Result<Self, FlattenError> {
        let held = region.outline().first().map_or(0, |&v| v as usize);
        let matrix =
            toile_sparse::ScalarMatrix::from_entries(region.vertex_count(), &entries(region));
        let mut factor = Factor::new(graph(region), &region.mesh().positions);
        factor.factorise(|v, columns, row| {
            let (known, values) = matrix.row_entries(v);
            for (out, &column) in row.iter_mut().zip(columns) {
                let at = known.binary_search(&column);
                let is_held = v == held || column as usize == held;
                out[0][0] = match at {
                    _ if is_held && v == column as usize => 1.0,
                    Ok(at) if !is_held => values[at],
                    Ok(_) | Err(_) => 0.0,
                };
            }
        })?;
        let count = region.vertex_count();
        Ok(Self {
            factor,
            held,
            right: vec![Vec3::zeros(); count],
            result: vec![Vec3::zeros(); count],
        })
    }

    /// Solves for vectors of the plane; the right-hand sides sum to zero. The held vertex gets zero.
    pub fn solve(&mut self, right: &[Vec2], result: &mut [Vec2]) {
        for (to, from) in self.right.iter_mut().zip(right) {
            *to = Vec3::new(from.x, from.y, 0.0);
        }
        self.right[self.held] = Vec3::zeros();
        self.factor.solve(&self.right, &mut self.result);
        for (to, from) in result.iter_mut().zip(&self.result) {
            *to = from.xy();
        }
    }
}
