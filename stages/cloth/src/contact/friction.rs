//! What friction remembers of a contact of cloth with cloth.

use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Friction of one contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionContact {
    /// Nodes.
    pub nodes: [u32; 4],
    /// Weights of the nodes in the way between the features.
    pub weights: [f64; 4],
    /// Unit direction from the second feature to the first.
    pub normal: Vec3,
    /// Where friction holds the way between the features, m.
    pub anchor: Vec3,
    /// How far the features had slid at the step's start, m.
    pub slid: Vec3,
    /// The force that limits friction: the mean over the last steps, N.
    pub load: f64,
    /// Coefficient of friction.
    pub friction: f64,
}
