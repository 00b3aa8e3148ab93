//! Whether a collapse keeps the sewn sheet a manifold.
//!
//! Two panels of similar shape may both get an edge between the same two points of their seams,
//! which four triangles would share after sewing. So the triangles at sewn edges are counted before
//! a collapse (the link condition of Dey, Edelsbrunner, Guha and Nekhayev 1999, for the sewn
//! sheet). Cost: that of the triangles around two points.

use super::{CoarseningMesh, Pieces};

/// Greatest number of triangles at an edge, unless a seam joins more sheets.
const MOST: usize = 2;

impl CoarseningMesh {
    /// Whether the edges of the sewn sheet have at most two triangles after the collapses `moves`,
    /// or as many as an edge there had before, for a seam of three sheets is coarsened as one.
    pub(super) fn stays_manifold(&self, moves: &[[u32; 2]], fine: &Pieces) -> bool {
        let Some(&ends) = moves.first() else { return true };
        if !self.nears_seam(ends, fine) {
            return true;
        }
        let to = |c: u32| moves.iter().find(|m| m[0] == c).map_or(c, |m| m[1]);
        let (mut before, mut after): (Vec<[u32; 2]>, Vec<[u32; 2]>) = (Vec::new(), Vec::new());
        for t in self.around(ends, fine) {
            let corners = self.triangles[t as usize];
            before.extend(sewn_edges(corners.map(|c| fine.node[c as usize])));
            let [a, b, c] = corners.map(to);
            if a != b && b != c && c != a {
                after.extend(sewn_edges([a, b, c].map(|c| fine.node[c as usize])));
            }
        }
        most_alike(&mut after) <= most_alike(&mut before).max(MOST)
    }

    /// Whether one of the ends or a neighbour of the first is sewn to another vertex.
    fn nears_seam(&self, [v, w]: [u32; 2], fine: &Pieces) -> bool {
        let is_sewn = |&c: &u32| self.members[fine.point[c as usize] as usize].len() > 1;
        is_sewn(&v) || is_sewn(&w) || self.neighbours(v).iter().any(is_sewn)
    }

    /// The triangles at the sewn points of two vertices.
    fn around(&self, ends: [u32; 2], fine: &Pieces) -> Vec<u32> {
        let members = ends.iter().flat_map(|&c| &self.members[fine.point[c as usize] as usize]);
        let mut all: Vec<u32> = members.flat_map(|&m| self.at[m as usize].iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// How many times the most frequent edge is listed.
fn most_alike(edges: &mut [[u32; 2]]) -> usize {
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).map(<[_]>::len).max().unwrap_or(0)
}

fn sewn_edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}
