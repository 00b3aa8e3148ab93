//! Edges of a triangle mesh and the triangles on their two sides, by sorting: O(n log n), the same
//! order on every machine.

use nalgebra::Vector2;

use crate::error::ClothError;

/// A triangle beside an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Side {
    /// The triangle.
    pub triangle: u32,
    /// Which of its corners (0, 1, 2) lies opposite the edge.
    pub corner: u8,
    /// The vertex at that corner.
    pub opposite: u32,
}

/// An edge with one or two triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Its vertices in the order in which the triangle of `sides[0]` runs through them.
    pub vertices: [u32; 2],
    /// Rest length in metres: the mean of what its triangles say.
    pub rest_length: f64,
    /// The triangle on the left of `vertices`, then the one on the right, if there is one.
    pub sides: (Side, Option<Side>),
}

impl Edge {
    /// Whether only one triangle has this edge.
    #[must_use]
    pub fn is_boundary(&self) -> bool {
        self.sides.1.is_none()
    }
}

pub(super) fn check_indices(triangles: &[[u32; 3]], count: usize) -> Result<(), ClothError> {
    for (index, t) in triangles.iter().enumerate() {
        if let Some(&v) = t.iter().find(|&&v| v as usize >= count) {
            return Err(ClothError::VertexOutOfRange { what: "triangle", index, vertex: v as usize, count });
        }
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            return Err(ClothError::DegenerateTriangle { index, quality: 0.0 });
        }
    }
    Ok(())
}

/// Greatest number of triangles at an edge among which duplicates are sought.
const MOST_SHARING: usize = 16;

/// One triangle's side of an edge, before sides are paired.
#[derive(Clone, Copy)]
struct HalfEdge {
    low: u32,
    high: u32,
    forward: bool,
    length: f64,
    side: Side,
}

/// Which sides of two triangles may meet at an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Facing {
    /// Both have the same side up.
    Alike,
    /// A seam may sew the right side of one to the wrong side of the other, as a collar that folds
    /// over is.
    Any,
}

pub(super) fn edges(
    triangles: &[[u32; 3]],
    rest: &[[Vector2<f64>; 3]],
    facing: Facing,
) -> Result<(Vec<Edge>, Vec<[u32; 3]>), ClothError> {
    let mut halves: Vec<HalfEdge> = (0..triangles.len())
        .flat_map(|t| (0..3).map(move |corner| (t, corner)))
        .map(|(t, corner)| half(t, corner, &triangles[t], &rest[t]))
        .collect();
    halves.sort_by_key(|h| (h.low, h.high, h.side.triangle));
    let mut edges = Vec::with_capacity(halves.len() / 2 + triangles.len());
    let mut of_triangle = vec![[0; 3]; triangles.len()];
    for group in halves.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        none_twice(group)?;
        for part in parts(group, rest, facing) {
            for h in &part {
                of_triangle[h.side.triangle as usize][h.side.corner as usize] = edges.len() as u32;
            }
            edges.push(pair(&part, facing)?);
        }
    }
    Ok((edges, of_triangle))
}

/// The halves of an edge in pairs. Where a seam joins more than two sheets, the two halves of one
/// sheet belong together: a line inside it to which another is sewn. Of what is left, the first two
/// are a seam like any other, and each further sheet hangs on it by its border alone, without a
/// fold.
fn parts(group: &[HalfEdge], rest: &[[Vector2<f64>; 3]], facing: Facing) -> Vec<Vec<HalfEdge>> {
    if group.len() <= 2 || facing == Facing::Alike {
        return vec![group.to_vec()];
    }
    let ends = |h: &HalfEdge| {
        let (corners, k) = (&rest[h.side.triangle as usize], h.side.corner as usize);
        let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        if h.forward { [a, b] } else { [b, a] }
    };
    let (mut left, mut parts) = (group.to_vec(), Vec::new());
    let mut k = 0;
    while k < left.len() {
        let is_other_half = |o: &HalfEdge| o.forward != left[k].forward && ends(o) == ends(&left[k]);
        match left[k + 1..].iter().take(MOST_SHARING).position(is_other_half) {
            Some(at) => {
                let other = left.remove(k + 1 + at);
                parts.push(vec![left.remove(k), other]);
            }
            None => k += 1,
        }
    }
    let hung = left.split_off(left.len().min(2));
    parts.extend((!left.is_empty()).then_some(left));
    parts.extend(hung.into_iter().map(|h| vec![h]));
    parts
}

fn half(t: usize, corner: usize, triangle: &[u32; 3], rest: &[Vector2<f64>; 3]) -> HalfEdge {
    let (i, j) = ((corner + 1) % 3, (corner + 2) % 3);
    let (a, b) = (triangle[i], triangle[j]);
    HalfEdge {
        low: a.min(b),
        high: a.max(b),
        forward: a < b,
        length: (rest[j] - rest[i]).norm(),
        side: Side { triangle: t as u32, corner: corner as u8, opposite: triangle[corner] },
    }
}

/// No triangle is listed twice.
fn none_twice(group: &[HalfEdge]) -> Result<(), ClothError> {
    let twice = |a: &HalfEdge, b: &HalfEdge| {
        let mut of = [a.low, a.high, a.side.opposite];
        of.sort_unstable();
        let (first, second) = (a.side.triangle as usize, b.side.triangle as usize);
        ClothError::TriangleTwice { first, second, of }
    };
    let same = |a: &&HalfEdge, b: &HalfEdge| a.side.opposite == b.side.opposite && a.forward == b.forward;
    for (k, a) in group.iter().enumerate().take(MOST_SHARING) {
        if let Some(b) = group[k + 1..].iter().find(|b| same(&a, b)) {
            return Err(twice(a, b));
        }
    }
    Ok(())
}

fn pair(group: &[HalfEdge], facing: Facing) -> Result<Edge, ClothError> {
    let bad = |why| ClothError::NonManifoldEdge { a: group[0].low as usize, b: group[0].high as usize, why };
    let first = group[0];
    let vertices = if first.forward { [first.low, first.high] } else { [first.high, first.low] };
    match group {
        [one] => Ok(Edge { vertices, rest_length: one.length, sides: (one.side, None) }),
        [one, two] if one.forward != two.forward || facing == Facing::Any => {
            let rest_length = 0.5 * (one.length + two.length);
            Ok(Edge { vertices, rest_length, sides: (one.side, Some(two.side)) })
        }
        [_, _] => Err(bad("its two triangles disagree on which side is up; turn one of them over")),
        _ => Err(bad("more than two triangles share it; separate them")),
    }
}
