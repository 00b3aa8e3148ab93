//! What is near cloth, found once and good for the small steps of a while.

use super::Vec3;
use crate::statics::drive::solve::Collider;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::Pair;
use toile_geometry::signed_distance::Nearest;

/// What a node may stray from the way that its speed foretells, m.
const STRAY: f64 = 1e-3;

/// Pairs of cloth, and the skin at each node as the plane that it is nearby.
pub(super) struct Near {
    pub(super) pairs: Vec<Pair>,
    skin: Vec<Option<Nearest>>,
    at: Vec<Vec3>,
}

impl Near {
    /// What nodes at `x` may come nearer to than `offset` while they move about as `moves`
    /// foretell.
    pub(super) fn of(
        tree: Option<&ClothTree>,
        wearer: Option<Collider<'_>>,
        x: &[Vec3],
        moves: &[Vec3],
        offset: f64,
    ) -> Self {
        let pairs = tree.map_or_else(Vec::new, |t| t.pairs(x, moves, offset + 2.0 * STRAY));
        let within: Vec<f64> = moves.iter().map(|m| offset + m.norm() + STRAY).collect();
        let skin = wearer.map_or_else(Vec::new, |w| w.skin.nearest(x, &within));
        Self { pairs, skin, at: x.to_vec() }
    }

    /// The skin as it lies to nodes that have come to `x`.
    pub(super) fn skin(&self, x: &[Vec3]) -> Vec<Option<Nearest>> {
        let seen = |((n, at), x): ((&Option<Nearest>, &Vec3), &Vec3)| {
            n.as_ref().map(|n| Nearest { distance: n.distance + n.normal.dot(&(x - at)), ..*n })
        };
        self.skin.iter().zip(&self.at).zip(x).map(seen).collect()
    }
}
