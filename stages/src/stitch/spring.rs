//! `SpringStitcher`: sews panels with springs.
//!
//! Method: masses and springs of the cloth engine, seam springs, damping and contacts, stepped by
//! central differences with an adaptive step [Fan et al. 1999; improved model 2003]; pairs nearer
//! than the sewing distance are joined. Gravity does not act until every pair is joined.
//! Cost: steps times triangles: about 0.1 ms a step for 4,000 triangles.
//! Limits: seams that make no progress pull harder, up to [`HARDEST`] times, and are then
//! reported; nothing is torn or pulled through the body.

use crate::cloth::{CentralDifferences, Rest, SeamPull, Settings, Simulation, Softening, check_garment};
use crate::engine::only_joins;
use nalgebra::Vector3;
use toile_core::prelude::*;

/// Sews the panels of a garment together with spring forces.
///
/// Paired points of the seams pull each other while the cloth's own springs, damping and contacts
/// act; gravity waits until the sewing is done, or the cloth would fall. Two points nearer than
/// `seam_distance` become one with their momentum kept. Gathered seams are sewn the same way. The
/// stage ends when all seams are closed and the energy no longer changes; a seam that cannot
/// close is an error that names it.
#[stage(
    role = Stitcher,
    version = 2,
    source = "Fan, Zhou, Wang, Yuen, 1999; improved spring-mass model, 2003",
    example = "SpringStitcher(seam_distance: \"1 mm\")",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct SpringStitcher {
    /// Two points of a seam nearer than this are joined.
    #[param(default = Length::mm(1.0), min = 1e-5, max = 0.02)]
    pub seam_distance: Length,
    /// Pull of a seam for each metre of gap and each metre of seam.
    #[param(default = 5000.0, min = 1.0, max = 1e6, unit = "N/m2")]
    pub seam_stiffness: f64,
    /// Greatest pull of a seam for each metre of it, as of a hand that draws it together.
    #[param(default = 3.0, min = 0.01, max = 100.0, unit = "N/m")]
    pub seam_tension: f64,
    /// Damping of all motion while sewing, on top of the fabric's.
    #[param(default = 20.0, min = 0.0, max = 1000.0, unit = "1/s")]
    pub damping: f64,
    /// Share of the collider's friction that acts while sewing: hands smooth the cloth as they sew.
    #[param(default = 0.1, min = 0.0, max = 1.0)]
    pub friction: f64,
    /// Tensile curves are cut at this slope: the stiffest spring decides the time step, and sewing
    /// needs no stiffer cloth.
    #[param(default = 500.0, min = 10.0, max = 1e6, unit = "N/m", trades)]
    pub stiffest: f64,
    /// The sewn garment is at rest when its energy changes by less than this in 20 ms.
    #[param(default = 1e-4, min = 0.0, max = 1.0, unit = "J", trades, finer = "less")]
    pub tolerance: f64,
    /// Simulated time after which sewing stops as it is, in seconds.
    #[param(default = 4.0, min = 0.01, max = 100.0, unit = "s", trades)]
    pub time_limit: f64,
    /// Steps after which sewing stops as it is.
    #[param(default = 200000, min = 1, max = 100_000_000, unit = "steps", trades)]
    pub max_steps: usize,
    /// A start with a vertex deeper in the body than this is refused; shallower ones are moved out.
    #[param(default = Length::cm(4.0), min = 0.0, max = 1.0)]
    pub deepest_start: Length,
}

/// Seams that make no progress pull harder, up to this many times the tension.
const HARDEST: f64 = 64.0;
/// Steps between two looks for pairs to join.
const JOIN_EVERY: usize = 32;
/// Steps between two checks of the stop flag: well under 50 ms for any garment in reach.
const CHECK_EVERY: usize = 8;
/// Spans of 20 ms without progress after which seams pull harder.
const PATIENCE: usize = 4;
/// Progress is a gap sum smaller by this share.
const PROGRESS: f64 = 0.02;
/// Share of the cloth's thickness that acts while sewing: layers pressed together beside a seam
/// would hold it open by their full thickness.
const SELF_THICKNESS: f64 = 0.3;
/// Damping of a closing gap, N s/m2: keeps the last millimetres from ringing.
const SEAM_DAMPING: f64 = 0.2;
/// Simulated time that a sewn garment gets to come to rest, seconds; the drape goes on from there.
const SETTLE: f64 = 0.1;

#[stage]
impl SpringStitcher {
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
        check_start(garment, scheme, self.deepest_start.metres())?;
        let mut sewing = Sewing::new(self, garment, scheme);
        sewing.close(cx)?;
        let converged = sewing.settle(cx)?;
        cx.figure("sewing_time", sewing.simulation.time, "s");
        cx.figure("self_searches", sewing.simulation.searches() as f64, "");
        Ok(sewing.simulation.finish(converged))
    }
}

/// Refuses a start deep inside the body, from which the nearest skin may be the wrong side.
fn check_start(garment: &Garment, scheme: Option<&dyn Collide>, deepest: f64) -> Result<(), StageError> {
    let Some(scheme) = scheme else { return Ok(()) };
    let mut found = Vec::new();
    scheme.body_contacts(&garment.positions, 0.0, &mut found);
    let deep: Vec<f64> = found.iter().map(|c| -c.distance).filter(|d| *d > deepest).collect();
    let worst = deep.iter().copied().fold(0.0, f64::max);
    match deep.len() {
        0 => Ok(()),
        n => Err(StageError::invalid(format!(
            "{n} vertices start deep inside the body, the deepest by {:.0} mm",
            worst * 1e3
        ))
        .hint("place the panels farther from the body, or give them more ease")),
    }
}

