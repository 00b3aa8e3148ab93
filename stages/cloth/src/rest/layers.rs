//! Cloth against itself: a penalty between features that are nearer than a thickness.
//!
//! Each vertex is pressed away from the points of the sheet where its distance is a local minimum, and edges from edges
//! where both closest points lie inside (offset geometric contact, Chen et al. 2025, names these the feasible pairs), so
//! that nothing is counted twice. What touches rubs, by Coulomb's law (see `grip`).

use super::grip::{Grip, Memory, between};
use super::pattern::{Pattern, Slot, add_at};
use crate::contact::closest::Feature;
use crate::contact::pair::{Closest, Kind, Pair};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

type Vec3 = Vector3<f64>;

/// Pairs that may touch, and how stiffly.
#[derive(Debug, Clone)]
#[cfg_attr(not(toile_without = "self_contact"), derive(Default))]
pub struct Layers {
    #[cfg(toile_without = "self_contact")]
    pub(super) never: std::convert::Infallible,
    /// Distance at which contact begins, m.
    pub thickness: f64,
    /// Stiffness at each node, N/m.
    pub stiffness: Vec<f64>,
    /// Coefficient of friction of cloth on cloth at each node; where two rub, the mean counts. Empty where there is none.
    pub friction: Vec<f64>,
    /// The friction that is taken away for a while.
    pub away: Vec<f64>,
    /// Layer that each node is worn in, the outer ones higher; empty where all are one.
    pub order: Vec<u32>,
    /// Triangles at each node, for corners that are local minima.
    pub corners: Vec<u16>,
    /// Pairs that may touch during the step, sorted.
    pub pairs: Vec<Pair>,
    /// Those that touch at its start.
    pub contacts: Vec<Contact>,
    /// Their friction, one by one; empty where there is none.
    pub grips: Vec<Grip>,
    /// Edges that pass through triangles, as a coarser level's state can have it: pulled back out.
    pub tangles: Vec<Contact>,
    /// Nodes of the tangles: among themselves they may pass through each other to get free.
    pub tangled: Vec<bool>,
}

#[cfg(toile_without = "self_contact")]
impl Default for Layers {
    fn default() -> Self {
        std::process::abort()
    }
}

/// Two features that touch.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Nodes.
    pub nodes: [u32; 4],
    /// Weights of the nodes in the distance.
    pub weights: [f64; 4],
    /// Unit direction from the second to the first.
    pub normal: Vec3,
    /// Distance, m.
    pub distance: f64,
    /// N/m.
    pub stiffness: f64,
}

impl Layers {
    /// Finds the contacts at `x`, and what friction holds of them.
    pub fn touch(&mut self, x: &[Vec3]) {
        self.contacts = self.touching(x);
        if self.friction.is_empty() {
            return;
        }
        let mut memory = Memory::of(&self.grips, x);
        let grip = |c: &Contact| {
            let force = c.stiffness * (self.thickness - c.distance);
            // The weights of either side have the sum 1.
            let sides = c.nodes.iter().zip(&c.weights).map(|(i, w)| w.abs() * self.friction[*i as usize]);
            memory.grip(c, x, force, 0.5 * sides.sum::<f64>())
        };
        self.grips = self.contacts.iter().map(grip).collect();
    }

    /// Takes friction away, and gives it back.
    pub fn swap_friction(&mut self) {
        std::mem::swap(&mut self.friction, &mut self.away);
        self.grips.clear();
    }

    /// Drags the anchors of friction along behind cloth that slides.
    pub fn drag(&mut self, x: &[Vec3]) {
        self.grips.iter_mut().for_each(|g| g.drag(x));
    }

