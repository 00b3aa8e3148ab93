//! A closed mesh as parry3d's `TriMesh`, with the pseudo-normals that tell inside from outside.
//!
//! O(n log n) to build, O(log n) a query. Limit: for a point on an edge, to the last bit, the
//! normal is that of a triangle beside it. A mesh without triangles, which parry3d refuses, is far
//! from everything.

use super::super::search::BodySkin;
use super::{boxed, of_parry, to_parry};
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::{TriMesh, TriMeshFlags, TrianglePointLocation};
use toile_geometry::Vec3;
use toile_geometry::signed_distance::{Nearest, PathEntry, entry_share};

/// The skin of a body on parry3d.
#[derive(Debug)]
pub struct ParrySkin {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    mesh: Option<TriMesh>,
}

impl ParrySkin {
    /// The pseudo-normal of the feature of a triangle that a point projects to, and whether that is
    /// its inside.
    fn pseudo_normal(&self, mesh: &TriMesh, t: u32, at: TrianglePointLocation) -> (Vec3, bool) {
        let normals = mesh.pseudo_normals();
        let corner = |k: u32| self.triangles.get(t as usize).map(|nodes| nodes[k as usize % 3] as usize);
        let found = match at {
            TrianglePointLocation::OnFace(..) | TrianglePointLocation::OnSolid => mesh.triangle_normal(t),
            TrianglePointLocation::OnEdge(k, _) => {
                normals.and_then(|n| n.edges_pseudo_normal.get(t as usize)).map(|n| n[k as usize % 3])
            }
            TrianglePointLocation::OnVertex(k) => {
                normals.and_then(|n| n.vertices_pseudo_normal.get(corner(k)?)).copied()
            }
        };
        let unit = found.and_then(|n| of_parry(n).try_normalize(0.0)).unwrap_or_else(Vec3::zeros);
        (unit, matches!(at, TrianglePointLocation::OnFace(..) | TrianglePointLocation::OnSolid))
    }
}

impl BodySkin for ParrySkin {
    fn over(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        let points = vertices.iter().map(to_parry).collect();
        let mesh = TriMesh::with_flags(points, triangles.clone(), TriMeshFlags::ORIENTED).ok();
        ParrySkin { vertices, triangles, mesh }
    }

    fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    fn nearest(&self, p: &Vec3, bound: f64) -> Option<Nearest> {
        let mesh = self.mesh.as_ref().filter(|_| p.iter().all(|x| x.is_finite()))?;
        // parry3d finds what is nearer than its bound, not what lies at it.
        let bound = bound.next_up().min(f64::MAX);
        let (on, (t, at)) =
            mesh.project_local_point_and_get_location_with_max_dist(to_parry(p), false, bound)?;
        let (pseudo, in_face) = self.pseudo_normal(mesh, t, at);
        Some(Nearest::signed(p, of_parry(on.point), pseudo, in_face))
    }

    fn entry(&self, p: &Vec3, q: &Vec3) -> Option<PathEntry> {
        let mesh = self.mesh.as_ref().filter(|_| p.iter().chain(q).all(|x| x.is_finite()))?;
        let mut first: Option<(f64, u32, Vec3)> = None;
        for t in mesh.bvh().intersect_aabb(&boxed(&[*p, *q], 0.0)) {
            let (Some(nodes), Some(normal)) = (self.triangles.get(t as usize), mesh.triangle_normal(t))
            else {
                continue;
            };
            let (corners, normal) = (nodes.map(|v| self.vertices[v as usize]), of_parry(normal));
            let Some(share) = entry_share(p, q, &corners, &normal) else { continue };
            if first.is_none_or(|(s, k, _)| (share, t) < (s, k)) {
                first = Some((share, t, normal));
            }
        }
        first.map(|(share, _, normal)| PathEntry { share, normal })
    }
}
