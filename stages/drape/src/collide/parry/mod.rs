//! parry3d as the kernel of a scheme: the skin of a body on its `TriMesh`, cloth on its tree of
//! boxes.
//!
//! Of parry3d are the trees, the closest points with their features, and the pseudo-normals. Of our
//! own are the exact signs by which a path enters and triangles cross, and the pairs of features
//! that two triangles answer for, of which parry3d has none.

mod cloth;
mod skin;

pub use cloth::ParryCloth;
pub use skin::ParrySkin;

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use toile_geometry::Vec3;

// parry3d's own vectors: these functions are the border.
fn to_parry(p: &Vec3) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

fn of_parry(v: Vector) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// The box of some points, wider by `by` on every side.
fn boxed(points: &[Vec3], by: f64) -> Aabb {
    let mut frame = Aabb::new_invalid();
    points.iter().for_each(|p| frame.take_point(to_parry(p)));
    Aabb::new(frame.mins - Vector::splat(by), frame.maxs + Vector::splat(by))
}
