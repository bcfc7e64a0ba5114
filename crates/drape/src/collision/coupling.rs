//! Blocks of the Hessian between vertices that touch: what the pattern of the mesh has no room for.

use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// A symmetric matrix of few 3x3 blocks off the diagonal, row by row.
#[derive(Clone, Debug, Default)]
pub struct Couplings {
    entries: Vec<([u32; 2], Matrix3<f64>)>,
    start: Vec<u32>,
}

impl Couplings {
    /// Forgets all blocks.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Adds a symmetric block between two vertices.
    pub fn add(&mut self, a: u32, b: u32, block: Matrix3<f64>) {
        self.entries.push(([a, b], block));
        self.entries.push(([b, a], block));
    }

    /// Sums blocks of one place and sorts them into the rows of `count` vertices.
    pub fn sort(&mut self, count: usize) {
        // Stable, so that sums do not depend on anything but the order they were added in.
        self.entries.sort_by_key(|entry| entry.0);
        self.entries.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        self.start.clear();
        self.start.resize(count + 1, 0);
        for &([row, _], _) in &self.entries {
            self.start[row as usize + 1] += 1;
        }
        for row in 0..count {
            self.start[row + 1] += self.start[row];
        }
    }

    /// Columns and blocks of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (u32, &Matrix3<f64>)> {
        let range = match self.start.get(row + 1) {
            Some(&end) => self.start[row] as usize..end as usize,
            None => 0..0,
        };
        self.entries[range]
            .iter()
            .map(|([_, column], block)| (*column, block))
    }

    /// Rows and columns that have a block.
    pub fn places(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.entries.iter().map(|entry| entry.0)
    }

    /// A row times a vector.
    pub fn row_times(&self, row: usize, p: &[Vec3]) -> Vec3 {
        self.row(row)
            .map(|(column, block)| block * p[column as usize])
            .sum()
    }
}
