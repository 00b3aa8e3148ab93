//! Dense elimination of one front of a sparse factor.
//!
//! A front has `m` unknowns, of which the first `own` are eliminated. It is stored in two
//! column-major parts: its own columns of `m` rows, which become part of the factor, and the lower
//! triangle of its border, which the parent adds. Cost: O(m² own).

use crate::statics::factor::dense::{factor_columns, take_product};
use crate::statics::factor::scalar::Real;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut};
use nalgebra::Matrix3;
use std::ops::Range;

/// Nodes of the border of a child that are consecutive in the parent, too.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    /// The first node in the border of the child.
    pub(crate) child: u32,
    /// Its row in the parent.
    pub(crate) parent: u32,
    /// The number of nodes.
    pub(crate) nodes: u32,
}

impl Run {
    /// Its unknowns in the border of the child, and in the rows of the parent.
    pub(crate) fn rows(&self) -> (Range<usize>, Range<usize>) {
        let rows = |first: u32| 3 * first as usize..3 * (first + self.nodes) as usize;
        (rows(self.child), rows(self.parent))
    }
}

/// Adds a run of a column of a child to one of the parent, without its first rows.
#[inline]
fn add<T: Real>(from: &[T], to: &mut [T], first: usize, run: &Run, skip: usize) {
    let (at, here) = (3 * run.child as usize, 3 * run.parent as usize - first);
    let length = 3 * run.nodes as usize;
    let to = &mut to[here + skip..here + length];
    to.iter_mut().zip(&from[at + skip..at + length]).for_each(|(t, f)| *t += *f);
}

/// A front during elimination.
pub(crate) struct Dense<'a, T> {
    /// Its own columns, of `m` rows each.
    pub(crate) columns: &'a mut Vec<T>,
    /// The border, of at least `m - own` rows and columns, of which only the lower triangle is
    /// used. Elimination writes it first.
    pub(crate) border: Vec<T>,
    m: usize,
    own: usize,
}

impl<'a, T: Real> Dense<'a, T> {
    /// A front in the memory of `columns`, which are set to zero, and of `border`, which
    /// elimination overwrites.
    pub(crate) fn zeros(columns: &'a mut Vec<T>, mut border: Vec<T>, m: usize, own: usize) -> Self {
        let n = m - own;
        columns.resize(m * own, T::ZERO);
        // Longer memory keeps its length: to shorten it would fill it with zeros again later.
        border.resize(border.len().max(n * n), T::ZERO);
        (0..own).for_each(|c| columns[c * m + c..(c + 1) * m].fill(T::ZERO));
        if own == 0 {
            // Without elimination nothing else writes the border.
            border[..n * n].fill(T::ZERO);
        }
        Self { columns, border, m, own }
    }

    /// Column `c` from its first stored row on, and the index of that row.
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

    /// Adds the contribution of a child to the own columns: a lower triangle over its border, whose
    /// nodes are the rows of `runs`.
    pub(crate) fn add_to_own(&mut self, update: &[T], runs: &[Run]) {
        let own = runs.partition_point(|r| 3 * (r.parent as usize) < self.own);
        self.extend_add(update, runs, 0..own);
    }

    /// The same for the columns of the border, once the own ones are eliminated.
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
                // From the diagonal on within its own run, and all of the later ones.
                add(from, to, first, own, c);
                runs[k + 1..].iter().for_each(|run| add(from, to, first, run, 0));
            }
        }
    }

    /// Eliminates the own columns, which become part of the factor, and writes the contribution to
    /// the border.
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
