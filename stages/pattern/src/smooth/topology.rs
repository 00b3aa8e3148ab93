//! Who is next to whom: neighbours of vertices, and stretches of the outline between pins.

use toile_core::artifact::{Panel, Point2};

/// An outline vertex where the outline turns more than this (degrees) is a corner. Named edges end
/// at corners whatever the angle.
const CORNER: f64 = 30.0;

/// Neighbours of each vertex, ascending.
#[derive(Debug, Clone)]
pub struct Neighbours {
    start: Vec<u32>,
    list: Vec<u32>,
}

impl Neighbours {
    /// From triangles over `vertices` vertices.
    pub fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(6 * triangles.len());
        for t in triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                pairs.extend([(a, b), (b, a)]);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut start = vec![0; vertices + 1];
        pairs.iter().for_each(|p| start[p.0 as usize + 1] += 1);
        for v in 0..vertices {
            start[v + 1] += start[v];
        }
        Neighbours { start, list: pairs.into_iter().map(|p| p.1).collect() }
    }

    /// The neighbours of a vertex.
    pub fn of(&self, v: usize) -> &[u32] {
        &self.list[self.start[v] as usize..self.start[v + 1] as usize]
    }
}

/// A run of outline vertices between two pins, both included; a closed one holds each once.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    pub vertices: Vec<u32>,
    pub closed: bool,
}

impl Stretch {
    /// The vertex `step` places after place `k`, where there is one on this stretch.
    pub(crate) fn at(&self, k: usize, step: isize) -> Option<u32> {
        let (n, i) = (self.vertices.len() as isize, k as isize + step);
        match self.closed {
            true => Some(self.vertices[i.rem_euclid(n) as usize]),
            false => (0..n).contains(&i).then(|| self.vertices[i as usize]),
        }
    }
}

/// What of a panel may move, and how.
#[derive(Debug, Clone)]
pub(crate) struct Topology {
    pub neighbours: Neighbours,
    /// True for vertices that are neither on the outline nor on an inner line.
    pub inner: Vec<bool>,
    /// The outlines, cut at corners, ends of named edges and feet of inner lines.
    pub stretches: Vec<Stretch>,
}

impl Topology {
    pub(crate) fn new(panel: &Panel) -> Self {
        let n = panel.positions.len();
        let mut inner = vec![true; n];
        let mut pinned = vec![false; n];
        for v in panel.boundary.iter().chain(panel.holes.iter().flatten()) {
            inner[*v as usize] = false;
        }
        for v in panel.inner.iter().flat_map(|c| &c.vertices) {
            inner[*v as usize] = false;
            pinned[*v as usize] = true;
        }
        for e in &panel.edges {
            [e.vertices.first(), e.vertices.last()]
                .into_iter()
                .flatten()
                .for_each(|&v| pinned[v as usize] = true);
        }
        let loops = std::iter::once(&panel.boundary).chain(&panel.holes);
        let stretches = loops.flat_map(|l| stretches_of(panel, l, &mut pinned)).collect();
        Topology { neighbours: Neighbours::new(n, &panel.triangles), inner, stretches }
    }
}

fn stretches_of(panel: &Panel, lp: &[u32], pinned: &mut [bool]) -> Vec<Stretch> {
    let n = lp.len();
    let at = |k: usize| panel.positions[lp[k % n] as usize];
    for k in 0..n {
        pinned[lp[k] as usize] |= turn(at(k + n - 1), at(k), at(k + 1)) > CORNER.to_radians();
    }
    let pins: Vec<usize> = (0..n).filter(|&k| pinned[lp[k] as usize]).collect();
    if pins.is_empty() {
        return vec![Stretch { vertices: lp.to_vec(), closed: true }];
    }
    let next = pins.iter().cycle().skip(1);
    let piece = |(&a, &b): (&usize, &usize)| {
        let count = (b + n - a - 1) % n + 1;
        Stretch { vertices: (0..=count).map(|k| lp[(a + k) % n]).collect(), closed: false }
    };
    pins.iter().zip(next).map(piece).collect()
}

/// The angle by which a path turns at `b`, radians.
fn turn(a: Point2, b: Point2, c: Point2) -> f64 {
    let (u, v) = (b - a, c - b);
    u.perp(&v).atan2(u.dot(&v)).abs()
}
