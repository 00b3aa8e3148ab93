//! Why `StaticEquilibrium` finds no garment at rest, in words that say what to change.

use crate::contact::past::Fallen;
use crate::error::ClothError;
use crate::scene::SceneError;
use crate::statics::factor::multifrontal::NotPositive;
use crate::statics::report::equilibrium::Equilibrium;
use crate::statics::report::load::Load;
use crate::statics::report::not_at_rest::unrest;
use crate::statics::report::start::StartError;
use crate::statics::report::words::{both, list, place};
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// How far, in edges, a seam may stay open because its mesh is too coarse: a polygon of n corners
/// about a limb is longer than the limb's girth by 3.3 edges over n, and what is folded onto itself
/// by its seams by an edge or two.
pub(crate) const MOST_EDGES: f64 = 3.0;

/// What is about a vertex whose step has no solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Unsolvable {
    /// It belongs to no triangle.
    #[error("it belongs to no triangle; remove it, or give it one")]
    Loose,
    /// Its place is no finite number.
    #[error(
        "its place is no finite number any more; look for stiffness, density and lengths beyond those of cloth"
    )]
    Lost,
    /// Its triangles have no area where they start.
    #[error("its triangles have no area where they start; lay the panel out flat")]
    Flat,
    /// The forces on it differ too much in size.
    #[error(
        "the forces on it are too far apart to be told from each other; look for stiffness, density and lengths beyond those of cloth"
    )]
    Apart,
}

/// Why there is no garment at rest.
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
    /// What is wrong with the start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// A step that has no solution.
    #[error("no step can be solved at vertex {vertex} of {panel}: {why}")]
    Unsolvable {
        /// The vertex about which it has none.
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
    /// Cloth came through cloth while it was brought to rest.
    #[error(
        "cloth passes through cloth under its load: {} while solving, and {pairs} pairs cross or lie in each other, one at {}, while {load}",
        both(panels, "came through", "came through"),
        place(at)
    )]
    Tangled {
        /// Two panels of them.
        panels: [String; 2],
        /// How many pairs of an edge and a triangle, or so near that nothing tells their sides.
        pairs: usize,
        /// Where one is, m.
        at: Vec3,
        /// Weight against stiffness.
        load: Load,
    },
    /// Cloth that passes through cloth at the end.
    #[error(
        "{pairs} pairs of an edge and a triangle cross at the end; place the panels more smoothly, or begin on a finer mesh"
    )]
    Crossing {
        /// How many.
        pairs: usize,
        /// The state.
        state: Box<Equilibrium>,
    },
    /// Still moving after all steps.
    #[error("{}", unrest(state, panel, *wanted))]
    NotAtRest {
        /// The speed that was asked for, m/s.
        wanted: f64,
        /// The panel with the greatest force left over.
        panel: String,
        /// The last state, which has neither crossings nor vertices in the body.
        state: Box<Equilibrium>,
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

impl StaticsError {
    /// How far the cloth has come, where that is known: vertices of the finest level, m.
    #[must_use]
    pub fn so_far(&self) -> Option<&[Vec3]> {
        match self {
            Self::SeamNotClosed { positions, .. } | Self::Timeout { positions, .. } => Some(positions),
            _ => None,
        }
    }

    /// Whether a finer mesh to begin on may help, where this one's edges have a mean length, m.
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
