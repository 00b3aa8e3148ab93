//! Pieces that show their wrong side: found across seams.
//!
//! Two pieces that face the same way walk a common edge of the garment in opposite directions. From
//! the first piece of each garment part over the seams every piece is compared with its neighbour
//! by most of their common edges; where that marks more than half of the part's triangles, the
//! others are marked instead.

use crate::surface::{FREE, sorted_edges};
use std::collections::BTreeMap;

/// For each component whether it must be turned; its triangles must agree with each other.
pub(super) fn inside_out(triangles: &[[u32; 3]], opposite: &[u32], component: &[u32]) -> Vec<bool> {
    let count = component.iter().max().map_or(0, |&c| c as usize + 1);
    let mut sizes = vec![0usize; count];
    component.iter().for_each(|&c| sizes[c as usize] += 1);
    let votes = votes(triangles, opposite, component);
    let mut turned = vec![false; count];
    let mut seen = vec![false; count];
    for seed in 0..count {
        if seen[seed] {
            continue;
        }
        let part = compare(seed, &votes, &mut seen, &mut turned);
        let whole: usize = part.iter().map(|&c| sizes[c]).sum();
        let marked: usize = part.iter().filter(|&&c| turned[c]).map(|&c| sizes[c]).sum();
        if 2 * marked > whole {
            part.iter().for_each(|&c| turned[c] = !turned[c]);
        }
    }
    turned
}

/// For each pair of components that share free edges: how many more are walked in opposite
/// directions than in the same.
fn votes(triangles: &[[u32; 3]], opposite: &[u32], component: &[u32]) -> BTreeMap<(usize, usize), i64> {
    let mut votes = BTreeMap::new();
    let edges = sorted_edges(triangles);
    for group in edges.chunk_by(|a, b| a.0 == b.0) {
        let [(_, g), (_, h)] = *group else { continue };
        let of = |h: u32| component[h as usize / 3] as usize;
        if opposite[g as usize] != FREE || opposite[h as usize] != FREE || of(g) == of(h) {
            continue;
        }
        let start = |h: u32| triangles[h as usize / 3][h as usize % 3];
        let vote = if start(g) == start(h) { -1 } else { 1 };
        *votes.entry((of(g), of(h))).or_insert(0) += vote;
        *votes.entry((of(h), of(g))).or_insert(0) += vote;
    }
    votes
}

/// Finds all that is connected with `seed` by votes, marks what faces the other way as turned, and
/// returns all of it.
fn compare(
    seed: usize,
    votes: &BTreeMap<(usize, usize), i64>,
    seen: &mut [bool],
    turned: &mut [bool],
) -> Vec<usize> {
    let mut part = vec![seed];
    seen[seed] = true;
    let mut next = 0;
    while let Some(&c) = part.get(next) {
        next += 1;
        for (&(_, other), &vote) in votes.range((c, 0)..(c + 1, 0)) {
            if !seen[other] && vote != 0 {
                seen[other] = true;
                turned[other] = turned[c] != (vote < 0);
                part.push(other);
            }
        }
    }
    part
}
