//! Self-contact: a potential between features of the cloth that are nearer than a thickness.
//!
//! Method: offset geometric contact (Chen et al. 2025). A vertex is in contact with the points of
//! the sheet at which its distance is a local minimum, and an edge with an edge where both closest
//! points lie inside (the feasible pairs), so that nothing is counted twice. Friction is
//! regularised Coulomb friction (see `friction_history`). Cost: one closest-point query per pair.
//! Limit: pairs are found by the caller (see `newton/nearby`).

use crate::contact::friction::FrictionContact;
use crate::energy::Subset;
use crate::linear::{Pattern, add_at};
use crate::statics::forces::contact::Contact;
use crate::statics::forces::contact_potential::ContactPotential;
use crate::statics::forces::force::{Force, Place, of_type};
use crate::statics::forces::friction_history::{FrictionHistory, between};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use toile_geometry::closest::Feature;
use toile_geometry::pair::{Closest, Kind, Pair};

mod intersections;
mod stacked;

pub(crate) use intersections::MERGED;

type Vec3 = Vector3<f64>;

/// Pairs that may touch, their contacts and their friction.
#[derive(Debug, Clone)]
#[cfg_attr(not(toile_without = "self_contact"), derive(Default))]
pub struct SelfContact {
    #[cfg(toile_without = "self_contact")]
    pub(crate) never: std::convert::Infallible,
    /// Distance at which contact begins, m.
    pub thickness: f64,
    /// Mean length of the edges, m.
    pub edge: f64,
    /// Whether many cloths lie on each other (see `self_contact/stacked`).
    pub stacked: bool,
    /// Stiffness at each node, N/m.
    pub stiffness: Vec<f64>,
    /// Coefficient of friction of cloth on cloth at each node; a contact has the mean of its two
    /// sides. Empty where there is none.
    pub friction: Vec<f64>,
    /// The coefficients while friction is disabled.
    pub disabled_friction: Vec<f64>,
    /// Layer in which each node is worn, counted outwards; empty where all are in one layer.
    pub order: Vec<u32>,
    /// How many triangles each node has, to find corners that are local minima.
    pub corners: Vec<u16>,
    /// Pairs that may touch during the step, sorted.
    pub pairs: Vec<Pair>,
    /// Pairs that count as contacts while they are near, sorted; `None` where only local minima
    /// count.
    pub held: Option<Vec<Pair>>,
    /// Pairs in contact at the start of the step.
    pub contacts: Vec<Contact>,
    /// The friction of each contact; empty where there is none.
    pub friction_contacts: Vec<FrictionContact>,
    /// Edges that pass through triangles, as the state of a coarser level may: they are pulled out.
    pub intersections: Vec<Contact>,
    /// Nodes of the intersections: they may pass through each other to get free.
    pub intersecting: Vec<bool>,
}

#[cfg(toile_without = "self_contact")]
impl Default for SelfContact {
    fn default() -> Self {
        std::process::abort()
    }
}

impl SelfContact {
    /// Finds the contacts at `x` and their friction.
    pub fn update_contacts(&mut self, x: &[Vec3]) {
        let counted = self.feasible(x);
        self.contacts = counted.iter().map(|near| self.contact(near, x)).collect();
        self.remember(&counted);
        if self.friction.is_empty() {
            return;
        }
        let mut history = FrictionHistory::of(&self.friction_contacts, x);
        let friction = |c: &Contact| {
            // The weights of either side have the sum 1.
            let sides = c.nodes.iter().zip(&c.weights).map(|(i, w)| w.abs() * self.friction[*i as usize]);
            history.friction_contact(c, x, c.potential.force, 0.5 * sides.sum::<f64>())
        };
        self.friction_contacts = self.contacts.iter().map(friction).collect();
    }

    /// The contacts at `x`, in the order of the pairs.
    #[must_use]
    pub fn touching(&self, x: &[Vec3]) -> Vec<Contact> {
        self.feasible(x).iter().map(|near| self.contact(near, x)).collect()
    }

    /// The pairs in contact at `x`, with their closest points.
    fn feasible(&self, x: &[Vec3]) -> Vec<(Pair, Closest)> {
        let near = |p: &Pair| {
            if self.is_intersecting(p) {
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
            potential: ContactPotential::of(stiffness, self.thickness, c.distance),
        }
    }

    /// Energy of friction, J.
    fn friction_energy(&self, x: &[Vec3]) -> f64 {
        self.friction_contacts.iter().map(|g| g.coulomb().value(&g.at(x))).sum()
    }

    /// Energy of the springs that pull intersections apart, J.
    fn intersection_energy(&self, x: &[Vec3]) -> f64 {
        let one = |c: &Contact| {
            let between = between(&c.nodes, &c.weights, x);
            ContactPotential::spring(c.stiffness, self.thickness, c.normal.dot(&between).min(self.thickness))
                .energy
        };
        self.intersections.iter().map(one).sum()
    }
}

impl Force for SelfContact {
    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn candidates(&self, visit: &mut dyn FnMut(&[u32])) {
        self.pairs.iter().for_each(|p| visit(&p.nodes));
    }

