//! What a sheet resists when it is folded.
//!
//! | model | promises | costs |
//! |---|---|---|
//! | [`Hinge`] | rigidity D in every direction on every mesh but alternating squares, at any fold, at free edges | three angles a triangle |
//! | [`QuadraticHinge`] | the same for a sheet that hardly stretches; its matrix never changes | a fixed product a triangle |
//! | [`LoneHinge`] | D on the mean of all directions; needs [`FreeEdge`] at free edges | one angle an edge |
//! | [`SkipOne`] | the classic spring over every second vertex: nothing against a small fold | one square root an edge |
//! | [`Clamp`] | holds the slope along an edge beside lone hinges | one angle an edge |

mod angle;
mod calibrate;
mod clamp;
mod flap;
mod free_edge;
mod hinge;
mod lone;
mod patch;
mod quadratic;
mod skip;

#[cfg(test)]
mod tests;

pub(crate) use calibrate::Calibration;
pub use clamp::Clamp;
pub(crate) use flap::flaps;
pub use free_edge::FreeEdge;
pub use hinge::Hinge;
pub use lone::{HingeTerm, LoneHinge, hinge_terms};
pub use quadratic::QuadraticHinge;
pub use skip::SkipOne;

pub use crate::fabric::Rigidity;
