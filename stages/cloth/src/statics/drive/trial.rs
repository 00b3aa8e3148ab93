//! A trial of a start: the seams are closed on the coarsest mesh, and the result is judged.
//!
//! Method: the coarsest level is planned and sewn as in a whole solution (see `sew`), then counted.
//! Cost: that of sewing the coarsest level, some tenths of a second. Limits: what only a finer mesh
//! can follow (pleats, narrow cuffs) may cross here and come free later, so a trial ranks starts of
//! one garment and condemns none.

use crate::contact::collision_surface::CollisionSurface;
use crate::scene::Scene;
use crate::statics::drive::coarse_to_fine::Solve;
use crate::statics::drive::plan::Plan;
use crate::statics::drive::solve::{Collider, StaticEquilibrium, StaticsError};
use crate::statics::forces::penetration::pierced;
use crate::statics::newton::sequential_start::stack_size;
use crate::statics::report::start::moved_out;
use crate::stopper::Stopper;
use std::ops::ControlFlow;
use std::time::Instant;

/// Seams that are open by less than this differ by chance, m.
const SAME_GAP: f64 = 0.01;

/// How well a garment is sewn on its coarsest mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// The widest gap of a seam, m; 0 where all are joined.
    pub gap: f64,
    /// Pairs of triangles of the cloth that cross.
    pub crossings: usize,
    /// Triangles through which the body passes.
    pub pierced: usize,
}

impl Trial {
    /// Whether all seams are joined, and nothing crosses.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.gap == 0.0 && self.crossings == 0 && self.pierced == 0
    }

    /// Whether it is clearly better than `other`: its seams close where those of the other stay
    /// open, or nothing crosses where something does. How much crosses is chance on a coarse mesh.
    #[must_use]
    pub fn is_better(&self, other: &Self) -> bool {
        if (self.gap - other.gap).abs() > SAME_GAP || (self.gap == 0.0) != (other.gap == 0.0) {
            return self.gap < other.gap;
        }
        self.is_clean() && !other.is_clean()
    }
}

impl StaticEquilibrium {
    /// Sews `scene` from its positions on the coarsest mesh alone, around the solids of `around`
    /// (see [`StaticEquilibrium::solve_around`]).
    ///
    /// # Errors
    /// Every [`StaticsError`] but open seams, which are a result.
    pub fn try_start(
        &self,
        scene: &Scene,
        collider: Option<Collider<'_>>,
        around: &[&dyn CollisionSurface],
        stopper: &Stopper,
    ) -> Result<Trial, StaticsError> {
        scene.check()?;
        let surface = around.first().copied().or(collider.map(|c| c.surface));
        let start = moved_out::<StaticsError>(scene, surface, self.join_gap)?;
        let coarsest = self.first_coarsest(stack_size(scene));
        let plan = Plan::new(self, coarsest, scene, collider, around, stopper, &start)?;
        let mut solve = Solve::new(&plan, Instant::now());
        match solve.sew(&mut |_| ControlFlow::Continue(())) {
            Ok(()) => {}
            Err(StaticsError::SeamNotClosed { gap, .. }) => {
                return Ok(Trial { gap, crossings: 0, pierced: 0 });
            }
            Err(error) => return Err(error),
        }
        let level = plan.coarsest_level();
        let sheet = plan.pieces[level].sewn_sheet(&plan.cloths)?;
        let pierced = collider.map_or(0, |c| pierced(&sheet, c.surface, &solve.x));
        Ok(Trial { gap: 0.0, crossings: solve.crossings, pierced })
    }
}
