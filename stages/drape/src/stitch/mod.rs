//! Stitchers: sew the placed panels.

mod spring;
#[cfg(test)]
mod tests;

pub use spring::SpringStitcher;
use toile_core::{Migration, Registry};

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<SpringStitcher>();
    for (parameter, why) in [
        ("tugs", "seams close at the speed `closing`"),
        ("seam_stiffness", "seams close at the speed `closing`"),
        ("seam_tension", "seams close at the speed `closing`"),
        ("tolerance", "sewing ends when the seams are joined"),
        ("max_steps", "`time_limit` ends the sewing"),
        ("deepest_start", "a start inside the body is moved out or refused by itself"),
    ] {
        registry.migrate(Migration::removed("SpringStitcher", parameter, why));
    }
}
