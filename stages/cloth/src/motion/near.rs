//! Neighbour pairs and the nearest body, found once for many small steps. Cost: one search per
//! larger step. Limit: the surface of the body is taken as a plane at each node meanwhile.

use super::Vec3;
use crate::statics::drive::solve::Collider;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::Pair;
use toile_geometry::signed_distance::Nearest;

/// Greatest deviation of a node from the move that its velocity predicts, m.
const STRAY: f64 = 1e-3;

/// Neighbour pairs, and the tangent plane of the body at each node.
pub(super) struct Near {
    pub(super) pairs: Vec<Pair>,
    surface: Vec<Option<Nearest>>,
    at: Vec<Vec3>,
}

impl Near {
    /// Everything that nodes at `x` may approach to within `offset` while they move by about
    /// `moves`, and the body for nodes up to `reach` deep in it.
    pub(super) fn of(
        tree: Option<&ClothTree>,
        collider: Option<Collider<'_>>,
        x: &[Vec3],
        moves: &[Vec3],
        offset: f64,
        reach: f64,
    ) -> Self {
        let pairs = tree.map_or_else(Vec::new, |t| t.pairs(x, moves, offset + 2.0 * STRAY));
        let within: Vec<f64> = moves.iter().map(|m| offset + reach + m.norm() + STRAY).collect();
        let surface = collider.map_or_else(Vec::new, |c| c.surface.nearest(x, &within));
        Self { pairs, surface, at: x.to_vec() }
    }

    /// The nearest places of the body for nodes that have moved to `x`.
    pub(super) fn surface(&self, x: &[Vec3]) -> Vec<Option<Nearest>> {
        let seen = |((n, at), x): ((&Option<Nearest>, &Vec3), &Vec3)| {
            n.as_ref().map(|n| Nearest { distance: n.distance + n.normal.dot(&(x - at)), ..*n })
        };
        self.surface.iter().zip(&self.at).zip(x).map(seen).collect()
    }
}