/// A garment that is being sewn.
struct Sewing<'a> {
    stage: &'a SpringStitcher,
    simulation: Simulation<'a>,
    rest: Rest,
    harder: f64,
    best: f64,
    waited: usize,
    first_gap: f64,
}

impl<'a> Sewing<'a> {
    fn new(stage: &'a SpringStitcher, garment: &Garment, scheme: Option<&'a dyn Collide>) -> Self {
        let settings = Settings {
            gravity: Vector3::zeros(),
            damping: stage.damping,
            softening: Softening { steepest: stage.stiffest },
            max_strain: None,
            friction: stage.friction,
            self_thickness: SELF_THICKNESS,
            pull: Some(stage.pull(1.0)),
        };
        let simulation = Simulation::new(garment, scheme, Box::<CentralDifferences>::default(), settings);
        let first_gap = simulation.seams.gap_max(&simulation.state.x);
        Sewing {
            stage,
            simulation,
            rest: Rest::default(),
            harder: 1.0,
            best: f64::INFINITY,
            waited: 0,
            first_gap,
        }
    }

    /// Until every pair is joined.
    fn close(&mut self, cx: &Context) -> Result<(), StageError> {
        self.simulation.join(self.stage.seam_distance.metres());
        while !self.simulation.seams.all_closed() {
            self.step(cx)?;
            if self.simulation.steps.is_multiple_of(JOIN_EVERY) {
                self.simulation.join(self.stage.seam_distance.metres());
            }
            if self.rest.look(&self.simulation) {
                self.tell(cx);
                self.watch_progress()?;
            }
        }
        Ok(())
    }

    /// Until the sewn garment's energy no longer changes; true where it came to that.
    fn settle(&mut self, cx: &Context) -> Result<bool, StageError> {
        self.simulation.settings.pull = None;
        self.simulation.retune();
        self.rest.restart();
        let end = self.simulation.time + SETTLE;
        while self.simulation.time < end && self.simulation.steps < self.stage.max_steps {
            self.step(cx)?;
            if self.rest.look(&self.simulation) {
                self.tell(cx);
                if self.rest.change().is_some_and(|c| c < self.stage.tolerance) {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    fn step(&mut self, cx: &Context) -> Result<(), StageError> {
        if self.simulation.steps.is_multiple_of(CHECK_EVERY) {
            cx.check()?;
        }
        self.simulation.step()
    }

    fn tell(&self, cx: &Context) {
        let gap = self.simulation.seams.gap_max(&self.simulation.state.x);
        let share = 1.0 - gap / self.first_gap.max(1e-9);
        cx.progress(share, progress_text(gap, &self.rest, self.stage.tolerance));
    }

    /// Pulls harder where no seam has moved for a while; gives up when that does not help.
    fn watch_progress(&mut self) -> Result<(), StageError> {
        let left = self.simulation.seams.gap_sum(&self.simulation.state.x);
        if left < self.best * (1.0 - PROGRESS) {
            (self.best, self.waited) = (left, 0);
        } else {
            self.waited += 1;
        }
        let over =
            self.simulation.time > self.stage.time_limit || self.simulation.steps >= self.stage.max_steps;
        if over || (self.waited > PATIENCE && self.harder >= HARDEST) {
            return Err(self.stuck(over));
        }
        if self.waited > PATIENCE {
            self.harder *= 2.0;
            (self.waited, self.best) = (0, left);
            self.simulation.settings.pull = Some(self.stage.pull(self.harder));
            self.simulation.retune();
        }
        Ok(())
    }

    fn stuck(&self, over: bool) -> StageError {
        let (name, gap) = self.widest();
        let gap = gap * 1e3;
        let text = match over {
            true => format!("seam \"{name}\" is still open by {gap:.1} mm at the limit of time or steps"),
            false => format!("seam \"{name}\" cannot be closed: it is stuck at a gap of {gap:.1} mm"),
        };
        StageError::new(ErrorCode::StitchingError, text)
            .hint("see that both panels start near the body, each on its own side, and that their edges fit")
    }

    /// The seam with the widest gap, and the gap.
    fn widest(&self) -> (String, f64) {
        let (garment, cloth, x) =
            (&self.simulation.garment, &self.simulation.cloth, &self.simulation.state.x);
        let at = |i: u32| x[cloth.node_of[i as usize] as usize];
        let gap = |s: &GarmentSeam| s.pairs.iter().map(|p| (at(p[0]) - at(p[1])).norm()).fold(0.0, f64::max);
        let wider = |best: (String, f64), s: &GarmentSeam| {
            let g = gap(s);
            if g > best.1 { (s.name.clone(), g) } else { best }
        };
        garment.seams.iter().fold((String::new(), 0.0), wider)
    }
}

impl SpringStitcher {
    fn pull(&self, harder: f64) -> SeamPull {
        let (stiffness, tension) = (self.seam_stiffness * harder, self.seam_tension * harder);
        SeamPull { stiffness, tension, damping: SEAM_DAMPING }
    }
}

/// `seam gap 3.2 mm, energy 0.41 J, about 2 s to rest`.
fn progress_text(gap: f64, rest: &Rest, tolerance: f64) -> String {
    let left = rest.time_left(tolerance).map_or(String::new(), |t| format!(", about {t:.1} s to rest"));
    format!("seam gap {:.1} mm, energy {:.3} J{left}", gap * 1e3, rest.energy())
}
