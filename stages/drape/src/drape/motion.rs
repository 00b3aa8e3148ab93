//! What the stages that drape in time have in common: from garment to scene, through the motion,
//! and back.

use super::frames;
use crate::engine::{
    self, MessageContext, Motions, SceneSetting, SchemeSurface, only_joins, scene_of, weld_seams,
};
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::time::Duration;
use toile_cloth::energy::{Air as EngineAir, Models};
use toile_cloth::motion::{Method, Motion, Moved, Progress, Response, Until};
use toile_cloth::scene::{Phase as ScenePhase, Scene};
use toile_cloth::statics::drive::solve::Collider as EngineCollider;
use toile_cloth::stopper::Stopper;
use toile_core::prelude::*;

/// What all of them share.
#[params]
#[derive(Copy)]
pub struct InTime {
    /// Downward acceleration; a scene's own phases come before it.
    #[param(default = 9.81, min = 0.0, max = 1000.0, unit = "m/s2")]
    pub gravity: f64,
    /// Time between two looks at contacts.
    #[param(default = 0.004, min = 1e-6, max = 0.1, unit = "s", trades, finer = "less")]
    pub dt: f64,
    /// Drag in proportion to mass, so that swinging dies out; 0 for a true fall.
    #[param(default = 4.0, min = 0.0, max = 1000.0, unit = "1/s")]
    pub drag: f64,
    /// Density of the air, which slows every triangle and carries the wind: 1.2 at 20 degrees; a
    /// scene's phases may have their own.
    #[param(default = 0.0, min = 0.0, max = 2000.0, unit = "kg/m3")]
    pub air: f64,
    /// Drag coefficient of the air across the cloth.
    #[param(default = 1.17, min = 0.0, max = 100.0)]
    pub air_normal: f64,
    /// Drag coefficient of the air along the cloth, both sides together.
    #[param(default = 0.008, min = 0.0, max = 100.0)]
    pub air_tangential: f64,
    /// Velocity of the air; still while seams are sewn.
    #[param(default = (0.0, 0.0, 0.0), min = -500.0, max = 500.0, unit = "m/s")]
    pub wind: (f64, f64, f64),
    /// At rest, no vertex is faster, by its way in a sixtieth of a second.
    #[param(default = 0.02, min = 1e-9, max = 10.0, unit = "m/s", trades, finer = "less")]
    pub speed: f64,
    /// Longest motion for sewing, and again for draping.
    #[param(default = 6.0, min = 0.001, max = 1000.0, unit = "s", trades)]
    pub longest: f64,
    /// Gap below which a seam is joined.
    #[param(default = Length::mm(0.5), min = 1e-6, max = 0.1, trades)]
    pub join_gap: Length,
    /// Wall time after which it gives up. A run that meets it is not repeatable.
    #[param(default = 600.0, min = 0.001, max = 1e6, unit = "s", trades)]
    pub time_limit: f64,
    /// Time between two frames that are recorded, none at 0; `Frames` behind it asks for its own.
    #[param(default = 0.0, min = 0.0, max = 100.0, unit = "s")]
    pub frames: f64,
}

/// Distance at which cloth is held off itself where there is no collider, m.
const THICKNESS: f64 = 1e-3;
/// Change of energy in a sixtieth of a second at rest, as a share.
const SETTLED: f64 = 1e-3;

/// What a stage has a garment do in time.
pub(crate) struct Course<'a> {
    pub(crate) time: &'a InTime,
    pub(crate) motion: Motion,
    /// What its user can change.
    pub(crate) can: Motions,
}

/// Sews the garment and lets it come to rest, or follows the phases of a scene; `soft` is the
/// garment as the solver takes it.
pub(super) fn drape(
    course: &Course<'_>,
    soft: &Garment,
    garment: &Garment,
    collider: Option<&Collider>,
    phases: Option<&Phases>,
    cx: &Context,
) -> Result<Garment, StageError> {
    let mut draped = moved(course, soft, garment, collider, phases, cx)?;
    let gravity = match phases.and_then(|p| p.0.last()) {
        Some(last) => last.gravity,
        None => Vector3::new(0.0, -course.time.gravity, 0.0),
    };
    if let Some(collider) = collider {
        let kept = engine::on_body(garment, &draped.positions, collider.scheme.as_ref(), &gravity);
        draped.status.on_body = engine::both(&garment.status.on_body, kept);
    }
    Ok(draped)
}

