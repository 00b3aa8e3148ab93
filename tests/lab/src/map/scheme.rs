//! The solvers of a map.

use serde::{Serialize, Serializer};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::fabric::Rigidity;
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::{CentralDifferences, ImplicitEuler, LinearMethod, Model, Projective, Solver, Xpbd};

/// Residual of conjugate gradients.
const GRADIENTS: f64 = 1e-4;
/// Turns of a step of projective dynamics.
const TURNS: usize = 10;

/// A solver with the settings that a map gives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Central differences, which refuse steps above their limit.
    Explicit,
    /// The same without that guard.
    Unguarded,
    /// Implicit Euler, each step to a residual, with a sparse factor.
    Implicit,
    /// Implicit Euler with conjugate gradients.
    Gradients,
    /// XPBD, one substep per time step.
    Xpbd,
    /// Projective dynamics, 10 iterations per time step.
    Projective,
    /// Straight to rest: no time step.
    Rest,
}

impl Scheme {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Explicit,
        Self::Unguarded,
        Self::Implicit,
        Self::Gradients,
        Self::Xpbd,
        Self::Projective,
        Self::Rest,
    ];

    /// For people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Explicit => "central differences",
            Self::Unguarded => "central differences (unguarded)",
            Self::Implicit => "implicit Euler (factor)",
            Self::Gradients => "implicit Euler (gradients)",
            Self::Xpbd => "XPBD",
            Self::Projective => "projective dynamics (10 turns)",
            Self::Rest => "StaticEquilibrium",
        }
    }

    /// For files and options.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Explicit => "explicit",
            Self::Unguarded => "unguarded",
            Self::Implicit => "implicit",
            Self::Gradients => "gradients",
            Self::Xpbd => "xpbd",
            Self::Projective => "projective",
            Self::Rest => "rest",
        }
    }

    /// What theory says of its greatest time step.
    #[must_use]
    pub fn theory(self) -> &'static str {
        match self {
            Self::Explicit | Self::Unguarded => {
                "limit 2/omega_max of the assembled stiffness and masses (dashed)"
            }
            Self::Implicit | Self::Gradients => {
                "no limit: backward Euler lowers the energy at any step; dashed: the explicit limit"
            }
            Self::Xpbd => {
                "no limit: each projection is bounded by its compliance; dashed: the explicit limit"
            }
            Self::Projective => {
                "no limit: each turn lowers the energy of its step; dashed: the explicit limit"
            }
            Self::Rest => "no time step, so no limit",
        }
    }

    /// Whether theory bounds its time step.
    #[must_use]
    pub fn is_limited(self) -> bool {
        matches!(self, Self::Explicit | Self::Unguarded)
    }

    /// Whether it has a time step.
    #[must_use]
    pub fn steps_in_time(self) -> bool {
        self != Self::Rest
    }

    /// About what a step costs, s a triangle on one core of 2020: bounds how long a cell runs, the
    /// same on every machine.
    #[must_use]
    pub fn price(self) -> f64 {
        match self {
            Self::Explicit | Self::Unguarded => 7e-7,
            Self::Implicit | Self::Gradients => 1.5e-5,
            Self::Xpbd => 6e-7,
            Self::Projective => 1.5e-6,
            Self::Rest => 0.0,
        }
    }

    /// The solver for steps of `dt` (s), implicit ones to this largest force (N); none for
    /// `StaticEquilibrium`.
    pub(crate) fn solver(
        self,
        cloth: &Cloth<'_>,
        dt: f64,
        tolerance: f64,
    ) -> Result<Option<Box<dyn Solver>>, ClothError> {
        let Cloth { sheet, fabric, model } = *cloth;
        Ok(Some(match self {
            Self::Explicit => Box::new(CentralDifferences::fixed(dt)),
            Self::Unguarded => Box::new(CentralDifferences::unguarded(dt)),
            Self::Implicit => Box::new(ImplicitEuler::new(dt, tolerance)),
            Self::Gradients => {
                let mut solver = ImplicitEuler::new(dt, tolerance);
                solver.newton.linear = LinearMethod::ConjugateGradients { tolerance: GRADIENTS };
                Box::new(solver)
            }
            Self::Xpbd => Box::new(Xpbd::new(sheet, fabric, dt, 1)?),
            Self::Projective => {
                let rigidity = Rigidity::of(fabric);
                Box::new(Projective::new(sheet, model, fabric.stretch(), &rigidity, dt, TURNS)?)
            }
            Self::Rest => return Ok(None),
        }))
    }
}

/// What a solver is made for.
#[derive(Clone, Copy)]
pub(crate) struct Cloth<'a> {
    pub sheet: &'a Sheet,
    pub fabric: &'a Fabric,
    pub model: &'a Model,
}

impl Serialize for Scheme {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}
