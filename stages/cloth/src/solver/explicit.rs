//! Central differences with an adaptive step (Fan et al., 1999; step control after Desbrun), in the
//! leapfrog form that keeps its second order when the step changes:
//! `v' = ((1 - c dt/2) v + dt f/m) / (1 + c dt/2)`, `x' = x + dt v'`.
//!
//! Undamped and of second order, a few flops per vertex and step. Unstable above `2/omega_max`,
//! which is computed (not guessed) from the stiffness matrix and again as the sheet stiffens; a
//! fixed step above it is refused. Stiffness-proportional damping lowers the limit to
//! `(2/w)(sqrt(1 + z²) - z)`, `z = viscosity w / 2`. Obstacles act on velocities, with Coulomb
//! friction that really sticks.
//!
//! Few light vertices set the step of all. Where only the state of rest matters, a least step may
//! be asked for: vertices that do not allow it get more inertia, and no more weight (mass scaling,
//! Belytschko, Liu, Moran 2000, section 6.2.4). By Gershgorin's theorem no frequency is above
//! `sqrt(max_i sum_j |K_ij| / m_i)`, so the inertia that each needs is known.

use super::spectrum::omega_max_of;
use super::{Model, Report, Solver, State};
use crate::energy::{Projection, Vec3, carried, mobility};
use crate::error::{ClothError, check_parameter};
use crate::linear::BlockMatrix;

/// The step is this share of the limit: headroom for stiffening until the next look.
const SAFETY: f64 = 0.9;
/// Steps between looks at the greatest frequency.
const STEPS_PER_LOOK: usize = 200;

/// How the step is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Adaptive { longest: f64, least: f64 },
    Fixed(f64),
    Unguarded(f64),
}

/// The solver.
pub struct CentralDifferences {
    step: Step,
    limit: f64,
    since_look: usize,
    last_dt: f64,
}

impl CentralDifferences {
    /// As long a step as is safe, but no longer than `longest` (s).
    #[must_use]
    pub fn adaptive(longest: f64) -> Self {
        Self::bounded(longest, 0.0)
    }

    /// As long a step as is safe, but no longer than `longest` (s), of a model whose inertia allows
    /// `least` at any strain (see [`CentralDifferences::inertia`]).
    #[must_use]
    pub fn bounded(longest: f64, least: f64) -> Self {
        Self::stepping(Step::Adaptive { longest, least })
    }

    /// Always this step (s); refused if it is unstable.
    #[must_use]
    pub fn fixed(dt: f64) -> Self {
        Self::stepping(Step::Fixed(dt))
    }

    /// Always this step (s), stable or not, to show where motion diverges.
    #[must_use]
    pub fn unguarded(dt: f64) -> Self {
        Self { since_look: 0, ..Self::stepping(Step::Unguarded(dt)) }
    }

    fn stepping(step: Step) -> Self {
        Self { step, limit: 0.0, since_look: STEPS_PER_LOOK, last_dt: 0.0 }
    }

    /// The largest stable step at a state, s.
    #[must_use]
    pub fn limit(model: &Model, x: &[Vec3]) -> f64 {
        let stiffness = model.stiffness(x, Projection::PositiveSemiDefinite);
        limit_of(model, &stiffness)
    }

    /// The limit as it was found at the last look, which is now if that is long ago.
    fn look(&mut self, model: &Model, x: &[Vec3]) -> f64 {
        let least = self.least();
        if least > 0.0 && self.limit == 0.0 {
            // The bound holds for all strains, so that one look is enough.
            self.limit = limit_of(model, &model.stiffness(x, Projection::Bound));
        } else if least == 0.0 && self.since_look > STEPS_PER_LOOK {
            (self.limit, self.since_look) = (Self::limit(model, x), 1);
        }
        self.limit
    }

    /// The shortest step, s; 0 where there is none.
    fn least(&self) -> f64 {
        if let Step::Adaptive { least, .. } = self.step { least } else { 0.0 }
    }

