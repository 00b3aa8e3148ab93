//! A symmetric sparse matrix of 3 x 3 blocks: a [`Pattern`] and its values.
//!
//! Every diagonal block exists; of the others only those above the diagonal are kept. Products run
//! through the rows in order, so they are the same bits every time.

use crate::linear::{Pattern, add_at};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// The matrix. Block (i, j) with i <= j stands for itself and, transposed, for (j, i).
#[derive(Debug, Clone)]
pub struct BlockMatrix {
    pattern: Pattern,
    values: Vec<Matrix3<f64>>,
}

impl BlockMatrix {
    /// An all-zero matrix of `n` block rows with the given groups of mutually coupled rows.
    #[must_use]
    pub fn with_couplings(n: usize, visit_groups: impl FnOnce(&mut dyn FnMut(&[u32]))) -> Self {
        let pattern = Pattern::new(n, visit_groups);
        let values = vec![Matrix3::zeros(); pattern.blocks()];
        Self { pattern, values }
    }

    /// Which blocks there are.
    #[must_use]
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// The blocks, by their slots in the pattern.
    #[must_use]
    pub fn values(&self) -> &[Matrix3<f64>] {
        &self.values
    }

    /// The blocks, to be written.
    pub fn values_mut(&mut self) -> &mut [Matrix3<f64>] {
        &mut self.values
    }

    /// Number of block rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.pattern.nodes()
    }

    /// Number of stored blocks.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.values.len()
    }

    /// Whether another matrix has blocks at just the same places.
    #[must_use]
    pub fn same_pattern(&self, other: &Self) -> bool {
        self.pattern == other.pattern
    }

    /// An all-zero matrix with the same pattern.
    #[must_use]
    pub fn zeroed(&self) -> Self {
        Self { pattern: self.pattern.clone(), values: vec![Matrix3::zeros(); self.values.len()] }
    }

    /// Columns and blocks of row `i`, from the diagonal on, columns ascending.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &Matrix3<f64>)> {
        let above = self.pattern.row(i).map(|(j, slot)| (j as usize, &self.values[slot]));
        std::iter::once((i, &self.values[i])).chain(above)
    }

    /// Sets every block to zero, keeping the pattern.
    pub fn clear(&mut self) {
        self.values.fill(Matrix3::zeros());
    }

    /// Adds `block` at (i, j), and so its transpose at (j, i). Does nothing for a pair that the
    /// pattern lacks.
    pub fn add(&mut self, i: u32, j: u32, block: &Matrix3<f64>) {
        if let Some(slot) = self.pattern.slot(i, j) {
            add_at(&mut self.values, slot, block);
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
        self.values.iter_mut().zip(scale).for_each(|(v, s)| *v += Matrix3::identity() * s);
    }

    /// The diagonal block of row i.
    #[must_use]
    pub fn diagonal(&self, i: usize) -> &Matrix3<f64> {
        &self.values[i]
    }

    /// Cuts the given rows and columns out of the system: zero off the diagonal, identity on it.
    pub fn fix(&mut self, fixed: &[bool]) {
        for (value, _) in self.values.iter_mut().zip(fixed).filter(|(_, f)| **f) {
            *value = Matrix3::identity();
        }
        for (i, j, slot) in self.pattern.upper() {
            if fixed[i as usize] || fixed[j as usize] {
                self.values[slot as usize] = Matrix3::zeros();
            }
        }
    }

    /// For each row a bound of the sum of the norms of its blocks: that of the greatest absolute
    /// row sum of each block and of its transpose.
    #[must_use]
    pub fn row_sums(&self) -> Vec<f64> {
        let norm = |b: &Matrix3<f64>| {
            let rows = b.abs().column_sum().max();
            (rows * b.abs().row_sum().max()).sqrt()
        };
        let mut sums: Vec<f64> = self.values.iter().take(self.rows()).map(norm).collect();
        for (i, j, slot) in self.pattern.upper() {
            let size = norm(&self.values[slot as usize]);
            sums[i as usize] += size;
            sums[j as usize] += size;
        }
        sums
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
        self.pattern.multiply_add(&self.values, x, y);
    }
}
