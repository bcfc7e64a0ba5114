//! Sparse matrices of the implicit step: 3x3 blocks for the membrane, scalars for bending.
//! Rows are computed independently, so results do not depend on the number of threads.

use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Rows of one parallel task: enough to outweigh its overhead, few enough to balance the load.
pub const ROW_CHUNK: usize = 256;

/// A symmetric matrix of scalars, each of which represents itself times the 3x3 identity.
#[derive(Clone, Debug, Default)]
pub struct ScalarMatrix {
    row_start: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    diagonal: Vec<f64>,
}

impl ScalarMatrix {
    /// The sum of entries (row, column, value), added in the given order.
    pub fn from_entries(rows: usize, entries: &[(u32, u32, f64)]) -> Self {
        let mut start = vec![0u32; rows + 1];
        for &(row, _, _) in entries {
            start[row as usize + 1] += 1;
        }
        for row in 0..rows {
            start[row + 1] += start[row];
        }
        let mut next = start.clone();
        let mut sorted = vec![(0u32, 0f64); entries.len()];
        for &(row, column, value) in entries {
            sorted[next[row as usize] as usize] = (column, value);
            next[row as usize] += 1;
        }
        let mut matrix = Self {
            row_start: vec![0],
            diagonal: vec![0.0; rows],
            ..Self::default()
        };
        for row in 0..rows {
            let line = &mut sorted[start[row] as usize..start[row + 1] as usize];
            line.sort_by_key(|&(column, _)| column);
            let first = matrix.columns.len();
            for &(column, value) in line.iter() {
                if matrix.columns.len() > first && matrix.columns.last() == Some(&column) {
                    let last = matrix.values.len() - 1;
                    matrix.values[last] += value;
                } else {
                    matrix.columns.push(column);
                    matrix.values.push(value);
                }
            }
            for at in first..matrix.columns.len() {
                if matrix.columns[at] as usize == row {
                    matrix.diagonal[row] = matrix.values[at];
                }
            }
            matrix.row_start.push(matrix.columns.len() as u32);
        }
        matrix
    }

    /// `self` plus `factor` times a matrix of the same pattern.
    pub fn plus(&self, other: &Self, factor: f64) -> Self {
        assert_eq!(self.columns, other.columns, "matrices of one pattern");
        let add = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + factor * b).collect();
        Self {
            row_start: self.row_start.clone(),
            columns: self.columns.clone(),
            values: add(&self.values, &other.values),
            diagonal: add(&self.diagonal, &other.diagonal),
        }
    }

    /// Index of an entry among the values; none for one outside the pattern.
    pub fn index_of(&self, row: u32, column: u32) -> Option<usize> {
        let first = self.row_start[row as usize] as usize;
        let end = self.row_start[row as usize + 1] as usize;
        let found = self.columns[first..end].binary_search(&column).ok()?;
        Some(first + found)
    }

    /// A matrix of the same pattern with the values that `fill` adds to zeros, each at its
    /// [`Self::index_of`].
    #[must_use]
    pub fn filled(&self, fill: impl FnOnce(&mut [f64])) -> Self {
        let mut matrix = Self {
            row_start: self.row_start.clone(),
            columns: self.columns.clone(),
            values: vec![0.0; self.values.len()],
            diagonal: vec![0.0; self.diagonal.len()],
        };
        fill(&mut matrix.values);
        for row in 0..matrix.diagonal.len() as u32 {
            if let Some(at) = matrix.index_of(row, row) {
                matrix.diagonal[row as usize] = matrix.values[at];
            }
        }
        matrix
    }

    /// The diagonal entry of a row.
    pub fn diagonal(&self, row: usize) -> f64 {
        self.diagonal[row]
    }

    /// Columns and values of a row, columns ascending.
    pub fn row_entries(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.row_start[row] as usize..self.row_start[row + 1] as usize;
        (&self.columns[range.clone()], &self.values[range])
    }

    /// One row of the gradient of [`ScalarMatrix::row_energy`]'s sum: sum_j K_ij (x_j - x_i), the
    /// row times a vector when rows sum to zero. Differences keep the rounding small.
    pub fn row_force(&self, row: usize, x: &[Vec3]) -> Vec3 {
        let range = self.row_start[row] as usize..self.row_start[row + 1] as usize;
        let mut sum = Vec3::zeros();
        for (&column, &value) in self.columns[range.clone()].iter().zip(&self.values[range]) {
            sum += (x[column as usize] - x[row]) * value;
        }
        sum
    }

    /// A row's share of x K x / 2 when rows sum to zero: -1/4 sum_j K_ij |x_j - x_i|^2.
    pub fn row_energy(&self, row: usize, x: &[Vec3]) -> f64 {
        let range = self.row_start[row] as usize..self.row_start[row + 1] as usize;
        let mut sum = 0.0;
        for (&column, &value) in self.columns[range.clone()].iter().zip(&self.values[range]) {
            sum += (x[column as usize] - x[row]).norm_squared() * value;
        }
        -0.25 * sum
    }

    /// One row times a vector.
    pub fn row_times(&self, row: usize, x: &[Vec3]) -> Vec3 {
        let range = self.row_start[row] as usize..self.row_start[row + 1] as usize;
        let mut sum = Vec3::zeros();
        for (&column, &value) in self.columns[range.clone()].iter().zip(&self.values[range]) {
            sum += x[column as usize] * value;
        }
        sum
    }
}

