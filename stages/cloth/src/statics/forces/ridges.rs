//! Cloth against the body's sharp edges and corners: edges of the cloth against edges of the body,
//! corners against triangles.
//!
//! A contact is a place where the distance of cloth and feature is a local minimum: inside both
//! edges, or inside the triangle (or on one of its sides, where no triangle of the side is nearer),
//! on the outer side of the feature (the pairs that Chen et al. 2025 name feasible). It presses as
//! cloth presses on cloth (see `contact_potential`), so that no load brings the two together.
//! Friction is regularised Coulomb friction; the tangential displacement of each contact is kept
//! from step to step. Moves end before cloth passes a feature (`ridges/limit`). A coarser mesh may
//! leave cloth that the body passes through: that cloth is pushed back out over the nearest
//! feature.
//!
//! Cost: a search for pairs when the cloth has moved by more than a thickness; nothing for a body
//! without sharp features.

use crate::contact::collision_surface::CollisionSurface;
use crate::contact::coulomb::{Coulomb, FrictionMemory, mean_by_load};
use crate::energy::Subset;
use crate::linear::{Pattern, add_at};
use crate::mesh::Sheet;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::contact_potential::ContactPotential;
use crate::statics::forces::distance_query::NUDGE;
use crate::statics::forces::force::{Force, Place, of_type};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::pair::Kind;
use toile_geometry::sharp::{Sharp, Side};

mod limit;

type Vec3 = Vector3<f64>;

/// How far beyond one thickness pairs are sought, in thicknesses. The pairs stay valid until the
/// cloth has moved that far.
const SLACK: f64 = 1.5;

/// Cloth that is farther than this from every feature is not checked again until it has moved that
/// far, m.
const FAR: f64 = 0.03;

/// Edges or triangles per parallel task.
const CHUNK: usize = 512;

/// Greatest depth behind a feature from which cloth is pushed back over it, as a share of its
/// longest edge.
const DEEPEST: f64 = 0.5;

/// An edge of the cloth, or a triangle of it, and a feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Pair {
    /// Which feature.
    feature: u32,
    /// Nodes; of an edge the last one twice.
    nodes: [u32; 3],
}

/// Where the two come nearest.
#[derive(Debug, Clone, Copy)]
struct Near {
    /// From the feature to the cloth.
    off: Vec3,
    distance: f64,
    /// Weights of the nodes in the cloth's closest point.
    weights: [f64; 3],
    /// Whether it lies inside both.
    inside: bool,
}

/// A contact between the cloth and a feature.
#[derive(Debug, Clone, Copy)]
struct Contact {
    pair: Pair,
    weights: [f64; 3],
    /// Unit direction in which the feature presses.
    normal: Vec3,
    potential: ContactPotential,
    friction: f64,
    memory: FrictionMemory,
    /// Tangential displacement at the start of the step, m.
    slid: Vec3,
}

/// The sharp features and the cloth about them.
#[derive(Debug, Clone)]
pub struct Ridges {
    sharp: Arc<Sharp>,
    edges: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
    /// Distance at which contact begins, m.
    thickness: f64,
    /// Longest edge, m.
    longest: f64,
    /// Stiffness at each node, N/m.
    stiffness: Vec<f64>,
    /// Coefficient of friction at each node.
    friction: Vec<f64>,
    /// The coefficients while friction is disabled.
    disabled_friction: Vec<f64>,
    /// Pairs that may touch, sorted.
    pairs: Vec<Pair>,
    /// Where the nodes were when the pairs were sought; `None` where the pairs hold for one step
    /// only.
    at: Option<Vec<Vec3>>,
    /// How far they may move from there, m.
    slack: f64,
    /// Pairs whose cloth the body passes through, sorted.
    pierced: Vec<Pair>,
    contacts: Vec<Contact>,
}

/// An edge of the cloth or a corner of the body: each is pushed out over one feature only.
type Part = [u32; 3];

impl Pair {
    fn part(&self) -> Part {
        if self.count() == 2 { self.nodes } else { [u32::MAX, u32::MAX, self.feature] }
    }

