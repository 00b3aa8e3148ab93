//! Friction of cloth on cloth: what each contact keeps from step to step.
//!
//! Friction acts on the vector between the two features of a contact (see `Contact`); its anchor
//! is that vector at the first touch. Features change as cloth slides, and a vertex above a corner
//! or a side of its partner changes triangles with every rounding. So the tangential displacement
//! is kept, not the place: a contact goes on from its displacement in the last step, and a new
//! contact takes over the mean displacement of contacts that share a node with it on either side.
//!
//! Cost: O(n log n) of the contacts.

use crate::contact::coulomb::{Coulomb, FrictionMemory, mean_by_load};
use crate::contact::friction::FrictionContact;
use crate::statics::forces::contact::Contact;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The sum of nodes times weights.
pub(crate) fn between(nodes: &[u32; 4], weights: &[f64; 4], x: &[Vec3]) -> Vec3 {
    nodes.iter().zip(weights).map(|(i, w)| x[*i as usize] * *w).sum()
}

impl FrictionContact {
    /// The friction of this contact.
    pub(crate) fn coulomb(&self) -> Coulomb {
        self.memory.coulomb(self.normal, self.friction)
    }

    /// The vector between its features at `x`, m.
    pub(crate) fn at(&self, x: &[Vec3]) -> Vec3 {
        between(&self.nodes, &self.weights, x)
    }

    /// Moves the anchor along where the features have slid in this step.
    pub(crate) fn drag_anchor(&mut self, x: &[Vec3]) {
        let (friction, at) = (self.coulomb(), self.at(x));
        self.memory.drag(&friction, &at, &self.slid);
    }

    /// How many nodes the first feature has.
    fn first(&self) -> usize {
        if self.weights[1] > 0.0 { 2 } else { 1 }
    }

    pub(crate) fn key(&self) -> (usize, [u32; 4]) {
        (self.first(), self.nodes)
    }

    /// Every pair of a node of the first feature and one of the second.
    fn opposites(&self) -> impl Iterator<Item = Opposite> + '_ {
        let (a, b) = self.nodes.split_at(self.first());
        a.iter().flat_map(move |&i| b.iter().map(move |&j| Opposite::of(i, j)))
    }
}

/// Two nodes on the two sides of a contact.
#[derive(Debug, Clone, Copy)]
struct Opposite {
    nodes: [u32; 2],
    /// 1 if the first feature has the smaller node, otherwise -1.
    sign: f64,
}

impl Opposite {
    fn of(i: u32, j: u32) -> Self {
        if i < j { Self { nodes: [i, j], sign: 1.0 } } else { Self { nodes: [j, i], sign: -1.0 } }
    }
}

/// The tangential displacement of a contact, for one pair of opposite nodes.
#[derive(Debug, Clone, Copy)]
struct Slid {
    nodes: [u32; 2],
    displacement: Vec3,
    load: f64,
}

/// The contacts of the last step with their tangential displacements at the present places.
pub(crate) struct FrictionHistory<'a> {
    friction_contacts: &'a [FrictionContact],
    displacements: Vec<Vec3>,
    /// Sorted by nodes; made on first use.
    slid: Option<Vec<Slid>>,
}

impl<'a> FrictionHistory<'a> {
    pub(crate) fn of(friction_contacts: &'a [FrictionContact], x: &[Vec3]) -> Self {
        let displacements = friction_contacts.iter().map(|c| c.coulomb().displacement(&c.at(x))).collect();
        Self { friction_contacts, displacements, slid: None }
    }

    /// The friction of a contact that presses with `force`.
    pub(crate) fn friction_contact(
        &mut self,
        c: &Contact,
        x: &[Vec3],
        force: f64,
        friction: f64,
    ) -> FrictionContact {
        let (nodes, weights, normal) = (c.nodes, c.weights, c.normal);
        let memory = FrictionMemory { anchor: between(&nodes, &weights, x), load: force };
        let mut new = FrictionContact { nodes, weights, normal, friction, memory, slid: Vec3::zeros() };
        new.slid = match self.friction_contacts.binary_search_by_key(&new.key(), FrictionContact::key) {
            Ok(k) => {
                new.memory.load = self.friction_contacts[k].memory.mean_load(force);
                self.displacements[k]
            }
            Err(_) => self.taken_over(&new),
        };
        new.memory.anchor -= new.slid;
        new
    }

    /// The mean displacement of the contacts that share a node on either side, weighted by load.
    fn taken_over(&mut self, new: &FrictionContact) -> Vec3 {
        let slid = self.slid.get_or_insert_with(|| all_slid(self.friction_contacts, &self.displacements));
        mean_by_load(new.opposites().flat_map(|c| {
            let start = slid.partition_point(|s| s.nodes < c.nodes);
            let own = slid[start..].iter().take_while(move |s| s.nodes == c.nodes);
            own.map(move |s| (s.displacement * c.sign, s.load))
        }))
    }
}

fn all_slid(friction_contacts: &[FrictionContact], displacements: &[Vec3]) -> Vec<Slid> {
    let one = |(g, d): (&FrictionContact, &Vec3)| -> Vec<Slid> {
        g.opposites()
            .map(|c| Slid { nodes: c.nodes, displacement: d * c.sign, load: g.memory.load })
            .collect()
    };
    let mut slid: Vec<Slid> = friction_contacts.iter().zip(displacements).flat_map(one).collect();
    // A stable sort: the order of the sums decides their rounding.
    slid.sort_by_key(|s| s.nodes);
    slid
}

#[cfg(test)]
mod tests;
