//! Sparse Cholesky factors of a block matrix, front by front.
//!
//! Method: the multifrontal method (Duff, Reid 1983) over a nested dissection. Each front is a small dense matrix: its own
//! nodes, eliminated, and the border, which passes to the parent. All heavy work is dense products, so it runs near the
//! speed of the machine. Fronts of different branches run side by side and are summed in the order of the children, so
//! the bits do not depend on threads.
//!
//! Cost for a sheet of n nodes: about 40 n log2 n numbers in the factor, O(n^1.5) multiplications. Limit: memory of the
//! factor, about 0.5 GB at 50,000 nodes.

use super::dissect::{Part, dissect};
use super::front::{Dense, Run};
use super::pattern::Pattern;
use nalgebra::{Matrix3, Vector3};
use std::sync::Mutex;

/// Fronts above this many unknowns are worth a task of their own.
const TASK_UNKNOWNS: usize = 400;

/// The matrix is not positive definite at this node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the stiffness matrix is not positive definite at node {node}")]
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
    /// The caller wanted no more.
    #[error("stopped on request")]
    Stopped,
}

/// Asked now and then whether to stop.
pub type Stop<'s> = dyn Fn() -> bool + Sync + 's;

/// What of the factor does not depend on the values.
#[derive(Debug, Clone)]
pub struct Symbolic {
    nodes: usize,
    fronts: Vec<Front>,
}

#[derive(Debug, Clone)]
struct Front {
    nodes: Vec<u32>,
    border: Vec<u32>,
    children: Vec<usize>,
    /// For each child, where its border lies among this front's rows.
    child_runs: Vec<Vec<Run>>,
    /// Slot, local row and local column of each block that enters here, and whether it enters transposed.
    entries: Vec<(u32, u32, u32, bool)>,
    /// Unknowns of this front and all below it.
    weight: usize,
}

impl Front {
    fn unknowns(&self) -> usize {
        3 * (self.nodes.len() + self.border.len())
    }
}

/// A factor: for each front the columns of its own nodes, `unknowns` rows each.
#[derive(Debug, Default)]
pub struct Factor {
    columns: Vec<Vec<f64>>,
    spare: Spare,
}

/// Memory of borders, kept from front to front and from one factorization to the next: fresh pages cost more than sums.
#[derive(Debug, Default)]
struct Spare(Mutex<Vec<Vec<f64>>>);

impl Spare {
    /// The smallest that holds `size` numbers, or a new one: were a leaf's to grow for the root, all would in the end.
    fn take(&self, size: usize) -> Vec<f64> {
        let Ok(mut spare) = self.0.lock() else { return Vec::new() };
        let fits = (0..spare.len()).filter(|&k| spare[k].capacity() >= size);
        let best = fits.min_by_key(|&k| spare[k].capacity());
        best.map_or_else(|| Vec::with_capacity(size), |k| spare.swap_remove(k))
    }

    fn give(&self, border: Vec<f64>) {
        if let Ok(mut s) = self.0.lock() {
            s.push(border);
        }
    }
}

