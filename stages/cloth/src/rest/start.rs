//! Where the cloth starts: outside the body, and through no other cloth.

use super::assemble::{Wearer, cloths};
use super::error::RestError;
use super::layers::Layers;
use super::pieces::Pieces;
use crate::contact::start;
use crate::contact::tree::ClothTree;
use crate::error::ClothError;
use crate::scene::Scene;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Crossings of a level before it is sewn; none where they do not matter.
pub(super) fn crossings_at_start(
    scene: &Scene,
    pieces: &Pieces,
    start: &[Vec3],
) -> Result<usize, ClothError> {
    if !scene.self_collision {
        return Ok(0);
    }
    let sheet = pieces.open_sheet(&cloths(scene))?;
    let tree = ClothTree::new(&sheet, start).sewing(pieces.point.clone());
    Ok(unordered(scene, pieces, &tree.crossings(start)))
}

/// Crossings of vertices of one layer: those of two layers are resolved by their order.
fn unordered(scene: &Scene, pieces: &Pieces, crossings: &[([u32; 2], [u32; 3])]) -> usize {
    let of = |&p: &u32| (p as usize).checked_sub(1).map_or(0, |k| scene.panels[k].layer);
    let layers = Layers { order: pieces.panel.iter().map(of).collect(), ..Layers::default() };
    layers.unordered(crossings)
}

/// The start with vertices that lie a little inside the body moved out.
pub(super) fn clear_start(scene: &Scene, body: Option<Wearer<'_>>) -> Result<Vec<Vec3>, RestError> {
    let Some(body) = body else { return Ok(scene.positions.clone()) };
    Ok(start::clear_start(&scene.positions, body.skin, scene.material.thickness)?)
}
