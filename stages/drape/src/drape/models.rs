//! What a sheet resists with: the models that a draper may take, by the engine's energies.

use toile_cloth::energy::{Bending as EngineBending, Membrane as EngineMembrane, Models};
use toile_core::prelude::*;

/// What cloth resists in its plane.
#[choice]
#[derive(Copy, Eq)]
pub enum MembraneModel {
    /// Triangles with the fabric's warp, weft and shear curves.
    Woven,
    /// Isotropic triangles (St Venant-Kirchhoff) of the warp's first slope and Poisson's ratio.
    StVenantKirchhoff,
    /// Springs along the edges of the mesh, by family (van Gelder 1998; Fan et al. 1999): right
    /// along the mesh lines only.
    Springs,
}

/// What cloth resists when it is folded.
#[choice]
#[derive(Copy, Eq)]
pub enum BendingModel {
    /// Quadratic hinges (Bergou et al. 2006): for cloth that hardly stretches; the fastest.
    Quadratic,
    /// Coupled hinges by their angles (Grinspun et al. 2003, 2006): right at any fold.
    Hinge,
    /// Hinges each by itself, by `2 tan(theta / 2)` of their angle (Grinspun et al. 2003; Tamstorf,
    /// Grinspun 2013): cloth never folds through itself.
    DiscreteShell,
    /// Springs over every second vertex, as the classic systems have them: nothing against a small
    /// fold.
    SkipOne,
}

/// The engine's models.
pub(super) fn models(membrane: MembraneModel, bending: BendingModel) -> Models {
    let membrane = match membrane {
        MembraneModel::Woven => EngineMembrane::Woven,
        MembraneModel::StVenantKirchhoff => EngineMembrane::StVenantKirchhoff,
        MembraneModel::Springs => EngineMembrane::Springs,
    };
    let bending = match bending {
        BendingModel::Quadratic => EngineBending::Quadratic,
        BendingModel::Hinge => EngineBending::Hinge,
        BendingModel::DiscreteShell => EngineBending::DiscreteShell,
        BendingModel::SkipOne => EngineBending::SkipOne,
    };
    Models { membrane, bending }
}
