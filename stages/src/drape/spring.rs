//! `SpringDraper`: lets the sewn garment hang.
//!
//! Method: the stitcher's model without seam forces [improved spring-mass model 2003]: gravity,
//! springs, contacts with body and cloth, and Provot's correction of over-stretched edges.
//! Cost: steps times triangles: about 0.1 ms a step for 4,000 triangles, plus searches for cloth
//! near cloth. Limits: explicit steps, so stiff fabrics are softened to `stiffest`; the error in
//! strain is the weight below a point over that stiffness, under 1 % for a garment.

use crate::cloth::{CentralDifferences, Rest, Settings, Simulation, Softening, check_garment};
use crate::engine::{self, FallWatch, only_joins};
use nalgebra::Vector3;
use toile_core::prelude::*;

/// Lets the sewn garment hang and fold under its weight until it is at rest.
///
/// Gravity, the cloth's springs and contacts act, edges longer than `max_strain` allows are
/// shortened after every step, and cloth is kept off itself. Damping grows with time, so that
/// folds form freely first and swinging dies out then. The stage ends when the energy no longer
/// changes and every vertex is slow, or at its time limit with a warning. Cloth that falls past the body
/// is an error, as soon as nothing is left that could catch it.
#[stage(
    role = Draper,
    version = 3,
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
    /// Simulated time after which damping doubles, and again.
    #[param(default = 0.2, min = 0.01, max = 100.0, unit = "s", trades)]
    pub settle_time: f64,
    /// Simulated time over which friction grows to its full value, so that cloth slips into
    /// place as a wearer shakes it.
    #[param(default = 0.3, min = 0.0, max = 100.0, unit = "s")]
    pub slip_time: f64,
    /// At rest, the energy changes by less than this in 20 ms.
    #[param(default = 2e-5, min = 0.0, max = 1.0, unit = "J", trades, finer = "less")]
    pub tolerance: f64,
    /// At rest, no vertex is faster, by its way in 20 ms.
    #[param(default = 0.02, min = 0.0, max = 10.0, unit = "m/s", trades, finer = "less")]
    pub speed: f64,
    /// Simulated time after which the drape stops as it is.
    #[param(default = 3.0, min = 0.01, max = 100.0, unit = "s", trades)]
    pub time_limit: f64,
    /// Steps after which the drape stops as it is.
    #[param(default = 200000, min = 1, max = 100_000_000, unit = "steps", trades)]
    pub max_steps: usize,
}

/// Steps between two checks of the stop flag.
const CHECK_EVERY: usize = 8;
/// Damping grows up to this, 1/s: above, cloth creeps.
const GREATEST_DAMPING: f64 = 120.0;

/// Line force that a worn garment meets where it is tight, N/m: a snug sleeve pulls by about that.
const WORN_FORCE: f64 = 50.0;