    fn count(&self) -> usize {
        if self.nodes[1] == self.nodes[2] { 2 } else { 3 }
    }

    /// The cloth and the feature in the order of the pair of features that they are.
    fn places(&self, sharp: &Sharp, x: &[Vec3]) -> (Kind, [Vec3; 4]) {
        let f = sharp.feature(self.feature);
        let [a, b, c] = self.nodes.map(|i| x[i as usize]);
        match f.kind {
            Kind::EdgeEdge => (f.kind, [a, b, f.ends[0], f.ends[1]]),
            Kind::VertexTriangle => (f.kind, [f.ends[0], a, b, c]),
        }
    }

    fn near(&self, sharp: &Sharp, x: &[Vec3]) -> Near {
        let (kind, places) = self.places(sharp, x);
        let c = kind.closest(&places);
        let (off, weights) = match kind {
            Kind::EdgeEdge => (c.between, [c.weights[0], c.weights[1], 0.0]),
            Kind::VertexTriangle => (-c.between, [-c.weights[1], -c.weights[2], -c.weights[3]]),
        };
        Near { off, distance: c.distance, weights, inside: c.inside }
    }
}

impl Near {
    /// The two nodes between which the closest point lies, if it lies on a side of the triangle.
    fn side(&self, nodes: &[u32; 3]) -> Option<[u32; 2]> {
        let mut on = (0..3).filter(|&k| self.weights[k] > 0.0).map(|k| nodes[k]);
        match (on.next(), on.next(), on.next()) {
            (Some(a), Some(b), None) => Some([a.min(b), a.max(b)]),
            _ => None,
        }
    }
}

impl Contact {
    fn nodes(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.pair.nodes.iter().copied().zip(self.weights).take(self.pair.count())
    }

    fn point(&self, x: &[Vec3]) -> Vec3 {
        self.nodes().map(|(i, w)| x[i as usize] * w).sum()
    }

    fn coulomb(&self) -> Option<Coulomb> {
        Some(self.memory.coulomb(self.normal, self.friction)).filter(|c| c.limit > 0.0)
    }

    fn friction_energy(&self, x: &[Vec3]) -> f64 {
        self.coulomb().map_or(0.0, |r| r.value(&self.point(x)))
    }
}

impl Ridges {
    /// The sharp features of a body, and the sheet that lies on it with `body_contact`; `None`
    /// where the body has none.
    pub(crate) fn new(
        body: &dyn CollisionSurface,
        body_contact: &BodyContact,
        sheet: &Sheet,
    ) -> Option<Self> {
        Some(Self {
            sharp: body.sharp()?,
            edges: sheet.distinct_edges().map(|(ends, _)| ends).collect(),
            triangles: sheet.triangles().to_vec(),
            thickness: body_contact.offset,
            longest: sheet.edges().iter().map(|e| e.rest_length).fold(0.0, f64::max),
            stiffness: body_contact.stiffness.clone(),
            friction: body_contact.friction.clone(),
            disabled_friction: vec![0.0; body_contact.friction.len()],
            pairs: Vec::new(),
            at: None,
            slack: 0.0,
            pierced: Vec::new(),
            contacts: Vec::new(),
        })
    }

    /// Makes the pairs valid for `moves` from `x`. Where they are new, returns the edges of the
    /// cloth that lie over edges of the body, sorted.
    pub(crate) fn seek(&mut self, x: &[Vec3], moves: &[Vec3]) -> Option<Vec<[u32; 2]>> {
        let most = self.slack * self.slack;
        let stays = |((a, p), m): ((&Vec3, &Vec3), &Vec3)| (p + m - a).norm_squared() < most;
        if self.at.as_ref().is_some_and(|at| at.iter().zip(x).zip(moves).all(stays)) {
            return None;
        }
        if self.pairs.is_empty() {
            // Most garments meet no sharp feature on most of their way.
            if self.is_far(x, moves) {
                self.at = None;
                return None;
            }
            self.seek_within(x, moves, FAR);
            if self.pairs.is_empty() {
                return Some(Vec::new());
            }
        }
        self.seek_within(x, moves, SLACK * self.thickness);
        Some(self.bridges())
    }

