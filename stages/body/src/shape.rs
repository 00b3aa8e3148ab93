//! What the parts of a figure are made from: its size, its aims, its levels.

use crate::form::{BodyForm, HIP_ROW, WOMAN};
use toile_core::artifact::Point3;

/// What a figure is made to, metres and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FigureSize {
    /// Crown to sole.
    pub height: f64,
    /// Girth at the bust.
    pub bust: f64,
    /// Girth at the waist.
    pub waist: f64,
    /// Girth at the hip.
    pub hip: f64,
    /// Shoulder point to shoulder point.
    pub shoulder_width: f64,
    /// Girth of the neck.
    pub neck: f64,
    /// Shoulder point, elbow, wrist.
    pub arm: f64,
    /// Fork of the legs to sole.
    pub inseam: f64,
    /// Angle between the upper arm and the vertical.
    pub arm_angle: f64,
}

/// The adult whose sections stand in [`crate::form`].
pub(crate) const ADULT: FigureSize = FigureSize {
    height: 1.72,
    bust: 0.88,
    waist: 0.70,
    hip: 0.96,
    shoulder_width: 0.386,
    neck: 0.345,
    arm: 0.575,
    inseam: 0.797,
    arm_angle: std::f64::consts::FRAC_PI_3,
};
/// The adult's height up to the chin.
pub(crate) const ADULT_CHIN: f64 = 1.495;

/// Levels of the tape measures and joints as shares of the height up to the chin.
pub(crate) mod level {
    /// Fork of the legs.
    pub(crate) const CROTCH: f64 = 0.533;
    /// Fullest place of the seat.
    pub(crate) const HIP: f64 = 0.598;
    /// Narrowest place of the trunk.
    pub(crate) const WAIST: f64 = 0.725;
    /// Fullest place of the chest.
    pub(crate) const BUST: f64 = 0.828;
    /// Outer point of the shoulder.
    pub(crate) const SHOULDER: f64 = 0.938;
    /// Where the shoulder line meets the neck.
    pub(crate) const NECK: f64 = 0.974;
    /// Where the neck's girth is taken, along its axis.
    pub(crate) const NECK_GIRTH: f64 = 0.988;
}

/// The height of the head from chin to crown: from 18 cm at one year to 22.5 cm grown up.
pub(crate) fn head_height(height: f64) -> f64 {
    0.18 + (height.min(1.72) - 0.8) * (0.045 / 0.92) + (height - 1.72).max(0.0) * 0.09
}

/// The height up to the chin, metres.
pub(crate) fn chin(height: f64) -> f64 {
    height - head_height(height)
}

/// What is aimed at so that the skin has the measures that are asked for: factors of the adult's
/// sections and lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aims {
    /// Factors of the trunk's sections at hip, waist and bust.
    pub trunk: [f64; 3],
    /// Radius of the neck, metres.
    pub neck: f64,
    /// Factor of the arms' length.
    pub arm: f64,
    /// Height of the legs' fork, metres.
    pub crotch: f64,
}

impl Aims {
    /// Where the search begins.
    pub(crate) fn first(size: &FigureSize) -> Self {
        Aims {
            trunk: [size.hip / ADULT.hip, size.waist / ADULT.waist, size.bust / ADULT.bust],
            neck: size.neck / std::f64::consts::TAU,
            arm: size.arm / ADULT.arm * ADULT_CHIN / chin(size.height),
            crotch: size.inseam,
        }
    }
}

/// Makes the parts of a figure.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FigureShape {
    /// The measures.
    pub size: FigureSize,
    /// Woman, man or child.
    pub form: BodyForm,
    /// What is aimed at.
    pub aims: Aims,
    /// The height up to the chin, metres.
    pub chin: f64,
    /// Skeleton against the adult's.
    pub stature: f64,
    /// The head against the adult's.
    pub head: f64,
}

impl FigureShape {
    pub(crate) fn new(size: &FigureSize, form: &BodyForm, aims: &Aims) -> Self {
        let chin = chin(size.height);
        let head = head_height(size.height) / 0.225;
        FigureShape { size: *size, form: *form, aims: *aims, chin, stature: chin / ADULT_CHIN, head }
    }

    /// The height of a level: shares of the height up to the chin, shifted so that the fork of the
    /// legs is where it is aimed at.
    pub(crate) fn y(&self, level: f64) -> f64 {
        let (fork, neck) = (level::CROTCH, level::NECK);
        match level {
            l if l <= fork => self.aims.crotch * l / fork,
            l if l < neck => {
                let top = neck * self.chin;
                self.aims.crotch + (top - self.aims.crotch) * (l - fork) / (neck - fork)
            }
            l => l * self.chin,
        }
    }

    pub(crate) fn hip(&self) -> f64 {
        self.aims.trunk[0]
    }

    pub(crate) fn bust(&self) -> f64 {
        self.aims.trunk[2]
    }

    /// Thickness of the arms: mostly by stature, so that the armpits of stout figures stay open.
    pub(crate) fn arm_build(&self) -> f64 {
        self.form.arm * self.stature.powf(0.65) * self.bust().powf(0.35)
    }

    /// Thickness of the other limbs: half by stature, half by girth.
    pub(crate) fn build(&self, scale: f64) -> f64 {
        (self.stature * scale).sqrt()
    }

    /// The width of the hip against a woman's of the same girth.
    pub(crate) fn width_of_hip(&self) -> f64 {
        self.form.trunk[HIP_ROW][1] / WOMAN.trunk[HIP_ROW][1]
    }

    /// Where the left leg leaves the hip and where its ankle is, to the side of the middle.
    pub(crate) fn leg_out(&self) -> [f64; 2] {
        let out = 0.093 * self.hip() * self.width_of_hip();
        [out * 0.98, out + 0.008 * self.stature]
    }

    /// A point of the head: measured from the crown on the adult.
    pub(crate) fn of_head(&self, x: f64, down: f64, z: f64) -> Point3 {
        Point3::new(x * self.head, self.size.height - down * self.head, z * self.head)
    }
}
