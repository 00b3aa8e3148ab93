//! Cloth that crosses itself is taken out of itself along the contours where it does, by geometry
//! alone.
//!
//! Method: intersection contour minimisation (Volino, Magnenat-Thalmann 2006). Where an edge passes
//! through a triangle, the contour goes on from there into the triangles beside the edge. Edge and
//! triangle move against each other in the direction in which the contour becomes shorter the
//! fastest; a contour that ends at a hem is drawn out over it, a closed one shrinks to nothing.
//! Between these moves edges that were stretched are drawn back to their lengths. No side need be
//! known. Cost: a look for crossings a sweep. Limits: contours that are as long whichever way the
//! cloth moves, as where one tube passes straight through another, or a hem lies below cloth along
//! its whole length, may stay.

use crate::mesh::{Edge, Sheet};
use nalgebra::Vector3;
use std::collections::HashMap;
use toile_geometry::cloth_tree::ClothTree;

type Vec3 = Vector3<f64>;

/// How far an edge moves in a sweep at most, as a share of the mean edge, and the gradient at which
/// it moves 0.7 of that.
const STEP: (f64, f64) = (0.3, 0.3);

/// After so many sweeps without fewer crossings moves are this share of that: the last ones are
/// stepped over, to and fro.
const SHORTER: (usize, f64) = (20, 0.3);

/// Sweeps at most, and those in which the least number of crossings must fall.
const SWEEPS: usize = 400;
const PATIENCE: usize = 60;

/// How strongly an edge is pulled back by its end that has gone through less, beside a gradient
/// of 1.
const BACK: f64 = 0.2;

/// Least sine of the angle between an edge and a triangle: one nearly in its plane would move
/// without bound.
const LEAST_STEEP: f64 = 0.1;

/// How often edges are drawn back to their lengths after a sweep, and by which share of what they
/// lack.
const KEEP: (usize, f64) = (4, 0.3);

/// Moves nodes until cloth crosses itself no more, or no fewer times; the crossings left. `x` is
/// the best state found.
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
        let step = if since > SHORTER.0 { SHORTER.1 * STEP.0 } else { STEP.0 };
        let mut moves = vec![(Vec3::zeros(), 0.0); at.len()];
        for (e, t) in &crossings {
            let found = beside.get(e).and_then(|sides| meeting(*e, *t, sides, &at));
            let Some(Meeting { gradient, along, on }) = found else { continue };
            let way = gradient * (step * mean / (gradient.norm_squared() + STEP.1 * STEP.1).sqrt());
            let edge = [(e[0], 1.0 - along), (e[1], along)];
            let nodes = edge.into_iter().map(|(v, w)| (v, w, way));
            for (v, w, way) in nodes.chain(t.iter().zip(on).map(|(v, w)| (*v, w, -way))) {
                moves[v as usize].0 += way * w;
                moves[v as usize].1 += w;
            }
        }
        // Where several meet, their mean.
        let means = moves.iter().map(|(m, w)| m / w.max(1.0));
        at.iter_mut().zip(means).zip(pinned).filter(|(_, fixed)| !**fixed).for_each(|((p, m), _)| *p += m);
        keep(sheet, pinned, &mut at);
    }
    least
}

/// The vertices across from an edge, in the one or two triangles beside it.
type Beside = [Option<u32>; 2];

fn beside(e: &Edge) -> ([u32; 2], Beside) {
    let [a, b] = e.vertices;
    ([a.min(b), a.max(b)], [Some(e.sides.0.opposite), e.sides.1.map(|s| s.opposite)])
}

/// An edge that passes through a triangle.
struct Meeting {
    /// The direction in which the edge moves against the triangle to shorten their contour, the
    /// longer the faster that becomes shorter.
    gradient: Vec3,
    /// Where along the edge, 0 to 1.
    along: f64,
    /// The weights of the triangle's corners there.
    on: [f64; 3],
}

fn meeting(e: [u32; 2], t: [u32; 3], sides: &Beside, x: &[Vec3]) -> Option<Meeting> {
    let [p, q] = e.map(|v| x[v as usize]);
    let [a, b, c] = t.map(|v| x[v as usize]);
    let area = (b - a).cross(&(c - a));
    let normal = area.try_normalize(0.0)?;
    let edge = (q - p).try_normalize(0.0)?;
    let [from, to] = [normal.dot(&(p - a)), normal.dot(&(q - a))];
    let along = if from == to { 0.5 } else { (from / (from - to)).clamp(0.0, 1.0) };
    let at = p + (q - p) * along;
    let slope = edge.dot(&normal);
    let steep = slope.abs().max(LEAST_STEEP).copysign(slope);
    // The end that has gone through less comes back, where nothing else tells the way: straight
    // contours are as long whichever way they move.
    let shallow = if from.abs() < to.abs() { to } else { from };
    let mut gradient = normal * BACK.copysign(shallow);
    for across in sides.iter().flatten().filter(|v| !t.contains(v)).map(|v| x[*v as usize] - p) {
        let Some(line) = (q - p).cross(&across).cross(&normal).try_normalize(1e-12) else { continue };
        // Away from the edge, into its triangle.
        let inward = across - edge * edge.dot(&across);
        let line = if line.dot(&inward) < 0.0 { -line } else { line };
        gradient += line - normal * (2.0 * edge.dot(&line) / steep);
    }
    let weight = |u: Vec3, v: Vec3| (u - at).cross(&(v - at)).dot(&normal) / area.norm();
    Some(Meeting { gradient, along, on: [weight(b, c), weight(c, a), weight(a, b)] })
}

/// Draws stretched edges back to their lengths: cloth folds before it is squeezed.
fn keep(sheet: &Sheet, pinned: &[bool], x: &mut [Vec3]) {
    for _ in 0..KEEP.0 {
        let mut moves = vec![Vec3::zeros(); x.len()];
        for e in sheet.edges() {
            let [a, b] = e.vertices.map(|v| v as usize);
            let way = x[b] - x[a];
            let length = way.norm();
            if length > e.rest_length {
                let half = way * (0.5 * KEEP.1 * (1.0 - e.rest_length / length));
                moves[a] += half;
                moves[b] -= half;
            }
        }
        x.iter_mut().zip(moves).zip(pinned).filter(|(_, fixed)| !**fixed).for_each(|((p, m), _)| *p += m);
    }
}

#[cfg(test)]
mod tests;
