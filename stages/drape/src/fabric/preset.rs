//! `Preset`: common cloths by name.
//!
//! The figures lie inside the ranges that textile handbooks give for each cloth as Kawabata (KES-F)
//! and Cusick orders of magnitude. They are typical, not measured on one cloth: measure yours
//! and use `Kes` or `Cloth` where it matters.

use super::AIR_DAMPING;
use super::curve::{shear_curve, tensile_curve};
use toile_core::prelude::*;

/// A common cloth by name, such as `Preset("cotton poplin")`.
///
/// Names: cotton poplin, cotton twill, denim, linen, wool suiting, wool coating, silk charmeuse,
/// polyester satin, polyester chiffon, ripstop nylon, cotton jersey, interlock knit. The figures
/// are typical of their kind (KES-F orders of magnitude from textile handbooks), not of one cloth.
#[stage(
    role = Fabric,
    source = "general textile-testing knowledge: KES-F (Kawabata 1980) and Cusick 1968 orders of magnitude",
    example = "Preset(name: \"cotton poplin\")",
    contracts(Deterministic)
)]
pub struct Preset {
    /// The cloth's name.
    #[param(default = "cotton poplin".into())]
    name: String,
    /// Whether bending has the friction that is typical of the cloth (its hysteresis 2HB): folds
    /// are held where they formed. Only `StaticEquilibrium` knows it. How strongly is measured for
    /// cottons; for wool, filaments and knits it is assumed.
    #[param(default = false)]
    hysteresis: bool,
}

#[stage]
impl Preset {
    /// Runs the stage.
    pub fn run(&self, _cx: &Context) -> Result<Fabric, StageError> {
        self.typical().map(|t| t.fabric(self.hysteresis))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.typical().err().into_iter().collect()
    }

    fn typical(&self) -> Result<&'static Typical, StageError> {
        let wanted = self.name.trim().to_lowercase();
        TYPICAL.iter().find(|t| t.name == wanted || t.also.contains(&wanted.as_str())).ok_or_else(|| {
            let names: Vec<&str> = TYPICAL.iter().map(|t| t.name).collect();
            let near = nearest(&wanted, &names);
            StageError::invalid(format!("there is no fabric preset \"{}\"", self.name))
                .hint(format!("did you mean \"{near}\"? there are: {}", names.join(", ")))
                .at("name")
        })
    }
}

/// One line of the table, in handbook units.
struct Typical {
    name: &'static str,
    /// Other names for it.
    also: &'static [&'static str],
    /// g/m2
    mass: f64,
    /// mm
    thickness: f64,
    /// Strain at 490 N/m along warp and weft, %.
    stretch: [f64; 2],
    linearity: f64,
    /// N/m per rad
    shear: f64,
    /// Bending along warp and weft, 1e-6 N m.
    bending: [f64; 2],
    /// The frictional couple of bending (half of 2HB) over the stiffness, 1/m. Six cellulosic
    /// cloths of denim's weight measured by KES have 23 to 54 (2HB / B of 0.46 to 1.07 per cm;
    /// Journal of Textiles 2016, 4614168). That wool and filaments have less and knits more is
    /// assumed: no sheet was found.
    held: f64,
    friction: f64,
}

impl Typical {
    fn fabric(&self, hysteresis: bool) -> Fabric {
        let couple = |k: usize| if hysteresis { self.held * self.bending[k] * 1e-6 } else { 0.0 };
        let tensile = |percent: f64| tensile_curve(percent / 100.0, super::curve::KES_FORCE, self.linearity);
        Fabric {
            name: self.name.into(),
            area_density: self.mass * 1e-3,
            warp: tensile(self.stretch[0]),
            weft: tensile(self.stretch[1]),
            shear: shear_curve(self.shear),
            bending_warp: self.bending[0] * 1e-6,
            bending_weft: self.bending[1] * 1e-6,
            bending_friction_warp: couple(0),
            bending_friction_weft: couple(1),
            thickness: self.thickness * 1e-3,
            friction: self.friction,
            damping: AIR_DAMPING,
            source: "typical of its kind: KES-F orders of magnitude from general textile-testing knowledge"
                .into(),
        }
    }
}

