//! Why a motion did not end.

use crate::contact::past::Fallen;
use crate::error::ClothError;
use crate::scene::SceneError;
use crate::statics::report::error::remedy;
use crate::statics::report::start::StartError;
use toile_geometry::Vec3;

/// Why a motion did not end.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// A fault of the numbers, or a solver that gave up.
    #[error(transparent)]
    Cloth(#[from] ClothError),
    /// A fault of the scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Panels of several fabrics.
    #[error(
        "panel '{panel}' is of another fabric than the first; Xpbd and Projective take one, all others any number"
    )]
    Fabrics {
        /// The panel.
        panel: String,
    },
    /// Cloth falls past the body.
    #[error("{0}")]
    FallsPast(Box<Fallen>),
    /// A seam does not close.
    #[error("seam '{seam}' stays open by {:.1} mm after {time:.2} s; {}", 1e3 * gap, remedy(reversed))]
    SeamNotClosed {
        /// The seam with the widest gap.
        seam: String,
        /// Its gap, m.
        gap: f64,
        /// Simulated time, s.
        time: f64,
        /// Seams whose pairs seem to run against each other.
        reversed: Vec<String>,
        /// The vertices where the motion ended, m.
        positions: Vec<Vec3>,
    },
    /// A fault of the initial positions.
    #[error(transparent)]
    Start(#[from] StartError),
    /// Steps so short that the motion would not end.
    #[error(
        "the steps are {step:.1e} s long after {time:.3} s of the motion, shorter than {least:.1e} s; take a softer or heavier cloth, or a \
         coarser mesh"
    )]
    TooStiff {
        /// The step that the solver may take, s.
        step: f64,
        /// The shortest that is taken, s.
        least: f64,
        /// Simulated time, s.
        time: f64,
        /// The widest seam that is still open, m; 0 where none is.
        gap: f64,
    },
    /// The budget of wall time is spent.
    #[error("out of time after {seconds:.1} s, at {time:.3} s of the motion")]
    Timeout {
        /// Wall time, s.
        seconds: f64,
        /// Simulated time, s.
        time: f64,
        /// The widest seam that is still open, m; 0 where none is.
        gap: f64,
        /// The vertices where the motion ended, m.
        positions: Vec<Vec3>,
    },
    /// The caller asked to stop.
    #[error("stopped")]
    Stopped,
}

impl MotionError {
    /// The vertices where the motion ended, m, where the error tells them.
    #[must_use]
    pub fn so_far(&self) -> Option<&[Vec3]> {
        match self {
            Self::SeamNotClosed { positions, .. } | Self::Timeout { positions, .. } => Some(positions),
            _ => None,
        }
    }
}
