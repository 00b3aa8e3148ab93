//! Contact of cloth with the body, and its friction.
//!
//! Method: a quadratic penalty within a thickness of the surface, so that vertices rest outside it,
//! and regularised Coulomb friction from an anchor of each node (see `contact/coulomb`). Anchors
//! move along while the cloth moves fast. Normals and limits of friction are those of the start of
//! the step. Cost: one distance query per node that may be near. Limits: see `clearance` for what
//! lies between vertices, and `ridges` for sharp features.

use crate::contact::coulomb::{Coulomb, FrictionMemory};
use crate::energy::Subset;
use crate::linear::Pattern;
use crate::statics::forces::distance_query::{ContactQuery, DistanceCache};
use crate::statics::forces::force::{Force, Place, of_type};
use nalgebra::{Matrix3, Vector3};

mod guard;
mod offsets;
mod query;

type Vec3 = Vector3<f64>;

/// Distance, as a share of the offset, within which a node that has just come near carries its
/// weight.
const FIRST: f64 = 1.1;

/// A node in contact with the body.
#[derive(Debug, Clone, Copy)]
pub struct BodyTouch {
    /// The node.
    pub node: u32,
    /// Outward normal of the body at the contact.
    pub normal: Vec3,
    /// Contact force, N.
    pub force: f64,
}

/// Contact of the nodes with the body.
#[derive(Debug, Clone)]
pub struct BodyContact {
    /// Coefficient of friction, per node.
    pub friction: Vec<f64>,
    /// The coefficients while friction is disabled.
    pub disabled_friction: Vec<f64>,
    /// Distance at which contact begins, per node, m.
    pub offsets: Vec<f64>,
    /// The least of them, m.
    pub offset: f64,
    /// How deep inside the body a node is still pushed out, m.
    pub depth: f64,
    /// Edges of the sheet and their rest lengths: an edge between two nodes on a curved body dips
    /// below them.
    pub edges: Vec<([u32; 2], f64)>,
    /// Edges that lie over an edge of the body, sorted: `ridges` keeps them off it.
    pub bridges: Vec<[u32; 2]>,
    /// Whether edges must stay outside the body, too; otherwise they may dip into it as far as
    /// keeps the girth right.
    pub keeps_edges_out: bool,
    /// Whether the offset of overloaded nodes grows until contact carries them.
    pub grows_offsets: bool,
    /// Whether contact becomes stiffer at nodes inside the body until they are outside: cloth that
    /// is sewn through a body may be too tight to come out otherwise.
    pub stiffens_inside: bool,
    /// Whether moves may lead into the body, which then pushes the cloth out.
    pub lets_through: bool,
    /// Stiffness of contact, N/m per node.
    pub stiffness: Vec<f64>,
    /// Nodes that pressed harder than their contact can carry in the last step.
    pub overloaded: Vec<u32>,
    /// Nodes in contact at the start of the step.
    pub touches: Vec<BodyTouch>,
    /// The friction of each node in contact.
    pub memory: Vec<Option<FrictionMemory>>,
    /// Tangential displacement with which the friction of each node begins at its first contact, as
    /// the coarser level found it, m.
    pub slides: Vec<Vec3>,
    /// The last known distance of each node from the body; empty before the first step.
    pub distance_cache: Vec<DistanceCache>,
    #[cfg(toile_without = "body")]
    pub(crate) never: std::convert::Infallible,
}

impl BodyContact {
    /// The tangential displacement of each node from its anchor at `x`, m.
    pub(crate) fn displacements(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut slides = vec![Vec3::zeros(); x.len()];
        self.rubs().for_each(|(i, r)| slides[i] = r.displacement(&x[i]));
        slides
    }

    /// Whether there is no friction.
    pub(crate) fn is_frictionless(&self) -> bool {
        self.friction.iter().all(|f| *f == 0.0)
    }

    /// The nodes with friction, and that friction.
    fn rubs(&self) -> impl Iterator<Item = (usize, Coulomb)> + '_ {
        self.touches.iter().filter_map(move |t| {
            let node = t.node as usize;
            let memory = self.memory[node].filter(|_| self.friction[node] > 0.0)?;
            Some((node, memory.coulomb(t.normal, self.friction[node])))
        })
    }

    fn friction_energy(&self, x: &[Vec3]) -> f64 {
        self.rubs().map(|(i, r)| r.value(&x[i])).sum()
    }

    /// Finds the nodes in contact, their forces and their friction.
    fn find_touches(&mut self, at: &Place<'_>) {
        self.touches.clear();
        for (i, (_, near)) in at.on_body.iter().enumerate() {
            let before = self.memory[i].take();
            let Some(n) = near else { continue };
            if self.stiffens_inside && n.distance < 0.0 {
                self.overloaded.push(i as u32);
            }
            let force = self.stiffness[i] * (self.offsets[i] - n.distance).max(0.0);
            // A node that has just come into contact will carry at least its weight.
            let weight = -at.loads.masses[i] * at.loads.gravity.dot(&n.normal);
            let first = if n.distance < FIRST * self.offsets[i] { force.max(weight) } else { force };
            let load = before.map_or(first, |m| m.mean_load(force));
            if force > 0.0 || load > 0.0 {
                let start = || at.x[i] - std::mem::take(&mut self.slides[i]);
                let anchor = before.map_or_else(start, |m| m.anchor);
                self.memory[i] = Some(FrictionMemory { anchor, load });
                self.touches.push(BodyTouch { node: i as u32, normal: n.normal, force });
            }
        }
    }
}

