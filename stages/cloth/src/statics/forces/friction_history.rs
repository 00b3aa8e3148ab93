//! Friction of cloth on cloth: what each contact remembers from step to step.
//!
//! The point that rubs is the way between the two features of a contact (see [`Contact`]); its
//! anchor lies where the way was when they first touched. Features change as cloth slides, and
//! above a corner or a side of its partner a vertex swaps triangles with every rounding. So what is
//! remembered is how far the two have slid, not where: a contact goes on from the way of the last
//! step, and a new one takes over from contacts of the same two places, which share a node on
//! either side with it.

use crate::contact::friction::FrictionContact;
use crate::statics::forces::contact::Contact;
use crate::statics::forces::coulomb::{Coulomb, SLIP_TOLERANCE};
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The sum of nodes times weights.
pub(crate) fn between(nodes: &[u32; 4], weights: &[f64; 4], x: &[Vec3]) -> Vec3 {
    nodes.iter().zip(weights).map(|(i, w)| x[*i as usize] * *w).sum()
}

impl FrictionContact {
    pub(crate) fn rub(&self) -> Coulomb {
        Coulomb { normal: self.normal, anchor: self.anchor, limit: self.friction * self.load }
    }

    pub(crate) fn at(&self, x: &[Vec3]) -> Vec3 {
        between(&self.nodes, &self.weights, x)
    }

    /// Drags the anchor along, where the features have slid on in this step: what holds beside
    /// cloth that slides goes on holding.
    pub(crate) fn drag(&mut self, x: &[Vec3]) {
        let (rub, at) = (self.rub(), self.at(x));
        if (rub.way(&at) - self.slid).norm() > SLIP_TOLERANCE {
            self.anchor = rub.dragged(&at);
        }
    }

    /// Nodes of the first feature.
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
    /// From the larger node's side to the smaller's, or the other way round: -1.
    sign: f64,
}

impl Opposite {
    fn of(i: u32, j: u32) -> Self {
        if i < j { Self { nodes: [i, j], sign: 1.0 } } else { Self { nodes: [j, i], sign: -1.0 } }
    }
}

/// What contacts of two places have slid.
#[derive(Debug, Clone, Copy)]
struct Slid {
    nodes: [u32; 2],
    way: Vec3,
    load: f64,
}

/// How far the contacts of the last step have slid where the cloth is now.
pub(crate) struct Memory<'a> {
    friction_contacts: &'a [FrictionContact],
    ways: Vec<Vec3>,
    /// By the nodes; made when it is first asked.
    slid: Option<Vec<Slid>>,
}

impl<'a> Memory<'a> {
    pub(crate) fn of(friction_contacts: &'a [FrictionContact], x: &[Vec3]) -> Self {
        let ways = friction_contacts.iter().map(|g| g.rub().way(&g.at(x))).collect();
        Self { friction_contacts, ways, slid: None }
    }

    /// The friction of a contact that presses with `force`.
    pub(crate) fn grip(&mut self, c: &Contact, x: &[Vec3], force: f64, friction: f64) -> FrictionContact {
        let (nodes, weights, normal) = (c.nodes, c.weights, c.normal);
        let anchor = between(&nodes, &weights, x);
        let mut grip =
            FrictionContact { nodes, weights, normal, anchor, slid: Vec3::zeros(), load: force, friction };
        grip.slid = match self.friction_contacts.binary_search_by_key(&grip.key(), FrictionContact::key) {
            Ok(k) => {
                // While Newton's steps swing between touching and not, friction follows the mean.
                grip.load = 0.5 * (self.friction_contacts[k].load + force);
                self.ways[k]
            }
            Err(_) => self.taken_over(&grip),
        };
        grip.anchor -= grip.slid;
        grip
    }

    /// The mean way of the contacts of the same two places.
    fn taken_over(&mut self, grip: &FrictionContact) -> Vec3 {
        let slid = self.slid.get_or_insert_with(|| all_slid(self.friction_contacts, &self.ways));
        let (mut way, mut load) = (Vec3::zeros(), 0.0);
        for c in grip.opposites() {
            let start = slid.partition_point(|s| s.nodes < c.nodes);
            for s in slid[start..].iter().take_while(|s| s.nodes == c.nodes) {
                way += s.way * (c.sign * s.load);
                load += s.load;
            }
        }
        if load > 0.0 { way / load } else { way }
    }
}

fn all_slid(friction_contacts: &[FrictionContact], ways: &[Vec3]) -> Vec<Slid> {
    let one = |(g, way): (&FrictionContact, &Vec3)| -> Vec<Slid> {
        g.opposites().map(|c| Slid { nodes: c.nodes, way: way * c.sign, load: g.load }).collect()
    };
    let mut slid: Vec<Slid> = friction_contacts.iter().zip(ways).flat_map(one).collect();
    // Stable, so that sums are the same every time.
    slid.sort_by_key(|s| s.nodes);
    slid
}

#[cfg(test)]
mod tests;
