//! The part of a system that still moves, by itself: sleeping nodes hold still.
//!
//! Near rest most of a garment sleeps while a few nodes buckle one after the other. A step that
//! moves only these, and the elements about them, costs what they cost (nonlinear elimination:
//! Lanzkron, Rose, Wilkes 1996). The whole system looks again afterwards, so the state of rest is
//! that of the whole.

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
    /// The awake nodes and those around them, which are pinned.
    pub(crate) system: System<'a>,
    /// Which nodes these are of the whole, ascending.
    nodes: Vec<u32>,
    cut: Subset,
    /// How many such parts, one on the other, it stands for.
    bundle: f64,
}

/// Widens a set of nodes by the elements they are in, so many times.
pub(crate) fn widen(system: &System<'_>, active: &mut [bool], rings: usize) {
    for _ in 0..rings {
        let was = active.to_vec();
        for nodes in system.elastic.faces().iter().filter(|t| t.iter().any(|&i| was[i as usize])) {
            nodes.iter().for_each(|&i| active[i as usize] = true);
        }
    }
}

impl<'a> Subdomain<'a> {
    /// The `awake` nodes of a system, and what holds them.
    pub(crate) fn of(system: &System<'a>, active: Vec<bool>) -> Self {
        let seen = active.clone();
        Self::beside(system, active, seen)
    }

    /// The same with all that is `seen` from them besides: what they may meet on their way.
    pub(crate) fn beside(system: &System<'a>, active: Vec<bool>, mut seen: Vec<bool>) -> Self {
        let mut see = |nodes: &[u32]| {
            if nodes.iter().any(|&i| active[i as usize]) {
                nodes.iter().for_each(|&i| seen[i as usize] = true);
            }
        };
        system.elastic.couplings(&mut see);
        system.seam_forces.iter().for_each(|t| see(&t.nodes));
        system.self_contact.iter().flat_map(|c| &c.pairs).for_each(|p| see(&p.nodes));
        let (cut, nodes) = Subset::new(active, &seen);
        Self { system: cut_out(system, &cut, &nodes), nodes, cut, bundle: 1.0 }
    }

    /// Values of the whole at the part's nodes.
    pub(crate) fn pick<T: Clone>(&self, of: &[T]) -> Vec<T> {
        pick(&self.nodes, of)
    }

    /// The tree of its triangles, of which only those of awake nodes look for what they may meet.
    /// `layout` is that of the part.
    pub(crate) fn tree(&self, whole: &ClothTree, layout: &[Vec3]) -> ClothTree {
        let active: Vec<bool> = self.pick(self.cut.active());
        whole.part(&self.nodes, self.cut.index(), layout).with_active(&active)
    }

    /// This part, to stand for so many of one shape, one on the other, of which it is the lowest:
    /// what lies under it carries them all. Told in the forces of one: contact is softer by that
    /// number, and so is what presses for friction.
    pub(crate) fn standing_for(mut self, count: usize) -> Self {
        self.bundle = count as f64;
        self.scale_contact(1.0 / self.bundle);
        self
    }

    /// Scales contact and its loads.
    fn scale_contact(&mut self, factor: f64) {
        let scale = |v: &mut [f64]| v.iter_mut().for_each(|s| *s *= factor);
        scale(&mut self.system.loads);
        self.system.body_contact.iter_mut().for_each(|s| scale(&mut s.stiffness));
        self.system.ridges.iter_mut().for_each(|r| r.scale(factor));
        if let Some(c) = &mut self.system.self_contact {
            scale(&mut c.stiffness);
            c.friction_contacts.iter_mut().for_each(|f| f.load *= factor);
        }
    }

    /// How many nodes it has.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Puts places and what the part has learnt of contacts back into the whole.
    pub(crate) fn put_back(mut self, x: &[Vec3], system: &mut System<'a>, whole: &mut [Vec3]) {
        if self.bundle != 1.0 {
            self.scale_contact(self.bundle);
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
            let grip = |g: &FrictionContact| FrictionContact {
                nodes: g.nodes.map(|i| self.nodes[i as usize]),
                ..*g
            };
            to.replace_friction(|g| self.cut.touches(&g.nodes), from.friction_contacts.iter().map(grip));
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
    let asleep = |&i: &u32| system.pinned[i as usize] || !cut.active()[i as usize];
    let thread = |t: &SeamForce| SeamForce { nodes: cut.renumbered(t.nodes), ..*t };
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
        pinned: nodes.iter().map(asleep).collect(),
        seam_forces: system.seam_forces.iter().filter(|t| cut.touches(&t.nodes)).map(thread).collect(),
        body_contact: system.body_contact.as_ref().map(|s| body_contact(s, cut, nodes)),
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
        clear: whole.clear,
        grows: whole.grows,
        hard: whole.hard,
        passes: whole.passes,
        stiffness: pick(nodes, &whole.stiffness),
        overloaded: Vec::new(),
        #[cfg(toile_without = "body")]
        never: whole.never,
    }
}

fn self_contact(whole: &SelfContact, cut: &Subset, nodes: &[u32]) -> SelfContact {
    let pair = |p: &Pair| Pair { nodes: cut.renumbered(p.nodes), ..*p };
    let grip = |g: &FrictionContact| FrictionContact { nodes: cut.renumbered(g.nodes), ..*g };
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
        // A grip outlives its pair by the step that parts them.
        friction_contacts: whole
            .friction_contacts
            .iter()
            .filter(|g| cut.touches(&g.nodes) && cut.has_all(&g.nodes))
            .map(grip)
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
