//! The body under the cloth: from which distance it presses, how near a move may lead, and what was
//! seen of it.

use crate::contact::skin::CollisionSurface;
use nalgebra::Vector3;
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// Share of the offset that a move leaves between a node and the body.
const GUARD: f64 = 0.5;

/// Share of the offset below which a node that the guard stops is one that the layer cannot carry.
const PRESSED: f64 = 0.6;

/// How much stiffer contact becomes that cannot carry a node.
const STIFFER: f64 = 4.0;

/// Beyond this it does not, N/m: in half a millimetre it carries 50 kg.
const STIFFEST: f64 = 1e6;

/// What a bound on a distance is widened by against rounding, m.
pub(crate) const NUDGE: f64 = 1e-9;

/// Share of the offset up to which a node that has touched keeps its place on the body.
pub(crate) const NEAR: f64 = 1.5;

/// The body and how cloth rests on it.
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
    /// Edges of the sheet and their rest lengths: between two nodes on a curved body an edge sags.
    pub edges: Vec<([u32; 2], f64)>,
    /// Whether edges must stay outside the body, too; otherwise they may sag into it as far as
    /// keeps the girth right.
    pub clear: bool,
    /// Whether the layer grows under nodes that are pressed to the guard, so that it carries them.
    pub grows: bool,
    /// Whether contact becomes stiffer under nodes that lie in the body, until it brings them out:
    /// cloth that is sewn through a body, or around another, may be too tight for it to come out by
    /// itself.
    pub hard: bool,
    /// Whether cloth may pass through the body, which pushes it out all the same.
    pub passes: bool,
    /// Stiffness of contact, N/m per node.
    pub stiffness: Vec<f64>,
    /// Nodes that pressed harder than their contact can carry in the last step.
    pub pressed: Vec<u32>,
    #[cfg(toile_without = "body")]
    pub(crate) never: std::convert::Infallible,
}

/// How far a node was from the body when that was last looked up: it bounds how far it can be now.
#[derive(Debug, Clone, Copy)]
pub struct DistanceCache {
    /// Where the node was.
    pub at: Vec3,
    /// Its distance, negative inside, or a bound below it, m.
    pub distance: f64,
    /// Whether the distance is exact.
    pub exact: bool,
}

/// What a node sees of the body: how far it is, and the place that presses, if any does.
pub type ContactQuery = (DistanceCache, Option<Nearest>);

impl BodyContact<'_> {
    /// How near the body a move may lead node `i`, m.
    pub(crate) fn guard(&self, i: usize) -> f64 {
        GUARD * if self.grows { self.offset } else { self.offsets[i] }
    }

    /// Lets the layer under node `i` grow if it lies at its bottom. A stiff sheet presses harder on
    /// a few nodes than the layer can carry; the guard would stop them at every step, and nothing
    /// would come to rest.
    pub(crate) fn grow(&mut self, i: usize, distance: f64) {
        if distance < PRESSED * self.offset {
            self.offsets[i] += GUARD * self.offset;
        }
    }

    /// Takes a node that the guard stops at the bottom of its layer for one that presses harder
    /// than its contact carries.
    pub(crate) fn press(&mut self, i: usize, distance: f64) {
        if distance < PRESSED * self.offsets[i] {
            self.pressed.push(i as u32);
        }
    }

    /// Makes contact stiffer where the last step pressed a node to the guard: its share of the
    /// sheet is too small for what comes together there, and held by the guard alone it would never
    /// rest.
    pub(crate) fn stiffen(&mut self) {
        self.pressed.sort_unstable();
        self.pressed.dedup();
        for i in self.pressed.drain(..) {
            let stiffness = &mut self.stiffness[i as usize];
            *stiffness = (*stiffness * STIFFER).min(stiffness.max(STIFFEST));
        }
    }

    /// Moves the offsets of touching nodes outwards where the edges between them would dip into a
    /// convex body, but for edges that are held off it themselves.
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
            let least = if self.clear { (sag - 0.5 * self.offset).max(sag / 3.0) } else { sag / 3.0 };
            self.offsets[i] = self.offsets[i].max(self.offset + least);
        }
    }

    /// How far to look for the body around `p`; not at all where what was `seen` earlier tells that
    /// it is far.
    pub(crate) fn reach(&self, p: &Vec3, offset: f64, seen: Option<&DistanceCache>) -> Option<f64> {
        let within = offset + self.depth;
        let Some(seen) = seen else { return Some(within) };
        let way = (p - seen.at).norm();
        match seen.distance - way > NEAR * offset {
            true => None,
            false if seen.exact => Some(within.min(seen.distance.abs() + way + NUDGE)),
            false => Some(within),
        }
    }
}

#[cfg(test)]
mod tests;
