//! The node with the greatest residual force, and what it is in contact with. Cost: O(n).

use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::levels::pieces::Pieces;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The node with the greatest residual force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalanced {
    /// The vertex of the scene.
    pub vertex: u32,
    /// The force, N.
    pub force: f64,
    /// What the cloth is in contact with there.
    pub meets: Meets,
}

/// What cloth is in contact with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meets {
    /// Other cloth.
    Cloth,
    /// The body.
    Body,
    /// Nothing.
    Nothing,
}

/// The greatest residual force of a gradient.
pub(crate) fn unbalanced(system: &System<'_>, gradient: &[Vec3], pieces: &Pieces) -> Unbalanced {
    let mut worst = (0, 0.0);
    for (n, force) in gradient.iter().map(Vec3::norm).enumerate() {
        if force > worst.1 {
            worst = (n as u32, force);
        }
    }
    let (node, force) = worst;
    let meets_cloth =
        system.get::<SelfContact>().is_some_and(|l| l.contacts.iter().any(|c| c.nodes.contains(&node)));
    let meets_body = system.get::<BodyContact>().is_some_and(|c| c.touches.iter().any(|t| t.node == node));
    let meets = match (meets_cloth, meets_body) {
        (true, _) => Meets::Cloth,
        (_, true) => Meets::Body,
        _ => Meets::Nothing,
    };
    let vertex = pieces.node.iter().position(|n| *n == node).unwrap_or(0) as u32;
    Unbalanced { vertex, force, meets }
}
