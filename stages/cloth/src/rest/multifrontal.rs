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
use super::pattern::Pattern;
use nalgebra::{DMatrixView, DMatrixViewMut, Dyn, Matrix3, Vector3};

/// Columns eliminated together: wide enough for fast products, narrow enough to stay in the cache.
const STRIP: usize = 48;

/// Fronts above this many unknowns are worth a task of their own.
const TASK_UNKNOWNS: usize = 120;

/// The matrix is not positive definite at this node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the stiffness matrix is not positive definite at node {node}")]
pub struct NotPositive {
    /// The node whose pivot failed.
    pub node: u32,
}

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
    child_rows: Vec<Vec<u32>>,
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
#[derive(Debug, Clone, Default)]
pub struct Factor {
    columns: Vec<Vec<f64>>,
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

    /// Factors the matrix of these block values.
    pub fn factor(&self, values: &[Matrix3<f64>]) -> Result<Factor, NotPositive> {
        let Some(root) = self.fronts.len().checked_sub(1) else {
            return Ok(Factor::default());
        };
        let (_, mut done) = self.eliminate(root, values)?;
        done.sort_unstable_by_key(|(k, _)| *k);
        Ok(Factor { columns: done.into_iter().map(|(_, c)| c).collect() })
    }

    /// Factors the front `k` and all below it: what it leaves to its parent, and the finished columns.
    fn eliminate(&self, k: usize, values: &[Matrix3<f64>]) -> Result<(Vec<f64>, Vec<Finished>), NotPositive> {
        let front = &self.fronts[k];
        let below = self.eliminate_children(front, values)?;
        let m = front.unknowns();
        let mut a = vec![0.0; m * m];
        for &(slot, row, column, flipped) in &front.entries {
            put(&mut a, m, row as usize, column as usize, &values[slot as usize], flipped);
        }
        let mut done = Vec::new();
        for ((update, finished), rows) in below.into_iter().zip(&front.child_rows) {
            extend_add(&mut a, m, &update, rows);
            done.extend(finished);
        }
        let own = 3 * front.nodes.len();
        partial_cholesky(&mut a, m, own).map_err(|c| NotPositive { node: front.nodes[c / 3] })?;
        let update = schur(&a, m, own);
        a.truncate(m * own);
        a.shrink_to_fit();
        done.push((k, a));
        Ok((update, done))
    }

