//! How far a garment is from another of the same cloth.
//!
//! Vertices are matched by their place in the flat panel, since a draft and a full run have
//! different meshes. Panels that only one of them has, and cloth that only one pattern has, count
//! for nothing.

use toile_core::artifact::{Garment, GarmentPanel, Locator, Point2};

/// Cloth that lies farther than this beyond the other's panel, metres, is not looked for in it.
const REACH: f64 = 5e-3;

/// The largest move of a place on the cloth, metres; none where no place is in both.
pub(super) fn largest_move(before: &Garment, now: &Garment) -> Option<f64> {
    let of_panel = |panel: &GarmentPanel| {
        let other = before.panels.iter().find(|p| p.name == panel.name)?;
        moved(before, other, now, panel)
    };
    now.panels.iter().filter_map(of_panel).reduce(f64::max)
}

fn moved(before: &Garment, other: &GarmentPanel, now: &Garment, panel: &GarmentPanel) -> Option<f64> {
    let triangles = before.triangles.get(other.triangles.clone())?;
    let flat = |t: &[u32; 3]| -> Option<[Point2; 3]> {
        let at = |k: usize| before.rest.get(t[k] as usize).copied();
        Some([at(0)?, at(1)?, at(2)?])
    };
    let locator = Locator::new(triangles.iter().map(flat).collect::<Option<_>>()?, REACH)?;
    let places = panel.vertices.clone().filter_map(|v| Some((now.rest.get(v)?, now.positions.get(v)?)));
    let far = places.filter_map(|(rest, position)| {
        let found = locator.find(*rest)?;
        let corners = triangles.get(found.triangle)?.map(|i| before.positions[i as usize]);
        Some((found.in_space(corners) - position).norm())
    });
    far.reduce(f64::max)
}
