//! Fabrics to start from. Each says where its numbers come from; none claims to be one measured cloth.

use super::{Curve, Fabric};

/// A named fabric.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preset {
    /// What to call it.
    pub name: &'static str,
    /// Where its numbers come from.
    pub source: &'static str,
    density: f64,
    secant: f64,
    shear: f64,
    bending: f64,
    thickness: f64,
    friction: f64,
}

const TEXTBOOK: &str =
    "middle of the range that textile-testing textbooks give for KES-F values; not a measured cloth";

/// All presets.
pub const PRESETS: [Preset; 5] = [
    Preset {
        name: "bench",
        source: "the neutral material of the benchmark scenes",
        density: 0.15,
        secant: 500.0,
        shear: 50.0,
        bending: 1e-5,
        thickness: 1e-3,
        friction: 0.4,
    },
    Preset {
        name: "cotton-poplin",
        source: TEXTBOOK,
        density: 0.115,
        secant: 1.1e4,
        shear: 87.0,
        bending: 8.5e-6,
        thickness: 0.34e-3,
        friction: 0.17,
    },
    Preset {
        name: "denim",
        source: TEXTBOOK,
        density: 0.42,
        secant: 1.2e4,
        shear: 195.0,
        bending: 9.8e-5,
        thickness: 0.88e-3,
        friction: 0.21,
    },
    Preset {
        name: "wool-suiting",
        source: TEXTBOOK,
        density: 0.225,
        secant: 9.0e3,
        shear: 38.0,
        bending: 1.1e-5,
        thickness: 0.67e-3,
        friction: 0.18,
    },
    Preset {
        name: "wool-coating",
        source: TEXTBOOK,
        density: 0.49,
        secant: 8.2e3,
        shear: 58.0,
        bending: 5.4e-5,
        thickness: 2.1e-3,
        friction: 0.22,
    },
];

impl Preset {
    /// Its values.
    #[must_use]
    pub fn fabric(&self) -> Fabric {
        Fabric {
            thickness: self.thickness,
            friction: self.friction,
            shear: Curve::linear(self.shear),
            ..Fabric::isotropic(self.density, self.secant, 0.0, self.bending)
        }
    }
}
