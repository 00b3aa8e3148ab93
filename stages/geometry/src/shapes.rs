//! Meshes of simple shapes, for tests and examples.

use crate::Vec3;
use std::f64::consts::{PI, TAU};

/// Vertices and triangles.
pub type ShapeMesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// The box from `low` to `high`, two triangles a face, facing outwards.
#[must_use]
pub fn block(low: [f64; 3], high: [f64; 3]) -> ShapeMesh {
    let corner =
        |i: usize| Vec3::from(std::array::from_fn(|k| if i & (1 << k) == 0 { low[k] } else { high[k] }));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

/// The cube from -h to h.
#[must_use]
pub fn cube(h: f64) -> ShapeMesh {
    block([-h; 3], [h; 3])
}

/// A sphere about the origin of `2 * columns * (rows - 1)` triangles, its vertices on the radius.
#[must_use]
pub fn sphere(radius: f64, rows: u32, columns: u32) -> ShapeMesh {
    let mut positions = vec![Vec3::new(0.0, radius, 0.0), Vec3::new(0.0, -radius, 0.0)];
    for r in 1..rows {
        let theta = PI * f64::from(r) / f64::from(rows);
        for c in 0..columns {
            let phi = TAU * f64::from(c) / f64::from(columns);
            let (x, z) = (theta.sin() * phi.sin(), theta.sin() * phi.cos());
            positions.push(Vec3::new(x, theta.cos(), z) * radius);
        }
    }
    let at = |r: u32, c: u32| 2 + (r - 1) * columns + c % columns;
    let mut triangles = Vec::new();
    for c in 0..columns {
        triangles.push([0, at(1, c), at(1, c + 1)]);
        triangles.push([1, at(rows - 1, c + 1), at(rows - 1, c)]);
        for r in 1..rows - 1 {
            triangles.push([at(r, c), at(r + 1, c), at(r + 1, c + 1)]);
            triangles.push([at(r, c), at(r + 1, c + 1), at(r, c + 1)]);
        }
    }
    (positions, triangles)
}

/// A sheet of `2 * n * n` triangles over the unit square, lifted by `height(x, y)`.
#[must_use]
pub fn sheet(n: u32, height: impl Fn(f64, f64) -> f64) -> ShapeMesh {
    let at = |i: u32| f64::from(i) / f64::from(n);
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            positions.push(Vec3::new(at(i), at(j), height(at(i), at(j))));
            if i < n && j < n {
                let (a, b) = (j * (n + 1) + i, (j + 1) * (n + 1) + i);
                triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
            }
        }
    }
    (positions, triangles)
}

/// Two pieces of cloth as one.
#[must_use]
pub fn both(mut a: ShapeMesh, b: ShapeMesh) -> ShapeMesh {
    let offset = a.0.len() as u32;
    a.0.extend(b.0);
    a.1.extend(b.1.into_iter().map(|t| t.map(|i| i + offset)));
    a
}

/// Numbers from 0 to 1 that look random and are the same at every run.
pub fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A soup of triangles of size `size` in the unit cube; every third shares a vertex with the one
/// before.
#[must_use]
pub fn soup(seed: u64, count: u32, size: f64) -> ShapeMesh {
    let mut next = numbers(seed);
    let mut point = move |scale: f64| Vec3::new(next() * scale, next() * scale, next() * scale);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..count {
        let center = point(1.0);
        positions.extend((0..3).map(|_| center + point(size)));
        let first = if i % 3 == 2 { 3 * i - 1 } else { 3 * i };
        triangles.push([first, 3 * i + 1, 3 * i + 2]);
    }
    (positions, triangles)
}
