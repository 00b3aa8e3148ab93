//! Vertices from corners: corners are one vertex where their triangles hang together by edges.
//!
//! A vertex where only tips touch (a bow-tie) becomes several. Used for repair and for cutting: cut
//! edges join no corners.

use super::edges::FREE;

/// The corners of a mesh gathered into vertices.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GatheredCorners {
    /// Three vertices a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// For each vertex the vertex of the input that it stands for.
    pub sources: Vec<u32>,
    /// Vertices that were added.
    pub split: usize,
    /// Vertices of the input that no triangle names.
    pub unused: usize,
}

/// Gathers corners across the paired half-edges of consistently oriented triangles.
///
/// Vertices keep the order of the input; what is split off comes after all others.
#[must_use]
pub(crate) fn corner_vertices(triangles: &[[u32; 3]], opposite: &[u32], vertices: usize) -> GatheredCorners {
    let class = corner_classes(opposite);
    let mut first = vec![FREE; vertices];
    let mut extra = Vec::new();
    for (c, &root) in class.iter().enumerate() {
        let v = triangles[c / 3][c % 3] as usize;
        if root as usize != c {
            continue;
        }
        if first[v] == FREE {
            first[v] = root;
        } else {
            extra.push((root, v as u32));
        }
    }
    number(triangles, &class, &first, &extra)
}

fn number(triangles: &[[u32; 3]], class: &[u32], first: &[u32], extra: &[(u32, u32)]) -> GatheredCorners {
    let mut of_class = vec![FREE; class.len()];
    let mut sources = Vec::with_capacity(first.len() + extra.len());
    let used = first.iter().enumerate().filter(|(_, c)| **c != FREE).map(|(v, &c)| (c, v as u32));
    for (root, v) in used.chain(extra.iter().copied()) {
        of_class[root as usize] = sources.len() as u32;
        sources.push(v);
    }
    let vertex = |t: usize, k: usize| of_class[class[3 * t + k] as usize];
    let triangles = (0..triangles.len()).map(|t| [vertex(t, 0), vertex(t, 1), vertex(t, 2)]).collect();
    let unused = first.iter().filter(|&&c| c == FREE).count();
    GatheredCorners { triangles, sources, split: extra.len(), unused }
}

/// For each corner the lowest corner of its fan.
fn corner_classes(opposite: &[u32]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..opposite.len() as u32).collect();
    let next = |h: u32| h - h % 3 + (h + 1) % 3;
    for (h, &o) in opposite.iter().enumerate() {
        if o != FREE && (h as u32) < o {
            // Opposite half-edges run against each other: the start of one is the end of the other.
            join(&mut parent, h as u32, next(o));
            join(&mut parent, next(h as u32), o);
        }
    }
    (0..opposite.len() as u32).map(|c| root(&mut parent, c)).collect()
}

fn root(parent: &mut [u32], mut c: u32) -> u32 {
    while parent[c as usize] != c {
        parent[c as usize] = parent[parent[c as usize] as usize];
        c = parent[c as usize];
    }
    c
}

fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    let (low, high) = (a.min(b), a.max(b));
    parent[high as usize] = low;
}
