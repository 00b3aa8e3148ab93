//! `PoseBody`: the body with its arms swung to another angle.
//!
//! Method: [`Swing`]. Cost: some slices of the trunk, then linear in vertices.

use crate::limbs::swing::Swing;
use toile_core::prelude::*;

/// Swings the arms of the body, such as from the pose in which a garment is sewn to one in which it
/// is looked at.
///
/// The trunk and its measurements stay; the skin between arm and trunk is drawn along.
/// `PoseGarment` brings the garment after it.
#[stage(
    role = Body,
    source = "monotone cubic between arm and trunk: Fritsch and Carlson 1980",
    example = "PoseBody()",
    contracts(Deterministic, ThreadInvariant, Improves)
)]
pub struct PoseBody {
    /// Angle between the upper arms and the vertical, from the middle between shoulder and armpit
    /// to the elbow; where it is not given, 28 degrees or as near to it as the trunk lets the arms,
    /// and arms that hang lower stay.
    #[param(default = None, min = 5.0, max = 150.0, unit = "deg")]
    arm_angle: Option<f64>,
}

#[stage]
impl PoseBody {
    pub(crate) fn run(&self, body: &Body, _cx: &Context) -> Result<Body, StageError> {
        let swing = match self.arm_angle {
            Some(angle) => Swing::to(body, angle.to_radians())?,
            None => Swing::hanging(body)?,
        };
        Ok(Body {
            positions: body.positions.iter().map(|p| swing.place(p)).collect(),
            landmarks: body.landmarks.iter().map(|(name, p)| (name.clone(), swing.place(p))).collect(),
            ..body.clone()
        })
    }
}
