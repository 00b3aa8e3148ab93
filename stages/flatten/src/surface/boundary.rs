//! Boundary loops of an oriented manifold mesh.

use super::edges::{FREE, ends};

/// The loops of vertices along free half-edges, the surface on their left, each from its lowest
/// half-edge.
///
/// Each vertex must have one fan of triangles (see [`corner_vertices`](super::corner_vertices)).
#[must_use]
pub(super) fn boundary_loops(triangles: &[[u32; 3]], opposite: &[u32], vertices: usize) -> Vec<Vec<u32>> {
    let mut next = vec![FREE; vertices];
    let free = || (0..opposite.len() as u32).filter(|&h| opposite[h as usize] == FREE);
    for h in free() {
        let [a, b] = ends(triangles, h);
        next[a as usize] = b;
    }
    let mut loops = Vec::new();
    for h in free() {
        let (mut v, mut vertices) = (ends(triangles, h)[0], Vec::new());
        while next[v as usize] != FREE {
            vertices.push(v);
            v = std::mem::replace(&mut next[v as usize], FREE);
        }
        if !vertices.is_empty() {
            loops.push(vertices);
        }
    }
    loops
}
