//! Sewing through: cloth passes through cloth while its seams close, and is taken out of itself
//! after.
//!
//! Method: what starts in the body is moved out of it. The seams close on a coarse mesh of the
//! pieces, whose sheets do not meet. The sewn mesh is taken out of itself along the contours where
//! it crosses (see `contour`), carried to each finer mesh and let move there a little, without
//! weight, so that it becomes smooth. Where the garment is sewn around thinner solids first, each
//! of them pushes it out, and the body last. Cost: that of the motion on a mesh of some hundred
//! points, and a few steps on each finer one. Limits: a limb that comes through the coarse mesh
//! asks for the next finer one, down to the cut mesh; crossings may be left.

use super::contact::Pushed;
use super::moving::Moving;
use super::{MotionError, MotionRun, SAME_TIME};
use crate::solver::State;
use crate::statics::drive::solve::Collider;
use crate::statics::levels::coarsen::{Coarser, levels};
use crate::statics::levels::pieces::Pieces;
use crate::statics::report::start::moved_out;
use toile_geometry::Vec3;

/// How cloth is sewn through cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Through {
    /// Points of the coarsest mesh, on which the seams close.
    pub coarsest: usize,
}

/// Widest gap at which seams are joined that the body keeps open, as a share of an edge.
pub(super) const JOINED_GAP: f64 = 0.3;

/// Time in which the sewn cloth becomes smooth on each mesh, s.
const SMOOTHING: f64 = 0.1;

/// Drag meanwhile, 1/s.
const SMOOTHING_DRAG: f64 = 30.0;

/// Speed at which a solid pushes cloth out of itself meanwhile, m/s.
const PUSHING_SPEED: f64 = 0.5;

/// Depth from which it does, m.
const REACH: f64 = 0.1;

/// The meshes of a scene, from fine to coarse.
pub(super) struct Meshes {
    pieces: Vec<Pieces>,
    coarser: Vec<Coarser>,
    starts: Vec<Vec<Vec3>>,
}

impl Meshes {
    fn new(run: &MotionRun<'_>, coarsest: usize) -> Result<Self, MotionError> {
        let (pieces, coarser) = levels(run.scene, coarsest);
        let surface = run.sewn_on().map(|c| c.surface);
        let mut starts = vec![moved_out::<MotionError>(run.scene, surface, run.settings.join_gap)?];
        for level in &coarser {
            let finer = &starts[starts.len() - 1];
            starts.push(level.kept.iter().map(|&v| finer[v as usize]).collect());
        }
        Ok(Self { pieces, coarser, starts })
    }

    fn coarsest(&self) -> usize {
        self.coarser.len()
    }
}

impl MotionRun<'_> {
    /// Sews the garment on a coarse mesh, and carries it to the scene's own; a mesh through which
    /// the body comes is too coarse.
    pub(super) fn sewn_through(&mut self, through: Through, longest: f64) -> Result<Moving, MotionError> {
        let mut coarsest = through.coarsest;
        loop {
            let meshes = Meshes::new(self, coarsest)?;
            let k = meshes.coarsest();
            let moving = self.sewn_on_mesh(&meshes, longest)?;
            let finer = k.checked_sub(1).map(|k| meshes.pieces[k].points);
            match finer.filter(|_| moving.is_pierced(self.collider)) {
                Some(points) => coarsest = points,
                None => return self.carried(&meshes, moving),
            }
        }
    }

    /// Closes and joins the seams on the coarsest mesh.
    fn sewn_on_mesh(&mut self, meshes: &Meshes, longest: f64) -> Result<Moving, MotionError> {
        let k = meshes.coarsest();
        self.take_mesh(meshes, k);
        let open = Moving::open(self, meshes.starts[k].clone())?;
        let body = self.collider;
        self.collider = self.sewn_on();
        let sewn = self.sew(open, longest);
        self.collider = body;
        let mut moving = sewn?;
        moving.uncross();
        for surface in self.around.iter().skip(1) {
            self.smoothed(&mut moving, body.map(|c| Collider { surface: *surface, ..c }))?;
        }
        self.smoothed(&mut moving, body)?;
        Ok(moving)
    }

    /// Carries the sewn cloth to the scene's own mesh.
    fn carried(&mut self, meshes: &Meshes, mut moving: Moving) -> Result<Moving, MotionError> {
        for k in (0..meshes.coarsest()).rev() {
            let x = meshes.coarser[k].prolong(&self.pieces.spread(&moving.state.x));
            self.take_mesh(meshes, k);
            let x = self.pieces.sew(&x, &vec![1.0; x.len()]);
            let time = moving.state.time;
            moving = moving.goes_on(self, State { time, ..State::at_rest(x) })?;
            moving.uncross();
            let body = self.collider;
            self.smoothed(&mut moving, body)?;
        }
        Ok(moving)
    }

    fn take_mesh(&mut self, meshes: &Meshes, k: usize) {
        self.pieces = meshes.pieces[k].clone();
        self.coarser = meshes.coarser[..k].to_vec();
    }

    /// Lets the sewn cloth move a little without weight and friction, while a solid pushes it out.
    fn smoothed(&mut self, moving: &mut Moving, solid: Option<Collider<'_>>) -> Result<(), MotionError> {
        moving.set_damping(SMOOTHING_DRAG, 0.0);
        moving.pushed = Some(Pushed { reach: REACH, speed: PUSHING_SPEED });
        let end = moving.progress.time + SMOOTHING;
        while end - moving.progress.time > SAME_TIME {
            self.step_on(solid, moving, end)?;
        }
        moving.pushed = None;
        moving.state.v.fill(Vec3::zeros());
        moving.uncross();
        Ok(())
    }
}
