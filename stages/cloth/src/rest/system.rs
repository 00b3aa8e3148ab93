//! Everything that acts on one level's nodes, as one potential: value, gradient and matrix.
//!
//! Membrane, bending, weight, seams that still pull, the body (a penalty within a thickness of its surface, so that
//! vertices rest outside it), and friction as a potential about anchors that stick and, when the limit is reached, are
//! dragged along (the elastic-plastic form of Coulomb's law). Normals and limits of friction are those of the step's start.

use super::elastic::Elastic;
use super::layers::Layers;
use super::pattern::{Pattern, Slot, add_at};
use crate::contact::body::Nearest;
use crate::contact::skin::Skin;
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// A seam that still pulls its two nodes together, with a force that hardly depends on the gap.
#[derive(Debug, Clone, Copy)]
pub struct Thread {
    /// The nodes.
    pub nodes: [u32; 2],
    /// Force at large gaps, N.
    pub force: f64,
    /// Gap at which the force falls off, m.
    pub soft: f64,
}

/// Where a node touches the body.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// The node.
    pub node: u32,
    /// Outward normal of the body there.
    pub normal: Vec3,
    /// Force of the body, N.
    pub force: f64,
    /// The force that limits friction: the mean over the last steps, N.
    pub load: f64,
}

/// The body and how cloth rests on it.
#[derive(Debug, Clone)]
pub struct Support<'a> {
    /// The body.
    pub body: &'a dyn Skin,
    /// Coefficient of friction, per node.
    pub friction: Vec<f64>,
    /// Distance at which contact begins, per node, m.
    pub offsets: Vec<f64>,
    /// The least of them, m.
    pub offset: f64,
    /// How deep inside the body a node is still pushed out, m.
    pub depth: f64,
    /// Edges of the sheet and their rest lengths: between two nodes on a curved body an edge sags.
    pub edges: Vec<([u32; 2], f64)>,
    /// Whether edges must stay outside the body, too; otherwise they may sag into it as far as keeps the girth right.
    pub clear: bool,
    /// Stiffness of contact, N/m per node.
    pub stiffness: Vec<f64>,
}

/// All that acts on the nodes.
#[derive(Debug, Clone)]
pub struct System<'a> {
    /// The sheet's resistance.
    pub elastic: Elastic,
    /// kg per node.
    pub masses: Vec<f64>,
    /// m/s².
    pub gravity: Vec3,
    /// Nodes that stay.
    pub pinned: Vec<bool>,
    /// Seams that still pull.
    pub threads: Vec<Thread>,
    /// The body.
    pub support: Option<Support<'a>>,
    /// Cloth against itself.
    pub layers: Option<Layers>,
    /// Nodes in contact at the start of the step.
    pub touches: Vec<Touch>,
    /// Where friction holds each node.
    pub anchors: Vec<Option<Vec3>>,
    /// How far friction holds each node back when it first touches: what the coarser level found, m.
    pub slides: Vec<Vec3>,
    /// Whether friction holds without limit for now: the last slides are settled by springs, and the limit is looked at
    /// when they have come to rest.
    pub holds: bool,
    /// Share of friction's stiffness that nodes which slide put into the matrix: little, or they would hardly slide;
    /// more where steps overshoot.
    pub ease: f64,
    /// Nodes that slid in the last step.
    pub slips: Vec<bool>,
    /// What presses each node on the body, a mean over the last steps, N.
    pub loads: Vec<f64>,
}