impl Symbolic {
    /// Orders and analyses `pattern`; `layout` holds a place for each node, best where the sheet lies flat.
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
        Self { nodes: pattern.nodes(), fronts }
    }

    /// Numbers that the factor holds.
    pub fn factor_len(&self) -> usize {
        self.fronts.iter().map(|f| 3 * f.nodes.len() * f.unknowns()).sum()
    }

    /// Multiplications of one factorization.
    pub fn work(&self) -> f64 {
        let front = |f: &Front| {
            let (own, m) = (3.0 * f.nodes.len() as f64, f.unknowns() as f64);
            own * (m - own) * m * 0.5 + own * own * own / 6.0
        };
        self.fronts.iter().map(front).sum()
    }

    /// Factors the matrix of these block values into the memory of `factor`. `stop` is asked before every front.
    ///
    /// # Errors
    /// [`Halt`]: the matrix is not positive definite, or `stop` said so.
    pub fn factor(&self, values: &[Matrix3<f64>], factor: &mut Factor, stop: &Stop) -> Result<(), Halt> {
        factor.columns.resize(self.fronts.len(), Vec::new());
        match self.fronts.len().checked_sub(1) {
            Some(root) => {
                let border = self.eliminate(root, values, &mut factor.columns, &factor.spare, stop)?;
                factor.spare.give(border);
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Factors the front `k` and all below it, whose columns are the last of `columns`: what it leaves to its parent.
    fn eliminate(
        &self,
        k: usize,
        values: &[Matrix3<f64>],
        columns: &mut [Vec<f64>],
        spare: &Spare,
        stop: &Stop,
    ) -> Result<Vec<f64>, Halt> {
        let front = &self.fronts[k];
        let Some((mine, below)) = columns.split_last_mut() else { return Ok(Vec::new()) };
        let below = self.eliminate_children(front, values, below, spare, stop)?;
        if stop() {
            return Err(Halt::Stopped);
        }
        let border = spare.take(9 * front.border.len() * front.border.len());
        let mut dense = Dense::zeros(mine, border, front.unknowns(), 3 * front.nodes.len());
        for &(slot, row, column, flipped) in &front.entries {
            dense.put(row as usize, column as usize, &values[slot as usize], flipped);
        }
        for (update, runs) in below.into_iter().zip(&front.child_runs) {
            dense.extend_add(&update, runs);
            spare.give(update);
        }
        dense.eliminate().map_err(|c| NotPositive { node: front.nodes[c / 3] })?;
        Ok(dense.border)
    }

    fn eliminate_children(
        &self,
        front: &Front,
        values: &[Matrix3<f64>],
        columns: &mut [Vec<f64>],
        spare: &Spare,
        stop: &Stop,
    ) -> Result<Vec<Vec<f64>>, Halt> {
        match front.children[..] {
            [] => Ok(vec![]),
            [a] => Ok(vec![self.eliminate(a, values, columns, spare, stop)?]),
            [a, b, ..] => {
                // Children come one after the other, each after all below it.
                let (left, right) = columns.split_at_mut(columns.len() - (b - a));
                let mut left = || self.eliminate(a, values, left, spare, stop);
                let mut right = || self.eliminate(b, values, right, spare, stop);
                let (a, b) = if self.fronts[a].weight.min(self.fronts[b].weight) > TASK_UNKNOWNS {
                    rayon::join(left, right)
                } else {
                    (left(), right())
                };
                Ok(vec![a?, b?])
            }
        }
    }

    /// Solves in place: `x` is the right side, then the solution.
    pub fn solve(&self, factor: &Factor, x: &mut [Vector3<f64>]) {
        debug_assert_eq!(x.len(), self.nodes);
        let mut local = Vec::new();
        for (front, columns) in self.fronts.iter().zip(&factor.columns) {
            gather(front, x, &mut local);
            forward(columns, &mut local, 3 * front.nodes.len());
            scatter(front.nodes.iter().chain(&front.border), x, &local);
        }
        for (front, columns) in self.fronts.iter().zip(&factor.columns).rev() {
            gather(front, x, &mut local);
            backward(columns, &mut local, 3 * front.nodes.len());
            scatter(front.nodes.iter(), x, &local);
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
    let child_runs = part.children.iter().map(|&c| runs(fronts[c].border.iter().map(|&i| row(i)))).collect();
    let mut entries: Vec<_> = part.nodes.iter().map(|&i| (i, row(i), row(i), false)).collect();
    // Kept are blocks of row i and column j with i < j; the front wants the later node as the row.
    entries.extend(
        later.iter().map(|&(first, last, slot, last_is_row)| (slot, row(last), row(first), !last_is_row)),
    );
    let weight = 3 * part.nodes.len() + part.children.iter().map(|&c| fronts[c].weight).sum::<usize>();
    Front { nodes: part.nodes, border, children: part.children, child_runs, entries, weight }
}

/// Rows that follow one another, taken together.
fn runs(rows: impl Iterator<Item = u32>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (child, parent) in rows.enumerate() {
        match runs.last_mut() {
            Some(run) if run.parent + run.nodes == parent => run.nodes += 1,
            _ => runs.push(Run { child: child as u32, parent, nodes: 1 }),
        }
    }
    runs
}

fn gather(front: &Front, x: &[Vector3<f64>], local: &mut Vec<f64>) {
    local.clear();
    local.extend(front.nodes.iter().chain(&front.border).flat_map(|&i| x[i as usize].iter().copied()));
}

fn scatter<'a>(nodes: impl Iterator<Item = &'a u32>, x: &mut [Vector3<f64>], local: &[f64]) {
    for (&i, v) in nodes.zip(local.as_chunks::<3>().0) {
        x[i as usize] = Vector3::from(*v);
    }
}

fn forward(columns: &[f64], local: &mut [f64], own: usize) {
    let m = local.len();
    for c in 0..own {
        let column = &columns[c * m..(c + 1) * m];
        let v = local[c] / column[c];
        local[c] = v;
        local[c + 1..].iter_mut().zip(&column[c + 1..]).for_each(|(x, l)| *x -= v * l);
    }
}

fn backward(columns: &[f64], local: &mut [f64], own: usize) {
    let m = local.len();
    for c in (0..own).rev() {
        let column = &columns[c * m..(c + 1) * m];
        let sum = dot(&column[c + 1..], &local[c + 1..]);
        local[c] = (local[c] - sum) / column[c];
    }
}

/// A dot product in eight running sums, which the compiler can keep side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a8, a1), (b8, b1)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a8.iter().zip(b8) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + a1.iter().zip(b1).map(|(a, b)| a * b).sum::<f64>()
}

#[cfg(test)]
mod tests;
