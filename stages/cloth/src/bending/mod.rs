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

use crate::fabric::Fabric;

/// Bending rigidity of a sheet by direction, N m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigidity {
    /// Of a strip cut along the rest y axis.
    pub warp: f64,
    /// Of a strip cut along the rest x axis.
    pub weft: f64,
}

impl Rigidity {
    /// The same in all directions.
    #[must_use]
    pub fn uniform(d: f64) -> Self {
        Self { warp: d, weft: d }
    }

    /// The fabric's.
    #[must_use]
    pub fn of(fabric: &Fabric) -> Self {
        Self { warp: fabric.bending_warp, weft: fabric.bending_weft }
    }

    /// For curvature along the unit direction (x, y).
    #[must_use]
    pub fn along(&self, direction: &nalgebra::Vector2<f64>) -> f64 {
        self.weft * direction.x * direction.x + self.warp * direction.y * direction.y
    }

    pub(crate) fn check(&self) -> Result<(), crate::error::ClothError> {
        for (name, value) in [("bending_warp", self.warp), ("bending_weft", self.weft)] {
            crate::error::check_parameter(name, value, |v| v >= 0.0, "0 or more N m")?;
        }
        Ok(())
    }
}
