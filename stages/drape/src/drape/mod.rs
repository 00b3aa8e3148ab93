//! Drapers: the sewn garment under gravity.

mod again;
mod asleep;
pub(crate) mod by_place;
mod central_differences;
mod frames;
mod implicit_euler;
mod layers;
mod mixed_precision;
mod models;
mod motion;
mod projective;
mod soften;
mod spring;
mod spring_sewing;
mod starts;
mod static_equilibrium;
#[cfg(test)]
mod tests;
mod xpbd;

pub use central_differences::CentralDifferences;
pub use implicit_euler::ImplicitEuler;
pub use mixed_precision::FactorPrecision;
pub use models::{BendingModel, MembraneModel};
pub use motion::{InTime, SewThrough};
pub use projective::Projective;
pub use spring::SpringDraper;
pub(crate) use spring_sewing::SewingFor;
pub use spring_sewing::{SeamPull, SpringSewing};
pub use static_equilibrium::{ProofSteps, StaticEquilibrium};
use toile_core::{Migration, Registry};
pub use xpbd::Xpbd;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<StaticEquilibrium>();
    registry.add::<ImplicitEuler>();
    registry.add::<Xpbd>();
    registry.add::<Projective>();
    registry.add::<CentralDifferences>();
    registry.add::<SpringDraper>();
    registry.migrate(Migration::stage("Rest", "StaticEquilibrium"));
    registry.migrate(Migration::renamed("StaticEquilibrium", "graded", "bending_continuation"));
    for (parameter, why) in [
        ("tolerance", "rest is a change of energy below 0.1 % in a sixtieth of a second"),
        ("max_steps", "`time_limit` ends the motion"),
    ] {
        registry.migrate(Migration::removed("SpringDraper", parameter, why));
    }
}
