//! Who wears a garment.

use toile_core::choice;

/// Whose proportions a mannequin has.
#[choice]
#[derive(Copy, Eq)]
pub enum Wearer {
    /// A woman's.
    Woman,
    /// A man's.
    Man,
    /// A child's.
    Child,
}
