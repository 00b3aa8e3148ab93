//! Subdomain solve: the active nodes of a system as a system of their own, with all others pinned.
//!
//! Method: nonlinear elimination (Lanzkron, Rose, Wilkes 1996). Near rest most of a garment is at
//! rest while a few nodes buckle one after the other. The subdomain has the active nodes and the
//! nodes to which elements, seams and contacts couple them. Cost: a step costs what its nodes cost;
//! O(n) to cut it out. Limits: only the whole system can prove that it is at rest.

use crate::contact::friction::FrictionContact;
use crate::energy::Subset;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::height_springs::HeightSprings;
use crate::statics::forces::seam_force::SeamForce;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::Pair;

type Vec3 = Vector3<f64>;

/// Some nodes of a system as a system of their own.
pub(crate) struct Subdomain<'a> {
    /// The active nodes, and the pinned nodes to which they are coupled.
    pub(crate) system: System<'a>,
    /// Their indices in the whole system, ascending.
    nodes: Vec<u32>,
    cut: Subset,
    /// How many stacked subdomains of the same shape it stands for.
    multiplicity: f64,
}

/// Widens a set of nodes by the elements that they are in, `rings` times.
pub(crate) fn widen(system: &System<'_>, active: &mut [bool], rings: usize) {
    for _ in 0..rings {
        let was = active.to_vec();
        for nodes in system.elastic.faces().iter().filter(|t| t.iter().any(|&i| was[i as usize])) {
            nodes.iter().for_each(|&i| active[i as usize] = true);
        }
    }
}

impl<'a> Subdomain<'a> {
    /// The `active` nodes of a system and the nodes to which they are coupled.
    pub(crate) fn of(system: &System<'a>, active: Vec<bool>) -> Self {
        let included = active.clone();
        Self::with_neighbours(system, active, included)
    }

    /// The same with the `included` nodes, which the active ones may meet.
    pub(crate) fn with_neighbours(system: &System<'a>, active: Vec<bool>, mut included: Vec<bool>) -> Self {
        let mut include = |nodes: &[u32]| {
            if nodes.iter().any(|&i| active[i as usize]) {
                nodes.iter().for_each(|&i| included[i as usize] = true);
            }
        };
        system.elastic.couplings(&mut include);
        system.seam_forces.iter().for_each(|t| include(&t.nodes));
        system.self_contact.iter().flat_map(|c| &c.pairs).for_each(|p| include(&p.nodes));
        let (cut, nodes) = Subset::new(active, &included);
        Self { system: cut_out(system, &cut, &nodes), nodes, cut, multiplicity: 1.0 }
    }

    /// The values of the whole system at the nodes of the subdomain.
    pub(crate) fn pick<T: Clone>(&self, of: &[T]) -> Vec<T> {
        pick(&self.nodes, of)
    }

    /// The tree of its triangles, in which only those of active nodes seek pairs. `layout` is that
    /// of the subdomain.
    pub(crate) fn tree(&self, whole: &ClothTree, layout: &[Vec3]) -> ClothTree {
        let active: Vec<bool> = self.pick(self.cut.active());
        whole.part(&self.nodes, self.cut.index(), layout).with_active(&active)
    }

    /// This subdomain as the lowest of `count` stacked ones of the same shape, so that the cloth
    /// below carries them all. In the forces of one of them, contact and the loads of friction are
    /// smaller by that factor.
    pub(crate) fn standing_for(mut self, count: usize) -> Self {
        self.multiplicity = count as f64;
        self.scale_contact(1.0 / self.multiplicity);
        self
    }

    /// Scales the stiffness of contact and its loads.
    fn scale_contact(&mut self, factor: f64) {
        let scale = |v: &mut [f64]| v.iter_mut().for_each(|s| *s *= factor);
        scale(&mut self.system.loads);
        self.system.body_contact.iter_mut().for_each(|c| scale(&mut c.stiffness));
        self.system.ridges.iter_mut().for_each(|r| r.scale(factor));
        if let Some(c) = &mut self.system.self_contact {
            scale(&mut c.stiffness);
            c.friction_contacts.iter_mut().for_each(|f| f.load *= factor);
        }
    }

    /// The number of its nodes.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Writes positions and the state of contacts back into the whole system.
    pub(crate) fn put_back(mut self, x: &[Vec3], system: &mut System<'a>, whole: &mut [Vec3]) {
        if self.multiplicity != 1.0 {
            self.scale_contact(self.multiplicity);
        }
        put(&self.nodes, x, whole);
        put(&self.nodes, &self.system.anchors, &mut system.anchors);
        put(&self.nodes, &self.system.loads, &mut system.loads);
        put(&self.nodes, &self.system.slides, &mut system.slides);
        if !system.distance_cache.is_empty() && !self.system.distance_cache.is_empty() {
            put(&self.nodes, &self.system.distance_cache, &mut system.distance_cache);
        }
        if let (Some(from), Some(to)) = (&self.system.body_contact, &mut system.body_contact) {
            put(&self.nodes, &from.offsets, &mut to.offsets);
            put(&self.nodes, &from.stiffness, &mut to.stiffness);
        }
        if let (Some(from), Some(to)) = (&self.system.self_contact, &mut system.self_contact) {
            let whole = |c: &FrictionContact| FrictionContact {
                nodes: c.nodes.map(|i| self.nodes[i as usize]),
                ..*c
            };
            to.replace_friction(|c| self.cut.touches(&c.nodes), from.friction_contacts.iter().map(whole));
        }
        if let (Some(from), Some(to)) = (&self.system.ridges, &mut system.ridges) {
            to.merge(&self.cut, &self.nodes, from);
        }
        system.elastic.merge(&self.cut, &self.system.elastic);
    }
}

