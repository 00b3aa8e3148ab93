//! The scoreboard: which test, which models, which mesh, and the error.

use std::time::Instant;

use super::{Layout, cantilever, catenary, dynamics, friction, plate, stretch};
use crate::bending::{Clamp, FreeEdge, Hinge, LoneHinge, QuadraticHinge, Rigidity, SkipOne};
use crate::error::ClothError;
use crate::fabric::Fabric;
use crate::force::{Energy, Vec3};
use crate::membrane::{Springs, StVenantKirchhoff, Triangles, Woven};
use crate::mesh::Sheet;

/// The six tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Test {
    /// Tip of a cantilever, in lengths.
    Cantilever,
    /// Tip of a hanging strip and stiffness of strips cut off the grain, relative.
    Stretch,
    /// Centre of clamped and supported plates, relative.
    Plate,
    /// Sag (in lengths) and support tension (relative) of catenaries.
    Catenary,
    /// Slip of a belt round a drum and of a sheet on an incline, relative.
    Friction,
    /// Frequencies of a hanging sheet and a drumhead, relative.
    Dynamics,
}

impl Test {
    /// In the order E1 to E6.
    pub const ALL: [Self; 6] =
        [Self::Cantilever, Self::Stretch, Self::Plate, Self::Catenary, Self::Friction, Self::Dynamics];

    /// E1 to E6.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Cantilever => "E1 cantilever",
            Self::Stretch => "E2 stretch",
            Self::Plate => "E3 plate",
            Self::Catenary => "E4 catenary",
            Self::Friction => "E5 friction",
            Self::Dynamics => "E6 dynamics",
        }
    }

    /// What the default models must reach on equilateral and irregular meshes.
    #[must_use]
    pub fn limit(self) -> f64 {
        match self {
            Self::Cantilever | Self::Dynamics => 0.005,
            Self::Stretch | Self::Catenary => 0.002,
            Self::Plate | Self::Friction => 0.02,
        }
    }

    /// The least resolution at which the limit binds, and the one that a table shows if it shows one.
    #[must_use]
    pub fn binding_resolution(self) -> usize {
        self.resolutions()[1]
    }

    /// Triangles along the longest side: coarse, middle, fine.
    #[must_use]
    pub fn resolutions(self) -> [usize; 3] {
        match self {
            Self::Cantilever | Self::Catenary => [20, 40, 80],
            Self::Stretch | Self::Dynamics => [10, 20, 40],
            Self::Plate => [16, 32, 64],
            Self::Friction => [48, 64, 96],
        }
    }
}

/// Which membrane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Membrane {
    /// Finite elements with warp, weft and shear curves.
    Woven,
    /// Finite elements, St Venant-Kirchhoff.
    StVenantKirchhoff,
    /// Springs by family.
    Springs,
}

