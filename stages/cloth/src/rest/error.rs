//! Why `Rest` finds no garment at rest, in words that say what to change.

use super::multifrontal::NotPositive;
use super::solve::Rested;
use super::unrest::unrest;
use crate::contact::past::Fallen;
use crate::contact::start::Sunk;
use crate::error::ClothError;
use crate::scene::SceneError;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Why there is no garment at rest.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RestError {
    /// A fault of the input.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A fault of the mesh.
    #[error(transparent)]
    Cloth(#[from] ClothError),
    /// The matrix stayed indefinite.
    #[error(transparent)]
    NotPositive(#[from] NotPositive),
    /// Nothing holds the cloth.
    #[error(
        "nothing holds the cloth: it has weight, but no pin and no body under it; it has no state of rest"
    )]
    Falls,
    /// Cloth falls past the body.
    #[error("{0}")]
    FallsPast(Box<Fallen>),
    /// A seam does not close.
    #[error(
        "seam '{seam}' stays open by {gap:.4} m at {force:.1} N a metre; place its panels nearer or cut them wider"
    )]
    SeamNotClosed {
        /// The seam with the widest gap.
        seam: String,
        /// Its widest gap, m.
        gap: f64,
        /// The force that did not close it, N/m.
        force: f64,
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
    #[error(
        "cloth touches or passes through cloth at the start: {pairs} pairs of an edge and a triangle cross or cannot be told apart; lay the panels out so that none do"
    )]
    InitialCrossing {
        /// How many.
        pairs: usize,
    },
    /// Cloth that passes through cloth at the end.
    #[error(
        "{pairs} pairs of an edge and a triangle cross at the end; start from a smoother lay or a finer coarse level"
    )]
    Crossing {
        /// How many.
        pairs: usize,
        /// The state.
        state: Box<Rested>,
    },
    /// Still moving after all steps.
    #[error("{}", unrest(state, panel, *wanted))]
    NotAtRest {
        /// The speed that was asked for, m/s.
        wanted: f64,
        /// The panel with the greatest force left over.
        panel: String,
        /// The last state, which has neither crossings nor vertices in the body.
        state: Box<Rested>,
    },
    /// The budget of time is spent.
    #[error(
        "out of time after {seconds:.1} s on level {level} of {levels}; allow more time or take a coarser mesh"
    )]
    Timeout {
        /// Wall time spent, s.
        seconds: f64,
        /// The level, coarse to fine, from 1.
        level: usize,
        /// Levels.
        levels: usize,
        /// The state carried to the finest level.
        positions: Vec<Vec3>,
    },
    /// A garment that is to go on has another mesh or other seams.
    #[error("the mesh or its seams have changed; solve the scene from its start")]
    Reshaped,
    /// The caller asked to stop.
    #[error("stopped")]
    Stopped,
}

impl RestError {
    /// Whether a finer mesh to begin on may help.
    pub(super) fn is_of_a_coarse_mesh(&self) -> bool {
        matches!(
            self,
            Self::SeamNotClosed { .. }
                | Self::Cloth(ClothError::NonManifoldEdge { .. })
                | Self::Crossing { .. }
        )
    }
}

impl From<Sunk> for RestError {
    fn from(sunk: Sunk) -> Self {
        Self::InitialPenetration { vertices: sunk.vertices, depth: sunk.depth }
    }
}
