//! The load of panels under their own weight, for messages about cloth that cannot be solved.

use crate::scene::Scene;
use std::fmt;

/// Strain under its own weight above which the load is named as the cause.
const HEAVY: f64 = 0.1;

/// The load of a panel that hangs at its full length, and its stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// Its length along or across the warp, m.
    pub length: f64,
    /// Its weight a metre of width, N/m.
    pub weight: f64,
    /// Its stretch stiffness in that direction, N/m.
    pub stiffness: f64,
}

impl Load {
    /// The load of the panel and direction that stretch most under their own weight.
    pub(crate) fn of(scene: &Scene, gravity: f64) -> Self {
        let of = |k: usize| {
            let (panel, fabric) = (&scene.panels[k], scene.fabric_of(k));
            let along = |axis: usize, stiffness: f64| {
                let values = scene.rest[panel.vertices.clone()].iter().map(|p| p[axis]);
                let [low, high] = values
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [f64::min(l, v), f64::max(h, v)]);
                let length = (high - low).max(0.0);
                Self { length, weight: fabric.density * gravity * length, stiffness }
            };
            [along(1, fabric.warp.slope(0.0)), along(0, fabric.weft.slope(0.0))]
        };
        let none = Self { length: 0.0, weight: 0.0, stiffness: 1.0 };
        let more = |best: Self, next: Self| if next.strain() > best.strain() { next } else { best };
        (0..scene.panels.len()).flat_map(of).fold(none, more)
    }

    /// Whether the weight is so great for the stiffness that it is the likely cause of a fault.
    #[must_use]
    pub fn is_heavy(&self) -> bool {
        self.strain() > HEAVY
    }

    /// Weight over stiffness: the strain at its upper end.
    #[must_use]
    pub fn strain(&self) -> f64 {
        self.weight / self.stiffness
    }
}

impl fmt::Display for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { length, weight, stiffness } = self;
        let strain = 1e2 * self.strain();
        write!(
            f,
            "a length of {length:.2} m weighs {weight:.1} N a metre of width, which stretches a stiffness of {stiffness:.1} N/m by \
             {strain:.0} %; "
        )?;
        match self.is_heavy() {
            true => f.write_str("look whether the area density is in kg/m^2 and the stiffness in N/m"),
            false => f.write_str("place its panels more smoothly, or begin on a finer mesh"),
        }
    }
}
