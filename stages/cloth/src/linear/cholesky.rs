//! Sparse Cholesky factor of a block matrix: `A = L L^T`.
//!
//! The order of elimination is approximate minimum degree on the graph of blocks (Amestoy, Davis,
//! Duff, 1996), a third the size of the graph of scalars; the factor is supernodal (by the `faer`
//! library). For a sheet of n vertices the factor holds about n log n numbers and takes about n^1.5
//! products. The symbolic part is done once a pattern and reused. One thread, so the bits never
//! change.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::Vec3;
use super::{BlockMatrix, leave_vectors};
use crate::error::ClothError;

/// A factor that can be renewed for other values of the same pattern.
pub struct Cholesky {
    width: usize,
    pattern: SymbolicSparseColMat<u32>,
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    factor: Vec<f64>,
    workspace: MemBuffer,
}

impl Cholesky {
    /// Orders and analyses the pattern of `a`; the values do not matter yet.
    ///
    /// # Errors
    /// [`ClothError::Factorization`] if memory runs out.
    pub fn analyse(a: &BlockMatrix) -> Result<Self, ClothError> {
        Self::analyse_width(a, 3)
    }

    /// For a matrix whose blocks are multiples of the identity: keeps one number per block, a ninth
    /// of the work.
    ///
    /// # Errors
    /// [`ClothError::Factorization`] if memory runs out.
    pub fn analyse_scalar(a: &BlockMatrix) -> Result<Self, ClothError> {
        Self::analyse_width(a, 1)
    }

    fn analyse_width(a: &BlockMatrix, width: usize) -> Result<Self, ClothError> {
        let pattern = scalar_pattern(a, width);
        let (forward, inverse) = order(a, width)?;
        let permutation = faer::perm::PermRef::new_checked(&forward, &inverse, forward.len());
        let symbolic = factorize_symbolic_cholesky(
            pattern.as_ref(),
            Side::Lower,
            SymmetricOrdering::Custom(permutation),
            CholeskySymbolicParams::default(),
        )
        .map_err(refused)?;
        let needed = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let workspace = MemBuffer::try_new(needed).map_err(refused)?;
        let factor = vec![0.0; symbolic.len_val()];
        let values = vec![0.0; pattern.row_idx().len()];
        Ok(Self { width, pattern, symbolic, values, factor, workspace })
    }

    /// Numbers in the factor.
    #[must_use]
    pub fn fill(&self) -> usize {
        self.factor.len()
    }

    /// Factors `a`, whose pattern is the analysed one.
    ///
    /// # Errors
    /// [`ClothError::Factorization`] if `a` is not positive definite.
    pub fn factor(&mut self, a: &BlockMatrix) -> Result<(), ClothError> {
        copy_values(a, self.width, &mut self.values);
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), &self.values[..]);
        let done = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            matrix,
            Side::Lower,
            LltRegularization { dynamic_regularization_delta: 0.0, dynamic_regularization_epsilon: 0.0 },
            Par::Seq,
            MemStack::new(&mut self.workspace),
            Default::default(),
        );
        leave_vectors();
        done.map_err(refused)?;
        // The library only stops at pivots that are not above zero; NaN must not slip through.
        if self.factor.iter().all(|v| v.is_finite()) {
            Ok(())
        } else {
            Err(ClothError::Factorization { why: "a pivot is not finite".into() })
        }
    }

    /// Solves `A x = b` with the last factor.
    #[must_use]
    pub fn solve(&self, b: &[Vec3]) -> Vec<Vec3> {
        let (rows, columns) = (b.len() * self.width, 3 / self.width);
        let mut flat = vec![0.0; 3 * b.len()];
        // One column of all scalars, or three columns of one scalar per block.
        let at = |v: usize, k: usize| if self.width == 3 { 3 * v + k } else { rows * k + v };
        for (v, value) in b.iter().enumerate() {
            (0..3).for_each(|k| flat[at(v, k)] = value[k]);
        }
        let mut workspace = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq));
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut flat, rows, columns),
            Par::Seq,
            MemStack::new(&mut workspace),
        );
        leave_vectors();
        (0..b.len()).map(|v| Vec3::new(flat[at(v, 0)], flat[at(v, 1)], flat[at(v, 2)])).collect()
    }
}

