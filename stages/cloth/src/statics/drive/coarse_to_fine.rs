//! One try of the static solver, from the coarsest mesh level to the finest.
//!
//! Method: the coarsest level is sewn, then the levels are relaxed from coarse to fine (see `sew`
//! and `drape`). Here are the state of the try, the run of one level and the result. Cost: that of
//! Newton's method on each level (see `newton/to_rest`). Limits: a level that is too coarse for the
//! body or its seams is reported, and the caller tries again on a finer one (see `solve`).

use crate::error::ClothError;
use crate::mesh::Sheet;
use crate::statics::drive::plan::Plan;
use crate::statics::factor::multifrontal::Halt;
use crate::statics::forces::clearance::clearance;
use crate::statics::forces::penetration::pierced;
use crate::statics::forces::seam_force::{SeamForces, widest};
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::levels::assemble::{KEPT_FORCE, strongest};
use crate::statics::levels::cloths::pieces_of;
use crate::statics::newton::to_rest::{NewtonOptions, Outcome, relax};
use crate::statics::report::equilibrium::{Equilibrium, LevelReport, Progress};
use crate::statics::report::error::StaticsError;
use crate::statics::report::intersecting::{Intersections, unsolvable};
use crate::statics::report::unbalanced::unbalanced;
use std::ops::ControlFlow;
use std::time::Instant;
use toile_geometry::Vec3;

/// Greatest number of points of a mesh on which the garment is sewn anew because it still
/// intersects itself on a coarser one. Sewing a larger mesh takes long, and the rest may be
/// resolved while the garment drapes.
const MOST_CROSSED: usize = 4000;

/// The result of a try.
pub(crate) enum Draped {
    Equilibrium(Box<Equilibrium>),
    /// The cloth of a level intersects itself, and the intersections could not be resolved.
    Intersecting(Intersections),
    /// The body passes through a coarse level between its vertices, or the cloth sewn on it stays
    /// intersected.
    TooCoarse {
        /// Points of the next finer level.
        finer: usize,
    },
}

/// The mesh of a level during a run.
#[derive(Clone, Copy)]
pub(crate) struct LevelMesh<'m> {
    /// The level index, from fine to coarse.
    pub(crate) k: usize,
    /// Whether the seams are open, so that every vertex is a node.
    pub(crate) is_open: bool,
    /// The open or sewn sheet.
    pub(crate) sheet: &'m Sheet,
    /// The places that order the elimination.
    pub(crate) layout: &'m [Vec3],
}

/// The state of a try.
pub(crate) struct Solve<'a> {
    pub(crate) plan: &'a Plan<'a>,
    clock: Instant,
    /// The positions of the nodes of the present level, m.
    pub(crate) x: Vec<Vec3>,
    pub(crate) joined_at: Option<f64>,
    /// How deep the final cloth dips into the body between its vertices, where that is known, m.
    pub(crate) dip: Option<f64>,
    pub(crate) reports: Vec<LevelReport>,
    /// Whether cloth passes through cloth while its seams close.
    pub(crate) sews_through: bool,
    /// Crossings of the sewn garment with itself on the coarsest level.
    pub(crate) crossings: usize,
    /// The error of the last state that fell past the body, if any.
    pub(crate) last_fall: Option<StaticsError>,
}

impl<'a> Solve<'a> {
    pub(crate) fn new(plan: &'a Plan<'a>, clock: Instant) -> Self {
        Self {
            plan,
            clock,
            x: vec![],
            joined_at: None,
            dip: None,
            reports: vec![],
            sews_through: false,
            crossings: 0,
            last_fall: None,
        }
    }

    /// Sews the garment and drapes it.
    pub(crate) fn run(mut self, progress: &mut Progress<'_>) -> Result<Draped, StaticsError> {
        self.sew(progress)?;
        let coarsest = self.plan.coarsest_level();
        let sheet = self.plan.pieces[coarsest].sewn_sheet(&self.plan.cloths)?;
        // A finer mesh may resolve the crossings that are left.
        let finer =
            coarsest.checked_sub(1).map(|k| self.plan.pieces[k].points).filter(|n| *n <= MOST_CROSSED);
        if let Some(finer) = finer.filter(|_| self.crossings > 0) {
            return Ok(Draped::TooCoarse { finer });
        }
        match self.pierced(coarsest, &sheet, &self.x) {
            Some(draped) => Ok(draped),
            None => self.drape(progress),
        }
    }

