//! What a garment is compared with.

/// Limits of the checks; shares unless a unit is named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckLimits {
    /// Greatest gap of a seam, metres.
    pub gap: f64,
    /// Greatest distance between a panel's flat outline and that of its piece, metres.
    pub outline: f64,
    /// Greatest area error of a panel, as `Measure` has it: what the body stretches counts as it
    /// was cut.
    pub area_error: f64,
    /// Greatest error of the length of a panel's outline, as above.
    pub outline_error: f64,
    /// Greatest 99th percentile of the strain of the edges that the body does not stretch.
    pub strain: f64,
    /// Greatest 99th percentile of the strain of a panel's edges that the body stretches.
    pub tight: f64,
    /// Greatest strain of any triangle in any direction.
    pub strain_max: f64,
    /// Greatest depth of a vertex in the body, metres.
    pub depth: f64,
    /// The greatest share of the vertices that get faster than 5 mm/s when the garment is let go.
    pub moving: f64,
    /// The farthest that the garment moves when it is let go, but for a share of its vertices,
    /// metres.
    pub shift: f64,
}

impl Default for CheckLimits {
    fn default() -> Self {
        Self {
            gap: 5e-4,
            outline: 2e-3,
            area_error: 0.03,
            outline_error: 0.03,
            strain: 0.05,
            tight: 0.25,
            strain_max: 1.0,
            depth: 1e-4,
            moving: crate::released::NON_STATIC,
            shift: 5e-3,
        }
    }
}
