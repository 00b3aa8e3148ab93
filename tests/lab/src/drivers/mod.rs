//! The two drivers of cost that Fan et al. (1999) and the improved spring-mass model of 2003 name:
//! the number of particles and the time step, each against processor time and error, for every
//! solver and for springs beside finite elements.
//!
//! Two scenes with exact references: a hanging strip's slowest swing
//! ([`hanging_swing`](super::reference::hanging_swing)), where the error is that of a motion over
//! one period, and a strip between two supports ([`catenary`](super::reference::catenary())), where
//! it is that of the state of rest. One driver is turned while the other stays: particles at a
//! fixed step, steps at a fixed mesh. Powers are fitted by least squares in the logarithms; a power
//! near 0 says that the other driver holds the error.

mod catenary;
mod fit;
mod show;
mod swing;
mod way;

#[cfg(test)]
mod tests;

pub use fit::{Fit, Power};
pub use way::Way;

use super::Progress;
use fit::fits;
use serde::{Serialize, Serializer};
use std::ops::ControlFlow;
use toile_cloth::error::ClothError;

/// Edges along the strip where the number of particles is varied.
const ALONG: [usize; 6] = [4, 10, 14, 20, 30, 44];
/// Edges along the strip where the time step is varied.
const FIXED_ALONG: usize = 14;
/// The longest time step, s; each following one is half as long.
const LONGEST_STEP: f64 = 0.128;
/// Time steps.
const STEPS: i32 = 8;
/// Runs shorter than this are made three times, and the quickest counts, s.
const SHORT: f64 = 0.2;

/// What is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Scene {
    /// One period of the slowest swing of a hanging strip; error: greatest root mean square
    /// distance over the swing's.
    Swing,
    /// A strip that sags between two supports; error: of its sag, in lengths.
    Catenary,
}

/// What is turned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Driver {
    /// The number of particles, at a fixed time step.
    Particles,
    /// The time step, at a fixed number of particles.
    Step,
}

/// Why a run is not made.
const TOO_LONG: &str = "it would take longer than a run may";

/// How to run.
#[derive(Debug, Clone)]
pub struct Options {
    /// Which solvers; see [`Way::ALL`].
    pub ways: Vec<Way>,
    /// Longest nominal time of a run, s; see [`Scheme::price`](super::map::Scheme::price).
    pub longest: f64,
    /// Seconds of processor time so far.
    pub clock: fn() -> f64,
    /// Asked at every step; a run that is stopped is left out.
    pub stop: fn() -> bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { ways: Way::ALL.to_vec(), longest: 10.0, clock: super::map::wall, stop: || false }
    }
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// What was simulated.
    pub scene: Scene,
    /// What was turned.
    pub driver: Driver,
    /// The solver and its membrane.
    #[serde(serialize_with = "named")]
    pub way: Way,
    /// Vertices.
    pub particles: usize,
    /// Time step, s; none for solvers without.
    pub dt: Option<f64>,
    /// As the scene defines it; none where nothing came out.
    pub error: Option<f64>,
    /// Processor time, s.
    pub seconds: f64,
    /// Why there is no error.
    pub refused: Option<String>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// By scene, driver, solver, then from the coarsest.
    pub rows: Vec<Row>,
    /// The powers of each solver.
    pub fits: Vec<Fit>,
    /// Whether the caller stopped it.
    pub stopped: bool,
}

/// A run to be made.
#[derive(Debug, Clone, Copy)]
struct Run {
    scene: Scene,
    driver: Driver,
    way: Way,
    along: usize,
    dt: Option<f64>,
}

/// Runs everything; `progress` is called before each run and may stop there.
#[must_use]
pub fn drivers(options: &Options, progress: &mut Progress<'_>) -> Report {
    let runs = runs(&options.ways);
    let mut report = Report { rows: vec![], fits: vec![], stopped: false };
    for (k, run) in runs.iter().enumerate() {
        let row = progress(k as f64 / runs.len() as f64, &run.name()).is_continue().then(|| run.row(options));
        match row.flatten() {
            Some(row) => report.rows.push(row),
            None => {
                report.stopped = true;
                break;
            }
        }
    }
    report.fits = fits(&report.rows);
    report
}

fn runs(ways: &[Way]) -> Vec<Run> {
    let mut runs = Vec::new();
    for scene in [Scene::Swing, Scene::Catenary] {
        // What has no time step has no motion.
        let fit = |way: &&Way| scene == Scene::Catenary || way.steps_in_time();
        let with = |driver, along, way: &Way, dt| Run { scene, driver, way: *way, along, dt };
        for way in ways.iter().filter(fit) {
            runs.extend(ALONG.map(|n| with(Driver::Particles, n, way, way.usual_step())));
        }
        for way in ways.iter().filter(fit).filter(|w| w.steps_in_time()) {
            let dt = |k: i32| Some(LONGEST_STEP * 0.5_f64.powi(k));
            runs.extend((0..STEPS).map(|k| with(Driver::Step, FIXED_ALONG, way, dt(k))));
        }
    }
    runs
}

/// What a run gives: its error, or why there is none; nothing at all if it was stopped.
type Ran = Option<Result<f64, String>>;

impl Run {
    fn name(&self) -> String {
        let dt = self.dt.map_or(String::new(), |dt| format!(", step {dt} s"));
        format!("{:?}, {}, {} edges along{dt}", self.scene, self.way.name(), self.along)
    }

    /// Runs it, short ones three times; none if it was stopped.
    fn row(&self, options: &Options) -> Option<Row> {
        let mut best = self.timed(options)?;
        for _ in 0..2 {
            if best.1 >= SHORT || best.0.is_err() {
                break;
            }
            let again = self.timed(options)?;
            best.1 = best.1.min(again.1);
        }
        let (ran, seconds, particles) = best;
        let (error, refused) = match ran {
            Ok(error) => (Some(error), None),
            Err(why) => (None, Some(why)),
        };
        let Self { scene, driver, way, dt, .. } = *self;
        Some(Row { scene, driver, way, particles, dt, error, seconds, refused })
    }

    fn timed(&self, options: &Options) -> Option<(Result<f64, String>, f64, usize)> {
        match self.scene {
            Scene::Swing => timed(swing::Problem::new(self.way, self.along), self, options),
            Scene::Catenary => timed(catenary::Problem::new(self.way, self.along), self, options),
        }
    }
}

/// A scene that is set up: its making does not count.
trait Solve {
    fn particles(&self) -> usize;
    fn solve(&self, run: &Run, options: &Options) -> Ran;
}

fn timed(
    problem: Result<impl Solve, ClothError>,
    run: &Run,
    options: &Options,
) -> Option<(Result<f64, String>, f64, usize)> {
    let problem = match problem {
        Ok(problem) => problem,
        Err(e) => return Some((Err(e.to_string()), 0.0, 0)),
    };
    let start = (options.clock)();
    let ran = problem.solve(run, options)?;
    Some((ran, (options.clock)() - start, problem.particles()))
}

fn named<S: Serializer>(way: &Way, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&way.name())
}

/// Breaks where a run is to be stopped.
fn go_on(options: &Options) -> ControlFlow<()> {
    if (options.stop)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
