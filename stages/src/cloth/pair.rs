//! Contact of cloth with itself, kept free of crossings.
//!
//! Method: vertex-triangle and edge-edge pairs within reach are found from time to time; between
//! two searches each pair keeps its weights and normal, and pairs nearer than the thickness get
//! an impulse that keeps them apart, with friction (Bridson, Fedkiw, Anderson 2002). The plane halfway
//! between the two closest points separates the two pieces; a node of a close pair may use
//! [`SHARE`] of its distance to come nearer to that plane, and none may go farther than [`SHARE`] of its
//! distance to other cloth otherwise, so two pieces never pass each other (Wu et al. 2020, Chen
//! et al. 2025): a start without crossings ends without. Sliding and parting stay free. A
//! node that wants to go farther asks for a new search.
//! Cost: a search of a few milliseconds for 4,000 triangles, as often as cloth near cloth moves.
//! Limit: the two sides of an open seam are let through to each other.

use super::contact::rub;
use super::model::{Cloth, State};
use nalgebra::Vector3;
use toile_core::artifact::{Collide, Point3, SelfContact};

/// Nodes may move by this share of their distance to other cloth: below one half, so that two
/// that move towards each other never meet.
const SHARE: f64 = 0.45;

/// Cloth farther than the thickness plus this is not watched, metres: a longer reach finds more
/// pairs but asks for fewer searches.
const WATCH: f64 = 5e-3;

/// Pairs nearer than this many thicknesses get a plane: they may slide; farther ones share a ball.
const CLOSE: f64 = 2.0;

/// A new search is made when a node has used this share of its way.
const ASK_AT: f64 = 0.7;

/// Searches are at least so many steps apart; in between nodes that have used up their way wait.
const LEAST_STEPS: usize = 8;

/// Speed at which pairs nearer than the thickness are moved apart, m/s.
const PUSH_APART: f64 = 0.1;

/// The pairs near each other, and how far each node may go.
#[derive(Debug, Default)]
pub struct SelfPairs {
    contacts: Vec<SelfContact>,
    /// The first so many have planes.
    close: usize,
    asked: Vec<Point3>,
    way: Vec<f64>,
    /// Nodes that will be joined have one group.
    group: Vec<u32>,
    steps: usize,
    searches: usize,
    wanted: bool,
}

impl SelfPairs {
    /// Forgets everything, as after a change of nodes; `partners` are pairs that will be joined.
    pub fn reset(&mut self, nodes: usize, partners: impl Iterator<Item = [u32; 2]>) {
        self.group = (0..nodes as u32).collect();
        for [a, b] in partners {
            let (a, b) = (self.group[a as usize], self.group[b as usize]);
            let (low, high) = (a.min(b), a.max(b));
            self.group.iter_mut().filter(|g| **g == high).for_each(|g| *g = low);
        }
        self.wanted = true;
        self.asked.clear();
    }

    /// Searches again where a node asked for it.
    pub fn refresh(&mut self, scheme: &dyn Collide, x: &[Point3], triangles: &[[u32; 3]]) {
        self.steps += 1;
        let due = self.wanted && self.steps >= LEAST_STEPS;
        if !due && self.asked.len() == x.len() {
            return;
        }
        let reach = scheme.card().thickness + WATCH;
        self.searches += 1;
        self.contacts.clear();
        scheme.self_contacts(x, triangles, reach, &mut self.contacts);
        let group = &self.group;
        self.contacts.retain(|c| !will_join(c, group));
        self.way.clear();
        self.way.resize(x.len(), SHARE * reach);
        let near = CLOSE * scheme.card().thickness;
        self.contacts.sort_by_key(|c| c.distance >= near);
        self.close = self.contacts.partition_point(|c| c.distance < near);
        for c in &self.contacts[self.close..] {
            for &i in &c.vertices {
                let way = &mut self.way[i as usize];
                *way = way.min(SHARE * c.distance);
            }
        }
        self.asked.clear();
        self.asked.extend_from_slice(x);
        (self.steps, self.wanted) = (0, false);
    }

    /// Number of pairs watched.
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// Searches made so far.
    pub fn searches(&self) -> usize {
        self.searches
    }

    /// True where no cloth is near other cloth.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Corrects the velocities of pairs that would end a step nearer than `thickness`.
    pub fn respond(&self, thickness: f64, friction: f64, cloth: &Cloth, state: &mut State, dt: f64) {
        for c in &self.contacts {
            respond_pair(c, thickness, friction, cloth, state, dt);
        }
    }

