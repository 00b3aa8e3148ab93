//! What is otherwise where many cloths lie on each other, each near many others, often of one mesh
//! with corner over corner.
//!
//! There a contact that begins or ends with every rounding, at its full force, would push the pile
//! to and fro for ever. Two edges may meet at an end anywhere, so at their very ends contacts fade
//! everywhere.

use super::SelfContact;
use nalgebra::Vector3;
use toile_geometry::pair::{Closest, Kind, Pair};

type Vec3 = Vector3<f64>;

/// Least way that a node may move before pairs are sought anew, in thicknesses.
const SLACK: f64 = 1.5;

/// The same in edges.
const EDGE_SLACK: f64 = 0.2;

/// Share of an edge from its end within which its contact with an edge fades in a pile.
const END: f64 = 0.1;

/// The same elsewhere: as little as serves, for where folds press on each other the ends must
/// carry, too.
const TIP: f64 = 0.005;

/// Square of the sine of the angle between two edges below which their contact fades.
const ALONG: f64 = 0.01;

impl SelfContact {
    /// How far a node may move before pairs are sought anew, m. Longer serves more steps, but
    /// beyond a part of an edge every triangle is near its neighbours' neighbours, and in a pile
    /// near many sheets.
    #[must_use]
    pub fn slack(&self) -> f64 {
        let least = SLACK * self.thickness;
        if self.crowded { least } else { least.max(EDGE_SLACK * self.edge) }
    }

    /// In a pile: from now on, or no more, what has counted as a contact counts while it is near,
    /// although it is no local minimum of the distance any more.
    pub fn hold(&mut self, on: bool) {
        match (on && self.crowded, &self.held) {
            (true, None) => self.held = Some(Vec::new()),
            (false, Some(_)) => self.held = None,
            _ => {}
        }
    }

    /// The share of its stiffness that a contact has: less than 1 where two edges meet near an end
    /// or, in a pile, lie along each other. There the corners carry.
    pub(super) fn fading(&self, p: &Pair, c: &Closest, x: &[Vec3]) -> f64 {
        match p.kind {
            Kind::VertexTriangle => 1.0,
            Kind::EdgeEdge if self.crowded => inwards(c, END) * across(&p.at(x)),
            Kind::EdgeEdge => inwards(c, TIP),
        }
    }

    pub(super) fn is_held(&self, p: &Pair) -> bool {
        self.held.as_ref().is_some_and(|h| h.binary_search(p).is_ok())
    }

    pub(super) fn remember(&mut self, counted: &[(Pair, Closest)]) {
        if let Some(held) = &mut self.held {
            held.extend(counted.iter().map(|(p, _)| *p));
            held.sort_unstable();
            held.dedup();
        }
    }
}

/// How far the closest points of two edges lie inside them, 0 at an end to 1 from that share of the
/// edge on.
fn inwards(c: &Closest, end: f64) -> f64 {
    let [a, b, d, e] = c.weights.map(f64::abs);
    (a.min(b) / end).min(1.0) * (d.min(e) / end).min(1.0)
}

/// How far two edges are from parallel, 0 to 1 from a square [`ALONG`] of the sine of their angle
/// on.
///
/// The closest points of edges that lie along each other run from end to end with every rounding
/// (the mollifier of Li et al. 2020, here of the stiffness).
fn across(x: &[Vec3; 4]) -> f64 {
    let (a, b) = (x[1] - x[0], x[3] - x[2]);
    let lengths = a.norm_squared() * b.norm_squared();
    (a.cross(&b).norm_squared() / (ALONG * lengths).max(f64::MIN_POSITIVE)).min(1.0)
}

#[cfg(test)]
mod tests;
