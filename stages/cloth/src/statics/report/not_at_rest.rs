//! Why cloth has not come to rest, in words.

use crate::statics::report::equilibrium::Equilibrium;
use crate::statics::report::unbalanced::{Meets, Unbalanced};

/// Why a state is not at rest, in words. `panel` is the panel with the greatest residual force, and
/// `wanted` the speed of rest, m/s.
#[must_use]
pub fn unrest(state: &Equilibrium, panel: &str, wanted: f64) -> String {
    let (outcome, Unbalanced { force, meets, .. }) = (&state.outcome, state.unbalanced);
    let mm = |metres: f64| metres * 1e3;
    let how = match outcome.gained {
        Some(gained) => format!(
            "released for a sixtieth of a second it would gain {:.3} mm/s, {:.3} mm/s are allowed",
            mm(gained),
            mm(wanted)
        ),
        None => format!(
            "its last step, of {:.3} s, led {:.3} mm away, and rest is tried from {:.3} mm on",
            outcome.dt,
            mm(outcome.speed * outcome.dt),
            mm(wanted * outcome.dt)
        ),
    };
    let cause = match meets {
        Meets::Cloth => {
            "where cloth lies on cloth; take a finer mesh, whose layers lie closer, or allow more steps"
        }
        Meets::Body => "where it lies on the body; raise the friction, or allow more steps",
        Meets::Nothing => "where it hangs free and still folds; allow more steps",
    };
    let steps = outcome.steps;
    format!(
        "the cloth is not at rest after {steps} steps: {how}; {force:.2e} N are left over in '{panel}' {cause}"
    )
}
