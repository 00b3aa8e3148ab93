//! The plan of one try: the mesh levels of a scene, from the cut pieces to the coarsest mesh.
//!
//! Method: each level is coarsened from the finer one (see `levels/coarsen`) until it has few
//! enough points; levels whose cloth intersects itself at the start are dropped. Cost: O(n log n).

use crate::contact::collision_surface::CollisionSurface;
use crate::contact::past::BodyBox;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use crate::scene::Scene;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::levels::assemble::{Collider, assemble, cloths, gravity, kept_seam_forces};
use crate::statics::levels::bending_continuation::{BendingContinuation, EDGES, EDGES_THROUGH};
use crate::statics::levels::coarsen::{Coarser, levels};
use crate::statics::levels::mesh_level::Level;
use crate::statics::levels::pieces::Pieces;
use crate::statics::newton::sequential_start::stack_size;
use crate::statics::newton::settings::StaticEquilibrium;
use crate::statics::report::error::StaticsError;
use crate::statics::report::start::{crossing, crossings_at_start};
use crate::stopper::Stopper;
use toile_geometry::{Vec3, cloth_tree::ClothTree};

/// The levels of a scene. A plan does not change, so that a finer level can be prepared while a
/// coarser one is solved.
pub(crate) struct Plan<'a> {
    pub(crate) settings: &'a StaticEquilibrium,
    pub(crate) scene: &'a Scene,
    pub(crate) body: Option<Collider<'a>>,
    /// The solids on which the cloth is sewn, one after the other; empty for the body alone.
    pub(crate) around: &'a [&'a dyn CollisionSurface],
    /// Whether the caller has asked to stop.
    pub(crate) stopper: &'a Stopper,
    /// The bounding box of the body, if there is one and the cloth has weight.
    pub(crate) body_box: Option<BodyBox>,
    /// The fabric of vertices without a panel, then that of each panel.
    pub(crate) cloths: Vec<&'a Fabric>,
    /// Whether many cloths lie on each other.
    pub(crate) is_stack: bool,
    /// The pieces of each level, from fine to coarse.
    pub(crate) pieces: Vec<Pieces>,
    /// How each level but the finest was coarsened from the finer one.
    pub(crate) coarser: Vec<Coarser>,
    /// The initial positions of the vertices of each level, m.
    pub(crate) starts: Vec<Vec<Vec3>>,
}

