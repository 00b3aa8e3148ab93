//! Coarsening: a coarser mesh of the same pieces, on a subset of their vertices.
//!
//! Method: a maximal independent set of the sewn points is kept, corners and pins first, then
//! outlines, then the inside. Every other vertex is collapsed into a neighbour where no triangle is
//! inverted or becomes a sliver (edge collapse: Hoppe 1996, in the plane). The two sides of a seam
//! are collapsed together, so that they still match. Prolongation interpolates in the coarse
//! triangle in which a fine vertex lies. Cost: O(n) on ordinary meshes. Limit: a third to a quarter
//! of the vertices remain.

use self::keep::independent;
use self::locate::CoarseLocator;
use crate::scene::Scene;
use crate::statics::levels::pieces::Pieces;
use nalgebra::{Vector2, Vector3};

/// Least shape quality (1 for equilateral) of a triangle after a collapse.
const LEAST_QUALITY: f64 = 0.3;

/// A coarser level and its prolongation.
#[derive(Debug, Clone)]
pub struct Coarser {
    /// Its pieces.
    pub pieces: Pieces,
    /// The fine vertex that each coarse vertex is.
    pub kept: Vec<u32>,
    /// For each fine vertex three coarse vertices and their weights, whose sum is 1.
    pub weights: Vec<([u32; 3], [f64; 3])>,
}

impl Coarser {
    /// Prolongation: values at fine vertices from those at coarse vertices.
    #[must_use]
    pub fn prolong(&self, coarse: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        let at = |(v, w): &([u32; 3], [f64; 3])| (0..3).map(|k| coarse[v[k] as usize] * w[k]).sum();
        self.weights.iter().map(at).collect()
    }
}

/// The pieces of a scene and coarser ones down to about so many points, fine to coarse, and how
/// each of those was made.
pub(crate) fn levels(scene: &Scene, coarsest: usize) -> (Vec<Pieces>, Vec<Coarser>) {
    let (mut pieces, mut coarser) = (vec![Pieces::new(scene)], Vec::new());
    while let Some(next) = pieces.last().filter(|p| p.points > coarsest).and_then(coarsen) {
        pieces.push(next.pieces.clone());
        coarser.push(next);
    }
    (pieces, coarser)
}

/// The next coarser level, or `None` where little can be removed.
#[must_use]
pub fn coarsen(fine: &Pieces) -> Option<Coarser> {
    let mut mesh = CoarseningMesh::new(fine);
    let bare: Vec<bool> = mesh.at.iter().map(Vec::is_empty).collect();
    let keep = independent(fine, &mesh);
    // Vertices that could not be collapsed are tried again after their neighbours have gone.
    for _ in 0..2 {
        for p in 0..fine.points {
            if !keep[p] {
                mesh.collapse(p as u32, fine, &keep);
            }
        }
    }
    let alive = mesh.alive_triangles();
    let mut number = vec![u32::MAX; fine.rest.len()];
    // A pinned vertex without a triangle holds the cloth that is sewn to it on every level.
    let anchors: Vec<u32> =
        (0..bare.len() as u32).filter(|&v| bare[v as usize] && fine.pinned[v as usize]).collect();
    let mut kept: Vec<u32> = alive.iter().flatten().chain(&anchors).copied().collect();
    kept.sort_unstable();
    kept.dedup();
    if kept.len() * 10 > fine.rest.len() * 8 {
        return None;
    }
    kept.iter().enumerate().for_each(|(k, &v)| number[v as usize] = k as u32);
    let pieces = restrict(fine, &kept, alive.iter().map(|t| t.map(|v| number[v as usize])).collect());
    let mut weights = CoarseLocator::new(&pieces).weights(fine);
    anchors.iter().for_each(|&v| weights[v as usize] = ([number[v as usize]; 3], [1.0, 0.0, 0.0]));
    Some(Coarser { pieces, kept, weights })
}