    /// [`Draped::TooCoarse`] if the body passes through level `k` with its nodes at `x`. The finest
    /// level is judged by its final state.
    pub(crate) fn pierced(&self, k: usize, sheet: &Sheet, x: &[Vec3]) -> Option<Draped> {
        let finer = self.plan.pieces.get(k.checked_sub(1)?)?.points;
        let collider = self.plan.body?;
        (pierced(sheet, collider.surface, x) > 0).then_some(Draped::TooCoarse { finer })
    }

    /// The equilibrium of the finest level, with its nodes at `x`.
    pub(crate) fn finish(
        self,
        mut system: System<'_>,
        sheet: &Sheet,
        x: Vec<Vec3>,
    ) -> Result<Equilibrium, StaticsError> {
        system.update_contacts(&x);
        let unbalanced = unbalanced(&system, &system.gradient(&x), &self.plan.pieces[0]);
        let outcome = self.reports.last().map(|r| r.outcome).unwrap_or_default();
        let positions = self.plan.pieces[0].spread(&x);
        let energy = system.stored(&x);
        let depth = || self.plan.body.map_or(0.0, |c| clearance(sheet, c.surface, &x).depth);
        let (pairs, dip) = rayon::join(|| self.crossings(sheet, &x), || self.dip.unwrap_or_else(depth));
        let slides = self.plan.pieces[0].spread(&system.displacements(&x));
        let offsets = self.plan.pieces[0].offsets(&system);
        let (joined_at, levels) = (self.joined_at, self.reports);
        let own = system.get_mut::<SelfContact>().map(|c| &mut c.friction_contacts);
        let friction_contacts = own.map(std::mem::take).unwrap_or_default();
        let state = Equilibrium {
            positions,
            outcome,
            residual: unbalanced.force,
            unbalanced,
            slides,
            folds: system.elastic.held().to_vec(),
            friction_contacts,
            offsets,
            energy,
            dip,
            joined_at,
            levels,
            restarts: 0,
        };
        match pairs {
            0 => Ok(state),
            pairs => Err(StaticsError::Crossing { pairs, state: Box::new(state) }),
        }
    }

    /// Crossings of the sewn finest level with itself, with its nodes at `x`.
    pub(crate) fn crossings(&self, sheet: &Sheet, x: &[Vec3]) -> usize {
        #[cfg(toile_without = "self_contact")]
        return 0;
        #[cfg(not(toile_without = "self_contact"))]
        match self.plan.scene.self_collision {
            true => self.plan.tree(0, sheet, x, false).crossings(x).len(),
            false => 0,
        }
    }

