//! The cut pieces of a garment, flat: what one level of the solver works on.

use super::pattern::Pattern;
use super::system::{Support, System};
use crate::error::ClothError;
use crate::fabric::Fabric;
use crate::mesh::Sheet;
use crate::scene::Scene;
use nalgebra::{Vector2, Vector3};

/// Flat pieces and which of their vertices are sewn into one.
#[derive(Debug, Clone)]
pub struct Pieces {
    /// Rest coordinates of each vertex, m.
    pub rest: Vec<Vector2<f64>>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The sewn point that each vertex ends up at, 0 to `points`: both sides of a seam are coarsened together.
    pub point: Vec<u32>,
    /// How many sewn points there are.
    pub points: usize,
    /// The node that each vertex becomes, 0 to `nodes`: that of its sewn point, unless a seam there is not joined.
    pub node: Vec<u32>,
    /// How many nodes there are after sewing.
    pub nodes: usize,
    /// The panel that each vertex belongs to, counted from 1; 0 for a vertex of none.
    pub panel: Vec<u32>,
    /// The connected piece that each vertex belongs to.
    pub piece: Vec<u32>,
    /// Whether a vertex must stay where it is.
    pub pinned: Vec<bool>,
}

impl Pieces {
    /// The pieces of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let n = scene.rest.len();
        let (point, points) = groups(n, scene.seams.iter().flat_map(|s| &s.pairs).copied());
        let joined = scene.seams.iter().filter(|s| s.joined);
        let (node, nodes) = groups(n, joined.flat_map(|s| &s.pairs).copied());
        let mut panel = vec![0; n];
        for (k, p) in scene.panels.iter().enumerate() {
            panel[p.vertices.clone()].fill(k as u32 + 1);
        }
        let sides = scene.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]);
        let (piece, _) = groups(n, sides);
        let mut pinned = vec![false; n];
        scene.pinned.iter().for_each(|&p| pinned[p as usize] = true);
        let (rest, triangles) = (scene.rest.clone(), scene.triangles.clone());
        Self { rest, triangles, point, points, node, nodes, panel, piece, pinned }
    }

    /// The sheet before sewing: every vertex a node of its own.
    pub fn open_sheet(&self, cloths: &[&Fabric]) -> Result<Sheet, ClothError> {
        Sheet::flat(&self.rest, &self.triangles, 1.0)?.weighing(|t| cloths[self.cloth(t)].density)
    }

    /// The sheet after sewing: every sewn point a node.
    pub fn sewn_sheet(&self, cloths: &[&Fabric]) -> Result<Sheet, ClothError> {
        let nodes = self.triangles.iter().map(|t| t.map(|v| self.node[v as usize])).collect();
        let corners = self.triangles.iter().map(|t| t.map(|v| self.rest[v as usize])).collect();
        Sheet::new(self.nodes, nodes, corners, 1.0)?.weighing(|t| cloths[self.cloth(t)].density)
    }

    /// The panel of a triangle, counted from 1; 0 for none.
    #[must_use]
    pub fn cloth(&self, triangle: usize) -> usize {
        self.panel[self.triangles[triangle][0] as usize] as usize
    }

    /// The mean of `values` over the vertices of each node, weighted.
    #[must_use]
    pub fn sew(&self, values: &[Vector3<f64>], weights: &[f64]) -> Vec<Vector3<f64>> {
        let mut sums = vec![(Vector3::zeros(), 0.0); self.nodes];
        for ((v, w), &p) in values.iter().zip(weights).zip(&self.node) {
            let sum = &mut sums[p as usize];
            sum.0 += v * *w;
            sum.1 += w;
        }
        sums.into_iter().map(|(v, w)| if w > 0.0 { v / w } else { v }).collect()
    }

    /// The distance at which the body presses on each vertex.
    pub(super) fn offsets(&self, system: &System<'_>) -> Vec<f64> {
        let of = |s: &Support<'_>| self.node.iter().map(|&n| s.offsets[n as usize]).collect();
        system.support.as_ref().map_or_else(Vec::new, of)
    }

    /// The value of each vertex's node.
    #[must_use]
    pub fn spread(&self, values: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        self.node.iter().map(|&p| values[p as usize]).collect()
    }

    /// Pairs of vertices that become one point.
    #[must_use]
    pub fn seam_pairs(&self) -> Vec<[u32; 2]> {
        let mut first = vec![u32::MAX; self.points];
        let mut pairs = Vec::new();
        for (v, &p) in self.point.iter().enumerate() {
            match first[p as usize] {
                u32::MAX => first[p as usize] = v as u32,
                earlier => pairs.push([earlier, v as u32]),
            }
        }
        pairs
    }

    /// Pairs of nodes that stay two at one sewn point, held by thread.
    #[must_use]
    pub fn kept_pairs(&self) -> Vec<[u32; 2]> {
        let pairs = self.seam_pairs().into_iter().map(|p| p.map(|v| self.node[v as usize]));
        let mut kept: Vec<[u32; 2]> = pairs.filter(|[a, b]| a != b).collect();
        kept.sort_unstable();
        kept.dedup();
        kept
    }

    /// The pattern of sewn points that share a triangle.
    #[must_use]
    pub fn neighbours(&self) -> Pattern {
        let groups: Vec<[u32; 3]> =
            self.triangles.iter().map(|t| t.map(|v| self.point[v as usize])).collect();
        Pattern::new(self.points, groups.iter().map(|g| &g[..]))
    }
}

/// Numbers the groups that `pairs` connect, in the order of their first members.
fn groups(n: usize, pairs: impl Iterator<Item = [u32; 2]>) -> (Vec<u32>, usize) {
    let mut parent: Vec<u32> = (0..n as u32).collect();
    fn root(parent: &mut [u32], mut i: u32) -> u32 {
        while parent[i as usize] != i {
            parent[i as usize] = parent[parent[i as usize] as usize];
            i = parent[i as usize];
        }
        i
    }
    for [a, b] in pairs {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut number = vec![u32::MAX; n];
    let mut count = 0;
    let of = (0..n as u32)
        .map(|i| {
            let r = root(&mut parent, i) as usize;
            if number[r] == u32::MAX {
                number[r] = count;
                count += 1;
            }
            number[r]
        })
        .collect();
    (of, count as usize)
}
