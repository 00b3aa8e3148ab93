//! What a garment does when it is let go where it is, without the state of the solver that draped
//! it.
//!
//! Method: the static solver goes on from the places of the vertices, on their own mesh, until it
//! finds the cloth at rest as it does at the end of a drape: in a step of a tenth of a second or
//! more, from a standstill, no vertex but a share gains a speed. Steps are implicit, so that places
//! rounded to what a file holds do not count. Cost: a factorization a step. Limits: the history of
//! friction is not known, so that cloth which friction holds slides until friction holds it again;
//! cloth that another program holds off the body by more than the collider falls by the rest.

use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;
use toile_cloth::statics::drive::live::Live;
use toile_cloth::statics::drive::solve::{
    Collider as EngineCollider, LevelReport, StaticEquilibrium as Solver, StaticsError,
};
use toile_core::artifact::{Collider, Fabric, Garment, GarmentSeam, SeamKind, SeamState};
use toile_core::{ErrorCode, StageError};
use toile_drape::engine::{SceneSetting, SchemeSurface, cloth_error, scene_error, scene_of, split};

/// m/s².
const GRAVITY: f64 = 9.81;
/// Steps at most.
const STEPS: usize = 12;
/// At rest a vertex gains no more, m/s, but for the share.
const REST_SPEED: f64 = 5e-3;
/// The share of the vertices that may gain more: where the skin of a body folds some never come to
/// rest.
pub(crate) const NON_STATIC: f64 = 0.015;
/// A step of this length shows what slides or falls, s.
const LONG: f64 = 0.1;
/// Vertices that move no farther in a step have come to their places, m.
const SETTLED: f64 = 1e-3;
/// The number of steps alone bounds the time.
const BUDGET: Duration = Duration::from_secs(3600);

/// What comes of letting a garment go.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Released {
    /// The least share of the vertices that get fast in a step of [`LONG`] or more.
    pub(crate) moving: f64,
    /// How each vertex moves until the cloth is at rest, or in the steps that it is given, m.
    pub(crate) moves: Vec<Vector3<f64>>,
    /// Steps that were made.
    pub(crate) steps: usize,
}

/// Lets a garment of that fabric go, on `collider`, whose friction and distance count.
///
/// # Errors
/// Triangles without area, or a fabric that the engine does not take.
pub(crate) fn released(
    garment: &Garment,
    fabric: &Arc<Fabric>,
    collider: &Collider,
) -> Result<Released, StageError> {
    let card = collider.scheme.card();
    let setting = SceneSetting {
        gravity: Vector3::new(0.0, -GRAVITY, 0.0),
        air: None,
        thickness: card.thickness,
        self_collision: card.self_collision,
    };
    let scene = scene_of(&worn(garment, fabric), &setting)?;
    let surface = SchemeSurface::new(collider.scheme.as_ref());
    let engine_collider = EngineCollider { surface: &surface, friction: card.friction };
    let settings = Solver {
        speed: REST_SPEED,
        non_static: 0.0,
        finest_steps: STEPS,
        budget: BUDGET,
        from_here: true,
        long_proof: true,
        ..Solver::default()
    };
    let mut live = Live::here(settings, scene, Some(engine_collider)).map_err(|e| unsolved(&e))?;
    let start = live.positions();
    let (mut moving, mut steps) = (1.0_f64, 0);
    let mut watch = |report: &LevelReport, _: &dyn Fn() -> Vec<Vector3<f64>>| {
        let step = report.outcome;
        steps = step.steps;
        if step.dt >= LONG {
            moving = moving.min(step.non_static);
        }
        // What single vertices do is seen to its end.
        match moving <= NON_STATIC && step.fastest * step.dt <= SETTLED {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    match live.settle(&mut watch) {
        // Cloth that crosses itself is told by its own check.
        Ok(_)
        | Err(StaticsError::Stopped | StaticsError::NotAtRest { .. } | StaticsError::Crossing { .. }) => {}
        Err(e) => return Err(unsolved(&e)),
    }
    let moves = live.positions().iter().zip(&start).map(|(x, p)| x - p).collect();
    Ok(Released { moving, moves, steps })
}

/// The garment of that fabric; vertices at one place are sewn where no seam names them.
fn worn(garment: &Garment, fabric: &Arc<Fabric>) -> Garment {
    let mut garment = garment.clone();
    garment.panels.iter_mut().for_each(|p| p.fabric = fabric.clone());
    let joined = (0_u32..).zip(&garment.weld).filter(|(v, w)| v != *w).map(|(v, w)| [*w, v]).collect();
    let (name, kind, state) = ("joined".to_owned(), SeamKind::Matched, SeamState::Closed);
    garment.seams.push(GarmentSeam { name, kind, pairs: joined, state });
    garment
}

fn unsolved(error: &StaticsError) -> StageError {
    match error {
        StaticsError::Cloth(e) => cloth_error(e),
        StaticsError::Scene(e) => scene_error(e),
        other => split(ErrorCode::StaticEquilibrium, &other.to_string()),
    }
}