#[rustfmt::skip]
const TYPICAL: [Typical; 12] = [
    Typical { name: "cotton poplin", also: &["cotton", "poplin", "shirting"], mass: 115.0, thickness: 0.32, stretch: [3.0, 6.0], linearity: 0.75, shear: 90.0, bending: [11.0, 7.0], held: 40.0, friction: 0.17 },
    Typical { name: "cotton twill", also: &["twill", "chino"], mass: 255.0, thickness: 0.55, stretch: [3.0, 6.0], linearity: 0.75, shear: 150.0, bending: [40.0, 20.0], held: 40.0, friction: 0.18 },
    Typical { name: "denim", also: &["jeans"], mass: 420.0, thickness: 0.9, stretch: [3.0, 6.0], linearity: 0.8, shear: 220.0, bending: [150.0, 70.0], held: 45.0, friction: 0.21 },
    Typical { name: "linen", also: &["linen plain"], mass: 170.0, thickness: 0.45, stretch: [3.0, 5.0], linearity: 0.8, shear: 60.0, bending: [30.0, 18.0], held: 40.0, friction: 0.18 },
    Typical { name: "wool suiting", also: &["wool", "suiting"], mass: 230.0, thickness: 0.65, stretch: [4.0, 7.0], linearity: 0.65, shear: 38.0, bending: [14.0, 9.0], held: 22.0, friction: 0.18 },
    Typical { name: "wool coating", also: &["melton", "coating"], mass: 500.0, thickness: 2.2, stretch: [6.0, 9.0], linearity: 0.7, shear: 60.0, bending: [70.0, 50.0], held: 22.0, friction: 0.22 },
    Typical { name: "silk charmeuse", also: &["silk", "charmeuse"], mass: 75.0, thickness: 0.2, stretch: [2.5, 5.0], linearity: 0.7, shear: 16.0, bending: [3.5, 2.0], held: 20.0, friction: 0.15 },
    Typical { name: "polyester satin", also: &["satin"], mass: 105.0, thickness: 0.22, stretch: [2.5, 5.0], linearity: 0.75, shear: 22.0, bending: [7.0, 4.0], held: 20.0, friction: 0.16 },
    Typical { name: "polyester chiffon", also: &["chiffon"], mass: 60.0, thickness: 0.22, stretch: [4.0, 7.0], linearity: 0.7, shear: 16.0, bending: [1.8, 1.2], held: 20.0, friction: 0.2 },
    Typical { name: "ripstop nylon", also: &["ripstop", "nylon"], mass: 55.0, thickness: 0.11, stretch: [1.5, 2.5], linearity: 0.85, shear: 130.0, bending: [5.0, 4.0], held: 20.0, friction: 0.15 },
    Typical { name: "cotton jersey", also: &["jersey", "cotton single jersey"], mass: 155.0, thickness: 0.7, stretch: [12.0, 30.0], linearity: 0.7, shear: 36.0, bending: [2.8, 1.6], held: 50.0, friction: 0.25 },
    Typical { name: "interlock knit", also: &["interlock", "rib knit"], mass: 220.0, thickness: 1.0, stretch: [16.0, 40.0], linearity: 0.7, shear: 40.0, bending: [5.0, 3.0], held: 50.0, friction: 0.25 },
];

/// The name most like `wanted`: it shares the most pairs of neighbouring letters (Dice 1945).
fn nearest<'a>(wanted: &str, names: &[&'a str]) -> &'a str {
    let pairs = |s: &str| s.as_bytes().windows(2).map(<[u8]>::to_vec).collect::<Vec<_>>();
    let given = pairs(wanted);
    let likeness = |name: &&&str| {
        let own = pairs(name);
        let shared = own.iter().filter(|p| given.contains(p)).count();
        2000 * shared / (own.len() + given.len()).max(1)
    };
    // The first of several equals, so that the hint does not depend on anything else.
    names.iter().rev().max_by_key(likeness).copied().unwrap_or("")
}
