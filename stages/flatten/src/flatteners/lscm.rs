//! Least squares conformal maps as a flattener (Lévy and others 2002): angles kept, size fitted to
//! the true area.

use super::{Flattening, NOTHING_MINIMISED, Placement};
use crate::error::FlattenError;
use crate::frames::TriangleFrames;
use crate::start::conformal_start;
use crate::surface::PieceSurface;
use crate::system::PieceSystem;

/// Flattens with the least angle errors; where that flips triangles, gives Tutte's embedding
/// instead, and says so.
///
/// # Errors
/// Parameters of the placement, [`FlattenError::NoStart`], [`FlattenError::Factorization`].
pub fn lscm(surface: &PieceSurface, placement: &Placement) -> Result<Flattening, FlattenError> {
    placement.check(surface)?;
    let (system, frames) = (PieceSystem::new(surface, &[]), TriangleFrames::new(surface));
    let (flat, start) = conformal_start(surface, &system, &frames)?;
    placement.finish(surface, &frames, flat, (start, NOTHING_MINIMISED))
}
