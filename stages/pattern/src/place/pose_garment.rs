//! `PoseGarment`: a worn garment brought along with its wearer's arms.
//!
//! Method: garment and body go through the same map of space, so that neither crosses the other
//! afterwards but for the error of straight edges. Cost: linear in vertices.

use toile_body::Swing;
use toile_core::needed_for;
use toile_core::prelude::*;

/// Brings a draped garment along with a body that `PoseBody` has given another pose.
///
/// The garment is stretched and pressed where arm and trunk meet; a collider of the new body and
/// a `StaticEquilibrium` after it let it settle.
#[stage(
    role = Placement,
    source = "monotone cubic between arm and trunk: Fritsch and Carlson 1980",
    example = "PoseGarment()",
    contracts(Deterministic, ThreadInvariant, Improves)
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
            status: SolveStatus { converged: false, held: Held::default(), ..garment.status.clone() },
            starts: Vec::new(),
            ..garment.clone()
        })
    }

    /// The map begins at the first body: a garment that was draped on another one would be moved
    /// too far.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let index = |port: &str| {
            let maker = placed.maker(port)?;
            placed.nodes.iter().position(|n| std::ptr::eq(n, maker))
        };
        let (Some(garment), Some(first)) = (index("garment"), index("before")) else { return Vec::new() };
        let needed = needed_for(placed.nodes, &[garment]);
        let makes_body = |n: &toile_core::Node| n.card.outputs.iter().any(|o| o.kind == Body::KIND);
        let mut worn = placed.nodes.iter().zip(needed).enumerate();
        let other = worn.rfind(|(k, (n, needed))| *needed && *k != first && makes_body(n));
        let refused = |text: String| {
            vec![StageError::invalid(text).hint("let `PoseBody` stand between the drape and `PoseGarment`")]
        };
        match (other, index("after") == Some(first)) {
            (Some((_, (body, _))), _) => refused(format!(
                "the garment is draped on the body of `{}`, and not on the first one",
                body.id
            )),
            (None, true) => refused("the body has one pose alone".to_owned()),
            (None, false) => Vec::new(),
        }
    }
}
