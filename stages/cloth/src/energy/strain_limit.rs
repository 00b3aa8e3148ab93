//! How far warp and weft stretch before they stiffen.

/// Strain that cloth may reach, beyond which it stiffens. Shares of the length at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrainLimit {
    /// Along the warp.
    pub warp: f64,
    /// Along the weft.
    pub weft: f64,
}
