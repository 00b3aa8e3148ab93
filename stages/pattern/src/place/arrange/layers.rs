//! Garments that are worn over each other: the outer ones stand farther out.
//!
//! The solver keeps cloth of a higher layer outside that of a lower one; a start in which the
//! layers are already in order needs less of that. Cost: linear in the vertices.

use super::PiecePlaces;
use toile_core::prelude::*;

/// From one layer to the next, metres.
pub(super) const APART: f64 = 0.02;

/// The layers of a pattern's pieces, from the innermost.
pub(super) fn layers(pattern: &Pattern) -> Vec<u32> {
    let mut all: Vec<u32> = pattern.pieces.iter().map(|p| p.layer).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The layer of a piece; the innermost where the pattern has no such piece.
pub(super) fn layer(pattern: &Pattern, name: &str) -> u32 {
    pattern.piece(name).map_or(0, |p| p.layer)
}

/// Moves the pieces of outer layers away from the body's middle, forwards or backwards.
pub(super) fn spread(pattern: &Pattern, places: &mut PiecePlaces, body: &Body) {
    let middle = |points: &[Point3]| points.iter().map(|p| p.z).sum::<f64>() / points.len().max(1) as f64;
    let of_body = middle(&body.positions);
    for (name, points) in places {
        let by = APART * f64::from(layer(pattern, name));
        if by == 0.0 {
            continue;
        }
        let way = if middle(points) < of_body { -by } else { by };
        points.iter_mut().for_each(|p| p.z += way);
    }
}
