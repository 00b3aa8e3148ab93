//! Flatteners that are Newton's method with one energy each.

use super::{Flattening, Placement};
use crate::energy::{EnergyDensity, SpringEnergy, SymmetricDirichletEnergy, WovenEnergy, WovenStiffness};
use crate::error::FlattenError;
use crate::frames::{TriangleFrames, flipped};
use crate::grain::turn_upright;
use crate::newton::{Constraint, NewtonProblem, StoppingLimits};
use crate::start::{StartMethod, neighbour_layout, start};
use crate::surface::PieceSurface;
use crate::system::PieceSystem;
use nalgebra::{Point2, Vector2};

/// Flattens with the least symmetric Dirichlet energy (Smith and Schaefer 2015), which no triangle
/// can flip under.
///
/// # Errors
/// Parameters of the placement or options, [`FlattenError::NoStart`],
/// [`FlattenError::Factorization`].
pub fn symmetric_dirichlet(
    surface: &PieceSurface,
    options: StoppingLimits,
    placement: &Placement,
) -> Result<Flattening, FlattenError> {
    placement.check(surface)?;
    let (system, frames) = (PieceSystem::new(surface, &[]), TriangleFrames::new(surface));
    let (mut flat, start) = start(surface, &system, &frames)?;
    let energy = SymmetricDirichletEnergy;
    let problem =
        NewtonProblem { system: &system, frames: &frames, energy: &energy, terms: &[], constraints: &[] };
    let report = problem.minimise(&mut flat, options)?;
    placement.finish(surface, &frames, flat, (start, report))
}

/// Flattens by the published method: neighbours laid out by their distances, then springs along the
/// edges relax in the plane until the energy that a step would save is below the tolerance. Where
/// the layout flips triangles, another start without flips is taken.
///
/// # Errors
/// As [`symmetric_dirichlet`].
pub fn springs(
    surface: &PieceSurface,
    options: StoppingLimits,
    placement: &Placement,
) -> Result<Flattening, FlattenError> {
    placement.check(surface)?;
    let (system, frames) = (PieceSystem::new(surface, &[]), TriangleFrames::new(surface));
    let layout = frames.scaled(&neighbour_layout(surface));
    let (mut flat, start) = if flipped(system.triangles(), &layout).is_empty() {
        (layout, StartMethod::Neighbours)
    } else {
        start(surface, &system, &frames)?
    };
    let energy = SpringEnergy::new(surface);
    let problem =
        NewtonProblem { system: &system, frames: &frames, energy: &energy, terms: &[], constraints: &[] };
    let report = problem.minimise(&mut flat, options)?;
    placement.finish(surface, &frames, flat, (start, report))
}

/// Flattens for woven cloth: the warp (along the grain, pattern y) and the weft keep their lengths,
/// shear is soft.
///
/// The mean grain is held upright while the energy is minimised.
///
/// # Errors
/// As [`symmetric_dirichlet`], and stiffnesses out of range.
pub fn woven(
    surface: &PieceSurface,
    stiffness: WovenStiffness,
    options: StoppingLimits,
    placement: &Placement,
) -> Result<Flattening, FlattenError> {
    placement.check(surface)?;
    let energy = WovenEnergy::new(stiffness)?;
    let (system, frames) = (PieceSystem::new(surface, &[]), TriangleFrames::new(surface));
    let (mut flat, start) = start(surface, &system, &frames)?;
    let upright = upright(surface, &frames, placement, &mut flat);
    let problem = NewtonProblem {
        system: &system,
        frames: &frames,
        energy: &energy as &dyn EnergyDensity,
        terms: &[],
        constraints: &upright,
    };
    let report = problem.minimise(&mut flat, options)?;
    placement.finish(surface, &frames, flat, (start, report))
}

/// Turns the grain up, and gives the equation that keeps it there.
pub(crate) fn upright(
    surface: &PieceSurface,
    frames: &TriangleFrames,
    placement: &Placement,
    flat: &mut [Point2<f64>],
) -> Vec<Constraint> {
    let weights = placement.grain.weights(surface, frames);
    if !turn_upright(&weights, flat) {
        return Vec::new();
    }
    vec![Constraint::Balance { weights, direction: Vector2::x() }]
}
