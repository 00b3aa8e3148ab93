//! The body's triangles, with the normals that give a distance its sign.
//!
//! The closest triangle of a place is found from a good guess by walking over the mesh: where the
//! closest point lies on a side or a corner, the triangles around it are tried, until none is
//! nearer.
//!
//! The sign comes from the angle-weighted normal of the closest feature, which is right for faces,
//! edges and corners alike (Baerentzen & Aanaes 2005). That needs a closed mesh that faces
//! outwards, so it is checked first.

use crate::closest::{at, on_triangle};
use toile_core::artifact::{Artifact, Body, Point3, Vector3};
use toile_core::{ErrorCode, StageError};

/// Sine of a triangle's angle below which it has no normal.
const FLAT: f64 = 1e-10;

/// Triangles with the unit pseudo-normals of their features.
#[derive(Debug)]
pub(crate) struct Skin {
    pub(crate) corners: Vec<[Point3; 3]>,
    faces: Vec<Vector3>,
    sides: Vec<[Vector3; 3]>,
    points: Vec<[Vector3; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Triangles at each vertex, as offsets into one list.
    fan_start: Vec<u32>,
    fans: Vec<u32>,
}

/// The closest point of the skin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnSkin {
    pub(crate) distance: f64,
    pub(crate) normal: Vector3,
}

/// A walk over the mesh ends after this many steps, wherever it is.
const MAX_STEPS: usize = 16;
/// Nearer to the skin than this the direction to it is noise, metres.
const ON_SKIN: f64 = 1e-9;

impl Skin {
    /// Checks a body and takes its normals.
    pub(crate) fn of(body: &Body) -> Result<Self, StageError> {
        body.check().map_err(|e| StageError::invalid(format!("the body cannot be used: {e}")))?;
        if body.triangles.is_empty() {
            return Err(StageError::invalid("the body has no triangles").hint("give a closed triangle mesh"));
        }
        let corners: Vec<[Point3; 3]> =
            body.triangles.iter().map(|t| t.map(|i| body.positions[i as usize])).collect();
        let faces = face_normals(&corners)?;
        let uses = uses_of_sides(&body.triangles);
        closed(&uses)?;
        if volume(&corners) <= 0.0 {
            return Err(StageError::invalid("the body is inside out: its triangles face inwards")
                .hint("list each triangle's corners counter-clockwise as seen from outside"));
        }
        let mut sides = vec![[Vector3::zeros(); 3]; faces.len()];
        for pair in uses.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let sum = unit(pair.iter().map(|u| faces[u.3 as usize]).sum());
            pair.iter().for_each(|u| sides[u.3 as usize][u.4] = sum);
        }
        let points = point_normals(body, &corners, &faces);
        let (fan_start, fans) = fans(body);
        Ok(Skin { corners, faces, sides, points, triangles: body.triangles.clone(), fan_start, fans })
    }

    /// The closest point, looked for from the best of a few triangles.
    pub(crate) fn closest(&self, p: &Point3, guesses: impl Iterator<Item = u32>) -> Option<OnSkin> {
        let mut best: Option<(f64, u32, [f64; 3])> = None;
        let mut last = u32::MAX;
        for t in guesses {
            // The nodes of a cell mostly share their triangle.
            if t != last {
                self.take(p, t, &mut best);
                last = t;
            }
        }
        for _ in 0..MAX_STEPS {
            let (before, t, weights) = best?;
            if weights.iter().all(|w| *w > 0.0) {
                break;
            }
            for k in (0..3).filter(|&k| weights[k] > 0.0) {
                let v = self.triangles[t as usize][k] as usize;
                let fan = self.fan_start[v] as usize..self.fan_start[v + 1] as usize;
                self.fans[fan].iter().for_each(|&u| self.take(p, u, &mut best));
            }
            if best.is_none_or(|b| b.0 >= before) {
                break;
            }
        }
        best.map(|(_, t, weights)| self.reading(p, t as usize, &weights))
    }

    fn take(&self, p: &Point3, t: u32, best: &mut Option<(f64, u32, [f64; 3])>) {
        let corners = &self.corners[t as usize];
        let weights = on_triangle(p, corners);
        let d = (p - at(corners, &weights)).norm_squared();
        if best.is_none_or(|b| d < b.0 || (d == b.0 && t < b.1)) {
            *best = Some((d, t, weights));
        }
    }

    fn reading(&self, p: &Point3, t: usize, weights: &[f64; 3]) -> OnSkin {
        let gap = p - at(&self.corners[t], weights);
        let pseudo = self.pseudo_normal(t, weights);
        let length = gap.norm();
        let distance = if gap.dot(&pseudo) < 0.0 { -length } else { length };
        let face = weights.iter().all(|w| *w > 0.0);
        let normal = if face || length <= ON_SKIN { pseudo } else { gap / distance };
        OnSkin { distance, normal }
    }

    /// The normal of the feature that a closest point lies on.
    fn pseudo_normal(&self, t: usize, weights: &[f64; 3]) -> Vector3 {
        match weights.map(|w| w != 0.0) {
            [true, true, true] => self.faces[t],
            [true, true, false] => self.sides[t][0],
            [false, true, true] => self.sides[t][1],
            [true, false, true] => self.sides[t][2],
            [_, false, false] => self.points[t][0],
            [false, true, false] => self.points[t][1],
            _ => self.points[t][2],
        }
    }

    /// Squared distance of `p` from triangle `t`.
    pub(crate) fn distance_squared(&self, p: &Point3, t: usize) -> f64 {
        let corners = &self.corners[t];
        (p - at(corners, &on_triangle(p, corners))).norm_squared()
    }

    /// Signed distance of `p` from triangle `t`, its closest.
    pub(crate) fn signed(&self, p: &Point3, t: usize) -> f64 {
        let corners = &self.corners[t];
        let weights = on_triangle(p, corners);
        let gap = p - at(corners, &weights);
        let normal = self.pseudo_normal(t, &weights);
        if gap.dot(&normal) < 0.0 { -gap.norm() } else { gap.norm() }
    }
}