impl System<'_> {
    /// The pattern of its matrix.
    #[must_use]
    pub fn pattern(&self) -> Pattern {
        let threads = self.threads.iter().map(|t| &t.nodes[..]);
        let layers = self.layers.iter().flat_map(|l| l.groups());
        Pattern::new(self.masses.len(), self.elastic.couplings().chain(threads).chain(layers))
    }

    /// The body nearest to each node, if within reach.
    fn nearest(&self, x: &[Vec3]) -> Vec<Option<Nearest>> {
        let Some(s) = &self.support else { return vec![None; x.len()] };
        s.nearest(x)
    }

    /// Energy at `x`, J; `touches` and `anchors` are those of the step's start.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        let weight: f64 = x.iter().zip(&self.masses).map(|(p, m)| -m * self.gravity.dot(p)).sum();
        let threads: f64 = self.threads.iter().map(|t| t.value(x)).sum();
        let body: f64 = match &self.support {
            Some(s) => {
                let press = |((n, o), k): ((Option<Nearest>, &f64), &f64)| {
                    n.map_or(0.0, |n| 0.5 * k * (o - n.distance).max(0.0).powi(2))
                };
                self.nearest(x).into_iter().zip(&s.offsets).zip(&s.stiffness).map(press).sum()
            }
            None => 0.0,
        };
        let rub: f64 = self.rubs().map(|r| r.value(x)).sum();
        let layers = self.layers.as_ref().map_or(0.0, |l| l.value(x));
        self.elastic.value(x) + weight + threads + body + rub + layers
    }

    /// Elastic and gravitational energy at `x`, J.
    #[must_use]
    pub fn stored(&self, x: &[Vec3]) -> f64 {
        let weight: f64 = x.iter().zip(&self.masses).map(|(p, m)| -m * self.gravity.dot(p)).sum();
        self.elastic.value(x) + weight
    }

    /// Finds the touches at `x`: call it at the start of each step.
    pub fn touch(&mut self, x: &[Vec3]) {
        if let Some(l) = &mut self.layers {
            l.contacts = l.touching(x);
        }
        let near = self.nearest(x);
        let Some(s) = &mut self.support else { return };
        s.allow_for_sag(&near, x);
        let mut anchors = vec![None; x.len()];
        let mut loads = vec![0.0; x.len()];
        self.touches.clear();
        for (i, n) in near.iter().enumerate() {
            let Some(n) = n else { continue };
            let force = s.stiffness[i] * (s.offsets[i] - n.distance).max(0.0);
            // While Newton's steps swing between touching and not, friction follows the mean.
            loads[i] = if self.anchors[i].is_some() { 0.5 * (self.loads[i] + force) } else { force };
            if force > 0.0 || loads[i] > 0.0 {
                anchors[i] = Some(self.anchors[i].unwrap_or(x[i] - std::mem::take(&mut self.slides[i])));
                self.touches.push(Touch { node: i as u32, normal: n.normal, force, load: loads[i] });
            }
        }
        (self.anchors, self.loads) = (anchors, loads);
    }

    /// Drags anchors along where friction is beyond its limit, until it is `share` of the limit: call it at the end of each
    /// step that may slide.
    pub fn drag(&mut self, x: &[Vec3], share: f64) {
        let dragged: Vec<(u32, (bool, Vec3))> = self.rubs().map(|r| (r.node, r.dragged(x, share))).collect();
        self.slips.fill(false);
        for (i, (slips, anchor)) in dragged {
            self.anchors[i as usize] = Some(anchor);
            self.slips[i as usize] = slips;
        }
    }

    /// Friction that the sheet as a whole asks for beyond its limit, as a share of all it can give: what single nodes ask
    /// for against each other cancels, for they may slide and stop.
    #[must_use]
    pub fn excess(&self, x: &[Vec3]) -> f64 {
        let (mut excess, mut limit) = (Vec3::zeros(), 0.0);
        for r in self.rubs() {
            let (along, s) = r.slide(x);
            let beyond = s * r.stiffness - r.limit;
            if beyond > 0.0 {
                excess += along * (beyond / s);
            }
            limit += r.limit;
        }
        if limit > 0.0 { excess.norm() / limit } else { 0.0 }
    }

    /// How far friction holds each node back at `x`, m. It is force over stiffness, so it is the same on a finer mesh.
    #[must_use]
    pub fn held_back(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut slides = vec![Vec3::zeros(); x.len()];
        self.rubs().for_each(|r| slides[r.node as usize] = r.slide(x).0);
        slides
    }

    fn rubs(&self) -> impl Iterator<Item = Rub> + '_ {
        let s = self.support.as_ref();
        self.touches.iter().filter_map(move |t| {
            let s = s.filter(|s| s.friction[t.node as usize] > 0.0)?;
            let anchor = self.anchors[t.node as usize]?;
            Some(Rub {
                node: t.node,
                normal: t.normal,
                anchor,
                limit: s.friction[t.node as usize] * t.load,
                slips: self.slips[t.node as usize],
                ease: self.ease,
                holds: self.holds,
                stiffness: s.stiffness[t.node as usize],
            })
        })
    }

    /// Derivative of the energy at the step's start, N; zero at pins.
    #[must_use]
    pub fn gradient(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut g: Vec<Vec3> = self.masses.iter().map(|m| -self.gravity * *m).collect();
        self.elastic.add_gradient(x, &mut g);
        self.threads.iter().for_each(|t| t.add_gradient(x, &mut g));
        self.touches.iter().for_each(|t| g[t.node as usize] -= t.normal * t.force);
        self.rubs().for_each(|r| g[r.node as usize] += r.gradient(x));
        self.layers.iter().for_each(|l| l.add_gradient(&mut g));
        g.iter_mut().zip(&self.pinned).filter(|(_, p)| **p).for_each(|(g, _)| *g = Vec3::zeros());
        g
    }

    /// Positive definite matrix at the step's start: second derivative plus `inertia` times the masses.
    pub fn matrix(&self, x: &[Vec3], pattern: &Pattern, inertia: f64, values: &mut Vec<Matrix3<f64>>) {
        values.clear();
        values.resize(pattern.blocks(), Matrix3::zeros());
        self.elastic.add_matrix(x, values);
        for (v, m) in values.iter_mut().zip(&self.masses) {
            (0..3).for_each(|c| v[(c, c)] += m * inertia);
        }
        self.threads.iter().for_each(|t| t.add_matrix(x, pattern, values));
        if let Some(s) = &self.support {
            for t in self.touches.iter().filter(|t| t.force > 0.0) {
                values[t.node as usize] += t.normal * t.normal.transpose() * s.stiffness[t.node as usize];
            }
        }
        self.rubs().for_each(|r| values[r.node as usize] += r.matrix(x));
        self.layers.iter().for_each(|l| l.add_matrix(pattern, values));
        hold(&self.pinned, pattern, values);
    }
}

