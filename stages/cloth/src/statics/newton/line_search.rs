//! How much of a step is taken: the potential must fall below the highest of the last few (Grippo,
//! Lampariello, Lucidi 1986).

use crate::statics::forces::system::{Evaluation, System};
use crate::statics::newton::state::greatest;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Halvings of a step before it is taken as it is.
const MOST_HALVINGS: u32 = 6;

/// Moves shorter than this change the potential by less than its rounding, m.
pub(crate) const ROUNDING: f64 = 1e-10;

/// Share of the slope by which the potential must fall (Armijo's rule).
const LEAST_FALL: f64 = 1e-4;

/// Steps whose highest potential a new one is measured by. More lets the cloth pass through worse
/// states to better ones.
const MEMORY: usize = 8;

/// The way gone in a step.
pub(crate) struct Accepted {
    /// The share of the step that is left.
    pub share: f64,
    /// What was found at its end, if anybody looked.
    pub end: Option<Evaluation>,
}

/// Shortens the step until the potential falls below the highest of the last ones; it is `start`
/// where the step begins.
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
        let visit = system.evaluate(&trial);
        if visit.energy <= highest + LEAST_FALL * share * slope.min(0.0) {
            return Accepted { share, end: Some(visit) };
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
