//! Shapes that the tests of this folder share.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use toile_core::artifact::{Body, Point3};

pub(super) type Cloth = (Vec<Point3>, Vec<[u32; 3]>);

pub(super) fn body((positions, triangles): Cloth) -> Body {
    Body { positions, triangles, landmarks: BTreeMap::new(), measurements: BTreeMap::new() }
}

/// A cube from -h to h, two triangles a face.
pub(super) fn cube(h: f64) -> Body {
    let corner = |i: u32| {
        let at = |bit: u32| if i & bit == 0 { -h } else { h };
        Point3::new(at(1), at(2), at(4))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    body(((0..8).map(corner).collect(), triangles))
}

/// A sphere about the origin of `2 * columns * (rows - 1)` triangles, its vertices on the radius.
pub(super) fn sphere(radius: f64, rows: u32, columns: u32) -> Body {
    let mut positions = vec![Point3::new(0.0, radius, 0.0), Point3::new(0.0, -radius, 0.0)];
    for r in 1..rows {
        let theta = PI * f64::from(r) / f64::from(rows);
        for c in 0..columns {
            let phi = TAU * f64::from(c) / f64::from(columns);
            let (x, z) = (theta.sin() * phi.sin(), theta.sin() * phi.cos());
            positions.push(Point3::new(x, theta.cos(), z) * radius);
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
    body((positions, triangles))
}

/// A sheet of `2 * n * n` triangles over the unit square, lifted by `height(x, y)`.
pub(super) fn sheet(n: u32, height: impl Fn(f64, f64) -> f64) -> Cloth {
    let at = |i: u32| f64::from(i) / f64::from(n);
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            positions.push(Point3::new(at(i), at(j), height(at(i), at(j))));
            if i < n && j < n {
                let (a, b) = (j * (n + 1) + i, (j + 1) * (n + 1) + i);
                triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
            }
        }
    }
    (positions, triangles)
}

/// Two pieces of cloth as one.
pub(super) fn both(mut a: Cloth, b: Cloth) -> Cloth {
    let offset = a.0.len() as u32;
    a.0.extend(b.0);
    a.1.extend(b.1.into_iter().map(|t| t.map(|i| i + offset)));
    a
}

/// Numbers from 0 to 1 that look random and are the same at every run.
pub(super) fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A soup of triangles of size `size` in the unit cube; every third shares a vertex with the one before.
pub(super) fn soup(seed: u64, count: u32, size: f64) -> Cloth {
    let mut next = numbers(seed);
    let mut point = move |scale: f64| Point3::new(next() * scale, next() * scale, next() * scale);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..count {
        let center = point(1.0);
        positions.extend((0..3).map(|_| center + point(size).coords));
        let first = if i % 3 == 2 { 3 * i - 1 } else { 3 * i };
        triangles.push([first, 3 * i + 1, 3 * i + 2]);
    }
    (positions, triangles)
}
