//! What a cloth is made of.

use super::{Artifact, ArtifactType, Kind, Measures};
use crate::artifact::store::sound::{ensure, positive};
use serde::{Deserialize, Serialize};

/// A piecewise-linear force-strain curve through the origin, per metre of width.
///
/// Points are (strain, N/m), both strictly rising; beyond the last point the last slope continues;
/// compression follows the first slope.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve(pub Vec<(f64, f64)>);

impl Curve {
    /// A straight line with stiffness `k`, N/m.
    pub fn linear(k: f64) -> Self {
        Curve(vec![(1.0, k)])
    }

    /// True where both strain and force rise from the origin, point by point.
    pub fn rises(&self) -> bool {
        let steps = std::iter::once(&(0.0, 0.0)).chain(&self.0).zip(&self.0);
        let mut steps = steps.map(|(a, b)| b.0 > a.0 && b.1 > a.1 && b.0.is_finite() && b.1.is_finite());
        !self.0.is_empty() && steps.all(|rises| rises)
    }

    /// Line force (N/m) and its slope (N/m) at a strain.
    pub fn at(&self, strain: f64) -> (f64, f64) {
        let mut from = (0.0, 0.0);
        for (i, &to) in self.0.iter().enumerate() {
            if strain <= to.0 || i + 1 == self.0.len() {
                let slope = (to.1 - from.1) / (to.0 - from.0);
                return (from.1 + slope * (strain - from.0), slope);
            }
            from = to;
        }
        (0.0, 0.0)
    }

    /// Stored energy per area at a strain, J/m2.
    pub fn energy(&self, strain: f64) -> f64 {
        let (mut from, mut energy) = ((0.0, 0.0), 0.0);
        for (i, &to) in self.0.iter().enumerate() {
            let last = strain <= to.0 || i + 1 == self.0.len();
            let end = if last { (strain, self.at(strain).0) } else { to };
            energy += (from.1 + end.1) / 2.0 * (end.0 - from.0);
            if last {
                break;
            }
            from = to;
        }
        energy
    }

    /// The steepest slope, N/m, which bounds the time step.
    pub fn steepest(&self) -> f64 {
        let from = std::iter::once((0.0, 0.0)).chain(self.0.iter().copied());
        from.zip(&self.0).map(|(a, b)| (b.1 - a.1) / (b.0 - a.0)).fold(0.0, f64::max)
    }
}

/// A fabric in SI units, per unit width where it is a sheet quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fabric {
    /// Name, for reports.
    pub name: String,
    /// Mass per area, kg/m2.
    pub area_density: f64,
    /// Tensile curve along the warp (pattern y).
    pub warp: Curve,
    /// Tensile curve along the weft (pattern x).
    pub weft: Curve,
    /// Shear curve: shear angle (rad) against N/m.
    pub shear: Curve,
    /// Bending stiffness along the warp, N m.
    pub bending_warp: f64,
    /// Bending stiffness along the weft, N m.
    pub bending_weft: f64,
    /// Friction of a strip cut along the warp while it is bent: half of the hysteresis 2HB, N m per
    /// m of width. 0 where it is not known.
    #[serde(default)]
    pub bending_friction_warp: f64,
    /// The same along the weft.
    #[serde(default)]
    pub bending_friction_weft: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Friction coefficient, cloth on cloth and on the body.
    pub friction: f64,
    /// Velocity damping, 1/s.
    pub damping: f64,
    /// Where the figures come from.
    pub source: String,
}

impl ArtifactType for Fabric {
    const KIND: Kind = Kind("fabric");
    const IN_SETS: bool = false;
}

impl Artifact for Fabric {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.push("area_density", self.area_density * 1e3, "g/m2", 1e-6);
        m.push("thickness", self.thickness * 1e3, "mm", 1e-6);
        m
    }

    fn check(&self) -> Result<(), String> {
        positive("area density", self.area_density)?;
        for (curve, word) in [(&self.warp, "warp"), (&self.weft, "weft"), (&self.shear, "shear")] {
            ensure(curve.rises(), || {
                format!(
                    "its {word} curve does not rise from the origin: strains and forces must be above 0 and rise"
                )
            })?;
        }
        let bending =
            [self.bending_warp, self.bending_weft, self.bending_friction_warp, self.bending_friction_weft];
        let rest = bending.iter().chain([&self.thickness, &self.friction, &self.damping]);
        let held = rest.into_iter().all(|x| x.is_finite() && *x >= 0.0);
        ensure(held, || "bending, thickness, friction and damping must be finite and at least 0".to_owned())
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}
