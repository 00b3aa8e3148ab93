//! Half a set-in sleeve, before the arm.

use super::{DraftEdge, DraftPanel, PlanePoint, curve, line};

/// Degrees between the mannequin's arms and the vertical.
const ARM: f64 = 60.0;

/// Measures of half a sleeve, from the under arm to the over arm seam. Halves that are sewn to each
/// other have equal heights.
pub(super) struct HalfSleeve {
    /// Length of the under arm seam, and height of the cap above it.
    pub(super) under: f64,
    pub(super) high: f64,
    /// Length of the cap: the sleeve is as wide as it asks.
    pub(super) cap: f64,
    /// What the hem is narrower.
    pub(super) narrow: f64,
    /// A point of the arm's axis, and how far from it along the arm the sleeve begins.
    pub(super) axis: PlanePoint,
    pub(super) gap: f64,
    /// Distance before the body.
    pub(super) z: f64,
}

impl HalfSleeve {
    /// The left sleeve's half.
    pub(super) fn panel(&self, name: &str) -> DraftPanel {
        let ends = |wide: f64| ([-wide / 2.0, self.under], [wide / 2.0, self.under + self.high]);
        let (mut least, mut most) = (0.0, self.cap);
        for _ in 0..60 {
            let middle = (least + most) / 2.0;
            let (low, high) = ends(middle);
            if cap(low, high).length(high, low) < self.cap { least = middle } else { most = middle }
        }
        let (low, high) = ends(least);
        let hem = (least - self.narrow) / 2.0;
        let (sin, cos) = ARM.to_radians().sin_cos();
        let along = self.gap + high[1];
        let corners = [[-hem, 0.0], [hem, 0.0], high, low];
        let edges = [line("hem"), line("over_arm"), cap(low, high), line("under_arm")];
        let at = [self.axis[0] + along * sin, self.axis[1] - along * cos, self.z];
        DraftPanel { turn: ARM, ..DraftPanel::new(name, "arm", &corners, &edges, at) }
    }
}

/// The cap: hollow above the under arm, round and level at the over arm.
fn cap(low: PlanePoint, high: PlanePoint) -> DraftEdge {
    let wide = high[0] - low[0];
    curve("cap", high, low, &[[high[0] - 0.45 * wide, high[1]], [low[0] + 0.4 * wide, low[1]]])
}