/// The garment after the motion.
pub(crate) fn moved(
    course: &Course<'_>,
    soft: &Garment,
    garment: &Garment,
    collider: Option<&Collider>,
    phases: Option<&Phases>,
    cx: &Context,
) -> Result<Garment, StageError> {
    let time = course.time;
    garment.check_solvable()?;
    garment.seams.iter().try_for_each(|s| only_joins(s.kind, &s.name))?;
    let air = time.air();
    check_wind(&air)?;
    let card = collider.map(|c| c.scheme.card());
    let setting = SceneSetting {
        gravity: Vector3::new(0.0, -time.gravity, 0.0),
        air: Some(air).filter(EngineAir::acts),
        thickness: card.map_or(THICKNESS, |c| c.thickness),
        self_collision: card.is_none_or(|c| c.self_collision),
    };
    let scene = with_phases(scene_of(soft, &setting)?, phases);
    let surface = collider.map(|c| SchemeSurface::new(c.scheme.as_ref()));
    let friction = card.map_or(0.0, |c| c.friction);
    let engine_collider = surface.as_ref().map(|surface| EngineCollider { surface, friction });
    let until = match phases {
        Some(_) => Until::Phases { longest: time.longest },
        None => course.motion.until,
    };
    let response =
        card.map_or(Response::default(), |c| Response { restitution: c.restitution, penalty: c.penalty });
    let motion = Motion { until, response, ..course.motion };
    let cancel = cx.cancel().clone();
    let stopper = Stopper::when(move || cancel.is_cancelled());
    let mut recorder = frames::recorder(time.frames, garment, cx)?;
    let mut told = |p: &Progress| tell(p, time, cx);
    let moved = motion.run_recorded(&scene, engine_collider, &stopper, &mut told, recorder.as_mut());
    cx.check()?;
    if recorder.as_ref().is_some_and(|r| r.is_full) {
        return Err(frames::full(time.frames));
    }
    let words = MessageContext { garment, scheme: collider.map(|c| c.scheme.as_ref()), stage: cx.stage() };
    let moved = moved.map_err(|e| words.motion(&e, &course.can))?;
    if !moved.converged {
        cx.warn(unrest(&moved, time.speed));
    }
    cx.figure("motion_time", moved.progress.time, "s");
    let mut finished = finish(garment, &moved);
    finished.motion = frames::after(recorder, garment, &moved);
    Ok(finished)
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

impl InTime {
    /// What a stage with these parameters does by a method with these models.
    pub(super) fn course(&self, method: Method, models: Models) -> Course<'_> {
        let motion = self.motion(method, models);
        let can = Motions {
            longest: ("longest", self.longest),
            closing: motion.closing,
            time_limit: Some(self.time_limit),
            stiffest: None,
        };
        Course { time: self, motion, can }
    }

    /// The motion until rest, by a method with these models.
    pub(crate) fn motion(&self, method: Method, models: Models) -> Motion {
        Motion {
            method,
            models,
            dt: self.dt,
            drag: self.drag,
            join_gap: self.join_gap.metres(),
            until: Until::Rest { speed: self.speed, energy: SETTLED, longest: self.longest },
            budget: Duration::from_secs_f64(self.time_limit),
            ..Motion::default()
        }
    }

    /// The air that the parameters name.
    fn air(&self) -> EngineAir {
        let (x, y, z) = self.wind;
        let wind = Vector3::new(x, y, z);
        EngineAir { density: self.air, normal: self.air_normal, tangential: self.air_tangential, wind }
    }
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

fn tell(p: &Progress, time: &InTime, cx: &Context) -> ControlFlow<()> {
    if cx.check().is_err() {
        return ControlFlow::Break(());
    }
    let (speed, rest) = (p.speed * 1e3, time.speed * 1e3);
    let doing = match p.gap > 0.0 {
        true => format!("sewing: widest seam {:.1} mm", p.gap * 1e3),
        false => format!("draping: moves {speed:.0} mm/s, at rest below {rest:.0} mm/s"),
    };
    cx.progress(p.time / time.longest, format!("{doing}; {:.2} s of at most {} s", p.time, time.longest));
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
        held: Held::default(),
    };
    garment
}