/// Sparsity pattern of a matrix of 3x3 blocks over the edges of a mesh, with the positions of the triangles' blocks.
#[derive(Clone, Debug, Default)]
pub struct BlockPattern {
    row_start: Vec<u32>,
    columns: Vec<u32>,
    diagonal: Vec<u32>,
    source_start: Vec<u32>,
    sources: Vec<u32>,
}

/// For each pair of corners the index of its stored block (00, 01, 02, 11, 12, 22), and whether it is transposed.
const BLOCK_OF_PAIR: [[(u32, bool); 3]; 3] = [
    [(0, false), (1, false), (2, false)],
    [(1, true), (3, false), (4, false)],
    [(2, true), (4, true), (5, false)],
];

impl BlockPattern {
    /// The pattern of a mesh: a block for each vertex, and two for each edge.
    pub fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut entries: Vec<(u32, u32, u32)> = Vec::with_capacity(9 * triangles.len() + vertices);
        for (t, corners) in triangles.iter().enumerate() {
            for i in 0..3 {
                for j in 0..3 {
                    let (block, transposed) = BLOCK_OF_PAIR[i][j];
                    let code = (t as u32 * 6 + block) * 2 + u32::from(transposed);
                    entries.push((corners[i], corners[j], code));
                }
            }
        }
        entries.sort_unstable();
        let mut pattern = Self {
            row_start: vec![0],
            source_start: vec![0],
            ..Self::default()
        };
        let mut at = 0;
        for row in 0..vertices as u32 {
            let mut has_diagonal = false;
            while at < entries.len() && entries[at].0 == row {
                let column = entries[at].1;
                if !has_diagonal && column >= row {
                    has_diagonal = true;
                    pattern.diagonal.push(pattern.columns.len() as u32);
                    if column > row {
                        pattern.push_column(row);
                    }
                }
                while at < entries.len() && entries[at].0 == row && entries[at].1 == column {
                    pattern.sources.push(entries[at].2);
                    at += 1;
                }
                pattern.push_column(column);
            }
            if !has_diagonal {
                pattern.diagonal.push(pattern.columns.len() as u32);
                pattern.push_column(row);
            }
            pattern.row_start.push(pattern.columns.len() as u32);
        }
        pattern
    }

    fn push_column(&mut self, column: u32) {
        self.columns.push(column);
        self.source_start.push(self.sources.len() as u32);
    }

    fn row(&self, row: usize) -> std::ops::Range<usize> {
        self.row_start[row] as usize..self.row_start[row + 1] as usize
    }

    /// Columns of a row, ascending.
    pub fn row_columns(&self, row: usize) -> &[u32] {
        &self.columns[self.row(row)]
    }

    /// Columns and blocks of a row, columns ascending.
    pub fn row_entries<'a>(
        &'a self,
        row: usize,
        blocks: &'a [Matrix3<f64>],
    ) -> (&'a [u32], &'a [Matrix3<f64>]) {
        let range = self.row(row);
        (&self.columns[range.clone()], &blocks[range])
    }

    /// Number of stored blocks.
    pub fn block_count(&self) -> usize {
        self.columns.len()
    }

    /// Fills `blocks` with the sums of the triangles' blocks, and adds `diagonal[row]`.
    pub fn gather(
        &self,
        elements: &[[Matrix3<f64>; 6]],
        diagonal: &[Matrix3<f64>],
        blocks: &mut [Matrix3<f64>],
    ) {
        // Split the blocks at row boundaries, a fixed number of rows a task.
        let mut tasks = Vec::new();
        let mut rest = blocks;
        let rows = self.row_start.len() - 1;
        for first in (0..rows).step_by(ROW_CHUNK) {
            let last = (first + ROW_CHUNK).min(rows);
            let (head, tail) =
                rest.split_at_mut((self.row_start[last] - self.row_start[first]) as usize);
            tasks.push((first..last, head));
            rest = tail;
        }
        tasks.into_par_iter().for_each(|(rows, out)| {
            let base = self.row_start[rows.start] as usize;
            for row in rows {
                for at in self.row(row) {
                    let mut sum = Matrix3::zeros();
                    let sources =
                        self.source_start[at] as usize..self.source_start[at + 1] as usize;
                    for &code in &self.sources[sources] {
                        let (index, transposed) = (code / 2, code % 2 == 1);
                        let block = &elements[(index / 6) as usize][(index % 6) as usize];
                        sum += if transposed {
                            block.transpose()
                        } else {
                            *block
                        };
                    }
                    if at as u32 == self.diagonal[row] {
                        sum += diagonal[row];
                    }
                    out[at - base] = sum;
                }
            }
        });
    }

    /// One row of blocks times a vector.
    pub fn row_times(&self, row: usize, blocks: &[Matrix3<f64>], x: &[Vec3]) -> Vec3 {
        let range = self.row(row);
        let mut sum = Vec3::zeros();
        for (&column, block) in self.columns[range.clone()].iter().zip(&blocks[range]) {
            sum += block * x[column as usize];
        }
        sum
    }

    /// The diagonal block of a row.
    pub fn diagonal_block<'a>(&self, row: usize, blocks: &'a [Matrix3<f64>]) -> &'a Matrix3<f64> {
        &blocks[self.diagonal[row] as usize]
    }
}

