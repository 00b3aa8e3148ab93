//! `PoseGarment`: a worn garment brought along with its wearer's arms.
//!
//! Method: garment and body go through the same map of space, so that neither crosses the other afterwards but for the error of straight edges.
//! Cost: linear in vertices.

use crate::body::Swing;
use toile_core::prelude::*;

/// Brings a draped garment along with a body that `PoseBody` has given another pose.
///
/// The garment is stretched and pressed where arm and trunk meet; a collider of the new body and `StaticEquilibrium(from_here: true)` after
/// it let it settle.
#[stage(
    role = Placement,
    source = "monotone cubic between arm and trunk: Fritsch and Carlson 1980",
    example = "PoseGarment()",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct PoseGarment;

#[stage]
impl PoseGarment {
    pub(crate) fn run(
        &self,
        garment: &Garment,
        #[original] before: &Body,
        after: &Body,
        _cx: &Context,
    ) -> Result<Garment, StageError> {
        let swing = Swing::between(before, after)?;
        let positions = garment.positions.iter().map(|p| swing.place(p)).collect();
        Ok(Garment {
            positions,
            velocities: vec![Vector3::zeros(); garment.velocities.len()],
            ..garment.clone()
        })
    }
}
