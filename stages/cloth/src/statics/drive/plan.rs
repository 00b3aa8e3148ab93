//! What a way to rest is laid out on, before anything moves: the levels, from the cut pieces to the
//! coarsest mesh.

use crate::contact::past::BodyBox;
use crate::contact::skin::CollisionSurface;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use crate::scene::Scene;
use crate::statics::levels::assemble::{Collider, assemble, cloths, gravity, kept_seam_forces};
use crate::statics::levels::bending_continuation::{BendingContinuation, EDGES, EDGES_THROUGH};
use crate::statics::levels::coarsen::{Coarser, coarsen};
use crate::statics::levels::mesh_level::Level;
use crate::statics::levels::pieces::Pieces;
use crate::statics::newton::settings::StaticEquilibrium;
use crate::statics::newton::stack::stack_size;
use crate::statics::report::error::StaticsError;
use crate::statics::report::start::{crossing, crossings_at_start};
use crate::stopper::Stopper;
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;

type Vec3 = Vector3<f64>;

/// The levels of a scene. Nothing of it changes on the way, so a finer level can be made ready
/// while a coarser one moves.
pub(crate) struct Plan<'a> {
    pub(crate) settings: &'a StaticEquilibrium,
    pub(crate) scene: &'a Scene,
    pub(crate) body: Option<Collider<'a>>,
    /// What keeps cloth out while it is sewn, one after the other; the body where there is nothing
    /// else.
    pub(crate) around: &'a [&'a dyn CollisionSurface],
    /// Says whether the caller wants to stop.
    pub(crate) stopper: &'a Stopper,
    /// The box around the body, where there is one and the cloth has weight.
    pub(crate) body_box: Option<BodyBox>,
    /// What no panel and what each panel is made of.
    pub(crate) cloths: Vec<&'a Fabric>,
    /// Whether many cloths lie on each other.
    pub(crate) is_stack: bool,
    /// Fine to coarse.
    pub(crate) pieces: Vec<Pieces>,
    /// How each level but the finest was made from the finer one.
    pub(crate) coarser: Vec<Coarser>,
    /// Where the vertices of each level start.
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
        let body_box = body.and_then(|w| BodyBox::of(w.skin, &gravity(scene)));
        let (mut pieces, mut coarser) = levels(scene, coarsest);
        let mut starts = vec![start.to_vec()];
        for level in &coarser {
            let finer = &starts[starts.len() - 1];
            starts.push(level.kept.iter().map(|&v| finer[v as usize]).collect());
        }
        // A coarse mesh cannot follow a pleat: it starts where no cloth crosses.
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
        // A collider may stand for no body.
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

    /// What keeps cloth out while its seams close.
    pub(crate) fn sewn_on(&self) -> Option<Collider<'a>> {
        self.body.map(|w| Collider { skin: self.around.first().copied().unwrap_or(w.skin), ..w })
    }

    /// Mean length of the edges of the coarsest level, m.
    pub(crate) fn edge(&self) -> f64 {
        let Some(coarsest) = self.pieces.last() else { return 0.0 };
        let at = |v: u32| coarsest.rest[v as usize];
        let sides =
            coarsest.triangles.iter().flat_map(|t| (0..3).map(|k| (at(t[k]) - at(t[(k + 1) % 3])).norm()));
        sides.sum::<f64>() / (3 * coarsest.triangles.len()).max(1) as f64
    }

    /// The vertex of the finest level that vertex `v` of level `k` is.
    pub(crate) fn finest_of(&self, k: usize, v: u32) -> u32 {
        self.coarser[..k].iter().rev().fold(v, |v, c| c.kept[v as usize])
    }

    /// Points of the level that is finer than the coarsest, if there is one.
    pub(crate) fn second(&self) -> Option<usize> {
        self.pieces.len().checked_sub(2).map(|k| self.pieces[k].points)
    }

    /// How bending is let go in a garment of that size, if it is.
    pub(crate) fn continuation(&self, size: f64) -> Option<BendingContinuation> {
        let gravity = gravity(self.scene).norm();
        let edges = if self.settings.sew_through { EDGES_THROUGH } else { EDGES };
        self.settings
            .bending_continuation
            .then(|| BendingContinuation::of(&self.cloths, gravity, size, edges))
            .flatten()
    }

    /// Level `k`, sewn, with its nodes nowhere yet.
    pub(crate) fn level(&self, k: usize) -> Result<Level<'a>, StaticsError> {
        let pieces = &self.pieces[k];
        let sheet = pieces.sewn_sheet(&self.cloths)?;
        let layout = pieces.sew(&self.starts[k], &vec![1.0; self.starts[k].len()]);
        let mut system = assemble(self.scene, self.body, pieces, &sheet, false, self.settings.models)?;
        system.seam_forces = kept_seam_forces(self.scene, pieces, self.settings.join_gap);
        system.self_contact.iter_mut().for_each(|c| c.stacked = self.is_stack);
        if let (true, true, Some(s)) = (self.settings.bending_continuation, k > 0, &mut system.body_contact) {
            // Offsets that grow with the edges of a passing state would shake the cloth, and with
            // it the choice of folds.
            s.edges.clear();
        }
        system.body_contact.iter_mut().for_each(|s| s.hard = self.settings.sew_through);
        Ok(Level { system, sheet, layout, x: Vec::new(), friction: None })
    }

    /// The tree of a level; what thread holds together is no obstacle to itself.
    pub(crate) fn tree(&self, sheet: &Sheet, layout: &[Vec3], sewing: bool) -> ClothTree {
        let tree = ClothTree::new(sheet.triangles(), layout);
        let kept = || self.scene.seams.iter().any(|s| !s.joined);
        let nodes = |p: &Pieces| if sewing { p.rest.len() } else { p.nodes };
        match self.pieces.iter().rev().find(|p| nodes(p) == layout.len()) {
            Some(p) if sewing => tree.sewing(p.point.clone()),
            Some(p) if kept() => tree.sewing(p.node_points()),
            _ => tree,
        }
    }

    /// Values at the nodes of level `k` carried to those of the next finer one.
    pub(crate) fn finer(&self, k: usize, values: &[Vec3]) -> Vec<Vec3> {
        let fine = self.coarser[k - 1].prolong(&self.pieces[k].spread(values));
        self.pieces[k - 1].sew(&fine, &vec![1.0; fine.len()])
    }
}

/// The pieces of a scene and coarser ones, fine to coarse, and how each of those was made.
fn levels(scene: &Scene, coarsest: usize) -> (Vec<Pieces>, Vec<Coarser>) {
    let (mut pieces, mut coarser) = (vec![Pieces::new(scene)], Vec::new());
    while let Some(next) = pieces.last().filter(|p| p.points > coarsest).and_then(coarsen) {
        pieces.push(next.pieces.clone());
        coarser.push(next);
    }
    (pieces, coarser)
}
