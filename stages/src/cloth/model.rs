//! A garment as nodes and springs.
//!
//! Joined vertices are one node. Masses are lumped: a third of each triangle's area times the
//! fabric's density goes to each corner. The lists are flat and built once; they are rebuilt only
//! when pairs are joined, which costs about a millisecond for 4,000 triangles.

use super::frequency::{highest, inertia};
use super::hinge::{Hinge, Wing};
use super::membrane::{Material, Membrane};
use nalgebra::Vector3;
use std::ops::Range;
use toile_core::artifact::{Garment, Point3};

/// Cloth with fewer triangles is not worth a second thread.
const LEAST_PARALLEL: usize = 1000;

/// How far the fabric's measured stiffness is cut for the sake of the time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Softening {
    /// No slope of a curve above it, N/m.
    pub steepest: f64,
}

/// A mesh edge between two nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Nodes, the lower first.
    pub nodes: [u32; 2],
    /// Flat length, metres; the mean of both panels' along a closed seam.
    pub length: f64,
}

/// Positions and velocities of all nodes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct State {
    /// Metres.
    pub x: Vec<Point3>,
    /// Metres per second.
    pub v: Vec<Vector3<f64>>,
}

/// Nodes, masses and springs.
#[derive(Debug, Clone)]
pub struct Cloth {
    /// The node of every garment vertex.
    pub node_of: Vec<u32>,
    /// Mass of every node, kg: what gravity pulls.
    pub mass: Vec<f64>,
    /// Inertia of every node, kg: its mass, raised where a tiny triangle would force a tiny time
    /// step on the whole garment. The shape at rest does not depend on it.
    pub inertia: Vec<f64>,
    /// One over the inertia; 0 for a node that is held.
    pub inverse_inertia: Vec<f64>,
    /// Velocity damping of every node, 1/s.
    pub damping: Vec<f64>,
    /// Triangles as nodes, in the garment's order.
    pub triangles: Vec<[u32; 3]>,
    /// Structural and shear springs, one entry a triangle.
    pub membranes: Vec<Membrane>,
    /// The membranes' laws, one a panel.
    pub materials: Vec<Material>,
    /// Bending springs.
    pub hinges: Vec<Hinge>,
    /// Mesh edges, ascending.
    pub edges: Vec<Edge>,
}

/// A triangle's side: its nodes in ascending order, the triangle, the corner where it starts.
type Side = ([u32; 2], usize, usize);

