//! Step limiting by continuous collision detection: how much of its move each node may make so that
//! no pair collides.
//!
//! Method: the moves of the nodes of colliding pairs are shortened to a share of the time to
//! impact. Since this changes the relative motion of neighbours, all pairs of these nodes are
//! tested again, until no pair collides. If some still do after a few rounds, the whole step is
//! shortened. So every pair keeps a share of its distance. Cost: one collision test per pair, and
//! fewer in each later round. Limit: pairs that were found for the original moves may miss
//! collisions of shortened ones: see [`limit_with_search`].

use rayon::prelude::*;
use toile_geometry::pair::Pair;
use toile_geometry::{Vec3, ccd::impact};

/// Rounds before the whole step is shortened.
const ROUNDS: usize = 8;

/// Searches of pairs for shortened moves, before the whole step is shortened.
const SEARCHES: usize = 8;

/// Share of the time to impact that is used.
const SAFETY: f64 = 0.9;

/// Shortens `moves` so that none of `pairs` collides; returns how many would have.
pub fn limit_step(x: &[Vec3], moves: &mut [Vec3], pairs: &[Pair]) -> usize {
    limit_or_stop(x, moves, pairs).0
}

/// The same; also returns the share to which the whole step was shortened.
fn limit_or_stop(x: &[Vec3], moves: &mut [Vec3], pairs: &[Pair]) -> (usize, f64) {
    let mut suspects: Vec<Pair> = pairs.to_vec();
    let mut first = 0;
    for round in 0..ROUNDS {
        let hits = impacts(x, moves, &suspects);
        if round == 0 {
            first = hits.len();
        }
        if hits.is_empty() {
            return (first, 1.0);
        }
        let mut share = vec![1.0f64; x.len()];
        for (pair, time) in &hits {
            for i in pair.nodes {
                share[i as usize] = share[i as usize].min(SAFETY * time);
            }
        }
        moves.iter_mut().zip(&share).filter(|(_, s)| **s < 1.0).for_each(|(m, s)| *m *= *s);
        suspects =
            pairs.iter().filter(|p| p.nodes.iter().any(|&i| share[i as usize] < 1.0)).copied().collect();
    }
    (first, stop(x, moves, pairs).1)
}

/// Shortens `moves` until none of the pairs that `seek` finds for them collides, of those that
/// count. Returns the pairs found last, and the share to which the whole step was shortened; below
/// 1, cloth without contact was held back as well.
///
/// Cloth that falls together does not collide until a part of it is held back. So pairs are sought
/// again for the shortened moves, unless `seek` returns `None`: the known pairs are then valid for
/// all shorter moves.
pub fn limit_with_search(
    x: &[Vec3],
    moves: &mut [Vec3],
    mut pairs: Vec<Pair>,
    counts: impl Fn(&Pair) -> bool,
    seek: impl Fn(&[Vec3]) -> Option<Vec<Pair>>,
) -> (Vec<Pair>, f64) {
    let mut whole = 1.0;
    for search in 0..=SEARCHES {
        let strict: Vec<Pair> = pairs.iter().filter(|p| counts(p)).copied().collect();
        let (hits, share) =
            if search < SEARCHES { limit_or_stop(x, moves, &strict) } else { stop(x, moves, &strict) };
        whole *= share;
        if hits == 0 {
            break;
        }
        match seek(moves) {
            Some(found) => pairs = found,
            None => break,
        }
    }
    (pairs, whole)
}

/// Shortens the whole step to before the first collision of `pairs`; returns how many would have
/// collided, and the share that is left.
fn stop(x: &[Vec3], moves: &mut [Vec3], pairs: &[Pair]) -> (usize, f64) {
    // A step that has no collision until some time has none if it is scaled to end there.
    let hits = impacts(x, moves, pairs);
    let least = hits.iter().map(|(_, t)| *t).fold(1.0, f64::min);
    let share = if least < 1.0 { SAFETY * least } else { 1.0 };
    if share < 1.0 {
        moves.iter_mut().for_each(|m| *m *= share);
    }
    (hits.len(), share)
}

/// The pairs that would collide.
pub fn colliding(x: &[Vec3], moves: &[Vec3], pairs: &[Pair]) -> Vec<Pair> {
    impacts(x, moves, pairs).into_iter().map(|(p, _)| p).collect()
}

/// The pairs that would collide, and their times of impact.
fn impacts(x: &[Vec3], moves: &[Vec3], pairs: &[Pair]) -> Vec<(Pair, f64)> {
    let hit = |p: &Pair| impact(p, &p.at(x), &p.at(moves)).map(|t| (*p, t));
    pairs.par_iter().with_min_len(256).filter_map(hit).collect()
}
