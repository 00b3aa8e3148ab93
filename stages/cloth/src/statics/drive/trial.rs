//! A trial of a start: the seams are closed on the coarsest mesh, and the result is judged.
//!
//! Method: the coarsest level is planned and sewn as in a whole solution (see `sew`), then counted.
//! Cost: that of sewing the coarsest level, some tenths of a second. Limits: what only a finer mesh
//! can follow (pleats, narrow cuffs) may cross here and come free later, so a trial ranks starts of
//! one garment and condemns none.

use crate::contact::collision_surface::CollisionSurface;
use crate::scene::{Panel, Scene};
use crate::statics::drive::coarse_to_fine::Solve;
use crate::statics::drive::plan::Plan;
use crate::statics::drive::solve::{Collider, StaticEquilibrium, StaticsError};
use crate::statics::forces::penetration::pierced;
use crate::statics::levels::assemble::gravity;
use crate::statics::newton::sequential_start::stack_size;
use crate::statics::report::start::moved_out;
use crate::stopper::Stopper;
use std::ops::ControlFlow;
use std::time::Instant;
use toile_geometry::Vec3;

/// Seams that are open by less than this differ by chance, m.
const SAME_GAP: f64 = 0.01;

/// A garment that is held sinks by less while its seams close, m. One that is raised to clear the
/// shoulders comes down by 5 cm, and the round edge of a hood by as much.
const MOST_SUNK: f64 = 0.12;

/// How well a garment is sewn on its coarsest mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartTrial {
    /// The widest gap of a seam, m; 0 where all are joined.
    pub gap: f64,
    /// Pairs of triangles of the cloth that cross.
    pub crossings: usize,
    /// Triangles through which the body passes.
    pub pierced: usize,
    /// How far it has sunk, m: closing seams pull a bodice off the shoulders.
    pub sunk: f64,
}

impl StartTrial {
    /// Whether all seams are joined, nothing crosses, and it is where it was put.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.gap == 0.0 && self.crossings == 0 && self.pierced == 0 && !self.has_sunk()
    }

    /// Whether it has sunk by more than seams draw a garment that is held.
    #[must_use]
    pub fn has_sunk(&self) -> bool {
        self.sunk > MOST_SUNK
    }

    /// How far it is from its place: its widest seam, or how far it has sunk, m.
    fn off(&self) -> f64 {
        if self.has_sunk() { self.gap.max(self.sunk) } else { self.gap }
    }

    /// Whether it is clearly better than `other`: its seams close and it stays up, or it is nearer
    /// to that, or less than half as much crosses. Smaller differences are chance on a coarse mesh.
    #[must_use]
    pub fn is_better(&self, other: &Self) -> bool {
        let [mine, others] = [self.off(), other.off()];
        if (mine - others).abs() > SAME_GAP || (mine == 0.0) != (others == 0.0) {
            return mine < others;
        }
        2 * self.faults() < other.faults()
    }

    /// Pairs that cross, and triangles through which the body passes.
    fn faults(&self) -> usize {
        self.crossings + self.pierced
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
    ) -> Result<StartTrial, StaticsError> {
        scene.check()?;
        let surface = around.first().copied().or(collider.map(|c| c.surface));
        let start = moved_out::<StaticsError>(scene, surface, self.join_gap)?;
        let coarsest = self.first_coarsest(stack_size(scene));
        let plan = Plan::new(self, coarsest, scene, collider, around, stopper, &start)?;
        let mut solve = Solve::new(&plan, Instant::now());
        let level = plan.coarsest_level();
        let (gap, positions) = match solve.sew(&mut |_, _| ControlFlow::Continue(())) {
            Ok(()) => (0.0, solve.prolonged(level, plan.pieces[level].spread(&solve.x))),
            Err(StaticsError::SeamNotClosed { gap, positions, .. }) => (gap, positions),
            Err(error) => return Err(error),
        };
        let sunk = sunk(scene, &positions);
        if gap > 0.0 {
            return Ok(StartTrial { gap, crossings: 0, pierced: 0, sunk });
        }
        let sheet = plan.pieces[level].sewn_sheet(&plan.cloths)?;
        let pierced = collider.map_or(0, |c| pierced(&sheet, c.surface, &solve.x));
        Ok(StartTrial { gap, crossings: solve.crossings, pierced, sunk })
    }
}

/// By how much the middles of the panels have sunk: the median by vertices. A hood falls by itself,
/// and what hangs below rises to what it is sewn to.
fn sunk(scene: &Scene, positions: &[Vec3]) -> f64 {
    let up = (-gravity(scene)).try_normalize(1e-9).unwrap_or_else(Vec3::zeros);
    let drop = |panel: &Panel| {
        let n = panel.vertices.len();
        let all = panel.vertices.clone().map(|v| up.dot(&(scene.positions[v] - positions[v])));
        (all.sum::<f64>() / n.max(1) as f64, n)
    };
    let mut drops: Vec<(f64, usize)> = scene.panels.iter().map(drop).collect();
    drops.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = drops.iter().map(|d| d.1).sum::<usize>() / 2;
    let mut seen = 0;
    let median = drops.iter().find(|(_, n)| {
        seen += n;
        seen > half
    });
    median.map_or(0.0, |(drop, _)| *drop)
}
