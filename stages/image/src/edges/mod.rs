//! Edge detectors: photo and mask to a closed sub-pixel outline.
//!
//! All of them share one way: the mask's boundary is followed ([`trace`]), an operator is evaluated
//! in a band around it ([`band`], [`operator`]), every boundary point moves along its normal to the
//! operator's edge ([`refine`]), corners are found ([`corners`]), and the curve between them is
//! smoothed and spaced evenly ([`curve`]). They differ in the operator alone.

mod band;
mod canny;
mod corners;
mod crossing;
mod curve;
mod laplacian;
mod log;
mod operator;
mod outline;
mod prewitt;
mod refine;
mod roberts;
mod sobel;
#[cfg(test)]
mod tests;
mod trace;

pub use canny::Canny;
pub use laplacian::Laplacian;
pub use log::LaplacianOfGaussian;
pub use prewitt::Prewitt;
pub use roberts::Roberts;
pub use sobel::Sobel;

use toile_core::{Migration, Registry};

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Canny>();
    registry.add::<Sobel>();
    registry.add::<Prewitt>();
    registry.add::<Roberts>();
    registry.add::<LaplacianOfGaussian>();
    registry.add::<Laplacian>();
    registry.migrate(Migration::stage("LaplacianEdges", "Laplacian"));
}