    fn collisions(&self, visit: &mut dyn FnMut(&[u32; 4])) {
        self.contacts.iter().chain(&self.intersections).for_each(|c| visit(&c.nodes));
    }

    fn begin_step(&mut self, at: &Place<'_>) {
        self.update_contacts(at.x);
    }

    fn add_contact_value(&self, at: &Place<'_>, sum: &mut f64) {
        *sum += contact_energy(&self.touching(at.x))
            + self.intersection_energy(at.x)
            + self.friction_energy(at.x);
    }

    fn add_contact_value_at_start(&self, x: &[Vec3], sum: &mut f64) {
        *sum += contact_energy(&self.contacts) + self.intersection_energy(x) + self.friction_energy(x);
    }

    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        for (k, c) in self.contacts.iter().chain(&self.intersections).enumerate() {
            let mut push = c.normal * -c.potential.force;
            if let Some(friction) = self.friction_contacts.get(k) {
                push += friction.coulomb().gradient(&friction.at(x));
            }
            for (i, w) in c.nodes.iter().zip(&c.weights) {
                g[*i as usize] += push * *w;
            }
        }
    }

    fn add_matrix(&self, x: &[Vec3], pattern: &Pattern, values: &mut [Matrix3<f64>]) {
        for (k, c) in self.contacts.iter().chain(&self.intersections).enumerate() {
            let mut block = c.normal * c.normal.transpose() * c.potential.curvature;
            if let Some(friction) = self.friction_contacts.get(k) {
                block += friction.coulomb().matrix(&friction.at(x));
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

    fn end_step(&mut self, x: &[Vec3]) {
        self.friction_contacts.iter_mut().for_each(|c| c.drag_anchor(x));
    }

    fn swap_friction(&mut self) {
        std::mem::swap(&mut self.friction, &mut self.disabled_friction);
        self.friction_contacts.clear();
    }

    fn scale_contact(&mut self, factor: f64) {
        self.stiffness.iter_mut().for_each(|s| *s *= factor);
        self.friction_contacts.iter_mut().for_each(|c| c.memory.load *= factor);
    }

    fn restrict(&self, cut: &Subset) -> Box<dyn Force> {
        let pair = |p: &Pair| Pair { nodes: cut.renumbered(p.nodes), ..*p };
        let held = |h: &Vec<Pair>| {
            let mut held: Vec<Pair> = h.iter().filter(|p| cut.knows(&p.nodes)).map(pair).collect();
            held.sort_unstable();
            held
        };
        // Friction outlives its pair by one step.
        let friction = self.friction_contacts.iter().filter(|c| cut.knows(&c.nodes));
        let renumbered = |c: &FrictionContact| FrictionContact { nodes: cut.renumbered(c.nodes), ..*c };
        Box::new(Self {
            stiffness: cut.pick(&self.stiffness),
            order: cut.pick(&self.order),
            corners: cut.pick(&self.corners),
            friction: cut.pick(&self.friction),
            disabled_friction: cut.pick(&self.disabled_friction),
            friction_contacts: friction.map(renumbered).collect(),
            pairs: self.pairs.iter().filter(|p| cut.touches(&p.nodes)).map(pair).collect(),
            held: self.held.as_ref().map(held),
            contacts: Vec::new(),
            intersections: Vec::new(),
            intersecting: Vec::new(),
            ..*self
        })
    }

    /// Takes over the friction of the subset, in the order of the contacts.
    fn merge(&mut self, cut: &Subset, part: &dyn Force) {
        let Some(part) = of_type::<Self>(part) else { return };
        let whole = |c: &FrictionContact| FrictionContact { nodes: cut.in_whole(c.nodes), ..*c };
        self.friction_contacts.retain(|c| !cut.touches(&c.nodes));
        self.friction_contacts.extend(part.friction_contacts.iter().map(whole));
        self.friction_contacts.sort_by_key(FrictionContact::key);
    }

    fn continue_from(&mut self, before: &dyn Force) {
        if let Some(before) = of_type::<Self>(before) {
            self.pairs.clone_from(&before.pairs);
            self.friction_contacts.clone_from(&before.friction_contacts);
        }
    }
}

/// Energy of contacts, J.
fn contact_energy(contacts: &[Contact]) -> f64 {
    contacts.iter().map(|c| c.potential.energy).sum()
}
