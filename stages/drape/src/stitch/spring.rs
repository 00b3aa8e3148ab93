//! `SpringStitcher`: sews panels with springs.
//!
//! Method: the engine's motion by central differences (Fan et al. 1999) with springs along the mesh
//! edges for cloth and bending; seams close at a set speed as if by hands, and pairs that have met
//! become one node. Gravity does not act until every pair is joined. Cost: steps times triangles.
//! Limits: stiff fabrics are softened to `stiffest`; a seam that does not come nearer is reported;
//! nothing is torn or pulled through the body.

use crate::drape::{Course, InTime, SewThrough, by_place, damping, moved, softened, springs};
use crate::engine::Motions;
use toile_cloth::motion::{self, Method, Motion, Until};
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Known, Node};

/// Sews the panels of a garment together, cloth taken as springs.
///
/// Paired points of the seams are brought together at `closing` while the cloth's own springs,
/// damping and contacts act; gravity waits until the sewing is done, or the cloth would fall. When
/// all are nearer than `seam_distance` they become one with their momentum kept. Gathered seams are
/// sewn the same way. A seam that cannot close is an error that names it.
#[stage(
    role = Stitcher,
    version = 4,
    source = "Fan, Zhou, Wang, Yuen, 1999; improved spring-mass model, 2003",
    example = "SpringStitcher(seam_distance: \"1 mm\")",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct SpringStitcher {
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

#[stage]
impl SpringStitcher {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        self.sew(garment, collider, &SewingFor { longest: "time_limit", wall: None, has_stiffest: true }, cx)
    }

    /// Sews for a stage.
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
                SeamPull::Speed => motion::SeamClosing::Speed,
                SeamPull::Linear(stiffness) => motion::SeamClosing::Linear(stiffness),
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

    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        by_place::in_time(nodes, index)
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        by_place::in_time_rule(known)
    }
}
