//! Dense kernels of a front, cut into tiles of fixed size: whichever thread does a tile, it does
//! the same sums in the same order.

use faer::dyn_stack::MemStack;
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization, cholesky_in_place};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::traits::RealField;
use faer::{Accum, MatMut, MatRef, Par, Spec};
use std::mem::MaybeUninit;

/// Numbers a factor can be held in.
pub trait Number: RealField + Copy + Send + Sync + 'static {
    /// Rounded from double precision.
    fn rounded(value: f64) -> Self;
    /// In double precision, exactly.
    fn wide(self) -> f64;
}

impl Number for f64 {
    fn rounded(value: f64) -> Self {
        value
    }
    fn wide(self) -> f64 {
        self
    }
}

impl Number for f32 {
    fn rounded(value: f64) -> Self {
        value as f32
    }
    fn wide(self) -> f64 {
        f64::from(self)
    }
}

/// Columns factorised at once: small enough for the first-level cache.
const PANEL: usize = 48;
/// Rows and columns of a tile: a tile's operands fit the second-level cache.
const TILE: usize = 256;
/// Halves are rounded to this many rows, those of the kernel of a product; not above `PANEL`.
const ROUND: usize = 48;

fn half(n: usize) -> usize {
    (n / 2).next_multiple_of(ROUND).min(n)
}

/// Partial Cholesky factorisation L L^T of the columns of a front, square on top, in place.
/// Fails with the first column whose pivot is not positive.
pub fn factorise<T: Number>(front: MatMut<'_, T>) -> Result<(), usize> {
    let columns = front.ncols();
    if columns <= PANEL {
        let (mut top, below) = front.split_at_row_mut(columns);
        let mut memory = [MaybeUninit::<u8>::uninit(); 16 * PANEL + 256];
        cholesky_in_place(
            top.rb_mut(),
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        )
        .map_err(|LltError::NonPositivePivot { index }| index)?;
        divide(below, top.rb());
        return Ok(());
    }
    let first = half(columns);
    let (mut left, right) = front.split_at_col_mut(first);
    factorise(left.rb_mut())?;
    let left = left.rb();
    let (_, done) = left.split_at_row(first);
    let (_, mut right) = right.split_at_row_mut(first);
    let (square, rest) = right.rb_mut().split_at_row_mut(columns - first);
    let (done_top, done_rest) = done.split_at_row(columns - first);
    rayon::join(
        || subtract_square(square, done_top, Accum::Add),
        || subtract_product(rest, done_rest, done_top, Accum::Add),
    );
    factorise(right).map_err(|at| at + first)
}

/// rows <- rows L^-T
fn divide<T: Number>(rows: MatMut<'_, T>, triangle: MatRef<'_, T>) {
    let count = rows.nrows();
    if count <= TILE {
        solve_lower_triangular_in_place(triangle, rows.transpose_mut(), Par::Seq);
        return;
    }
    let (top, bottom) = rows.split_at_row_mut(half(count));
    rayon::join(|| divide(top, triangle), || divide(bottom, triangle));
}

/// square <- square - rows rows^T, at and below the diagonal; with `Accum::Replace` what was there
/// does not count.
pub fn subtract_square<T: Number>(square: MatMut<'_, T>, rows: MatRef<'_, T>, into: Accum) {
    let count = square.nrows();
    if count <= TILE {
        triangular::matmul(
            square,
            BlockStructure::TriangularLower,
            into,
            rows,
            BlockStructure::Rectangular,
            rows.transpose(),
            BlockStructure::Rectangular,
            -T::rounded(1.0),
            Par::Seq,
        );
        return;
    }
    let first = half(count);
    let (top, _, below, bottom) = square.split_at_mut(first, first);
    let (rows_top, rows_bottom) = rows.split_at_row(first);
    rayon::join(
        || subtract_product(below, rows_bottom, rows_top, into),
        || {
            rayon::join(
                || subtract_square(top, rows_top, into),
                || subtract_square(bottom, rows_bottom, into),
            )
        },
    );
}

/// out <- out - a b^T
fn subtract_product<T: Number>(
    out: MatMut<'_, T>,
    a: MatRef<'_, T>,
    b: MatRef<'_, T>,
    into: Accum,
) {
    let (rows, columns) = (out.nrows(), out.ncols());
    if rows.max(columns) <= TILE {
        matmul(out, into, a, b.transpose(), -T::rounded(1.0), Par::Seq);
    } else if rows >= columns {
        let (top, bottom) = out.split_at_row_mut(half(rows));
        let (a_top, a_bottom) = a.split_at_row(half(rows));
        rayon::join(
            || subtract_product(top, a_top, b, into),
            || subtract_product(bottom, a_bottom, b, into),
        );
    } else {
        let (left, right) = out.split_at_col_mut(half(columns));
        let (b_left, b_right) = b.split_at_row(half(columns));
        rayon::join(
            || subtract_product(left, a, b_left, into),
            || subtract_product(right, a, b_right, into),
        );
    }
}
