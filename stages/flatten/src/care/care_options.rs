//! What pattern care takes care of.

use crate::error::FlattenError;
use crate::newton::StoppingLimits;

/// What is taken care of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CareOptions {
    /// Make the two sides of seams equal.
    pub seams: bool,
    /// A chain of boundary that leaves its line by at most this share of its length becomes
    /// straight; 0 for none. Below 0.2.
    pub straight: f64,
    /// Angle between an edge's direction before and after a vertex that makes it a corner, degrees,
    /// above 0.
    pub corner: f64,
    /// How exactly pieces must be mirror images in space, a share of their diagonal; 0 leaves left
    /// and right alone. Below 0.1.
    pub mirror: f64,
    /// How near pieces with different meshes must be to mirror images, in space (mean) and in the
    /// plane (largest), a share of their diagonal, for their outlines to be made so; 0 leaves them
    /// alone. Below 0.2.
    pub mirror_outline: f64,
    /// When the solver stops.
    pub newton: StoppingLimits,
}

impl Default for CareOptions {
    fn default() -> Self {
        Self {
            seams: true,
            straight: 0.005,
            corner: 30.0,
            mirror: 1e-4,
            mirror_outline: 0.05,
            newton: StoppingLimits::default(),
        }
    }
}

impl CareOptions {
    pub(super) fn check(&self) -> Result<(), FlattenError> {
        let bad = |name, value, range| Err(FlattenError::InvalidParameter { name, value, range });
        if !(self.straight >= 0.0 && self.straight < 0.2) {
            return bad("straight", self.straight, "a share from 0 to below 0.2");
        }
        if !(self.corner > 0.0 && self.corner < 180.0) {
            return bad("corner", self.corner, "an angle above 0 and below 180 degrees");
        }
        if !(self.mirror >= 0.0 && self.mirror < 0.1) {
            return bad("mirror", self.mirror, "a share from 0 to below 0.1");
        }
        if !(self.mirror_outline >= 0.0 && self.mirror_outline < 0.2) {
            return bad("mirror_outline", self.mirror_outline, "a share from 0 to below 0.2");
        }
        Ok(())
    }
}
