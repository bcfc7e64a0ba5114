//! Sparse constant matrices for groups of rows, the values of groups that are alike kept once.

use super::octets::{
    Octet, PAD, Places, WIDTH, add_scaled, gather, gather_points, load, load_points,
};
use pulp::Simd;
use std::collections::BTreeMap;

/// A constant matrix. A group of eight rows has entries: a value for every row and where its
/// eight operands lie.
#[derive(Default)]
pub struct Rows {
    groups: Vec<Group>,
    /// Where operands that lie side by side begin.
    runs: Vec<u32>,
    /// Where others lie.
    scattered: Vec<Places>,
    values: Vec<Octet>,
}

/// Where the entries of a group end, and where its values begin: of its runs, then of the others.
#[derive(Clone, Copy, Default)]
struct Group {
    runs: u32,
    scattered: u32,
    values: u32,
}

/// What a load in no order costs in loads of runs.
const SCATTERED_COST: usize = 6;

/// Entries of a row, a run, or a lane: a place, or a lane, and a value.
type Entries = Vec<(u32, f64)>;

impl Rows {
    /// From the columns and values of each row.
    pub fn new(rows: &[Entries]) -> Self {
        let mut made = Self::default();
        let mut known: BTreeMap<Vec<u64>, u32> = BTreeMap::new();
        for group in rows.chunks(WIDTH) {
            let values = made.add_entries(group);
            let numbers = values.iter().flat_map(|octet: &Octet| octet.0);
            let bits = numbers.map(f64::to_bits).collect();
            let at = *known.entry(bits).or_insert_with(|| {
                made.values.extend_from_slice(&values);
                (made.values.len() - values.len()) as u32
            });
            made.groups.push(Group {
                runs: made.runs.len() as u32,
                scattered: made.scattered.len() as u32,
                values: at,
            });
        }
        made
    }

    /// Adds the entries of a group; their values.
    fn add_entries(&mut self, group: &[Entries]) -> Vec<Octet> {
        let mut runs: BTreeMap<u32, Entries> = BTreeMap::new();
        for (lane, row) in (0u32..).zip(group) {
            for &(column, value) in row {
                let start = column + PAD as u32 - lane;
                runs.entry(start).or_default().push((lane, value));
            }
        }
        let least = least_run(runs.values().map(|run| run.iter().map(|&(lane, _)| lane)));
        let mut values = Vec::new();
        let mut left: [Entries; WIDTH] = Default::default();
        for (&start, run) in &runs {
            if run.len() < least {
                for &(lane, value) in run {
                    left[lane as usize].push((start + lane, value));
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
        for k in 0..left.iter().map(Vec::len).max().unwrap_or(0) {
            let lanes = left
                .each_ref()
                .map(|row| row.get(k).copied().unwrap_or_default());
            self.scattered.push(lanes.map(|(place, _)| place));
            values.push(Octet(lanes.map(|(_, value)| value)));
        }
        values
    }

    /// Numbers of runs that a product's loads are worth.
    pub fn cost(&self) -> usize {
        self.runs.len() + SCATTERED_COST * self.scattered.len()
    }

    #[inline(always)]
    fn entries(&self, group: usize) -> (&[u32], &[Places], &[Octet]) {
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

    /// A part of a group of rows times numbers.
    #[inline(always)]
    pub fn product<S: Simd>(&self, simd: S, group: usize, part: usize, x: &[f64]) -> S::f64s {
        let (runs, scattered, values) = self.entries(group);
        let (run_values, values) = values.split_at(runs.len());
        let first = part * S::F64_LANES;
        let mut sum = simd.splat_f64s(0.0);
        for (start, value) in runs.iter().zip(run_values) {
            let x = load::<S>(x, *start as usize + first);
            sum = simd.mul_add_f64s(value.part::<S>(part), x, sum);
        }
        for (places, value) in scattered.iter().zip(values) {
            let x = gather::<S>(x, places, part);
            sum = simd.mul_add_f64s(value.part::<S>(part), x, sum);
        }
        sum
    }

    /// A part of a group of rows times points.
    #[inline(always)]
    pub fn product_points<S: Simd>(
        &self,
        simd: S,
        group: usize,
        part: usize,
        x: [&[f64]; 3],
    ) -> [S::f64s; 3] {
        let (runs, scattered, values) = self.entries(group);
        let (run_values, values) = values.split_at(runs.len());
        let first = part * S::F64_LANES;
        let mut sum = [simd.splat_f64s(0.0); 3];
        for (start, value) in runs.iter().zip(run_values) {
            let x = load_points::<S>(x, *start as usize + first);
            add_scaled(simd, &mut sum, value.part::<S>(part), x);
        }
        for (places, value) in scattered.iter().zip(values) {
            let x = gather_points::<S>(x, places, part);
            add_scaled(simd, &mut sum, value.part::<S>(part), x);
        }
        sum
    }
}

/// The length from which on runs are worth it, given the lanes of each that could be made: what
/// shorter ones hold is taken in no order, one of each lane at a time.
pub fn least_run<L: Iterator<Item = u32>>(runs: impl Iterator<Item = L>) -> usize {
    let lanes: Vec<Vec<u32>> = runs.map(Iterator::collect).collect();
    let cost = |least: usize| {
        let mut left = [0; WIDTH];
        let mut made = 0;
        for run in &lanes {
            if run.len() < least {
                run.iter().for_each(|&lane| left[lane as usize] += 1);
            } else {
                made += 1;
            }
        }
        made + SCATTERED_COST * left.into_iter().max().unwrap_or(0)
    };
    (1..=WIDTH).min_by_key(|&least| cost(least)).unwrap_or(1)
}

/// Rounds to 2^-44 of the largest, which makes the rows of a regular mesh alike to the last bit.
pub fn rounding(largest: f64) -> impl Fn(f64) -> f64 {
    let quantum = (largest.log2().floor() - 44.0).exp2();
    let quantum = quantum.max(f64::MIN_POSITIVE);
    move |value| (value / quantum).round() * quantum
}

#[cfg(test)]
mod tests {
    use super::super::octets::{groups, padded, parts, place};
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
                for part in 0..parts::<S>() {
                    let values = self.rows.product(simd, group, part, self.x);
                    super::super::octets::store::<S>(&mut to, place::<S>(group, part), values);
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
        let made = Rows::new(&rows);
        let mut x = padded(count);
        for k in 0..count {
            x[PAD + k] = (0.3 * k as f64).sin();
        }
        let multiply = || Multiply {
            rows: &made,
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
            made.values.len() < made.runs.len() + made.scattered.len(),
            "alike ones are kept once"
        );
    }
}
