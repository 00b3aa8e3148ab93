//! The time-stepping solvers, made for one sheet.

use crate::error::ClothError;
use crate::fabric::{Fabric, Rigidity};
use crate::mesh::Sheet;
use crate::solver::{CentralDifferences, ImplicitEuler, LinearMethod, Model, Projective, Solver, Xpbd};
use toile_geometry::Vec3;

/// First explicit step, as a share of the stability limit: cloth stiffens.
const STABLE: f64 = 0.8;

/// A solver and its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Central differences: explicit, of second order, undamped, with as many small steps as
    /// stability needs.
    CentralDifferences {
        /// Shortest step, s: vertices too light for it get more inertia. 0 for true motion.
        least: f64,
    },
    /// Implicit Euler: stable at any step, damps motion that the step does not resolve.
    ImplicitEuler {
        /// Greatest residual force on a vertex, N.
        tolerance: f64,
        /// Conjugate gradients to this relative residual instead of a factor.
        relative: Option<f64>,
    },
    /// Extended position-based dynamics: Gauss-Seidel in small steps, always stable, too soft where
    /// steps are few.
    Xpbd {
        /// Small steps in a step.
        substeps: usize,
    },
    /// Projective dynamics: local and global iterations with one factor.
    Projective {
        /// Iterations a step.
        iterations: usize,
    },
}

impl Method {
    /// The solver for steps of `dt`, s.
    pub(super) fn solver(
        self,
        sheet: &Sheet,
        model: &Model,
        x: &[Vec3],
        fabric: &Fabric,
        dt: f64,
    ) -> Result<Box<dyn Solver>, ClothError> {
        Ok(match self {
            Self::CentralDifferences { least } => {
                // A whole number of stable steps fills the step, so that phases end after whole
                // steps.
                let stable = (STABLE * CentralDifferences::limit(model, x)).max(least);
                Box::new(CentralDifferences::bounded(dt / (dt / stable).ceil().max(1.0), least))
            }
            Self::ImplicitEuler { tolerance, relative } => {
                let mut solver = ImplicitEuler::new(dt, tolerance);
                if let Some(tolerance) = relative {
                    solver.newton.linear = LinearMethod::ConjugateGradients { tolerance };
                }
                Box::new(solver)
            }
            Self::Xpbd { substeps } => Box::new(Xpbd::new(sheet, fabric, dt, substeps)?),
            Self::Projective { iterations } => {
                let rigidity = Rigidity::of(fabric);
                Box::new(Projective::new(sheet, model, fabric.stretch(), &rigidity, dt, iterations)?)
            }
        })
    }

    /// Whether all its cloth is of one fabric.
    pub(super) fn takes_one_fabric(self) -> bool {
        matches!(self, Self::Xpbd { .. } | Self::Projective { .. })
    }

    /// The shortest step for which vertices get more inertia, s.
    pub(super) fn least_step(self) -> Option<f64> {
        if let Self::CentralDifferences { least } = self { Some(least).filter(|l| *l > 0.0) } else { None }
    }

    /// Whether it takes elastic bands and the published seam force: solvers whose forces are the
    /// gradients of energies do.
    #[must_use]
    pub fn takes_bands(self) -> bool {
        matches!(self, Self::CentralDifferences { .. } | Self::ImplicitEuler { .. })
    }

    /// Whether it makes shorter steps than the given one; a phase then ends to within one of them.
    pub(super) fn chooses_its_step(self) -> bool {
        matches!(self, Self::CentralDifferences { .. })
    }
}
