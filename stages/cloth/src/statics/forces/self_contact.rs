//! Cloth against itself: a penalty between features that are nearer than a thickness.
//!
//! Each vertex is pressed away from the points of the sheet where its distance is a local minimum,
//! and edges from edges where both closest points lie inside (offset geometric contact, Chen et al.
//! 2025, names these the feasible pairs), so that nothing is counted twice. What touches rubs, by
//! Coulomb's law (see `friction_history`).

use crate::contact::friction::FrictionContact;
use crate::linear::{Pattern, add_at};
use crate::statics::forces::contact::Contact;
use crate::statics::forces::contact_potential::ContactPotential;
use crate::statics::forces::friction_history::{Memory, between};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use toile_geometry::closest::Feature;
use toile_geometry::pair::{Closest, Kind, Pair};

mod intersections;
mod stacked;

pub(crate) use intersections::MERGED;

type Vec3 = Vector3<f64>;

/// Pairs that may touch, and how stiffly.
#[derive(Debug, Clone)]
#[cfg_attr(not(toile_without = "self_contact"), derive(Default))]
pub struct SelfContact {
    #[cfg(toile_without = "self_contact")]
    pub(crate) never: std::convert::Infallible,
    /// Distance at which contact begins, m.
    pub thickness: f64,
    /// Mean length of the edges, m.
    pub edge: f64,
    /// Whether many cloths lie on each other: each is then near many others.
    pub crowded: bool,
    /// Stiffness at each node, N/m.
    pub stiffness: Vec<f64>,
    /// Coefficient of friction of cloth on cloth at each node; where two rub, the mean counts.
    /// Empty where there is none.
    pub friction: Vec<f64>,
    /// The friction that is taken away for a while.
    pub away: Vec<f64>,
    /// Layer that each node is worn in, the outer ones higher; empty where all are one.
    pub order: Vec<u32>,
    /// Triangles at each node, for corners that are local minima.
    pub corners: Vec<u16>,
    /// Pairs that may touch during the step, sorted.
    pub pairs: Vec<Pair>,
    /// Those that count as contacts while they are near, sorted; none where only their features
    /// tell.
    pub held: Option<Vec<Pair>>,
    /// Those that touch at its start.
    pub contacts: Vec<Contact>,
    /// Their friction, one by one; empty where there is none.
    pub friction_contacts: Vec<FrictionContact>,
    /// Edges that pass through triangles, as a coarser level's state can have it: pulled back out.
    pub tangles: Vec<Contact>,
    /// Nodes of the tangles: among themselves they may pass through each other to get free.
    pub tangled: Vec<bool>,
}

#[cfg(toile_without = "self_contact")]
impl Default for SelfContact {
    fn default() -> Self {
        std::process::abort()
    }
}

impl SelfContact {
    /// Finds the contacts at `x`, and what friction holds of them.
    pub fn touch(&mut self, x: &[Vec3]) {
        let counted = self.feasible(x);
        self.contacts = counted.iter().map(|near| self.contact(near, x)).collect();
        self.remember(&counted);
        if self.friction.is_empty() {
            return;
        }
        let mut memory = Memory::of(&self.friction_contacts, x);
        let grip = |c: &Contact| {
            // The weights of either side have the sum 1.
            let sides = c.nodes.iter().zip(&c.weights).map(|(i, w)| w.abs() * self.friction[*i as usize]);
            memory.grip(c, x, c.press.force, 0.5 * sides.sum::<f64>())
        };
        self.friction_contacts = self.contacts.iter().map(grip).collect();
    }

    /// Takes friction away, and gives it back.
    pub fn swap_friction(&mut self) {
        std::mem::swap(&mut self.friction, &mut self.away);
        self.friction_contacts.clear();
    }

    /// Has new friction in place of that which is `replaced`, in the order of the contacts.
    pub(crate) fn take_over(
        &mut self,
        replaced: impl Fn(&FrictionContact) -> bool,
        new: impl Iterator<Item = FrictionContact>,
    ) {
        self.friction_contacts.retain(|g| !replaced(g));
        self.friction_contacts.extend(new);
        self.friction_contacts.sort_by_key(FrictionContact::key);
    }

    /// Drags the anchors of friction along behind cloth that slides.
    pub fn drag(&mut self, x: &[Vec3]) {
        self.friction_contacts.iter_mut().for_each(|g| g.drag(x));
    }

