//! What the stages that drape in time have in common: from garment to scene, through the motion, and back.

use crate::cloth::check_garment;
use crate::engine::{self, SchemeSkin, Setting, cloth_error, only_joins, scene_error, scene_of, weld_seams};
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::time::Duration;
use toile_cloth::force::Air as EngineAir;
use toile_cloth::motion::{Method, Motion, MotionError, Moved, Progress, Until};
use toile_cloth::rest::solve::Wearer;
use toile_cloth::scene::{Phase as ScenePhase, Scene};
use toile_core::prelude::*;

/// Settings that all of them share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub(super) method: Method,
    pub(super) gravity: f64,
    pub(super) air: EngineAir,
    pub(super) dt: f64,
    pub(super) drag: f64,
    pub(super) speed: f64,
    pub(super) longest: f64,
    pub(super) join_gap: f64,
    pub(super) time_limit: f64,
}

/// Distance at which cloth is held off itself where there is no collider, m.
const THICKNESS: f64 = 1e-3;
/// Change of energy in a sixtieth of a second at rest, as a share.
const SETTLED: f64 = 1e-3;

/// Sews the garment and lets it come to rest, or follows the phases of a scene.
pub(super) fn drape(
    course: &Course,
    garment: &Garment,
    collider: Option<&Collider>,
    phases: Option<&Phases>,
    cx: &Context,
) -> Result<Garment, StageError> {
    check_garment(garment)?;
    garment.seams.iter().try_for_each(|s| only_joins(s.kind, &s.name))?;
    check_wind(&course.air)?;
    let card = collider.map(|c| c.scheme.card());
    let setting = Setting {
        gravity: Vector3::new(0.0, -course.gravity, 0.0),
        air: Some(course.air).filter(EngineAir::acts),
        thickness: card.map_or(THICKNESS, |c| c.thickness),
        self_collision: card.is_none_or(|c| c.self_collision),
    };
    let scene = with_phases(scene_of(garment, &setting)?, phases);
    let skin = collider.map(|c| SchemeSkin::new(c.scheme.as_ref()));
    let friction = card.map_or(0.0, |c| c.friction);
    let wearer = skin.as_ref().map(|skin| Wearer { skin, friction });
    let until = match phases {
        Some(_) => Until::Phases { longest: course.longest },
        None => Until::Rest { speed: course.speed, energy: SETTLED, longest: course.longest },
    };
    let motion = Motion {
        method: course.method,
        dt: course.dt,
        drag: course.drag,
        join_gap: course.join_gap,
        until,
        budget: Duration::from_secs_f64(course.time_limit),
        ..Motion::default()
    };
    let moved = motion.run(&scene, wearer, &mut |p| tell(p, course.longest, cx));
    cx.check()?;
    let moved = moved.map_err(|e| motion_error(&e))?;
    if !moved.converged {
        cx.warn(unrest(&moved, course.speed));
    }
    cx.figure("motion_time", moved.progress.time, "s");
    let mut draped = finish(garment, &moved);
    let gravity = scene.phases.last().map(|p| p.gravity).unwrap_or_default();
    if let Some(collider) = collider {
        let kept = engine::on_body(garment, &draped.positions, collider.scheme.as_ref(), &gravity);
        draped.status.on_body = engine::both(&garment.status.on_body, kept);
    }
    Ok(draped)
}

/// Why a motion has not come to rest, whose speed is `wanted`, m/s.
fn unrest(moved: &Moved, wanted: f64) -> String {
    let (speed, wanted, time) = (moved.progress.speed * 1e3, wanted * 1e3, moved.progress.time);
    if moved.is_jammed {
        format!(
            "after {time:.1} s cloth holds cloth in the air, where it has no rest: take a smaller `dt`, or place the layers farther apart"
        )
    } else if speed < wanted {
        let share = SETTLED * 1e2;
        format!(
            "after {time:.1} s the cloth moves by only {speed:.2} mm/s, but its energy still changes by more than {share} % in a sixtieth of \
             a second: allow a longer motion"
        )
    } else {
        format!(
            "the cloth still moves by {speed:.1} mm/s after {time:.1} s, at rest it has less than {wanted:.1} mm/s: allow a longer motion"
        )
    }
}

/// The air that a stage's parameters name.
pub(super) fn air(density: f64, normal: f64, tangential: f64, wind: (f64, f64, f64)) -> EngineAir {
    EngineAir { density, normal, tangential, wind: Vector3::new(wind.0, wind.1, wind.2) }
}

pub(super) fn engine_air(a: Air) -> EngineAir {
    EngineAir { density: a.density, normal: a.normal, tangential: a.tangential, wind: a.wind }
}

fn check_wind(air: &EngineAir) -> Result<(), StageError> {
    if air.wind.norm() > 0.0 && !air.acts() {
        let e = StageError::new(ErrorCode::InvalidParameter, "there is wind, but no air that could blow");
        return Err(e.hint("write `air: 1.2`").at("wind"));
    }
    Ok(())
}

fn with_phases(scene: Scene, phases: Option<&Phases>) -> Scene {
    let Some(phases) = phases else { return scene };
    let own = scene.phases.last().and_then(|p| p.air);
    let phase = |p: &Phase| ScenePhase {
        name: p.name.clone(),
        seconds: p.seconds,
        gravity: p.gravity,
        air: p.air.map(engine_air).or(own),
    };
    Scene { phases: phases.0.iter().map(phase).collect(), ..scene }
}

fn tell(p: &Progress, longest: f64, cx: &Context) -> ControlFlow<()> {
    if cx.check().is_err() {
        return ControlFlow::Break(());
    }
    let gap = if p.gap > 0.0 { format!(", seam gap {:.1} mm", p.gap * 1e3) } else { String::new() };
    cx.progress(p.time / longest, format!("{:.2} s, fastest {:.0} mm/s{gap}", p.time, p.speed * 1e3));
    ControlFlow::Continue(())
}

fn finish(garment: &Garment, moved: &Moved) -> Garment {
    let mut garment = garment.clone();
    garment.positions = moved.positions.iter().map(|p| Point3::from(*p)).collect();
    garment.velocities.clone_from(&moved.velocities);
    weld_seams(&mut garment);
    garment.status = SolveStatus {
        steps: garment.status.steps + moved.progress.steps,
        converged: moved.converged,
        energy: moved.energy,
        max_speed: moved.progress.speed,
        on_body: garment.status.on_body.clone(),
    };
    garment
}

pub(super) fn motion_error(error: &MotionError) -> StageError {
    let message = error.to_string();
    let (text, hint) = message.split_once("; ").map_or((&*message, None), |(t, h)| (t, Some(h)));
    let code = match error {
        MotionError::Cloth(e) => return cloth_error(e),
        MotionError::Scene(e) => return scene_error(e),
        MotionError::FallsPast(_) => ErrorCode::StaticEquilibrium,
        MotionError::SeamNotClosed { .. } => ErrorCode::StitchingError,
        MotionError::Timeout { .. } => ErrorCode::Timeout,
        MotionError::Stopped => ErrorCode::Cancelled,
        MotionError::Start(_) | MotionError::Fabrics { .. } => ErrorCode::InvalidInput,
    };
    let e = StageError::new(code, text);
    match hint {
        Some(hint) => e.hint(hint),
        None => e,
    }
}
