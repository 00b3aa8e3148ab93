//! Finer triangles where they are asked for: long edges are halved, then edges are turned until no
//! angle opposite to one is too wide (Delaunay's condition on a surface; Lawson, 1977).
//!
//! Halving is decided edge by edge, so both triangles of an edge agree and no vertex hangs. Cost: a
//! sort of the half-edges a round. Limit: triangles between fine and coarse places have angles down
//! to some 25 degrees.

use crate::skin::topology::SkinMesh;
use std::collections::BTreeSet;
use toile_core::artifact::{Point3, Vector3};

/// Rounds of halving: a quarter of the edge is the finest.
pub(crate) const LEVELS: usize = 2;

/// An edge is halved from so many times the wanted length on.
const LONG: f64 = 1.4;

/// Rounds of turning edges.
const TURNS: usize = 3;

/// Halves the edges that are longer than wanted; new vertices are put onto the skin by `project`.
pub(crate) fn refined(
    (mut points, triangles): SkinMesh,
    wanted: impl Fn(Point3) -> f64,
    project: impl Fn(Point3) -> Point3,
) -> SkinMesh {
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(sides).map(sorted).collect();
    edges.sort_unstable();
    edges.dedup();
    edges.retain(|&[a, b]| {
        let (p, q) = (points[a as usize], points[b as usize]);
        (p - q).norm() > LONG * wanted(nalgebra::center(&p, &q))
    });
    let first = points.len() as u32;
    for &[a, b] in &edges {
        let (p, q) = (points[a as usize], points[b as usize]);
        let middle = project(nalgebra::center(&p, &q));
        let flat = p.x == 0.0 && q.x == 0.0;
        points.push(if flat { Point3::new(0.0, middle.y, middle.z) } else { middle });
    }
    let middle = |e: [u32; 2]| edges.binary_search(&sorted(e)).ok().map(|i| first + i as u32);
    let triangles = triangles.iter().flat_map(|t| parts(&points, t, sides(t).map(middle))).collect();
    (points, triangles)
}

fn sides(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The parts of a triangle some of whose sides have new middles.
fn parts(points: &[Point3], &[a, b, c]: &[u32; 3], middles: [Option<u32>; 3]) -> Vec<[u32; 3]> {
    match middles {
        [None, None, None] => vec![[a, b, c]],
        [Some(m), Some(n), Some(o)] => vec![[a, m, o], [m, b, n], [o, n, c], [m, n, o]],
        [Some(m), None, None] => vec![[a, m, c], [m, b, c]],
        [Some(m), Some(n), None] => {
            let mut all = vec![[m, b, n]];
            let length = |u: u32, v: u32| (points[u as usize] - points[v as usize]).norm_squared();
            let one = length(a, n) <= length(m, c);
            all.extend(if one { [[a, m, n], [a, n, c]] } else { [[a, m, c], [m, n, c]] });
            all
        }
        // Turned until a new middle stands first, and a second beside it.
        [x, y, z] => parts(points, &[b, c, a], [y, z, x]),
    }
}

/// Turns edges whose opposite angles together are wider than a half turn.
pub(crate) fn flip(points: &[Point3], triangles: &mut [[u32; 3]]) {
    for _ in 0..TURNS {
        if flip_once(points, triangles) == 0 {
            return;
        }
    }
}

fn flip_once(points: &[Point3], triangles: &mut [[u32; 3]]) -> usize {
    let mut half: Vec<([u32; 2], usize)> =
        triangles.iter().enumerate().flat_map(|(t, v)| sides(v).map(|e| (sorted(e), t))).collect();
    half.sort_unstable();
    let mut known: BTreeSet<[u32; 2]> = BTreeSet::new();
    let (mut touched, mut turned) = (vec![false; triangles.len()], 0);
    for pair in half.windows(2).filter(|w| w[0].0 == w[1].0) {
        let ([a, b], s, t) = (pair[0].0, pair[0].1, pair[1].1);
        if touched[s] || touched[t] {
            continue;
        }
        let (c, d) = (opposite(&triangles[s], a, b), opposite(&triangles[t], a, b));
        let new = sorted([c, d]);
        if !better(points, [a, b, c, d]) || known.contains(&new) {
            continue;
        }
        if half.binary_search_by_key(&new, |h| h.0).is_ok() {
            continue;
        }
        known.insert(new);
        let forward = sides(&triangles[s]).contains(&[a, b]);
        let (from, to) = if forward { (a, b) } else { (b, a) };
        (triangles[s], triangles[t]) = ([from, d, c], [d, to, c]);
        (touched[s], touched[t], turned) = (true, true, turned + 1);
    }
    turned
}

fn opposite(t: &[u32; 3], a: u32, b: u32) -> u32 {
    t[0] ^ t[1] ^ t[2] ^ a ^ b
}

/// Whether the edge c-d is better than a-b, and its triangles look to the same side.
fn better(points: &[Point3], [a, b, c, d]: [u32; 4]) -> bool {
    let [a, b, c, d] = [a, b, c, d].map(|v| points[v as usize]);
    let wide = |at: Point3| (a - at).angle(&(b - at));
    if wide(c) + wide(d) < std::f64::consts::PI + 1e-3 {
        return false;
    }
    let (n, m) = ((d - a).cross(&(c - a)), (c - b).cross(&(d - b)));
    let (o, p) = ((b - a).cross(&(c - a)), (d - a).cross(&(b - a)));
    let along = o + p;
    let alike = |u: &Vector3| u.dot(&along) > 0.5 * u.norm() * along.norm();
    alike(&n) && alike(&m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skin::topology::MeshTopology;

    /// An octahedron.
    fn solid() -> SkinMesh {
        let p = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
        let points = vec![
            p(1.0, 0.0, 0.0),
            p(-1.0, 0.0, 0.0),
            p(0.0, 1.0, 0.0),
            p(0.0, -1.0, 0.0),
            p(0.0, 0.0, 1.0),
            p(0.0, 0.0, -1.0),
        ];
        let t = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        (points, t)
    }

    #[test]
    fn a_solid_stays_closed_when_one_side_is_made_finer() {
        let onto = |p: Point3| Point3::from(p.coords.normalize());
        let mut mesh = solid();
        for _ in 0..4 {
            mesh = refined(mesh, |p| if p.x > 0.3 { 0.2 } else { 0.8 }, onto);
            flip(&mesh.0, &mut mesh.1);
        }
        let topology = MeshTopology::of(mesh.0.len(), &mesh.1);
        assert!(topology.is_closed() && topology.euler() == 2, "{topology:?}");
        let outward = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.0[i as usize].coords);
            a.dot(&b.cross(&c)) > 0.0
        };
        assert!(mesh.1.iter().all(outward));
    }
}
