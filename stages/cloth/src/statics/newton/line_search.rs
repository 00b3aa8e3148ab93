//! Non-monotone line search: how much of a step is made.
//!
//! Method: the step is halved until the potential is below the highest of the last few, by a share
//! of the slope (Grippo, Lampariello, Lucidi 1986). Cost: one evaluation of the energy a trial.
//! Limit: after [`MOST_HALVINGS`] halvings the rest of the step is made as it is.

use crate::statics::forces::system::{Evaluation, System};
use crate::statics::newton::state::greatest;
use toile_geometry::Vec3;

/// Halvings of a step before it is made as it is.
const MOST_HALVINGS: u32 = 6;

/// Moves shorter than this change the potential by less than its rounding, m.
pub(crate) const ROUNDING: f64 = 1e-10;

/// Share of the slope by which the potential must fall (Armijo's rule).
const LEAST_FALL: f64 = 1e-4;

/// Steps whose highest potential a new one must be below. More steps let the cloth pass through
/// higher potentials to a lower one.
const MEMORY: usize = 8;

/// The accepted share of a step.
pub(crate) struct Accepted {
    /// The share of the step that is made.
    pub share: f64,
    /// The energy at its end, if it was evaluated.
    pub end: Option<Evaluation>,
}

/// Shortens `moves` until the potential falls below the highest of the last ones. `start` is the
/// potential at the beginning of the step.
pub(crate) fn descend(
    system: &System<'_>,
    x: &[Vec3],
    g: &[Vec3],
    moves: &mut [Vec3],
    start: f64,
    history: &mut Vec<f64>,
) -> Accepted {
    if greatest(moves) < ROUNDING {
        return Accepted { share: 1.0, end: None };
    }
    let slope: f64 = g.iter().zip(moves.iter()).map(|(g, d)| g.dot(d)).sum();
    history.push(start);
    if history.len() > MEMORY {
        history.remove(0);
    }
    // Rounding of the sum hides changes smaller than this.
    let highest = history.iter().copied().fold(start, f64::max) + 1e-13 * start.abs();
    let mut share = 1.0;
    for _ in 0..MOST_HALVINGS {
        let trial: Vec<Vec3> = x.iter().zip(moves.iter()).map(|(p, d)| p + d).collect();
        let end = system.evaluate(&trial);
        if end.energy <= highest + LEAST_FALL * share * slope.min(0.0) {
            return Accepted { share, end: Some(end) };
        }
        share *= 0.5;
        shorten(moves, 0.5);
    }
    Accepted { share, end: None }
}

/// Shortens all moves alike.
pub(crate) fn shorten(moves: &mut [Vec3], share: f64) {
    if share < 1.0 {
        moves.iter_mut().for_each(|m| *m *= share);
    }
}
