//! `Kes`: a cloth by the figures of the Kawabata test.

use super::AIR_DAMPING;
use super::curve::{GREATEST_LINEARITY, KES_FORCE, LEAST_LINEARITY, shear_curve, tensile_curve};
use toile_core::prelude::*;

/// 1 gf cm2/cm, N m.
const BENDING: f64 = 9.806_65e-5;
/// 1 gf cm/cm, N m/m.
const COUPLE: f64 = 9.806_65e-3;
/// 1 gf/(cm degree), N/m per rad.
const SHEAR: f64 = 56.188;

/// A cloth by the figures on its Kawabata (KES-F) sheet, in that sheet's own units.
///
/// Pairs are (warp, weft). Tensile strain and linearity are those of the test up to 500 gf/cm.
#[stage(
    role = Fabric,
    source = "Kawabata, 1980",
    example = "Kes(weight: 12.0, emt: (3.0, 6.0), lt: 0.75, g: 1.6, b: (0.11, 0.07))",
    contracts(Deterministic)
)]
pub struct Kes {
    /// Weight W.
    #[param(default = 12.0, min = 0.1, max = 500.0, unit = "mg/cm2")]
    weight: f64,
    /// Strain EMT at 500 gf/cm, warp and weft.
    #[param(default = (3.0, 6.0), min = 0.05, max = 300.0, unit = "%")]
    emt: (f64, f64),
    /// Linearity LT of the tensile curve.
    #[param(default = 0.75, min = LEAST_LINEARITY, max = GREATEST_LINEARITY)]
    lt: f64,
    /// Shear stiffness G.
    #[param(default = 1.6, min = 0.001, max = 100.0, unit = "gf/(cm degree)")]
    g: f64,
    /// Bending stiffness B, warp and weft.
    #[param(default = (0.11, 0.07), min = 0.0, max = 1000.0, unit = "gf cm2/cm")]
    b: (f64, f64),
    /// Bending hysteresis 2HB, warp and weft; it holds folds, and only `StaticEquilibrium` knows
    /// it.
    #[param(default = (0.0, 0.0), min = 0.0, max = 1000.0, unit = "gf cm/cm")]
    hb: (f64, f64),
    /// Thickness T0 at 0.5 gf/cm2.
    #[param(default = 0.35, min = 0.01, max = 50.0, unit = "mm")]
    thickness: f64,
    /// Surface friction MIU.
    #[param(default = 0.18, min = 0.0, max = 2.0)]
    miu: f64,
}

#[stage]
impl Kes {
    /// Runs the stage.
    pub fn run(&self, _cx: &Context) -> Result<Fabric, StageError> {
        let tensile = |percent: f64| tensile_curve(percent / 100.0, KES_FORCE, self.lt);
        Ok(Fabric {
            name: "KES sheet".into(),
            // 1 mg/cm2 = 0.01 kg/m2
            area_density: self.weight * 0.01,
            warp: tensile(self.emt.0),
            weft: tensile(self.emt.1),
            shear: shear_curve(self.g * SHEAR),
            bending_warp: self.b.0 * BENDING,
            bending_weft: self.b.1 * BENDING,
            bending_friction_warp: 0.5 * self.hb.0 * COUPLE,
            bending_friction_weft: 0.5 * self.hb.1 * COUPLE,
            thickness: self.thickness * 1e-3,
            friction: self.miu,
            damping: AIR_DAMPING,
            source: "KES sheet given in the pipeline".into(),
        })
    }
}