    /// The inertia of each vertex with which steps of `least` (s) are stable at any strain, kg: no
    /// less than its mass.
    #[must_use]
    pub fn inertia(model: &Model, x: &[Vec3], least: f64) -> Vec<f64> {
        let greatest = highest(least / SAFETY, model.viscosity);
        let sums = model.stiffness(x, Projection::Bound).row_sums();
        model.masses.iter().zip(sums).map(|(m, sum)| m.max(sum / (greatest * greatest))).collect()
    }

    fn choose(&mut self, model: &Model, x: &[Vec3]) -> Result<f64, ClothError> {
        self.since_look += 1;
        match self.step {
            Step::Adaptive { longest, .. } => {
                let limit = self.look(model, x);
                check_parameter("longest step", longest, |v| v > 0.0, "above 0 s")?;
                Ok(longest.min(SAFETY * limit))
            }
            Step::Fixed(dt) => {
                let limit = self.look(model, x);
                check_parameter("dt", dt, |v| v > 0.0, "above 0 s")?;
                if dt >= limit { Err(ClothError::TimeStepUnstable { dt, limit }) } else { Ok(dt) }
            }
            Step::Unguarded(dt) => check_parameter("dt", dt, |v| v > 0.0, "above 0 s").map(|()| dt),
        }
    }
}

/// The largest stable step with this stiffness, s.
fn limit_of(model: &Model, stiffness: &BlockMatrix) -> f64 {
    let w = omega_max_of(stiffness, model.inertia(), &model.fixed);
    if w == 0.0 {
        return f64::INFINITY;
    }
    let z = 0.5 * model.viscosity * w;
    2.0 / w * ((1.0 + z * z).sqrt() - z)
}

/// The highest frequency for which a step of `dt` s is stable, rad/s.
fn highest(dt: f64, viscosity: f64) -> f64 {
    2.0 / (dt * (1.0 + 2.0 * viscosity / dt).sqrt())
}

impl Solver for CentralDifferences {
    fn name(&self) -> &'static str {
        "central differences"
    }

    /// # Errors
    /// [`ClothError::TimeStepUnstable`] for a fixed step at or above the limit;
    /// [`ClothError::Diverged`]; those of input.
    fn advance(&mut self, model: &Model, state: &mut State) -> Result<Report, ClothError> {
        if self.last_dt == 0.0 {
            model.check(state)?;
        }
        let dt = self.choose(model, &state.x)?;
        // Velocities live half a step behind: the first step is half as long, and a changed step
        // moves them to its own middle.
        let reach = 0.5 * (self.last_dt + dt);
        let mut force = model.forces(&state.x);
        if model.viscosity > 0.0 {
            let damping = model.stiffness(&state.x, Projection::PositiveSemiDefinite).times(&state.v);
            force.iter_mut().zip(&damping).for_each(|(f, d)| *f -= d * model.viscosity);
        }
        let air = model.air.as_ref().map(|a| (a.air.wind, a.drag_tensors(&state.x, &state.v)));
        let (keep, share) = (1.0 - 0.5 * model.drag * reach, 1.0 / (1.0 + 0.5 * model.drag * reach));
        let inertia = model.inertia();
        for (v, push) in force.iter().enumerate() {
            if model.fixed[v] {
                state.v[v] = Vec3::zeros();
                continue;
            }
            let mut velocity = (state.v[v] * keep + push * (reach / inertia[v])) * share;
            if let Some((wind, drag_tensors)) = &air {
                let mobility = mobility(inertia[v] / share, &drag_tensors[v], reach);
                velocity = carried(&velocity, wind, &mobility, &drag_tensors[v], reach);
            }
            for obstacle in &model.obstacles {
                velocity = obstacle.stop(&state.x[v], &velocity, dt);
            }
            state.v[v] = velocity;
            state.x[v] += velocity * dt;
        }
        if !state.x.iter().all(|x| x.iter().all(|c| c.is_finite())) {
            return Err(ClothError::Diverged { what: "position", step: self.since_look });
        }
        state.time += dt;
        self.last_dt = dt;
        Ok(Report { advanced: dt, iterations: 1, residual: 0.0, converged: true })
    }
}
