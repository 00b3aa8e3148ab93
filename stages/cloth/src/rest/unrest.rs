//! Why cloth has not come to rest: how fast it would still get, where, and what it meets there.

use super::pieces::Pieces;
use super::solve::Rested;
use super::system::System;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The place with the greatest force left over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalanced {
    /// The vertex of the scene.
    pub vertex: u32,
    /// The force, N.
    pub force: f64,
    /// What the cloth meets there.
    pub meets: Meets,
}

/// What cloth meets at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meets {
    /// Other cloth.
    Cloth,
    /// The body.
    Body,
    /// Nothing.
    Nothing,
}

/// The greatest force that a gradient leaves over.
pub(super) fn unbalanced(system: &System<'_>, gradient: &[Vec3], pieces: &Pieces) -> Unbalanced {
    let mut worst = (0, 0.0);
    for (n, force) in gradient.iter().map(Vec3::norm).enumerate() {
        if force > worst.1 {
            worst = (n as u32, force);
        }
    }
    let (node, force) = worst;
    let meets_cloth =
        system.layers.as_ref().is_some_and(|l| l.contacts.iter().any(|c| c.nodes.contains(&node)));
    let meets_body = system.touches.iter().any(|t| t.node == node);
    let meets = match (meets_cloth, meets_body) {
        (true, _) => Meets::Cloth,
        (_, true) => Meets::Body,
        _ => Meets::Nothing,
    };
    let vertex = pieces.node.iter().position(|n| *n == node).unwrap_or(0) as u32;
    Unbalanced { vertex, force, meets }
}

/// Why a state is not at rest, in words; `panel` is that of the place with the greatest force, and `wanted` the speed of rest, m/s.
#[must_use]
pub fn unrest(state: &Rested, panel: &str, wanted: f64) -> String {
    let (outcome, Unbalanced { force, meets, .. }) = (&state.outcome, state.unbalanced);
    let mm = |metres: f64| metres * 1e3;
    let how = match outcome.gained {
        Some(gained) => format!(
            "let go for a sixtieth of a second it would gain {:.3} mm/s, {:.3} mm/s are allowed",
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