/// The strain that the softest fabric of the garment takes on under [`WORN_FORCE`]: a knit may
/// stretch by that, whatever the limit.
fn easy_strain(garment: &Garment) -> f64 {
    let at_force = |curve: &Curve| {
        let mut from = (0.0, 0.0);
        for (i, &to) in curve.0.iter().enumerate() {
            if to.1 >= WORN_FORCE || i + 1 == curve.0.len() {
                return from.0 + (WORN_FORCE - from.1) * (to.0 - from.0) / (to.1 - from.1);
            }
            from = to;
        }
        0.0
    };
    let fabrics = garment.panels.iter().map(|p| &p.fabric);
    fabrics.map(|f| at_force(&f.warp).max(at_force(&f.weft))).fold(0.0, f64::max)
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
        check_garment(garment)?;
        garment.seams.iter().try_for_each(|s| only_joins(s.kind, &s.name))?;
        let scheme = collider.map(|c| c.scheme.as_ref());
        let mut simulation =
            Simulation::new(garment, scheme, Box::<CentralDifferences>::default(), self.settings(garment));
        let mut rest = Rest::default();
        let gravity = simulation.settings.gravity;
        let watch = scheme.and_then(|s| FallWatch::of(garment, s, &gravity));
        let converged = self.fall(&mut simulation, &mut rest, watch.as_ref(), cx)?;
        let speed = rest.drift().unwrap_or_else(|| simulation.max_speed());
        if !converged {
            let (time, change) = (simulation.time, rest.change().unwrap_or(0.0));
            cx.warn(match speed < self.speed {
                true => format!(
                    "the cloth's energy still changes by {change:.1e} J in 20 ms after {time:.1} s of drape, at rest by less than {:.1e} J",
                    self.tolerance
                ),
                false => format!("the cloth still moves by {:.0} mm/s after {time:.1} s of drape", speed * 1e3),
            });
        }
        simulation.lift_off_skin();
        cx.figure("drape_time", simulation.time, "s");
        cx.figure("self_searches", simulation.searches() as f64, "");
        let mut draped = simulation.finish(converged);
        draped.status.max_speed = speed;
        if let Some(scheme) = scheme {
            let kept = engine::on_body(garment, &draped.positions, scheme, &gravity);
            draped.status.on_body = engine::both(&garment.status.on_body, kept);
        }
        Ok(draped)
    }
}

impl SpringDraper {
    fn settings(&self, garment: &Garment) -> Settings {
        Settings {
            gravity: Vector3::new(0.0, -self.gravity, 0.0),
            damping: self.damping,
            softening: Softening { steepest: self.stiffest },
            max_strain: Some(self.max_strain.max(easy_strain(garment))),
            friction: 0.0,
            self_thickness: 1.0,
            pull: None,
        }
    }

    /// Steps until rest or the limits; true where it came to rest.
    fn fall(
        &self,
        simulation: &mut Simulation,
        rest: &mut Rest,
        watch: Option<&FallWatch<'_>>,
        cx: &Context,
    ) -> Result<bool, StageError> {
        while simulation.time < self.time_limit && simulation.steps < self.max_steps {
            if simulation.steps.is_multiple_of(CHECK_EVERY) {
                cx.check()?;
            }
            simulation.step()?;
            if rest.look(simulation) {
                if let Some(error) = watch.and_then(|w| w.look(&places(simulation))) {
                    return Err(error);
                }
                let doublings = simulation.time / self.settle_time;
                simulation.settings.damping =
                    (self.damping * doublings.exp2()).min(GREATEST_DAMPING.max(self.damping));
                simulation.settings.friction = (simulation.time / self.slip_time.max(1e-9)).min(1.0);
                cx.progress(self.share(simulation, rest), progress_text(rest, self.tolerance));
                if self.at_rest(rest) && simulation.settings.friction >= 1.0 {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    fn at_rest(&self, rest: &Rest) -> bool {
        rest.change().is_some_and(|c| c < self.tolerance) && rest.drift().is_some_and(|v| v < self.speed)
    }

    fn share(&self, simulation: &Simulation, rest: &Rest) -> f64 {
        let limit = simulation.time / self.time_limit;
        rest.time_left(self.tolerance)
            .map_or(limit, |left| limit.max(simulation.time / (simulation.time + left)))
    }
}

/// Where every vertex of the garment is.
fn places(simulation: &Simulation<'_>) -> Vec<Vector3<f64>> {
    let at = |&n: &u32| simulation.state.x[n as usize].coords;
    simulation.cloth.node_of.iter().map(at).collect()
}

/// `energy 0.412 J, fastest 31 mm/s, about 0.4 s to rest`.
fn progress_text(rest: &Rest, tolerance: f64) -> String {
    let left = rest.time_left(tolerance).map_or(String::new(), |t| format!(", about {t:.1} s to rest"));
    format!("energy {:.3} J, fastest {:.0} mm/s{left}", rest.energy(), rest.drift().unwrap_or(0.0) * 1e3)
}
