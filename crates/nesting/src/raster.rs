//! The weighted loss of a piece at all positions of a coarse grid (after Sato, Martins, Gomes and Tsuzuki
//! 2019): a sum of loss rasters of pairs, each computed once.

use crate::depth_raster::{DepthRaster, LANES, padded};
use crate::random::SplitMix64;
use pulp::{Arch, Simd, WithSimd};
use toile_geometry::Vec2;

/// Side of the square blocks that each yield one best cell (cells).
const BLOCK: usize = 8;
/// Largest random increase of a cell's score (fraction).
const CHANCE: f32 = 0.1;

/// The weighted loss of a shape at every cell of its range of positions.
pub(crate) struct LossMap {
    columns: usize,
    rows: usize,
    /// Distance between rows in `values`; numbers after the columns are padding.
    stride: usize,
    values: Vec<f32>,
    /// Smallest value of each column in a row of blocks.
    least: Vec<f32>,
    arch: Arch,
}

/// A cell to examine more closely.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// Approximate loss at the cell.
    pub score: f32,
    pub shape: usize,
    /// Position of the cell (m).
    pub at: Vec2,
}

impl LossMap {
    pub fn new() -> Self {
        Self {
            columns: 0,
            rows: 0,
            stride: 0,
            values: Vec::new(),
            least: Vec::new(),
            arch: Arch::new(),
        }
    }

    /// Resets the map to zero loss, with a size in cells.
    pub fn clear(&mut self, columns: usize, rows: usize) {
        (self.columns, self.rows) = (columns, rows);
        self.stride = padded(columns);
        self.values.clear();
        self.values.resize(self.stride * rows, 0.0);
    }

    /// Adds a raster times a weight, with its zero offset at `cell`.
    pub fn add(&mut self, raster: &DepthRaster, cell: [i32; 2], weight: f32) {
        let left = raster.first[0] + cell[0];
        let low = raster.first[1] + cell[1];
        let start = left.max(0);
        let end = (left + raster.columns as i32).min(self.columns as i32);
        let rows = (raster.values.len() / raster.stride) as i32;
        let (first, last) = (low.max(0), (low + rows).min(self.rows as i32));
        if start >= end || first >= last {
            return;
        }
        let count = ((end - start) as usize).next_multiple_of(LANES);
        let to = first as usize * self.stride + start as usize;
        let from = (first - low) as usize * raster.stride + (start - left) as usize;
        self.arch.dispatch(AddRows {
            target: &mut self.values[to..],
            source: &raster.values[from..],
            strides: [self.stride, raster.stride],
            count,
            rows: (last - first) as usize,
            weight,
        });
    }

    /// Collects the best cells, at most one per block, with a small random increase to decide between equal
    /// ones. A cell better than the worst of the `most` cells already found replaces it.
    pub fn collect(
        &mut self,
        (shape, spacing, room): (usize, f64, Vec2),
        bias: f64,
        sequence: &mut SplitMix64,
        (found, most): (&mut Vec<Candidate>, usize),
    ) {
        let small = 0.1 * spacing as f32;
        for low in (0..self.rows).step_by(BLOCK) {
            let high = (low + BLOCK).min(self.rows);
            self.least_of_rows(low, high);
            for left in (0..self.columns).step_by(BLOCK) {
                let right = (left + BLOCK).min(self.columns);
                let least = self.least[left..right]
                    .iter()
                    .copied()
                    .fold(f32::INFINITY, f32::min);
                let full = found.len() >= most;
                if full
                    && found
                        .last()
                        .is_some_and(|worst| least + small >= worst.score)
                {
                    continue;
                }
                let score = (least + small + (bias * left as f64 * spacing) as f32)
                    * (1.0 + CHANCE * sequence.unit() as f32);
                let place = found.partition_point(|known| known.score <= score);
                if place >= most {
                    continue;
                }
                let is_it = |&(row, column): &(usize, usize)| {
                    self.values[row * self.stride + column] == least
                };
                let mut cells = (low..high).flat_map(|row| (left..right).map(move |c| (row, c)));
                let Some((row, column)) = cells.find(is_it) else {
                    continue;
                };
                let cell = Vec2::new(column as f64, row as f64) * spacing;
                let candidate = Candidate {
                    score,
                    shape,
                    at: cell.inf(&room),
                };
                found.insert(place, candidate);
                found.truncate(most);
            }
        }
    }

    /// Computes the smallest value of each column between two rows.
    fn least_of_rows(&mut self, low: usize, high: usize) {
        self.least.clear();
        self.least.resize(self.stride, f32::INFINITY);
        self.arch.dispatch(LeastOfRows {
            values: &self.values[low * self.stride..high * self.stride],
            least: &mut self.least,
        });
    }
}

/// Adds weighted rows of one table to rows of another.
struct AddRows<'a> {
    target: &'a mut [f32],
    source: &'a [f32],
    /// Distance between rows in the target and in the source.
    strides: [usize; 2],
    /// Length of a row, a multiple of the SIMD group.
    count: usize,
    rows: usize,
    weight: f32,
}

impl WithSimd for AddRows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let weight = simd.splat_f32s(self.weight);
        for row in 0..self.rows {
            let target = &mut self.target[row * self.strides[0]..][..self.count];
            let source = &self.source[row * self.strides[1]..][..self.count];
            let (target, _) = S::as_mut_simd_f32s(target);
            let (source, _) = S::as_simd_f32s(source);
            for (target, &source) in target.iter_mut().zip(source) {
                *target = simd.add_f32s(*target, simd.mul_f32s(weight, source));
            }
        }
    }
}

/// Smallest number of each column.
struct LeastOfRows<'a> {
    values: &'a [f32],
    least: &'a mut [f32],
}

impl WithSimd for LeastOfRows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let stride = self.least.len();
        let (least, _) = S::as_mut_simd_f32s(self.least);
        for row in self.values.chunks_exact(stride) {
            let (row, _) = S::as_simd_f32s(row);
            for (least, &value) in least.iter_mut().zip(row) {
                *least = simd.min_f32s(*least, value);
            }
        }
    }
}
