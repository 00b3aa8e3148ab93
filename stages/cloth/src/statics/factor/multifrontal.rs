//! Sparse Cholesky factorization of a block matrix by the multifrontal method.
//!
//! Method: the multifrontal method (Duff, Reid 1983) over a nested dissection. Each front is a
//! small dense matrix of its own nodes, which are eliminated, and of its border, which passes to
//! the parent. All heavy work is dense products, which run near the peak speed of the machine.
//! Fronts of different branches run in parallel, large ones in strips of fixed size, and are summed
//! in the order of the children, so the bits do not depend on the number of threads. The forward
//! substitution (`substitute`) is made while a front is in memory.
//!
//! Cost for a sheet of n nodes: about 40 n log2 n numbers in the factor, O(n^1.5) multiplications.
//! Limit: memory of the factor, about 0.5 GB at 50,000 nodes.

mod substitute;

use crate::linear::Pattern;
use crate::statics::factor::dense::join_if;
use crate::statics::factor::front::{Dense, Run};
use crate::statics::factor::nested_dissection::{Part, dissect};
use crate::statics::factor::scalar::Real;
use nalgebra::{Matrix3, Vector3};
use std::sync::Mutex;

/// Least number of unknowns of a front that is worth a task of its own.
const TASK_UNKNOWNS: usize = 400;

/// The matrix is not positive definite at this node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the stiffness matrix is not positive definite at node {node}; look for vertices of no triangle, a start on a line, or numbers beyond those of cloth"
)]
pub struct NotPositive {
    /// The node whose pivot failed.
    pub node: u32,
}

/// Why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Halt {
    /// The matrix is not positive definite.
    #[error(transparent)]
    NotPositive(#[from] NotPositive),
    /// The caller has stopped it.
    #[error("stopped on request")]
    Stopped,
}

/// Returns whether to stop; asked before every front.
pub type Stop<'s> = dyn Fn() -> bool + Sync + 's;

/// The symbolic factorization, which does not depend on the values.
#[derive(Debug, Clone)]
pub struct Symbolic {
    /// The free nodes in the order of elimination.
    order: Vec<u32>,
    fronts: Vec<Front>,
}

#[derive(Debug, Clone)]
struct Front {
    nodes: Vec<u32>,
    border: Vec<u32>,
    children: Vec<usize>,
    /// For each child, where its border lies among this front's rows.
    child_runs: Vec<Vec<Run>>,
    /// Slot, local row and local column of each block that is assembled here, and whether it is
    /// transposed.
    entries: Vec<(u32, u32, u32, bool)>,
    /// Unknowns of this front and all below it.
    weight: usize,
}

impl Front {
    fn unknowns(&self) -> usize {
        3 * (self.nodes.len() + self.border.len())
    }

    /// Unknowns that are eliminated here.
    fn own(&self) -> usize {
        3 * self.nodes.len()
    }
}

/// A factor: for each front the columns of its own nodes, `unknowns` rows each.
#[derive(Debug, Default)]
pub struct Factor<T> {
    columns: Vec<Vec<T>>,
    spare: Spare<T>,
}

/// Memory of borders, reused by later fronts and factorizations: new pages would cost more than the
/// sums.
#[derive(Debug, Default)]
struct Spare<T>(Mutex<Vec<Vec<T>>>);

impl<T> Spare<T> {
    /// The smallest buffer of at least `size` numbers, or a new one. Small buffers must not grow,
    /// for in the end all would be large.
    fn take(&self, size: usize) -> Vec<T> {
        let Ok(mut spare) = self.0.lock() else { return Vec::new() };
        let fits = (0..spare.len()).filter(|&k| spare[k].capacity() >= size);
        let best = fits.min_by_key(|&k| spare[k].capacity());
        best.map_or_else(|| Vec::with_capacity(size), |k| spare.swap_remove(k))
    }

    fn give(&self, border: Vec<T>) {
        if let Ok(mut s) = self.0.lock() {
            s.push(border);
        }
    }
}

