//! Dense elimination of one front of a sparse factor.
//!
//! A front of `m` unknowns, the first `own` of which are eliminated, is kept in two column-major
//! parts: its own columns, `m` rows each, which become the factor's, and the border's lower
//! triangle, which becomes what the parent adds.

use crate::statics::factor::dense::{factor_columns, take_product};
use crate::statics::factor::scalar::Real;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut};
use nalgebra::Matrix3;
use std::ops::Range;

/// Nodes of a child's border that follow one another in the parent, too.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    /// The first in the child's border.
    pub(crate) child: u32,
    /// The first among the parent's rows.
    pub(crate) parent: u32,
    /// How many.
    pub(crate) nodes: u32,
}

impl Run {
    /// Its unknowns in the child's border, and among the parent's rows.
    pub(crate) fn rows(&self) -> (Range<usize>, Range<usize>) {
        let rows = |first: u32| 3 * first as usize..3 * (first + self.nodes) as usize;
        (rows(self.child), rows(self.parent))
    }
}

/// Adds a run of a child's column to the parent's, without its first rows.
#[inline]
fn add<T: Real>(from: &[T], to: &mut [T], first: usize, run: &Run, skip: usize) {
    let (at, here) = (3 * run.child as usize, 3 * run.parent as usize - first);
    let length = 3 * run.nodes as usize;
    let to = &mut to[here + skip..here + length];
    to.iter_mut().zip(&from[at + skip..at + length]).for_each(|(t, f)| *t += *f);
}

/// One front at work.
pub(crate) struct Dense<'a, T> {
    /// Own columns, `m` rows each.
    pub(crate) columns: &'a mut Vec<T>,
    /// The border's part, `m - own` rows and columns or more; only its lower triangle is used.
    /// Elimination writes it first.
    pub(crate) border: Vec<T>,
    m: usize,
    own: usize,
}

impl<'a, T: Real> Dense<'a, T> {
    /// A front in the memory of `columns`, which are zeros then, and of `border`, which elimination
    /// writes over.
    pub(crate) fn zeros(columns: &'a mut Vec<T>, mut border: Vec<T>, m: usize, own: usize) -> Self {
        let n = m - own;
        columns.resize(m * own, T::ZERO);
        // FrictionHistory that was longer stays so: to cut it would fill it with zeros again later.
        border.resize(border.len().max(n * n), T::ZERO);
        (0..own).for_each(|c| columns[c * m + c..(c + 1) * m].fill(T::ZERO));
        if own == 0 {
            // Nothing is eliminated, so nothing writes it.
            border[..n * n].fill(T::ZERO);
        }
        Self { columns, border, m, own }
    }

    /// Column `c` from its first row that is kept, and the number of that row.
    fn column(&mut self, c: usize) -> (&mut [T], usize) {
        let (m, own, n) = (self.m, self.own, self.m - self.own);
        if c < own {
            (&mut self.columns[c * m..(c + 1) * m], 0)
        } else {
            (&mut self.border[(c - own) * n..(c - own + 1) * n], own)
        }
    }

    /// Adds a block of the matrix.
    pub(crate) fn put(&mut self, row: usize, column: usize, block: &Matrix3<f64>, flipped: bool) {
        for c in 0..3 {
            let (to, first) = self.column(3 * column + c);
            for r in 0..3 {
                to[3 * row + r - first] += T::of(if flipped { block[(c, r)] } else { block[(r, c)] });
            }
        }
    }

    /// Adds what a child leaves in the own columns: a lower triangle over its border, whose nodes
    /// are the rows of these runs.
    pub(crate) fn add_to_own(&mut self, update: &[T], runs: &[Run]) {
        let own = runs.partition_point(|r| 3 * (r.parent as usize) < self.own);
        self.extend_add(update, runs, 0..own);
    }

    /// The same in the border's columns, once the own ones are eliminated.
    pub(crate) fn add_to_border(&mut self, update: &[T], runs: &[Run]) {
        let own = runs.partition_point(|r| 3 * (r.parent as usize) < self.own);
        self.extend_add(update, runs, own..runs.len());
    }

    fn extend_add(&mut self, update: &[T], runs: &[Run], of: Range<usize>) {
        let n: usize = runs.iter().map(|r| 3 * r.nodes as usize).sum();
        for k in of {
            let own = &runs[k];
            for c in 0..3 * own.nodes as usize {
                let from = &update[(3 * own.child as usize + c) * n..][..n];
                let (to, first) = self.column(3 * own.parent as usize + c);
                // Within its own run from the diagonal on, in the later ones all.
                add(from, to, first, own, c);
                runs[k + 1..].iter().for_each(|run| add(from, to, first, run, 0));
            }
        }
    }

    /// Eliminates the own columns, which become the factor's, and writes what that leaves of the
    /// border.
    ///
    /// # Errors
    /// The column whose pivot is not positive.
    pub(crate) fn eliminate(&mut self) -> Result<(), usize> {
        let (m, own, n) = (self.m, self.own, self.m - self.own);
        if own == 0 {
            return Ok(());
        }
        let mut all = MatMut::from_column_major_slice_mut(&mut self.columns[..], m, own);
        factor_columns(all.rb_mut())?;
        let below = all.rb().subrows(own, n);
        let border = MatMut::from_column_major_slice_mut(&mut self.border[..n * n], n, n);
        take_product(border, Accum::Replace, below);
        Ok(())
    }
}