    fn eliminate_children(&self, front: &Front, values: &[Matrix3<f64>]) -> Result<Vec<Below>, NotPositive> {
        match front.children[..] {
            [a, b] if self.fronts[a].weight.min(self.fronts[b].weight) > TASK_UNKNOWNS => {
                let (a, b) = rayon::join(|| self.eliminate(a, values), || self.eliminate(b, values));
                Ok(vec![a?, b?])
            }
            _ => front.children.iter().map(|&c| self.eliminate(c, values)).collect(),
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

type Finished = (usize, Vec<f64>);
type Below = (Vec<f64>, Vec<Finished>);

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
    let child_rows =
        part.children.iter().map(|&c| fronts[c].border.iter().map(|&i| row(i)).collect()).collect();
    let mut entries: Vec<_> = part.nodes.iter().map(|&i| (i, row(i), row(i), false)).collect();
    // Kept are blocks of row i and column j with i < j; the front wants the later node as the row.
    entries.extend(
        later.iter().map(|&(first, last, slot, last_is_row)| (slot, row(last), row(first), !last_is_row)),
    );
    let weight = 3 * part.nodes.len() + part.children.iter().map(|&c| fronts[c].weight).sum::<usize>();
    Front { nodes: part.nodes, border, children: part.children, child_rows, entries, weight }
}

fn put(a: &mut [f64], m: usize, row: usize, column: usize, block: &Matrix3<f64>, flipped: bool) {
    for c in 0..3 {
        for r in 0..3 {
            a[(3 * column + c) * m + 3 * row + r] += if flipped { block[(c, r)] } else { block[(r, c)] };
        }
    }
}

/// Adds a child's update, a dense lower triangle over its border, into the front.
fn extend_add(a: &mut [f64], m: usize, update: &[f64], rows: &[u32]) {
    let n = 3 * rows.len();
    for (cb, &column) in rows.iter().enumerate() {
        for c in 0..3 {
            let from = &update[(3 * cb + c) * n..][..n];
            let to = &mut a[(3 * column as usize + c) * m..][..m];
            for (rb, &row) in rows.iter().enumerate().skip(cb) {
                for r in 0..3 {
                    to[3 * row as usize + r] += from[3 * rb + r];
                }
            }
        }
    }
}

fn schur(a: &[f64], m: usize, own: usize) -> Vec<f64> {
    let n = m - own;
    let mut update = Vec::with_capacity(n * n);
    for c in own..m {
        update.extend_from_slice(&a[c * m + own..(c + 1) * m]);
    }
    update
}

/// Eliminates the first `own` columns of the lower triangle of `a`, `m` by `m`, by columns; the failed column on error.
fn partial_cholesky(a: &mut [f64], m: usize, own: usize) -> Result<(), usize> {
    let mut inverse = [0.0; STRIP * STRIP];
    let mut panel = Vec::new();
    for start in (0..own).step_by(STRIP) {
        let width = STRIP.min(own - start);
        let end = start + width;
        dense_cholesky(a, m, start, width)?;
        if end == m {
            break;
        }
        invert_lower(a, m, start, width, &mut inverse);
        let (strip, rest) = a[start * m..].split_at_mut(width * m);
        scale_panel(strip, m, end, width, &inverse, &mut panel);
        update_rest(strip, rest, m, end, width);
    }
    Ok(())
}

fn dense_cholesky(a: &mut [f64], m: usize, start: usize, width: usize) -> Result<(), usize> {
    for j in start..start + width {
        for k in start..j {
            let l = a[k * m + j];
            let (left, right) = a.split_at_mut(j * m);
            let (from, to) = (&left[k * m + j..k * m + start + width], &mut right[j..start + width]);
            to.iter_mut().zip(from).for_each(|(t, f)| *t -= l * f);
        }
        let pivot = a[j * m + j];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return Err(j);
        }
        let scale = 1.0 / pivot.sqrt();
        a[j * m + j..j * m + start + width].iter_mut().for_each(|v| *v *= scale);
    }
    Ok(())
}

/// The inverse of the lower triangle at `start`, by columns, `width` rows each.
fn invert_lower(a: &[f64], m: usize, start: usize, width: usize, inverse: &mut [f64]) {
    inverse[..width * width].fill(0.0);
    for c in 0..width {
        let column = &mut inverse[c * width..(c + 1) * width];
        column[c] = 1.0;
        for k in c..width {
            let l = &a[(start + k) * m + start..][..width];
            let v = column[k] / l[k];
            column[k] = v;
            for r in k + 1..width {
                column[r] -= v * l[r];
            }
        }
    }
}

/// Multiplies the strip's rows from `end` on by the inverse of its triangle, transposed.
fn scale_panel(strip: &mut [f64], m: usize, end: usize, width: usize, inverse: &[f64], panel: &mut Vec<f64>) {
    let rows = m - end;
    panel.clear();
    for c in 0..width {
        panel.extend_from_slice(&strip[c * m + end..(c + 1) * m]);
    }
    let from = DMatrixView::from_slice_with_strides_generic(panel, Dyn(rows), Dyn(width), Dyn(1), Dyn(rows));
    let by =
        DMatrixView::from_slice_with_strides_generic(inverse, Dyn(width), Dyn(width), Dyn(width), Dyn(1));
    let to = &mut strip[end..];
    let mut to = DMatrixViewMut::from_slice_with_strides_generic(to, Dyn(rows), Dyn(width), Dyn(1), Dyn(m));
    to.gemm(1.0, &from, &by, 0.0);
}

/// Takes the strip's product with itself from the columns after it, lower triangle only.
fn update_rest(strip: &[f64], rest: &mut [f64], m: usize, end: usize, width: usize) {
    for first in (end..m).step_by(STRIP) {
        let columns = STRIP.min(m - first);
        let rows = m - first;
        let left = DMatrixView::from_slice_with_strides_generic(
            &strip[first..],
            Dyn(rows),
            Dyn(width),
            Dyn(1),
            Dyn(m),
        );
        let right = DMatrixView::from_slice_with_strides_generic(
            &strip[first..],
            Dyn(width),
            Dyn(columns),
            Dyn(m),
            Dyn(1),
        );
        let to = &mut rest[(first - end) * m + first..];
        let mut to =
            DMatrixViewMut::from_slice_with_strides_generic(to, Dyn(rows), Dyn(columns), Dyn(1), Dyn(m));
        to.gemm(-1.0, &left, &right, 1.0);
    }
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
