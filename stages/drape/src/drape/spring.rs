//! `SpringDraper`: lets the sewn garment hang.
//!
//! Method: the engine's motion by central differences with springs along the mesh edges [improved
//! spring-mass model 2003]: gravity, springs, contacts with body and cloth, and Provot's correction
//! of over-stretched edges. Cost: steps times triangles. Limits: explicit steps, so stiff fabrics
//! are softened to `stiffest`; the error in strain is the weight below a point over that stiffness,
//! under 1 % for a garment.

use super::by_place;
use super::motion::{Course, InTime, SewThrough, drape};
use super::soften::{damping, easy_strain, softened, springs};
use super::spring_sewing::SewingFor;
use crate::engine::Motions;
use toile_cloth::motion::{Calming, Method, Motion};
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Known, Node};

/// Lets the sewn garment hang and fold under its weight until it is at rest.
///
/// Gravity, the cloth's springs and contacts act, edges longer than `max_strain` allows are
/// shortened after every step, and cloth is kept off itself. Damping grows with time, so that folds
/// form freely first and swinging dies out then. The stage ends when the energy no longer changes
/// and every vertex is slow, or at its time limit with a warning. Cloth that falls past the body is
/// an error.
#[stage(
    role = Draper,
    version = 5,
    source = "improved spring-mass model, 2003; Provot, 1995",
    example = "SpringDraper(max_strain: 0.02)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct SpringDraper {
    /// Downward acceleration.
    #[param(default = 9.81, min = 0.0, max = 100.0, unit = "m/s2")]
    pub gravity: f64,
    /// Edges longer than their flat length by more than this share are shortened; a knit may
    /// stretch by as much as 50 N/m stretch it.
    #[param(default = 0.02, min = 0.001, max = 1.0)]
    pub max_strain: f64,
    /// Tensile curves are cut at this slope: the stiffest spring decides the time step. The weight
    /// of a shirt's front, about 6 N on a metre of shoulder, stretches it by 6/`stiffest`.
    #[param(default = 1500.0, min = 10.0, max = 1e6, unit = "N/m", trades)]
    pub stiffest: f64,
    /// Damping in the beginning, on top of the fabric's.
    #[param(default = 2.0, min = 0.0, max = 1000.0, unit = "1/s")]
    pub damping: f64,
    /// Simulated time after which damping doubles, and again, up to 120 1/s.
    #[param(default = 0.2, min = 0.01, max = 100.0, unit = "s", trades)]
    pub settle_time: f64,
    /// Simulated time over which friction grows to its full value, so that cloth slips into
    /// place as a wearer shakes it.
    #[param(default = 0.3, min = 0.0, max = 100.0, unit = "s")]
    pub slip_time: f64,
    /// Time between two looks at contacts.
    #[param(default = 0.004, min = 1e-6, max = 0.1, unit = "s", trades, finer = "less")]
    pub dt: f64,
    /// Shortest step: vertices that are too light for it get more inertia, and no more weight.
    /// Shorter is truer to the motion; the state of rest does not depend on it.
    #[param(default = 2e-4, min = 1e-7, max = 0.01, unit = "s", trades, finer = "less")]
    pub least_step: f64,
    /// At rest, no vertex is faster, by its way in a sixtieth of a second.
    #[param(default = 0.02, min = 1e-9, max = 10.0, unit = "m/s", trades, finer = "less")]
    pub speed: f64,
    /// Simulated time after which the drape stops as it is.
    #[param(default = 3.0, min = 0.01, max = 100.0, unit = "s", trades)]
    pub time_limit: f64,
    /// How seams close that are open yet.
    #[param(flatten)]
    pub sewn: SewThrough,
    /// Time between two frames that are recorded, none at 0; `Frames` behind it asks for its own.
    #[param(default = 0.0, min = 0.0, max = 100.0, unit = "s")]
    pub frames: f64,
}

#[stage]
impl SpringDraper {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        garment.check_solvable()?;
        let sewing = SewingFor { longest: "time_limit", wall: None, has_stiffest: false };
        let garment =
            &*self.sewn.sewn_first(garment, collider, (self.time_limit, self.frames), &sewing, cx)?;
        let time = InTime {
            gravity: self.gravity,
            dt: self.dt,
            drag: self.damping + damping(garment),
            speed: self.speed,
            longest: self.time_limit,
            frames: self.frames,
            ..InTime::default()
        };
        let motion = Motion {
            calming: Calming { doubling: self.settle_time, slip: self.slip_time },
            strain_limit: Some(self.max_strain.max(easy_strain(garment))),
            ..time.motion(Method::CentralDifferences { least: self.least_step }, springs())
        };
        let can = Motions {
            longest: ("time_limit", self.time_limit),
            closing: motion.closing,
            time_limit: None,
            stiffest: Some(self.stiffest),
        };
        let course = Course { time: &time, motion, can };
        drape(&course, &softened(garment, self.stiffest), garment, collider, None, cx)
    }

    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        by_place::in_time(nodes, index)
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        by_place::in_time_rule(known)
    }
}
