//! `Projective`: sews and drapes in time by local and global turns.
//!
//! Method: implicit Euler with a matrix that never changes. Cost: one factor for all, two
//! triangular solves a turn. Limit: isotropic, converges slowly for stiff cloth and long steps.

use super::by_place;
use super::motion::{InTime, drape};
use toile_cloth::energy::Models;
use toile_cloth::motion::Method;
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Known, Node};

/// Sews the garment and lets it fall and settle, by projective dynamics.
///
/// Promises that every iteration lowers the energy of the step and that a step costs the same
/// always; what `iterations` leave undone shows as cloth too stiff against rotation and slow to
/// fall into folds. Warp and weft count as one stiffness. Seams are sewn first, without weight, for
/// as long as they take. In a scene it then follows the scene's phases for their seconds; the time
/// of sewing is taken off those before the first phase with weight; else it drapes until rest.
/// Cloth that falls past the body is an error.
#[stage(
    role = Draper,
    version = 5,
    source = "Bouaziz et al. 2014",
    example = "Projective(iterations: 10)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Projective {
    /// Turns in each step.
    #[param(default = 10, min = 1, max = 10_000, unit = "turns", trades, finer = "more")]
    pub iterations: usize,
    /// The motion.
    #[param(flatten)]
    pub motion: InTime,
}

#[stage]
impl Projective {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        phases: Option<&Phases>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        let method = Method::Projective { iterations: self.iterations };
        let course = self.motion.course(method, Models::DEFAULT);
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
