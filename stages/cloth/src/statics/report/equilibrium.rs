//! What the static solver reports.

use crate::contact::friction::FrictionContact;
use crate::statics::newton::state::Outcome;
use crate::statics::report::unbalanced::Unbalanced;
use nalgebra::Vector3;
use std::ops::ControlFlow;

type Vec3 = Vector3<f64>;

/// What one level did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelReport {
    /// Its nodes.
    pub nodes: usize,
    /// Whether seams were open.
    pub sewing: bool,
    /// The widest seam that is still open, m; 0 where none is.
    pub gap: f64,
    /// Which of how many meshes it is, from the first on, counted from 1.
    pub pass: [usize; 2],
    /// How it ended.
    pub outcome: Outcome,
    /// Wall time, s.
    pub seconds: f64,
}

/// A garment at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Position of every vertex of the scene, m.
    pub positions: Vec<Vec3>,
    /// How the finest level ended.
    pub outcome: Outcome,
    /// Greatest force left on a node, N.
    pub residual: f64,
    /// Where that is, and what the cloth meets there.
    pub unbalanced: Unbalanced,
    /// How far friction holds each vertex back, m: what [`Live`](crate::statics::drive::live::Live)
    /// goes on from.
    pub slides: Vec<Vec3>,
    /// Angles at which friction between yarns holds the folds, by hinges of the sewn garment: what
    /// `Live` goes on from.
    pub folds: Vec<f64>,
    /// Friction of every contact of cloth with cloth, by sewn points: what `Live` goes on from.
    pub friction_contacts: Vec<FrictionContact>,
    /// Distance at which the body begins to press on each vertex, m; none without a body.
    pub offsets: Vec<f64>,
    /// Elastic and gravitational energy, J.
    pub energy: f64,
    /// Deepest point inside the body between vertices, m; 0 unless the body has edges sharper than
    /// the mesh can follow.
    pub dip: f64,
    /// Widest seam when it was joined, m; nothing where there are none.
    pub joined_at: Option<f64>,
    /// Every level, coarse to fine, of the try that came to its end.
    pub levels: Vec<LevelReport>,
    /// How often the garment was begun again, each time on a finer coarsest mesh, or once without
    /// grading.
    pub restarts: usize,
}

/// What a caller learns while solving; it may stop the solver.
pub type Progress<'p> = dyn FnMut(&LevelReport) -> ControlFlow<()> + 'p;
