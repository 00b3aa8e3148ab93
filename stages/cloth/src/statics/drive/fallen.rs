//! Tells cloth that has fallen past the body from cloth that is still falling onto it.
//!
//! Method: see `contact/past`. Cost: O(n) a step.

use crate::contact::past::{Fallen, Start, list};
use crate::mesh::Sheet;
use crate::scene::Scene;
use crate::statics::drive::coarse_to_fine::Solve;
use crate::statics::forces::system::System;
use crate::statics::levels::cloths::pieces_of_scene;
use crate::statics::report::error::StaticsError;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The panels that have fallen, as a list for messages.
pub(crate) fn list_of(scene: &Scene, is_fallen: &[bool]) -> String {
    let count = |p: &crate::scene::Panel| is_fallen[p.vertices.clone()].iter().filter(|f| **f).count();
    let panels = scene.panels.iter().map(|p| (p.name.as_str(), count(p), p.vertices.len()));
    list(&panels.filter(|(_, fallen, _)| *fallen > 0).collect::<Vec<_>>())
}

impl Solve<'_> {
    /// The error of cloth that has fallen past the body, if any node of level `k` at `x` has.
    /// `piece` is the piece of each node.
    pub(crate) fn fallen(
        &self,
        k: usize,
        system: &System<'_>,
        sheet: &Sheet,
        x: &[Vec3],
        piece: &[u32],
    ) -> Option<StaticsError> {
        let body =
            self.plan.body_box.filter(|_| system.loads.gravity != Vec3::zeros() && piece.len() == x.len())?;
        let past = body.past(x, piece, &system.pinned);
        let is_past = |n: usize| past.get(piece[n] as usize).copied().unwrap_or(false);
        if past.is_empty() {
            return None;
        }
        let node = &self.plan.pieces[k].node;
        // Pieces of the scene, with all vertices: a coarse level keeps only some of them.
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
        Some(StaticsError::FallsPast(Box::new(Fallen {
            cloth: list_of(self.plan.scene, &is_fallen),
            start,
            body: body.height(),
            is_certain: start != Start::Around
                || !self.plan.settings.bending_continuation && body.resolves(edge),
        })))
    }
}
