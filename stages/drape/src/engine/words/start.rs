//! What is wrong with where a garment starts.

use super::{MessageContext, both, length, panel, seam, turn_round};
use toile_cloth::statics::report::start::StartError;
use toile_core::{ErrorCode, StageError};

/// What less of it lies in the body is moved out by a solver, metres.
const MOVED_OUT: f64 = 0.05;

impl MessageContext<'_> {
    /// `through` is how this user lets cloth pass through what lies in its way, where that can be
    /// asked for.
    pub(super) fn start(&self, error: &StartError, through: Option<String>) -> StageError {
        let or_through = |remedy: String| match &through {
            Some(through) => format!("{remedy}, or {through}"),
            None => remedy,
        };
        let (message, help) = match error {
            StartError::InBody { depth, panel: of, at, .. } => (
                format!("{} starts inside the body, by {} {}", panel(of), length(*depth), self.place(at)),
                or_through(format!(
                    "place it outside the body (what is less than {} deep is moved out)",
                    length(MOVED_OUT)
                )),
            ),
            StartError::Crossing { panels, at, more, .. } => (
                format!(
                    "{} where they start, {}{}",
                    both(panels, "pass through", "passes through"),
                    self.place(at),
                    others(*more)
                ),
                or_through("place them so that none does".into()),
            ),
            StartError::Lying { panels, share, at, more, thickness, .. } => (
                format!(
                    "{} where they start: {:.0} % of {}, {}{}",
                    both(panels, "lie in", "lies in"),
                    share * 1e2,
                    panel(&panels[0]),
                    self.place(at),
                    others(*more)
                ),
                or_through(format!("place them {} apart, as thick as the cloth is", length(*thickness))),
            ),
            StartError::Squeezed { panel: of, share, at, .. } => (
                format!(
                    "{} starts squeezed together: {:.0} % of it has hardly any width, {}",
                    panel(of),
                    share * 1e2,
                    self.place(at)
                ),
                "place it as large as it is cut".into(),
            ),
            StartError::Reversed { seams, apart, turned } => {
                let first = seams.first().map_or("", String::as_str);
                let more = match seams.len() {
                    0 | 1 => String::new(),
                    n => format!(", and so do {} others", n - 1),
                };
                (
                    format!(
                        "{} runs the wrong way{more}: its sides start {} apart in the mean, and {} if one of them is turned round",
                        seam(first),
                        length(*apart),
                        length(*turned)
                    ),
                    turn_round(first),
                )
            }
            StartError::PinnedApart { seam: of, gap } => (
                format!("{} joins points that are pinned {} apart", seam(of), length(*gap)),
                "pin them at one place, or let one of them go".into(),
            ),
        };
        Self::error(ErrorCode::InvalidInput, message, error).hint(help)
    }
}

fn others(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", and so do two other pieces".into(),
        n => format!(", and so do {n} other pairs of pieces"),
    }
}