fn pick<T: Clone>(nodes: &[u32], of: &[T]) -> Vec<T> {
    nodes.iter().filter_map(|&i| of.get(i as usize)).cloned().collect()
}

fn put<T: Clone>(nodes: &[u32], from: &[T], to: &mut [T]) {
    nodes.iter().zip(from).for_each(|(&i, v)| to[i as usize] = v.clone());
}

fn cut_out<'a>(system: &System<'a>, cut: &Subset, nodes: &[u32]) -> System<'a> {
    let is_pinned = |&i: &u32| system.pinned[i as usize] || !cut.active()[i as usize];
    let seam_force = |t: &SeamForce| SeamForce { nodes: cut.renumbered(t.nodes), ..*t };
    System {
        elastic: system.elastic.part(cut),
        masses: pick(nodes, &system.masses),
        gravity: system.gravity,
        push: pick(nodes, &system.push),
        height_springs: system.height_springs.as_ref().map(|h| HeightSprings {
            heights: pick(nodes, &h.heights),
            groups: pick(nodes, &h.groups),
            ..*h
        }),
        pinned: nodes.iter().map(is_pinned).collect(),
        seam_forces: system.seam_forces.iter().filter(|t| cut.touches(&t.nodes)).map(seam_force).collect(),
        body_contact: system.body_contact.as_ref().map(|c| body_contact(c, cut, nodes)),
        ridges: system.ridges.as_ref().map(|r| r.subset(cut, nodes)),
        self_contact: system.self_contact.as_ref().map(|c| self_contact(c, cut, nodes)),
        touches: Vec::new(),
        anchors: pick(nodes, &system.anchors),
        slides: pick(nodes, &system.slides),
        loads: pick(nodes, &system.loads),
        brakes: vec![],
        targets: Vec::new(),
        distance_cache: pick(nodes, &system.distance_cache),
    }
}

fn body_contact<'a>(whole: &BodyContact<'a>, cut: &Subset, nodes: &[u32]) -> BodyContact<'a> {
    let edges = whole.edges.iter().filter(|(e, _)| cut.touches(e) && cut.has_all(e));
    BodyContact {
        body: whole.body,
        friction: pick(nodes, &whole.friction),
        offsets: pick(nodes, &whole.offsets),
        offset: whole.offset,
        depth: whole.depth,
        edges: edges.map(|(e, l)| (cut.renumbered(*e), *l)).collect(),
        keeps_edges_out: whole.keeps_edges_out,
        grows_offsets: whole.grows_offsets,
        stiffens_inside: whole.stiffens_inside,
        lets_through: whole.lets_through,
        stiffness: pick(nodes, &whole.stiffness),
        overloaded: Vec::new(),
        #[cfg(toile_without = "body")]
        never: whole.never,
    }
}

fn self_contact(whole: &SelfContact, cut: &Subset, nodes: &[u32]) -> SelfContact {
    let pair = |p: &Pair| Pair { nodes: cut.renumbered(p.nodes), ..*p };
    let friction = |c: &FrictionContact| FrictionContact { nodes: cut.renumbered(c.nodes), ..*c };
    SelfContact {
        #[cfg(toile_without = "self_contact")]
        never: whole.never,
        thickness: whole.thickness,
        edge: whole.edge,
        stacked: whole.stacked,
        stiffness: pick(nodes, &whole.stiffness),
        order: pick(nodes, &whole.order),
        corners: pick(nodes, &whole.corners),
        friction: pick(nodes, &whole.friction),
        disabled_friction: pick(nodes, &whole.disabled_friction),
        // Friction outlives its pair by one step.
        friction_contacts: whole
            .friction_contacts
            .iter()
            .filter(|c| cut.touches(&c.nodes) && cut.has_all(&c.nodes))
            .map(friction)
            .collect(),
        pairs: whole.pairs.iter().filter(|p| cut.touches(&p.nodes)).map(pair).collect(),
        held: whole
            .held
            .as_ref()
            .map(|h| sorted(h.iter().filter(|p| cut.touches(&p.nodes) && cut.has_all(&p.nodes)).map(pair))),
        contacts: Vec::new(),
        intersections: Vec::new(),
        intersecting: Vec::new(),
    }
}

fn sorted(pairs: impl Iterator<Item = Pair>) -> Vec<Pair> {
    let mut all: Vec<Pair> = pairs.collect();
    all.sort_unstable();
    all
}

#[cfg(test)]
mod tests;
