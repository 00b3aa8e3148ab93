//! Starts: flat places without flipped triangles, from which an energy can be minimised.
//!
//! Tried in order of cost: the projection along the mean normal (taken only if it strains little),
//! least squares conformal maps, the embedding of Tutte. The last has no flips by theorem, for any
//! disk with holes. A start far from isometric settles first.

mod layout;
mod lscm;
mod projection;
#[cfg(test)]
mod tests;
mod tutte;

pub(crate) use layout::neighbour_layout;
use lscm::lscm_map;
use projection::projection;
use tutte::tutte;

use crate::energy::SymmetricDirichletEnergy;
use crate::error::FlattenError;
use crate::frames::{TriangleFrames, corners, flat_area, flipped};
use crate::newton::{NewtonProblem, StoppingLimits};
use crate::surface::PieceSurface;
use crate::system::PieceSystem;
use nalgebra::Point2;

/// Where a solution started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartMethod {
    /// The projection along the mean normal.
    Projection,
    /// Least squares conformal maps (Lévy and others 2002).
    Lscm,
    /// The embedding on a circle (Tutte 1963).
    Tutte,
    /// Neighbours laid out by their distances.
    Neighbours,
}

/// A projection that shrinks any triangle to less than this share is no good start: bending it open
/// takes longer than solving anew.
const LEAST_PROJECTED: f64 = 0.3;

/// Symmetric Dirichlet energy by area of a start that needs to settle: stretches of about a half
/// everywhere.
const FAR: f64 = 1.0;

/// When a start has settled enough for other energies to take over.
const SETTLED: StoppingLimits = StoppingLimits { iterations: 60, tolerance: 1e-3 };

/// The cheapest start without flips, in units of [`TriangleFrames::unit`].
///
/// # Errors
/// [`FlattenError::NoStart`] if rounding leaves flips in every one, [`FlattenError::Factorization`]
/// from Tutte's system.
pub(crate) fn start(
    surface: &PieceSurface,
    system: &PieceSystem,
    frames: &TriangleFrames,
) -> Result<(Vec<Point2<f64>>, StartMethod), FlattenError> {
    let flat = frames.scaled(&projection(surface));
    if least_area_ratio(system, frames, &flat) > LEAST_PROJECTED {
        return Ok((flat, StartMethod::Projection));
    }
    let (mut flat, start) = conformal_start(surface, system, frames)?;
    settle(system, frames, &mut flat)?;
    Ok((flat, start))
}

/// Brings a start that is far from isometric nearer, by the energy that does so in fewest steps.
fn settle(
    system: &PieceSystem,
    frames: &TriangleFrames,
    flat: &mut [Point2<f64>],
) -> Result<(), FlattenError> {
    let energy = &SymmetricDirichletEnergy;
    let problem = NewtonProblem { system, frames, energy, terms: &[], constraints: &[] };
    if problem.energy_at(flat) > FAR {
        problem.minimise(flat, SETTLED)?;
    }
    Ok(())
}

/// Least squares conformal maps where they have no flips, else Tutte's embedding; scaled to the
/// true area.
///
/// # Errors
/// As [`start`].
pub(crate) fn conformal_start(
    surface: &PieceSurface,
    system: &PieceSystem,
    frames: &TriangleFrames,
) -> Result<(Vec<Point2<f64>>, StartMethod), FlattenError> {
    // A refused factor of the conformal system is one more reason to take the other start.
    if let Ok(flat) = lscm_map(surface, system, frames) {
        let flat = with_true_area(system, flat);
        if flipped(system.triangles(), &flat).is_empty() {
            return Ok((flat, StartMethod::Lscm));
        }
    }
    let flat = with_true_area(system, tutte(surface, frames)?);
    match flipped(system.triangles(), &flat)[..] {
        [] => Ok((flat, StartMethod::Tutte)),
        [triangle, ..] => {
            Err(FlattenError::NoStart { flips: flipped(system.triangles(), &flat).len(), triangle })
        }
    }
}

/// Scales to the area 1, the whole surface's in units of [`TriangleFrames::unit`].
pub(crate) fn with_true_area(system: &PieceSystem, mut flat: Vec<Point2<f64>>) -> Vec<Point2<f64>> {
    let area = flat_area(system.triangles(), &flat);
    if area > 0.0 && area.is_finite() {
        let scale = 1.0 / area.sqrt();
        flat.iter_mut().for_each(|p| *p *= scale);
    }
    flat
}

/// The least flat area over true area of all triangles.
fn least_area_ratio(system: &PieceSystem, frames: &TriangleFrames, flat: &[Point2<f64>]) -> f64 {
    let ratio = |(t, &c): (usize, &[u32; 3])| frames.map(t, corners(flat, c)).determinant();
    system.triangles().iter().enumerate().map(ratio).fold(f64::INFINITY, f64::min)
}
