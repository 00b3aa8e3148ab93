//! Sparse Cholesky factor of a symmetric (or Hermitian) matrix on the graph of a mesh: `A = L L^H`.
//!
//! One number or a 2 x 2 block a vertex and a pair of coupled vertices. The order comes from nested
//! dissection, the factor is supernodal (by the `faer` library). The symbolic part is done once a
//! graph and reused. One thread, so the bits never change. For n vertices the factor holds about n
//! log n numbers and takes about n^1.5 products.

use super::graph::Graph;
use super::vectors::leave_vectors;
use crate::error::FlattenError;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::traits::ComplexField;
use faer::{Conj, MatMut, Par, Side};

/// A factor that can be renewed for other values of the same graph.
pub(crate) struct CholeskyFactor<T> {
    pattern: SymbolicSparseColMat<u32>,
    symbolic: SymbolicCholesky<u32>,
    factor: Vec<T>,
    workspace: MemBuffer,
}

impl<T: ComplexField + Copy> CholeskyFactor<T> {
    /// Analyses the pattern for `width` numbers a vertex, 1 or 2; `order` lists the vertices in the
    /// order of elimination.
    ///
    /// # Errors
    /// [`FlattenError::Factorization`] if memory runs out.
    pub(crate) fn analyse(graph: &Graph, width: usize, order: &[u32]) -> Result<Self, FlattenError> {
        let pattern = lower_pattern(graph, width);
        let unknowns = pattern.ncols();
        let refused = |e: &dyn std::fmt::Debug| refused(unknowns, e);
        let forward = expanded(order, width);
        let mut inverse = vec![0u32; forward.len()];
        forward.iter().enumerate().for_each(|(k, &v)| inverse[v as usize] = k as u32);
        let symbolic = factorize_symbolic_cholesky(
            pattern.as_ref(),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, forward.len())),
            CholeskySymbolicParams::default(),
        )
        .map_err(|e| refused(&e))?;
        let needed = symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, Default::default());
        let workspace = MemBuffer::try_new(needed).map_err(|e| refused(&e))?;
        let factor = vec![T::zero_impl(); symbolic.len_val()];
        Ok(Self { pattern, symbolic, factor, workspace })
    }

    /// Factors the matrix of these values, placed as [`slot`] and [`block_slots`] say.
    ///
    /// # Errors
    /// [`FlattenError::Factorization`] if the matrix is not positive definite.
    pub(crate) fn factor(&mut self, values: &[T]) -> Result<(), FlattenError> {
        let unknowns = self.pattern.ncols();
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        let done = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            matrix,
            Side::Lower,
            LltRegularization {
                dynamic_regularization_delta: T::Real::zero_impl(),
                dynamic_regularization_epsilon: T::Real::zero_impl(),
            },
            Par::Seq,
            MemStack::new(&mut self.workspace),
            Default::default(),
        );
        leave_vectors();
        done.map_err(|e| refused(unknowns, &e))?;
        Ok(())
    }

    /// Solves for the right-hand sides in `b`, one whole column after the other, in place.
    ///
    /// # Errors
    /// [`FlattenError::Factorization`] if a result is not finite: the factor stops at pivots that
    /// are not above zero, but lets NaN pass.
    pub(crate) fn solve(&self, b: &mut [T]) -> Result<(), FlattenError> {
        let rows = self.pattern.ncols();
        let columns = b.len() / rows.max(1);
        let mut workspace = MemBuffer::new(self.symbolic.solve_in_place_scratch::<T>(columns, Par::Seq));
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(b, rows, columns),
            Par::Seq,
            MemStack::new(&mut workspace),
        );
        leave_vectors();
        if b.iter().all(T::is_finite_impl) { Ok(()) } else { Err(refused(rows, &"a result is not finite")) }
    }
}

fn refused(unknowns: usize, e: &dyn std::fmt::Debug) -> FlattenError {
    FlattenError::Factorization { unknowns, why: format!("{e:?}").to_lowercase() }
}

/// Columns of the lower triangle.
fn lower_pattern(graph: &Graph, width: usize) -> SymbolicSparseColMat<u32> {
    let n = graph.vertices();
    let (mut starts, mut rows) = (vec![0u32], Vec::new());
    for i in 0..n {
        for k in 0..width {
            rows.extend((k..width).map(|r| (width * i + r) as u32));
            for &j in graph.above(i) {
                rows.extend((0..width).map(|r| (width * j as usize + r) as u32));
            }
            starts.push(rows.len() as u32);
        }
    }
    SymbolicSparseColMat::new_checked(n * width, n * width, starts, None, rows)
}

/// Each vertex of an order as its `width` numbers.
fn expanded(order: &[u32], width: usize) -> Vec<u32> {
    let width = width as u32;
    order.iter().flat_map(|&v| (0..width).map(move |k| width * v + k)).collect()
}

/// Where the values of a matrix with one number a vertex lie: the diagonal of vertex `i`, then its
/// pairs in order.
#[must_use]
pub(crate) fn slot(graph: &Graph, i: usize) -> usize {
    graph.start(i) + i
}

/// Where a 2 x 2 block's columns begin: the diagonal block of vertex `i` at its first and second
/// column.
///
/// The first column holds two numbers of the diagonal block, the second one; each pair then has two
/// numbers a column.
#[must_use]
pub(crate) fn block_slots(graph: &Graph, i: usize) -> [usize; 2] {
    let first = 4 * graph.start(i) + 3 * i;
    [first, first + 2 + 2 * graph.above(i).len()]
}
