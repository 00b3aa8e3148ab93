//! `SpringStitcher`: sews panels with springs.
//!
//! Method: the engine's motion by central differences (Fan et al. 1999) with springs along the mesh
//! edges for cloth and bending; seams close at a set speed as if by hands, and pairs that have met
//! become one node. Gravity does not act until every pair is joined. Cost: steps times triangles.
//! Limits: stiff fabrics are softened to `stiffest`; a seam that does not come nearer is reported;
//! nothing is torn or pulled through the body.

use crate::drape::{SewingFor, SpringSewing, by_place};
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Known, Node};

/// Sews the panels of a garment together, cloth taken as springs.
///
/// Paired points of the seams are brought together at `closing` while the cloth's own springs,
/// damping and contacts act; gravity waits until the sewing is done, or the cloth would fall. When
/// all are nearer than `seam_distance` they become one with their momentum kept. Gathered seams are
/// sewn the same way. A seam that cannot close is an error that names it.
#[stage(
    role = Stitcher,
    version = 4,
    source = "Fan, Zhou, Wang, Yuen, 1999; improved spring-mass model, 2003",
    example = "SpringStitcher(seam_distance: \"1 mm\")",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct SpringStitcher {
    /// How it sews.
    #[param(flatten)]
    pub sewing: SpringSewing,
}

#[stage]
impl SpringStitcher {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        self.sewing.sew(
            garment,
            collider,
            &SewingFor { longest: "time_limit", wall: None, has_stiffest: true },
            cx,
        )
    }

    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        by_place::in_time(nodes, index)
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        by_place::in_time_rule(known)
    }
}