fn restrict(fine: &Pieces, kept: &[u32], triangles: Vec<[u32; 3]>) -> Pieces {
    let (point, points) = renumber(kept, &fine.point, fine.points);
    let (node, nodes) = renumber(kept, &fine.node, fine.nodes);
    let mut number = vec![u32::MAX; fine.rest.len()];
    kept.iter().enumerate().for_each(|(k, &v)| number[v as usize] = k as u32);
    Pieces {
        rest: kept.iter().map(|&v| fine.rest[v as usize]).collect(),
        triangles,
        point,
        points,
        node,
        nodes,
        panel: kept.iter().map(|&v| fine.panel[v as usize]).collect(),
        gathered: kept.iter().map(|&v| fine.gathered[v as usize]).collect(),
        fold: kept.iter().map(|&v| fine.fold[v as usize]).collect(),
        bands: fine.bands.iter().map(|b| b.restrict(&number)).collect(),
        piece: kept.iter().map(|&v| fine.piece[v as usize]).collect(),
        pinned: kept.iter().map(|&v| fine.pinned[v as usize]).collect(),
    }
}

/// The groups of the kept vertices, numbered in the order of their first members.
fn renumber(kept: &[u32], group: &[u32], groups: usize) -> (Vec<u32>, usize) {
    let mut number = vec![u32::MAX; groups];
    let mut count = 0;
    let of = |&v: &u32| {
        let n = &mut number[group[v as usize] as usize];
        if *n == u32::MAX {
            *n = count;
            count += 1;
        }
        *n
    };
    let numbers = kept.iter().map(of).collect();
    (numbers, count as usize)
}

struct CoarseningMesh {
    triangles: Vec<[u32; 3]>,
    dead: Vec<bool>,
    /// Triangles at each vertex.
    at: Vec<Vec<u32>>,
    /// Vertices of each sewn point.
    members: Vec<Vec<u32>>,
    /// The two neighbours along the outline; `None` inside and where outlines meet.
    outline: Vec<Option<[u32; 2]>>,
    on_outline: Vec<bool>,
}

impl CoarseningMesh {
    fn new(fine: &Pieces) -> Self {
        let n = fine.rest.len();
        let mut at = vec![Vec::new(); n];
        for (k, t) in fine.triangles.iter().enumerate() {
            t.iter().for_each(|&v| at[v as usize].push(k as u32));
        }
        let mut members = vec![Vec::new(); fine.points];
        fine.point.iter().enumerate().for_each(|(v, &p)| members[p as usize].push(v as u32));
        let mut ends: Vec<Vec<u32>> = vec![Vec::new(); n];
        for [a, b] in outline_edges(&fine.triangles) {
            ends[a as usize].push(b);
            ends[b as usize].push(a);
        }
        let on_outline = ends.iter().map(|e| !e.is_empty()).collect();
        let outline = ends.iter().map(|e| <[u32; 2]>::try_from(&e[..]).ok()).collect();
        let dead = vec![false; fine.triangles.len()];
        Self { triangles: fine.triangles.clone(), dead, at, members, outline, on_outline }
    }

    fn alive_triangles(&self) -> Vec<[u32; 3]> {
        self.triangles.iter().zip(&self.dead).filter(|(_, dead)| !**dead).map(|(t, _)| *t).collect()
    }

    fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut all: Vec<u32> = self.at[v as usize]
            .iter()
            .flat_map(|&t| self.triangles[t as usize])
            .filter(|&w| w != v)
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Collapses every vertex of the sewn point `p` into the best neighbouring point, if one is
    /// good enough.
    fn collapse(&mut self, p: u32, fine: &Pieces, keep: &[bool]) {
        let members = self.members[p as usize].clone();
        let Some(&first) = members.first() else { return };
        if self.at[first as usize].is_empty() {
            return;
        }
        let mut targets: Vec<u32> = self.neighbours(first).iter().map(|&w| fine.point[w as usize]).collect();
        targets.sort_unstable();
        targets.dedup();
        let score = |target: u32| {
            let moves = self.moves(&members, target, fine)?;
            let worst = moves.iter().map(|&[v, w]| self.quality_after(v, w, fine)).fold(1.0, f64::min);
            let fits = worst > LEAST_QUALITY && self.stays_manifold(&moves, fine);
            fits.then_some((keep[target as usize], worst, moves))
        };
        let better = |a: &(bool, f64, Vec<[u32; 2]>), b: &(bool, f64, Vec<[u32; 2]>)| (a.0, a.1) > (b.0, b.1);
        let mut best: Option<(bool, f64, Vec<[u32; 2]>)> = None;
        for found in targets.into_iter().filter(|&t| t != p).filter_map(score) {
            if best.as_ref().is_none_or(|b| better(&found, b)) {
                best = Some(found);
            }
        }
        for [v, w] in best.map(|b| b.2).unwrap_or_default() {
            self.merge(v, w);
        }
    }

