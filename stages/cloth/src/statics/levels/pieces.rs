//! The flat cut pieces of a garment on one mesh level, and how they are sewn.
//!
//! Cost: O(n log n) to make.

use crate::energy::Band as Piece;
use crate::error::ClothError;
use crate::fabric::Fabric;
use crate::linear::Pattern;
use crate::mesh::{Sheet, Side};
use crate::scene::{Band, Scene};
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::system::System;
use nalgebra::{Vector2, Vector3};
use toile_geometry::components::{groups, links};

/// The flat pieces, and which of their vertices are sewn together.
#[derive(Debug, Clone)]
pub struct Pieces {
    /// Rest coordinates of each vertex, m.
    pub rest: Vec<Vector2<f64>>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The sewn point of each vertex, 0 to `points`. Both sides of a seam have the same point, so
    /// that they are coarsened together.
    pub point: Vec<u32>,
    /// The number of sewn points.
    pub points: usize,
    /// The node of each vertex, 0 to `nodes`: that of its sewn point, unless a seam there is not
    /// joined.
    pub node: Vec<u32>,
    /// The number of nodes after sewing.
    pub nodes: usize,
    /// The panel of each vertex, counted from 1; 0 for none.
    pub panel: Vec<u32>,
    /// Whether a vertex lies on a seam that gathers.
    pub gathered: Vec<bool>,
    /// The rest angle between the two sheets of a seam that is pressed to stay folded, for its
    /// vertices, radians.
    pub fold: Vec<Option<f64>>,
    /// Elastic bands.
    pub bands: Vec<Path>,
    /// The connected piece of each vertex.
    pub piece: Vec<u32>,
    /// Whether a vertex is pinned.
    pub pinned: Vec<bool>,
}

/// An elastic band on one level.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Its vertices.
    pub vertices: Vec<u32>,
    /// Unstretched length between consecutive vertices, m; 0 from one side of a seam to the other.
    pub lengths: Vec<f64>,
    /// Force per unit of strain, N.
    pub stiffness: f64,
}

impl Path {
    fn new(band: &Band, scene: &Scene, point: &[u32]) -> Self {
        let length = |w: &[u32]| {
            let (a, b) = (w[0] as usize, w[1] as usize);
            if point[a] == point[b] { 0.0 } else { band.ratio * (scene.rest[a] - scene.rest[b]).norm() }
        };
        let lengths = band.vertices.windows(2).map(length).collect();
        Self { vertices: band.vertices.clone(), lengths, stiffness: band.stiffness }
    }

