//! A force on the nodes, as a potential of their positions: the interface that forces share.
//!
//! Method: every step makes the same calls, in the order of the IPC Toolkit (Ferguson et al. 2020).
//! Candidates are pairs that may touch. Collisions are found among them when the step begins, and
//! friction is built from the collisions. A force without contact has only a value, a gradient and
//! a matrix. Gradient, matrix and friction are those of the collisions at the step's start; the
//! value of contact is that of the collisions at the place where it is asked for.
//!
//! Cost: a dynamic call per force and sum. Limit: values do not add to the energy that a caller
//! reports as stored, which is that of the sheet and of its weight.

use crate::contact::collision_surface::CollisionSurface;
use crate::energy::Subset;
use crate::linear::Pattern;
use crate::statics::forces::distance_query::ContactQuery;
use crate::statics::forces::loads::Loads;
use nalgebra::{Matrix3, Vector3};
use std::any::Any;
use std::fmt::Debug;

type Vec3 = Vector3<f64>;

/// Positions of the nodes, with what acts on them and is known there.
#[derive(Clone, Copy)]
pub struct Place<'p> {
    /// The positions, m.
    pub x: &'p [Vec3],
    /// The body, if there is one.
    pub body: Option<&'p dyn CollisionSurface>,
    /// The contact query of each node; empty without body contact.
    pub on_body: &'p [ContactQuery],
    /// Masses, weight and pushes.
    pub loads: &'p Loads,
}

/// A force on the nodes of a system.
pub trait Force: Any + Debug + Send + Sync {
    /// A copy.
    fn boxed(&self) -> Box<dyn Force>;

    /// Visits the groups of nodes that it couples in every step.
    fn couplings(&self, _visit: &mut dyn FnMut(&[u32])) {}

    /// Visits the groups of nodes that may touch.
    fn candidates(&self, _visit: &mut dyn FnMut(&[u32])) {}

    /// Visits the groups of nodes that the collisions of this step couple besides.
    fn collisions(&self, _visit: &mut dyn FnMut(&[u32; 4])) {}

    /// Finds the collisions and their friction at the start of a step.
    fn begin_step(&mut self, _at: &Place<'_>) {}

    /// The energy that does not depend on collisions, J.
    fn value(&self, _x: &[Vec3]) -> f64 {
        0.0
    }

    /// Adds the energy of collisions, J.
    fn add_contact_value(&self, _at: &Place<'_>, _sum: &mut f64) {}

    /// Adds the same at the step's start, where the collisions are known, J.
    fn add_contact_value_at_start(&self, _x: &[Vec3], _sum: &mut f64) {}

    /// Adds the derivative at the step's start, N.
    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]);

    /// Adds the matrix at the step's start, N/m. It must be positive semi-definite.
    fn add_matrix(&self, x: &[Vec3], pattern: &Pattern, values: &mut [Matrix3<f64>]);

    /// Moves the anchors of friction along with what slides, at the end of a step that moves far.
    fn end_step(&mut self, _x: &[Vec3]) {}

    /// Disables friction, or enables it again.
    fn swap_friction(&mut self) {}

    /// Scales the stiffness and the loads of contact.
    fn scale_contact(&mut self, _factor: f64) {}

    /// The force on a subset of the nodes.
    fn restrict(&self, cut: &Subset) -> Box<dyn Force>;

    /// Takes over what a restricted copy has found.
    fn merge(&mut self, _cut: &Subset, _part: &dyn Force) {}

    /// Takes over the history of the same force before the scene was changed; `before` may be
    /// another force.
    fn continue_from(&mut self, _before: &dyn Force) {}
}

impl Clone for Box<dyn Force> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// A force as one of its type; `None` if it is of another.
pub(crate) fn of_type<F: Force>(force: &dyn Force) -> Option<&F> {
    (force as &dyn Any).downcast_ref()
}
