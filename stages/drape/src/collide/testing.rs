//! Bodies and cloths that the tests of this folder share.

use super::points;
use std::collections::BTreeMap;
use toile_core::artifact::{Body, Point3};
use toile_geometry::shapes::{self, ShapeMesh};

pub(super) use toile_geometry::shapes::numbers;

pub(super) type ClothMesh = (Vec<Point3>, Vec<[u32; 3]>);

fn cloth((positions, triangles): ShapeMesh) -> ClothMesh {
    (points::of(&positions).to_vec(), triangles)
}

pub(super) fn body((positions, triangles): ClothMesh) -> Body {
    Body { positions, triangles, landmarks: BTreeMap::new(), measurements: BTreeMap::new() }
}

/// A cube from -h to h.
pub(super) fn cube(h: f64) -> Body {
    body(cloth(shapes::cube(h)))
}

/// See [`shapes::sphere`].
pub(super) fn sphere(radius: f64, rows: u32, columns: u32) -> Body {
    body(cloth(shapes::sphere(radius, rows, columns)))
}

/// See [`shapes::sheet`].
pub(super) fn sheet(n: u32, height: impl Fn(f64, f64) -> f64) -> ClothMesh {
    cloth(shapes::sheet(n, height))
}

/// See [`shapes::soup`].
pub(super) fn soup(seed: u64, count: u32, size: f64) -> ClothMesh {
    cloth(shapes::soup(seed, count, size))
}

/// Two pieces of cloth as one.
pub(super) fn both(mut a: ClothMesh, b: ClothMesh) -> ClothMesh {
    let offset = a.0.len() as u32;
    a.0.extend(b.0);
    a.1.extend(b.1.into_iter().map(|t| t.map(|i| i + offset)));
    a
}
