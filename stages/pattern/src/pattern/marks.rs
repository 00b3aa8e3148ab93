//! What is drawn on a piece beside its outline: notches on the edges that they are nearest to,
//! holes.

use toile_core::prelude::*;

/// Each notch, a point and its depth, on the edge that it is nearest to.
pub(super) fn notched(outer: &PatternLoop, notches: &[(Point2, f64)]) -> Vec<Notch> {
    let paths: Vec<EdgePath> = (0..outer.edges.len()).map(|k| outer.path(k)).collect();
    let mut out: Vec<Notch> = Vec::new();
    for (p, depth) in notches {
        let feet = paths.iter().enumerate().map(|(k, path)| (k, nearest(path, *p)));
        let Some((k, (_, along))) = feet.min_by(|x, y| x.1.0.total_cmp(&y.1.0)) else { continue };
        let notch = Notch { edge: outer.edges[k].name.clone(), along, depth: *depth };
        let same = |n: &Notch| n.edge == notch.edge && (n.along - along).abs() < 1e-3;
        if !out.iter().any(same) {
            out.push(notch);
        }
    }
    out
}

/// The distance of a point from a path, and the length along it there.
fn nearest(path: &EdgePath, p: Point2) -> (f64, f64) {
    let (mut best, mut before) = ((f64::INFINITY, 0.0), 0.0);
    for w in path.points().windows(2) {
        let d = w[1] - w[0];
        let t = ((p - w[0]).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let distance = (p - (w[0] + d * t)).norm();
        if distance < best.0 {
            best = (distance, (before + t * d.norm()).min(path.length()));
        }
        before += d.norm();
    }
    best
}

/// A hole by its corners, straight from one to the next.
pub(super) fn hole(k: usize, mut corners: Vec<Point2>) -> PatternLoop {
    if polygon_area(&corners) > 0.0 {
        corners.reverse();
    }
    let edge = |i: usize| PieceEdge { name: format!("hole_{k}_{i}"), curve: EdgeCurve::Line };
    PatternLoop { edges: (0..corners.len()).map(edge).collect(), corners }
}
