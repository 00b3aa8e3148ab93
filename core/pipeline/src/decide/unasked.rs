//! `unasked`: a stage that no requested result depends on does not run.
//!
//! Fact: no writer, no judgement and no `--until` needs what it makes, near or far (reachability in
//! the graph of stages; as in dead-code elimination, Kennedy 1981). Tolerance: no bit of what is
//! requested changes. Reversed by `--also STAGE`.

use super::{Decision, Saves, State, Tolerance, Turn};

/// The decision on a stage that is left out, with the planner's reason.
pub(super) fn unasked(reason: &str) -> Decision {
    Decision {
        rule: "unasked".into(),
        state: State::Off,
        what: "the whole stage".into(),
        fact: reason.to_owned(),
        tolerance: Tolerance::SameBits,
        saves: Saves::Modelled,
        source: "dead code: Kennedy 1981".into(),
        turn: Turn::Also,
    }
}