impl Symbolic {
    /// Orders and analyses `pattern`. `layout` has a place for each node, best in the flat sheet.
    pub fn new(pattern: &Pattern, layout: &[Vector3<f64>]) -> Self {
        let parts = dissect(pattern, layout);
        let mut order = vec![0u32; pattern.nodes()];
        let mut part_of = vec![0u32; pattern.nodes()];
        let mut next = 0;
        for (k, part) in parts.iter().enumerate() {
            for &i in &part.nodes {
                order[i as usize] = next;
                part_of[i as usize] = k as u32;
                next += 1;
            }
        }
        let mut fronts: Vec<Front> = Vec::with_capacity(parts.len());
        let mut later = vec![Vec::new(); parts.len()];
        for (i, j, slot) in pattern.upper() {
            let (first, last) = if order[i as usize] < order[j as usize] { (i, j) } else { (j, i) };
            later[part_of[first as usize] as usize].push((first, last, slot, last == i));
        }
        for (part, later) in parts.into_iter().zip(later) {
            let front = build_front(part, later, &order, &fronts);
            fronts.push(front);
        }
        Self { order: fronts.iter().flat_map(|f| f.nodes.iter().copied()).collect(), fronts }
    }

    /// The number of values in the factor.
    pub fn factor_len(&self) -> usize {
        self.fronts.iter().map(|f| 3 * f.nodes.len() * f.unknowns()).sum()
    }

    /// The number of multiplications of one factorization.
    pub fn work(&self) -> f64 {
        let front = |f: &Front| {
            let (own, m) = (3.0 * f.nodes.len() as f64, f.unknowns() as f64);
            own * (m - own) * m * 0.5 + own * own * own / 6.0
        };
        self.fronts.iter().map(front).sum()
    }

    /// Factors the matrix of these block values into the memory of `factor` and solves for `x`,
    /// which is the right-hand side, then the solution. `x` does not change where it fails. `stop`
    /// is asked before every front.
    ///
    /// # Errors
    /// [`Halt`]: the matrix is not positive definite, or `stop` returned true.
    pub fn factor_and_solve<T: Real>(
        &self,
        values: &[Matrix3<f64>],
        factor: &mut Factor<T>,
        x: &mut [Vector3<f64>],
        stop: &Stop,
    ) -> Result<(), Halt> {
        let Some(root) = self.fronts.len().checked_sub(1) else { return Ok(()) };
        factor.columns.resize(self.fronts.len(), Vec::new());
        let mut y = self.ordered(x);
        let work = Solve { symbolic: self, values, spare: &factor.spare, stop };
        let left = work.eliminate(root, &mut factor.columns, &mut y)?;
        factor.spare.give(left.border);
        self.backward(root, &factor.columns, &mut y, &[]);
        self.restore(&y, x);
        Ok(())
    }

    /// Solves in place: `x` is the right-hand side, then the solution. Held nodes do not change.
    pub fn solve<T: Real>(&self, factor: &Factor<T>, x: &mut [Vector3<f64>]) {
        let Some(root) = self.fronts.len().checked_sub(1) else { return };
        let mut y = self.ordered(x);
        self.forward(root, &factor.columns, &mut y);
        self.backward(root, &factor.columns, &mut y, &[]);
        self.restore(&y, x);
    }
}

/// A running factorization.
struct Solve<'w, T> {
    symbolic: &'w Symbolic,
    values: &'w [Matrix3<f64>],
    spare: &'w Spare<T>,
    stop: &'w Stop<'w>,
}

/// The contribution of a front to its parent.
struct Left<T> {
    /// The matrix of its border, the lower triangle by columns.
    border: Vec<T>,
    /// The right-hand side of its border.
    right: Vec<T>,
}

