//! The distance of a node from the body, and the cached distance that saves a query.
//!
//! Method: the distance at the last query bounds the distance now, by how far the node has moved.
//! Cost: O(1).

use nalgebra::Vector3;
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// Allowance for rounding in bounds on a distance, m.
pub(crate) const NUDGE: f64 = 1e-9;

/// Distance, as a share of the offset, up to which a node in contact keeps its anchor.
pub(crate) const NEAR: f64 = 1.5;

/// The distance of a node from the body at its last query: it bounds the distance now.
#[derive(Debug, Clone, Copy)]
pub struct DistanceCache {
    /// Where the node was.
    pub at: Vec3,
    /// Its distance, negative inside, or a bound below it, m.
    pub distance: f64,
    /// Whether the distance is exact.
    pub exact: bool,
}

/// The result of a contact query of one node: its distance, and the nearest place if it is near.
pub type ContactQuery = (DistanceCache, Option<Nearest>);

impl DistanceCache {
    /// The radius within which to query the body around `p`, at most `within`; `None` where the
    /// distance shows that it is far from contact at that `offset`.
    pub(crate) fn reach(&self, p: &Vec3, offset: f64, within: f64) -> Option<f64> {
        let moved = (p - self.at).norm();
        match self.distance - moved > NEAR * offset {
            true => None,
            false if self.exact => Some(within.min(self.distance.abs() + moved + NUDGE)),
            false => Some(within),
        }
    }
}