impl<'a> Plan<'a> {
    /// Levels down to one of about `coarsest` nodes, of a scene whose vertices begin at `start`.
    pub(crate) fn new(
        settings: &'a StaticEquilibrium,
        coarsest: usize,
        scene: &'a Scene,
        body: Option<Collider<'a>>,
        around: &'a [&'a dyn CollisionSurface],
        stopper: &'a Stopper,
        start: &[Vec3],
    ) -> Result<Self, StaticsError> {
        let body_box = body.and_then(|c| BodyBox::of(c.surface, &gravity(scene)));
        let (mut pieces, mut coarser) = levels(scene, coarsest);
        let mut starts = vec![start.to_vec()];
        for level in &coarser {
            let finer = &starts[starts.len() - 1];
            starts.push(level.kept.iter().map(|&v| finer[v as usize]).collect());
        }
        // A coarse mesh cannot follow a pleat: the coarsest level must start without crossings.
        while let (Some(coarse), Some(start)) = (pieces.last(), starts.last()) {
            if settings.sew_through {
                break;
            }
            let crossings = crossings_at_start(scene, coarse, start)?;
            let Some(error) = crossing(scene, &coarse.panel, start, &crossings) else { break };
            if coarser.pop().is_none() {
                return Err(error.into());
            }
            pieces.pop();
            starts.pop();
        }
        // A collider may have no surface.
        if scene.pinned.is_empty() && body_box.is_none() && gravity(scene).norm() > 0.0 {
            return Err(StaticsError::Falls);
        }
        let (cloths, is_stack) = (cloths(scene), stack_size(scene).is_some());
        Ok(Self {
            settings,
            scene,
            body,
            around,
            stopper,
            body_box,
            cloths,
            is_stack,
            pieces,
            coarser,
            starts,
        })
    }

    /// The level index of the coarsest level.
    pub(crate) fn coarsest_level(&self) -> usize {
        self.pieces.len() - 1
    }

    /// The collider while the seams close.
    pub(crate) fn sewn_on(&self) -> Option<Collider<'a>> {
        self.body.map(|c| Collider { surface: self.around.first().copied().unwrap_or(c.surface), ..c })
    }

    /// Mean length of the edges of the coarsest level, m.
    pub(crate) fn edge(&self) -> f64 {
        let Some(coarsest) = self.pieces.last() else { return 0.0 };
        let at = |v: u32| coarsest.rest[v as usize];
        let sides =
            coarsest.triangles.iter().flat_map(|t| (0..3).map(|k| (at(t[k]) - at(t[(k + 1) % 3])).norm()));
        sides.sum::<f64>() / (3 * coarsest.triangles.len()).max(1) as f64
    }

    /// The vertex of the finest level that is vertex `v` of level `k`.
    pub(crate) fn finest_of(&self, k: usize, v: u32) -> u32 {
        self.coarser[..k].iter().rev().fold(v, |v, c| c.kept[v as usize])
    }

    /// Points of the level next to the coarsest, if there is one.
    pub(crate) fn second(&self) -> Option<usize> {
        self.pieces.len().checked_sub(2).map(|k| self.pieces[k].points)
    }

    /// The bending continuation of a garment of that size, if it is enabled.
    pub(crate) fn continuation(&self, size: f64) -> Option<BendingContinuation> {
        let gravity = gravity(self.scene).norm();
        let edges = if self.settings.sew_through { EDGES_THROUGH } else { EDGES };
        self.settings
            .bending_continuation
            .then(|| BendingContinuation::of(&self.cloths, gravity, size, edges))
            .flatten()
    }

    /// Level `k`, sewn, without positions of its nodes.
    pub(crate) fn level(&self, k: usize) -> Result<Level<'a>, StaticsError> {
        let pieces = &self.pieces[k];
        let sheet = pieces.sewn_sheet(&self.cloths)?;
        let layout = pieces.sew(&self.starts[k], &vec![1.0; self.starts[k].len()]);
        let mut system = assemble(self.scene, self.body, pieces, &sheet, false, self.settings.models)?;
        system.set_seam_forces(kept_seam_forces(self.scene, pieces, self.settings.join_gap));
        system.get_mut::<SelfContact>().into_iter().for_each(|c| c.stacked = self.is_stack);
        if let Some(contact) = system.get_mut::<BodyContact>() {
            contact.stiffens_inside = self.settings.sew_through;
            if self.settings.bending_continuation && k > 0 {
                // Offsets that grow in an intermediate state would move the cloth, and so change
                // which folds form.
                contact.edges.clear();
            }
        }
        Ok(Level { system, sheet, layout, x: Vec::new(), is_frictionless: false })
    }

    /// The tree of level `k`, while it is sewn or after. The two sides of a seam are no obstacle to
    /// each other.
    pub(crate) fn tree(&self, k: usize, sheet: &Sheet, layout: &[Vec3], sewing: bool) -> ClothTree {
        let tree = ClothTree::new(sheet.triangles(), layout);
        let kept = || self.scene.seams.iter().any(|s| !s.joined);
        match &self.pieces[k] {
            p if sewing => tree.sewing(p.point.clone()),
            p if kept() => tree.sewing(p.node_points()),
            _ => tree,
        }
    }

    /// Values at the nodes of level `k` carried to those of the next finer one.
    pub(crate) fn finer(&self, k: usize, values: &[Vec3]) -> Vec<Vec3> {
        let fine = self.coarser[k - 1].prolong(&self.pieces[k].spread(values));
        self.pieces[k - 1].sew(&fine, &vec![1.0; fine.len()])
    }
}
