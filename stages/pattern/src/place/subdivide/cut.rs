//! Panels with their edges cut: the numbers of all vertices, what these have, and the triangles
//! between them.

use super::edges::Edges;
use nalgebra::SVector;
use std::ops::Range;
use toile_core::prelude::*;

/// Triangles between two looks at the stop flag.
const CHECK_EVERY: usize = 1000;

/// The vertices of the cut garment: of each panel the old ones, then those on its edges, then those
/// in its triangles.
pub(super) struct GarmentCut<'a> {
    old: &'a Garment,
    edges: &'a Edges,
    /// Parts of each edge, at least 1.
    pub(super) parts: usize,
    /// Where each old vertex went.
    pub(super) kept: Vec<usize>,
    /// For each edge the first vertex on it, next to its lower end.
    on_edge: Vec<usize>,
    /// For each triangle the first vertex in it.
    in_triangle: Vec<usize>,
    /// The vertices of each panel.
    panels: Vec<Range<usize>>,
}

impl<'a> GarmentCut<'a> {
    pub(super) fn new(old: &'a Garment, edges: &'a Edges, parts: usize) -> Self {
        let (mut kept, mut on_edge, mut in_triangle) = (Vec::new(), Vec::new(), Vec::new());
        let (mut panels, mut next) = (Vec::new(), 0);
        for (panel, own) in old.panels.iter().zip(&edges.panels) {
            let start = next;
            let mut number = |firsts: &mut Vec<usize>, count: usize, each: usize| {
                firsts.extend((0..count).map(|k| next + k * each));
                next += count * each;
            };
            number(&mut kept, panel.vertices.len(), 1);
            number(&mut on_edge, own.len(), parts - 1);
            number(&mut in_triangle, panel.triangles.len(), inner(parts).count());
            panels.push(start..next);
        }
        GarmentCut { old, edges, parts, kept, on_edge, in_triangle, panels }
    }

    /// How many vertices there are.
    pub(super) fn count(&self) -> usize {
        self.panels.last().map_or(0, |p| p.end)
    }

    /// The vertex `k` parts from the end `from` of an edge.
    pub(super) fn along(&self, edge: usize, from: u32, k: usize) -> u32 {
        let [low, high] = self.edges.ends[edge];
        let k = if from == low { k } else { self.parts - k };
        let vertex = match k {
            0 => self.kept[low as usize],
            k if k == self.parts => self.kept[high as usize],
            k => self.on_edge[edge] + k - 1,
        };
        vertex as u32
    }

    /// The garment, its seams not yet sewn and new vertices not yet joined.
    pub(super) fn garment(&self, cx: &Context) -> Result<Garment, StageError> {
        let old = self.old;
        let kept = |v: &u32| self.kept[*v as usize] as u32;
        let mut weld: Vec<u32> = (0..self.count() as u32).collect();
        self.kept.iter().zip(&old.weld).for_each(|(&v, w)| weld[v] = kept(w));
        let mut fine = Garment {
            positions: Vec::with_capacity(self.count()),
            velocities: Vec::with_capacity(self.count()),
            rest: Vec::with_capacity(self.count()),
            triangles: Vec::with_capacity(old.triangles.len() * self.parts * self.parts),
            panels: Vec::new(),
            seams: Vec::new(),
            weld,
            pinned: old.pinned.iter().map(kept).collect(),
            status: SolveStatus { converged: false, held: Held::default(), ..old.status.clone() },
            starts: Vec::new(),
            motion: old.motion.clone(),
        };
        for k in 0..old.panels.len() {
            cx.check()?;
            fine.positions.extend(self.spread(k, |v| old.positions[v].coords).into_iter().map(Point3::from));
            cx.check()?;
            fine.velocities.extend(self.spread(k, |v| old.velocities[v]));
            cx.check()?;
            fine.rest.extend(self.spread(k, |v| old.rest[v].coords).into_iter().map(Point2::from));
            let start = fine.triangles.len();
            for (n, t) in old.panels[k].triangles.clone().enumerate() {
                if n % CHECK_EVERY == 0 {
                    cx.check()?;
                }
                self.triangles(t, &mut fine.triangles);
            }
            fine.panels.push(self.panel(k, start..fine.triangles.len()));
        }
        Ok(fine)
    }

    fn panel(&self, k: usize, triangles: Range<usize>) -> GarmentPanel {
        let old = &self.old.panels[k];
        let photo_px = match old.photo_px.as_slice() {
            [] => Vec::new(),
            px => {
                self.spread(k, |v| px[v - old.vertices.start].coords).into_iter().map(Point2::from).collect()
            }
        };
        GarmentPanel {
            name: old.name.clone(),
            vertices: self.panels[k].clone(),
            triangles,
            boundary: self.boundary(&old.boundary),
            photo_px,
            fabric: old.fabric.clone(),
            layer: old.layer,
        }
    }

    fn boundary(&self, old: &[u32]) -> Vec<u32> {
        let mut boundary = Vec::with_capacity(old.len() * self.parts);
        for (&a, &b) in old.iter().zip(old.iter().cycle().skip(1)) {
            boundary.push(self.kept[a as usize] as u32);
            if let Some(edge) = self.edges.find(a, b) {
                boundary.extend((1..self.parts).map(|k| self.along(edge, a, k)));
            }
        }
        boundary
    }

    /// What the old vertices of a panel have, interpolated at all of its vertices.
    fn spread<const D: usize>(
        &self,
        panel: usize,
        at: impl Fn(usize) -> SVector<f64, D>,
    ) -> Vec<SVector<f64, D>> {
        let (own, share) = (&self.old.panels[panel], |k: usize| k as f64 / self.parts as f64);
        let mut all: Vec<SVector<f64, D>> = Vec::with_capacity(self.panels[panel].len());
        all.extend(own.vertices.clone().map(&at));
        for ends in &self.edges.ends[self.edges.panels[panel].clone()] {
            let [a, b] = ends.map(|v| at(v as usize));
            all.extend((1..self.parts).map(|k| a + (b - a) * share(k)));
        }
        for corners in &self.old.triangles[own.triangles.clone()] {
            let [a, b, c] = corners.map(|v| at(v as usize));
            all.extend(inner(self.parts).map(|(i, j)| a + (b - a) * share(i) + (c - a) * share(j)));
        }
        all
    }

    /// The triangles that an old one falls into, turned as it is.
    fn triangles(&self, t: usize, out: &mut Vec<[u32; 3]>) {
        let [a, b, c] = self.old.triangles[t];
        let [ab, bc, ac] = [self.edges.side(a, b), self.edges.side(b, c), self.edges.side(a, c)];
        let n = self.parts;
        // `i` parts from the first corner towards the second, `j` towards the third.
        let at = |i: usize, j: usize| match (i, j) {
            (i, 0) => self.along(ab, a, i),
            (0, j) => self.along(ac, a, j),
            (i, j) if i + j == n => self.along(bc, b, j),
            // Rows before it have n - 2, n - 3, ... vertices.
            (i, j) => (self.in_triangle[t] + (j - 1) * (n - 1) - j * (j - 1) / 2 + i - 1) as u32,
        };
        for j in 0..n {
            for i in 0..n - j {
                out.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    out.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
}

/// The vertices within a triangle, in parts from its first corner towards the second and the third,
/// row by row.
fn inner(parts: usize) -> impl Iterator<Item = (usize, usize)> {
    (1..parts).flat_map(move |j| (1..parts - j).map(move |i| (i, j)))
}
