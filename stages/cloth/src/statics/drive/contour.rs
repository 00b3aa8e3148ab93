//! Intersection contour minimisation: resolves crossings of cloth with itself by geometry alone.
//!
//! Method: Volino, Magnenat-Thalmann 2006. Where an edge passes through a triangle, the contour
//! continues into the triangles beside the edge. Edge and triangle move against each other in the
//! direction in which the contour becomes shorter the fastest. A contour that ends at a hem is
//! moved out over it; a closed one shrinks to nothing. Between these moves stretched edges are
//! shortened to their rest lengths. The method need not know which side of the cloth is which.
//!
//! Cost: one search for crossings a sweep. Limits: contours whose length does not depend on the
//! direction of motion may stay, as where one tube passes straight through another, or where a hem
//! lies below cloth along its whole length.

use crate::mesh::{Edge, Sheet};
use std::collections::HashMap;
use toile_geometry::{Vec3, cloth_tree::ClothTree};

/// Greatest move of an edge in a sweep, as a share of the mean edge length.
const LONGEST_MOVE: f64 = 0.3;

/// Gradient of the contour length at which an edge makes 0.7 of the greatest move.
const HALF_GRADIENT: f64 = 0.3;

/// Sweeps without fewer crossings after which moves become shorter: long moves may alternate about
/// the last crossings.
const SWEEPS_UNTIL_SHORTER: usize = 20;

/// The share of the greatest move that is left then.
const SHORTER_MOVE: f64 = 0.3;

/// Sweeps at most.
const SWEEPS: usize = 400;

/// Sweeps within which the least number of crossings must fall.
const PATIENCE: usize = 60;

/// Gradient that pulls an edge back by its end that has gone through less, next to a gradient of 1
/// of the contour.
const PULL_BACK: f64 = 0.2;

/// Least sine of the angle between an edge and a triangle that the gradient is divided by: the move
/// of an edge nearly in the plane of the triangle would have no bound.
const LEAST_SINE: f64 = 0.1;

/// Rounds after a sweep in which stretched edges are shortened.
const SHORTENING_ROUNDS: usize = 4;

/// Share of its excess length by which an edge is shortened in a round.
const SHORTENING: f64 = 0.3;

/// Moves nodes until no crossings are left or their number no longer falls. `x` becomes the state
/// with the fewest crossings; returns how many these are.
pub(crate) fn uncross(sheet: &Sheet, tree: &ClothTree, pinned: &[bool], x: &mut [Vec3]) -> usize {
    if tree.crossings(x).is_empty() {
        return 0;
    }
    let mut at = x.to_vec();
    let mean = sheet.edges().iter().map(|e| e.rest_length).sum::<f64>() / sheet.edges().len().max(1) as f64;
    let beside: HashMap<[u32; 2], Beside> = sheet.edges().iter().map(beside).collect();
    let (mut least, mut since) = (usize::MAX, 0);
    for _ in 0..SWEEPS {
        let crossings = tree.crossings(&at);
        if crossings.len() < least {
            (least, since) = (crossings.len(), 0);
            x.copy_from_slice(&at);
        }
        since += 1;
        if least == 0 || since > PATIENCE {
            break;
        }
        let step = if since > SWEEPS_UNTIL_SHORTER { SHORTER_MOVE * LONGEST_MOVE } else { LONGEST_MOVE };
        let mut moves = vec![(Vec3::zeros(), 0.0); at.len()];
        for (e, t) in &crossings {
            let found = beside.get(e).and_then(|sides| crossing(*e, *t, sides, &at));
            let Some(Crossing { gradient, along, on }) = found else { continue };
            let way =
                gradient * (step * mean / (gradient.norm_squared() + HALF_GRADIENT * HALF_GRADIENT).sqrt());
            let edge = [(e[0], 1.0 - along), (e[1], along)];
            let nodes = edge.into_iter().map(|(v, w)| (v, w, way));
            for (v, w, way) in nodes.chain(t.iter().zip(on).map(|(v, w)| (*v, w, -way))) {
                moves[v as usize].0 += way * w;
                moves[v as usize].1 += w;
            }
        }
        // A node of several crossings makes their mean move.
        let means = moves.iter().map(|(m, w)| m / w.max(1.0));
        at.iter_mut().zip(means).zip(pinned).filter(|(_, fixed)| !**fixed).for_each(|((p, m), _)| *p += m);
        shorten_stretched(sheet, pinned, &mut at);
    }
    least
}