fn refused(e: impl std::fmt::Debug) -> ClothError {
    ClothError::Factorization { why: format!("{e:?}").to_lowercase() }
}

/// Columns of the lower triangle: block row i of the upper triangle, read as `width` columns.
fn scalar_pattern(a: &BlockMatrix, width: usize) -> SymbolicSparseColMat<u32> {
    let n = width * a.rows();
    let (mut starts, mut rows) = (Vec::with_capacity(n + 1), Vec::with_capacity(9 * a.block_count()));
    starts.push(0);
    for i in 0..a.rows() {
        for k in 0..width {
            for (j, _) in a.row(i) {
                let first = if i == j { k } else { 0 };
                rows.extend((first..width).map(|r| (width * j + r) as u32));
            }
            starts.push(rows.len() as u32);
        }
    }
    SymbolicSparseColMat::new_checked(n, n, starts, None, rows)
}

fn copy_values(a: &BlockMatrix, width: usize, values: &mut [f64]) {
    let mut slot = 0;
    for i in 0..a.rows() {
        for k in 0..width {
            for (j, block) in a.row(i) {
                let first = if i == j { k } else { 0 };
                for r in first..width {
                    values[slot] = block[(k, r)];
                    slot += 1;
                }
            }
        }
    }
}

/// Minimum degree on the block graph, each vertex then standing for its scalars.
fn order(a: &BlockMatrix, width: usize) -> Result<(Vec<u32>, Vec<u32>), ClothError> {
    let n = a.rows();
    let (mut starts, mut rows) = (vec![0_u32], Vec::with_capacity(a.block_count()));
    for i in 0..n {
        rows.extend(a.row(i).map(|(j, _)| j as u32));
        starts.push(rows.len() as u32);
    }
    // The strict lower triangle column by column is what the library calls the upper one of the
    // transpose: symmetric, so the same.
    let graph = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
    let full = symmetric(&graph);
    let (mut forward, mut inverse) = (vec![0_u32; n], vec![0_u32; n]);
    let mut workspace =
        MemBuffer::try_new(amd::order_scratch::<u32>(n, full.row_idx().len())).map_err(refused)?;
    amd::order(
        &mut forward,
        &mut inverse,
        full.as_ref(),
        amd::Control::default(),
        MemStack::new(&mut workspace),
    )
    .map_err(refused)?;
    let expand = |p: &[u32]| {
        p.iter().flat_map(|&v| (0..width as u32).map(move |k| width as u32 * v + k)).collect::<Vec<_>>()
    };
    let forward = expand(&forward);
    let mut inverse = vec![0; forward.len()];
    for (k, &v) in forward.iter().enumerate() {
        inverse[v as usize] = k as u32;
    }
    Ok((forward, inverse))
}

/// Both triangles of a graph given by one.
fn symmetric(half: &SymbolicSparseColMatRef<'_, u32>) -> SymbolicSparseColMat<u32> {
    let n = half.ncols();
    let mut lists = vec![Vec::new(); n];
    for i in 0..n {
        for &j in half.row_idx_of_col_raw(i) {
            lists[i].push(j);
            if j as usize != i {
                lists[j as usize].push(i as u32);
            }
        }
    }
    let mut starts = vec![0_u32];
    let mut rows = Vec::new();
    for list in &mut lists {
        list.sort_unstable();
        rows.extend_from_slice(list);
        starts.push(rows.len() as u32);
    }
    SymbolicSparseColMat::new_checked(n, n, starts, None, rows)
}
