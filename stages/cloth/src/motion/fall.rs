//! A fall past the body ends a motion. Cost: O(n) a check.

use super::Vec3;
use super::moving::Moving;
use crate::contact::past::{BodyBox, Fallen, NO_PIECE};
use crate::scene::Scene;
use crate::statics::drive::fallen::list_of;
use crate::statics::drive::solve::Collider;
use crate::statics::levels::cloths::pieces_of_scene;
use crate::statics::levels::pieces::Pieces;

/// What detects a fall.
pub(super) struct Falls {
    body: BodyBox,
    /// The piece of each vertex, and of each node once seams are joined, with what is pinned.
    open: (Vec<u32>, Vec<bool>),
    joined: (Vec<u32>, Vec<bool>),
}

impl Falls {
    /// The detector of a scene on a body; `None` without a body or without gravity in the last
    /// phase.
    pub(super) fn of(scene: &Scene, collider: Option<Collider<'_>>, pieces: &Pieces) -> Option<Self> {
        let gravity = scene.phases.last().map(|p| p.gravity).unwrap_or_default();
        let body = collider.and_then(|c| BodyBox::of(c.surface, &gravity))?;
        let open = (pieces_of_scene(scene), pieces.pinned.clone());
        let mut joined = (vec![NO_PIECE; pieces.nodes], vec![false; pieces.nodes]);
        for (v, &n) in pieces.node.iter().enumerate() {
            joined.0[n as usize] = joined.0[n as usize].min(open.0[v]);
            joined.1[n as usize] |= open.1[v];
        }
        Some(Self { body, open, joined })
    }

    /// The cloth that is past the body, if any.
    pub(super) fn look(&self, scene: &Scene, moving: &Moving) -> Option<Fallen> {
        let (piece, held) = if moving.is_joined { &self.joined } else { &self.open };
        if !moving.has_weight() || piece.len() != moving.state.x.len() {
            return None;
        }
        let past = self.body.past(&moving.state.x, piece, held);
        if past.is_empty() {
            return None;
        }
        let is_past = |p: &u32| past.get(*p as usize).copied().unwrap_or(false);
        let is_fallen: Vec<bool> = self.open.0.iter().map(is_past).collect();
        let of: Vec<Vec3> =
            scene.positions.iter().zip(&is_fallen).filter(|(_, f)| **f).map(|(p, _)| *p).collect();
        Some(Fallen {
            cloth: list_of(scene, &is_fallen),
            start: self.body.start(&of),
            body: self.body.height(),
            is_certain: true,
        })
    }
}
