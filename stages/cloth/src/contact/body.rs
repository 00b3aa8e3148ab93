//! The body: signed distance to a closed, static triangle mesh.
//!
//! Method: a tree of boxes built once, nearest box first; the sign comes from angle-weighted normals of faces, sides and
//! corners (Baerentzen, Aanaes 2005), which is right for every point of a closed mesh. Cost O(log n) a query; less where
//! the caller knows an upper bound, which it does after every small step.

use super::closest::{Feature, on_triangle};
use super::facets::Facets;
use super::sharp::Sharp;
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

type Vec3 = Vector3<f64>;

/// Triangles in a leaf: below that, testing them all is cheaper than more boxes.
const LEAF_TRIANGLES: usize = 4;

/// A point nearer to the surface than this takes its normal from the surface, not from the difference, m.
const ON_SURFACE: f64 = 1e-9;

/// A closed, static triangle mesh whose triangles face outwards.
#[derive(Debug, Clone)]
pub struct Body {
    vertices: Vec<Vec3>,
    /// In the order of the tree's leaves.
    triangles: Vec<[u32; 3]>,
    corners: Vec<[Vec3; 3]>,
    /// Of each triangle: its face, its sides, its corners.
    normals: Vec<[Vec3; 7]>,
    boxes: Vec<Node>,
    sharp: Option<Arc<Sharp>>,
    /// Made when they are first asked for.
    facets: OnceLock<Option<Facets>>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// First triangle of a leaf, or index of the left child; the right one follows the left.
    first: u32,
    /// Triangles of a leaf; 0 for an inner node.
    count: u32,
}

/// Where a point is in relation to the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Distance, m; negative inside.
    pub distance: f64,
    /// Unit direction in which the distance grows.
    pub normal: Vec3,
    /// The closest point of the surface.
    pub point: Vec3,
}

impl Body {
    /// Builds the tree. Triangles must refer to vertices that exist; an empty body is far from everything.
    #[must_use]
    pub fn new(vertices: Vec<Vec3>, triangles: &[[u32; 3]]) -> Self {
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let centres: Vec<Vec3> =
            triangles.iter().map(|t| t.iter().map(|&v| vertices[v as usize]).sum::<Vec3>() / 3.0).collect();
        let mut boxes = vec![];
        if !triangles.is_empty() {
            boxes.push(Node { low: Vec3::zeros(), high: Vec3::zeros(), first: 0, count: 0 });
            split(0, &mut order, 0, &centres, &mut boxes);
        }
        let all = pseudo_normals(&vertices, triangles);
        let sorted: Vec<[u32; 3]> = order.iter().map(|&t| triangles[t as usize]).collect();
        let corners = sorted.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
        let normals = order.iter().map(|&t| all[t as usize]).collect();
        let sharp = Sharp::of(&vertices, triangles).map(Arc::new);
        let mut body =
            Self { vertices, triangles: sorted, corners, normals, boxes, sharp, facets: OnceLock::new() };
        body.fit();
        body
    }

    /// Its vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// Its triangles, in the order of the tree.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Its sharp edges and corners, if it has any.
    #[must_use]
    pub fn sharp(&self) -> Option<Arc<Sharp>> {
        self.sharp.clone()
    }

    /// Its triangles, for cloth that may pass through them; none of an empty body.
    #[must_use]
    pub fn facets(&self) -> Option<&Facets> {
        self.facets.get_or_init(|| Facets::of(&self.vertices, &self.triangles)).as_ref()
    }

    fn fit(&mut self) {
        for k in (0..self.boxes.len()).rev() {
            let node = self.boxes[k];
            let (low, high) = if node.count > 0 {
                bounds(self.corners[node.first as usize..(node.first + node.count) as usize].iter().flatten())
            } else {
                let (a, b) = (&self.boxes[node.first as usize], &self.boxes[node.first as usize + 1]);
                (a.low.inf(&b.low), a.high.sup(&b.high))
            };
            (self.boxes[k].low, self.boxes[k].high) = (low, high);
        }
    }

    /// The surface nearest to `p`, if it is nearer than `within`.
    #[must_use]
    pub fn nearest(&self, p: &Vec3, within: f64) -> Option<Nearest> {
        let mut best = within * within;
        let mut found = None;
        // Nodes to come and how far away they are.
        let mut stack = [(0u32, 0.0f64); 64];
        let mut depth = usize::from(!self.boxes.is_empty());
        while depth > 0 {
            depth -= 1;
            let (k, gap) = stack[depth];
            if gap >= best {
                continue;
            }
            let node = &self.boxes[k as usize];
            if node.count == 0 {
                let gaps = [0, 1].map(|c| gap_squared(&self.boxes[(node.first + c) as usize], p));
                let nearer = u32::from(gaps[1] <= gaps[0]);
                for c in [1 - nearer, nearer] {
                    if gaps[c as usize] < best {
                        stack[depth] = (node.first + c, gaps[c as usize]);
                        depth += 1;
                    }
                }
                continue;
            }
            for t in node.first as usize..(node.first + node.count) as usize {
                let on = on_triangle(p, &self.corners[t]);
                let d = (p - on.point).norm_squared();
                if d < best {
                    best = d;
                    found = Some((t, on));
                }
            }
        }
        found.map(|(t, on)| self.signed(p, t, &on))
    }

