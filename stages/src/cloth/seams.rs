//! Seam forces and joining.
//!
//! Method: the two nodes of a pair pull each other with a spring of rest length 0 whose force is
//! limited, as a hand that pulls two edges together [METHODS 2: `f = c_s |p1 p2|`]; force and stiffness
//! are per metre of seam, so that they do not depend on the mesh. A pair nearer than the sewing
//! distance becomes one node with mass-weighted position and velocity: momentum is kept.
//! Cost: one root a pair.

use super::model::{Cloth, State};
use nalgebra::Vector3;
use toile_core::artifact::{Garment, Point3, SeamState};

/// How seams pull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeamPull {
    /// Force per metre of gap and metre of seam, N/m2.
    pub stiffness: f64,
    /// Greatest force per metre of seam, N/m.
    pub tension: f64,
    /// Damping of the gap's closing speed, N s/m2 (per metre of seam).
    pub damping: f64,
}

/// An open pair of nodes.
#[derive(Debug, Clone, Copy)]
struct Pair {
    nodes: [u32; 2],
    /// Length of seam that it stands for, metres.
    share: f64,
}

/// The open pairs of a garment's seams.
#[derive(Debug, Clone, Default)]
pub struct Seams {
    pairs: Vec<Pair>,
}

impl Seams {
    /// The pairs of all seams that are not yet one node.
    pub fn open(garment: &Garment, cloth: &Cloth) -> Self {
        let mut pairs = Vec::new();
        for seam in &garment.seams {
            let length = |k: usize| {
                let ends = |side: usize| {
                    let at = |j: usize| garment.rest[seam.pairs[j][side] as usize];
                    (at(k + 1) - at(k)).norm()
                };
                ends(0).max(ends(1))
            };
            let n = seam.pairs.len();
            for (k, pair) in seam.pairs.iter().enumerate() {
                let nodes = pair.map(|i| cloth.node_of[i as usize]);
                let before = if k > 0 { length(k - 1) } else { 0.0 };
                let after = if k + 1 < n { length(k) } else { 0.0 };
                if nodes[0] != nodes[1] {
                    pairs.push(Pair { nodes, share: ((before + after) / 2.0).max(1e-4) });
                }
            }
        }
        Seams { pairs }
    }

    /// True where every pair is joined.
    pub fn all_closed(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Number of open pairs.
    pub fn open_pairs(&self) -> usize {
        self.pairs.len()
    }

    /// Nodes of open pairs, so that collisions let them come together.
    pub fn partners(&self) -> impl Iterator<Item = [u32; 2]> {
        self.pairs.iter().map(|p| p.nodes)
    }

    /// Greatest gap of an open pair, metres.
    pub fn gap_max(&self, x: &[Point3]) -> f64 {
        self.pairs.iter().map(|p| gap(p, x)).fold(0.0, f64::max)
    }

    /// Sum of all gaps, metres.
    pub fn gap_sum(&self, x: &[Point3]) -> f64 {
        self.pairs.iter().map(|p| gap(p, x)).sum()
    }

    /// Adds the seams' forces to their nodes.
    pub fn add_forces(&self, pull: SeamPull, state: &State, forces: &mut [Vector3<f64>]) {
        for p in &self.pairs {
            let [a, b] = p.nodes.map(|n| n as usize);
            let apart = state.x[b] - state.x[a];
            let distance = apart.norm();
            if distance <= 0.0 {
                continue;
            }
            let closing = (state.v[b] - state.v[a]) * (pull.damping * p.share);
            let force = apart * (pull.tension.min(pull.stiffness * distance) * p.share / distance) + closing;
            forces[a] += force;
            forces[b] -= force;
        }
    }

    /// A bound on the stiffness over mass of any node that a seam pulls, 1/s2.
    pub fn frequency_square(&self, pull: SeamPull, cloth: &Cloth) -> f64 {
        let mut sum = vec![0.0; cloth.len()];
        for p in &self.pairs {
            p.nodes.iter().for_each(|&n| sum[n as usize] += 2.0 * pull.stiffness * p.share);
        }
        (0..cloth.len()).map(|i| sum[i] * cloth.inverse_inertia[i]).fold(0.0, f64::max)
    }
}

fn gap(p: &Pair, x: &[Point3]) -> f64 {
    (x[p.nodes[1] as usize] - x[p.nodes[0] as usize]).norm()
}

/// Joins every pair nearer than `distance`: the state of both nodes becomes their common
/// mass-weighted mean, and the garment's `weld` says so. Returns the number of pairs joined.
pub(super) fn join(garment: &mut Garment, cloth: &Cloth, state: &mut State, distance: f64) -> usize {
    let pairs: Vec<[u32; 2]> = garment.seams.iter().flat_map(|s| s.pairs.iter().copied()).collect();
    let mut groups = Groups::new(&garment.weld);
    let mut joined = 0;
    for [a, b] in pairs {
        let [i, j] = [a, b].map(|v| cloth.node_of[v as usize] as usize);
        if groups.root(a) != groups.root(b) && (state.x[i] - state.x[j]).norm() < distance {
            groups.unite(a, b);
            joined += 1;
        }
    }
    if joined > 0 {
        garment.weld = groups.least();
        merge(&garment.weld, cloth, state);
    }
    joined
}

/// Sets nodes whose vertices are welded to their mass-weighted mean, or to that of those among them that are held.
fn merge(weld: &[u32], cloth: &Cloth, state: &mut State) {
    let root_of = |i: usize| cloth.node_of[weld[i] as usize] as usize;
    let mut root = vec![usize::MAX; cloth.len()];
    for (i, &node) in cloth.node_of.iter().enumerate() {
        root[node as usize] = root_of(i);
    }
    let is_held = |i: usize| cloth.inertia[i] > 0.0 && cloth.inverse_inertia[i] == 0.0;
    let mut holds = vec![false; cloth.len()];
    root.iter().enumerate().for_each(|(i, &r)| holds[r] |= is_held(i));
    let mut sums = vec![(0.0, Vector3::zeros(), Vector3::zeros()); cloth.len()];
    for (i, &r) in root.iter().enumerate().filter(|(i, r)| is_held(*i) || !holds[**r]) {
        let (m, s) = (cloth.inertia[i], &mut sums[r]);
        *s = (s.0 + m, s.1 + state.x[i].coords * m, s.2 + state.v[i] * m);
    }
    for (i, &r) in root.iter().enumerate() {
        let (m, x, v) = sums[r];
        if m > cloth.inertia[i] || (holds[r] && !is_held(i)) {
            (state.x[i], state.v[i]) = (Point3::from(x / m), v / m);
        }
    }
}

/// Marks seams of which every pair is joined.
pub(super) fn mark_closed(garment: &mut Garment) {
    for seam in &mut garment.seams {
        let closed = seam.pairs.iter().all(|p| garment.weld[p[0] as usize] == garment.weld[p[1] as usize]);
        seam.state = if closed { SeamState::Closed } else { SeamState::Open };
    }
}

/// Disjoint sets of vertices, each known by its least member.
struct Groups(Vec<u32>);

impl Groups {
    fn new(weld: &[u32]) -> Self {
        Groups(weld.to_vec())
    }

    fn root(&self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            i = self.0[i as usize];
        }
        i
    }

    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    fn least(&self) -> Vec<u32> {
        (0..self.0.len() as u32).map(|i| self.root(i)).collect()
    }
}