fn unit(v: Vector3) -> Vector3 {
    v.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}

fn face_normals(corners: &[[Point3; 3]]) -> Result<Vec<Vector3>, StageError> {
    let flat = |[a, b, c]: &[Point3; 3]| {
        let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        (b - a).cross(&(c - a)).norm() <= FLAT * longest
    };
    match corners.iter().filter(|t| flat(t)).count() {
        0 => Ok(corners.iter().map(|[a, b, c]| unit((b - a).cross(&(c - a)))).collect()),
        n => Err(StageError::new(
            ErrorCode::DegenerateTriangles,
            format!("the body has {n} triangles without area"),
        )
        .hint("merge vertices that lie on each other and remove what collapses")),
    }
}

/// A side of a triangle: lower node, higher node, runs downwards, triangle, its first corner.
type Use = (u32, u32, bool, u32, usize);

fn uses_of_sides(triangles: &[[u32; 3]]) -> Vec<Use> {
    let of = |(t, nodes): (usize, &[u32; 3])| {
        let nodes = *nodes;
        (0..3).map(move |k| {
            let (i, j) = (nodes[k], nodes[(k + 1) % 3]);
            (i.min(j), i.max(j), i > j, t as u32, k)
        })
    };
    let mut uses: Vec<Use> = triangles.iter().enumerate().flat_map(of).collect();
    uses.sort_unstable();
    uses
}

fn closed(uses: &[Use]) -> Result<(), StageError> {
    let sound = |pair: &&[Use]| matches!(pair, [a, b] if a.2 != b.2);
    let sides = || uses.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
    match sides().count() - sides().filter(sound).count() {
        0 => Ok(()),
        n => Err(StageError::invalid(format!(
            "the body is not closed: {n} edges lack a second triangle that fits"
        ))
        .hint("merge vertices that lie on each other, fill the holes and turn all triangles outwards")),
    }
}

/// Six times the enclosed volume, seen from the first corner so that a far body keeps its digits.
fn volume(corners: &[[Point3; 3]]) -> f64 {
    let origin = corners[0][0];
    corners.iter().map(|t| t.map(|p| p - origin)).map(|[a, b, c]| a.dot(&b.cross(&c))).sum()
}

fn point_normals(body: &Body, corners: &[[Point3; 3]], faces: &[Vector3]) -> Vec<[Vector3; 3]> {
    let mut sums = vec![Vector3::zeros(); body.positions.len()];
    for ((nodes, t), face) in body.triangles.iter().zip(corners).zip(faces) {
        for k in 0..3 {
            let (u, v) = (t[(k + 1) % 3] - t[k], t[(k + 2) % 3] - t[k]);
            sums[nodes[k] as usize] += face * u.angle(&v);
        }
    }
    body.triangles.iter().map(|nodes| nodes.map(|i| unit(sums[i as usize]))).collect()
}

fn fans(body: &Body) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; body.positions.len() + 1];
    body.triangles.iter().flatten().for_each(|&v| start[v as usize + 1] += 1);
    (0..body.positions.len()).for_each(|v| start[v + 1] += start[v]);
    let (mut next, mut fans) = (start.clone(), vec![0; 3 * body.triangles.len()]);
    for (t, nodes) in body.triangles.iter().enumerate() {
        for &v in nodes {
            fans[next[v as usize] as usize] = t as u32;
            next[v as usize] += 1;
        }
    }
    (start, fans)
}
