//! Bending models: the energy of folds.
//!
//! | model | promises | costs |
//! |---|---|---|
//! | [`Hinge`] | rigidity D in every direction on every mesh but alternating squares, at any fold,
//! at free edges | three angles per triangle |
//! | [`Quadratic`] | the same for a sheet that hardly stretches; its matrix never changes | a fixed
//! product per edge |
//! | [`DiscreteShell`] | rigidity D on the mean of all directions, and never folds through itself |
//! one angle per edge |
//! | [`SkipOne`] | the classic spring over every second vertex: nothing against a small fold | one
//! square root per edge |
//!
//! Beside them: [`FreeEdge`] for the borders of quadratic hinges, [`ClampedEdge`] for a slope that
//! is held, [`Creases`] for pressed folds, [`Hysteresis`] for the friction between yarns.

mod angle;
mod calibrate;
mod clamp;
mod crease;
mod flap;
mod free_edge;
mod hinge;
mod hysteresis;
mod patch;
mod quadratic;
mod shell;
mod skip;

#[cfg(test)]
mod tests;

pub(crate) use calibrate::Calibration;
pub use clamp::ClampedEdge;
pub use crease::Creases;
pub use free_edge::FreeEdge;
pub use hinge::Hinge;
pub use hysteresis::Hysteresis;
pub use quadratic::{Fold, Quadratic, folds_of};
pub use shell::DiscreteShell;
pub use skip::SkipOne;