    /// Runs Newton's method on one level until it is at rest or `done`.
    ///
    /// # Errors
    /// Cloth falls past the body, time is over, the caller stops, or a step has no solution.
    pub(crate) fn relax(
        &self,
        mesh: LevelMesh<'_>,
        system: &mut System<'_>,
        x: &mut [Vec3],
        options: &NewtonOptions,
        done: &dyn Fn(&System<'_>, &[Vec3]) -> bool,
        progress: &mut Progress<'_>,
    ) -> Result<LevelReport, StaticsError> {
        let LevelMesh { k, sheet, layout, .. } = mesh;
        let sewing = self.joined_at.is_none() && system.is_sewing();
        let meets = system.get::<SelfContact>().is_some() && !(sewing && self.sews_through);
        let tree = meets.then(|| self.plan.tree(k, sheet, layout, sewing));
        let start = Instant::now();
        let meshes = self.plan.pieces.len();
        let mut report = LevelReport {
            nodes: x.len(),
            sewing,
            gap: 0.0,
            seam: String::new(),
            pass: [meshes - k, meshes],
            outcome: Outcome::default(),
            seconds: 0.0,
        };
        let (mut stop, mut is_late) = (None, false);
        let piece = if self.plan.body_box.is_some() { pieces_of(system) } else { Vec::new() };
        let late = || self.clock.elapsed() > self.plan.settings.budget || self.plan.stopper.is_up();
        let mut watch = |system: &System<'_>, x: &[Vec3], outcome: &Outcome| {
            let seconds = start.elapsed().as_secs_f64();
            let seams = system.get::<SeamForces>().filter(|_| sewing);
            let gap = seams.map_or(0.0, |s| s.widest(x));
            report.seam = if gap > 0.0 { self.widest_seam(k, x) } else { String::new() };
            (report.gap, report.outcome, report.seconds) = (gap, *outcome, seconds);
            stop = self.fallen(k, system, sheet, x, &piece);
            let positions = || self.positions(mesh, x);
            if stop.is_none() && progress(&report, &positions).is_break() {
                stop = Some(StaticsError::Stopped);
            }
            is_late = late();
            if stop.is_some() || is_late || done(system, x) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        match relax(system, layout, tree, x, options, &mut watch, &late) {
            Ok(outcome) => report.outcome = outcome,
            Err(Halt::NotPositive(error)) => return Err(self.unsolvable(mesh, error.node, x)),
            Err(Halt::Stopped) => is_late = true,
        }
        match stop {
            Some(error) => Err(error),
            None if self.plan.stopper.is_up() => Err(StaticsError::Stopped),
            None if is_late => Err(self.timeout(mesh, x)),
            None => Ok(report),
        }
    }

    /// The error of a step of a level from `x` that has no solution near `node`.
    fn unsolvable(&self, mesh: LevelMesh<'_>, node: u32, x: &[Vec3]) -> StaticsError {
        let of_node = || self.plan.pieces[mesh.k].node.iter().position(|n| *n == node).unwrap_or(0);
        let vertex = if mesh.is_open { node as usize } else { of_node() };
        unsolvable(self.plan.scene, self.plan.finest_of(mesh.k, vertex as u32) as usize, &x[node as usize])
    }

    /// The error of a level that is out of time with its nodes at `x`.
    fn timeout(&self, mesh: LevelMesh<'_>, x: &[Vec3]) -> StaticsError {
        let (seconds, levels) = (self.clock.elapsed().as_secs_f64(), self.plan.pieces.len());
        StaticsError::Timeout { seconds, level: levels - mesh.k, levels, positions: self.positions(mesh, x) }
    }

    /// The positions of the finest vertices, from those of a level's nodes.
    fn positions(&self, mesh: LevelMesh<'_>, x: &[Vec3]) -> Vec<Vec3> {
        let vertices = if mesh.is_open { x.to_vec() } else { self.plan.pieces[mesh.k].spread(x) };
        self.prolonged(mesh.k, vertices)
    }

    /// The positions of the vertices of level `k`, prolonged to the finest vertices.
    pub(crate) fn prolonged(&self, k: usize, vertices: Vec<Vec3>) -> Vec<Vec3> {
        self.plan.coarser[..k].iter().rev().fold(vertices, |v, c| c.prolong(&v))
    }

    /// Refuses seams that are not joined and are open in the final state.
    pub(crate) fn check_kept(&self, x: &[Vec3]) -> Result<(), StaticsError> {
        let gap = widest(x, &self.plan.pieces[0].kept_pairs());
        if gap <= self.plan.settings.join_gap {
            return Ok(());
        }
        let positions = self.plan.pieces[0].spread(x);
        let seam = self.widest_seam(0, &positions);
        let force = KEPT_FORCE * strongest(&self.plan.cloths);
        Err(StaticsError::SeamNotClosed { seam, gap, force, reversed: vec![], positions })
    }

    /// Refuses cloth that is strained beyond its limit.
    pub(crate) fn check_strain(&self, sheet: &Sheet, x: &[Vec3]) -> Result<(), StaticsError> {
        match self.plan.scene.strain_limit.and_then(|l| sheet.over(x, [l.weft, l.warp])) {
            Some((index, strain, limit)) => {
                Err(ClothError::StrainLimitExceeded { index, strain, limit }.into())
            }
            None => Ok(()),
        }
    }
}
