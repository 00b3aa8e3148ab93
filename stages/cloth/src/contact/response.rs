//! Momentum-conserving contact response: cloth that would collide with cloth takes it along.
//!
//! Method: an inelastic impulse (Provot 1997; Bridson, Fedkiw, Anderson 2002). The closest points
//! of a pair that would collide lose their relative motion towards each other, with momentum kept;
//! the rest of the moves stays. If the moves were shortened instead, the cloth around would move
//! on, stretch, and press the pair harder together, and two layers a micrometre apart would never
//! separate again. Cost: one collision test per pair and round.
//!
//! Limit: pairs may still collide afterwards, so the caller must also limit the step (see
//! [`super::step_limit`]).

use super::step_limit::colliding;
use toile_geometry::{Vec3, pair::Pair};

/// Rounds in which pairs around changed moves respond, too.
const ROUNDS: usize = 4;

/// Changes the `moves` of nodes that are not `held`, where the `colliding_pairs` would collide;
/// returns which moves have changed.
pub fn respond(
    x: &[Vec3],
    moves: &mut [Vec3],
    pairs: &[Pair],
    mut colliding_pairs: Vec<Pair>,
    held: &[bool],
) -> Vec<bool> {
    let mut changed = vec![false; x.len()];
    for _ in 0..ROUNDS {
        let mut touched = vec![false; x.len()];
        colliding_pairs.iter().for_each(|p| push(p, x, moves, held, &mut touched));
        let about = |p: &&Pair| p.nodes.iter().any(|&i| touched[i as usize]);
        let suspects: Vec<Pair> = pairs.iter().filter(about).copied().collect();
        changed.iter_mut().zip(&touched).for_each(|(p, t)| *p |= t);
        colliding_pairs = colliding(x, moves, &suspects);
        if colliding_pairs.is_empty() {
            break;
        }
    }
    changed
}

/// Removes the relative motion of the closest points of a pair towards each other.
fn push(pair: &Pair, x: &[Vec3], moves: &mut [Vec3], held: &[bool], touched: &mut [bool]) {
    let c = pair.closest(x);
    let normal = c.between / c.distance;
    let weights: [f64; 4] = std::array::from_fn(|k| match held[pair.nodes[k] as usize] {
        true => 0.0,
        false => c.weights[k],
    });
    let way: Vec3 = pair.at(moves).iter().zip(&c.weights).map(|(m, w)| m * *w).sum();
    let (apart, sum) = (way.dot(&normal), weights.iter().map(|w| w * w).sum::<f64>());
    if c.distance == 0.0 || apart >= 0.0 || sum == 0.0 {
        return;
    }
    for (i, w) in pair.nodes.iter().zip(weights).filter(|(_, w)| *w != 0.0) {
        moves[*i as usize] -= normal * (apart * w / sum);
        touched[*i as usize] = true;
    }
}

#[cfg(test)]
mod tests;