    /// The path over the vertices that are kept: those whose `number` is not `u32::MAX`.
    #[must_use]
    pub fn restrict(&self, number: &[u32]) -> Self {
        let mut out = Self { vertices: vec![], lengths: vec![], stiffness: self.stiffness };
        let mut length = 0.0;
        for (k, &v) in self.vertices.iter().enumerate() {
            if number[v as usize] != u32::MAX {
                if !out.vertices.is_empty() {
                    out.lengths.push(length);
                }
                out.vertices.push(number[v as usize]);
                length = 0.0;
            }
            length += self.lengths.get(k).copied().unwrap_or(0.0);
        }
        out
    }
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
        let (piece, _) = groups(n, links(&scene.triangles));
        let mut pinned = vec![false; n];
        scene.pinned.iter().for_each(|&p| pinned[p as usize] = true);
        let mut gathered = vec![false; n];
        let gathers = scene.seams.iter().filter(|s| s.gather.is_some());
        gathers.flat_map(|s| &s.pairs).flatten().for_each(|&v| gathered[v as usize] = true);
        let mut fold = vec![None; n];
        for s in scene.seams.iter().filter(|s| s.fold.is_some()) {
            s.pairs.iter().flatten().for_each(|&v| fold[v as usize] = s.fold);
        }
        let bands = scene.bands.iter().map(|b| Path::new(b, scene, &point)).collect();
        let (rest, triangles) = (scene.rest.clone(), scene.triangles.clone());
        let mut pieces =
            Self { rest, triangles, point, points, node, nodes, panel, gathered, fold, bands, piece, pinned };
        pieces.part_ears(&scene.seams);
        pieces
    }

    /// The sheet before sewing, in which every vertex is a node.
    pub fn open_sheet(&self, cloths: &[&Fabric]) -> Result<Sheet, ClothError> {
        Sheet::new(self.rest.len(), self.triangles.clone(), self.corners(), 1.0)?
            .weighing(|t| cloths[self.cloth(t)].density)
    }

    /// The sheet after sewing.
    pub fn sewn_sheet(&self, cloths: &[&Fabric]) -> Result<Sheet, ClothError> {
        let nodes = self.triangles.iter().map(|t| t.map(|v| self.node[v as usize])).collect();
        Sheet::sewn(self.nodes, nodes, self.corners(), 1.0)?.weighing(|t| cloths[self.cloth(t)].density)
    }

    /// The pieces as they are cut, where gathers change the sheets; otherwise `None`.
    #[must_use]
    pub fn uncut(&self) -> Option<Result<Sheet, ClothError>> {
        self.gathered.contains(&true).then(|| Sheet::flat(&self.rest, &self.triangles, 1.0))
    }

    /// Rest corners of every triangle. Along a gathered seam the longer side is shortened to the
    /// length of the shorter one.
    fn corners(&self) -> Vec<[Vector2<f64>; 3]> {
        let mut corners: Vec<[Vector2<f64>; 3]> =
            self.triangles.iter().map(|t| t.map(|v| self.rest[v as usize])).collect();
        let mut sides = Vec::new();
        for (t, v) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let ends = [v[(k + 1) % 3], v[(k + 2) % 3]];
                if ends.iter().all(|&v| self.gathered[v as usize]) {
                    let mut key = ends.map(|v| self.point[v as usize]);
                    key.sort_unstable();
                    let length = (corners[t][(k + 1) % 3] - corners[t][(k + 2) % 3]).norm();
                    sides.push((key, t, k, length));
                }
            }
        }
        sides.sort_unstable_by_key(|s| (s.0, s.1, s.2));
        for pair in sides.chunk_by(|a, b| a.0 == b.0).filter(|c| c.len() == 2) {
            let shorter = pair[0].3.min(pair[1].3);
            for &(_, t, k, length) in pair {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let inwards = (corners[t][j] - corners[t][i]) * (0.5 * (1.0 - shorter / length));
                corners[t][i] += inwards;
                corners[t][j] -= inwards;
            }
        }
        corners
    }

    /// The sewn point of every node.
    #[must_use]
    pub fn node_points(&self) -> Vec<u32> {
        let mut points = vec![0; self.nodes];
        self.node.iter().zip(&self.point).for_each(|(&n, &p)| points[n as usize] = p);
        points
    }

    /// Springs of the bands between consecutive vertices, or nodes where the seams are closed.
    #[must_use]
    pub fn springs(&self, open: bool) -> Vec<Piece> {
        let mut springs = Vec::new();
        for band in &self.bands {
            for (w, &length) in band.vertices.windows(2).zip(&band.lengths) {
                let one = self.piece[w[0] as usize] == self.piece[w[1] as usize];
                let nodes = [w[0], w[1]].map(|v| if open { v } else { self.node[v as usize] });
                if length > 0.0 && nodes[0] != nodes[1] && (one || !open) {
                    springs.push(Piece { nodes, length, stiffness: band.stiffness });
                }
            }
        }
        springs
    }

    /// Edges of the sewn sheet that are pressed to stay folded: the index of each among those with
    /// two triangles, and its angle.
    #[must_use]
    pub fn creases(&self, sheet: &Sheet) -> Vec<(usize, f64)> {
        if self.fold.iter().all(Option::is_none) {
            return Vec::new();
        }
        let ends = |side: &Side| {
            let (t, k) = (self.triangles[side.triangle as usize], side.corner as usize);
            let mut ends = [t[(k + 1) % 3], t[(k + 2) % 3]];
            ends.sort_unstable_by_key(|v| self.node[*v as usize]);
            ends
        };
        let inner = sheet.edges().iter().filter_map(|e| Some((e.sides.0, e.sides.1?)));
        let crease = |(k, (one, other)): (usize, (Side, Side))| {
            let (a, b) = (ends(&one), ends(&other));
            let angle = |v: u32| self.fold[v as usize];
            let is_seam = a[0] != b[0] && a[1] != b[1];
            angle(a[1]).and(angle(a[0])).filter(|_| is_seam).map(|angle| (k, angle))
        };
        inner.enumerate().filter_map(crease).collect()
    }

    /// The panel of a triangle, counted from 1; 0 for none.
    #[must_use]
    pub fn cloth(&self, triangle: usize) -> usize {
        self.panel[self.triangles[triangle][0] as usize] as usize
    }

    /// The weighted mean of `values` over the vertices of each node, or over the pinned ones among
    /// them. A pinned vertex without a triangle has no mass, and its weight is 1.
    #[must_use]
    pub fn sew(&self, values: &[Vector3<f64>], weights: &[f64]) -> Vec<Vector3<f64>> {
        let mut is_held = vec![false; self.nodes];
        self.node.iter().zip(&self.pinned).for_each(|(&p, &pinned)| is_held[p as usize] |= pinned);
        let mut sums = vec![(Vector3::zeros(), 0.0); self.nodes];
        for (((v, w), &p), &pinned) in values.iter().zip(weights).zip(&self.node).zip(&self.pinned) {
            if is_held[p as usize] && !pinned {
                continue;
            }
            let w = if pinned && *w == 0.0 { 1.0 } else { *w };
            let sum = &mut sums[p as usize];
            sum.0 += v * w;
            sum.1 += w;
        }
        sums.into_iter().map(|(v, w)| if w > 0.0 { v / w } else { v }).collect()
    }

    /// The offset of body contact at each vertex, m.
    pub(crate) fn offsets(&self, system: &System<'_>) -> Vec<f64> {
        let of = |s: &BodyContact| self.node.iter().map(|&n| s.offsets[n as usize]).collect();
        system.get::<BodyContact>().map_or_else(Vec::new, of)
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

    /// Pairs of nodes at one sewn point that are not joined.
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
        Pattern::new(self.points, |visit| groups.iter().for_each(|g| visit(g)))
    }
}

/// The number of cloths of a scene, each connected by triangles or seams.
pub(crate) fn count_cloths(scene: &Scene) -> usize {
    groups(
        scene.rest.len(),
        links(&scene.triangles).chain(scene.seams.iter().flat_map(|s| &s.pairs).copied()),
    )
    .1
}
