//! Straight edges: chains that are nearly lines become lines.

use crate::newton::QuadraticTerm;
use nalgebra::Point2;

/// Weight of a point's distance from its place on the line: a hundred thousand times the stiffness
/// of a triangle.
const LINE_WEIGHT: f64 = 1e5;

/// Whether all points of an open chain of three or more lie within `share` of its end-to-end length
/// from the line between its ends.
#[must_use]
pub fn is_straight(chain: &[u32], flat: &[Point2<f64>], share: f64) -> bool {
    let [first, .., last] = chain else { return false };
    if chain.len() < 3 || first == last {
        return false;
    }
    let (a, b) = (flat[*first as usize], flat[*last as usize]);
    let along = b - a;
    let length = along.norm();
    let off = |&v: &u32| along.perp(&(flat[v as usize] - a)).abs() / length;
    length > 0.0 && chain.iter().all(|v| off(v) <= share * length)
}

/// The chains that are straight within `share`.
#[must_use]
pub fn straight_chains(chains: &[Vec<u32>], flat: &[Point2<f64>], share: f64) -> Vec<Vec<u32>> {
    chains.iter().filter(|c| is_straight(c, flat, share)).cloned().collect()
}

/// For each inner point of a chain its share of the chain's length.
fn proportions(chain: &[u32], flat: &[Point2<f64>]) -> Vec<f64> {
    let step = |w: &[u32]| (flat[w[1] as usize] - flat[w[0] as usize]).norm();
    let whole: f64 = chain.windows(2).map(step).sum();
    let mut gone = 0.0;
    let shares = chain.windows(2).map(|w| {
        gone += step(w);
        gone / whole
    });
    shares.take(chain.len().saturating_sub(2)).collect()
}

/// Terms that hold the inner points of straight chains on their lines, in proportion.
pub(super) fn line_terms(chains: &[Vec<u32>], flat: &[Point2<f64>]) -> Vec<QuadraticTerm> {
    let mut terms = Vec::new();
    for chain in chains {
        let (first, last) = (chain[0], chain[chain.len() - 1]);
        for (&v, t) in chain[1..].iter().zip(proportions(chain, flat)) {
            terms.push(QuadraticTerm::between(v, first, last, t, LINE_WEIGHT));
        }
    }
    terms
}

/// Puts what the terms hold exactly on the lines.
pub(super) fn snap(terms: &[QuadraticTerm], flat: &mut [Point2<f64>]) {
    for term in terms {
        let [v, from, to] = term.vertices.map(|v| v as usize);
        let t = -term.coefficients[2];
        flat[v] = flat[from] + (flat[to] - flat[from]) * t;
    }
}
