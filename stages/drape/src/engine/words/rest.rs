//! Messages about a garment that does not come to rest.

use super::numbers::BEYOND_CLOTH;
use super::{MessageContext, both, length, panel, seam, turn_round};
use crate::engine::{scene_error, split};
use toile_cloth::statics::drive::solve::{Equilibrium, StaticsError, Unsolvable};
use toile_cloth::statics::report::not_at_rest::unrest;
use toile_cloth::statics::report::unbalanced::Meets;
use toile_core::{ErrorCode, StageError};

/// What a user can change of `StaticEquilibrium`.
#[derive(Clone, Copy)]
pub(crate) struct Rests<'a> {
    /// Seams that run the wrong way as they start.
    pub(crate) reversed: &'a [String],
    pub(crate) sew_through: bool,
    pub(crate) coarsest: usize,
    pub(crate) steps: usize,
    pub(crate) time_limit: f64,
}

/// A first mesh this many times finer, and of no fewer than [`FINER_VERTICES`], may do what a
/// coarser one does not.
const TIMES_FINER: usize = 3;
/// Vertices of the finer first mesh at least.
const FINER_VERTICES: usize = 2000;

impl MessageContext<'_> {
    /// An error of the static solver.
    pub(crate) fn rest(&self, error: &StaticsError, can: &Rests<'_>) -> StageError {
        let finer = || self.set("coarsest", FINER_VERTICES.max(TIMES_FINER * can.coarsest));
        let through = (!can.sew_through).then(|| {
            format!(
                "let cloth pass through what lies in its way while it is sewn: {}",
                self.set("sew_through", true)
            )
        });
        let (code, message, help) = match error {
            StaticsError::Cloth(e) => return self.numbers(e),
            StaticsError::Scene(e) => return scene_error(e),
            StaticsError::Start(e) => {
                let through = (!can.sew_through).then(|| format!("let the solver move it apart: {}", self.set("sew_through", true)));
                return self.start(e, through);
            }
            StaticsError::FallsPast(fallen) => {
                return split(ErrorCode::StaticEquilibrium, &fallen.to_string());
            }
            StaticsError::Stopped => return StageError::new(ErrorCode::Cancelled, "stopped on request"),
            StaticsError::Falls => (
                ErrorCode::StaticEquilibrium,
                "nothing holds the garment: there is no body under it, and nothing of it is pinned".to_owned(),
                "put a body and a collider before it (`body: Mannequin()`, `BvhCollider()`), or pin some of it (`pinned` of a scene)"
                    .to_owned(),
            ),
            StaticsError::Unsolvable { panel: of, why, .. } => {
                let (what, help) = no_step(*why);
                (ErrorCode::StaticEquilibrium, format!("a point of {} {what}", panel(of)), help.to_owned())
            }
            StaticsError::SeamNotClosed { seam: of, gap, reversed, .. } => {
                let help = match (reversed.contains(of) || can.reversed.contains(of), through) {
                    (true, _) => turn_round(of),
                    (false, Some(through)) => {
                        format!("{through}; where the body is in the way, cut the pieces wider or take a smaller body")
                    }
                    (false, None) => {
                        format!("cut the pieces wider, or take the body that they were drafted for; {} sews on a finer mesh", finer())
                    }
                };
                (ErrorCode::StitchingError, open_seam(of, *gap, None, reversed), help)
            }
            StaticsError::Tangled { panels, at, load, .. } => {
                let help = match (load.is_heavy(), can.reversed.first(), through) {
                    (true, ..) => BEYOND_CLOTH.to_owned(),
                    (false, Some(of), _) => format!("{} seems to run the wrong way: {}", seam(of), turn_round(of)),
                    (false, None, Some(through)) => format!("{through}; or sew on a finer mesh: {}", finer()),
                    (false, None, None) => format!("sew on a finer mesh: {}", finer()),
                };
                let who = both(panels, "came through", "came through");
                (ErrorCode::SelfIntersection, format!("{who} {}, and did not come free", self.place(at)), help)
            }
            StaticsError::Crossing { pairs, .. } => {
                (ErrorCode::SelfIntersection, crossing(*pairs), format!("sew on a finer mesh: {}", finer()))
            }
            StaticsError::NotAtRest { state, panel, .. } => {
                (ErrorCode::StaticEquilibrium, self.unrest(state, panel), self.more_steps(can))
            }
            StaticsError::Timeout { seconds, level, levels, .. } => (
                ErrorCode::Timeout,
                format!("out of time after {seconds:.1} s, on mesh {level} of {levels}"),
                format!("allow more time: {}", self.set("time_limit", (2.0 * can.time_limit).ceil())),
            ),
            StaticsError::NotPositive(_) => (
                ErrorCode::StaticEquilibrium,
                "the forces in the cloth cannot be balanced".to_owned(),
                BEYOND_CLOTH.to_owned(),
            ),
            StaticsError::Reshaped => return StageError::internal(error.to_string()),
        };
        Self::error(code, message, error).hint(help)
    }

    /// The message for a garment that still moves, without the remedy; `of` is the panel with the
    /// greatest force left over.
    fn unrest(&self, state: &Equilibrium, of: &str) -> String {
        let cause = match state.unbalanced.meets {
            Meets::Cloth => "where cloth lies on cloth",
            Meets::Body => "where it lies on the body",
            Meets::Nothing => "where it hangs free",
        };
        let at = state.positions.get(state.unbalanced.vertex as usize);
        let at = at.map_or_else(String::new, |at| format!(", {}", self.place(at)));
        format!(
            "the garment is not at rest after {} steps: '{of}' still moves {cause}{at}",
            state.outcome.steps
        )
    }

    fn more_steps(&self, can: &Rests<'_>) -> String {
        format!("{} lets it go on", self.set("steps", 2 * can.steps))
    }

    /// A garment that still moves, as a warning, and what the engine says of it.
    pub(crate) fn still_moving(
        &self,
        state: &Equilibrium,
        panel: &str,
        wanted: f64,
        can: &Rests<'_>,
    ) -> [String; 2] {
        [format!("{}; {}", self.unrest(state, panel), self.more_steps(can)), unrest(state, panel, wanted)]
    }
}

/// The message for cloth that passes through cloth in the end.
pub(crate) fn crossing(pairs: usize) -> String {
    match pairs {
        1 => "cloth passes through cloth in one place".to_owned(),
        n => format!("cloth passes through cloth in {n} places"),
    }
}

/// A seam that stays open, after so many seconds where a motion closes it.
pub(super) fn open_seam(name: &str, gap: f64, after: Option<f64>, reversed: &[String]) -> String {
    let why = if reversed.iter().any(|r| r == name) { ": its two sides run the opposite way" } else { "" };
    let after = after.map_or_else(String::new, |s| format!(" after {s:.2} s of sewing"));
    format!("{} stays open by {}{after}{why}", seam(name), length(gap))
}

/// What is wrong with a point that no step moves, and what may help.
fn no_step(why: Unsolvable) -> (&'static str, &'static str) {
    match why {
        Unsolvable::Loose => ("belongs to no triangle", "take it out of the file, or give it a triangle"),
        Unsolvable::Lost => ("has left every place: its numbers are too large", BEYOND_CLOTH),
        Unsolvable::Flat => {
            ("has no cloth around it where it starts", "place the piece as large as it is cut")
        }
        Unsolvable::Apart => ("has forces that differ too much in size to be balanced", BEYOND_CLOTH),
    }
}
