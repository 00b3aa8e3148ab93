//! A solver with the membrane that it is given.

use crate::map::{Cloth, Scheme};
use toile_cloth::energy::{Bending, Membrane, Models};
use toile_cloth::error::ClothError;
use toile_cloth::solver::Solver;

/// Steps short enough for a mesh of 30 edges along, s.
const SHORT_STEP: f64 = 1e-3;
/// Steps of solvers without a limit, s.
const LONG_STEP: f64 = 0.016;

/// A solver, and what resists in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Way {
    /// The solver; none for static Newton.
    pub scheme: Option<Scheme>,
    /// Woven finite elements, or springs; XPBD, projective dynamics and `StaticEquilibrium` have
    /// their own.
    pub membrane: Membrane,
}

const fn woven(scheme: Scheme) -> Way {
    Way { scheme: Some(scheme), membrane: Membrane::Woven }
}

const fn springs(scheme: Scheme) -> Way {
    Way { scheme: Some(scheme), membrane: Membrane::Springs }
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 10] = [
        woven(Scheme::Explicit),
        springs(Scheme::Explicit),
        woven(Scheme::Implicit),
        springs(Scheme::Implicit),
        woven(Scheme::Gradients),
        woven(Scheme::Xpbd),
        woven(Scheme::Projective),
        Self { scheme: None, membrane: Membrane::Woven },
        Self { scheme: None, membrane: Membrane::Springs },
        woven(Scheme::Rest),
    ];

    /// For tables.
    #[must_use]
    pub fn name(self) -> String {
        let solver = self.scheme.map_or("static Newton", Scheme::name);
        match self.membrane {
            Membrane::Springs => format!("{solver} on springs"),
            _ => solver.to_owned(),
        }
    }

    /// Whether it has a time step.
    #[must_use]
    pub fn steps_in_time(self) -> bool {
        self.scheme.is_some_and(Scheme::steps_in_time)
    }

    /// The time step at which particles are turned, s.
    pub(super) fn usual_step(self) -> Option<f64> {
        let step = match self.scheme? {
            Scheme::Rest => return None,
            Scheme::Explicit | Scheme::Unguarded | Scheme::Xpbd => SHORT_STEP,
            Scheme::Implicit | Scheme::Gradients | Scheme::Projective => LONG_STEP,
        };
        Some(step)
    }

    /// Its membrane with coupled hinges.
    pub(super) fn models(self) -> Models {
        Models { membrane: self.membrane, bending: Bending::Hinge }
    }

    /// About what `steps` of it cost on so many triangles, s.
    pub(super) fn nominal(self, steps: f64, triangles: usize) -> f64 {
        self.scheme.map_or(0.0, |s| steps * triangles as f64 * s.price())
    }

    /// The solver for steps in time, or what refuses it.
    pub(super) fn solver(
        self,
        cloth: &Cloth<'_>,
        dt: Option<f64>,
        tolerance: f64,
    ) -> Result<Option<Box<dyn Solver>>, ClothError> {
        match self.scheme.zip(dt) {
            Some((scheme, dt)) => scheme.solver(cloth, dt, tolerance),
            None => Ok(None),
        }
    }
}
