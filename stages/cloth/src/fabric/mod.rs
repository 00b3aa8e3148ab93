//! What a fabric is: mass, tensile curves, shear, bending, damping. Cloths by name and by their KES
//! (Kawabata) sheets are stages.
//!
//! Every quantity is per unit width of the sheet, in SI units: kg/m², N/m, N/m per radian, N m.

mod curve;
mod rigidity;

#[cfg(test)]
mod tests;

pub use curve::Curve;
pub use rigidity::Rigidity;

use crate::error::{ClothError, check_parameter};

/// Strain of a worn garment where it carries load.
pub const IN_USE: f64 = 0.02;

/// The mechanical values of one fabric. Warp runs along the rest shape's y, weft along x.
#[derive(Debug, Clone, PartialEq)]
pub struct Fabric {
    /// Area density, kg/m².
    pub density: f64,
    /// Tension (N/m) over engineering strain along the warp.
    pub warp: Curve,
    /// Tension (N/m) over engineering strain along the weft.
    pub weft: Curve,
    /// Contraction of the weft under warp tension (Poisson's ratio of the weave), 0 to below 1.
    pub poisson: f64,
    /// Shear force (N/m) over shear angle (radians).
    pub shear: Curve,
    /// Bending rigidity of a strip cut along the warp, N m.
    pub bending_warp: f64,
    /// Bending rigidity of a strip cut along the weft, N m.
    pub bending_weft: f64,
    /// Friction of a strip cut along the warp while it is bent: half of the hysteresis 2HB, N m per
    /// m of width. Only `StaticEquilibrium` uses it.
    pub bending_friction_warp: f64,
    /// The same of a strip cut along the weft, N m/m.
    pub bending_friction_weft: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Coulomb friction of cloth on cloth and body.
    pub friction: f64,
    /// Damping of strain waves, as stiffness-proportional damping time, s.
    pub damping: f64,
}

impl Fabric {
    /// An isotropic fabric: stiffness `k` (N/m), Poisson's ratio, bending rigidity `bending` (N m).
    #[must_use]
    pub fn isotropic(density: f64, k: f64, poisson: f64, bending: f64) -> Self {
        Self {
            density,
            warp: Curve::linear(k),
            weft: Curve::linear(k),
            poisson,
            shear: Curve::linear(k / (2.0 * (1.0 + poisson))),
            bending_warp: bending,
            bending_weft: bending,
            bending_friction_warp: 0.0,
            bending_friction_weft: 0.0,
            thickness: 1e-3,
            friction: 0.3,
            damping: 0.0,
        }
    }

    /// Checks every value.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] or [`ClothError::NonFiniteInput`], naming the first bad
    /// value.
    pub fn check(&self) -> Result<(), ClothError> {
        check_parameter("density", self.density, |v| v > 0.0, "above 0 kg/m^2")?;
        check_parameter("poisson", self.poisson, |v| (0.0..1.0).contains(&v), "0 to below 1")?;
        let not_negative = [
            ("bending_warp", self.bending_warp),
            ("bending_weft", self.bending_weft),
            ("bending_friction_warp", self.bending_friction_warp),
            ("bending_friction_weft", self.bending_friction_weft),
            ("thickness", self.thickness),
            ("friction", self.friction),
            ("damping", self.damping),
        ];
        for (name, value) in not_negative {
            check_parameter(name, value, |v| v >= 0.0, "0 or more")?;
        }
        for (name, curve) in [("warp", &self.warp), ("weft", &self.weft), ("shear", &self.shear)] {
            check_parameter(name, curve.slope(0.0), |v| v > 0.0, "a slope above 0 N/m")?;
        }
        let product = self.poisson_squared();
        check_parameter("poisson", product, |v| v < 1.0, "so small that warp and weft stay stable together")
    }

    /// The frictional couple of bending by direction, N m/m.
    #[must_use]
    pub fn bending_friction(&self) -> Rigidity {
        Rigidity { warp: self.bending_friction_warp, weft: self.bending_friction_weft }
    }

    /// Whether bending has friction.
    #[must_use]
    pub fn has_bending_friction(&self) -> bool {
        self.bending_friction_warp.max(self.bending_friction_weft) > 0.0
    }

    /// Tensile stiffness in use, N/m: the greater of warp and weft, as force over strain at
    /// [`IN_USE`].
    #[must_use]
    pub fn stretch(&self) -> f64 {
        self.warp.force(IN_USE).max(self.weft.force(IN_USE)) / IN_USE
    }

    /// nu12 nu21 of the linear range.
    #[must_use]
    pub fn poisson_squared(&self) -> f64 {
        let (warp, weft) = (self.warp.slope(0.0), self.weft.slope(0.0));
        if warp > 0.0 { self.poisson * self.poisson * weft / warp } else { 0.0 }
    }
}
