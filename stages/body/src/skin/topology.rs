//! Whether a triangle mesh is closed, consistently turned and in one piece.
//!
//! Cost: a sort of the half-edges.

use std::collections::BTreeSet;
use toile_core::artifact::Point3;

/// Vertices and triangles, counter-clockwise from outside.
pub(crate) type SkinMesh = (Vec<Point3>, Vec<[u32; 3]>);

/// The vertices beside each of so many.
pub(crate) fn neighbours(vertices: usize, triangles: &[[u32; 3]]) -> Vec<BTreeSet<u32>> {
    let mut beside = vec![BTreeSet::new(); vertices];
    for t in triangles {
        for k in 0..3 {
            beside[t[k] as usize].extend([t[(k + 1) % 3], t[(k + 2) % 3]]);
        }
    }
    beside
}

/// What the edges of a triangle mesh tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MeshTopology {
    /// Vertices that a triangle uses.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Triangles.
    pub triangles: usize,
    /// Edges with one triangle.
    pub open: usize,
    /// Edges with more than two triangles, or whose two triangles run the same way.
    pub faulty: usize,
    /// Pieces that hang together.
    pub components: usize,
    /// The first open edge.
    pub first_open: Option<[u32; 2]>,
    /// The first faulty edge.
    pub first_faulty: Option<[u32; 2]>,
}

impl MeshTopology {
    /// Counts over a mesh of `vertices` vertices.
    pub(crate) fn of(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut half_edges: Vec<(u32, u32, bool)> = triangles
            .iter()
            .flat_map(|t| (0..3).map(move |k| (t[k], t[(k + 1) % 3])))
            .map(|(a, b)| (a.min(b), a.max(b), a < b))
            .collect();
        half_edges.sort_unstable();
        let (mut edges, mut open, mut faulty) = (0, 0, 0);
        let (mut first_open, mut first_faulty) = (None, None);
        for group in half_edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            edges += 1;
            let edge = [group[0].0, group[0].1];
            match group {
                [_] => {
                    open += 1;
                    first_open = first_open.or(Some(edge));
                }
                [a, b] if a.2 != b.2 => {}
                _ => {
                    faulty += 1;
                    first_faulty = first_faulty.or(Some(edge));
                }
            }
        }
        let mut pieces = VertexSets::new(vertices);
        triangles.iter().for_each(|t| {
            pieces.join(t[0], t[1]);
            pieces.join(t[0], t[2]);
        });
        let mut used = vec![false; vertices];
        triangles.iter().flatten().for_each(|&i| used[i as usize] = true);
        let components = (0..vertices as u32).filter(|&i| used[i as usize] && pieces.root(i) == i).count();
        let vertices = used.iter().filter(|u| **u).count();
        MeshTopology {
            vertices,
            edges,
            triangles: triangles.len(),
            open,
            faulty,
            components,
            first_open,
            first_faulty,
        }
    }

    /// True where every edge has two triangles that run opposite ways.
    pub(crate) fn is_closed(&self) -> bool {
        self.open == 0 && self.faulty == 0 && self.triangles > 0
    }

    /// The Euler characteristic: 2 for a closed piece without handles.
    pub(crate) fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.triangles as i64
    }
}

/// Disjoint sets of vertices; the root of a set is its least vertex.
#[derive(Debug)]
pub(crate) struct VertexSets(Vec<u32>);

impl VertexSets {
    /// Every vertex on its own.
    pub(crate) fn new(count: usize) -> Self {
        VertexSets((0..count as u32).collect())
    }

    /// The least vertex of the set.
    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }

    /// Joins the sets of two vertices.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_tetrahedron_is_closed() {
        let t = MeshTopology::of(4, &TETRAHEDRON);
        assert!(t.is_closed());
        assert_eq!((t.euler(), t.components), (2, 1));
    }

    #[test]
    fn a_missing_triangle_opens_three_edges() {
        assert_eq!(MeshTopology::of(4, &TETRAHEDRON[1..]).open, 3);
    }

    #[test]
    fn a_turned_triangle_is_a_fault() {
        let mut turned = TETRAHEDRON;
        turned[0].swap(0, 1);
        assert_eq!(MeshTopology::of(4, &turned).faulty, 3);
    }
}
