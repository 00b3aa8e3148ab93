//! Moves cloth out of the body at the start. Cost: one distance per vertex.

use super::collision_surface::CollisionSurface;
use toile_geometry::Vec3;

/// Greatest depth in the body from which a vertex is moved out, m: deeper ones may belong to
/// another side.
pub(crate) const DEEPEST: f64 = 0.05;

/// Vertices that start too deep in the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sunk {
    /// How many there are.
    pub(crate) vertices: usize,
    /// The depth of the deepest one, m.
    pub(crate) depth: f64,
    /// The deepest one.
    pub(crate) deepest: usize,
}

/// The initial positions, with vertices a little inside the body moved out to a distance, m; and
/// whether there is a body.
pub(crate) fn clear_start(
    positions: &[Vec3],
    surface: &dyn CollisionSurface,
    distance: f64,
) -> Result<(Vec<Vec3>, bool), Sunk> {
    let mut start = positions.to_vec();
    let mut sunk = Sunk { vertices: 0, depth: 0.0, deepest: 0 };
    let near = surface.nearest(&start, &vec![f64::INFINITY; start.len()]);
    let is_worn = near.iter().any(Option::is_some);
    for (v, (p, n)) in start.iter_mut().zip(near).enumerate() {
        if let Some(n) = n.filter(|n| n.distance < 0.0) {
            sunk.vertices += 1;
            if -n.distance > sunk.depth {
                (sunk.depth, sunk.deepest) = (-n.distance, v);
            }
            *p = n.point + n.normal * distance;
        }
    }
    if sunk.depth > DEEPEST { Err(sunk) } else { Ok((start, is_worn)) }
}
