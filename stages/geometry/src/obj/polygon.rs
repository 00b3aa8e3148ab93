//! Faces of any number of corners as triangles.
//!
//! Method: a fan, which suits convex faces and the nearly flat quads of bodies; where a triangle of
//! it would be turned over, ears are cut instead (Meisters, 1975), seen along the face's normal
//! (Newell). Cost: the corners; their square where ears are cut.

use crate::Vec3;
use nalgebra::Vector2;

/// Corners up to which ears are cut.
const MAX_EARS: usize = 256;

/// Adds the triangles of a face; `None` where it is not convex and has too many corners.
pub(super) fn cut(face: &[u32], vertices: &[Vec3], triangles: &mut Vec<[u32; 3]>) -> Option<()> {
    let fan = (1..face.len() - 1).map(|k| [face[0], face[k], face[k + 1]]);
    if face.len() == 3 || is_convex(face, vertices) {
        triangles.extend(fan);
        return Some(());
    }
    if face.len() > MAX_EARS {
        return None;
    }
    match ears(face, vertices) {
        Some(cut) => triangles.extend(cut),
        // It crosses itself: no triangles are better than others.
        None => triangles.extend(fan),
    }
    Some(())
}

/// Twice the area of a face as a vector along its normal.
fn normal(face: &[u32], vertices: &[Vec3]) -> Vec3 {
    let origin = vertices[face[0] as usize];
    let at = |k: usize| vertices[face[k % face.len()] as usize] - origin;
    (1..face.len() - 1).map(|k| at(k).cross(&at(k + 1))).sum()
}

/// Whether no triangle of the fan is turned over.
fn is_convex(face: &[u32], vertices: &[Vec3]) -> bool {
    let along = normal(face, vertices);
    let origin = vertices[face[0] as usize];
    let at = |k: usize| vertices[face[k] as usize] - origin;
    (1..face.len() - 1).all(|k| at(k).cross(&at(k + 1)).dot(&along) >= 0.0)
}

/// Triangles of a simple polygon; `None` where it crosses itself.
fn ears(face: &[u32], vertices: &[Vec3]) -> Option<Vec<[u32; 3]>> {
    let flat = flatten(face, vertices);
    let mut left: Vec<usize> = (0..face.len()).collect();
    let mut triangles = Vec::with_capacity(face.len() - 2);
    let mut at = 0;
    let mut tried = 0;
    while left.len() > 3 {
        let n = left.len();
        let [i, j, k] = [left[(at + n - 1) % n], left[at % n], left[(at + 1) % n]];
        if is_ear([i, j, k], &left, &flat) {
            triangles.push([i, j, k].map(|c| face[c]));
            left.remove(at % n);
            at = (at + n - 1) % n;
            tried = 0;
        } else {
            at = (at + 1) % n;
            tried += 1;
        }
        if tried > n {
            return None;
        }
    }
    triangles.push([left[0], left[1], left[2]].map(|c| face[c]));
    Some(triangles)
}

/// The corners seen along the normal.
fn flatten(face: &[u32], vertices: &[Vec3]) -> Vec<Vector2<f64>> {
    let along = normal(face, vertices);
    let axis = along.iamax();
    let [x, y] = [(axis + 1) % 3, (axis + 2) % 3];
    let turn = along[axis].signum();
    face.iter().map(|&v| Vector2::new(vertices[v as usize][x], turn * vertices[v as usize][y])).collect()
}

fn is_ear([i, j, k]: [usize; 3], left: &[usize], flat: &[Vector2<f64>]) -> bool {
    let side = |a: usize, b: usize, p: usize| (flat[b] - flat[a]).perp(&(flat[p] - flat[a]));
    let holds = |p: usize| side(i, j, p) >= 0.0 && side(j, k, p) >= 0.0 && side(k, i, p) >= 0.0;
    side(i, j, k) > 0.0 && !left.iter().any(|&p| p != i && p != j && p != k && holds(p))
}
