//! Which membrane and which bending a sheet has: a new model is one file and one line in each place here that the compiler names.

use super::Vec3;
use super::bending::{
    Calibration, ClampedEdge, DiscreteShell, FreeEdge, Hinge, Hysteresis, Quadratic, SkipOne,
};
use super::membrane::{Springs, StVenantKirchhoff, Triangles, Woven};
use super::potential::Resistance;
use crate::error::ClothError;
use crate::fabric::{Fabric, Rigidity};
use crate::mesh::Sheet;
use crate::scene::StrainLimit;
use std::cell::OnceCell;

/// A sheet and what it is made of.
#[derive(Clone)]
pub struct Cloth<'a> {
    /// The triangles, at rest.
    pub sheet: &'a Sheet,
    /// The same as it was cut, where `sheet` has rest shapes that do not fit together (gathers): bending is calibrated on it.
    pub cut: &'a Sheet,
    /// The fabrics.
    pub fabrics: &'a [&'a Fabric],
    /// Which fabric each triangle is of.
    pub fabric: &'a dyn Fn(usize) -> usize,
    /// What yarns must not exceed.
    pub limit: Option<StrainLimit>,
    /// Border edges that keep their slope.
    pub clamp: Option<Clamp<'a>>,
    /// Nodes that stay: the border is not free there. Empty where that does not matter.
    pub fixed: &'a [bool],
    /// What its hinges are, once somebody has asked.
    pub(crate) calibration: OnceCell<Calibration>,
}

/// Border edges with a held slope; their nodes must be pinned as well.
#[derive(Clone, Copy)]
pub struct Clamp<'a> {
    /// Whether a node is clamped; an edge is if both its ends are.
    pub chosen: &'a dyn Fn(u32) -> bool,
    /// The direction in which the sheet would go on beyond the edge.
    pub outward: &'a dyn Fn(u32) -> Vec3,
}

impl<'a> Cloth<'a> {
    /// A sheet of one fabric, free all around.
    #[must_use]
    pub fn of(sheet: &'a Sheet, fabrics: &'a [&'a Fabric; 1]) -> Self {
        let (limit, clamp, calibration) = (None, None, OnceCell::new());
        Self { sheet, cut: sheet, fabrics, fabric: &|_| 0, limit, clamp, fixed: &[], calibration }
    }

    /// What hinges on this mesh are, against the sheet that they stand for.
    pub(crate) fn calibration(&self) -> &Calibration {
        self.calibration.get_or_init(|| Calibration::of(self.cut))
    }

    /// The number of a triangle's fabric.
    #[must_use]
    pub fn index(&self, triangle: usize) -> usize {
        (self.fabric)(triangle).min(self.fabrics.len().saturating_sub(1))
    }

    /// A triangle's fabric.
    #[must_use]
    pub fn fabric_of(&self, triangle: usize) -> &Fabric {
        self.fabrics[self.index(triangle)]
    }

    /// A triangle's bending rigidity.
    #[must_use]
    pub fn rigidity(&self, triangle: usize) -> Rigidity {
        Rigidity::of(self.fabric_of(triangle))
    }

    /// Beyond a border edge, the direction in which a clamp holds it.
    #[must_use]
    pub fn beyond(&self, [a, b]: [u32; 2]) -> Option<Vec3> {
        self.clamp.filter(|c| (c.chosen)(a) && (c.chosen)(b)).map(|c| (c.outward)(a))
    }

    /// Whether nothing of it resists bending.
    fn is_limp(&self) -> bool {
        self.fabrics.iter().all(|f| Rigidity::of(f).is_zero())
    }
}

/// What a sheet resists in its plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Membrane {
    /// Finite elements with warp, weft and shear curves.
    Woven,
    /// Finite elements, St Venant-Kirchhoff: isotropic, by the warp's first slope.
    StVenantKirchhoff,
    /// Springs along the edges, by family.
    Springs,
}

/// What a sheet resists when it is folded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bending {
    /// Quadratic hinges, for sheets that hardly stretch: their matrix never changes.
    Quadratic,
    /// Coupled hinges, at any fold.
    Hinge,
    /// Hinges each by itself, by `2 tan(theta / 2)` of their angle.
    DiscreteShell,
    /// Skip-one springs.
    SkipOne,
}

/// A pair of models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Models {
    /// In the plane.
    pub membrane: Membrane,
    /// Out of it.
    pub bending: Bending,
}

impl Models {
    /// Finite elements and coupled hinges: the most exact pair.
    pub const DEFAULT: Self = Self { membrane: Membrane::Woven, bending: Bending::Hinge };

    /// Finite elements and quadratic hinges: as exact for cloth that hardly stretches, and the fastest.
    pub const STATIC: Self = Self { membrane: Membrane::Woven, bending: Bending::Quadratic };

    /// What the scoreboard compares.
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
    /// What [`Fabric::check`] finds.
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
    /// What [`Fabric::check`] finds.
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
