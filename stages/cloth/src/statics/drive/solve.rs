//! `StaticEquilibrium`: a whole scene straight to static equilibrium.
//!
//! Method: panels are coarsened; the coarsest level is sewn (seams pull with a force that hardly
//! depends on their gap, without weight, until they meet; then each pair becomes one node, so the
//! gap is exactly zero) and draped; each finer level starts from the coarser one's state, carried
//! over by the triangles that its vertices lie in at rest. So the fall and the sewing happen where
//! steps cost milliseconds, and the finest level only settles.
//!
//! Where the coarsest level shows itself too coarse (a seam stays open, layers tangle, a limb comes
//! through a triangle: see `penetration`), the garment is sewn again on the next finer one.
//!
//! Where the body would keep seams open, the coarsest level may be sewn on other solids (see
//! [`StaticEquilibrium::solve_around`]).
//!
//! With [`StaticEquilibrium::from_here`] there are no coarser levels: cloth that hangs already
//! settles where it is.
//!
//! With [`StaticEquilibrium::bending_continuation`] bending starts stiff and is let go on the way
//! (see `bending_continuation`), so that chance has less of a say.
//!
//! Cost: some 35 to 150 factorizations of the finest level (docs/log/2026-11-23-rest-speed.md).
//! Limits: what the coarse level cannot see (a fold finer than its mesh) must form on finer levels;
//! one out of many equilibria is found, as friction and folds have many.

use crate::contact::body::Body;
use crate::contact::skin::CollisionSurface;
use crate::scene::{Panel, Scene};
use crate::statics::drive::coarse_to_fine::{Draped, Solve};
use crate::statics::drive::plan::Plan;
pub use crate::statics::factor::scalar::Precision;
pub use crate::statics::levels::assemble::Collider;
use crate::statics::levels::assemble::gravity;
use crate::statics::levels::bending_continuation::COARSEST;
use crate::statics::levels::pieces::Pieces;
pub use crate::statics::newton::settings::StaticEquilibrium;
use crate::statics::newton::stack::stack_size;
pub use crate::statics::report::equilibrium::{Equilibrium, LevelReport, Progress};
pub use crate::statics::report::error::{StaticsError, Unsolvable};
use crate::statics::report::intersecting::tangled;
pub use crate::statics::report::load::Load;
pub use crate::statics::report::start::StartError;
use crate::statics::report::start::{check, check_lying, moved_out};
use crate::stopper::Stopper;
use std::time::Instant;

impl StaticEquilibrium {
    /// Solves `scene`; `progress` hears of every step.
    ///
    /// # Errors
    /// Every [`StaticsError`].
    pub fn solve(&self, scene: &Scene, progress: &mut Progress<'_>) -> Result<Equilibrium, StaticsError> {
        #[cfg(not(toile_without = "body"))]
        let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
        #[cfg(not(toile_without = "body"))]
        let collider = body.as_ref().map(|(body, friction)| Collider { skin: body, friction: *friction });
        #[cfg(toile_without = "body")]
        let collider = None;
        self.solve_on(scene, collider, progress)
    }

    /// Solves `scene` on a body that answers for itself; the scene's own body is not looked at.
    ///
    /// # Errors
    /// Every [`StaticsError`].
    pub fn solve_on(
        &self,
        scene: &Scene,
        collider: Option<Collider<'_>>,
        progress: &mut Progress<'_>,
    ) -> Result<Equilibrium, StaticsError> {
        self.solve_around(scene, collider, &[], &Stopper::default(), progress)
    }

    /// The same, sewn on other solids before the body comes: seams close on the first of `around`,
    /// then each of the others pushes the sewn cloth out of itself, and the body as the last; on
    /// the first and on the body the cloth slides to where it fits. For
    /// [`StaticEquilibrium::sew_through`], where the body keeps seams open. `stopper` is asked
    /// inside of steps, too.
    ///
    /// # Errors
    /// Every [`StaticsError`].
    pub fn solve_around(
        &self,
        scene: &Scene,
        collider: Option<Collider<'_>>,
        around: &[&dyn CollisionSurface],
        stopper: &Stopper,
        progress: &mut Progress<'_>,
    ) -> Result<Equilibrium, StaticsError> {
        let clock = Instant::now();
        scene.check()?;
        scene.check_still()?;
        let stack = stack_size(scene);
        let mut settings = Self {
            bending_continuation: self.bending_continuation && !self.from_here && stack.is_none(),
            ..*self
        };
        let start = match self.sew_through {
            true => moved_out::<StaticsError>(
                scene,
                around.first().copied().or(collider.map(|w| w.skin)),
                self.join_gap,
            )?,
            false => check::<StaticsError>(scene, collider.map(|w| w.skin), self.join_gap)?,
        };
        if !self.from_here && !self.sew_through {
            check_lying::<StaticsError>(scene, &Pieces::new(scene), &start)?;
        }
        let (mut coarsest, mut restarts) = (settings.first_coarsest(stack), 0);
        loop {
            let plan = Plan::new(&settings, coarsest, scene, collider, around, stopper, &start)?;
            let (made, finer) = (Solve::new(&plan, clock).run(progress), plan.second());
            coarsest = match (made, finer) {
                (Ok(Draped::Equilibrium(state)), _) => {
                    return settings.judge(scene, Equilibrium { restarts, ..*state });
                }
                // From its own start the level keeps free of crossings by itself, if slowly.
                (Ok(Draped::Tangled(entangled)), None) => {
                    return Err(tangled(scene, gravity(scene).norm(), entangled));
                }
                (Ok(Draped::Tangled(entangled)), Some(finer)) => entangled.nodes.max(finer),
                (Ok(Draped::TooCoarse { finer }), _) => finer,
                // What slides off while it is stiff may stay on as cloth.
                (Err(StaticsError::FallsPast(fallen)), _)
                    if settings.bending_continuation && !fallen.is_certain =>
                {
                    settings.bending_continuation = false;
                    settings.first_coarsest(stack)
                }
                // A sheet of a few vertices falls past a body that would catch it.
                (Err(StaticsError::FallsPast(fallen)), Some(finer)) if !fallen.is_certain => finer,
                // A polygon of so few corners does not go round a limb, is folded onto itself by
                // its seams, or hands on folds that lie too close for a finer mesh to come apart.
                (Err(e), Some(finer)) if e.is_of_a_coarse_mesh(plan.edge()) => finer,
                (Err(e), _) => return Err(e),
            };
            restarts += 1;
        }
    }

    /// Most vertices of the coarsest mesh of the first try.
    fn first_coarsest(&self, stack: Option<usize>) -> usize {
        if self.from_here {
            return usize::MAX;
        }
        let one = if self.bending_continuation { COARSEST.max(self.coarsest) } else { self.coarsest };
        // The limit is for each cloth of a pile: nine nodes cannot follow a body.
        one * stack.unwrap_or(1)
    }

    pub(crate) fn judge(&self, scene: &Scene, state: Equilibrium) -> Result<Equilibrium, StaticsError> {
        if state.outcome.at_rest {
            return Ok(state);
        }
        let has = |p: &&Panel| p.vertices.contains(&(state.unbalanced.vertex as usize));
        let panel = scene.panels.iter().find(has).map_or("?", |p| &p.name).to_string();
        Err(StaticsError::NotAtRest { wanted: self.speed, panel, state: Box::new(state) })
    }
}

#[cfg(test)]
mod continuation_tests;
#[cfg(test)]
mod fall_tests;
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
