//! What a sheet resists with: the models that a draper may take, by the engine's energies.

use toile_cloth::energy::{Bending as EngineBending, Membrane as EngineMembrane, Models};
use toile_core::prelude::*;

/// What cloth resists in its plane.
#[choice]
#[derive(Copy, Eq)]
pub enum Membrane {
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
pub enum Bending {
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
pub(super) fn models(membrane: Membrane, bending: Bending) -> Models {
    let membrane = match membrane {
        Membrane::Woven => EngineMembrane::Woven,
        Membrane::StVenantKirchhoff => EngineMembrane::StVenantKirchhoff,
        Membrane::Springs => EngineMembrane::Springs,
    };
    let bending = match bending {
        Bending::Quadratic => EngineBending::Quadratic,
        Bending::Hinge => EngineBending::Hinge,
        Bending::DiscreteShell => EngineBending::DiscreteShell,
        Bending::SkipOne => EngineBending::SkipOne,
    };
    Models { membrane, bending }
}
