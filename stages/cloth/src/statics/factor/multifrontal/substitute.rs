//! Forward and backward substitution with a multifrontal factor: up the tree of fronts, and down.
//!
//! Values are stored in the order of elimination, in which all nodes below a front are consecutive.
//! Branches share nothing, so they run in parallel. The contribution of a branch to the nodes above
//! it is a vector over its border. Cost: each value of the factor is read twice, so the limit is
//! memory bandwidth.

use super::{Front, Symbolic, TASK_UNKNOWNS};
use crate::statics::factor::dense::join_if;
use crate::statics::factor::scalar::Real;
use nalgebra::Vector3;

impl Symbolic {
    /// Values of the nodes in the order of elimination.
    pub(super) fn ordered<T: Real>(&self, x: &[Vector3<f64>]) -> Vec<T> {
        debug_assert!(x.len() >= self.order.len());
        self.order.iter().flat_map(|&i| x[i as usize].iter().map(|&v| T::of(v))).collect()
    }

    /// The values in the order of the nodes.
    pub(super) fn restore<T: Real>(&self, y: &[T], x: &mut [Vector3<f64>]) {
        for (&i, v) in self.order.iter().zip(y.as_chunks::<3>().0) {
            x[i as usize] = Vector3::from(v.map(T::wide));
        }
    }

    /// Forward substitution for the front `k` and all below it; returns the contribution to its
    /// parent.
    pub(super) fn forward<T: Real>(&self, k: usize, columns: &[Vec<T>], y: &mut [T]) -> Vec<T> {
        let front = &self.fronts[k];
        let Some((mine, below)) = columns.split_last() else { return Vec::new() };
        let (below_y, y) = y.split_at_mut(y.len() - front.own());
        let rights = match front.children[..] {
            [] => vec![],
            [a] => vec![self.forward(a, below, below_y)],
            [a, b, ..] => {
                let (left, right) = below.split_at(below.len() - (b - a));
                let (left_y, right_y) = below_y.split_at_mut(self.fronts[a].weight);
                let both = join_if(
                    self.worth(a, b),
                    || self.forward(a, left, left_y),
                    || self.forward(b, right, right_y),
                );
                vec![both.0, both.1]
            }
        };
        front.forward(mine, y, &rights)
    }

    /// Backward substitution; `border` is the solution on the border.
    pub(super) fn backward<T: Real>(&self, k: usize, columns: &[Vec<T>], y: &mut [T], border: &[T]) {
        let front = &self.fronts[k];
        let Some((mine, below)) = columns.split_last() else { return };
        let (below_y, y) = y.split_at_mut(y.len() - front.own());
        let local = front.backward(mine, y, border);
        match front.children[..] {
            [] => {}
            [a] => self.backward(a, below, below_y, &front.seen_by(0, &local)),
            [a, b, ..] => {
                let (left, right) = below.split_at(below.len() - (b - a));
                let (left_y, right_y) = below_y.split_at_mut(self.fronts[a].weight);
                join_if(
                    self.worth(a, b),
                    || self.backward(a, left, left_y, &front.seen_by(0, &local)),
                    || self.backward(b, right, right_y, &front.seen_by(1, &local)),
                );
            }
        }
    }

    /// Whether two branches are large enough to run in parallel.
    pub(super) fn worth(&self, a: usize, b: usize) -> bool {
        self.fronts[a].weight.min(self.fronts[b].weight) > TASK_UNKNOWNS
    }
}

impl Front {
    /// Forward substitution of one front for its own unknowns `y`, with the contributions `rights`
    /// of the children; returns the contribution to the parent.
    pub(super) fn forward<T: Real>(&self, columns: &[T], y: &mut [T], rights: &[Vec<T>]) -> Vec<T> {
        let own = self.own();
        let mut local = vec![T::ZERO; self.unknowns()];
        local[..own].copy_from_slice(y);
        for (right, runs) in rights.iter().zip(&self.child_runs) {
            for run in runs {
                let (from, to) = run.rows();
                local[to].iter_mut().zip(&right[from]).for_each(|(l, r)| *l += *r);
            }
        }
        forward(columns, &mut local, own);
        y.copy_from_slice(&local[..own]);
        local.split_off(own)
    }

    /// Backward substitution of one front with the solution on the `border`; returns the solution
    /// on both.
    fn backward<T: Real>(&self, columns: &[T], y: &mut [T], border: &[T]) -> Vec<T> {
        let own = self.own();
        let mut local = Vec::with_capacity(self.unknowns());
        local.extend_from_slice(y);
        local.extend_from_slice(border);
        backward(columns, &mut local, own);
        y.copy_from_slice(&local[..own]);
        local
    }

    /// The solution on the border of a child.
    fn seen_by<T: Real>(&self, child: usize, local: &[T]) -> Vec<T> {
        self.child_runs[child].iter().flat_map(|run| local[run.rows().1].iter().copied()).collect()
    }
}

fn forward<T: Real>(columns: &[T], local: &mut [T], own: usize) {
    let m = local.len();
    for c in 0..own {
        let column = &columns[c * m..(c + 1) * m];
        let v = local[c] / column[c];
        local[c] = v;
        local[c + 1..].iter_mut().zip(&column[c + 1..]).for_each(|(x, l)| *x -= v * *l);
    }
}

fn backward<T: Real>(columns: &[T], local: &mut [T], own: usize) {
    let m = local.len();
    for c in (0..own).rev() {
        let column = &columns[c * m..(c + 1) * m];
        let sum = dot(&column[c + 1..], &local[c + 1..]);
        local[c] = (local[c] - sum) / column[c];
    }
}

/// A dot product in eight partial sums, which the compiler can vectorise.
fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    let ((a8, a1), (b8, b1)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [T::ZERO; 8];
    for (a, b) in a8.iter().zip(b8) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.into_iter().sum::<T>() + a1.iter().zip(b1).map(|(a, b)| *a * *b).sum::<T>()
}