impl<T: Real> Solve<'_, T> {
    /// Factors the front `k` and all below it. Their columns are the last of `columns`, and their
    /// right-hand sides are `y`, which becomes the result of the forward substitution.
    fn eliminate(&self, k: usize, columns: &mut [Vec<T>], y: &mut [T]) -> Result<Left<T>, Halt> {
        let front = &self.symbolic.fronts[k];
        let Some((mine, below)) = columns.split_last_mut() else { return Err(Halt::Stopped) };
        let (below_y, y) = y.split_at_mut(y.len() - front.own());
        let below = self.eliminate_children(front, below, below_y)?;
        if (self.stop)() {
            return Err(Halt::Stopped);
        }
        let border = self.spare.take(9 * front.border.len() * front.border.len());
        let mut dense = Dense::zeros(mine, border, front.unknowns(), front.own());
        for &(slot, row, column, flipped) in &front.entries {
            dense.put(row as usize, column as usize, &self.values[slot as usize], flipped);
        }
        below.iter().zip(&front.child_runs).for_each(|(b, runs)| dense.add_to_own(&b.border, runs));
        dense.eliminate().map_err(|c| NotPositive { node: front.nodes[c / 3] })?;
        below.iter().zip(&front.child_runs).for_each(|(b, runs)| dense.add_to_border(&b.border, runs));
        let border = dense.border;
        let rights: Vec<Vec<T>> = below.into_iter().map(|b| self.recycle(b)).collect();
        Ok(Left { border, right: front.forward(mine, y, &rights) })
    }

    /// Releases the memory of a border; the right-hand side is kept.
    fn recycle(&self, left: Left<T>) -> Vec<T> {
        self.spare.give(left.border);
        left.right
    }

    fn eliminate_children(
        &self,
        front: &Front,
        columns: &mut [Vec<T>],
        y: &mut [T],
    ) -> Result<Vec<Left<T>>, Halt> {
        match front.children[..] {
            [] => Ok(vec![]),
            [a] => Ok(vec![self.eliminate(a, columns, y)?]),
            [a, b, ..] => {
                // Children follow each other, each after all fronts below it.
                let (left, right) = columns.split_at_mut(columns.len() - (b - a));
                let (left_y, right_y) = y.split_at_mut(self.symbolic.fronts[a].weight);
                let (a, b) = join_if(
                    self.symbolic.worth(a, b),
                    || self.eliminate(a, left, left_y),
                    || self.eliminate(b, right, right_y),
                );
                Ok(vec![a?, b?])
            }
        }
    }
}

fn build_front(part: Part, later: Vec<(u32, u32, u32, bool)>, order: &[u32], fronts: &[Front]) -> Front {
    let last_own = part.nodes.iter().map(|&i| order[i as usize]).max().unwrap_or(0);
    let mut border: Vec<u32> = later.iter().map(|&(_, last, _, _)| last).collect();
    for &c in &part.children {
        border.extend_from_slice(&fronts[c].border);
    }
    border.retain(|&i| order[i as usize] > last_own);
    border.sort_unstable_by_key(|&i| order[i as usize]);
    border.dedup();
    let first_own = part.nodes.first().map_or(0, |&i| order[i as usize]);
    let own = part.nodes.len() as u32;
    let row = |i: u32| {
        let at = order[i as usize];
        if at <= last_own && own > 0 {
            return at - first_own;
        }
        own + border.binary_search_by_key(&at, |&b| order[b as usize]).unwrap_or(0) as u32
    };
    let child_runs =
        part.children.iter().map(|&c| runs(fronts[c].border.iter().map(|&i| row(i)), own)).collect();
    let mut entries: Vec<_> = part.nodes.iter().map(|&i| (i, row(i), row(i), false)).collect();
    // Blocks are stored with row i < column j, but a front has the later node as the row.
    entries.extend(
        later.iter().map(|&(first, last, slot, last_is_row)| (slot, row(last), row(first), !last_is_row)),
    );
    let weight = 3 * part.nodes.len() + part.children.iter().map(|&c| fronts[c].weight).sum::<usize>();
    Front { nodes: part.nodes, border, children: part.children, child_runs, entries, weight }
}

/// Runs of consecutive rows; no run crosses the first `own` rows.
fn runs(rows: impl Iterator<Item = u32>, own: u32) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (child, parent) in rows.enumerate() {
        match runs.last_mut() {
            Some(run) if run.parent + run.nodes == parent && parent != own => run.nodes += 1,
            _ => runs.push(Run { child: child as u32, parent, nodes: 1 }),
        }
    }
    runs
}

#[cfg(test)]
mod tests;
