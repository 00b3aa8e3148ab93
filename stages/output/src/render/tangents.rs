//! The tangent frame in which a normal map is read.
//!
//! Every triangle has a direction along which its texture coordinate u grows and one along which v
//! falls (up the picture). At a vertex the first is averaged over its triangles by area and made
//! orthogonal to the normal (Lengyel, *Computing tangent space basis vectors*, 2001); the second is
//! the cross product of normal and tangent, times a sign that is -1 where the picture lies
//! mirrored, as glTF 2.0 has it. Cost: one pass over the triangles.

use toile_core::artifact::{Mesh, Vector3};

/// A tangent, orthogonal to its vertex's normal and of length one, and the sign of the bitangent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tangent {
    pub(crate) along: Vector3,
    pub(crate) sign: f64,
}

impl Tangent {
    /// The direction up the picture, for a unit normal.
    pub(crate) fn up(&self, normal: &Vector3) -> Vector3 {
        normal.cross(&self.along) * self.sign
    }
}

/// One tangent a vertex; none for a mesh without one normal and one texture coordinate a vertex.
pub(crate) fn tangents(mesh: &Mesh) -> Vec<Tangent> {
    let count = mesh.positions.len();
    if mesh.uv.len() != count || mesh.normals.len() != count {
        return Vec::new();
    }
    let mut sums = vec![(Vector3::zeros(), Vector3::zeros()); count];
    for t in &mesh.triangles {
        let corners = t.map(|i| i as usize);
        if corners.iter().any(|i| *i >= count) {
            continue;
        }
        let (along, up) = directions(mesh, corners);
        for i in corners {
            sums[i].0 += along;
            sums[i].1 += up;
        }
    }
    mesh.normals.iter().zip(&sums).map(|(n, (along, up))| tangent(n, along, up)).collect()
}

/// Where u grows and where v falls on a triangle, each weighted with its area; zero where the
/// texture has none there.
fn directions(mesh: &Mesh, [a, b, c]: [usize; 3]) -> (Vector3, Vector3) {
    let (p, q) = (mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    let difference = |i: usize| {
        let ([u, v], [u0, v0]) = (mesh.uv[i], mesh.uv[a]);
        [f64::from(u) - f64::from(u0), f64::from(v) - f64::from(v0)]
    };
    let ([pu, pv], [qu, qv]) = (difference(b), difference(c));
    let turn = (pu * qv - qu * pv).signum();
    let area = p.cross(&q).norm();
    let weighted = |d: Vector3| d.try_normalize(0.0).map_or_else(Vector3::zeros, |d| d * area);
    match pu * qv - qu * pv {
        d if d == 0.0 || !d.is_finite() => (Vector3::zeros(), Vector3::zeros()),
        _ => (weighted((p * qv - q * pv) * turn), weighted((p * qu - q * pu) * turn)),
    }
}

/// The tangent at a vertex, from the sums over its triangles.
fn tangent(normal: &Vector3, along: &Vector3, up: &Vector3) -> Tangent {
    let across = along - normal * normal.dot(along);
    let along = across.try_normalize(1e-12).unwrap_or_else(|| any_across(normal));
    let sign = if normal.cross(&along).dot(up) < 0.0 { -1.0 } else { 1.0 };
    Tangent { along, sign }
}

/// A unit vector across a normal, where the texture gives none.
fn any_across(normal: &Vector3) -> Vector3 {
    let least = if normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    normal.cross(&least).try_normalize(1e-12).unwrap_or_else(Vector3::x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_core::artifact::Point3;

    /// A triangle that faces +Z, its picture's u along `u`, its v along `v`.
    fn triangle(u: [f32; 2], v: [f32; 2]) -> Mesh {
        let at = |x: f32, y: f32| [u[0] * x + u[1] * y, v[0] * x + v[1] * y];
        Mesh {
            name: "front".into(),
            positions: vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)],
            normals: vec![Vector3::z(); 3],
            uv: vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)],
            triangles: vec![[0, 1, 2]],
            material: 0,
        }
    }

    fn frame(mesh: &Mesh) -> [[f64; 3]; 2] {
        let t = tangents(mesh)[0];
        [t.along.into(), t.up(&Vector3::z()).into()]
    }

    #[test]
    fn a_picture_that_stands_upright_has_its_top_where_v_is_least() {
        assert_eq!(frame(&triangle([1.0, 0.0], [0.0, -1.0])), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_eq!(tangents(&triangle([1.0, 0.0], [0.0, -1.0]))[0].sign, 1.0);
    }

    #[test]
    fn a_mirrored_picture_has_the_other_sign() {
        assert_eq!(frame(&triangle([-1.0, 0.0], [0.0, -1.0])), [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_eq!(tangents(&triangle([-1.0, 0.0], [0.0, -1.0]))[0].sign, -1.0);
    }

    #[test]
    fn a_picture_without_area_gives_some_frame() {
        let flat = triangle([0.0, 0.0], [0.0, 0.0]);
        let t = tangents(&flat)[0];
        assert!(t.along.dot(&Vector3::z()).abs() < 1e-12 && (t.along.norm() - 1.0).abs() < 1e-12);
        assert!(tangents(&Mesh { uv: vec![], ..flat }).is_empty());
    }
}
