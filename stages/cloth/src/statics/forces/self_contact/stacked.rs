//! Regularised contact of many stacked cloths, which often have the same mesh with corner over
//! corner.
//!
//! In a stack, contacts that begin or end with every rounding at their full force would keep the
//! cloth moving. So their stiffness falls to zero towards the ends of edges and where edges are
//! parallel (after the mollifier of Li et al. 2020), and pairs keep counting while they are near.
//! Outside stacks contacts fade only at the very ends of edges.

use super::SelfContact;
use toile_geometry::{
    Vec3,
    pair::{Closest, Kind, Pair},
};

/// Least distance that a node may move before pairs are sought anew, in thicknesses.
const SLACK: f64 = 1.5;

/// The same in edge lengths, outside stacks.
const EDGE_SLACK: f64 = 0.2;

/// Share of an edge from its end within which its contact with an edge fades in a stack.
const STACK_END: f64 = 0.1;

/// The same outside stacks. It is small because the ends must carry where folds press on each
/// other.
const END: f64 = 0.005;

/// Square of the sine of the angle between two edges below which their contact fades.
const PARALLEL: f64 = 0.01;

impl SelfContact {
    /// How far a node may move before pairs are sought anew, m. A longer slack lasts for more
    /// steps, but it brings more pairs: of triangles with their neighbours' neighbours, and in a
    /// stack of many sheets.
    #[must_use]
    pub fn slack(&self) -> f64 {
        let least = SLACK * self.thickness;
        if self.stacked { least } else { least.max(EDGE_SLACK * self.edge) }
    }

    /// Switches, in a stack, whether a pair that was in contact stays in contact while it is near,
    /// although it is no local minimum of the distance any more.
    pub fn hold(&mut self, on: bool) {
        match (on && self.stacked, &self.held) {
            (true, None) => self.held = Some(Vec::new()),
            (false, Some(_)) => self.held = None,
            _ => {}
        }
    }

    /// The share of its stiffness that a contact has: less than 1 where two edges meet near an end
    /// or, in a stack, are nearly parallel. There the corners carry the load.
    pub(super) fn fading(&self, p: &Pair, c: &Closest, x: &[Vec3]) -> f64 {
        match p.kind {
            Kind::VertexTriangle => 1.0,
            Kind::EdgeEdge if self.stacked => inwards(c, STACK_END) * across(&p.at(x)),
            Kind::EdgeEdge => inwards(c, END),
        }
    }

    /// Whether the pair stays in contact while it is near.
    pub(super) fn is_held(&self, p: &Pair) -> bool {
        self.held.as_ref().is_some_and(|h| h.binary_search(p).is_ok())
    }

    /// Adds the pairs in contact to those that stay in contact.
    pub(super) fn remember(&mut self, counted: &[(Pair, Closest)]) {
        if let Some(held) = &mut self.held {
            held.extend(counted.iter().map(|(p, _)| *p));
            held.sort_unstable();
            held.dedup();
        }
    }
}

/// How far the closest points of two edges lie inside them: 0 at an end, 1 from the share `end` of
/// the edge on.
fn inwards(c: &Closest, end: f64) -> f64 {
    let [a, b, d, e] = c.weights.map(f64::abs);
    (a.min(b) / end).min(1.0) * (d.min(e) / end).min(1.0)
}

/// How far two edges are from parallel: 0 for parallel edges, 1 where the squared sine of their
/// angle is at least [`PARALLEL`]. The closest points of parallel edges move from end to end with
/// every rounding.
fn across(x: &[Vec3; 4]) -> f64 {
    let (a, b) = (x[1] - x[0], x[3] - x[2]);
    let lengths = a.norm_squared() * b.norm_squared();
    (a.cross(&b).norm_squared() / (PARALLEL * lengths).max(f64::MIN_POSITIVE)).min(1.0)
}

#[cfg(test)]
mod tests;
