//! Contact of cloth with the body: the distance at which contact begins at each node, how near a
//! move may lead, and a cache of distances.
//!
//! Method: a quadratic penalty within a thickness of the surface, so that vertices rest outside it.
//! Cost: one distance query per node that may be near. Limits: see `clearance` for what lies
//! between vertices, and `ridges` for sharp features.

use crate::contact::collision_surface::CollisionSurface;
use nalgebra::Vector3;
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// Share of the offset that a move leaves between a node and the body.
const GUARD: f64 = 0.5;

/// Share of the offset below which a node that the guard stops counts as overloaded.
const OVERLOADED: f64 = 0.6;

/// Factor by which the contact of an overloaded node becomes stiffer.
const STIFFER: f64 = 4.0;

/// Greatest stiffness that it reaches, N/m: in half a millimetre it carries 50 kg.
const STIFFEST: f64 = 1e6;

/// Allowance for rounding in bounds on a distance, m.
pub(crate) const NUDGE: f64 = 1e-9;

/// Distance, as a share of the offset, up to which a node in contact keeps its anchor.
pub(crate) const NEAR: f64 = 1.5;

/// Contact of the nodes with the body.
#[derive(Debug, Clone)]
pub struct BodyContact<'a> {
    /// The body.
    pub body: &'a dyn CollisionSurface,
    /// Coefficient of friction, per node.
    pub friction: Vec<f64>,
    /// Distance at which contact begins, per node, m.
    pub offsets: Vec<f64>,
    /// The least of them, m.
    pub offset: f64,
    /// How deep inside the body a node is still pushed out, m.
    pub depth: f64,
    /// Edges of the sheet and their rest lengths: an edge between two nodes on a curved body dips
    /// below them.
    pub edges: Vec<([u32; 2], f64)>,
    /// Whether edges must stay outside the body, too; otherwise they may dip into it as far as
    /// keeps the girth right.
    pub keeps_edges_out: bool,
    /// Whether the offset of overloaded nodes grows until contact carries them.
    pub grows_offsets: bool,
    /// Whether contact becomes stiffer at nodes inside the body until they are outside: cloth that
    /// is sewn through a body may be too tight to come out otherwise.
    pub stiffens_inside: bool,
    /// Whether moves may lead into the body, which then pushes the cloth out.
    pub lets_through: bool,
    /// Stiffness of contact, N/m per node.
    pub stiffness: Vec<f64>,
    /// Nodes that pressed harder than their contact can carry in the last step.
    pub overloaded: Vec<u32>,
    #[cfg(toile_without = "body")]
    pub(crate) never: std::convert::Infallible,
}

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

impl BodyContact<'_> {
    /// How near the body a move may lead node `i`, m.
    pub(crate) fn guard(&self, i: usize) -> f64 {
        GUARD * if self.grows_offsets { self.offset } else { self.offsets[i] }
    }

    /// Increases the offset of node `i` if it is overloaded. A stiff sheet presses harder on a few
    /// nodes than their contact can carry. Without this the guard would stop them at every step,
    /// and nothing would come to rest.
    pub(crate) fn grow(&mut self, i: usize, distance: f64) {
        if distance < OVERLOADED * self.offset {
            self.offsets[i] += GUARD * self.offset;
        }
    }

    /// Marks a node that the guard has stopped as overloaded if it lies too near.
    pub(crate) fn mark_overloaded(&mut self, i: usize, distance: f64) {
        if distance < OVERLOADED * self.offsets[i] {
            self.overloaded.push(i as u32);
        }
    }

    /// Makes contact stiffer at overloaded nodes. Their share of the sheet is too small for the
    /// load there; if the guard alone held them they would never come to rest.
    pub(crate) fn stiffen_overloaded(&mut self) {
        self.overloaded.sort_unstable();
        self.overloaded.dedup();
        for i in self.overloaded.drain(..) {
            let stiffness = &mut self.stiffness[i as usize];
            *stiffness = (*stiffness * STIFFER).min(stiffness.max(STIFFEST));
        }
    }

    /// Increases the offsets of nodes in contact where the edges between them would dip into a
    /// convex body. Edges that `is_held` are left out: `ridges` keeps them off the body.
    pub(crate) fn allow_for_sag(
        &mut self,
        near: &[Option<Nearest>],
        x: &[Vec3],
        is_held: impl Fn([u32; 2]) -> bool,
    ) {
        let mut sags = vec![0.0f64; self.offsets.len()];
        for &([i, j], length) in &self.edges {
            let (i, j) = (i as usize, j as usize);
            if let (Some(a), Some(b)) = (&near[i], &near[j]) {
                let turn = b.normal - a.normal;
                if turn.dot(&(x[j] - x[i])) > 0.0 && !is_held([i as u32, j as u32]) {
                    let sag = length * turn.norm() / 8.0;
                    (sags[i], sags[j]) = (sags[i].max(sag), sags[j].max(sag));
                }
            }
        }
        // Offsets only grow within a level, or contacts would come and go with them.
        for (i, sag) in sags.into_iter().enumerate() {
            // A polygon around a circle has its length when its corners stand a third of the sag
            // outside.
            let least =
                if self.keeps_edges_out { (sag - 0.5 * self.offset).max(sag / 3.0) } else { sag / 3.0 };
            self.offsets[i] = self.offsets[i].max(self.offset + least);
        }
    }

    /// The radius within which to query the body around `p`; `None` where the `cached` distance
    /// shows that it is far.
    pub(crate) fn reach(&self, p: &Vec3, offset: f64, cached: Option<&DistanceCache>) -> Option<f64> {
        let within = offset + self.depth;
        let Some(cached) = cached else { return Some(within) };
        let moved = (p - cached.at).norm();
        match cached.distance - moved > NEAR * offset {
            true => None,
            false if cached.exact => Some(within.min(cached.distance.abs() + moved + NUDGE)),
            false => Some(within),
        }
    }
}

#[cfg(test)]
mod tests;
