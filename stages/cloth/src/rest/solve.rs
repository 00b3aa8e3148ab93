//! `Rest`: a whole scene straight to static equilibrium.
//!
//! Method: panels are coarsened; the coarsest level is sewn (seams pull with a force that hardly depends on their gap,
//! without weight, until they meet; then each pair becomes one node, so the gap is exactly zero) and draped; each finer
//! level starts from the coarser one's state, carried over by the triangles that its vertices lie in at rest. So the fall
//! and the sewing happen where steps cost milliseconds, and the finest level only settles.
//!
//! Where the coarsest level shows itself too coarse (a seam stays open, layers tangle, a limb comes through a triangle: see
//! `pierce`), the garment is sewn again on the next finer one.
//!
//! Where the body would keep seams open, the coarsest level may be sewn on other solids (see [`Rest::solve_around`]).
//!
//! With [`Rest::from_here`] there are no coarser levels: cloth that hangs already settles where it is.
//!
//! With [`Rest::graded`] bending starts stiff and is let go on the way (see `graded`), so that chance has less of a say.
//!
//! Cost: some 35 to 150 factorizations of the finest level (docs/log/2026-11-23-rest-speed.md). Limits: what the coarse level cannot see (a fold finer than its
//! mesh) must form on finer levels; one out of many equilibria is found, as friction and folds have many.

pub use super::assemble::Wearer;
use super::assemble::gravity;
pub use super::error::RestError;
use super::graded::COARSEST;
use super::grip::Grip;
use super::newton::Outcome;
use super::pieces::Pieces;
use super::pile::pile_of;
use super::plan::Plan;
pub use super::real::Precision;
pub use super::start::StartError;
use super::start::{check, check_lying, moved_out};
pub use super::tangled::Load;
use super::tangled::tangled;
use super::unrest::Unbalanced;
use super::work::{Draped, Work};
use crate::contact::body::Body;
use crate::contact::skin::Skin;
use crate::energy::Models;
use crate::scene::{Panel, Scene};
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

type Vec3 = Vector3<f64>;

/// Settings of the rest solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Membrane and bending.
    pub models: Models,
    /// Speed that cloth at rest must not gain in a sixtieth of a second, m/s.
    pub speed: f64,
    /// The share of the vertices that may gain more: some never come to rest where the skin of a body folds.
    pub non_static: f64,
    /// The coarsest level has at most about this many nodes.
    pub coarsest: usize,
    /// Steps on each level but the finest.
    pub coarse_steps: usize,
    /// Steps on the finest level before giving up.
    pub finest_steps: usize,
    /// Seams are joined when their gaps are below this, m.
    pub join_gap: f64,
    /// Wall time before giving up.
    pub budget: Duration,
    /// Whether bending starts far too stiff and is let go level by level, so that the state of rest hardly depends on where the
    /// cloth began.
    pub graded: bool,
    /// Whether the cloth goes on from where it is, on its own mesh alone: what came to rest on a coarser mesh keeps its folds.
    pub from_here: bool,
    /// Whether cloth passes through cloth while its seams close: what lies in its way does not keep them open, and the sewn
    /// garment is taken out of itself.
    pub sew_through: bool,
    /// Whether a step of a tenth of a second and more in which nothing is faster than `speed` proves rest, too.
    pub long_proof: bool,
    /// How precise the factor of each step is.
    pub precision: Precision,
    /// Whether what rests sleeps while few nodes move, which settle by themselves.
    pub asleep: bool,
}

impl Default for Rest {
    fn default() -> Self {
        Self {
            models: Models::STATIC,
            speed: 1e-3,
            non_static: 0.0,
            coarsest: 200,
            coarse_steps: 30,
            finest_steps: 500,
            join_gap: 5e-4,
            budget: Duration::from_secs(600),
            graded: false,
            from_here: false,
            sew_through: false,
            long_proof: false,
            precision: Precision::default(),
            asleep: true,
        }
    }
}

/// What one level did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelReport {
    /// Its nodes.
    pub nodes: usize,
    /// Whether seams were open.
    pub sewing: bool,
    /// How it ended.
    pub outcome: Outcome,
    /// Wall time, s.
    pub seconds: f64,
}

/// A garment at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Rested {
    /// Position of every vertex of the scene, m.
    pub positions: Vec<Vec3>,
    /// How the finest level ended.
    pub outcome: Outcome,
    /// Greatest force left on a node, N.
    pub residual: f64,
    /// Where that is, and what the cloth meets there.
    pub unbalanced: Unbalanced,
    /// How far friction holds each vertex back, m: what [`Live`](super::live::Live) goes on from.
    pub slides: Vec<Vec3>,
    /// Angles at which friction between yarns holds the folds, by hinges of the sewn garment: what `Live` goes on from.
    pub folds: Vec<f64>,
    /// Friction of every contact of cloth with cloth, by sewn points: what `Live` goes on from.
    pub grips: Vec<Grip>,
    /// Distance at which the body begins to press on each vertex, m; none without a body.
    pub offsets: Vec<f64>,
    /// Elastic and gravitational energy, J.
    pub energy: f64,
    /// Deepest point inside the body between vertices, m; 0 unless the body has edges sharper than the mesh can follow.
    pub dip: f64,
    /// Widest seam when it was joined, m; nothing where there are none.
    pub joined_at: Option<f64>,
    /// Every level, coarse to fine, of the try that came to its end.
    pub levels: Vec<LevelReport>,
    /// How often the garment was begun again, each time on a finer coarsest mesh, or once without grading.
    pub restarts: usize,
}

