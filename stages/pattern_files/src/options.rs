//! What drawings of a pattern are asked to be.

use crate::allowance::Allowances;

/// Options of drawings.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DrawingOptions {
    /// Seam allowance; none by default.
    pub allowances: Allowances,
    /// The size that the pattern is drafted for, such as `M`; empty where it has no name.
    pub size: String,
    /// The day that stands in the file, as it is to be read; empty for none, so that the same
    /// pattern gives the same file on every day.
    pub date: String,
}
