//! Sparse constant matrices stored by groups of eight rows; groups with equal values share them.

use super::octets::{Indices, Octet, PAD, WIDTH, gather, gather_points, load, load_points};
use pulp::Simd;
use std::collections::BTreeMap;
use toile_drape::lane_arithmetic::{F64s, Number, Triple};

/// A constant sparse matrix. An entry of a group of eight rows is a value for each row and the eight operands:
/// consecutive (a run) or at indices.
#[derive(Default)]
pub struct Rows {
    groups: Vec<Group>,
    /// First index of the operands of each run.
    runs: Vec<u32>,
    /// Indices of the operands of the other entries.
    scattered: Vec<Indices>,
    /// Values of the entries of groups, in each those of its runs first.
    values: Vec<Octet>,
}

/// Ends of the entries of a group in [`Rows::runs`] and [`Rows::scattered`], and the start of its values.
#[derive(Clone, Copy, Default)]
struct Group {
    runs: u32,
    scattered: u32,
    values: u32,
}

/// Cost of a load by indices, in loads of a run.
const SCATTERED_COST: usize = 6;

/// Entries of a row or of a lane (index, value), or of a run (lane, value).
type Entries = Vec<(u32, f64)>;

impl Rows {
    /// From the columns and values of each row.
    pub fn new(rows: &[Entries]) -> Self {
        let mut matrix = Self::default();
        let mut known_values: BTreeMap<Vec<u64>, u32> = BTreeMap::new();
        for group in rows.chunks(WIDTH) {
            let values = matrix.add_entries(group);
            let numbers = values.iter().flat_map(|octet: &Octet| octet.0);
            let bits = numbers.map(f64::to_bits).collect();
            let at = *known_values.entry(bits).or_insert_with(|| {
                matrix.values.extend_from_slice(&values);
                (matrix.values.len() - values.len()) as u32
            });
            matrix.groups.push(Group {
                runs: matrix.runs.len() as u32,
                scattered: matrix.scattered.len() as u32,
                values: at,
            });
        }
        matrix
    }

    /// Adds the entries of a group and returns their values.
    fn add_entries(&mut self, group: &[Entries]) -> Vec<Octet> {
        let mut runs: BTreeMap<u32, Entries> = BTreeMap::new();
        for (lane, row) in (0u32..).zip(group) {
            for &(column, value) in row {
                let start = column + PAD as u32 - lane;
                runs.entry(start).or_default().push((lane, value));
            }
        }
        let min_run = cheapest_min_run(runs.values().map(|run| run.iter().map(|&(lane, _)| lane)));
        let mut values = Vec::new();
        let mut scattered: [Entries; WIDTH] = Default::default();
        for (&start, run) in &runs {
            if run.len() < min_run {
                for &(lane, value) in run {
                    scattered[lane as usize].push((start + lane, value));
                }
                continue;
            }
            let mut octet = Octet::default();
            for &(lane, value) in run {
                octet.0[lane as usize] = value;
            }
            self.runs.push(start);
            values.push(octet);
        }
        for k in 0..scattered.iter().map(Vec::len).max().unwrap_or(0) {
            let lanes = scattered
                .each_ref()
                .map(|row| row.get(k).copied().unwrap_or_default());
            self.scattered.push(lanes.map(|(index, _)| index));
            values.push(Octet(lanes.map(|(_, value)| value)));
        }
        values
    }

    /// Cost of the loads of a product, in loads of a run.
    pub fn cost(&self) -> usize {
        self.runs.len() + SCATTERED_COST * self.scattered.len()
    }

    #[inline(always)]
    fn entries(&self, group: usize) -> (&[u32], &[Indices], &[Octet]) {
        let before = match group {
            0 => Group::default(),
            _ => self.groups[group - 1],
        };
        let Group {
            runs,
            scattered,
            values,
        } = self.groups[group];
        let runs = &self.runs[before.runs as usize..runs as usize];
        let scattered = &self.scattered[before.scattered as usize..scattered as usize];
        let values = &self.values[values as usize..][..runs.len() + scattered.len()];
        (runs, scattered, values)
    }

    /// The product of one lane group of rows with a vector of numbers.
    #[inline(always)]
    pub fn product<S: Simd>(&self, simd: S, group: usize, lane_group: usize, x: &[f64]) -> F64s<S> {
        let (runs, scattered, values) = self.entries(group);
        let (run_values, values) = values.split_at(runs.len());
        let first = lane_group * S::F64_LANES;
        let mut sum = F64s::splat(simd, 0.0);
        for (start, value) in runs.iter().zip(run_values) {
            let x = load(simd, x, *start as usize + first);
            sum = value.lane_group(simd, lane_group).mul_add(x, sum);
        }
        for (indices, value) in scattered.iter().zip(values) {
            let x = gather(simd, x, indices, lane_group);
            sum = value.lane_group(simd, lane_group).mul_add(x, sum);
        }
        sum
    }

