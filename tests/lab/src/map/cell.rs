//! One cell of a map: one solver, one sheet, one time step.

use super::Options;
use super::hung::{Hung, SIDE, farthest};
use super::scheme::{Cloth, Scheme};
use serde::Serialize;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};
use toile_cloth::energy::Vec3;
use toile_cloth::error::ClothError;
use toile_cloth::scene::Scene;
use toile_cloth::solver::{Solver, State};
use toile_cloth::statics::drive::solve::{StaticEquilibrium, StaticsError};

/// Force that implicit steps may leave, in weights of the sheet.
const TOLERANCE: f64 = 1e-6;
/// An answer farther than this from the right one is wrong, in lengths of the sheet.
pub const OFF: f64 = 0.01;
/// Cloth faster than this at the end is not at rest, in sides of the sheet a second.
const SLOW: f64 = 0.1;
/// Part of the time at whose end the speed is taken.
const LAST: f64 = 0.1;
/// Cloth farther away than this has blown up, in sides of the sheet.
const BLOWN: f64 = 100.0;
/// A long time step still gets so many steps.
const LEAST_STEPS: f64 = 40.0;
/// The clock ends a cell after so many times its nominal time: Newton's method may need many
/// iterations.
const PATIENCE: f64 = 10.0;

/// How a cell ended.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "outcome")]
pub enum Outcome {
    /// At rest, within [`OFF`] of the right place.
    Converges,
    /// At rest in a wrong place.
    Off,
    /// Still moving at the end, or flown away.
    Drifts,
    /// Refused by a typed error.
    Refused {
        /// The error's name, as in `ClothError`.
        error_name: String,
        /// Its text.
        error_text: String,
    },
    /// Not run, or ended by the clock: it takes more time than a cell may.
    TooLong,
}

/// A cell; SI units but for the error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cell {
    /// The solver.
    pub scheme: Scheme,
    /// Edges along the side.
    pub along: usize,
    /// Mean edge length, m.
    pub edge: f64,
    /// Stretch stiffness, N/m.
    pub stiffness: f64,
    /// Time step, s; none for solvers without.
    pub dt: Option<f64>,
    /// 2/omega_max of the sheet, s: the limit of explicit steps.
    pub limit: f64,
    /// How it ended.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Greatest distance from the converged answer, in lengths of the sheet; none where nothing
    /// came out.
    pub error: Option<f64>,
    /// Greatest speed in the last tenth of the time, m/s.
    pub speed: Option<f64>,
    /// Time steps, or Newton steps of a solver without.
    pub steps: usize,
    /// Processor time, s.
    pub seconds: f64,
}

/// What a run gave: how it ended, steps, the last state and its speed.
struct Ran {
    outcome: Outcome,
    steps: usize,
    error: Option<f64>,
    speed: Option<f64>,
}

/// Runs a cell; none if it was stopped.
pub(super) fn run(scheme: Scheme, hung: &Hung, dt: Option<f64>, options: &Options) -> Option<Cell> {
    let start = (options.clock)();
    let ran = match dt {
        Some(dt) => in_time(scheme, hung, dt, options)?,
        None => to_rest(hung, options)?,
    };
    Some(Cell {
        scheme,
        along: hung.along,
        edge: hung.edge(),
        stiffness: hung.stiffness,
        dt,
        limit: hung.limit,
        outcome: ran.outcome,
        error: ran.error,
        speed: ran.speed,
        steps: ran.steps,
        seconds: (options.clock)() - start,
    })
}

fn in_time(scheme: Scheme, hung: &Hung, dt: f64, options: &Options) -> Option<Ran> {
    let steps = (hung.time / dt).max(LEAST_STEPS).ceil();
    let nominal = steps * hung.sheet.triangles().len() as f64 * scheme.price();
    if nominal > options.longest && !is_refused(scheme, hung, dt) {
        return Some(Ran::without_state(Outcome::TooLong, 0));
    }
    let cloth = Cloth { sheet: &hung.sheet, fabric: &hung.fabric, model: &hung.model };
    match scheme.solver(&cloth, dt, TOLERANCE * hung.weight()) {
        Ok(Some(mut solver)) => stepped(&mut *solver, hung, steps as usize, options),
        Ok(None) => to_rest(hung, options),
        Err(e) => Some(Ran::refused(&e, 0)),
    }
}

