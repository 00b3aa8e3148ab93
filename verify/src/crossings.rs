//! Cloth through cloth, and cloth through the body, by exact signs.
//!
//! Method: that of `toile_geometry::crossing`. Joined vertices count as one, so that neighbours
//! across a seam do not cross by meeting there; touching and coplanar triangles do not cross. Cost:
//! O(n log n + pairs).

use toile_core::artifact::{Body, Garment, Point3};
use toile_geometry::Vec3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::crossing::between_meshes;

/// Pairs of triangles of the garment that cross, lower number first, ascending.
#[must_use]
pub fn with_itself(garment: &Garment) -> Vec<[u32; 2]> {
    if garment.triangles.is_empty() {
        return Vec::new();
    }
    let x = coords(&garment.positions);
    ClothTree::new(&garment.triangles, &x).sewing(garment.weld.clone()).exact_crossings(&x)
}

/// Pairs of a triangle of the garment and one of the body that cross, ascending.
#[must_use]
pub fn with_body(garment: &Garment, body: &Body) -> Vec<[u32; 2]> {
    let (x, y) = (coords(&garment.positions), coords(&body.positions));
    between_meshes((&x, &garment.triangles), (&y, &body.triangles))
}

fn coords(points: &[Point3]) -> Vec<Vec3> {
    points.iter().map(|p| p.coords).collect()
}