impl Support<'_> {
    /// Moves the offsets of touching nodes outwards where the edges between them would dip into a convex body.
    fn allow_for_sag(&mut self, near: &[Option<Nearest>], x: &[Vec3]) {
        let mut sags = vec![0.0f64; self.offsets.len()];
        for &([i, j], length) in &self.edges {
            let (i, j) = (i as usize, j as usize);
            if let (Some(a), Some(b)) = (&near[i], &near[j]) {
                let turn = b.normal - a.normal;
                if turn.dot(&(x[j] - x[i])) > 0.0 {
                    let sag = length * turn.norm() / 8.0;
                    (sags[i], sags[j]) = (sags[i].max(sag), sags[j].max(sag));
                }
            }
        }
        // Offsets only grow within a level, or contacts would come and go with them.
        for (i, sag) in sags.into_iter().enumerate() {
            // A polygon around a circle has its length when its corners stand a third of the sag outside.
            let least = if self.clear { (sag - 0.5 * self.offset).max(sag / 3.0) } else { sag / 3.0 };
            self.offsets[i] = self.offsets[i].max(self.offset + least);
        }
    }

    /// The body nearest to each node, where it presses.
    #[must_use]
    pub fn nearest(&self, x: &[Vec3]) -> Vec<Option<Nearest>> {
        let within: Vec<f64> = self.offsets.iter().map(|o| o + self.depth).collect();
        let mut near = self.body.nearest(x, &within);
        for (n, o) in near.iter_mut().zip(&self.offsets) {
            *n = n.filter(|n| n.distance < NEAR * o);
        }
        near
    }
}