    /// For each member the vertex of `target` into which it would collapse, if all of them may.
    fn moves(&self, members: &[u32], target: u32, fine: &Pieces) -> Option<Vec<[u32; 2]>> {
        members
            .iter()
            .map(|&v| {
                let to = |w: &u32| fine.point[*w as usize] == target && self.may_merge(v, *w);
                self.neighbours(v).into_iter().find(to).map(|w| [v, w])
            })
            .collect()
    }

    /// Whether the edge may be collapsed: outlines must stay outlines, and the link condition must
    /// hold.
    fn may_merge(&self, v: u32, w: u32) -> bool {
        let shared = self.at[v as usize].iter().filter(|&&t| self.triangles[t as usize].contains(&w)).count();
        if self.on_outline[v as usize] && !self.outline[v as usize].is_some_and(|ends| ends.contains(&w)) {
            return false;
        }
        let (a, b) = (self.neighbours(v), self.neighbours(w));
        a.iter().filter(|n| b.binary_search(n).is_ok()).count() == shared
    }

    fn quality_after(&self, v: u32, w: u32, fine: &Pieces) -> f64 {
        let mut worst: f64 = 1.0;
        for &t in &self.at[v as usize] {
            let corners = self.triangles[t as usize];
            if !corners.contains(&w) {
                let moved = corners.map(|c| fine.rest[if c == v { w } else { c } as usize]);
                worst = worst.min(signed_quality(&moved));
            }
        }
        worst
    }

    fn merge(&mut self, v: u32, w: u32) {
        for t in std::mem::take(&mut self.at[v as usize]) {
            let corners = &mut self.triangles[t as usize];
            if corners.contains(&w) {
                self.dead[t as usize] = true;
                for c in *corners {
                    self.at[c as usize].retain(|&k| k != t);
                }
            } else {
                corners.iter_mut().filter(|c| **c == v).for_each(|c| *c = w);
                self.at[w as usize].push(t);
            }
        }
        if let Some(ends) = self.outline[v as usize].take() {
            let far = if ends[0] == w { ends[1] } else { ends[0] };
            for (i, j) in [(far, w), (w, far)] {
                if let Some(e) = &mut self.outline[i as usize] {
                    e.iter_mut().filter(|k| **k == v).for_each(|k| *k = j);
                }
            }
        }
    }
}

fn outline_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut sides: Vec<[u32; 2]> =
        triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]).collect();
    sides.iter_mut().for_each(|s| s.sort_unstable());
    sides.sort_unstable();
    sides.chunk_by(|a, b| a == b).filter(|group| group.len() == 1).map(|group| group[0]).collect()
}

/// Shape quality, 1 for equilateral; negative where the triangle is turned over.
pub(crate) fn signed_quality(t: &[Vector2<f64>; 3]) -> f64 {
    let sum: f64 = (0..3).map(|k| (t[(k + 1) % 3] - t[k]).norm_squared()).sum();
    2.0 * 3.0_f64.sqrt() * (t[1] - t[0]).perp(&(t[2] - t[0])) / sum.max(f64::MIN_POSITIVE)
}

mod keep;
mod locate;
mod manifold;
#[cfg(test)]
mod tests;
