//! `Cloth`: a cloth by its mechanics in SI units.

use super::AIR_DAMPING;
use super::curve::shear_curve;
use toile_core::prelude::*;

/// A cloth by its mechanics, in SI units, with tensile curves point by point.
///
/// A curve is a list of (strain, N/m) points that rise in both; it starts at (0, 0) and goes on
/// with its last slope.
#[stage(
    role = Fabric,
    source = "Fan, Zhou, Wang, Yuen, 1999: stiffness piecewise linear in the strain",
    example = "Cloth(density: 0.12, warp: [(0.01, 60), (0.03, 490)], weft: [(0.02, 60), (0.06, 490)])",
    contracts(Deterministic)
)]
pub struct Cloth {
    /// Mass per area.
    #[param(default = 0.12, min = 0.001, max = 10.0, unit = "kg/m2")]
    density: f64,
    /// Tensile curve along the warp: strain and N/m.
    #[param(default = vec![(0.015, 123.0), (0.03, 490.0)], min = 1e-9, max = 1e9)]
    warp: Vec<(f64, f64)>,
    /// Tensile curve along the weft: strain and N/m.
    #[param(default = vec![(0.03, 123.0), (0.06, 490.0)], min = 1e-9, max = 1e9)]
    weft: Vec<(f64, f64)>,
    /// Shear stiffness.
    #[param(default = 90.0, min = 0.01, max = 1e6, unit = "N/m per rad")]
    shear: f64,
    /// Bending stiffness along warp and weft.
    #[param(default = (1.1e-5, 7e-6), min = 0.0, max = 1.0, unit = "N m")]
    bending: (f64, f64),
    /// Friction of bending along warp and weft, half of the hysteresis 2HB; it holds folds, and
    /// only `StaticEquilibrium` knows it.
    #[param(default = (0.0, 0.0), min = 0.0, max = 1.0, unit = "N m/m")]
    bending_friction: (f64, f64),
    /// Thickness.
    #[param(default = Length::mm(0.35), min = 1e-5, max = 0.05)]
    thickness: Length,
    /// Friction coefficient, cloth on cloth.
    #[param(default = 0.18, min = 0.0, max = 2.0)]
    friction: f64,
    /// Damping of its motion by air and inner friction.
    #[param(default = AIR_DAMPING, min = 0.0, max = 1000.0, unit = "1/s")]
    damping: f64,
}

#[stage]
impl Cloth {
    /// Runs the stage.
    pub fn run(&self, _cx: &Context) -> Result<Fabric, StageError> {
        Ok(Fabric {
            name: "cloth".into(),
            area_density: self.density,
            warp: rising(&self.warp, "warp")?,
            weft: rising(&self.weft, "weft")?,
            shear: shear_curve(self.shear),
            bending_warp: self.bending.0,
            bending_weft: self.bending.1,
            bending_friction_warp: self.bending_friction.0,
            bending_friction_weft: self.bending_friction.1,
            thickness: self.thickness.metres(),
            friction: self.friction,
            damping: self.damping,
            source: "given in the pipeline".into(),
        })
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        let curves = [(&self.warp, "warp"), (&self.weft, "weft")];
        curves.into_iter().filter_map(|(points, param)| rising(points, param).err()).collect()
    }
}

/// The points as a curve that rises from the origin.
fn rising(points: &[(f64, f64)], param: &'static str) -> Result<Curve, StageError> {
    let mut last = (0.0, 0.0);
    for (i, &p) in points.iter().enumerate() {
        if !(p.0 > last.0 && p.1 > last.1) {
            let text = format!(
                "point {} of the {param} curve, ({}, {}), does not rise above ({}, {})",
                i + 1,
                p.0,
                p.1,
                last.0,
                last.1
            );
            return Err(StageError::new(ErrorCode::InvalidParameter, text)
                .hint("give points (strain, N/m) that rise in both, without the origin")
                .at(param)
                .within(i));
        }
        last = p;
    }
    match points.is_empty() {
        true => Err(StageError::new(ErrorCode::InvalidParameter, format!("the {param} curve has no points"))
            .hint("give at least one point (strain, N/m)")
            .at(param)),
        false => Ok(Curve(points.to_vec())),
    }
}
