//! The history of friction of an equilibrium, from which another run goes on.
//!
//! Without it, the anchors of friction are the initial positions, and cloth that was held by
//! friction slides a little before friction holds it again.

use super::{Scene, SceneError};
use crate::contact::coulomb::FrictionMemory;
use crate::contact::friction::FrictionContact;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// How many numbers a contact has besides its nodes.
pub const FIGURES: usize = 15;

/// The history of friction.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Held {
    /// Tangential displacement of each vertex on the body, m.
    pub slides: Vec<Vec3>,
    /// Offset of body contact at each vertex, m; empty without a body.
    pub offsets: Vec<f64>,
    /// Angles of bending hysteresis, by hinges of the sewn garment; empty where there is none.
    pub folds: Vec<f64>,
    /// Friction contacts of cloth with cloth, by sewn points.
    pub contacts: Vec<FrictionContact>,
}

impl Held {
    /// Whether nothing is known.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.slides.is_empty()
    }

    /// Checks its lists against the scene's.
    pub(super) fn check(&self, scene: &Scene) -> Result<(), SceneError> {
        let wanted = scene.rest.len();
        let lists = [("held.slides", self.slides.len()), ("held.offsets", self.offsets.len())];
        match lists.into_iter().find(|(_, found)| ![0, wanted].contains(found)) {
            Some((name, found)) => Err(SceneError::Length { name, found, wanted }),
            None => Ok(()),
        }
    }
}

/// A contact from its nodes and its other numbers: weights, normal, anchor, displacement, load,
/// coefficient.
#[must_use]
pub fn contact(nodes: [u32; 4], f: &[f64; FIGURES]) -> FrictionContact {
    let vector = |k: usize| Vec3::new(f[k], f[k + 1], f[k + 2]);
    let weights = [f[0], f[1], f[2], f[3]];
    let memory = FrictionMemory { anchor: vector(7), load: f[13] };
    FrictionContact { nodes, weights, normal: vector(4), friction: f[14], memory, slid: vector(10) }
}

/// The numbers of a contact besides its nodes.
#[must_use]
pub fn figures(c: &FrictionContact) -> [f64; FIGURES] {
    let mut f = [0.0; FIGURES];
    f[..4].copy_from_slice(&c.weights);
    for (k, v) in [(4, c.normal), (7, c.memory.anchor), (10, c.slid)] {
        f[k..k + 3].copy_from_slice(v.as_slice());
    }
    (f[13], f[14]) = (c.memory.load, c.friction);
    f
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_is_the_same_after_its_numbers() {
        let f: [f64; FIGURES] = std::array::from_fn(|k| 0.1 * k as f64);
        assert_eq!(figures(&contact([1, 2, 3, 4], &f)), f);
        assert_eq!(contact([1, 2, 3, 4], &f).nodes, [1, 2, 3, 4]);
    }
}
