//! Solvers: from a model and a state to the next state, or straight to rest.
//!
//! | solver | promises |
//! |---|---|
//! | [`Static`] | equilibrium of the model to a residual in newtons, no time |
//! | [`ImplicitEuler`] | stable at any step; motion of first order in the step, damped by known amounts |
//! | [`CentralDifferences`] | motion of second order, undamped; refuses a step above 2/omega_max |
//! | [`Xpbd`] | a picture in fixed time; approaches the model as steps shrink |
//! | [`Projective`] | the same, with a factor made once; for soft constraints close to rigid |

mod explicit;
mod implicit;
pub mod layout;
mod model;
mod newton;
mod projective;
mod spectrum;
mod statics;
mod xpbd;

#[cfg(test)]
mod air_tests;
#[cfg(test)]
mod tests;

pub use explicit::CentralDifferences;
pub use implicit::ImplicitEuler;
pub use model::{Model, State};
pub use newton::{LinearMethod, Newton, NewtonReport};
pub use projective::Projective;
pub use spectrum::{lowest_modes, omega_max};
pub use statics::Static;
pub use xpbd::Xpbd;

use crate::error::ClothError;

/// The report of one call of a solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Simulated time, s; 0 for a static solution.
    pub advanced: f64,
    /// Inner iterations.
    pub iterations: usize,
    /// Largest force left on a free vertex, N, of the equations that the solver solves.
    pub residual: f64,
    /// Whether the residual met its tolerance. Always true for solvers that have none.
    pub converged: bool,
}

/// Something that moves a state on.
pub trait Solver: Send {
    /// Its name in reports.
    fn name(&self) -> &'static str;

    /// One step, or all the way to rest.
    ///
    /// # Errors
    /// What the solver documents; the state is then the last good one.
    fn advance(&mut self, model: &Model, state: &mut State) -> Result<Report, ClothError>;
}
