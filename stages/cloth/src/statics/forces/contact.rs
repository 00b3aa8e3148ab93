//! One contact of cloth with itself.

use crate::statics::forces::contact_potential::ContactPotential;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Two features that touch.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Nodes.
    pub nodes: [u32; 4],
    /// Weights of the nodes in the distance.
    pub weights: [f64; 4],
    /// Unit direction from the second to the first.
    pub normal: Vec3,
    /// Stiffness where they begin to touch, N/m.
    pub stiffness: f64,
    /// How hard they press.
    pub press: ContactPotential,
}
