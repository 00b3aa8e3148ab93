//! The flatteners: each gives one flat place a vertex, at true scale, no triangle flipped,
//! counter-clockwise from the right side.
//!
//! | function | minimises | use |
//! |---|---|---|
//! | [`lscm`] | angle errors | a start; the size is fitted |
//! | [`arap`] | `(s - 1)^2` of both stretches | least area error |
//! | [`symmetric_dirichlet`] | `(s - 1/s)^2` of both stretches | least error of the worst stretches |
//! | [`springs`] | length errors of edges | the published method |
//! | [`woven`] | strain of warp and weft; shear counts little | woven cloth |

mod arap;
mod lscm;
mod newton_methods;
#[cfg(test)]
mod tests;

pub use arap::{ArapOptions, arap};
pub use lscm::lscm;
pub use newton_methods::{springs, symmetric_dirichlet, woven};

use crate::error::FlattenError;
use crate::frames::{TriangleFrames, flipped};
use crate::grain::{Grain, turn_upright};
use crate::newton::NewtonOutcome;
use crate::start::StartMethod;
use crate::surface::PieceSurface;
use nalgebra::Point2;

/// A flat piece and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct Flattening {
    /// One place a vertex of the surface, in the surface's unit of length; y is the warp, up along
    /// the grain.
    pub points: Vec<Point2<f64>>,
    /// Where the solution started.
    pub start: StartMethod,
    /// What the minimisation did; nothing for a map that needs none.
    pub report: NewtonOutcome,
    /// Whether the grain has a direction on the piece; a piece that lies across it is left as it
    /// is.
    pub upright: bool,
}

/// How a flat piece lies, and how far the garment is stretched.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// What becomes upright.
    pub grain: Grain,
    /// The garment's stretch that the pattern must not have.
    pub tension: Tension,
}

/// A uniform strain of the garment as it is given: the pattern comes out smaller by it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tension {
    /// Along the warp (pattern y): 0.1 means that the garment is 10 % longer than its cloth. Above
    /// -0.9, below 10.
    pub warp: f64,
    /// Along the weft (pattern x).
    pub weft: f64,
}

impl Default for Placement {
    fn default() -> Self {
        Self { grain: Grain::up(), tension: Tension::default() }
    }
}

impl Placement {
    /// Checks it against a surface.
    ///
    /// # Errors
    /// [`FlattenError::InvalidParameter`], [`FlattenError::NoSuchVertex`].
    pub(crate) fn check(&self, surface: &PieceSurface) -> Result<(), FlattenError> {
        for (name, value) in [("tension.warp", self.tension.warp), ("tension.weft", self.tension.weft)] {
            if !(value > -0.9 && value < 10.0) {
                let range = "a strain above -0.9 and below 10";
                return Err(FlattenError::InvalidParameter { name, value, range });
            }
        }
        self.grain.check(surface)
    }

    /// Turns the grain up, takes the tension out, and restores the unit.
    ///
    /// # Errors
    /// [`FlattenError::TooSmall`] if rounding flips a triangle.
    pub(crate) fn finish(
        &self,
        surface: &PieceSurface,
        frames: &TriangleFrames,
        mut flat: Vec<Point2<f64>>,
        (start, report): (StartMethod, NewtonOutcome),
    ) -> Result<Flattening, FlattenError> {
        let upright = turn_upright(&self.grain.weights(surface, frames), &mut flat);
        let (x, y) = (1.0 + self.tension.weft, 1.0 + self.tension.warp);
        let points: Vec<_> = frames.restored(&flat).iter().map(|p| Point2::new(p.x / x, p.y / y)).collect();
        match flipped(surface.triangles(), &points).first() {
            Some(&triangle) => Err(FlattenError::TooSmall { triangle }),
            None => Ok(Flattening { points, start, report, upright }),
        }
    }
}

impl Flattening {
    /// Triangles of the surface that lie face down; none comes from the flatteners.
    #[must_use]
    pub fn flipped(&self, surface: &PieceSurface) -> Vec<usize> {
        flipped(surface.triangles(), &self.points)
    }
}

/// The report of a map that nothing was minimised for.
pub(crate) const NOTHING_MINIMISED: NewtonOutcome =
    NewtonOutcome { iterations: 0, energy: 0.0, remaining: 0.0, converged: true };