/// The vertices opposite an edge, in the one or two triangles beside it.
type Beside = [Option<u32>; 2];

fn beside(e: &Edge) -> ([u32; 2], Beside) {
    let [a, b] = e.vertices;
    ([a.min(b), a.max(b)], [Some(e.sides.0.opposite), e.sides.1.map(|s| s.opposite)])
}

/// A crossing: an edge that passes through a triangle.
struct Crossing {
    /// The direction in which the edge moves against the triangle to shorten the contour. Its
    /// length is the change of the contour length per move.
    gradient: Vec3,
    /// Where the crossing lies along the edge, 0 to 1.
    along: f64,
    /// The weights of the corners of the triangle at the crossing.
    on: [f64; 3],
}

fn crossing(e: [u32; 2], t: [u32; 3], sides: &Beside, x: &[Vec3]) -> Option<Crossing> {
    let [p, q] = e.map(|v| x[v as usize]);
    let [a, b, c] = t.map(|v| x[v as usize]);
    let area = (b - a).cross(&(c - a));
    let normal = area.try_normalize(0.0)?;
    let edge = (q - p).try_normalize(0.0)?;
    let [from, to] = [normal.dot(&(p - a)), normal.dot(&(q - a))];
    let along = if from == to { 0.5 } else { (from / (from - to)).clamp(0.0, 1.0) };
    let at = p + (q - p) * along;
    let slope = edge.dot(&normal);
    let steep = slope.abs().max(LEAST_SINE).copysign(slope);
    // The length of a straight contour does not depend on the move: then the end that has gone
    // through less moves back.
    let shallow = if from.abs() < to.abs() { to } else { from };
    let mut gradient = normal * PULL_BACK.copysign(shallow);
    for across in sides.iter().flatten().filter(|v| !t.contains(v)).map(|v| x[*v as usize] - p) {
        let Some(line) = (q - p).cross(&across).cross(&normal).try_normalize(1e-12) else { continue };
        // The direction from the edge into its triangle.
        let inward = across - edge * edge.dot(&across);
        let line = if line.dot(&inward) < 0.0 { -line } else { line };
        gradient += line - normal * (2.0 * edge.dot(&line) / steep);
    }
    let weight = |u: Vec3, v: Vec3| (u - at).cross(&(v - at)).dot(&normal) / area.norm();
    Some(Crossing { gradient, along, on: [weight(b, c), weight(c, a), weight(a, b)] })
}

/// Shortens stretched edges to their rest lengths. Compressed edges stay: cloth folds instead.
fn shorten_stretched(sheet: &Sheet, pinned: &[bool], x: &mut [Vec3]) {
    for _ in 0..SHORTENING_ROUNDS {
        let mut moves = vec![Vec3::zeros(); x.len()];
        for e in sheet.edges() {
            let [a, b] = e.vertices.map(|v| v as usize);
            let way = x[b] - x[a];
            let length = way.norm();
            if length > e.rest_length {
                let half = way * (0.5 * SHORTENING * (1.0 - e.rest_length / length));
                moves[a] += half;
                moves[b] -= half;
            }
        }
        x.iter_mut().zip(moves).zip(pinned).filter(|(_, fixed)| !**fixed).for_each(|((p, m), _)| *p += m);
    }
}

#[cfg(test)]
mod tests;
