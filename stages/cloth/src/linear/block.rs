//! A symmetric sparse matrix of 3 x 3 blocks; only blocks on and above the diagonal are kept, row by row.
//!
//! Every diagonal block exists. The pattern is made once from the couplings of the energies; adding a block is a search among
//! the few entries of its row. Products run through the rows in order, so they are the same bits every time.

use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// The matrix. Block (i, j) with i <= j stands for itself and, transposed, for (j, i).
#[derive(Debug, Clone)]
pub struct BlockMatrix {
    starts: Vec<u32>,
    columns: Vec<u32>,
    blocks: Vec<Matrix3<f64>>,
}

impl BlockMatrix {
    /// An all-zero matrix of `n` block rows with the given groups of mutually coupled rows.
    #[must_use]
    pub fn with_couplings(n: usize, visit_groups: impl FnOnce(&mut dyn FnMut(&[u32]))) -> Self {
        let mut pairs: Vec<(u32, u32)> = (0..n as u32).map(|i| (i, i)).collect();
        visit_groups(&mut |group: &[u32]| {
            for (k, &a) in group.iter().enumerate() {
                pairs.extend(group[k + 1..].iter().map(|&b| (a.min(b), a.max(b))));
            }
        });
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0; n + 1];
        for &(i, _) in &pairs {
            starts[i as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let blocks = vec![Matrix3::zeros(); pairs.len()];
        Self { starts, columns: pairs.into_iter().map(|p| p.1).collect(), blocks }
    }

    /// Number of block rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of stored blocks.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Whether another matrix has blocks at just the same places.
    #[must_use]
    pub fn same_pattern(&self, other: &Self) -> bool {
        self.starts == other.starts && self.columns == other.columns
    }

    /// An all-zero matrix with the same pattern.
    #[must_use]
    pub fn zeroed(&self) -> Self {
        let mut copy = self.clone();
        copy.clear();
        copy
    }

    /// Adds `scale` times a matrix whose pattern this one contains.
    pub fn add_matrix(&mut self, scale: f64, other: &Self) {
        for i in 0..other.rows() {
            for (j, block) in other.row(i) {
                self.add(i as u32, j as u32, &(block * scale));
            }
        }
    }

    /// Hands each pair of coupled rows to `visit`.
    pub fn couplings(&self, visit: &mut dyn FnMut(&[u32])) {
        for i in 0..self.rows() {
            for (j, _) in self.row(i).skip(1) {
                visit(&[i as u32, j as u32]);
            }
        }
    }

    /// Columns and blocks of row `i`, from the diagonal on, columns ascending.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &Matrix3<f64>)> {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().map(|&j| j as usize).zip(&self.blocks[range])
    }

    /// Sets every block to zero, keeping the pattern.
    pub fn clear(&mut self) {
        self.blocks.fill(Matrix3::zeros());
    }

    /// Adds `block` at (i, j), and so its transpose at (j, i). Does nothing for a pair that the pattern lacks.
    pub fn add(&mut self, i: u32, j: u32, block: &Matrix3<f64>) {
        if i <= j {
            if let Some(slot) = self.slot(i, j) {
                self.blocks[slot] += block;
            }
        } else if let Some(slot) = self.slot(j, i) {
            self.blocks[slot] += block.transpose();
        }
    }

    /// Adds an element's blocks `[a][b]`, `b >= a`, at its vertices.
    pub fn add_element<const N: usize>(&mut self, vertices: &[u32; N], blocks: &[[Matrix3<f64>; N]; N]) {
        for a in 0..N {
            for b in a..N {
                self.add(vertices[a], vertices[b], &blocks[a][b]);
            }
        }
    }

    /// Adds `scale[i]` times the identity to diagonal block i.
    pub fn add_diagonal(&mut self, scale: impl IntoIterator<Item = f64>) {
        for (i, s) in scale.into_iter().enumerate() {
            self.blocks[self.starts[i] as usize] += Matrix3::identity() * s;
        }
    }

    /// The diagonal block of row i.
    #[must_use]
    pub fn diagonal(&self, i: usize) -> &Matrix3<f64> {
        &self.blocks[self.starts[i] as usize]
    }

    /// Cuts the given rows and columns out of the system: zero off the diagonal, identity on it.
    pub fn fix(&mut self, fixed: &[bool]) {
        for i in 0..self.rows() {
            for slot in self.starts[i] as usize..self.starts[i + 1] as usize {
                let j = self.columns[slot] as usize;
                if fixed[i] || fixed[j] {
                    self.blocks[slot] = if i == j { Matrix3::identity() } else { Matrix3::zeros() };
                }
            }
        }
    }

    /// The matrix times `x`.
    #[must_use]
    pub fn times(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut y = vec![Vec3::zeros(); x.len()];
        self.times_into(x, &mut y);
        y
    }

    /// The matrix times `x`, written to `y`.
    pub fn times_into(&self, x: &[Vec3], y: &mut [Vec3]) {
        y.fill(Vec3::zeros());
        for i in 0..self.rows() {
            let (mut sum, xi) = (Vec3::zeros(), x[i]);
            for (j, block) in self.row(i) {
                sum += block * x[j];
                if j != i {
                    y[j] += block.tr_mul(&xi);
                }
            }
            y[i] += sum;
        }
    }

    fn slot(&self, i: u32, j: u32) -> Option<usize> {
        let (start, end) = (self.starts[i as usize] as usize, self.starts[i as usize + 1] as usize);
        self.columns[start..end].binary_search(&j).ok().map(|k| start + k)
    }
}
