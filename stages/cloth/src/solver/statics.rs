//! Static equilibrium without contact: Newton's method on the potential energy with
//! pseudo-transient continuation.
//!
//! The reported residual in newtons is exact. Cost: one sparse factorization an iteration, 10 to 60
//! iterations from a flat start. Limit: it finds the equilibrium downhill of the start, so a strip
//! that could buckle to either side needs an imperfection.

use super::{Model, Newton, Report, Solver, State};
use crate::energy::Energy;
use crate::error::ClothError;

/// First pseudo-time step, s: about how long a piece of cloth takes to fall its own size.
const PSEUDO_STEP: f64 = 0.1;

/// The static solver.
pub struct Static {
    /// Newton's options.
    pub newton: Newton,
}

impl Static {
    /// To this largest force (N) on any free vertex.
    #[must_use]
    pub fn to(tolerance: f64) -> Self {
        let mut newton = Newton::new(tolerance);
        newton.pseudo_step = PSEUDO_STEP;
        newton.most_iterations = 400;
        Self { newton }
    }
}

impl Solver for Static {
    fn name(&self) -> &'static str {
        "static Newton"
    }

    /// # Errors
    /// [`ClothError::NotConverged`] with the residual reached, [`ClothError::Wind`], besides those
    /// of input.
    fn advance(&mut self, model: &Model, state: &mut State) -> Result<Report, ClothError> {
        model.check(state)?;
        model.air.as_ref().map_or(Ok(()), |a| a.air.check_still())?;
        let weight = model.weight();
        let mut energies = model.internal();
        energies.push(&weight as &dyn Energy);
        let report = self.newton.minimise(&energies, &model.masses, &model.fixed, &mut state.x)?;
        if !report.converged {
            return Err(ClothError::NotConverged {
                iterations: report.iterations,
                residual: report.residual,
                wanted: self.newton.tolerance,
            });
        }
        state.v.fill(crate::energy::Vec3::zeros());
        Ok(Report {
            advanced: 0.0,
            iterations: report.iterations,
            residual: report.residual,
            converged: true,
        })
    }
}