    fn seek_within(&mut self, x: &[Vec3], moves: &[Vec3], slack: f64) {
        let is_short = moves.iter().all(|m| m.norm_squared() < 0.25 * slack * slack);
        (self.at, self.slack) = (is_short.then(|| x.to_vec()), slack);
        let reach = self.thickness + slack;
        self.pairs = match is_short {
            true => self.pairs_about(x, &vec![Vec3::zeros(); x.len()], reach),
            false => self.pairs_about(x, moves, reach),
        };
    }

    /// The edges of the cloth among the pairs, sorted.
    fn bridges(&self) -> Vec<[u32; 2]> {
        let edges = self.pairs.iter().filter(|p| p.count() == 2).map(|p| [p.nodes[0], p.nodes[1]]);
        let mut bridges: Vec<[u32; 2]> = edges.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        bridges.sort_unstable();
        bridges.dedup();
        bridges
    }

    /// Whether the whole cloth stays away from every feature on its way.
    fn is_far(&self, x: &[Vec3], moves: &[Vec3]) -> bool {
        let nothing = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        let (low, high) = x.iter().zip(moves).fold(nothing, |(low, high), (p, m)| {
            let end = p + m;
            (low.inf(p).inf(&end), high.sup(p).sup(&end))
        });
        let reach = Vec3::repeat(self.thickness + SLACK * self.thickness);
        !self.sharp.meets(&(low - reach), &(high + reach))
    }