/// Cuts pinned nodes out of the matrix.
fn hold(pinned: &[bool], pattern: &Pattern, values: &mut [Matrix3<f64>]) {
    if !pinned.contains(&true) {
        return;
    }
    for (i, j, slot) in pattern.upper() {
        if pinned[i as usize] || pinned[j as usize] {
            values[slot as usize] = Matrix3::zeros();
        }
    }
    for (i, _) in pinned.iter().enumerate().filter(|(_, p)| **p) {
        values[i] = Matrix3::identity();
    }
}

impl Thread {
    fn reach(&self, x: &[Vec3]) -> (Vec3, f64) {
        let d = x[self.nodes[1] as usize] - x[self.nodes[0] as usize];
        (d, (d.norm_squared() + self.soft * self.soft).sqrt())
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        self.force * self.reach(x).1
    }

    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        let (d, r) = self.reach(x);
        let pull = d * (self.force / r);
        g[self.nodes[0] as usize] -= pull;
        g[self.nodes[1] as usize] += pull;
    }

    fn add_matrix(&self, x: &[Vec3], pattern: &Pattern, values: &mut [Matrix3<f64>]) {
        let [i, j] = self.nodes;
        let (_, r) = self.reach(x);
        // The secant stiffness: a majorant, with which Newton's step never overshoots.
        let k = Matrix3::identity() * (self.force / r);
        values[i as usize] += k;
        values[j as usize] += k;
        add_at(values, pattern.slot(i, j).unwrap_or(Slot { index: i, flipped: false }), &-k);
    }
}

/// Share of the offset up to which a node that has touched keeps its place on the body.
const NEAR: f64 = 1.5;

/// Friction of one node.
struct Rub {
    node: u32,
    slips: bool,
    ease: f64,
    holds: bool,
    normal: Vec3,
    anchor: Vec3,
    limit: f64,
    stiffness: f64,
}

impl Rub {
    fn slide(&self, x: &[Vec3]) -> (Vec3, f64) {
        let d = x[self.node as usize] - self.anchor;
        let along = d - self.normal * self.normal.dot(&d);
        (along, along.norm())
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        let (_, s) = self.slide(x);
        if self.holds || s * self.stiffness <= self.limit {
            0.5 * self.stiffness * s * s
        } else {
            self.limit * (s - 0.5 * self.limit / self.stiffness)
        }
    }

    fn gradient(&self, x: &[Vec3]) -> Vec3 {
        let (along, s) = self.slide(x);
        if self.holds || s * self.stiffness <= self.limit {
            along * self.stiffness
        } else {
            along * (self.limit / s)
        }
    }

    fn matrix(&self, x: &[Vec3]) -> Matrix3<f64> {
        let flat = Matrix3::identity() - self.normal * self.normal.transpose();
        if self.holds || !self.slips {
            return flat * self.stiffness;
        }
        let (along, s) = self.slide(x);
        let way = if s > 0.0 { along / s } else { along };
        (flat - way * way.transpose() * (1.0 - ALONG)) * (self.stiffness * self.ease)
    }

    /// Whether the step has dragged it beyond the limit, and where the anchor is then.
    fn dragged(&self, x: &[Vec3], share: f64) -> (bool, Vec3) {
        let (along, s) = self.slide(x);
        let most = self.limit / self.stiffness;
        if s <= most {
            (false, self.anchor)
        } else {
            (true, x[self.node as usize] - along * (share * most / s))
        }
    }
}

/// Share of its stiffness that friction keeps in the matrix along the way that a node slides.
const ALONG: f64 = 0.1;