    /// Holds every node within its way over the step `dt`.
    pub fn hold_back(&mut self, state: &mut State, dt: f64) {
        let close = &self.contacts[..self.close];
        // Two sweeps: the first takes only what goes too near, the second shortens the step of nodes
        // that are still too near to one plane for another's sake.
        close.iter().for_each(|c| stop_at_plane(c, &self.asked, state, dt));
        for c in close {
            self.wanted |= shorten_step(c, &self.asked, state, dt);
        }
        for i in 0..self.way.len() {
            let gone = state.x[i] + state.v[i] * dt - self.asked[i];
            let (square, way) = (gone.norm_squared(), self.way[i]);
            if square <= (ASK_AT * way).powi(2) {
                continue;
            }
            self.wanted = true;
            if square > way * way {
                let share = share_inside_ball(state.x[i] - self.asked[i], state.v[i] * dt, way);
                state.v[i] *= share;
            }
        }
    }
}

/// The share of the step `d` from `p` that stays inside a ball around the origin.
fn share_inside_ball(p: Vector3<f64>, d: Vector3<f64>, radius: f64) -> f64 {
    let (a, b, c) = (d.norm_squared(), p.dot(&d), p.norm_squared() - radius * radius);
    let root = (b * b - a * c).max(0.0).sqrt();
    if a > 0.0 { ((root - b) / a).clamp(0.0, 1.0) } else { 1.0 }
}

/// Which side of a pair's plane a node is on: 1 or -1.
fn side(c: &SelfContact, k: usize) -> f64 {
    if c.weights[k] > 0.0 { 1.0 } else { -1.0 }
}

/// Takes from the velocities what would bring a node of a close pair too near to its plane.
fn stop_at_plane(c: &SelfContact, asked: &[Point3], state: &mut State, dt: f64) {
    for k in 0..4 {
        let (i, n) = (c.vertices[k] as usize, c.normal * side(c, k));
        let least = -SHARE * c.distance - n.dot(&(state.x[i] - asked[i]));
        let step = n.dot(&state.v[i]) * dt;
        // Never more than the step itself: a node is stopped, not thrown back.
        if step < least.min(0.0) {
            state.v[i] += n * ((least.min(0.0) - step) / dt);
        }
    }
}

/// Shortens the steps of nodes of a close pair that would still end too near to its plane; true
/// where one has used most of its way.
fn shorten_step(c: &SelfContact, asked: &[Point3], state: &mut State, dt: f64) -> bool {
    let mut wanted = false;
    for k in 0..4 {
        let (i, n) = (c.vertices[k] as usize, c.normal * side(c, k));
        let (gone, step) = (n.dot(&(state.x[i] - asked[i])), n.dot(&state.v[i]) * dt);
        let limit = -SHARE * c.distance;
        wanted |= gone + step < ASK_AT * limit;
        if step < 0.0 && gone + step < limit * (1.0 + 1e-9) {
            state.v[i] *= ((limit - gone) / step).clamp(0.0, 1.0);
        }
    }
    wanted
}

/// True where the two sides hold nodes that will be one.
fn will_join(c: &SelfContact, group: &[u32]) -> bool {
    let of = |k: usize| group[c.vertices[k] as usize];
    (0..4).any(|i| c.weights[i] > 0.0 && (0..4).any(|j| c.weights[j] <= 0.0 && of(i) == of(j)))
}

fn respond_pair(c: &SelfContact, thickness: f64, friction: f64, cloth: &Cloth, state: &mut State, dt: f64) {
    let nodes = c.vertices.map(|n| n as usize);
    let (mut apart, mut speed, mut free) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for (&i, &w) in nodes.iter().zip(&c.weights) {
        apart += state.x[i].coords * w;
        speed += state.v[i] * w;
        free += w * w * cloth.inverse_inertia[i];
    }
    let spare = c.normal.dot(&apart) - thickness;
    let least = if spare >= 0.0 { -spare / dt } else { (-spare / dt).min(PUSH_APART) };
    let normal = c.normal.dot(&speed);
    if normal >= least || free <= 0.0 {
        return;
    }
    let pushed = speed + c.normal * (least - normal);
    let change = rub(pushed, c.normal, friction * (least - normal)) - speed;
    for (&i, &w) in nodes.iter().zip(&c.weights) {
        state.v[i] += change * (w * cloth.inverse_inertia[i] / free);
    }
}
