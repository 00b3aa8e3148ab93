//! Where cloth starts: outside the body.

use super::skin::CollisionSurface;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// A vertex that starts deeper than this in the body is not pushed out: which side it belongs to is
/// a guess, m.
pub(crate) const DEEPEST: f64 = 0.05;

/// Vertices that start too deep in the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sunk {
    /// How many lie in it.
    pub(crate) vertices: usize,
    /// The depth of the deepest, m.
    pub(crate) depth: f64,
    /// The deepest.
    pub(crate) deepest: usize,
}

/// The start with vertices that lie a little inside the body moved out to a distance, m; besides,
/// whether there is a body.
pub(crate) fn clear_start(
    positions: &[Vec3],
    skin: &dyn CollisionSurface,
    distance: f64,
) -> Result<(Vec<Vec3>, bool), Sunk> {
    let mut start = positions.to_vec();
    let mut sunk = Sunk { vertices: 0, depth: 0.0, deepest: 0 };
    let near = skin.nearest(&start, &vec![f64::INFINITY; start.len()]);
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
