//! Why a motion does not end.

use super::rest::open_seam;
use super::{MessageContext, length, panel, turn_round};
use crate::engine::{scene_error, split};
use toile_cloth::motion::MotionError;
use toile_core::{ErrorCode, StageError};

/// What a user can change of a stage that steps in time.
#[derive(Clone, Copy)]
pub(crate) struct Motions {
    /// The parameter that ends the motion, and its value, s.
    pub(crate) longest: (&'static str, f64),
    /// The speed at which seams close, m/s.
    pub(crate) closing: f64,
    /// The wall time that a user can change, s.
    pub(crate) time_limit: Option<f64>,
    /// The slope at which the fabric's curves are cut, N/m, where they are.
    pub(crate) stiffest: Option<f64>,
}

/// Softer by this, springs take steps that are twice as long.
const SOFTER: f64 = 4.0;

impl MessageContext<'_> {
    /// An error of a solver that steps in time.
    pub(crate) fn motion(&self, error: &MotionError, can: &Motions) -> StageError {
        let (longest, time_limit) = (can.longest, can.time_limit);
        let (code, message, help) = match error {
            MotionError::Cloth(e) => return self.numbers(e),
            MotionError::Scene(e) => return scene_error(e),
            MotionError::Start(e) => return self.start(e, None),
            MotionError::FallsPast(fallen) => {
                return split(ErrorCode::StaticEquilibrium, &fallen.to_string());
            }
            MotionError::Stopped => return StageError::new(ErrorCode::Cancelled, "stopped on request"),
            MotionError::Fabrics { panel: of } => (
                ErrorCode::InvalidInput,
                format!(
                    "'{}' is of another fabric than the first piece, and `{}` takes one fabric",
                    panel(of),
                    self.stage
                ),
                "take another draper, such as `StaticEquilibrium()`, or one fabric for all pieces".to_owned(),
            ),
            MotionError::SeamNotClosed { seam: of, gap, time, reversed, .. } => {
                let help = match (reversed.contains(of), *time < longest.1) {
                    (true, _) => turn_round(of),
                    (false, false) => {
                        let enough = (4.0 * longest.1).max(2.0 * (time + gap / can.closing));
                        format!("sew for longer: {}", self.set(longest.0, (10.0 * enough).ceil() / 10.0))
                    }
                    (false, true) => "place its pieces nearer, with nothing between its sides, cut them wider, or sew with \
                                      `StaticEquilibrium(sew_through: true)`"
                        .to_owned(),
                };
                (ErrorCode::StitchingError, open_seam(of, *gap, Some(*time), reversed), help)
            }
            MotionError::TooStiff { time, gap, .. } => {
                let help = can.stiffest.map_or_else(
                    || "take `ImplicitEuler()`, whose steps do not get shorter, or a larger edge length of the mesh".to_owned(),
                    |stiffest| {
                        format!("sew with softer cloth: {}, or with a larger edge length of the mesh", self.set("stiffest", stiffest / SOFTER))
                    },
                );
                let message = format!(
                    "the cloth is too stiff for how light it is: {}, the next step would take too long",
                    done(*time, *gap)
                );
                (ErrorCode::StaticEquilibrium, message, help)
            }
            MotionError::Timeout { seconds, time, gap, .. } => {
                let more = time_limit.map_or_else(
                    || "take a larger edge length of the mesh".to_owned(),
                    |limit| format!("allow more time: {}", self.set("time_limit", (2.0 * limit).ceil())),
                );
                (ErrorCode::Timeout, format!("out of time after {seconds:.1} s: {}", done(*time, *gap)), more)
            }
        };
        Self::error(code, message, error).hint(help)
    }
}

/// How far a motion has come.
fn done(time: f64, gap: f64) -> String {
    let open =
        if gap > 0.0 { format!(", the widest seam is open by {}", length(gap)) } else { String::new() };
    format!("{time:.3} s of the motion are done{open}")
}
