//! Which membrane and which bending a sheet has: a new model is one file and one line in each place
//! here that the compiler names.

use super::bending::{ClampedEdge, DiscreteShell, FreeEdge, Hinge, Hysteresis, Quadratic, SkipOne};
use super::cloth::Cloth;
use super::membrane::{Springs, StVenantKirchhoff, Triangles, Woven};
use super::potential::Resistance;
use crate::error::ClothError;
use crate::fabric::Fabric;

/// Membrane models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Membrane {
    /// Finite elements with warp, weft and shear curves.
    Woven,
    /// Finite elements, St Venant-Kirchhoff: isotropic, by the warp's first slope.
    StVenantKirchhoff,
    /// Springs along the edges, by family.
    Springs,
}

/// Bending models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bending {
    /// Quadratic hinges, for sheets that hardly stretch: their matrix never changes.
    Quadratic,
    /// Coupled hinges, at any fold.
    Hinge,
    /// Lone hinges, each by `2 tan(theta / 2)` of its angle.
    DiscreteShell,
    /// Skip-one springs.
    SkipOne,
}

/// The models of a sheet's membrane and bending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Models {
    /// The resistance in the plane of the cloth.
    pub membrane: Membrane,
    /// The resistance to bending.
    pub bending: Bending,
}

impl Models {
    /// Finite elements and coupled hinges: the most exact pair.
    pub const DEFAULT: Self = Self { membrane: Membrane::Woven, bending: Bending::Hinge };

    /// Finite elements and quadratic hinges: as exact for cloth that hardly stretches, and the
    /// fastest.
    pub const STATIC: Self = Self { membrane: Membrane::Woven, bending: Bending::Quadratic };

    /// The pairs that the scoreboard compares.
    pub const ALL: [Self; 5] = [
        Self::DEFAULT,
        Self { membrane: Membrane::StVenantKirchhoff, bending: Bending::Hinge },
        Self::STATIC,
        Self { membrane: Membrane::Woven, bending: Bending::DiscreteShell },
        Self { membrane: Membrane::Springs, bending: Bending::SkipOne },
    ];

    /// For tables.
    #[must_use]
    pub fn name(self) -> String {
        let membrane = match self.membrane {
            Membrane::Woven => "woven",
            Membrane::StVenantKirchhoff => "StVK",
            Membrane::Springs => "springs",
        };
        let bending = match self.bending {
            Bending::Hinge => "hinge",
            Bending::Quadratic => "quadratic",
            Bending::DiscreteShell => "discrete shell",
            Bending::SkipOne => "skip-one",
        };
        format!("{membrane} + {bending}")
    }

    /// The membrane of a cloth.
    ///
    /// # Errors
    /// Every error of [`Fabric::check`].
    pub fn membrane(self, cloth: &Cloth<'_>) -> Result<Box<dyn Resistance>, ClothError> {
        cloth.fabrics.iter().try_for_each(|f| f.check())?;
        if let (Some(limit), false) = (cloth.limit, self.membrane == Membrane::Woven) {
            let (name, value) = ("strain limit", limit.warp.min(limit.weft));
            return Err(ClothError::InvalidParameter {
                name,
                value,
                range: "only the membrane Woven keeps one",
            });
        }
        let of = |t| cloth.index(t);
        Ok(match self.membrane {
            Membrane::Woven => {
                let laws = cloth.fabrics.iter().map(|f| Woven::limited(f, cloth.limit)).collect();
                Box::new(Triangles::with(cloth.sheet, laws, of))
            }
            Membrane::StVenantKirchhoff => {
                let law = |f: &&Fabric| StVenantKirchhoff::new(f.warp.slope(0.0), f.poisson);
                let laws = cloth.fabrics.iter().map(law).collect::<Result<_, _>>()?;
                Box::new(Triangles::with(cloth.sheet, laws, of))
            }
            Membrane::Springs => Box::new(Springs::new(cloth)),
        })
    }

    /// Membrane and bending of a cloth, with the friction between its yarns where it has any.
    ///
    /// # Errors
    /// Every error of [`Fabric::check`].
    pub fn energies(self, cloth: &Cloth<'_>) -> Result<Vec<Box<dyn Resistance>>, ClothError> {
        let mut energies = vec![self.membrane(cloth)?];
        if cloth.is_limp() {
            return Ok(energies);
        }
        match self.bending {
            Bending::Hinge => energies.push(Box::new(Hinge::new(cloth))),
            Bending::Quadratic => energies.push(Box::new(Quadratic::new(cloth))),
            Bending::DiscreteShell => energies.push(Box::new(DiscreteShell::new(cloth))),
            Bending::SkipOne => energies.push(Box::new(SkipOne::new(cloth))),
        }
        if let Some(hysteresis) = Hysteresis::new(cloth) {
            energies.push(Box::new(hysteresis));
        }
        if matches!(self.bending, Bending::Quadratic | Bending::DiscreteShell) {
            energies.push(Box::new(FreeEdge::new(cloth)));
        }
        if self.bending != Bending::Hinge && cloth.clamp.is_some() {
            energies.push(Box::new(ClampedEdge::new(cloth)));
        }
        Ok(energies)
    }
}
