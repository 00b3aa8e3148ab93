//! Contact of cloth with itself, kept free of crossings.
//!
//! Method: vertex-triangle and edge-edge pairs within reach are found from time to time; between
//! two searches each pair keeps its weights and normal, and pairs nearer than the thickness get
//! an impulse that keeps them apart, with friction (Bridson, Fedkiw, Anderson 2002). No node may
//! move farther from where it was at the search than [`SHARE`] of its least distance to other cloth, so
//! two pieces can never pass each other (Wu et al. 2020, Chen et al. 2025): a start without crossings
//! ends without. A node that wants to go farther asks for a new search.
//! Cost: a search of a few milliseconds for 4,000 triangles, as often as cloth near cloth moves.
//! Limit: the two sides of an open seam are let through to each other.

use super::cloth::{Cloth, State};
use super::contact::rub;
use nalgebra::Vector3;
use toile_core::artifact::{Collide, Point3, SelfContact};

/// Nodes may move by this share of their distance to other cloth: below one half, so that two
/// that move towards each other never meet.
const SHARE: f64 = 0.45;

/// Cloth farther than the thickness plus this is not watched, metres: a longer reach finds more
/// pairs but asks for fewer searches.
const WATCH: f64 = 5e-3;

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
        for c in &self.contacts {
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
        for i in 0..self.way.len() {
            let gone = state.x[i] + state.v[i] * dt - self.asked[i];
            let (square, way) = (gone.norm_squared(), self.way[i]);
            if square <= (ASK_AT * way).powi(2) {
                continue;
            }
            self.wanted = true;
            if square > way * way {
                let end = self.asked[i] + gone * (way / square.sqrt());
                state.v[i] = (end - state.x[i]) / dt;
            }
        }
    }
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
