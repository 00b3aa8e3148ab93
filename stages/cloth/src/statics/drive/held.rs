//! Goes on from the friction of an equilibrium: displacements, offsets, folds and contacts. Cost:
//! O(n).

use crate::contact::friction::FrictionContact;
use crate::scene::Held;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::levels::pieces::Pieces;
use crate::statics::report::equilibrium::Equilibrium;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

impl Equilibrium {
    /// The history of friction in this state.
    #[must_use]
    pub fn held(&self) -> Held {
        Held {
            slides: self.slides.clone(),
            offsets: self.offsets.clone(),
            folds: self.folds.clone(),
            contacts: self.friction_contacts.clone(),
        }
    }
}

/// Gives the nodes of the finest level at `x` the history of friction that a solver left.
pub(crate) fn hold_as(held: &Held, system: &mut System<'_>, pieces: &Pieces, x: &[Vec3]) {
    let vertices = pieces.rest.len();
    if let Some(contact) = system.get_mut::<BodyContact>() {
        if held.slides.len() == vertices {
            contact.slides = pieces.sew(&held.slides, &vec![1.0; vertices]);
        }
        if held.offsets.len() == vertices {
            pieces.node.iter().zip(&held.offsets).for_each(|(&n, o)| contact.offsets[n as usize] = *o);
        }
    }
    if let Some(self_contact) = system.get_mut::<SelfContact>() {
        let known = |c: &&FrictionContact| c.nodes.iter().all(|&i| (i as usize) < x.len());
        self_contact.friction_contacts = held.contacts.iter().filter(known).copied().collect();
    }
    system.elastic.hold(x, false);
    system.elastic.hold_at(&held.folds);
}
