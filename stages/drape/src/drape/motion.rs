//! What the stages that drape in time have in common: from garment to scene, through the motion,
//! and back.

use super::again::thin_of;
use super::frames;
use crate::engine::{
    self, MessageContext, Motions, SceneSetting, SchemeSurface, carries_out, scene_of, weld_seams,
};
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::time::Duration;
use toile_cloth::contact::collision_surface::CollisionSurface;
use toile_cloth::energy::{Air as EngineAir, Models};
use toile_cloth::motion::{
    Method, Motion, MotionError, Moved, PenaltyForce, Progress, Response, Through, Until,
};
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
    /// How seams close.
    #[param(flatten)]
    pub sewn: SewThrough,
    /// Wall time after which it gives up. A run that meets it is not repeatable.
    #[param(default = 600.0, min = 0.001, max = 1e6, unit = "s", trades)]
    pub time_limit: f64,
    /// Time between two frames that are recorded, none at 0; `Frames` behind it asks for its own.
    #[param(default = 0.0, min = 0.0, max = 100.0, unit = "s")]
    pub frames: f64,
}

/// How the stages that step in time sew pieces that start far apart.
#[params]
#[derive(Copy)]
pub struct SewThrough {
    /// Whether cloth passes through cloth while its seams close: for panels that start far apart,
    /// with others in between, or in the body. The seams close on a coarse mesh, which is taken out
    /// of itself along the contours where it crosses (Volino, Magnenat-Thalmann 2006) and carried
    /// to the finer ones. Where the body keeps seams open or comes through the cloth, the garment
    /// is sewn again around a thin figure of the body's pose, which grows; a note says so. Left
    /// out, it is true behind a placement of a pattern, such as `Arrange`.
    #[param(default = false, way)]
    pub sew_through: bool,
    /// Points of the coarsest mesh, on which seams close with `sew_through`; more than the garment
    /// has for its own mesh alone.
    #[param(default = 1500, min = 20, max = 10_000_000, unit = "vertices", trades)]
    pub coarsest: usize,
}

impl SewThrough {
    /// The same for the engine.
    pub(crate) fn engine(&self) -> Option<Through> {
        self.sew_through.then_some(Through { coarsest: self.coarsest })
    }
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
    let bands = course.motion.method.takes_bands();
    garment.seams.iter().try_for_each(|s| carries_out(s.kind, &s.name, bands))?;
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
    let response = card.map_or(Response::default(), response);
    let motion = Motion { until, response, ..course.motion };
    let cancel = cx.cancel().clone();
    let stopper = Stopper::when(move || cancel.is_cancelled());
    let begun = frames::recorder(time.frames, garment, cx)?;
    let mut recorder = None;
    let mut tell = |p: &Progress, positions: &dyn Fn() -> Vec<Vector3<f64>>| {
        cx.moves(|| points(&positions()));
        tell(p, time, cx)
    };
    let moved = sewn_twice(collider.filter(|_| motion.through.is_some()), cx, |around| {
        recorder = begun.clone();
        motion.run_around(&scene, engine_collider, around, &stopper, &mut tell, recorder.as_mut())
    });
    cx.check()?;
    if recorder.as_ref().is_some_and(|r| r.is_full) {
        return Err(frames::full(time.frames));
    }
    if let Some(positions) = moved.as_ref().err().and_then(MotionError::so_far) {
        cx.so_far(at(garment, positions));
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

/// How a body with this collider answers cloth that touches it.
fn response(card: ColliderCard) -> Response {
    let penalty = card.penalty.map(|penalty| match penalty {
        Penalty::Linear(c) => PenaltyForce::Linear(c),
        Penalty::Exponential(c) => PenaltyForce::Exponential(c),
    });
    Response { restitution: card.restitution, penalty }
}

/// The motion; where the body keeps seams open that could close on a thin figure of it, once more
/// around that.
fn sewn_twice(
    collider: Option<&Collider>,
    cx: &Context,
    mut run: impl FnMut(&[&dyn CollisionSurface]) -> Result<Moved, MotionError>,
) -> Result<Moved, MotionError> {
    let first = run(&[]);
    let is_open = matches!(first, Err(MotionError::SeamNotClosed { .. }));
    let thin = collider.filter(|_| is_open).map(thin_of).unwrap_or_default();
    if thin.is_empty() {
        return first;
    }
    cx.note(
        "the body keeps seams open: the garment is sewn again around a thin figure, which grows to the body",
    );
    let around: Vec<&dyn CollisionSurface> = thin.iter().map(|f| f as &dyn CollisionSurface).collect();
    run(&around).or(first)
}

/// Positions of the engine as the garment has them.
pub(super) fn points(positions: &[Vector3<f64>]) -> Vec<Point3> {
    positions.iter().map(|p| Point3::from(*p)).collect()
}

/// The garment with its vertices at other positions.
fn at(garment: &Garment, positions: &[Vector3<f64>]) -> Garment {
    let mut garment = garment.clone();
    garment.positions = points(positions);
    garment.velocities.fill(Vector3::zeros());
    garment.starts.clear();
    garment
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
    let mut garment = at(garment, &moved.positions);
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
