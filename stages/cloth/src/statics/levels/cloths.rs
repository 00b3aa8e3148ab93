//! The connected pieces of cloth, each of which may fall by itself. Cost: O(n).

use crate::contact::past::NO_PIECE;
use crate::scene::Scene;
use crate::statics::forces::system::System;
use toile_geometry::components::groups;

/// The piece of each node of a system.
pub(crate) fn pieces_of(system: &System<'_>) -> Vec<u32> {
    let (mut piece, _) = groups(system.loads.masses.len(), system.links().into_iter());
    piece.iter_mut().zip(&system.loads.masses).filter(|(_, m)| **m == 0.0).for_each(|(p, _)| *p = NO_PIECE);
    piece
}

/// The piece of each vertex of a scene, connected by triangles and seams.
pub(crate) fn pieces_of_scene(scene: &Scene) -> Vec<u32> {
    let n = scene.rest.len();
    let sides = scene.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]);
    let (mut piece, _) = groups(n, sides.chain(scene.seams.iter().flat_map(|s| &s.pairs).copied()));
    let mut is_cloth = vec![false; n];
    scene.triangles.iter().flatten().for_each(|&v| is_cloth[v as usize] = true);
    piece.iter_mut().zip(&is_cloth).filter(|(_, c)| !**c).for_each(|(p, _)| *p = NO_PIECE);
    piece
}
