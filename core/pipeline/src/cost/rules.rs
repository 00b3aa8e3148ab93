//! How sizes go through a stage that does not say so itself: by its role and its edge length.
//!
//! The factors are those of the shipped samples (docs/reference/costs.md); they stand in until the
//! sizes of an earlier run of the same stage on the same input are known.

use super::{Quantity, Size};
use crate::load::fields_of;
use toile_core::{Length, Node, Role};

/// Triangles on an area A with edges of length h: 2 A / h² on a grid, and this times the root of A
/// / h in the band along the outline.
const BAND: f64 = 12.0;
/// Points of an outline, which edge detectors resample.
const POINTS: f64 = 2300.0;
/// Texels for each pixel of the photos: the garment's box.
const TEXELS_PER_PIXEL: f64 = 0.8;
/// Triangles of a body that says nothing of itself: a mannequin's.
const BODY_TRIANGLES: f64 = 17_000.0;
/// Edge lengths that can be meant, metres.
pub const EDGE_LENGTHS: std::ops::RangeInclusive<f64> = 1e-4..=1.0;

/// The size of a stage's outputs for the size of its inputs: that of the inputs, with what its role
/// usually adds.
pub fn usual(node: &Node, given: &Size) -> Size {
    let all = given.clone();
    match node.card.role {
        Role::EdgeDetector => with(all, Quantity::Points, given.get(Quantity::Pieces), POINTS),
        Role::Mesher => with(all, Quantity::Triangles, triangles(node, given), 1.0),
        Role::Body => all.with(Quantity::BodyTriangles, BODY_TRIANGLES),
        Role::Texturer => with(all, Quantity::Texels, given.get(Quantity::Pixels), TEXELS_PER_PIXEL),
        _ => all,
    }
}

fn with(size: Size, quantity: Quantity, of: Option<f64>, factor: f64) -> Size {
    match of {
        Some(amount) => size.with(quantity, factor * amount),
        None => size,
    }
}

/// Triangles by the stage's edge length.
fn triangles(node: &Node, given: &Size) -> Option<f64> {
    let fields = fields_of(&node.stage.params());
    let edge: Length = fields.get("edge")?.trim_matches('"').parse().ok()?;
    let edge = EDGE_LENGTHS.contains(&edge.metres()).then(|| edge.metres())?;
    let side = given.get(Quantity::Area)?.sqrt() / edge;
    Some(2.0 * side * side + BAND * side)
}
