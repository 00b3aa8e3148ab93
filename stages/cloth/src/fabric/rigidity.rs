//! Bending rigidity by direction.

use super::Fabric;
use crate::error::{ClothError, check_parameter};

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

    pub(crate) fn is_zero(&self) -> bool {
        self.warp == 0.0 && self.weft == 0.0
    }

    pub(crate) fn check(&self) -> Result<(), ClothError> {
        for (name, value) in [("bending_warp", self.warp), ("bending_weft", self.weft)] {
            check_parameter(name, value, |v| v >= 0.0, "0 or more N m")?;
        }
        Ok(())
    }
}
