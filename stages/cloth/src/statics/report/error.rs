//! Errors of `StaticEquilibrium`, whose messages say what to change.

use crate::contact::past::Fallen;
use crate::error::ClothError;
use crate::scene::SceneError;
use crate::statics::factor::multifrontal::NotPositive;
use crate::statics::report::equilibrium::Equilibrium;
use crate::statics::report::load::Load;
use crate::statics::report::not_at_rest::unrest;
use crate::statics::report::start::StartError;
use crate::statics::report::words::{both, list, place};
use toile_geometry::Vec3;

/// Greatest gap, in edges, that a seam may have because its mesh is too coarse. A polygon of n
/// corners around a limb is longer than the girth of the limb by 3.3 edges over n, and cloth that
/// its seams fold onto itself is longer by one or two edges.
pub(crate) const MOST_EDGES: f64 = 3.0;

/// Why the step of a vertex has no solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Unsolvable {
    /// It belongs to no triangle.
    #[error("it belongs to no triangle; remove it, or give it one")]
    Loose,
    /// Its position is not finite.
    #[error(
        "its place is no finite number any more; look for stiffness, density and lengths beyond those of cloth"
    )]
    Lost,
    /// Its triangles have no area at the start.
    #[error("its triangles have no area where they start; lay the panel out flat")]
    Flat,
    /// The forces on it differ too much in size.
    #[error(
        "the forces on it differ too much in size to be balanced; look for stiffness, density and lengths beyond those of cloth"
    )]
    Apart,
}

/// Why no equilibrium was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaticsError {
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
    /// A fault of the initial positions.
    #[error(transparent)]
    Start(#[from] StartError),
    /// A step that has no solution.
    #[error("no step can be solved at vertex {vertex} of {panel}: {why}")]
    Unsolvable {
        /// The vertex without one.
        vertex: usize,
        /// Its panel.
        panel: String,
        /// Why.
        why: Unsolvable,
    },
    /// Cloth falls past the body.
    #[error("{0}")]
    FallsPast(Box<Fallen>),
    /// A seam does not close.
    #[error(
        "seam '{seam}' stays open by {:.1} mm at {force:.1} N a metre; {}",
        1e3 * gap, remedy(reversed)
    )]
    SeamNotClosed {
        /// The seam with the widest gap.
        seam: String,
        /// Its widest gap, m.
        gap: f64,
        /// The force that did not close it, N/m.
        force: f64,
        /// Seams whose pairs seem to run against each other.
        reversed: Vec<String>,
        /// The state carried to the finest level.
        positions: Vec<Vec3>,
    },
    /// Cloth passed through cloth while solving.
    #[error(
        "cloth passes through cloth under its load: {} while solving, and {pairs} pairs cross or lie in each other, one at {}, while {load}",
        both(panels, "came through", "came through"),
        place(at)
    )]
    Tangled {
        /// Two panels of them.
        panels: [String; 2],
        /// The number of crossings and merged pairs.
        pairs: usize,
        /// The place of one of them, m.
        at: Vec3,
        /// Weight against stiffness.
        load: Load,
    },
    /// Cloth passes through cloth in the final state.
    #[error(
        "{pairs} pairs of an edge and a triangle cross at the end; place the panels more smoothly, or begin on a finer mesh"
    )]
    Crossing {
        /// How many.
        pairs: usize,
        /// The state.
        state: Box<Equilibrium>,
    },
    /// The cloth still moves after all steps.
    #[error("{}", unrest(state, panel, *wanted))]
    NotAtRest {
        /// The speed that was requested, m/s.
        wanted: f64,
        /// The panel with the greatest residual force.
        panel: String,
        /// The last state, which has neither crossings nor vertices in the body.
        state: Box<Equilibrium>,
    },
    /// The time limit is reached.
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
    /// A live garment was given another mesh or other seams.
    #[error("the mesh or its seams have changed; solve the scene from its start")]
    Reshaped,
    /// The caller asked to stop.
    #[error("stopped")]
    Stopped,
}

impl StaticsError {
    /// The positions of the cloth, where they are known: vertices of the finest level, m.
    #[must_use]
    pub fn so_far(&self) -> Option<&[Vec3]> {
        match self {
            Self::SeamNotClosed { positions, .. } | Self::Timeout { positions, .. } => Some(positions),
            _ => None,
        }
    }

    /// Whether a finer coarsest level may help; `edge` is the mean edge length of this one, m.
    pub(crate) fn is_of_a_coarse_mesh(&self, edge: f64) -> bool {
        match self {
            Self::SeamNotClosed { gap, .. } => *gap < MOST_EDGES * edge,
            Self::Cloth(ClothError::NonManifoldEdge { .. }) | Self::Crossing { .. } => true,
            _ => false,
        }
    }
}

pub(crate) fn remedy(reversed: &[String]) -> String {
    match reversed {
        [] => "place its panels nearer, with nothing between its sides, or cut them wider".into(),
        names => format!(
            "the pairs of {} {} seem to run against each other: if that is not meant, list their second vertices in reverse order",
            if names.len() == 1 { "seam" } else { "seams" },
            list(names)
        ),
    }
}
