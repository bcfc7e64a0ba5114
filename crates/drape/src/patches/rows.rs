//! Bending as rows of a constant matrix, the values of rows that are alike kept once.

use super::Lane;
use crate::Model;
use std::collections::BTreeMap;

/// Entries of a row summed side by side: one need not wait for the last. Rows are filled up to a
/// multiple of it with zeros.
const TOGETHER: usize = 4;

/// Rows of the bending matrix for the vertices of a patch.
#[derive(Default)]
pub struct Rows {
    /// Where the columns of each vertex begin; one more than there are vertices.
    start: Vec<u32>,
    /// Neighbours, by their places in the patch.
    columns: Vec<u32>,
    /// Where the values of each vertex begin.
    values_at: Vec<u32>,
    /// Values of the rows [N/m].
    values: Vec<f64>,
}

impl Rows {
    /// The rows of some vertices; `local` says where a vertex of the model lies in the patch, and
    /// a row that looks outside it is left empty.
    ///
    /// Values are rounded to 2^-44 of the largest, which makes the rows of a regular mesh alike to
    /// the last bit. The matrix stays symmetric, so momentum is kept, and the diagonal is minus
    /// the sum of the others, so that a shift of the cloth bends nothing.
    pub fn new(model: &Model, vertices: &[u32], local: impl Fn(u32) -> Option<u32>) -> Self {
        let mut rows = Self {
            start: vec![0],
            ..Self::default()
        };
        let diagonals = (0..model.vertex_count()).map(|v| model.bending.diagonal(v));
        let largest = diagonals.fold(f64::MIN_POSITIVE, f64::max);
        let quantum = (largest.log2().floor() - 44.0)
            .exp2()
            .max(f64::MIN_POSITIVE);
        let mut known: BTreeMap<Vec<u64>, u32> = BTreeMap::new();
        let mut values = Vec::new();
        for &v in vertices {
            let (columns, _) = model.bending.row_entries(v as usize);
            let first = rows.columns.len();
            values.clear();
            if columns.iter().all(|&column| local(column).is_some()) {
                let mut diagonal = 0.0;
                for &column in columns.iter().filter(|&&column| column != v) {
                    let value = entry(model, v.min(column), v.max(column));
                    let value = (value / quantum).round() * quantum;
                    rows.columns.extend(local(column));
                    values.push(value);
                    diagonal -= value;
                }
                rows.columns.extend(local(v));
                values.push(diagonal);
                while !values.len().is_multiple_of(TOGETHER) {
                    rows.columns.extend(local(v));
                    values.push(0.0);
                }
            }
            debug_assert_eq!(rows.columns.len() - first, values.len());
            let bits = values.iter().map(|value| value.to_bits()).collect();
            let at = *known.entry(bits).or_insert_with(|| {
                rows.values.extend_from_slice(&values);
                (rows.values.len() - values.len()) as u32
            });
            rows.values_at.push(at);
            rows.start.push(rows.columns.len() as u32);
        }
        rows
    }

    /// A row times the places: the gradient of the bending energy at a vertex [N].
    #[inline(always)]
    pub fn gradient(&self, v: usize, x: &[Lane]) -> Lane {
        let columns = &self.columns[self.start[v] as usize..self.start[v + 1] as usize];
        let values = &self.values[self.values_at[v] as usize..][..columns.len()];
        let mut sums = [Lane::default(); TOGETHER];
        let groups = columns.chunks_exact(TOGETHER);
        for (columns, values) in groups.zip(values.chunks_exact(TOGETHER)) {
            for k in 0..TOGETHER {
                sums[k] = sums[k].add_scaled(x[columns[k] as usize], values[k]);
            }
        }
        let [a, b, c, d] = sums;
        a.plus(b).plus(c.plus(d))
    }
}

fn entry(model: &Model, row: u32, column: u32) -> f64 {
    let (columns, values) = model.bending.row_entries(row as usize);
    columns.binary_search(&column).map_or(0.0, |at| values[at])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cloth, Material};
    use toile_geometry::{TriangleMesh, Vec3};

    #[test]
    fn rows_are_those_of_the_matrix_and_alike_ones_are_kept_once() {
        let side = 16u32;
        let mut mesh = TriangleMesh::default();
        for j in 0..=side {
            for i in 0..=side {
                let [x, z] = [i, j].map(|k| f64::from(k) / 64.0);
                mesh.positions.push(Vec3::new(x, 0.0, z));
            }
        }
        for j in 0..side {
            for i in 0..side {
                let a = j * (side + 1) + i;
                let (b, c, d) = (a + 1, a + side + 2, a + side + 1);
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let cloth = Cloth::from_mesh("cloth", &mesh, Material::default()).unwrap();
        let model = Model::new("cloth", &cloth).unwrap();
        let all: Vec<u32> = (0..mesh.positions.len() as u32).collect();
        let rows = Rows::new(&model, &all, Some);
        let places: Vec<Vec3> = mesh
            .positions
            .iter()
            .map(|p| Vec3::new(p.x, 0.02 * (30.0 * p.x).sin() + p.z * p.x, p.z))
            .collect();
        let lanes: Vec<Lane> = places.iter().map(|&p| p.into()).collect();
        let largest = (0..all.len())
            .map(|v| model.bending.row_force(v, &places).norm())
            .fold(0.0, f64::max);
        for v in 0..all.len() {
            let off = Vec3::from(rows.gradient(v, &lanes)) - model.bending.row_force(v, &places);
            assert!(off.norm() < 1e-9 * largest, "{v}: {off} {largest}");
        }
        assert!(
            rows.values.len() < rows.columns.len() / 4,
            "{}",
            rows.values.len()
        );
    }
}