    /// Pairs that may come nearer than `reach` on the way, sorted.
    fn pairs_about(&self, x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<Pair> {
        let reach = Vec3::repeat(reach);
        let search = |kind: Kind, nodes: [u32; 3]| {
            let (mut low, mut high) = (x[nodes[0] as usize], x[nodes[0] as usize]);
            for i in nodes {
                let (p, q) = (x[i as usize], x[i as usize] + moves[i as usize]);
                (low, high) = (low.inf(&p).inf(&q), high.sup(&p).sup(&q));
            }
            let mut found = Vec::new();
            self.sharp
                .within(kind, &(low - reach), &(high + reach), |feature| found.push(Pair { feature, nodes }));
            found
        };
        let edges = self.edges.par_iter().with_min_len(CHUNK);
        let mut pairs: Vec<Pair> =
            edges.flat_map_iter(|[a, b]| search(Kind::EdgeEdge, [*a, *b, *b])).collect();
        let triangles = self.triangles.par_iter().with_min_len(CHUNK);
        pairs.par_extend(triangles.flat_map_iter(|t| search(Kind::VertexTriangle, *t)));
        pairs.sort_unstable();
        pairs
    }

    /// Finds cloth that the body passes through at `x`. Each such edge and corner is then pushed
    /// back over the nearest feature.
    pub(crate) fn find_pierced(&mut self, body: &dyn CollisionSurface, x: &[Vec3]) {
        let deepest = self.deepest();
        let pairs = self.pairs_about(x, &vec![Vec3::zeros(); x.len()], deepest);
        self.pierced = self.sunk(body, &pairs, x, deepest).into_iter().map(|p| p.1).collect();
        self.pierced.sort_unstable();
    }

    /// Adds cloth that the body has passed through since: cloth that goes around the end of a
    /// feature may sink behind another.
    fn find_newly_pierced(&mut self, body: &dyn CollisionSurface, x: &[Vec3]) {
        let known: Vec<Part> = self.pierced.iter().map(Pair::part).collect();
        let sunk = self.sunk(body, &self.pairs, x, self.thickness);
        self.pierced.extend(sunk.into_iter().filter(|(part, _)| !known.contains(part)).map(|p| p.1));
        self.pierced.sort_unstable();
    }

    /// The pairs whose cloth lies inside the body, behind the feature by less than `deepest`: the
    /// nearest of each part.
    fn sunk(
        &self,
        body: &dyn CollisionSurface,
        pairs: &[Pair],
        x: &[Vec3],
        deepest: f64,
    ) -> Vec<(Part, Pair)> {
        let near = |p: &Pair| {
            let near = p.near(&self.sharp, x);
            let is_in = near.inside
                && near.distance < deepest
                && self.sharp.feature(p.feature).side(&near.off) == Side::In;
            is_in.then_some((*p, near))
        };
        let hidden: Vec<(Pair, Near)> = pairs.iter().filter_map(near).collect();
        if hidden.is_empty() {
            return Vec::new();
        }
        let point = |(p, n): &(Pair, Near)| {
            (0..p.count()).map(|k| x[p.nodes[k] as usize] * n.weights[k]).sum::<Vec3>()
        };
        let points: Vec<Vec3> = hidden.iter().map(point).collect();
        let inside = body.nearest(&points, &vec![deepest; points.len()]);
        let sunk = hidden.iter().zip(inside).filter(|(_, n)| n.is_some_and(|n| n.distance < 0.0));
        let mut by_part: Vec<(Part, f64, Pair)> =
            sunk.map(|((p, n), _)| (p.part(), n.distance, *p)).collect();
        by_part.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        by_part.dedup_by_key(|p| p.0);
        by_part.into_iter().map(|p| (p.0, p.2)).collect()
    }

    /// Whether the body passes through the cloth at `x` near a feature: through its triangles, or
    /// because an edge of the cloth leads into the body. The second finds a thin plate, where the
    /// side of a feature does not decide.
    pub(crate) fn is_pierced(&self, body: &dyn CollisionSurface, x: &[Vec3]) -> bool {
        let pairs = self.pairs_about(x, &vec![Vec3::zeros(); x.len()], self.deepest());
        !leads_in(body, &pairs, x).is_empty() || !self.sunk(body, &pairs, x, self.deepest()).is_empty()
    }

    /// Greatest depth behind a feature from which cloth is pushed back over it, m.
    fn deepest(&self) -> f64 {
        (DEEPEST * self.longest).max(2.0 * self.thickness)
    }

    /// The pairs in contact at `x`, with their distance, negative where the body passes through the
    /// cloth.
    fn feasible(&self, x: &[Vec3]) -> Vec<(Pair, Near, f64)> {
        let mut found: Vec<(Pair, Near, f64)> = Vec::new();
        let mut on_sides: Vec<(Pair, Near)> = Vec::new();
        for p in &self.pairs {
            let near = p.near(&self.sharp, x);
            let touches = near.distance < self.thickness && near.distance > 0.0;
            if !touches || self.sharp.feature(p.feature).side(&near.off) != Side::Out {
                continue;
            }
            if near.inside {
                found.push((*p, near, near.distance));
            } else if p.count() == 3 && near.side(&p.nodes).is_some() {
                on_sides.push((*p, near));
            }
        }
        self.add_sides(&on_sides, &mut found);
        for p in &self.pierced {
            let near = p.near(&self.sharp, x);
            if near.inside && self.sharp.feature(p.feature).side(&near.off) == Side::In {
                found.push((*p, near, -near.distance));
            }
        }
        found
    }

    /// Adds each corner of the body that is nearest to a side of a triangle once, unless it is
    /// nearest to the inside of one of the triangles of that side.
    fn add_sides(&self, on_sides: &[(Pair, Near)], found: &mut Vec<(Pair, Near, f64)>) {
        let has = |p: &Pair, side: &[u32; 2]| side.iter().all(|i| p.nodes.contains(i));
        let inside: Vec<Pair> = found.iter().map(|(p, ..)| *p).filter(|p| p.count() == 3).collect();
        let mut seen: Vec<(u32, [u32; 2])> = Vec::new();
        for (p, near) in on_sides {
            let Some(side) = near.side(&p.nodes) else { continue };
            let key = (p.feature, side);
            if !seen.contains(&key) && !inside.iter().any(|q| q.feature == p.feature && has(q, &side)) {
                seen.push(key);
                found.push((*p, *near, near.distance));
            }
        }
    }

    /// Finds the contacts at `x` and their friction. Call it at the start of each step.
    pub(crate) fn update_contacts(&mut self, body: &dyn CollisionSurface, x: &[Vec3]) {
        let sharp = &self.sharp;
        self.pierced.retain(|p| {
            let near = p.near(sharp, x);
            sharp.feature(p.feature).side(&near.off) == Side::In || !near.inside
        });
        self.find_newly_pierced(body, x);
        let before = std::mem::take(&mut self.contacts);
        let displacement = |c: &Contact| c.memory.coulomb(c.normal, 0.0).displacement(&c.point(x));
        let displacements: Vec<Vec3> = before.iter().map(displacement).collect();
        self.contacts = self
            .feasible(x)
            .iter()
            .map(|(pair, near, distance)| self.contact(pair, near, *distance, x, (&before, &displacements)))
            .collect();
    }

    fn potential(&self, pair: &Pair, near: &Near, distance: f64) -> ContactPotential {
        let parts = (0..pair.count()).map(|k| near.weights[k] * self.stiffness[pair.nodes[k] as usize]);
        let stiffness = parts.sum();
        match distance > 0.0 {
            true => ContactPotential::of(stiffness, self.thickness, distance),
            false => ContactPotential::spring(stiffness, self.thickness, distance),
        }
    }

    fn contact(
        &self,
        pair: &Pair,
        near: &Near,
        distance: f64,
        x: &[Vec3],
        (before, displacements): (&[Contact], &[Vec3]),
    ) -> Contact {
        let potential = self.potential(pair, near, distance);
        let coefficients = (0..pair.count()).map(|k| near.weights[k] * self.friction[pair.nodes[k] as usize]);
        let (load, slid) = match before.iter().position(|c| c.pair == *pair) {
            Some(k) => (before[k].memory.mean_load(potential.force), displacements[k]),
            None => (potential.force, taken_over(pair, before, displacements)),
        };
        let mut contact = Contact {
            pair: *pair,
            weights: near.weights,
            normal: near.off / distance,
            potential,
            friction: coefficients.sum(),
            memory: FrictionMemory { anchor: Vec3::zeros(), load },
            slid,
        };
        contact.memory.anchor = contact.point(x) - slid;
        contact
    }
}

impl Force for Ridges {
    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn begin_step(&mut self, at: &Place<'_>) {
        if let Some(body) = at.body {
            self.update_contacts(body, at.x);
        }
    }

