//! Dense elimination of one front of a sparse factor.
//!
//! A front of `m` unknowns, the first `own` of which are eliminated, is kept in two column-major parts: its own columns,
//! `m` rows each, which become the factor's, and the border's lower triangle, which becomes what the parent adds. The
//! products are those of the `faer` library, which picks its instructions at run time; each front is one thread's work.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, Par};
use nalgebra::Matrix3;

/// Nodes of a child's border that follow one another in the parent, too.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    /// The first in the child's border.
    pub(super) child: u32,
    /// The first among the parent's rows.
    pub(super) parent: u32,
    /// How many.
    pub(super) nodes: u32,
}

/// Adds a run of a child's column to the parent's, without its first rows.
#[inline]
fn add(from: &[f64], to: &mut [f64], first: usize, run: &Run, skip: usize) {
    let (at, here) = (3 * run.child as usize, 3 * run.parent as usize - first);
    let length = 3 * run.nodes as usize;
    let to = &mut to[here + skip..here + length];
    to.iter_mut().zip(&from[at + skip..at + length]).for_each(|(t, f)| *t += f);
}

/// One front at work.
pub(super) struct Dense<'a> {
    /// Own columns, `m` rows each.
    pub(super) columns: &'a mut Vec<f64>,
    /// The border's part, `m - own` rows and columns; only its lower triangle is used.
    pub(super) border: Vec<f64>,
    m: usize,
    own: usize,
}

impl<'a> Dense<'a> {
    /// A front of zeros in the memory of `columns` and `border`.
    pub(super) fn zeros(columns: &'a mut Vec<f64>, mut border: Vec<f64>, m: usize, own: usize) -> Self {
        let n = m - own;
        columns.resize(m * own, 0.0);
        border.truncate(n * n);
        border.resize(n * n, 0.0);
        (0..own).for_each(|c| columns[c * m + c..(c + 1) * m].fill(0.0));
        (0..n).for_each(|c| border[c * n + c..(c + 1) * n].fill(0.0));
        Self { columns, border, m, own }
    }

    /// Column `c` from its first row that is kept, and the number of that row.
    fn column(&mut self, c: usize) -> (&mut [f64], usize) {
        let (m, own, n) = (self.m, self.own, self.m - self.own);
        if c < own {
            (&mut self.columns[c * m..(c + 1) * m], 0)
        } else {
            (&mut self.border[(c - own) * n..(c - own + 1) * n], own)
        }
    }

    /// Adds a block of the matrix.
    pub(super) fn put(&mut self, row: usize, column: usize, block: &Matrix3<f64>, flipped: bool) {
        for c in 0..3 {
            let (to, first) = self.column(3 * column + c);
            for r in 0..3 {
                to[3 * row + r - first] += if flipped { block[(c, r)] } else { block[(r, c)] };
            }
        }
    }

    /// Adds what a child leaves, a lower triangle over its border, whose nodes are the rows of these runs here.
    pub(super) fn extend_add(&mut self, update: &[f64], runs: &[Run]) {
        let n: usize = runs.iter().map(|r| 3 * r.nodes as usize).sum();
        for (k, own) in runs.iter().enumerate() {
            for c in 0..3 * own.nodes as usize {
                let from = &update[(3 * own.child as usize + c) * n..][..n];
                let (to, first) = self.column(3 * own.parent as usize + c);
                // Within its own run from the diagonal on, in the later ones all.
                add(from, to, first, own, c);
                runs[k + 1..].iter().for_each(|run| add(from, to, first, run, 0));
            }
        }
    }

    /// Eliminates the own columns: they become the factor's, the border what is left to the parent.
    ///
    /// # Errors
    /// The column whose pivot is not positive.
    pub(super) fn eliminate(&mut self) -> Result<(), usize> {
        let (m, own, n) = (self.m, self.own, self.m - self.own);
        if own == 0 {
            return Ok(());
        }
        let all = MatMut::from_column_major_slice_mut(&mut self.columns[..], m, own);
        let (mut top, mut below) = all.split_at_row_mut(own);
        let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(own, Par::Seq, Default::default()));
        let stack = MemStack::new(&mut memory);
        cholesky_in_place(top.rb_mut(), Default::default(), Par::Seq, stack, Default::default())
            .map_err(|LltError::NonPositivePivot { index }| index)?;
        if let Some(c) = (0..own).find(|&c| !(top[(c, c)] > 0.0 && top[(c, c)].is_finite())) {
            return Err(c);
        }
        solve_lower_triangular_in_place(top.rb(), below.rb_mut().transpose_mut(), Par::Seq);
        let border = MatMut::from_column_major_slice_mut(&mut self.border[..], n, n);
        matmul(
            border,
            BlockStructure::TriangularLower,
            Accum::Add,
            below.rb(),
            BlockStructure::Rectangular,
            below.rb().transpose(),
            BlockStructure::Rectangular,
            -1.0,
            Par::Seq,
        );
        Ok(())
    }
}
