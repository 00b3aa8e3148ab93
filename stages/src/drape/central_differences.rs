//! `CentralDifferences`: sews and drapes in time by explicit steps on finite elements.
//!
//! Method: leapfrog with a step below the limit 2/omega_max, which is computed. Cost: a few flops a vertex and step, but some
//! thousand steps a second. Limit: stiff or fine cloth makes steps tiny.

use super::motion::{Course, air, drape};
use toile_cloth::motion::Method;
use toile_core::prelude::*;

/// Sews the garment and lets it fall and settle, by central differences with an adaptive step.
///
/// Promises motion of second order without damping of its own; the step stays below the stable limit
/// 2/omega_max, which is computed from the stiffness and again as cloth stiffens. `SpringStitcher` and
/// `SpringDraper` do the same with springs.
/// Seams are sewn first, without weight, for as long as they take. In a scene it then follows the scene's
/// phases for their seconds, those before the first with weight less by the time of sewing; else it drapes until rest. Cloth that falls past
/// the body is an error.
#[stage(
    role = Draper,
    version = 5,
    source = "Fan et al. 1999; Desbrun et al. 1999",
    example = "CentralDifferences(drag: 4.0)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct CentralDifferences {
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
impl CentralDifferences {
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
            method: Method::CentralDifferences,
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