    fn add_contact_value(&self, at: &Place<'_>, sum: &mut f64) {
        let normal: f64 = self.feasible(at.x).iter().map(|(p, n, d)| self.potential(p, n, *d).energy).sum();
        *sum += normal + self.contacts.iter().map(|c| c.friction_energy(at.x)).sum::<f64>();
    }

    fn add_contact_value_at_start(&self, x: &[Vec3], sum: &mut f64) {
        *sum += self.contacts.iter().map(|c| c.potential.energy + c.friction_energy(x)).sum::<f64>();
    }

    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        for c in &self.contacts {
            let friction = c.coulomb().map_or_else(Vec3::zeros, |r| r.gradient(&c.point(x)));
            let push = friction - c.normal * c.potential.force;
            c.nodes().for_each(|(i, w)| g[i as usize] += push * w);
        }
    }

    /// The sheet couples all nodes of an edge or a triangle.
    fn add_matrix(&self, x: &[Vec3], pattern: &Pattern, values: &mut [Matrix3<f64>]) {
        for c in &self.contacts {
            let friction = c.coulomb().map_or_else(Matrix3::zeros, |r| r.matrix(&c.point(x)));
            let block = c.normal * c.normal.transpose() * c.potential.curvature + friction;
            for (k, (i, w)) in c.nodes().enumerate() {
                for (j, v) in c.nodes().take(k + 1).filter(|(_, v)| w * v != 0.0) {
                    if let Some(slot) = pattern.slot(i, j) {
                        add_at(values, slot, &(block * (w * v)));
                    }
                }
            }
        }
    }

    fn end_step(&mut self, x: &[Vec3]) {
        for c in &mut self.contacts {
            if let Some(friction) = c.coulomb() {
                c.memory.drag(&friction, &c.point(x), &c.slid);
            }
        }
    }

