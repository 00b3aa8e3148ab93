//! Time stepping.
//!
//! A [`Solver`] turns forces into velocities one step ahead; contacts then correct the velocities,
//! and positions follow. Other schemes (implicit, projective) stand behind the same trait.

use super::model::{Cloth, State};
use nalgebra::Vector3;

/// Adds the forces in a state to the list; returns the greatest tensile strain.
pub type Forces<'a> = &'a dyn Fn(&State, &mut [Vector3<f64>]) -> f64;

/// A time-stepping scheme.
pub trait Solver: Send + std::fmt::Debug {
    /// The longest stable step for springs up to this angular frequency (rad/s), seconds.
    fn step_limit(&self, frequency: f64) -> f64;

    /// Replaces the velocities by those after a step `dt`; positions stay. Returns the greatest
    /// tensile strain met.
    fn advance(
        &mut self,
        cloth: &Cloth,
        state: &mut State,
        extra_damping: f64,
        dt: f64,
        forces: Forces,
    ) -> f64;
}

/// Central differences [METHODS 2], written with velocities at half steps:
/// `v+ = ((1 - c dt/2) v- + dt f/m) / (1 + c dt/2)`, `x+ = x + dt v+`.
///
/// Eliminating the velocities gives `(m/dt^2 + c/2dt) x+ = f + 2m/dt^2 x - (m/dt^2 - c/2dt) x-` term by
/// term; this form lets the step change and contacts act on velocities. Second order; stable
/// up to `dt = 2 / frequency`.
#[derive(Debug, Default)]
pub struct CentralDifferences {
    forces: Vec<Vector3<f64>>,
    /// The step before; 0 at the start, whose velocities are those of the positions' own time.
    last: f64,
}

/// Share of the theoretical limit that is used: contacts and large turns eat the rest.
const SAFETY: f64 = 0.9;

impl Solver for CentralDifferences {
    fn step_limit(&self, frequency: f64) -> f64 {
        SAFETY * 2.0 / frequency.max(1e-6)
    }

    fn advance(
        &mut self,
        cloth: &Cloth,
        state: &mut State,
        extra_damping: f64,
        dt: f64,
        forces: Forces,
    ) -> f64 {
        self.forces.clear();
        self.forces.resize(cloth.len(), Vector3::zeros());
        let strain = forces(state, &mut self.forces);
        // From the middle of the last step to the middle of this one.
        let span = (self.last + dt) / 2.0;
        self.last = dt;
        for i in 0..cloth.len() {
            let c = (cloth.damping[i] + extra_damping) * span / 2.0;
            let push = self.forces[i] * (span * cloth.inverse_inertia[i]);
            let moves = if cloth.inverse_inertia[i] > 0.0 { 1.0 } else { 0.0 };
            state.v[i] = (state.v[i] * ((1.0 - c) * moves) + push) / (1.0 + c);
        }
        strain
    }
}
