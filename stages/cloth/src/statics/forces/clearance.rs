//! Body clearance: whether triangles dip into the body between their vertices.
//!
//! Vertices rest a thickness outside the body. On a curved body the triangle between them is
//! nearer, by the square of its length over eight radii, and dips in where the mesh is coarse.
//! Method: the distance is evaluated on a lattice of points of each triangle near the body, and
//! what is missing is added to the offsets of its corners. Where the body has triangles, crossings
//! with them between the points are found as well. Cost: a distance per lattice point and a query
//! of the tree of the body per triangle, once the cloth is at rest. Limits: features finer than the
//! lattice, of a body without triangles.

use crate::contact::collision_surface::CollisionSurface;
use crate::mesh::Sheet;
use nalgebra::Vector3;
use rayon::prelude::*;
use toile_geometry::facets::Facets;

type Vec3 = Vector3<f64>;

/// Spacing of the lattice, m: over a limb of 2 cm radius the surface between its points rises by
/// less than [`GAP`] and a half.
const SPACING: f64 = 0.006;

/// Most points along an edge.
const MOST: usize = 8;

/// Triangles per parallel task.
const CHUNK: usize = 64;

/// Crossings of a triangle with facets that are evaluated, with the middles between them, at most.
const MOST_PLACES: usize = 12;

/// Rounds in which nodes are moved outwards without regard to forces.
const LIFTS: usize = 10;

/// The least distance that lattice points must keep, m.
pub const GAP: f64 = 2e-4;

/// Least radius of the body at which dips between vertices are found, m.
pub(crate) const LEAST_RADIUS: f64 = 0.02;

/// The clearance of all triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    /// What must be added to the offset of each node, m.
    pub lacks: Vec<f64>,
    /// The direction out of the body where most of that is lacking; zero for nodes that lack
    /// nothing.
    pub outwards: Vec<Vec3>,
    /// The deepest point inside the body, m; 0 where none is.
    pub depth: f64,
    /// The number of triangles that dip in or cross facets.
    pub triangles: usize,
}

impl Clearance {
    /// Asks for so much more of the nodes of a triangle, in the direction `outwards`.
    fn ask(&mut self, nodes: &[u32; 3], lack: f64, outwards: Vec3) {
        for v in nodes.map(|v| v as usize) {
            if lack > self.lacks[v] {
                (self.lacks[v], self.outwards[v]) = (lack, outwards);
            }
        }
    }
}

/// Moves nodes outwards, without regard to forces, until no triangle dips in or crosses facets;
/// none where that takes more than `farthest` (m) of a node, or a node is `pinned`.
pub(crate) fn lifted(
    sheet: &Sheet,
    body: &dyn CollisionSurface,
    x: &[Vec3],
    pinned: &[bool],
    farthest: f64,
) -> Option<Vec<Vec3>> {
    let mut lifted = x.to_vec();
    for _ in 0..LIFTS {
        let Clearance { lacks, outwards, triangles, .. } = clearance(sheet, body, &lifted);
        if triangles == 0 {
            return Some(lifted);
        }
        for (v, p) in lifted.iter_mut().enumerate().filter(|(v, _)| lacks[*v] > 0.0) {
            *p += outwards[v] * lacks[v];
            if pinned[v] || (*p - x[v]).norm() > farthest {
                return None;
            }
        }
    }
    None
}

/// Evaluates the clearance of every triangle that may dip into the body.
#[must_use]
pub fn clearance(sheet: &Sheet, body: &dyn CollisionSurface, x: &[Vec3]) -> Clearance {
    let longest = sheet.edges().iter().map(|e| e.rest_length).fold(0.0, f64::max);
    let reach = GAP + longest * longest / (8.0 * LEAST_RADIUS);
    let near: Vec<bool> = body.nearest(x, &vec![reach; x.len()]).iter().map(Option::is_some).collect();
    let mut points = Vec::new();
    let mut of = Vec::new();
    for (t, nodes) in sheet.triangles().iter().enumerate() {
        if nodes.iter().any(|&v| near[v as usize]) {
            let corners = nodes.map(|v| x[v as usize]);
            lattice(&corners, |p| {
                points.push(p);
                of.push(t);
            });
        }
    }
    let found = body.nearest(&points, &vec![GAP + reach; points.len()]);
    let none = vec![Vec3::zeros(); x.len()];
    let mut out = Clearance { lacks: vec![0.0; x.len()], outwards: none, depth: 0.0, triangles: 0 };
    let mut last = usize::MAX;
    for (&t, n) in of.iter().zip(found).filter_map(|(t, n)| Some((t, n?))) {
        if n.distance < GAP {
            out.ask(&sheet.triangles()[t], GAP - n.distance, n.normal);
        }
        out.depth = out.depth.max(-n.distance);
        if n.distance < 0.0 && t != last {
            (out.triangles, last) = (out.triangles + 1, t);
        }
    }
    if let Some(facets) = body.facets() {
        add_crossings(sheet, body, facets, x, &near, &mut out);
    }
    out
}

/// Adds the depth of triangles with a node `near` the body that cross its facets: that of the
/// middles between their crossings.
fn add_crossings(
    sheet: &Sheet,
    body: &dyn CollisionSurface,
    facets: &Facets,
    x: &[Vec3],
    near: &[bool],
    out: &mut Clearance,
) {
    let asked: Vec<&[u32; 3]> =
        sheet.triangles().iter().filter(|t| t.iter().any(|&v| near[v as usize])).collect();
    let places: Vec<Vec<Vec3>> =
        asked.par_iter().with_min_len(CHUNK).map(|t| facets.crossings(&t.map(|v| x[v as usize]))).collect();
    for (t, places) in asked.iter().zip(&places).filter(|(_, p)| !p.is_empty()) {
        let places = &places[..places.len().min(MOST_PLACES)];
        let middles: Vec<Vec3> =
            (0..places.len()).flat_map(|i| places[..=i].iter().map(move |p| (places[i] + p) * 0.5)).collect();
        let deep = body.nearest(&middles, &vec![f64::INFINITY; middles.len()]);
        let deepest = deep.into_iter().flatten().min_by(|a, b| a.distance.total_cmp(&b.distance));
        let depth = deepest.map_or(0.0, |n| (-n.distance).max(0.0));
        out.ask(t, GAP + depth, deepest.map_or_else(Vec3::zeros, |n| n.normal));
        (out.triangles, out.depth) = (out.triangles + 1, out.depth.max(depth));
    }
}

/// Visits the points of the lattice except the corners.
pub(crate) fn lattice([a, b, c]: &[Vec3; 3], mut visit: impl FnMut(Vec3)) {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    let n = ((longest / SPACING).ceil() as usize).clamp(2, MOST);
    for i in 0..=n {
        for j in (0..=n - i).filter(|&j| i < n && j < n && i + j > 0) {
            let (s, t) = (i as f64 / n as f64, j as f64 / n as f64);
            visit(a * (1.0 - s - t) + b * s + c * t);
        }
    }
}
