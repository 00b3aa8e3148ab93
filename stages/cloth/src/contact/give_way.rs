//! Cloth that would meet cloth takes it along.
//!
//! A pair that would meet loses the way on which its closest points come together, shared among its
//! nodes like a blow that does not bounce (Provot 1997; Bridson, Fedkiw, Anderson 2002); all else
//! of the moves stays. Ending the moves of its nodes before they meet would hold these back while
//! the cloth around them goes on: it stretches, pulls them harder against each other, and two
//! layers a micrometre apart would never part again.
//!
//! What is left meets again, perhaps: whoever asks must still end moves before that (see
//! [`super::limit`]).

use super::limit::meet;
use nalgebra::Vector3;
use toile_geometry::pair::Pair;

type Vec3 = Vector3<f64>;

/// Rounds in which what was pushed pushes on.
const ROUNDS: usize = 4;

/// Changes `moves` of nodes that are not `held` where the pairs that are `meeting` would meet;
/// whose moves have changed.
pub fn give_way(
    x: &[Vec3],
    moves: &mut [Vec3],
    pairs: &[Pair],
    mut meeting: Vec<Pair>,
    held: &[bool],
) -> Vec<bool> {
    let mut pushed = vec![false; x.len()];
    for _ in 0..ROUNDS {
        let mut touched = vec![false; x.len()];
        meeting.iter().for_each(|p| push(p, x, moves, held, &mut touched));
        let about = |p: &&Pair| p.nodes.iter().any(|&i| touched[i as usize]);
        let suspects: Vec<Pair> = pairs.iter().filter(about).copied().collect();
        pushed.iter_mut().zip(&touched).for_each(|(p, t)| *p |= t);
        meeting = meet(x, moves, &suspects);
        if meeting.is_empty() {
            break;
        }
    }
    pushed
}

/// Takes away what the closest points of a pair come together.
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
