//! The friction of one contact of cloth with cloth, kept from step to step.

use crate::contact::coulomb::FrictionMemory;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Friction of one contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionContact {
    /// Nodes.
    pub nodes: [u32; 4],
    /// Weights of the nodes in the vector between the features.
    pub weights: [f64; 4],
    /// Unit vector from the second feature to the first.
    pub normal: Vec3,
    /// Coefficient of friction.
    pub friction: f64,
    /// The vector between the features that friction holds, and the load.
    pub memory: FrictionMemory,
    /// Tangential displacement at the start of the step, m.
    pub slid: Vec3,
}
