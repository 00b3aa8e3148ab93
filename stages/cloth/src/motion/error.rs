//! Why a motion did not end.

use crate::contact::past::Fallen;
use crate::error::ClothError;
use crate::scene::SceneError;
use crate::statics::start::StartError;

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
    #[error(
        "seam '{seam}' stays open by {:.1} mm after {time:.2} s; place its panels nearer, with nothing between its sides, or cut them wider",
        1e3 * gap
    )]
    SeamNotClosed {
        /// The seam with the widest gap.
        seam: String,
        /// Its gap, m.
        gap: f64,
        /// Simulated time, s.
        time: f64,
    },
    /// What is wrong with the start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The budget of wall time is spent.
    #[error("out of time after {seconds:.1} s, at {time:.3} s of the motion")]
    Timeout {
        /// Wall time, s.
        seconds: f64,
        /// Simulated time, s.
        time: f64,
    },
    /// The caller asked to stop.
    #[error("stopped")]
    Stopped,
}
