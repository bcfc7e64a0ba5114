//! Solving with the columns of the factor that belong to one front.
//!
//! A solve reads every number of the factor twice and does two operations with it: memory sets its
//! pace. So columns are fetched in the order they lie in, as many as the cache holds, and then worked on
//! side by side.

use super::dense::Number;
use super::layout::stride;
use faer::MatMut;
use faer::prelude::ReborrowMut;
use pulp::{Arch, NullaryFnOnce};
use std::array::from_fn;
use std::hint::black_box;
use std::ops::Range;

/// Columns read side by side.
const WIDTH: usize = 4;

/// Rows worked on at a time.
const LANES: usize = 8;

/// Lines of the cache read side by side as they lie, half lines in single precision: sums need not wait for
/// one another.
const LINES: usize = 4;

/// Numbers fetched before they are worked on: a quarter of a megabyte in double precision.
const RUN: usize = 1 << 15;

/// Columns of the factor, a triangle on top and the rows below it.
#[derive(Clone, Copy)]
pub struct Panel<'a, T> {
    values: &'a [T],
    stride: usize,
    /// Columns, and rows of the triangle.
    pivots: usize,
    /// Rows of the triangle and below.
    rows: usize,
}

impl<'a, T: Number> Panel<'a, T> {
    /// The columns of so many pivots, one or more, with so many rows below them.
    pub fn new(values: &'a [T], pivots: usize, below: usize) -> Self {
        let rows = pivots + below;
        Self {
            values,
            stride: stride(rows),
            pivots,
            rows,
        }
    }

    /// Some rows of columns side by side.
    #[inline(always)]
    fn columns<const W: usize>(&self, first: usize, rows: Range<usize>) -> [&'a [T]; W] {
        from_fn(|k| &self.values[(first + k) * self.stride..][rows.clone()])
    }

    #[inline(always)]
    fn at(&self, row: usize, column: usize) -> T {
        self.values[column * self.stride + row]
    }

    /// Runs of columns that fit the second-level cache together, four at the least.
    #[inline(always)]
    fn runs(&self) -> impl DoubleEndedIterator<Item = Range<usize>> + use<T> {
        let width = (RUN / self.stride).max(1).next_multiple_of(WIDTH);
        let pivots = self.pivots;
        let firsts = (0..pivots).step_by(width);
        firsts.map(move |first| first..pivots.min(first + width))
    }

    /// Reads columns once in the order they lie in memory, so that they come as fast as memory gives:
    /// four columns at a time, or backward, come at half that pace.
    #[inline(always)]
    fn fetch(&self, run: &Range<usize>) {
        let values = &self.values[run.start * self.stride..run.end * self.stride];
        let lines = values.chunks_exact(LINES * LANES);
        let mut sum = [T::rounded(0.0); LINES];
        for numbers in lines {
            sum = from_fn(|k| sum[k] + numbers[k * LANES]);
        }
        black_box(sum);
    }

    /// x <- y of L y = x for the triangle; below <- below - (rows below) y. A column of x and of
    /// below for each right-hand side.
    pub fn forward(&self, x: MatMut<'_, T>, below: &mut [T]) {
        let panel = *self;
        Arch::new().dispatch(Forward { panel, x, below });
    }

    #[inline(always)]
    fn go_forward(&self, mut x: MatMut<'_, T>, below: &mut [T]) {
        let height = self.rows - self.pivots;
        for run in self.runs() {
            self.fetch(&run);
            for k in 0..x.ncols() {
                let below = &mut below[k * height..][..height];
                self.forward_run(&run, slice(&mut x, k), below);
            }
        }
    }

    #[inline(always)]
    fn forward_run(&self, run: &Range<usize>, x: &mut [T], below: &mut [T]) {
        let whole = run.end - run.len() % WIDTH;
        for first in (run.start..whole).step_by(WIDTH) {
            self.forward_some::<WIDTH>(first, x, below);
        }
        for first in whole..run.end {
            self.forward_some::<1>(first, x, below);
        }
    }

    #[inline(always)]
    fn forward_some<const W: usize>(&self, first: usize, x: &mut [T], below: &mut [T]) {
        let (done, rest) = x.split_at_mut(first + W);
        for k in first..first + W {
            let taken = (first..k).map(|l| self.at(k, l) * done[l]);
            let sum = taken.fold(done[k], |sum, part| sum - part);
            done[k] = sum / self.at(k, k);
        }
        let y: [T; W] = from_fn(|k| done[first + k]);
        take(rest, self.columns(first, first + W..self.pivots), y);
        take(below, self.columns(first, self.pivots..self.rows), y);
    }

