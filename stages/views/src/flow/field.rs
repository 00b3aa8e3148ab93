//! A displacement for each block of a picture.

/// Pixels: whole ones while blocks are searched for, quarters in what is found.
pub type Vector = [i32; 2];

/// Blocks row by row; none where nothing is seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlowField {
    /// Blocks across.
    pub columns: usize,
    /// Blocks down.
    pub rows: usize,
    /// Row by row.
    pub vectors: Vec<Option<Vector>>,
}

impl FlowField {
    /// Known vectors of a block and of the eight around it.
    pub(crate) fn near(&self, column: usize, row: usize) -> impl Iterator<Item = Vector> + '_ {
        let columns = column.saturating_sub(1)..(column + 2).min(self.columns);
        (row.saturating_sub(1)..(row + 2).min(self.rows))
            .flat_map(move |r| columns.clone().filter_map(move |c| self.vectors[r * self.columns + c]))
    }

    /// Every known vector as the median, by component, of the known ones near it.
    pub(super) fn calmed(&self) -> FlowField {
        let calm = |k: usize| {
            self.vectors[k]?;
            let near: Vec<Vector> = self.near(k % self.columns, k / self.columns).collect();
            Some([0, 1].map(|c| median(near.iter().map(|v| v[c]).collect())))
        };
        FlowField { vectors: (0..self.vectors.len()).map(calm).collect(), ..*self }
    }

    /// The vectors carried on, ring by ring, to the blocks that have none; zero where no block has
    /// one.
    pub fn whole(mut self) -> Vec<Vector> {
        for _ in 0..self.columns.max(self.rows) {
            let ring =
                |k: usize| self.vectors[k].or_else(|| mean(self.near(k % self.columns, k / self.columns)));
            self.vectors = (0..self.vectors.len()).map(ring).collect();
            if self.vectors.iter().all(Option::is_some) {
                break;
            }
        }
        self.vectors.into_iter().map(Option::unwrap_or_default).collect()
    }
}

/// The lower of two in the middle.
fn median(mut values: Vec<i32>) -> i32 {
    values.sort_unstable();
    values.get((values.len().max(1) - 1) / 2).copied().unwrap_or_default()
}

fn mean(vectors: impl Iterator<Item = Vector>) -> Option<Vector> {
    let (sum, n) = vectors.fold(([0, 0], 0), |([x, y], n), v| ([x + v[0], y + v[1]], n + 1));
    (n > 0).then(|| sum.map(|s: i32| s.div_euclid(n)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(vectors: [Option<Vector>; 6]) -> FlowField {
        FlowField { columns: 3, rows: 2, vectors: vectors.to_vec() }
    }

    #[test]
    fn one_vector_that_differs_is_calmed_and_none_is_added() {
        let (a, b) = (Some([4, 1]), Some([90, -70]));
        assert_eq!(field([a, a, None, a, b, a]).calmed(), field([a, a, None, a, a, a]));
    }

    #[test]
    fn vectors_are_carried_on_and_an_empty_field_is_zero() {
        assert_eq!(field([Some([8, 2]), None, None, None, None, None]).whole(), [[8, 2]; 6]);
        assert_eq!(field([None; 6]).whole(), [[0, 0]; 6]);
        assert_eq!(FlowField { columns: 0, rows: 0, vectors: Vec::new() }.whole(), [[0, 0]; 0]);
    }
}
