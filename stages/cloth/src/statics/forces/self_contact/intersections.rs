//! Intersection resolution: cloth that has passed through cloth is pulled back out.
//!
//! The state of a coarser level may intersect itself on a finer one. For each edge that passes
//! through a triangle, a spring pulls the end that has gone through less back to the other side.
//! Cost: O(n) of the pairs. Limit: large intersections may stay (see `drive/contour`).

use super::{Contact, SelfContact};
use crate::statics::forces::contact_potential::ContactPotential;
use rayon::prelude::*;
use toile_geometry::pair::Pair;
use toile_geometry::{Vec3, closest::on_triangle};

/// Share of the thickness below which a pair counts as merged; under its own weight cloth keeps a
/// tenth and more.
pub(crate) const MERGED: f64 = 0.02;

impl SelfContact {
    /// Makes a spring for each crossing at `x`, and marks the nodes of crossings and merged pairs
    /// as intersecting.
    pub fn resolve_intersections(&mut self, crossings: &[([u32; 2], [u32; 3])], x: &[Vec3]) {
        let merged = self.merged(x);
        let free = crossings.is_empty() && merged.is_empty();
        self.intersecting = vec![false; if free { 0 } else { x.len() }];
        let crossed = crossings.iter().flat_map(|(e, t)| e.iter().chain(t));
        crossed
            .chain(merged.iter().flat_map(|p| &p.nodes))
            .for_each(|&i| self.intersecting[i as usize] = true);
        self.intersections = crossings.iter().filter_map(|(e, t)| self.intersection(*e, *t, x)).collect();
    }

    /// Pairs so near that barrier and collision detection would never let them separate.
    fn merged(&self, x: &[Vec3]) -> Vec<Pair> {
        self.pairs.par_iter().with_min_len(256).filter(|p| self.is_merged(p, x)).copied().collect()
    }

    /// The nodes of each crossing and of each merged pair; those of the edge or vertex come first.
    pub(crate) fn intersecting_nodes(&self, x: &[Vec3]) -> Vec<[u32; 4]> {
        self.intersections.iter().map(|c| c.nodes).chain(self.merged(x).iter().map(|p| p.nodes)).collect()
    }

    /// Whether a pair is merged: nearer than `MERGED` of the thickness.
    pub fn is_merged(&self, pair: &Pair, x: &[Vec3]) -> bool {
        pair.closest(x).distance < MERGED * self.thickness
    }

    fn intersection(&self, e: [u32; 2], t: [u32; 3], x: &[Vec3]) -> Option<Contact> {
        let [a, b, c] = t.map(|v| x[v as usize]);
        let up = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let height = |v: u32| up.dot(&(x[v as usize] - a));
        let (shallow, normal) = match self.side(&e, &t) {
            // The order of the layers decides which end is on the wrong side.
            Some(side) => (if side * height(e[0]) < side * height(e[1]) { e[0] } else { e[1] }, up * side),
            None => {
                let [shallow, deep] = if height(e[0]).abs() < height(e[1]).abs() { e } else { [e[1], e[0]] };
                (shallow, if height(deep) > 0.0 { up } else { -up })
            }
        };
        let on = on_triangle(&x[shallow as usize], &[a, b, c]);
        let nodes = [shallow, t[0], t[1], t[2]];
        let weights = [1.0, -on.weights[0], -on.weights[1], -on.weights[2]];
        let distance = normal.dot(&(x[shallow as usize] - on.point));
        let stiffness = 0.5 * self.stiffness[shallow as usize];
        let potential = ContactPotential::spring(stiffness, self.thickness, distance);
        Some(Contact { nodes, weights, normal, stiffness, potential })
    }

    /// The side of a triangle on which an edge of another layer belongs: 1 outside, -1 inside;
    /// `None` where they are in one layer.
    fn side(&self, e: &[u32; 2], t: &[u32; 3]) -> Option<f64> {
        let of = |v: &u32| self.order.get(*v as usize).copied();
        let one = |nodes: &[u32]| {
            nodes.first().and_then(of).filter(|first| nodes.iter().all(|v| of(v) == Some(*first)))
        };
        match one(e)?.cmp(&one(t)?) {
            std::cmp::Ordering::Greater => Some(1.0),
            std::cmp::Ordering::Less => Some(-1.0),
            std::cmp::Ordering::Equal => None,
        }
    }

    /// Whether an edge and a triangle are in two layers, whose order resolves their crossing.
    #[must_use]
    pub fn is_ordered(&self, e: &[u32; 2], t: &[u32; 3]) -> bool {
        self.side(e, t).is_some()
    }

    /// Whether all nodes of the pair are intersecting.
    #[must_use]
    pub fn is_intersecting(&self, pair: &Pair) -> bool {
        !self.intersecting.is_empty() && pair.nodes.iter().all(|&i| self.intersecting[i as usize])
    }
}

#[cfg(test)]
mod tests;
