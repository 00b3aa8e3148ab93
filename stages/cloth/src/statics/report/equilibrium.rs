//! The result and the progress of the static solver.

use crate::contact::friction::FrictionContact;
use crate::statics::newton::state::Outcome;
use crate::statics::report::unbalanced::Unbalanced;
use std::ops::ControlFlow;
use toile_geometry::Vec3;

/// The run of one level.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelReport {
    /// Its nodes.
    pub nodes: usize,
    /// Whether seams were open.
    pub sewing: bool,
    /// The widest seam that is still open, m; 0 where none is.
    pub gap: f64,
    /// The name of that seam; empty where none is open.
    pub seam: String,
    /// The index of the level, counted from 1 for the coarsest, and how many levels there are.
    pub pass: [usize; 2],
    /// Its last outcome.
    pub outcome: Outcome,
    /// Wall time, s.
    pub seconds: f64,
}

/// An equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Position of every vertex of the scene, m.
    pub positions: Vec<Vec3>,
    /// The outcome of the finest level.
    pub outcome: Outcome,
    /// Greatest residual force on a node, N.
    pub residual: f64,
    /// The node with that force, and what it is in contact with.
    pub unbalanced: Unbalanced,
    /// Tangential displacement of each vertex on the body, m, for
    /// [`Live`](crate::statics::drive::live::Live).
    pub slides: Vec<Vec3>,
    /// Angles of bending hysteresis, by hinges of the sewn garment, for `Live`.
    pub folds: Vec<f64>,
    /// Friction of every contact of cloth with cloth, by sewn points, for `Live`.
    pub friction_contacts: Vec<FrictionContact>,
    /// Offset of body contact at each vertex, m; empty without a body.
    pub offsets: Vec<f64>,
    /// Elastic and gravitational energy, J.
    pub energy: f64,
    /// Deepest point inside the body between vertices, m; 0 unless the body has edges sharper than
    /// the mesh can follow.
    pub dip: f64,
    /// Widest gap of the seams when they were joined, m; `None` without seams.
    pub joined_at: Option<f64>,
    /// The runs of all levels, coarse to fine, of the last try.
    pub levels: Vec<LevelReport>,
    /// How many times the garment was started again, each time with a finer coarsest level, or once
    /// without bending continuation.
    pub restarts: usize,
}

/// Called while solving, with a function that gives the position of every vertex of the scene, m;
/// it may stop the solver.
pub type Progress<'p> = dyn FnMut(&LevelReport, &dyn Fn() -> Vec<Vec3>) -> ControlFlow<()> + 'p;
