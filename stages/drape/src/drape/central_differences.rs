//! `CentralDifferences`: sews and drapes in time by explicit steps on finite elements.
//!
//! Method: leapfrog with a step below the limit 2/omega_max, which is computed. Cost: a few flops
//! per vertex and step, but some thousand steps a second. Limit: stiff or fine cloth makes steps
//! tiny.

use super::by_place;
use super::models::{BendingModel, MembraneModel, models};
use super::motion::{InTime, drape};
use toile_cloth::motion::Method;
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Known, Node};

/// Sews the garment and lets it fall and settle, by central differences with an adaptive step.
///
/// Promises motion of second order without damping of its own; the step stays below the stable
/// limit 2/omega_max, which is computed from the stiffness and again as cloth stiffens.
/// `SpringStitcher` and `SpringDraper` do the same with springs. Seams are sewn first, without
/// weight, for as long as they take. In a scene it then follows the scene's phases for their
/// seconds; the time of sewing is taken off those before the first phase with weight; else it
/// drapes until rest. Cloth that falls past the body is an error.
#[stage(
    role = Draper,
    version = 6,
    source = "Fan et al. 1999; Desbrun et al. 1999",
    example = "CentralDifferences(drag: 4.0)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct CentralDifferences {
    /// What cloth resists in its plane.
    #[param(default = MembraneModel::Woven, trades)]
    pub membrane: MembraneModel,
    /// What cloth resists when it is folded.
    #[param(default = BendingModel::Hinge, trades)]
    pub bending: BendingModel,
    /// The motion.
    #[param(flatten)]
    pub motion: InTime,
}

#[stage]
impl CentralDifferences {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        phases: Option<&Phases>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let models = models(self.membrane, self.bending);
        let course = self.motion.course(Method::CentralDifferences { least: 0.0 }, models);
        let garment = &*self.motion.sewn_first(garment, collider, cx)?;
        drape(&course, garment, garment, collider, phases, cx)
    }

    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        by_place::in_time(nodes, index)
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        by_place::in_time_rule(known)
    }
}
