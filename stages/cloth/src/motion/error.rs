//! Why a motion did not end.

use crate::contact::past::Fallen;
use crate::contact::start::Sunk;
use crate::error::ClothError;
use crate::scene::SceneError;

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
        "panel '{panel}' is of another fabric than the first; solvers in time take one, Rest takes any number"
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
        "seam '{seam}' stays open by {gap:.4} m after {time:.2} s; place its panels nearer or cut them wider"
    )]
    SeamNotClosed {
        /// The seam with the widest gap.
        seam: String,
        /// Its gap, m.
        gap: f64,
        /// Simulated time, s.
        time: f64,
    },
    /// Vertices start inside the body, too deep to be pushed out.
    #[error(
        "{vertices} vertices start inside the body, the deepest by {depth:.3} m; place the panels outside it"
    )]
    InitialPenetration {
        /// How many.
        vertices: usize,
        /// The deepest, m.
        depth: f64,
    },
    /// Cloth that passes through cloth where it starts.
    #[error("{pairs} pairs of an edge and a triangle cross at the start; lay the panels out so that none do")]
    InitialCrossing {
        /// How many.
        pairs: usize,
    },
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

impl From<Sunk> for MotionError {
    fn from(sunk: Sunk) -> Self {
        Self::InitialPenetration { vertices: sunk.vertices, depth: sunk.depth }
    }
}