    /// The product of one lane group of rows with a vector of points.
    #[inline(always)]
    pub fn product_points<S: Simd>(
        &self,
        simd: S,
        group: usize,
        lane_group: usize,
        x: [&[f64]; 3],
    ) -> Triple<F64s<S>> {
        let (runs, scattered, values) = self.entries(group);
        let (run_values, values) = values.split_at(runs.len());
        let first = lane_group * S::F64_LANES;
        let mut sum = Triple::repeat(F64s::splat(simd, 0.0));
        for (start, value) in runs.iter().zip(run_values) {
            let x = load_points(simd, x, *start as usize + first);
            sum = sum.add_scaled(x, value.lane_group(simd, lane_group));
        }
        for (indices, value) in scattered.iter().zip(values) {
            let x = gather_points(simd, x, indices, lane_group);
            sum = sum.add_scaled(x, value.lane_group(simd, lane_group));
        }
        sum
    }
}

/// The least length of a run at which the loads of a group cost least, given the lanes of each possible run.
/// The operands of shorter runs are loaded by indices, one of each lane at a time.
pub fn cheapest_min_run<L: Iterator<Item = u32>>(runs: impl Iterator<Item = L>) -> usize {
    let lanes: Vec<Vec<u32>> = runs.map(Iterator::collect).collect();
    let cost = |min_run: usize| {
        let mut scattered = [0; WIDTH];
        let mut run_count = 0;
        for run in &lanes {
            if run.len() < min_run {
                run.iter().for_each(|&lane| scattered[lane as usize] += 1);
            } else {
                run_count += 1;
            }
        }
        run_count + SCATTERED_COST * scattered.into_iter().max().unwrap_or(0)
    };
    (1..=WIDTH)
        .min_by_key(|&min_run| cost(min_run))
        .unwrap_or(1)
}

/// Rounds to a multiple of 2^-44 times the largest value (to a power of two), so that equal rows of a regular mesh
/// are equal to the last bit and share their values.
pub fn rounding(largest: f64) -> impl Fn(f64) -> f64 {
    let quantum = (largest.log2().floor() - 44.0).exp2();
    let quantum = quantum.max(f64::MIN_POSITIVE);
    move |value| (value / quantum).round() * quantum
}

#[cfg(test)]
mod tests {
    use super::super::octets::{groups, lane_group_start, lane_groups, padded};
    use super::*;

    struct Multiply<'a> {
        rows: &'a Rows,
        x: &'a [f64],
        count: usize,
    }

    impl pulp::WithSimd for Multiply<'_> {
        type Output = Vec<f64>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
            let mut to = padded(self.count);
            for group in 0..groups(self.count) {
                for lane_group in 0..lane_groups::<S>() {
                    let values = self.rows.product(simd, group, lane_group, self.x);
                    super::super::octets::store(
                        &mut to,
                        lane_group_start::<S>(group, lane_group),
                        values,
                    );
                }
            }
            to[PAD..PAD + self.count].to_vec()
        }
    }

    #[test]
    fn products_are_those_of_the_matrix_however_rows_lie() {
        let count = 61usize;
        // Runs in the first half, no order in the second; values alike in the first.
        let row = |k: usize| -> Vec<(u32, f64)> {
            let near = [-9i64, -1, 0, 1, 9].iter().filter_map(|step| {
                let column = k as i64 + step;
                (0..count as i64)
                    .contains(&column)
                    .then_some((column as u32, 2.0 + *step as f64))
            });
            let far = (0..4).map(|j| ((k * k * 7 + 13 * j) % count, (k + j) as f64));
            let mut row: Vec<(u32, f64)> = match k < 32 {
                true => near.collect(),
                false => far.map(|(column, value)| (column as u32, value)).collect(),
            };
            row.sort_by_key(|&(column, _)| column);
            row.dedup_by_key(|&mut (column, _)| column);
            row
        };
        let rows: Vec<Vec<(u32, f64)>> = (0..count).map(row).collect();
        let matrix = Rows::new(&rows);
        let mut x = padded(count);
        for k in 0..count {
            x[PAD + k] = (0.3 * k as f64).sin();
        }
        let multiply = || Multiply {
            rows: &matrix,
            x: &x,
            count,
        };
        let wide = pulp::Arch::new().dispatch(multiply());
        let scalar = pulp::WithSimd::with_simd(multiply(), pulp::Scalar);
        for (k, row) in rows.iter().enumerate() {
            let expected: f64 = row
                .iter()
                .map(|&(c, value)| value * x[PAD + c as usize])
                .sum();
            for got in [wide[k], scalar[k]] {
                assert!((got - expected).abs() < 1e-10, "{k}: {got} {expected}");
            }
        }
        assert!(
            matrix.values.len() < matrix.runs.len() + matrix.scattered.len(),
            "equal groups share their values"
        );
    }
}