impl Cloth {
    /// The cloth of a garment that passed [`check_garment`](super::check_garment).
    pub fn new(garment: &Garment, softening: Softening) -> Self {
        let node_of = nodes(&garment.weld);
        let triangles: Vec<[u32; 3]> =
            garment.triangles.iter().map(|t| t.map(|i| node_of[i as usize])).collect();
        let panel_of = panels(garment);
        let membranes: Vec<Membrane> = (0..triangles.len())
            .map(|t| {
                Membrane::new(
                    triangles[t],
                    garment.triangles[t].map(|i| garment.rest[i as usize]),
                    panel_of[t],
                )
            })
            .collect();
        let cut = softening.steepest;
        let materials: Vec<Material> = garment.panels.iter().map(|p| Material::new(&p.fabric, cut)).collect();
        let (mass, damping) = masses(garment, &membranes, node_count(&node_of));
        let sides = sides(&triangles);
        let hinges = hinges(garment, &triangles, &panel_of, &sides);
        let edges = edges(garment, &node_of, &sides);
        let inertia = inertia(&mass, &membranes, &materials);
        let inverse_inertia = inertia.iter().map(|&m| if m > 0.0 { 1.0 / m } else { 0.0 }).collect();
        Cloth {
            node_of,
            mass,
            inertia,
            inverse_inertia,
            damping,
            triangles,
            membranes,
            materials,
            hinges,
            edges,
        }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// True without nodes.
    pub fn is_empty(&self) -> bool {
        self.mass.is_empty()
    }

    /// Holds a node where it is.
    pub fn hold(&mut self, node: usize) {
        self.inverse_inertia[node] = 0.0;
    }

    /// Adds all elastic forces; returns the greatest tensile strain.
    ///
    /// Large cloth is worked on by two threads. The halves are the same for any number of
    /// threads and are added in a fixed order, so the bits are too.
    pub fn add_forces(&self, x: &[Point3], forces: &mut [Vector3<f64>]) -> f64 {
        let (m, h) = (self.membranes.len() / 2, self.hinges.len() / 2);
        if self.membranes.len() < LEAST_PARALLEL {
            return self.add_share(0..self.membranes.len(), 0..self.hinges.len(), x, forces);
        }
        let mut other = vec![Vector3::zeros(); forces.len()];
        let (first, second) = rayon::join(
            || self.add_share(0..m, 0..h, x, forces),
            || self.add_share(m..self.membranes.len(), h..self.hinges.len(), x, &mut other),
        );
        forces.iter_mut().zip(&other).for_each(|(f, o)| *f += o);
        first.max(second)
    }

    fn add_share(
        &self,
        membranes: Range<usize>,
        hinges: Range<usize>,
        x: &[Point3],
        forces: &mut [Vector3<f64>],
    ) -> f64 {
        let mut strain = 0.0f64;
        for m in &self.membranes[membranes] {
            strain = strain.max(m.add_forces(&self.materials[m.material as usize], x, forces));
        }
        self.hinges[hinges].iter().for_each(|h| h.add_forces(x, forces));
        strain
    }

    /// Stored elastic energy, J.
    pub fn elastic_energy(&self, x: &[Point3]) -> f64 {
        let membranes: f64 =
            self.membranes.iter().map(|m| m.energy(&self.materials[m.material as usize], x)).sum();
        membranes + self.hinges.iter().map(|h| h.energy(x)).sum::<f64>()
    }

    /// The highest angular frequency of its springs, rad/s.
    pub fn frequency(&self) -> f64 {
        highest(self)
    }

    /// The nodes' state in a garment: that of each node's least vertex.
    pub fn gather(&self, garment: &Garment) -> State {
        let own = |i: &usize| garment.weld[*i] as usize == *i;
        let roots = || (0..garment.weld.len()).filter(own);
        State {
            x: roots().map(|i| garment.positions[i]).collect(),
            v: roots().map(|i| garment.velocities[i]).collect(),
        }
    }

    /// Writes the state back: joined vertices get the same bits.
    pub fn scatter(&self, state: &State, garment: &mut Garment) {
        for (i, &node) in self.node_of.iter().enumerate() {
            garment.positions[i] = state.x[node as usize];
            garment.velocities[i] = state.v[node as usize];
        }
    }
}

/// Numbers the distinct representatives in ascending order.
fn nodes(weld: &[u32]) -> Vec<u32> {
    let mut number = vec![u32::MAX; weld.len()];
    let mut next = 0;
    for (i, &w) in weld.iter().enumerate() {
        if w as usize == i {
            number[i] = next;
            next += 1;
        }
    }
    weld.iter().map(|&w| number[w as usize]).collect()
}

fn node_count(node_of: &[u32]) -> usize {
    node_of.iter().max().map_or(0, |m| *m as usize + 1)
}

fn panels(garment: &Garment) -> Vec<u32> {
    let mut panel_of = vec![0; garment.triangles.len()];
    for (p, panel) in garment.panels.iter().enumerate() {
        panel_of[panel.triangles.clone()].fill(p as u32);
    }
    panel_of
}

/// Lumped masses, and the mass-weighted damping, of all nodes.
fn masses(garment: &Garment, membranes: &[Membrane], nodes: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut mass, mut damping) = (vec![0.0; nodes], vec![0.0; nodes]);
    for m in membranes {
        let fabric = &garment.panels[m.material as usize].fabric;
        let share = fabric.area_density * m.area / 3.0;
        for &n in &m.nodes {
            mass[n as usize] += share;
            damping[n as usize] += share * fabric.damping;
        }
    }
    let damping = damping.iter().zip(&mass).map(|(d, m)| if *m > 0.0 { d / m } else { 0.0 }).collect();
    (mass, damping)
}

fn sides(triangles: &[[u32; 3]]) -> Vec<Side> {
    let side = |t: usize, k: usize| {
        let (a, b) = (triangles[t][k], triangles[t][(k + 1) % 3]);
        ([a.min(b), a.max(b)], t, k)
    };
    let mut sides: Vec<Side> = (0..triangles.len()).flat_map(|t| (0..3).map(move |k| side(t, k))).collect();
    sides.sort_unstable();
    sides
}

/// A bending spring over each pair of triangles that follow each other around an edge.
fn hinges(garment: &Garment, triangles: &[[u32; 3]], panel_of: &[u32], sides: &[Side]) -> Vec<Hinge> {
    let wing = |&(nodes, t, k): &Side| {
        let corners = garment.triangles[t].map(|i| garment.rest[i as usize]);
        let fabric = &garment.panels[panel_of[t] as usize].fabric;
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let edge = if triangles[t][k] == nodes[0] { [a, b] } else { [b, a] };
        Wing { edge, tip: corners[(k + 2) % 3], bending: [fabric.bending_warp, fabric.bending_weft] }
    };
    let tip = |&(_, t, k): &Side| triangles[t][(k + 2) % 3];
    let pairs = sides.windows(2).filter(|w| w[0].0 == w[1].0 && tip(&w[0]) != tip(&w[1]));
    pairs
        .map(|w| {
            let nodes = [w[0].0[0], w[0].0[1], tip(&w[0]), tip(&w[1])];
            Hinge::new(nodes, [wing(&w[0]), wing(&w[1])])
        })
        .collect()
}

fn edges(garment: &Garment, node_of: &[u32], sides: &[Side]) -> Vec<Edge> {
    debug_assert_eq!(node_of.len(), garment.rest.len());
    let length = |&(_, t, k): &Side| {
        let corners = garment.triangles[t].map(|i| garment.rest[i as usize]);
        (corners[(k + 1) % 3] - corners[k]).norm()
    };
    sides
        .chunk_by(|a, b| a.0 == b.0)
        .map(|run| {
            let mean = run.iter().map(length).sum::<f64>() / run.len() as f64;
            Edge { nodes: run[0].0, length: mean }
        })
        .collect()
}
