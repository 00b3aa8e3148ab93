//! Places of artifacts as the geometry's vectors, and back, without a copy.

use toile_core::artifact::Point3;
use toile_geometry::Vec3;

/// Places as vectors.
pub(crate) fn coords(points: &[Point3]) -> &[Vec3] {
    bytemuck::cast_slice(points)
}

/// Vectors as places.
pub(crate) fn of(vectors: &[Vec3]) -> &[Point3] {
    bytemuck::cast_slice(vectors)
}
