//! Sewing by springs, for `SpringStitcher`, and for solvers that step in time where cloth passes
//! through cloth while its seams close: springs on a coarse mesh do that in seconds, whatever steps
//! the solver makes then.

use super::motion::{Course, InTime, SewThrough, moved};
use super::soften::{damping, softened, springs};
use crate::engine::Motions;
use std::borrow::Cow;
use toile_cloth::motion::{Method, Motion, SeamClosing, Until};
use toile_core::prelude::*;

/// How springs sew.
#[params]
#[derive(Copy)]
pub struct SpringSewing {
    /// Seams are joined when the points of each pair are nearer than this.
    #[param(default = Length::mm(1.0), min = 1e-5, max = 0.02, trades)]
    pub seam_distance: Length,
    /// What brings the two sides of a seam together: the set speed `closing`, as hands would, or
    /// the published force of each pair of points, in proportion to its gap, N/m; the larger it is
    /// the sooner seams close and the more the cloth stretches. Points that have met stay together.
    #[param(default = SeamPull::Speed, min = 1e-6, max = 1e6, unit = "N/m")]
    pub seam_force: SeamPull,
    /// Speed at which the two sides of a seam are brought together.
    #[param(default = 0.5, min = 0.001, max = 100.0, unit = "m/s")]
    pub closing: f64,
    /// Damping of all motion while sewing, on top of the fabric's.
    #[param(default = 20.0, min = 0.0, max = 1000.0, unit = "1/s")]
    pub damping: f64,
    /// Share of the friction that acts while sewing: hands smooth the cloth as they sew.
    #[param(default = 0.1, min = 0.0, max = 1.0)]
    pub friction: f64,
    /// Tensile curves are cut at this slope: the stiffest spring decides the time step, and sewing
    /// needs no stiffer cloth.
    #[param(default = 500.0, min = 10.0, max = 1e6, unit = "N/m", trades)]
    pub stiffest: f64,
    /// Time between two looks at contacts.
    #[param(default = 0.004, min = 1e-6, max = 0.1, unit = "s", trades, finer = "less")]
    pub dt: f64,
    /// Shortest step: vertices that are too light for it get more inertia, which changes how the
    /// cloth moves and not where it comes to rest.
    #[param(default = 4e-4, min = 1e-7, max = 0.01, unit = "s", trades, finer = "less")]
    pub least_step: f64,
    /// Longest simulated time for sewing.
    #[param(default = 4.0, min = 0.01, max = 100.0, unit = "s", trades)]
    pub time_limit: f64,
    /// How seams close.
    #[param(flatten)]
    pub sewn: SewThrough,
    /// Time between two frames that are recorded, none at 0; `Frames` behind it asks for its own.
    #[param(default = 0.0, min = 0.0, max = 100.0, unit = "s")]
    pub frames: f64,
}

/// What brings the two sides of a seam together.
#[choice]
#[derive(Copy)]
pub enum SeamPull {
    /// The set speed.
    Speed,
    /// A force in proportion to the gap, N/m.
    Linear(f64),
}

/// The stage for which it sews.
pub(crate) struct SewingFor {
    /// What the longest simulated time is called there.
    pub(crate) longest: &'static str,
    /// Its limit of wall time, s.
    pub(crate) wall: Option<f64>,
    /// Whether `stiffest` can be set there.
    pub(crate) has_stiffest: bool,
}

impl SpringSewing {
    /// Sews the garment for a stage.
    pub(crate) fn sew(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        sewing: &SewingFor,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        garment.check_solvable()?;
        let time = InTime {
            gravity: 0.0,
            dt: self.dt,
            drag: self.damping + damping(garment),
            longest: self.time_limit,
            join_gap: self.seam_distance,
            time_limit: sewing.wall.unwrap_or(InTime::default().time_limit),
            frames: self.frames,
            ..InTime::default()
        };
        let motion = Motion {
            seam_force: match self.seam_force {
                SeamPull::Speed => SeamClosing::Speed,
                SeamPull::Linear(stiffness) => SeamClosing::Linear(stiffness),
            },
            through: self.sewn.engine(),
            closing: self.closing,
            sewing_friction: self.friction,
            until: Until::Sewn { longest: self.time_limit },
            ..time.motion(Method::CentralDifferences { least: self.least_step }, springs())
        };
        let can = Motions {
            longest: (sewing.longest, self.time_limit),
            closing: motion.closing,
            time_limit: sewing.wall,
            stiffest: sewing.has_stiffest.then_some(self.stiffest),
        };
        let course = Course { time: &time, motion, can };
        moved(&course, &softened(garment, self.stiffest), garment, collider, None, cx)
    }
}

impl InTime {
    /// The garment with its seams closed, where they are open and cloth is to pass through cloth
    /// meanwhile; else as it is.
    pub(super) fn sewn_first<'a>(
        &self,
        garment: &'a Garment,
        collider: Option<&Collider>,
        cx: &Context,
    ) -> Result<Cow<'a, Garment>, StageError> {
        let sewing = SewingFor { longest: "longest", wall: Some(self.time_limit), has_stiffest: false };
        self.sewn.sewn_first(garment, collider, (self.longest, self.frames), &sewing, cx)
    }
}

impl SewThrough {
    /// The same, sewn for at most so long, s, with a frame every so many seconds.
    pub(super) fn sewn_first<'a>(
        &self,
        garment: &'a Garment,
        collider: Option<&Collider>,
        (time_limit, frames): (f64, f64),
        sewing: &SewingFor,
        cx: &Context,
    ) -> Result<Cow<'a, Garment>, StageError> {
        let is_open = garment.seams.iter().any(|s| s.state == SeamState::Open);
        if !self.sew_through || !is_open {
            return Ok(Cow::Borrowed(garment));
        }
        let springs = SpringSewing { sewn: *self, time_limit, frames, ..SpringSewing::default() };
        springs.sew(garment, collider, sewing, cx).map(Cow::Owned)
    }
}
