//! From a KES (Kawabata evaluation system) test sheet to SI values.
//!
//! A tensile test loads to 500 gf/cm and reports the strain there (EMT), the work (WT) and their ratio to a straight line (LT).
//! Two segments reproduce both EMT and LT: the break lies where a bilinear curve has that work. Half of the bending hysteresis
//! 2HB is the frictional couple of bending; that of shear (2HG) has no place in an elastic membrane. Source: Kawabata, 1980; unit factors from the definition of the gram-force.

use super::{Curve, Fabric};
use crate::error::{ClothError, check_parameter};

/// Newtons per metre of the tensile test's greatest load, 500 gf/cm.
pub(super) const TENSILE_LOAD: f64 = 490.3325;
/// N/m per radian of 1 gf/(cm degree).
pub(super) const SHEAR_UNIT: f64 = 0.980665 * 180.0 / std::f64::consts::PI;
/// N m of 1 gf cm²/cm.
pub(super) const BENDING_UNIT: f64 = 9.80665e-5;
/// N m/m of 1 gf cm/cm.
pub(super) const COUPLE_UNIT: f64 = 9.80665e-3;
/// Strain share at which the bilinear tensile curve breaks.
const BREAK_AT: f64 = 0.5;

/// One KES sheet in the units that the instrument prints. Pairs are [warp, weft].
#[derive(Debug, Clone, PartialEq)]
pub struct Kes {
    /// Strain at 500 gf/cm, percent.
    pub emt: [f64; 2],
    /// Linearity of the tensile curve, 0 to 1.
    pub lt: [f64; 2],
    /// Shear stiffness, gf/(cm degree).
    pub g: f64,
    /// Bending rigidity, gf cm²/cm.
    pub b: [f64; 2],
    /// Bending hysteresis 2HB at a curvature of 1/cm, gf cm/cm.
    pub hb: [f64; 2],
    /// Weight, mg/cm².
    pub weight: f64,
    /// Thickness at 0.5 gf/cm², mm.
    pub thickness: f64,
    /// Coefficient of friction (MIU).
    pub miu: f64,
}

impl Kes {
    /// The fabric with these measurements.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] with the KES name of the value.
    pub fn fabric(&self) -> Result<Fabric, ClothError> {
        check_parameter("G", self.g, |v| v >= 0.0, "0 or more gf/(cm degree)")?;
        let fabric = Fabric {
            density: self.weight * 0.01,
            warp: tensile(self.emt[0], self.lt[0])?,
            weft: tensile(self.emt[1], self.lt[1])?,
            poisson: 0.0,
            shear: Curve::linear(self.g * SHEAR_UNIT),
            bending_warp: self.b[0] * BENDING_UNIT,
            bending_weft: self.b[1] * BENDING_UNIT,
            bending_friction_warp: 0.5 * self.hb[0] * COUPLE_UNIT,
            bending_friction_weft: 0.5 * self.hb[1] * COUPLE_UNIT,
            thickness: self.thickness * 1e-3,
            friction: self.miu,
            damping: 0.0,
        };
        fabric.check()?;
        Ok(fabric)
    }
}

/// A bilinear curve through (EMT, 500 gf/cm) whose work is LT times the straight line's.
fn tensile(emt: f64, lt: f64) -> Result<Curve, ClothError> {
    check_parameter("EMT", emt, |v| v > 0.0, "above 0 percent")?;
    check_parameter("LT", lt, |v| (0.5..=1.5).contains(&v), "0.5 to 1.5")?;
    let strain = 0.01 * emt;
    // Work of the bilinear curve: strain/2 (break_at (F + 0) + force (1)) ... solved for the force at the break.
    let force = TENSILE_LOAD * (lt - (1.0 - BREAK_AT));
    Curve::through(&[[BREAK_AT * strain, force], [strain, TENSILE_LOAD]])
}