    fn swap_friction(&mut self) {
        std::mem::swap(&mut self.friction, &mut self.disabled_friction);
        self.contacts.clear();
    }

    fn scale_contact(&mut self, factor: f64) {
        self.stiffness.iter_mut().for_each(|s| *s *= factor);
        self.contacts.iter_mut().for_each(|c| c.memory.load *= factor);
    }

    fn restrict(&self, cut: &Subset) -> Box<dyn Force> {
        let pair = |p: &Pair| Pair { nodes: cut.renumbered(p.nodes), ..*p };
        let knows = |p: &&Pair| cut.knows(&p.nodes);
        let mut pierced: Vec<Pair> = self.pierced.iter().filter(knows).map(pair).collect();
        pierced.sort_unstable();
        let contacts = self.contacts.iter().filter(|c| cut.knows(&c.pair.nodes));
        let edges = self.edges.iter().filter(|e| cut.knows(&e[..]));
        let triangles = self.triangles.iter().filter(|t| cut.knows(&t[..]));
        Box::new(Self {
            sharp: self.sharp.clone(),
            edges: edges.map(|e| cut.renumbered(*e)).collect(),
            triangles: triangles.map(|t| cut.renumbered(*t)).collect(),
            stiffness: cut.pick(&self.stiffness),
            friction: cut.pick(&self.friction),
            disabled_friction: cut.pick(&self.disabled_friction),
            pairs: Vec::new(),
            at: None,
            slack: 0.0,
            pierced,
            contacts: contacts.map(|c| Contact { pair: pair(&c.pair), ..*c }).collect(),
            ..*self
        })
    }

    fn merge(&mut self, cut: &Subset, part: &dyn Force) {
        let Some(part) = of_type::<Self>(part) else { return };
        let whole = |p: &Pair| Pair { nodes: cut.in_whole(p.nodes), ..*p };
        self.contacts.retain(|c| !cut.knows(&c.pair.nodes));
        self.contacts.extend(part.contacts.iter().map(|c| Contact { pair: whole(&c.pair), ..*c }));
        self.contacts.sort_by_key(|c| c.pair);
        self.pierced.retain(|p| !cut.knows(&p.nodes));
        self.pierced.extend(part.pierced.iter().map(whole));
        self.pierced.sort_unstable();
    }

    /// Keeps the contacts and the pierced cloth of the same body.
    fn continue_from(&mut self, before: &dyn Force) {
        if let Some(before) = of_type::<Self>(before)
            && Arc::ptr_eq(&self.sharp, &before.sharp)
        {
            self.contacts.clone_from(&before.contacts);
            self.pierced.clone_from(&before.pierced);
        }
    }
}

/// The edges of the cloth among `pairs` that lead from their first node, outside the body, into it.
fn leads_in(body: &dyn CollisionSurface, pairs: &[Pair], x: &[Vec3]) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 2]> =
        pairs.iter().filter(|p| p.count() == 2).map(|p| [p.nodes[0], p.nodes[1]]).collect();
    edges.sort_unstable();
    edges.dedup();
    let from: Vec<Vec3> = edges.iter().map(|e| x[e[0] as usize]).collect();
    let moves: Vec<Vec3> = edges.iter().map(|e| x[e[1] as usize] - x[e[0] as usize]).collect();
    let mut ends = moves.clone();
    body.guard(&from, &mut ends, &vec![NUDGE; edges.len()]);
    let changed = edges.into_iter().zip(moves.iter().zip(&ends)).filter(|(_, (m, end))| m != end);
    changed.map(|(e, _)| e).collect()
}

/// The mean tangential displacement of the contacts of the same cloth, weighted by their loads.
fn taken_over(pair: &Pair, before: &[Contact], displacements: &[Vec3]) -> Vec3 {
    let is_same = |c: &Contact| {
        c.memory.load > 0.0 && c.pair.nodes[..c.pair.count()].iter().any(|i| pair.nodes.contains(i))
    };
    let own = before.iter().zip(displacements).filter(|(c, _)| is_same(c));
    mean_by_load(own.map(|(c, displacement)| (*displacement, c.memory.load)))
}

#[cfg(test)]
mod tests;
