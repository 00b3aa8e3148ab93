//! Tells cloth that has fallen past the body from cloth that is on its way.

use super::error::RestError;
use super::system::System;
use super::work::Work;
use crate::contact::past::{Fallen, NO_PIECE, Start, list};
use crate::mesh::Sheet;
use crate::scene::Scene;
use nalgebra::Vector3;
use toile_geometry::components::groups;

type Vec3 = Vector3<f64>;

/// The piece of cloth that each node of a system belongs to.
pub(super) fn pieces_of(system: &System<'_>) -> Vec<u32> {
    let (mut piece, _) = groups(system.masses.len(), system.links().into_iter());
    piece.iter_mut().zip(&system.masses).filter(|(_, m)| **m == 0.0).for_each(|(p, _)| *p = NO_PIECE);
    piece
}

/// The piece of cloth that each vertex of a scene belongs to: what hangs together by triangles and seams.
pub(crate) fn pieces_of_scene(scene: &Scene) -> Vec<u32> {
    let n = scene.rest.len();
    let sides = scene.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]);
    let (mut piece, _) = groups(n, sides.chain(scene.seams.iter().flat_map(|s| &s.pairs).copied()));
    let mut is_cloth = vec![false; n];
    scene.triangles.iter().flatten().for_each(|&v| is_cloth[v as usize] = true);
    piece.iter_mut().zip(&is_cloth).filter(|(_, c)| !**c).for_each(|(p, _)| *p = NO_PIECE);
    piece
}

/// The panels of a scene's vertices that have fallen, as a list for people.
pub(crate) fn list_of(scene: &Scene, is_fallen: &[bool]) -> String {
    let count = |p: &crate::scene::Panel| is_fallen[p.vertices.clone()].iter().filter(|f| **f).count();
    let panels = scene.panels.iter().map(|p| (p.name.as_str(), count(p), p.vertices.len()));
    list(&panels.filter(|(_, fallen, _)| *fallen > 0).collect::<Vec<_>>())
}

impl Work<'_> {
    /// The error of cloth that is past the body, if any of a level's nodes at `x` is. `piece` is that of each node.
    pub(super) fn fallen(
        &self,
        system: &System<'_>,
        sheet: &Sheet,
        x: &[Vec3],
        piece: &[u32],
    ) -> Option<RestError> {
        let body =
            self.plan.body_box.filter(|_| system.gravity != Vec3::zeros() && piece.len() == x.len())?;
        let past = body.past(x, piece, &system.pinned);
        let is_past = |n: usize| past.get(piece[n] as usize).copied().unwrap_or(false);
        if past.is_empty() {
            return None;
        }
        let k = self.level_of(x);
        let node = &self.plan.pieces[k].node;
        // A piece of the scene, whose vertices are all of it: a coarse level keeps some of them.
        let whole = pieces_of_scene(self.plan.scene);
        let mut fallen: Vec<u32> = (0..node.len())
            .filter(|&v| is_past(node[v] as usize))
            .map(|v| whole[self.plan.finest_of(k, v as u32) as usize])
            .collect();
        fallen.sort_unstable();
        fallen.dedup();
        let is_fallen: Vec<bool> = whole.iter().map(|p| fallen.binary_search(p).is_ok()).collect();
        let of = self.plan.starts[0].iter().zip(&is_fallen).filter(|(_, f)| **f);
        let start = body.start(&of.map(|(p, _)| *p).collect::<Vec<_>>());
        let edges = sheet.edges();
        let edge = edges.iter().map(|e| e.rest_length).sum::<f64>() / edges.len().max(1) as f64;
        Some(RestError::FallsPast(Box::new(Fallen {
            cloth: list_of(self.plan.scene, &is_fallen),
            start,
            body: body.height(),
            is_certain: start != Start::Around || !self.plan.rest.graded && body.resolves(edge),
        })))
    }
}
