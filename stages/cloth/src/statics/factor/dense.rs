//! Dense Cholesky factorization in blocks that run in parallel.
//!
//! The blocks depend on the sizes alone, so the bits are the same for any number of threads.
//! Products, triangular solves and small factorizations are those of the `faer` library, which
//! chooses its instructions at run time. Cost: O(n³) for n columns.

use crate::linear::leave_vectors;
use crate::statics::factor::scalar::Real;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{BlockStructure, matmul as triangular_matmul};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};

/// Columns of a block that is factored at once.
const PANEL: usize = 128;

/// Columns of a block of a product, and rows of a block of a triangular solve.
const STRIP: usize = 128;

/// Least number of multiplications of a block that is worth a task of its own.
const TASK: usize = 2_000_000;

/// Factors the lower trapezoid `a`, at least as high as wide: the first columns of a Cholesky
/// factor.
///
/// # Errors
/// The column whose pivot is not positive.
pub(crate) fn factor_columns<T: Real>(mut a: MatMut<'_, T>) -> Result<(), usize> {
    let columns = a.ncols();
    if columns <= PANEL {
        return factor_panel(a);
    }
    let half = whole_pieces(columns, PANEL);
    let (mut left, right) = a.rb_mut().split_at_col_mut(half);
    factor_columns(left.rb_mut())?;
    let mut right = right.split_at_row_mut(half).1;
    take_product(right.rb_mut(), Accum::Add, left.rb().split_at_row(half).1);
    factor_columns(right).map_err(|c| half + c)
}

fn factor_panel<T: Real>(a: MatMut<'_, T>) -> Result<(), usize> {
    let own = a.ncols();
    let (mut top, below) = a.split_at_row_mut(own);
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<T>(own, Par::Seq, Default::default()));
    let stack = MemStack::new(&mut memory);
    cholesky_in_place(top.rb_mut(), Default::default(), Par::Seq, stack, Default::default())
        .map_err(|LltError::NonPositivePivot { index }| index)?;
    if let Some(c) = (0..own).find(|&c| !(top[(c, c)] > T::ZERO && top[(c, c)].wide().is_finite())) {
        return Err(c);
    }
    solve_rows(top.rb(), below);
    Ok(())
}

/// The triangular solve for the rows below a factored square.
fn solve_rows<T: Real>(top: MatRef<'_, T>, mut below: MatMut<'_, T>) {
    let rows = below.nrows();
    if rows <= STRIP {
        solve_lower_triangular_in_place(top, below.transpose_mut(), Par::Seq);
        return leave_vectors();
    }
    let (upper, lower) = below.rb_mut().split_at_row_mut(whole_pieces(rows, STRIP));
    let work = rows * top.ncols() * top.ncols() / 2;
    join_if(work > TASK, || solve_rows(top, upper), || solve_rows(top, lower));
}

/// Subtracts `l` times the transpose of its first rows from the lower trapezoid `to`, or writes the
/// negative product there.
pub(crate) fn take_product<T: Real>(mut to: MatMut<'_, T>, accum: Accum, l: MatRef<'_, T>) {
    let columns = to.ncols();
    if columns <= STRIP {
        return take_strip(to, accum, l);
    }
    let half = whole_pieces(columns, STRIP);
    let work = to.nrows() * columns * l.ncols();
    let (left, right) = to.rb_mut().split_at_col_mut(half);
    let right = right.split_at_row_mut(half).1;
    let lower = l.split_at_row(half).1;
    join_if(work > TASK, || take_product(left, accum, l), || take_product(right, accum, lower));
}

/// One strip: a triangle and the rows below it.
fn take_strip<T: Real>(to: MatMut<'_, T>, accum: Accum, l: MatRef<'_, T>) {
    let columns = to.ncols();
    let (square, rest) = to.split_at_row_mut(columns);
    let (top, lower) = l.split_at_row(columns);
    let (triangle, full) = (BlockStructure::TriangularLower, BlockStructure::Rectangular);
    triangular_matmul(square, triangle, accum, top, full, top.transpose(), full, T::of(-1.0), Par::Seq);
    if rest.nrows() > 0 {
        matmul(rest, accum, lower, top.transpose(), T::of(-1.0), Par::Seq);
    }
    leave_vectors();
}

/// The factor of a fixed matrix and what it leaves of the border, to show this machine's
/// arithmetic; see [`crate::statics::factor::probe`]. The matrix is strictly dominated by its
/// diagonal, so it has a factor.
pub(crate) fn probe_factor<T: Real>(rows: usize, columns: usize) -> Vec<f64> {
    let value =
        |r: usize, c: usize| if r == c { 2.0 * rows as f64 } else { ((r * c + r + c) % 97) as f64 / 97.0 };
    let mut own: Vec<T> = (0..columns).flat_map(|c| (0..rows).map(move |r| T::of(value(r, c)))).collect();
    let below = rows - columns;
    let mut border = vec![T::ZERO; below * below];
    let mut front = MatMut::from_column_major_slice_mut(&mut own, rows, columns);
    if factor_columns(front.rb_mut()).is_ok() {
        let border = MatMut::from_column_major_slice_mut(&mut border, below, below);
        take_product(border, Accum::Replace, front.rb().subrows(columns, below));
    }
    own.into_iter().chain(border).map(Real::wide).collect()
}

/// Half of `size`, in whole blocks.
fn whole_pieces(size: usize, piece: usize) -> usize {
    size.div_ceil(2 * piece) * piece
}

/// Runs both functions, in parallel where it is worth it.
pub(crate) fn join_if<A: Send, B: Send>(
    worth: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if worth { rayon::join(a, b) } else { (a(), b()) }
}
