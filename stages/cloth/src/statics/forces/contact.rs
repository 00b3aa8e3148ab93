//! One contact of cloth with itself.

use crate::statics::forces::contact_potential::ContactPotential;
use toile_geometry::Vec3;

/// Two features in contact.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Nodes.
    pub nodes: [u32; 4],
    /// Weights of the nodes in the distance.
    pub weights: [f64; 4],
    /// Unit vector from the second feature to the first.
    pub normal: Vec3,
    /// Stiffness at the distance at which contact begins, N/m.
    pub stiffness: f64,
    /// The contact potential at the present distance.
    pub potential: ContactPotential,
}