/// Sum of dot products, in fixed chunks so that the result does not depend on the number of threads.
pub fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    let partial: Vec<f64> = a
        .par_chunks(1024)
        .zip(b.par_chunks(1024))
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>())
        .collect();
    partial.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_land_where_a_dense_sum_puts_them() {
        let triangles = [[0u32, 1, 2], [2, 1, 3], [4, 0, 2]];
        let pattern = BlockPattern::new(6, &triangles);
        let elements: Vec<[Matrix3<f64>; 6]> = (0..3)
            .map(|t| {
                std::array::from_fn(|b| {
                    let m = Matrix3::from_fn(|i, j| (t * 100 + b * 10 + i * 3 + j) as f64);
                    if matches!(b, 0 | 3 | 5) {
                        m + m.transpose()
                    } else {
                        m
                    }
                })
            })
            .collect();
        let diagonal: Vec<_> = (0..6).map(|v| Matrix3::identity() * f64::from(v)).collect();
        let mut blocks = vec![Matrix3::zeros(); pattern.block_count()];
        pattern.gather(&elements, &diagonal, &mut blocks);
        let mut dense = nalgebra::DMatrix::<f64>::zeros(18, 18);
        for (t, corners) in triangles.iter().enumerate() {
            for i in 0..3 {
                for j in 0..3 {
                    let (block, transposed) = BLOCK_OF_PAIR[i][j];
                    let m = elements[t][block as usize];
                    let m = if transposed { m.transpose() } else { m };
                    let mut view = dense
                        .fixed_view_mut::<3, 3>(3 * corners[i] as usize, 3 * corners[j] as usize);
                    view += m;
                }
            }
        }
        for (v, added) in diagonal.iter().enumerate() {
            let mut view = dense.fixed_view_mut::<3, 3>(3 * v, 3 * v);
            view += added;
        }
        let x: Vec<Vec3> = (0..6)
            .map(|v| Vec3::new(1.0, -2.0, 0.5) * f64::from(v + 1))
            .collect();
        let flat = nalgebra::DVector::from_iterator(18, x.iter().flat_map(|p| [p.x, p.y, p.z]));
        let expected = dense * flat;
        for row in 0..6 {
            let got = pattern.row_times(row, &blocks, &x);
            for k in 0..3 {
                assert!((got[k] - expected[3 * row + k]).abs() < 1e-9, "row {row}");
            }
        }
    }

    #[test]
    fn scalar_entries_are_summed() {
        let matrix =
            ScalarMatrix::from_entries(3, &[(0, 1, 2.0), (0, 0, 1.0), (0, 1, 3.0), (2, 2, 4.0)]);
        let x = [Vec3::x(), Vec3::y(), Vec3::z()];
        assert_eq!(matrix.row_times(0, &x), Vec3::new(1.0, 5.0, 0.0));
        assert_eq!(matrix.row_times(1, &x), Vec3::zeros());
        assert_eq!((matrix.diagonal(2), matrix.values.len()), (4.0, 3));
    }
}
