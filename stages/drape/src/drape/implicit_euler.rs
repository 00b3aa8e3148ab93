//! `ImplicitEuler`: sews and drapes in time by implicit steps.
//!
//! Method: each step minimises inertia and energy by Newton's method with line search. Cost: a few
//! factorizations a step. Limit: contacts act after the step, so `dt` above 8 ms lets tight
//! garments slip.

use super::by_place;
use super::models::{BendingModel, MembraneModel, models};
use super::motion::{InTime, drape};
use toile_cloth::motion::Method;
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Known, Node};

/// Sews the garment and lets it fall and settle, by implicit Euler steps.
///
/// Promises: stable at any step, never gains energy, free fall exact, each step solved to
/// `tolerance` newtons. Damps what the step does not resolve: a mode of frequency w loses the
/// factor 1/sqrt(1 + (w dt)^2) a step. Seams are sewn first, without weight, for as long as they
/// take. In a scene it then follows the scene's phases for their seconds; the time of sewing is
/// taken off those before the first phase with weight; else it drapes until rest. Cloth that falls
/// past the body is an error.
#[stage(
    role = Draper,
    version = 6,
    source = "Baraff and Witkin 1998; Martin et al. 2011",
    example = "ImplicitEuler(tolerance: 1e-4)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct ImplicitEuler {
    /// What cloth resists in its plane.
    #[param(default = MembraneModel::Woven, trades)]
    pub membrane: MembraneModel,
    /// What cloth resists when it is folded.
    #[param(default = BendingModel::Hinge, trades)]
    pub bending: BendingModel,
    /// Force that a step leaves on a vertex.
    #[param(default = 1e-4, min = 1e-12, max = 1.0, unit = "N", trades, finer = "less")]
    pub tolerance: f64,
    /// Relative residual of conjugate gradients instead of a factor: less memory, for short steps.
    #[param(default = None, min = 1e-12, max = 0.5, trades, finer = "less")]
    pub conjugate_gradients: Option<f64>,
    /// The motion.
    #[param(flatten)]
    pub motion: InTime,
}

#[stage]
impl ImplicitEuler {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        phases: Option<&Phases>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let method = Method::ImplicitEuler { tolerance: self.tolerance, relative: self.conjugate_gradients };
        let course = self.motion.course(method, models(self.membrane, self.bending));
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