impl Force for BodyContact {
    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn begin_step(&mut self, at: &Place<'_>) {
        self.distance_cache.clear();
        self.distance_cache.extend(at.on_body.iter().map(|(cached, _)| *cached));
        self.stiffen_overloaded();
        if !self.lets_through {
            self.allow_for_sag(at.on_body, at.x);
        }
        self.find_touches(at);
    }

    fn add_contact_value(&self, at: &Place<'_>, sum: &mut f64) {
        let penalty = |((n, o), k): ((&ContactQuery, &f64), &f64)| {
            n.1.as_ref().map_or(0.0, |n| 0.5 * k * (o - n.distance).max(0.0).powi(2))
        };
        *sum += at.on_body.iter().zip(&self.offsets).zip(&self.stiffness).map(penalty).sum::<f64>();
        *sum += self.friction_energy(at.x);
    }

    fn add_contact_value_at_start(&self, x: &[Vec3], sum: &mut f64) {
        let penalty = |t: &BodyTouch| 0.5 * t.force * t.force / self.stiffness[t.node as usize];
        *sum += self.touches.iter().filter(|t| t.force > 0.0).map(penalty).sum::<f64>();
        *sum += self.friction_energy(x);
    }

    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        self.touches.iter().for_each(|t| g[t.node as usize] -= t.normal * t.force);
        self.rubs().for_each(|(i, r)| g[i] += r.gradient(&x[i]));
    }

    fn add_matrix(&self, x: &[Vec3], _: &Pattern, values: &mut [Matrix3<f64>]) {
        for t in self.touches.iter().filter(|t| t.force > 0.0) {
            values[t.node as usize] += t.normal * t.normal.transpose() * self.stiffness[t.node as usize];
        }
        self.rubs().for_each(|(i, r)| values[i] += r.matrix(&x[i]));
    }

    fn end_step(&mut self, x: &[Vec3]) {
        for t in &self.touches {
            let node = t.node as usize;
            if let Some(memory) = self.memory[node].as_mut().filter(|_| self.friction[node] > 0.0) {
                memory.anchor = memory.coulomb(t.normal, self.friction[node]).dragged(&x[node]);
            }
        }
    }

    fn swap_friction(&mut self) {
        std::mem::swap(&mut self.friction, &mut self.disabled_friction);
        self.memory.fill(None);
    }

    fn scale_contact(&mut self, factor: f64) {
        self.stiffness.iter_mut().for_each(|s| *s *= factor);
        self.memory.iter_mut().flatten().for_each(|m| m.load *= factor);
    }

    fn restrict(&self, cut: &Subset) -> Box<dyn Force> {
        let edges = self.edges.iter().filter(|(e, _)| cut.knows(e));
        Box::new(Self {
            friction: cut.pick(&self.friction),
            disabled_friction: cut.pick(&self.disabled_friction),
            offsets: cut.pick(&self.offsets),
            edges: edges.map(|(e, l)| (cut.renumbered(*e), *l)).collect(),
            bridges: Vec::new(),
            stiffness: cut.pick(&self.stiffness),
            overloaded: Vec::new(),
            touches: Vec::new(),
            memory: cut.pick(&self.memory),
            slides: cut.pick(&self.slides),
            distance_cache: cut.pick(&self.distance_cache),
            ..*self
        })
    }

    fn merge(&mut self, cut: &Subset, part: &dyn Force) {
        let Some(part) = of_type::<Self>(part) else { return };
        cut.put(&part.memory, &mut self.memory);
        cut.put(&part.slides, &mut self.slides);
        if !self.distance_cache.is_empty() && !part.distance_cache.is_empty() {
            cut.put(&part.distance_cache, &mut self.distance_cache);
        }
        cut.put(&part.offsets, &mut self.offsets);
        cut.put(&part.stiffness, &mut self.stiffness);
    }

    fn continue_from(&mut self, before: &dyn Force) {
        let Some(before) = of_type::<Self>(before) else { return };
        self.memory.clone_from(&before.memory);
        self.distance_cache.clone_from(&before.distance_cache);
        self.offsets.iter_mut().zip(&before.offsets).for_each(|(new, old)| *new = new.max(*old));
    }
}

#[cfg(test)]
mod tests;