/// What a caller learns while solving; it may stop the solver.
pub type Progress<'p> = dyn FnMut(&LevelReport) -> ControlFlow<()> + 'p;

impl Rest {
    /// Solves `scene`; `progress` hears of every step.
    ///
    /// # Errors
    /// Every [`RestError`].
    pub fn solve(&self, scene: &Scene, progress: &mut Progress<'_>) -> Result<Rested, RestError> {
        #[cfg(not(toile_without = "body"))]
        let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
        #[cfg(not(toile_without = "body"))]
        let wearer = body.as_ref().map(|(body, friction)| Wearer { skin: body, friction: *friction });
        #[cfg(toile_without = "body")]
        let wearer = None;
        self.solve_on(scene, wearer, progress)
    }

    /// Solves `scene` on a body that answers for itself; the scene's own body is not looked at.
    ///
    /// # Errors
    /// Every [`RestError`].
    pub fn solve_on(
        &self,
        scene: &Scene,
        wearer: Option<Wearer<'_>>,
        progress: &mut Progress<'_>,
    ) -> Result<Rested, RestError> {
        self.solve_around(scene, wearer, &[], progress)
    }

    /// The same, sewn on other solids before the body comes: seams close on the first of `around`, then each of the others pushes the
    /// sewn cloth out of itself, and the body as the last; on the first and on the body the cloth slides to where it fits. For
    /// [`Rest::sew_through`], where the body keeps seams open.
    ///
    /// # Errors
    /// Every [`RestError`].
    pub fn solve_around(
        &self,
        scene: &Scene,
        wearer: Option<Wearer<'_>>,
        around: &[&dyn Skin],
        progress: &mut Progress<'_>,
    ) -> Result<Rested, RestError> {
        let clock = Instant::now();
        scene.check()?;
        scene.check_still()?;
        let pile = pile_of(scene);
        let mut rest = Self { graded: self.graded && !self.from_here && pile.is_none(), ..*self };
        let start = match self.sew_through {
            true => moved_out::<RestError>(
                scene,
                around.first().copied().or(wearer.map(|w| w.skin)),
                self.join_gap,
            )?,
            false => check::<RestError>(scene, wearer.map(|w| w.skin), self.join_gap)?,
        };
        if !self.from_here && !self.sew_through {
            check_lying::<RestError>(scene, &Pieces::new(scene), &start)?;
        }
        let (mut coarsest, mut restarts) = (rest.first_coarsest(pile), 0);
        loop {
            let plan = Plan::new(&rest, coarsest, scene, wearer, around, &start)?;
            let (made, finer) = (Work::new(&plan, clock).make(progress), plan.second());
            coarsest = match (made, finer) {
                (Ok(Draped::Rested(state)), _) => return rest.judge(scene, Rested { restarts, ..*state }),
                // From its own start the level keeps free of crossings by itself, if slowly.
                (Ok(Draped::Tangled(entangled)), None) => {
                    return Err(tangled(scene, gravity(scene).norm(), entangled));
                }
                (Ok(Draped::Tangled(entangled)), Some(finer)) => entangled.nodes.max(finer),
                (Ok(Draped::TooCoarse { finer }), _) => finer,
                // What slides off while it is stiff may stay on as cloth.
                (Err(RestError::FallsPast(fallen)), _) if rest.graded && !fallen.is_certain => {
                    rest.graded = false;
                    rest.first_coarsest(pile)
                }
                // A sheet of a few vertices falls past a body that would catch it.
                (Err(RestError::FallsPast(fallen)), Some(finer)) if !fallen.is_certain => finer,
                // A polygon of so few corners does not go round a limb, is folded onto itself by its seams, or hands on
                // folds that lie too close for a finer mesh to come apart.
                (Err(e), Some(finer)) if e.is_of_a_coarse_mesh(plan.edge()) => finer,
                (Err(e), _) => return Err(e),
            };
            restarts += 1;
        }
    }

    /// Most vertices of the coarsest mesh of the first try.
    fn first_coarsest(&self, pile: Option<usize>) -> usize {
        if self.from_here {
            return usize::MAX;
        }
        let one = if self.graded { COARSEST.max(self.coarsest) } else { self.coarsest };
        // The limit is for each cloth of a pile: nine nodes cannot follow a body.
        one * pile.unwrap_or(1)
    }

    pub(super) fn judge(&self, scene: &Scene, state: Rested) -> Result<Rested, RestError> {
        if state.outcome.at_rest {
            return Ok(state);
        }
        let has = |p: &&Panel| p.vertices.contains(&(state.unbalanced.vertex as usize));
        let panel = scene.panels.iter().find(has).map_or("?", |p| &p.name).to_string();
        Err(RestError::NotAtRest { wanted: self.speed, panel, state: Box::new(state) })
    }
}

#[cfg(test)]
mod fall_tests;
#[cfg(test)]
mod graded_tests;
#[cfg(test)]
mod held_tests;
#[cfg(test)]
mod layer_friction_tests;
#[cfg(test)]
mod models_tests;
#[cfg(test)]
mod sewn_tests;
#[cfg(test)]
mod sharp_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
#[cfg(test)]
mod worn_tests;