    /// The contacts at `x`, in the order of the pairs.
    #[must_use]
    pub fn touching(&self, x: &[Vec3]) -> Vec<Contact> {
        self.feasible(x).iter().map(|near| self.contact(near, x)).collect()
    }

    /// The pairs that count at `x`, with their closest points.
    fn feasible(&self, x: &[Vec3]) -> Vec<(Pair, Closest)> {
        let near = |p: &Pair| {
            if self.is_tangled(p) {
                return None;
            }
            let c = p.closest(x);
            (c.distance < self.thickness && c.distance > 0.0).then_some((*p, c))
        };
        let near: Vec<(Pair, Closest)> = self.pairs.par_iter().with_min_len(256).filter_map(near).collect();
        let mut keyed: Vec<([u32; 4], usize)> = Vec::new();
        let mut kept = Vec::new();
        for (k, (p, c)) in near.iter().enumerate() {
            if c.inside || self.is_held(p) {
                kept.push(k);
            } else if p.kind == Kind::VertexTriangle {
                keyed.push((p.key(c), k));
            }
        }
        keyed.sort_unstable();
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            let (_, c) = &near[group[0].1];
            // A local minimum is the closest point of every triangle that has it.
            let of = match c.feature {
                Feature::Corner(_) => usize::from(self.corners[group[0].0[1] as usize]),
                _ => 1,
            };
            if group.len() >= of {
                kept.push(group[0].1);
            }
        }
        kept.sort_unstable();
        kept.iter().map(|&k| near[k]).collect()
    }

    fn contact(&self, (p, c): &(Pair, Closest), x: &[Vec3]) -> Contact {
        let full =
            (0..4).map(|i| c.weights[i].abs() * self.stiffness[p.nodes[i] as usize]).sum::<f64>() * 0.25;
        let stiffness = full * self.fading(p, c, x);
        Contact {
            nodes: p.nodes,
            weights: c.weights,
            normal: c.between / c.distance,
            stiffness,
            press: ContactPotential::of(stiffness, self.thickness, c.distance),
        }
    }

    /// The nodes that each contact couples.
    pub fn groups(&self) -> impl Iterator<Item = &[u32; 4]> {
        self.contacts.iter().chain(&self.tangles).map(|c| &c.nodes)
    }

    /// Energy of the contacts at `x`, J.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        pressure(&self.touching(x)) + self.pull(x) + self.held(x)
    }

    /// The same at the step's start, whose contacts are known, J.
    #[must_use]
    pub fn value_at_start(&self, x: &[Vec3]) -> f64 {
        pressure(&self.contacts) + self.pull(x) + self.held(x)
    }

    /// Energy of friction.
    fn held(&self, x: &[Vec3]) -> f64 {
        self.friction_contacts.iter().map(|g| g.rub().value(&g.at(x))).sum()
    }

    /// Energy of what pulls crossings apart.
    fn pull(&self, x: &[Vec3]) -> f64 {
        let one = |c: &Contact| {
            let way = between(&c.nodes, &c.weights, x);
            ContactPotential::spring(c.stiffness, self.thickness, c.normal.dot(&way).min(self.thickness))
                .energy
        };
        self.tangles.iter().map(one).sum()
    }

    /// Adds the derivative at the step's start `x`, N.
    pub fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        for (k, c) in self.contacts.iter().chain(&self.tangles).enumerate() {
            let mut push = c.normal * -c.press.force;
            if let Some(grip) = self.friction_contacts.get(k) {
                push += grip.rub().gradient(&grip.at(x));
            }
            for (i, w) in c.nodes.iter().zip(&c.weights) {
                g[*i as usize] += push * *w;
            }
        }
    }

    /// Adds the matrix at the step's start `x`, N/m.
    pub fn add_matrix(&self, x: &[Vec3], pattern: &Pattern, values: &mut [Matrix3<f64>]) {
        for (k, c) in self.contacts.iter().chain(&self.tangles).enumerate() {
            let mut block = c.normal * c.normal.transpose() * c.press.curvature;
            if let Some(grip) = self.friction_contacts.get(k) {
                block += grip.rub().matrix(&grip.at(x));
            }
            for a in 0..4 {
                for b in 0..=a {
                    let w = c.weights[a] * c.weights[b];
                    if w != 0.0
                        && let Some(slot) = pattern.slot(c.nodes[a], c.nodes[b])
                    {
                        add_at(values, slot, &(block * w));
                    }
                }
            }
        }
    }
}

fn pressure(contacts: &[Contact]) -> f64 {
    contacts.iter().map(|c| c.press.energy).sum()
}
