//! Contact of nodes with the body.
//!
//! Method: the collider is asked for the skin near each node; until the node has moved by
//! [`NEAR_DRIFT`] the answer stands in as a plane, since a body bends little over that distance.
//! A node that would end a step nearer than the thickness loses that part of its normal velocity
//! (or gets it back, with restitution), and Coulomb friction takes from its tangential velocity in
//! proportion [METHODS 3]. A node that is already nearer is moved out at a limited speed that does
//! not count as velocity. With a penalty stiffness, `f = c_r (d - dist) N` replaces the impulse.
//! Where the skin bends between two nodes, both are held farther off by what the body would stand out
//! through the edge between them.
//! Cost: one product a node and step, a query for nodes that moved.

use super::model::{Cloth, Edge, State};
use nalgebra::Vector3;
use toile_core::artifact::{BodyContact, Collide, ColliderCard, Point3};

/// A plane stands in for the skin until the node has moved so far, metres: at a radius of 5 cm
/// the error is 0.02 mm.
const NEAR_DRIFT: f64 = 1.5e-3;

/// Nodes farther than this from the thickness are not watched until they have moved by it, metres.
const WATCH: f64 = 6e-3;

/// Speed at which a node inside the thickness is moved out, m/s: fast enough to resolve a
/// centimetre in 20 ms, slow enough not to stretch cloth.
const PUSH_OUT: f64 = 0.5;

/// Penalty forces use no more than this share of the stiffness that would be unstable.
const PENALTY_SHARE: f64 = 0.5;

/// The body may come this near to the middle of an edge, metres.
const LEAST_COVER: f64 = 3e-4;

#[derive(Debug, Clone, Copy)]
struct Skin {
    /// Where the node was when it was asked.
    asked: Point3,
    normal: Vector3<f64>,
    /// `normal . point` of the skin.
    base: f64,
    near: bool,
}

/// The skin near every node.
#[derive(Debug, Default)]
pub struct Contacts {
    skins: Vec<Skin>,
    /// By how much each node is held off beyond the thickness, metres.
    lifts: Vec<f64>,
    moved: Vec<u32>,
    places: Vec<Point3>,
    found: Vec<BodyContact>,
}

impl Contacts {
    /// Forgets everything, as after a change of nodes.
    pub fn clear(&mut self) {
        self.skins.clear();
    }

    /// Asks the collider about every node that has left the place where its answer holds.
    pub fn refresh(&mut self, scheme: &dyn Collide, edges: &[Edge], x: &[Point3]) {
        let fresh = self.skins.len() != x.len();
        if fresh {
            let none = Skin { asked: Point3::origin(), normal: Vector3::y(), base: 0.0, near: false };
            self.skins = vec![none; x.len()];
        }
        let stale = |s: &Skin, x: &Point3| {
            let drift = if s.near { NEAR_DRIFT } else { WATCH };
            fresh || (x - s.asked).norm_squared() > drift * drift
        };
        self.moved.clear();
        self.moved.extend((0..x.len() as u32).filter(|&i| stale(&self.skins[i as usize], &x[i as usize])));
        if !self.moved.is_empty() {
            self.ask(scheme, x);
            self.lift(edges, scheme.card().thickness);
        }
    }

    /// Holds the ends of each edge so far off that the skin does not stand out through its middle: on a
    /// round of radius r the chord of length s dips by s^2 / 8r, and the normals turn by s / r.
    fn lift(&mut self, edges: &[Edge], thickness: f64) {
        self.lifts.clear();
        self.lifts.resize(self.skins.len(), 0.0);
        for edge in edges {
            let [a, b] = edge.nodes.map(|i| i as usize);
            let (p, q) = (&self.skins[a], &self.skins[b]);
            let (turn, along) = (p.normal - q.normal, p.asked - q.asked);
            if p.near && q.near && turn.dot(&along) > 0.0 {
                let dip = along.norm() * turn.norm() / 8.0;
                let lift = (dip + LEAST_COVER - thickness).min(thickness);
                self.lifts[a] = self.lifts[a].max(lift);
                self.lifts[b] = self.lifts[b].max(lift);
            }
        }
    }

    fn ask(&mut self, scheme: &dyn Collide, x: &[Point3]) {
        self.places.clear();
        self.places.extend(self.moved.iter().map(|&i| x[i as usize]));
        self.found.clear();
        let reach = scheme.card().thickness + WATCH + NEAR_DRIFT;
        scheme.body_contacts(&self.places, reach, &mut self.found);
        for &i in &self.moved {
            let s = &mut self.skins[i as usize];
            (s.asked, s.near) = (x[i as usize], false);
        }
        for c in &self.found {
            let s = &mut self.skins[self.moved[c.vertex as usize] as usize];
            (s.normal, s.base, s.near) = (c.normal, c.normal.dot(&c.point.coords), true);
        }
    }

    /// Corrects velocities for contact over the step `dt`, and positions of nodes too near.
    pub fn respond(&self, card: &ColliderCard, cloth: &Cloth, state: &mut State, dt: f64) {
        for (i, skin) in self.skins.iter().enumerate() {
            if !skin.near || cloth.inverse_inertia[i] <= 0.0 {
                continue;
            }
            let height = card.thickness + self.lifts[i];
            let spare = skin.normal.dot(&state.x[i].coords) - skin.base - height;
            let (n, v) = (skin.normal, &mut state.v[i]);
            match card.penalty {
                None => {
                    *v = impulse(*v, n, spare, card, dt);
                    if spare < 0.0 {
                        state.x[i] += n * (-spare).min(PUSH_OUT * dt);
                    }
                }
                Some(k) if spare < 0.0 => {
                    let k = k.min(PENALTY_SHARE * cloth.inertia[i] / (dt * dt));
                    let push = -spare * k * dt * cloth.inverse_inertia[i];
                    *v = rub(*v + n * push, n, card.friction * push);
                }
                Some(_) => {}
            }
        }
    }

    /// Greatest depth below `height` over the skin of any watched node, metres.
    pub fn depth(&self, x: &[Point3], height: f64) -> f64 {
        let near = self.skins.iter().zip(x).filter(|(s, _)| s.near);
        near.map(|(s, x)| height + s.base - s.normal.dot(&x.coords)).fold(0.0, f64::max)
    }
}

/// The velocity after contact with a plane that lies `spare` metres below the node's thickness.
fn impulse(v: Vector3<f64>, n: Vector3<f64>, spare: f64, card: &ColliderCard, dt: f64) -> Vector3<f64> {
    let (normal, least) = (n.dot(&v), -spare.max(0.0) / dt);
    if normal >= least {
        return v;
    }
    let rebound = if spare <= 0.0 { -card.restitution * normal } else { 0.0 };
    let change = (least - normal) + rebound;
    rub(v + n * change, n, card.friction * (least - normal))
}

/// Takes Coulomb friction of at most `most` m/s from the tangential velocity.
pub(super) fn rub(v: Vector3<f64>, n: Vector3<f64>, most: f64) -> Vector3<f64> {
    let along = n * n.dot(&v);
    let tangential = v - along;
    let speed = tangential.norm();
    if speed <= most { along } else { along + tangential * (1.0 - most / speed) }
}
