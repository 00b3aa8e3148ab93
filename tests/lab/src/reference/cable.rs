//! The elastic catenary: a strip of rest length 1 and weight 1 held at two level edges (Irvine,
//! 1981).

use super::root;

/// A hanging strip; lengths in strip lengths, forces in strip weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Catenary {
    /// Depth of the middle under the supports.
    pub sag: f64,
    /// Level part of the tension.
    pub level: f64,
    /// Tension at the supports.
    pub support: f64,
}

/// For supports `span` apart (below 1, or at any distance if `beta > 0`), `beta` = weight over
/// stiffness; linear law of engineering strain.
#[must_use]
pub fn catenary(span: f64, beta: f64) -> Catenary {
    let miss = |h: f64| h * beta + 2.0 * h * (0.5 / h).asinh() - span;
    let high = if beta > 0.0 { (2.0 * span / beta).max(10.0) } else { 1e9 };
    let level = root(1e-9, high, miss);
    let support = level.hypot(0.5);
    Catenary { sag: beta / 8.0 + support - level, level, support }
}