    /// The move from `p` by `by`, ended `gap` outside the surface where it would enter the body.
    ///
    /// The way is walked in steps no longer than the distance from the surface, so nothing is jumped over. A point that
    /// starts inside may move as it likes.
    #[must_use]
    pub fn guard(&self, p: &Vec3, by: &Vec3, gap: f64) -> Vec3 {
        let length = by.norm();
        let start = self.nearest(p, length + gap);
        if start.is_none_or(|n| n.distance < 0.0) {
            return *by;
        }
        let mut t = start.map_or(0.0, |n| n.distance.max(gap)) / length;
        while t < 1.0 {
            let at = p + by * t;
            match self.nearest(&at, length + gap) {
                None => break,
                Some(n) if n.distance < 0.0 => return n.point + n.normal * gap - p,
                Some(n) => t += n.distance.max(gap) / length,
            }
        }
        match self.nearest(&(p + by), length + gap) {
            Some(n) if n.distance < 0.0 => n.point + n.normal * gap - p,
            _ => *by,
        }
    }

    fn signed(&self, p: &Vec3, t: usize, on: &super::closest::OnTriangle) -> Nearest {
        let surface = match on.feature {
            Feature::Face => self.normals[t][0],
            Feature::Side(k) => self.normals[t][1 + k as usize],
            Feature::Corner(k) => self.normals[t][4 + k as usize],
        };
        let away = p - on.point;
        let length = away.norm();
        if length < ON_SURFACE {
            return Nearest { distance: away.dot(&surface), normal: surface, point: on.point };
        }
        let sign = if away.dot(&surface) < 0.0 { -1.0 } else { 1.0 };
        Nearest { distance: sign * length, normal: away * (sign / length), point: on.point }
    }
}

fn bounds<'a>(points: impl Iterator<Item = &'a Vec3>) -> (Vec3, Vec3) {
    let nothing = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    points.fold(nothing, |(low, high), p| (low.inf(p), high.sup(p)))
}

fn split(k: usize, order: &mut [u32], offset: usize, centres: &[Vec3], boxes: &mut Vec<Node>) {
    if order.len() <= LEAF_TRIANGLES {
        (boxes[k].first, boxes[k].count) = (offset as u32, order.len() as u32);
        return;
    }
    let (low, high) = bounds(order.iter().map(|&t| &centres[t as usize]));
    let axis = (high - low).imax();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| {
        centres[a as usize][axis].total_cmp(&centres[b as usize][axis]).then(a.cmp(&b))
    });
    let left = boxes.len();
    boxes[k].first = left as u32;
    let empty = Node { low: Vec3::zeros(), high: Vec3::zeros(), first: 0, count: 0 };
    boxes.extend([empty, empty]);
    let (a, b) = order.split_at_mut(half);
    split(left, a, offset, centres, boxes);
    split(left + 1, b, offset + half, centres, boxes);
}

fn gap_squared(node: &Node, p: &Vec3) -> f64 {
    (node.low - p).sup(&(p - node.high)).sup(&Vec3::zeros()).norm_squared()
}

fn pseudo_normals(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[Vec3; 7]> {
    let mut corners = vec![Vec3::zeros(); vertices.len()];
    let mut sides: BTreeMap<(u32, u32), Vec3> = BTreeMap::new();
    let faces: Vec<Vec3> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
        })
        .collect();
    for (t, n) in triangles.iter().zip(&faces) {
        for k in 0..3 {
            let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            let at = vertices[a as usize];
            let angle = (vertices[b as usize] - at).angle(&(vertices[c as usize] - at)).clamp(0.0, PI);
            corners[a as usize] += n * angle;
            *sides.entry((a.min(b), a.max(b))).or_default() += n;
        }
    }
    let unit = |v: Vec3, or: &Vec3| v.try_normalize(1e-12).unwrap_or(*or);
    triangles
        .iter()
        .zip(&faces)
        .map(|(t, n)| {
            let side = |k: usize| {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                unit(sides.get(&(a.min(b), a.max(b))).copied().unwrap_or_default(), n)
            };
            let corner = |k: usize| unit(corners[t[k] as usize], n);
            [*n, side(0), side(1), side(2), corner(0), corner(1), corner(2)]
        })
        .collect()
}
