//! `Projective`: sews and drapes in time by local and global turns.
//!
//! Method: implicit Euler with a matrix that never changes. Cost: one factor for all, two triangular solves a turn.
//! Limit: isotropic, converges slowly for stiff cloth and long steps.

use super::motion::{Course, air, drape};
use toile_cloth::motion::Method;
use toile_core::prelude::*;

/// Sews the garment and lets it fall and settle, by projective dynamics.
///
/// Promises that every turn lowers the energy of the step and that a step costs the same always;
/// what `iterations` leave undone shows as cloth too stiff against turning and slow to fall into folds.
/// Warp and weft count as one stiffness.
/// Seams are sewn first, without weight, for as long as they take. In a scene it then follows the scene's
/// phases for their seconds, those before the first with weight less by the time of sewing; else it drapes until rest. Cloth that falls past
/// the body is an error.
#[stage(
    role = Draper,
    version = 5,
    source = "Bouaziz et al. 2014",
    example = "Projective(iterations: 10)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Projective {
    /// Turns in each step.
    #[param(default = 10, min = 1, max = 10_000, unit = "turns", trades, finer = "more")]
    pub iterations: usize,
    /// Downward acceleration; a scene's own phases come before it.
    #[param(default = 9.81, min = 0.0, max = 1000.0, unit = "m/s2")]
    pub gravity: f64,
    /// Time between two looks at contacts.
    #[param(default = 0.004, min = 1e-6, max = 0.1, unit = "s", trades, finer = "less")]
    pub dt: f64,
    /// Drag in proportion to mass, so that swinging dies out; 0 for a true fall.
    #[param(default = 4.0, min = 0.0, max = 1000.0, unit = "1/s")]
    pub drag: f64,
    /// Density of the air, which slows every triangle and carries the wind: 1.2 at 20 degrees; a scene's phases may have their own.
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
}

#[stage]
impl Projective {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        collider: Option<&Collider>,
        phases: Option<&Phases>,
        cx: &Context,
    ) -> Result<Garment, StageError> {
        drape(&self.course(), garment, collider, phases, cx)
    }

    fn course(&self) -> Course {
        Course {
            method: Method::Projective { iterations: self.iterations },
            gravity: self.gravity,
            air: air(self.air, self.air_normal, self.air_tangential, self.wind),
            dt: self.dt,
            drag: self.drag,
            speed: self.speed,
            longest: self.longest,
            join_gap: self.join_gap.metres(),
            time_limit: self.time_limit,
        }
    }
}
