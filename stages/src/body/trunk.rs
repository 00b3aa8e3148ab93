//! What a garment is sewn on: the trunk and the legs of a body, without arms and head.
//!
//! Flat panels stand before and behind a body: the arms are between them, and a seam on the shoulder must be led over it. So arms and head
//! are left out while seams close, and the trunk begins lower and rises into the sewn garment.
//!
//! Method: a limb is what of the mesh hangs together with its end beyond a plane through its root, at right angles to it; it
//! is cut off along edges of the mesh, and each hole is closed with a fan. Cost: O(triangles). Limit: arms that grow together with the
//! trunk (hands on hips) are left on.

use super::topology::neighbours;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::prelude::*;

/// The plane lies so far beyond a limb's root, metres: straps stay on the shoulder.
const BEYOND: f64 = 0.07;

/// The same of the head, above the base of the neck.
const ABOVE: f64 = 0.03;

/// An arm or a head has at most this share of the vertices; else it grows together with the trunk.
const MOST: f64 = 0.4;

/// How much lower the trunk begins, as a share of the body's height, and in how many steps it rises.
const LOWER: (f64, usize) = (0.05, 4);

/// A solid: points and triangles.
type Mesh = (Vec<Point3>, Vec<[u32; 3]>);

/// What the garment is sewn on, one after the other, before the whole body comes: the trunk from below up to its own height. Nothing for a
/// body that has no landmarks of arms and neck.
pub(crate) fn forms(body: &Body) -> Vec<Mesh> {
    let Some((points, triangles)) = trunk(body) else { return Vec::new() };
    let height = body.positions.iter().map(|p| p.y).fold(0.0, f64::max);
    let (share, steps) = LOWER;
    let lowered = |k: usize| {
        let by = Vector3::y() * (share * height * k as f64 / steps as f64);
        (points.iter().map(|p| p - by).collect(), triangles.clone())
    };
    (0..=steps).rev().map(lowered).collect()
}

/// The body without its arms and its head.
fn trunk(body: &Body) -> Option<Mesh> {
    let at = |name: &str| body.landmarks.get(name).copied();
    let mut cut = BTreeSet::new();
    for side in ["left", "right"] {
        let of = |part: &str| at(&format!("{part}_{side}"));
        let (root, wrist) = (nalgebra::center(&of("shoulder")?, &of("armpit")?), of("wrist")?);
        cut.extend(beyond(body, &root, &(wrist - root), BEYOND, &wrist)?);
    }
    let neck = nalgebra::center(&at("neck_left")?, &at("neck_right")?);
    let top = body.positions.iter().max_by(|a, b| a.y.total_cmp(&b.y))?;
    cut.extend(beyond(body, &neck, &Vector3::y(), ABOVE, top)?);
    let is_kept = |t: &&[u32; 3]| t.iter().all(|v| !cut.contains(v));
    let mut triangles: Vec<[u32; 3]> = body.triangles.iter().filter(is_kept).copied().collect();
    let mut points = body.positions.clone();
    for hole in holes(&triangles)? {
        let sum: Vector3 = hole.iter().map(|v| points[*v as usize].coords).sum();
        let tip = points.len() as u32;
        points.push(Point3::from(sum / hole.len() as f64));
        triangles.extend(hole.iter().enumerate().map(|(k, v)| [*v, hole[(k + 1) % hole.len()], tip]));
    }
    Some((points, triangles))
}

/// The vertices that hang together with the one at `tip` farther along `axis` from `root` than so many metres; none where they are too
/// many to be a limb.
fn beyond(body: &Body, root: &Point3, axis: &Vector3, far: f64, tip: &Point3) -> Option<BTreeSet<u32>> {
    let axis = axis.try_normalize(1e-6)?;
    let is_beyond = |v: u32| (body.positions[v as usize] - root).dot(&axis) > far;
    let distance = |v: &u32| (body.positions[*v as usize] - tip).norm_squared();
    let all = 0..body.positions.len() as u32;
    let first = all.filter(|v| is_beyond(*v)).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let beside = neighbours(body.positions.len(), &body.triangles);
    let mut found = BTreeSet::from([first]);
    let mut next = vec![first];
    while let Some(v) = next.pop() {
        let more = beside[v as usize].iter().filter(|w| is_beyond(**w) && found.insert(**w));
        next.extend(more);
    }
    let is_limb = (found.len() as f64) < MOST * body.positions.len() as f64;
    Some(if is_limb { found } else { BTreeSet::new() })
}

/// The borders of holes, each so that a fan over it has its triangles the right way round; nothing where borders meet in a vertex.
fn holes(triangles: &[[u32; 3]]) -> Option<Vec<Vec<u32>>> {
    let sides = || triangles.iter().flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3])));
    let all: BTreeSet<(u32, u32)> = sides().collect();
    let mut after = BTreeMap::new();
    for (a, b) in sides().filter(|(a, b)| !all.contains(&(*b, *a))) {
        if after.insert(b, a).is_some() {
            return None;
        }
    }
    let mut holes = Vec::new();
    while let Some((&first, _)) = after.iter().next() {
        let mut hole = vec![first];
        let mut at = after.remove(&first)?;
        while at != first {
            hole.push(at);
            at = after.remove(&at)?;
        }
        holes.push(hole);
    }
    Some(holes)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_mannequin_is_sewn_on_its_closed_trunk_which_rises_to_its_place() {
        let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
        let body = crate::body::tests::mannequin(lengths).unwrap();
        let forms = forms(&body);
        assert_eq!(forms.len(), 5);
        let top = |(points, triangles): &Mesh| {
            triangles.iter().flatten().map(|v| points[*v as usize].y).fold(0.0, f64::max)
        };
        let rises: Vec<f64> = forms.windows(2).map(|f| top(&f[1]) - top(&f[0])).collect();
        assert!(rises.iter().all(|r| (r - 0.05 * 1.72 / 4.0).abs() < 2e-3), "{rises:?}");
        let (points, triangles) = &forms[4];
        assert_eq!(holes(triangles), Some(vec![]));
        assert!(top(&forms[4]) < body.landmarks["neck_left"].y + 0.05);
        let wide = triangles.iter().flatten().map(|v| points[*v as usize].x).fold(0.0, f64::max);
        assert!(wide < body.landmarks["shoulder_left"].x.abs() + 0.1, "{wide}");
        let trunk = Body { positions: points.clone(), triangles: triangles.clone(), ..body.clone() };
        let share = trunk.volume() / body.volume();
        assert!((0.8..0.95).contains(&share), "{share}");
    }

    #[test]
    fn a_body_without_landmarks_is_sewn_on_as_it_is() {
        let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
        let mut body = crate::body::tests::mannequin(lengths).unwrap();
        body.landmarks.remove("wrist_left");
        assert!(forms(&body).is_empty());
    }
}