    /// The contacts at `x`, in the order of the pairs.
    #[must_use]
    pub fn touching(&self, x: &[Vec3]) -> Vec<Contact> {
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
            if p.kind == Kind::EdgeEdge {
                if c.inside {
                    kept.push(k);
                }
            } else if c.inside {
                kept.push(k);
            } else {
                keyed.push((p.key(c), k));
            }
        }
        keyed.sort_unstable();
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            let (p, c) = &near[group[0].1];
            // A local minimum is the closest point of every triangle that has it.
            let of = match c.feature {
                Feature::Corner(_) => usize::from(self.corners[group[0].0[1] as usize]),
                _ => 1,
            };
            if group.len() >= of && p.kind == Kind::VertexTriangle {
                kept.push(group[0].1);
            }
        }
        kept.sort_unstable();
        kept.iter().map(|&k| self.contact(&near[k])).collect()
    }

    fn contact(&self, (p, c): &(Pair, Closest)) -> Contact {
        let stiffness =
            (0..4).map(|i| c.weights[i].abs() * self.stiffness[p.nodes[i] as usize]).sum::<f64>() * 0.25;
        Contact {
            nodes: p.nodes,
            weights: c.weights,
            normal: c.between / c.distance,
            distance: c.distance,
            stiffness,
        }
    }

    /// The nodes that each contact couples.
    pub fn groups(&self) -> impl Iterator<Item = &[u32]> {
        self.contacts.iter().chain(&self.tangles).map(|c| &c.nodes[..])
    }

    /// Takes up the crossings of `x`: the end of each edge that has gone through least is pulled back to the other side.
    pub fn untangle(&mut self, crossings: &[([u32; 2], [u32; 3])], x: &[Vec3]) {
        self.tangled = vec![false; if crossings.is_empty() { 0 } else { x.len() }];
        for (e, t) in crossings {
            e.iter().chain(t).for_each(|&i| self.tangled[i as usize] = true);
        }
        self.tangles = crossings.iter().filter_map(|(e, t)| self.tangle(*e, *t, x)).collect();
    }

    fn tangle(&self, e: [u32; 2], t: [u32; 3], x: &[Vec3]) -> Option<Contact> {
        let [a, b, c] = t.map(|v| x[v as usize]);
        let up = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let height = |v: u32| up.dot(&(x[v as usize] - a));
        let (shallow, normal) = match self.side(&e, &t) {
            // The order of the layers tells which end is on the wrong side.
            Some(side) => (if side * height(e[0]) < side * height(e[1]) { e[0] } else { e[1] }, up * side),
            None => {
                let [shallow, deep] = if height(e[0]).abs() < height(e[1]).abs() { e } else { [e[1], e[0]] };
                (shallow, if height(deep) > 0.0 { up } else { -up })
            }
        };
        let on = crate::contact::closest::on_triangle(&x[shallow as usize], &[a, b, c]);
        let nodes = [shallow, t[0], t[1], t[2]];
        let weights = [1.0, -on.weights[0], -on.weights[1], -on.weights[2]];
        let distance = normal.dot(&(x[shallow as usize] - on.point));
        let stiffness = 0.5 * self.stiffness[shallow as usize];
        Some(Contact { nodes, weights, normal, distance, stiffness })
    }

    /// On which side of a triangle an edge of another layer belongs: 1 outside, -1 inside; nothing where they are one layer.
    fn side(&self, e: &[u32; 2], t: &[u32; 3]) -> Option<f64> {
        let of = |v: &u32| self.order.get(*v as usize).copied();
        let one = |nodes: &[u32]| {
            nodes.first().and_then(of).filter(|first| nodes.iter().all(|v| of(v) == Some(*first)))
        };
        match one(e)?.cmp(&one(t)?) {
            std::cmp::Ordering::Greater => Some(1.0),
            std::cmp::Ordering::Less => Some(-1.0),
            std::cmp::Ordering::Equal => None,
        }
    }

    /// Crossings of cloth of one layer, which no order resolves.
    #[must_use]
    pub fn unordered(&self, crossings: &[([u32; 2], [u32; 3])]) -> usize {
        crossings.iter().filter(|(e, t)| self.side(e, t).is_none()).count()
    }

    /// Whether the pair lies among tangled nodes only.
    #[must_use]
    pub fn is_tangled(&self, pair: &Pair) -> bool {
        !self.tangled.is_empty() && pair.nodes.iter().all(|&i| self.tangled[i as usize])
    }

    /// Energy of the contacts at `x`, J.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        self.pressure(&self.touching(x)) + self.pull(x) + self.held(x)
    }

    /// The same at the step's start, whose contacts are known, J.
    #[must_use]
    pub fn value_at_start(&self, x: &[Vec3]) -> f64 {
        self.pressure(&self.contacts) + self.pull(x) + self.held(x)
    }

    /// Energy of friction.
    fn held(&self, x: &[Vec3]) -> f64 {
        self.grips.iter().map(|g| g.rub().value(&g.at(x))).sum()
    }

    fn pressed(&self, c: &Contact, distance: f64) -> f64 {
        0.5 * c.stiffness * (self.thickness - distance).powi(2)
    }

    fn pressure(&self, contacts: &[Contact]) -> f64 {
        contacts.iter().map(|c| self.pressed(c, c.distance)).sum()
    }

    /// Energy of what pulls crossings apart.
    fn pull(&self, x: &[Vec3]) -> f64 {
        let one = |c: &Contact| {
            let way = between(&c.nodes, &c.weights, x);
            self.pressed(c, c.normal.dot(&way).min(self.thickness))
        };
        self.tangles.iter().map(one).sum()
    }

    /// Adds the derivative at the step's start `x`, N.
    pub fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        for (k, c) in self.contacts.iter().chain(&self.tangles).enumerate() {
            let mut push = c.normal * (c.stiffness * (c.distance - self.thickness));
            if let Some(grip) = self.grips.get(k) {
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
            let mut block = c.normal * c.normal.transpose() * c.stiffness;
            if let Some(grip) = self.grips.get(k) {
                block += grip.rub().matrix(&grip.at(x));
            }
            for a in 0..4 {
                for b in 0..=a {
                    let w = c.weights[a] * c.weights[b];
                    if w != 0.0 {
                        let slot = pattern
                            .slot(c.nodes[a], c.nodes[b])
                            .unwrap_or(Slot { index: c.nodes[a], flipped: false });
                        add_at(values, slot, &(block * w));
                    }
                }
            }
        }
    }
}