    /// x <- z of L^T z = x - (rows below)^T below. A column of x and of below for each right-hand
    /// side.
    pub fn backward(&self, x: MatMut<'_, T>, below: &[T]) {
        let panel = *self;
        Arch::new().dispatch(Backward { panel, x, below });
    }

    #[inline(always)]
    fn go_backward(&self, mut x: MatMut<'_, T>, below: &[T]) {
        let height = self.rows - self.pivots;
        for run in self.runs().rev() {
            self.fetch(&run);
            for k in 0..x.ncols() {
                let below = &below[k * height..][..height];
                self.backward_run(&run, slice(&mut x, k), below);
            }
        }
    }

    #[inline(always)]
    fn backward_run(&self, run: &Range<usize>, x: &mut [T], below: &[T]) {
        let whole = run.end - run.len() % WIDTH;
        for first in (whole..run.end).rev() {
            self.backward_some::<1>(first, x, below);
        }
        for first in (run.start..whole).step_by(WIDTH).rev() {
            self.backward_some::<WIDTH>(first, x, below);
        }
    }

    #[inline(always)]
    fn backward_some<const W: usize>(&self, first: usize, x: &mut [T], below: &[T]) {
        let (open, done) = x.split_at_mut(first + W);
        let near = products(self.columns::<W>(first, first + W..self.pivots), done);
        let far = products(self.columns::<W>(first, self.pivots..self.rows), below);
        for k in (first..first + W).rev() {
            let taken = (k + 1..first + W).map(|l| self.at(l, k) * open[l]);
            let left = open[k] - near[k - first] - far[k - first];
            let sum = taken.fold(left, |sum, part| sum - part);
            open[k] = sum / self.at(k, k);
        }
    }
}

struct Forward<'a, T> {
    panel: Panel<'a, T>,
    x: MatMut<'a, T>,
    below: &'a mut [T],
}

impl<T: Number> NullaryFnOnce for Forward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.panel.go_forward(self.x, self.below);
    }
}

struct Backward<'a, T> {
    panel: Panel<'a, T>,
    x: MatMut<'a, T>,
    below: &'a [T],
}

impl<T: Number> NullaryFnOnce for Backward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.panel.go_backward(self.x, self.below);
    }
}

/// A column as numbers side by side.
#[inline(always)]
fn slice<'a, T: Number>(x: &'a mut MatMut<'_, T>, column: usize) -> &'a mut [T] {
    let column = x.rb_mut().col_mut(column).try_as_col_major_mut();
    column.expect("columns of x are whole").as_slice_mut()
}

/// out <- out - columns y
#[inline(always)]
fn take<T: Number, const W: usize>(out: &mut [T], columns: [&[T]; W], y: [T; W]) {
    let columns = columns.map(|column| &column[..out.len()]);
    for (i, out) in out.iter_mut().enumerate() {
        let parts = columns.iter().zip(y).map(|(column, y)| column[i] * y);
        *out = parts.fold(*out, |sum, part| sum - part);
    }
}

/// The inner products of columns with a vector.
#[inline(always)]
fn products<T: Number, const W: usize>(columns: [&[T]; W], with: &[T]) -> [T; W] {
    let split = columns.map(|column| column.as_chunks::<LANES>());
    let (chunks, ends) = with.as_chunks::<LANES>();
    let mut sums = [[T::rounded(0.0); LANES]; W];
    for (i, with) in chunks.iter().enumerate() {
        for (sum, (column, _)) in sums.iter_mut().zip(split) {
            *sum = from_fn(|lane| sum[lane] + column[i][lane] * with[lane]);
        }
    }
    from_fn(|k| {
        let [a, b, c, d, e, f, g, h] = sums[k];
        let sum = ((a + b) + (c + d)) + ((e + f) + (g + h));
        let rest = ends.iter().zip(split[k].1);
        rest.fold(sum, |sum, (&with, &number)| sum + number * with)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_hold_every_column_once_however_long_it_is() {
        for (pivots, below) in [(1, 0), (3, 8), (300, 20), (5, 2 * RUN), (8, 200 * RUN)] {
            let panel = Panel::<f64>::new(&[], pivots, below);
            let columns: Vec<usize> = panel.runs().flatten().collect();
            assert_eq!(columns, (0..pivots).collect::<Vec<_>>());
        }
    }
}
