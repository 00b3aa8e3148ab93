//! Time to a fixed error: of each solver's time steps the one that keeps the error soonest.

use super::cell::{Cell, Outcome};
use super::scheme::Scheme;
use serde::Serialize;

/// The quickest cell of one solver on one sheet that keeps the error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Quickest {
    /// The solver.
    pub scheme: Scheme,
    /// Edges along the side.
    pub along: usize,
    /// Stretch stiffness, N/m.
    pub stiffness: f64,
    /// What it is; none where no cell that ran keeps the error.
    pub best: Option<Best>,
}

/// What the quickest cell is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Best {
    /// Its time step, s; none for a solver without.
    pub dt: Option<f64>,
    /// Its error, in lengths.
    pub error: f64,
    /// Its processor time, s.
    pub seconds: f64,
}

/// For every sheet and solver among the cells, in their order.
#[must_use]
pub fn quickest(cells: &[Cell], keep: f64) -> Vec<Quickest> {
    let same = |a: &Cell, b: &Cell| {
        a.scheme == b.scheme && a.along == b.along && a.stiffness.to_bits() == b.stiffness.to_bits()
    };
    cells.chunk_by(same).map(|row| of(row, keep)).collect()
}

fn of(row: &[Cell], keep: f64) -> Quickest {
    let keeps = |c: &&Cell| c.outcome == Outcome::Converges && c.error.is_some_and(|e| e <= keep);
    let best = row.iter().filter(keeps).min_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let best = best.and_then(|c| Some(Best { dt: c.dt, error: c.error?, seconds: c.seconds }));
    Quickest { scheme: row[0].scheme, along: row[0].along, stiffness: row[0].stiffness, best }
}