/// Which bending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bending {
    /// Coupled hinges.
    Hinge,
    /// Hinges each on its own, calibrated, with free edges mended.
    LoneHinge,
    /// Quadratic hinges.
    Quadratic,
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
    /// Finite elements and hinges.
    pub const DEFAULT: Self = Self { membrane: Membrane::Woven, bending: Bending::Hinge };

    /// What the table compares.
    pub const ALL: [Self; 5] = [
        Self::DEFAULT,
        Self { membrane: Membrane::StVenantKirchhoff, bending: Bending::Hinge },
        Self { membrane: Membrane::Woven, bending: Bending::Quadratic },
        Self { membrane: Membrane::Woven, bending: Bending::LoneHinge },
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
            Bending::LoneHinge => "lone hinge",
            Bending::Quadratic => "quadratic",
            Bending::SkipOne => "skip-one",
        };
        format!("{membrane} + {bending}")
    }

    pub(super) fn membrane_energy(
        self,
        sheet: &Sheet,
        fabric: &Fabric,
    ) -> Result<Box<dyn Energy>, ClothError> {
        Ok(match self.membrane {
            Membrane::Woven => Box::new(Triangles::new(sheet, Woven::new(fabric)?)),
            Membrane::StVenantKirchhoff => {
                let law = StVenantKirchhoff::new(fabric.warp.slope(0.0), fabric.poisson)?;
                Box::new(Triangles::new(sheet, law))
            }
            Membrane::Springs => Box::new(Springs::new(sheet, fabric)?),
        })
    }

    /// Membrane and bending for a sheet of this fabric, its borders free where not `fixed`.
    ///
    /// # Errors
    /// What the models find in sheet or fabric.
    pub fn energies(
        self,
        sheet: &Sheet,
        fabric: &Fabric,
        fixed: &[bool],
    ) -> Result<Vec<Box<dyn Energy>>, ClothError> {
        self.energies_held(sheet, fabric, fixed, None)
    }

    /// The same, where border edges of `held` keep their slope.
    pub(super) fn energies_held(
        self,
        sheet: &Sheet,
        fabric: &Fabric,
        fixed: &[bool],
        held: Option<&Held<'_>>,
    ) -> Result<Vec<Box<dyn Energy>>, ClothError> {
        let d = Rigidity::of(fabric);
        let beyond =
            |[a, b]: [u32; 2]| held.filter(|h| (h.chosen)(a) && (h.chosen)(b)).map(|h| (h.outward)(a));
        let mut energies = vec![self.membrane_energy(sheet, fabric)?];
        match self.bending {
            Bending::Hinge => energies.push(Box::new(Hinge::clamped(sheet, &d, beyond)?)),
            Bending::Quadratic => energies.push(Box::new(QuadraticHinge::clamped(sheet, &d, beyond)?)),
            Bending::SkipOne => energies.push(Box::new(SkipOne::new(sheet, &d)?)),
            Bending::LoneHinge => {
                energies.push(Box::new(LoneHinge::new(sheet, &d)?));
                energies.push(Box::new(FreeEdge::new(sheet, &d, |v| !fixed[v])?));
            }
        }
        if let (Some(held), Bending::LoneHinge | Bending::SkipOne) = (held, self.bending) {
            let factor = LoneHinge::new(sheet, &d)?.0.factor();
            energies.push(Box::new(Clamp::new(sheet, &d, factor, held.chosen, held.outward)?));
        }
        Ok(energies)
    }
}

/// Border edges with a clamped slope.
pub(super) struct Held<'a> {
    /// Whether a vertex is clamped; an edge is if both its ends are.
    pub chosen: &'a dyn Fn(u32) -> bool,
    /// The direction in which the sheet would go on beyond the edge.
    pub outward: &'a dyn Fn(u32) -> Vec3,
}

/// One row of the scoreboard.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Which test.
    pub test: Test,
    /// Which models.
    pub models: Models,
    /// Which mesh.
    pub layout: Layout,
    /// Triangles along the longest side.
    pub along: usize,
    /// The parts that make up the error, by name; the error is the largest in size.
    pub parts: Vec<(String, f64)>,
    /// Wall time, s.
    pub seconds: f64,
}

impl Score {
    /// The largest part.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.parts
            .iter()
            .map(|p| p.1.abs())
            .fold(0.0, |a, b| if b.is_nan() { f64::INFINITY } else { a.max(b) })
    }
}

/// Runs one test.
///
/// # Errors
/// When a solver does not converge or the mesh is refused.
pub fn run(test: Test, models: Models, layout: Layout, along: usize) -> Result<Score, ClothError> {
    let start = Instant::now();
    let parts = match test {
        Test::Cantilever => cantilever::errors(models, layout, along),
        Test::Stretch => stretch::errors(models, layout, along),
        Test::Plate => plate::errors(models, layout, along),
        Test::Catenary => catenary::errors(models, layout, along),
        Test::Friction => friction::errors(models, layout, along),
        Test::Dynamics => dynamics::errors(models, layout, along),
    }?;
    Ok(Score { test, models, layout, along, parts, seconds: start.elapsed().as_secs_f64() })
}
