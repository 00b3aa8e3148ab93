//! The static solver: brings a whole scene to static equilibrium.
//!
//! Method: the panels are coarsened to a multilevel mesh. On the coarsest level the seams are
//! closed (by a force that hardly depends on the gap, without weight; then each pair becomes one
//! node, so that the gap is exactly zero) and the garment is draped. Each finer level starts from
//! the state of the coarser one, interpolated in the triangles in which its vertices lie. So
//! falling and sewing happen where a step costs milliseconds, and the finest level needs only small
//! moves.
//!
//! Where the coarsest level is too coarse (a seam stays open, cloth intersects itself, a limb
//! passes through a triangle: see `penetration`), the garment is sewn again on the next finer
//! level.
//!
//! Where the body would keep seams open, the coarsest level may be sewn on other solids (see
//! [`StaticEquilibrium::solve_around`]).
//!
//! With [`StaticEquilibrium::from_here`] there are no coarser levels: the cloth is solved from its
//! present state.
//!
//! With [`StaticEquilibrium::bending_continuation`] bending starts stiff and is lowered on the way
//! (see `levels/bending_continuation`), so that the result depends less on the initial positions.
//!
//! Cost: some 35 to 150 factorizations of the finest level
//! (docs/log/2026-11-23-beside-blender-and-newton.md).
//! Limits: folds finer than the coarse mesh must form on finer levels; of the many equilibria that
//! friction and folds allow, one is found.

use crate::contact::body::Body;
use crate::contact::collision_surface::CollisionSurface;
use crate::scene::{Panel, Scene};
use crate::statics::drive::coarse_to_fine::{Draped, Solve};
use crate::statics::drive::plan::Plan;
pub use crate::statics::factor::scalar::Precision;
pub use crate::statics::levels::assemble::Collider;
use crate::statics::levels::assemble::gravity;
use crate::statics::levels::bending_continuation::COARSEST;
use crate::statics::levels::pieces::Pieces;
use crate::statics::newton::sequential_start::stack_size;
pub use crate::statics::newton::settings::StaticEquilibrium;
pub use crate::statics::report::equilibrium::{Equilibrium, LevelReport, Progress};
pub use crate::statics::report::error::{StaticsError, Unsolvable};
use crate::statics::report::intersecting::intersecting_error;
pub use crate::statics::report::load::Load;
pub use crate::statics::report::start::StartError;
use crate::statics::report::start::{check, check_lying, moved_out};
use crate::stopper::Stopper;
use std::time::Instant;

impl StaticEquilibrium {
    /// Solves `scene`; `progress` is called after every step.
    ///
    /// # Errors
    /// Every [`StaticsError`].
    pub fn solve(&self, scene: &Scene, progress: &mut Progress<'_>) -> Result<Equilibrium, StaticsError> {
        #[cfg(not(toile_without = "body"))]
        let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
        #[cfg(not(toile_without = "body"))]
        let collider = body.as_ref().map(|(body, friction)| Collider { surface: body, friction: *friction });
        #[cfg(toile_without = "body")]
        let collider = None;
        self.solve_on(scene, collider, progress)
    }

    /// Solves `scene` on `collider` in place of the body of the scene.
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

    /// The same, sewn on other solids first: the seams are closed on the first solid of `around`,
    /// then each of the others and last the body pushes the sewn cloth out of itself. On the first
    /// solid and on the body the cloth slides to where it fits. This is for
    /// [`StaticEquilibrium::sew_through`], where the body keeps seams open. `stopper` is also asked
    /// within steps.
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
                around.first().copied().or(collider.map(|c| c.surface)),
                self.join_gap,
            )?,
            false => check::<StaticsError>(scene, collider.map(|c| c.surface), self.join_gap)?,
        };
        if !self.from_here && !self.sew_through {
            check_lying::<StaticsError>(scene, &Pieces::new(scene), &start)?;
        }
        let (mut coarsest, mut restarts) = (settings.first_coarsest(stack), 0);
        loop {
            let plan = Plan::new(&settings, coarsest, scene, collider, around, stopper, &start)?;
            let (result, finer) = (Solve::new(&plan, clock).run(progress), plan.second());
            coarsest = match (result, finer) {
                (Ok(Draped::Equilibrium(state)), _) => {
                    return settings.judge(scene, Equilibrium { restarts, ..*state });
                }
                // There is no finer level to start from.
                (Ok(Draped::Intersecting(intersections)), None) => {
                    return Err(intersecting_error(scene, gravity(scene).norm(), intersections));
                }
                (Ok(Draped::Intersecting(intersections)), Some(finer)) => intersections.nodes.max(finer),
                (Ok(Draped::TooCoarse { finer }), _) => finer,
                // A garment that slides off while it is stiff may stay on with its own bending.
                (Err(StaticsError::FallsPast(fallen)), _)
                    if settings.bending_continuation && !fallen.is_certain =>
                {
                    settings.bending_continuation = false;
                    settings.first_coarsest(stack)
                }
                // A sheet of a few vertices may fall past a body that would hold a finer one.
                (Err(StaticsError::FallsPast(fallen)), Some(finer)) if !fallen.is_certain => finer,
                // A coarse mesh may not go around a limb, may be folded onto itself by its seams,
                // or may have folds too close for a finer mesh to separate.
                (Err(e @ StaticsError::SeamNotClosed { .. }), _) if restarts > 0 && self.gives_way => {
                    return Err(e);
                }
                (Err(e), Some(finer)) if e.is_of_a_coarse_mesh(plan.edge()) => finer,
                (Err(e), _) => return Err(e),
            };
            restarts += 1;
        }
    }

    /// Greatest number of nodes of the coarsest level in the first try.
    pub(crate) fn first_coarsest(&self, stack: Option<usize>) -> usize {
        if self.from_here {
            return usize::MAX;
        }
        let one = if self.bending_continuation { COARSEST.max(self.coarsest) } else { self.coarsest };
        // The limit is for each cloth of a stack: nine nodes cannot follow a body.
        one * stack.unwrap_or(1)
    }

    /// `state` if it is at rest.
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
mod worn_tests;