/// Whether the first step will be refused, so that the cell costs nothing.
fn is_refused(scheme: Scheme, hung: &Hung, dt: f64) -> bool {
    scheme == Scheme::Explicit && dt >= hung.limit
}

fn stepped(solver: &mut dyn Solver, hung: &Hung, steps: usize, options: &Options) -> Option<Ran> {
    let clock = Instant::now();
    let mut state = State::at_rest(hung.start.clone());
    let look = steps - ((steps as f64 * LAST).ceil() as usize).min(steps);
    let mut before = (state.x.clone(), state.time);
    for k in 0..steps {
        if k == look {
            before = (state.x.clone(), state.time);
        }
        if (options.stop)() {
            return None;
        }
        if let Err(e) = solver.advance(&hung.model, &mut state) {
            return Some(Ran::ended_by(&e, k + 1));
        }
        if farthest(&state.x, &hung.answer) > BLOWN * SIDE {
            return Some(Ran::without_state(Outcome::Drifts, k + 1));
        }
        if clock.elapsed().as_secs_f64() > PATIENCE * options.longest {
            return Some(Ran::without_state(Outcome::TooLong, k + 1));
        }
    }
    let speed = farthest(&state.x, &before.0) / (state.time - before.1);
    Some(Ran::judged(hung, &state.x, steps, Some(speed)))
}

fn to_rest(hung: &Hung, options: &Options) -> Option<Ran> {
    let mut steps = 0;
    let rest = StaticEquilibrium {
        budget: Duration::from_secs_f64(PATIENCE * options.longest),
        ..StaticEquilibrium::default()
    };
    let solved = rest.solve(&scene(hung), &mut |_, _| {
        steps += 1;
        if (options.stop)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    Some(match solved {
        Ok(state) => Ran::judged(hung, &state.positions, steps, None),
        Err(StaticsError::NotAtRest { state, .. }) => {
            let error = Some(hung.error(&state.positions));
            Ran { outcome: Outcome::Drifts, steps, error, speed: Some(state.outcome.speed) }
        }
        Err(StaticsError::Timeout { .. }) => Ran::without_state(Outcome::TooLong, steps),
        Err(StaticsError::Stopped) => return None,
        Err(e) => Ran::refused(&e, steps),
    })
}

/// The sheet as a scene without body and without self-contact.
fn scene(hung: &Hung) -> Scene {
    hung.mesh.scene(&hung.fabric, &hung.model, &hung.start)
}

impl Ran {
    fn without_state(outcome: Outcome, steps: usize) -> Self {
        Self { outcome, steps, error: None, speed: None }
    }

    fn refused(error: &(impl std::fmt::Debug + std::fmt::Display), steps: usize) -> Self {
        let (error_name, error_text) = (name_of(error), error.to_string());
        Self::without_state(Outcome::Refused { error_name, error_text }, steps)
    }

    /// A blow-up gives an error as well, but is no refusal.
    fn ended_by(error: &ClothError, steps: usize) -> Self {
        match error {
            ClothError::Diverged { .. } => Self::without_state(Outcome::Drifts, steps),
            _ => Self::refused(error, steps),
        }
    }

    fn judged(hung: &Hung, x: &[Vec3], steps: usize, speed: Option<f64>) -> Self {
        let error = hung.error(x);
        let outcome = match speed.is_some_and(|s| s >= SLOW * SIDE) {
            true => Outcome::Drifts,
            false if error <= OFF => Outcome::Converges,
            false => Outcome::Off,
        };
        Self { outcome, steps, error: Some(error), speed }
    }
}

/// The name of the variant, that of the inner error where one is wrapped.
fn name_of(error: &impl std::fmt::Debug) -> String {
    let text = format!("{error:?}");
    let names: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let wrapped = matches!(names.first(), Some(&("Cloth" | "Scene")));
    names.get(usize::from(wrapped)).map_or_else(String::new, |n| (*n).to_owned())
}

impl Outcome {
    /// One word.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Converges => "converges",
            Self::Off => "off",
            Self::Drifts => "drifts",
            Self::Refused { .. } => "refused",
            Self::TooLong => "too long",
        }
    }
}
