//! The scoreboard: which test, which models, which mesh, and the error.

use std::time::Instant;

use super::{Layout, cantilever, catenary, dynamics, friction, plate, stretch};
use toile_cloth::energy::Models;
use toile_cloth::error::ClothError;

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

    /// The least resolution at which the limit binds, and the one that a table shows if it shows
    /// one.
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
