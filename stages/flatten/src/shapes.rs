//! Surfaces with known answers, for tests.

use crate::surface::PieceSurface;
use nalgebra::{Point2, Point3};

/// A mesh: places and triangles.
pub(crate) type PlainMesh = (Vec<Point3<f64>>, Vec<[u32; 3]>);

/// A grid of `m` x `n` squares of the unit square, each of two triangles that run counter-clockwise
/// in (u, v), put into space.
pub(crate) fn grid(m: usize, n: usize, place: impl Fn(f64, f64) -> [f64; 3]) -> PlainMesh {
    let at = |i: usize, j: usize| (j * (m + 1) + i) as u32;
    let places = (0..=n).flat_map(|j| (0..=m).map(move |i| (i as f64 / m as f64, j as f64 / n as f64)));
    let mut triangles = Vec::new();
    for j in 0..n {
        for i in 0..m {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            // Diagonals that mirror each other about the middle column.
            let halves = if 2 * i < m { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            triangles.extend(halves);
        }
    }
    (places.map(|(u, v)| Point3::from(place(u, v))).collect(), triangles)
}

/// The checked surface of a mesh that is known to be sound.
pub(crate) fn surface((places, triangles): PlainMesh) -> PieceSurface {
    PieceSurface::new(places, triangles).unwrap_or_else(|e| unreachable!("{e}"))
}

/// A third of a cylinder of radius 1.5 about y, 2 high; seen from outside it is `pi` wide.
pub(crate) fn cylinder(m: usize, n: usize) -> PlainMesh {
    grid(m, n, |u, v| {
        let angle = std::f64::consts::TAU / 3.0 * (0.5 - u);
        [-1.5 * angle.sin(), 2.0 * v, 1.5 * angle.cos()]
    })
}

/// A bump over the square of side 2, symmetric about x = 0, as high as `height`.
pub(crate) fn bump(m: usize, n: usize, height: f64) -> PlainMesh {
    grid(m, n, move |u, v| {
        let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        [x, y, height * (-3.0 * (x * x + y * y)).exp()]
    })
}

/// A closed cone of the given missing angle (radians) about y, slant from 0 to 1, its tip vertex 0.
pub(crate) fn cone(rings: usize, sectors: usize, missing: f64) -> PlainMesh {
    let sine = 1.0 - missing / std::f64::consts::TAU;
    let mut places = vec![Point3::origin()];
    let mut triangles = Vec::new();
    let at = |r: usize, s: usize| (1 + (r - 1) * sectors + s % sectors) as u32;
    for r in 1..=rings {
        let slant = r as f64 / rings as f64;
        for s in 0..sectors {
            let angle = std::f64::consts::TAU * s as f64 / sectors as f64;
            places.push(Point3::new(
                slant * sine * angle.sin(),
                slant * sine * angle.cos(),
                -slant * (1.0 - sine * sine).sqrt(),
            ));
        }
        for s in 0..sectors {
            if r == 1 {
                triangles.push([0, at(1, s + 1), at(1, s)]);
            } else {
                triangles.push([at(r - 1, s), at(r, s + 1), at(r, s)]);
                triangles.push([at(r - 1, s), at(r - 1, s + 1), at(r, s + 1)]);
            }
        }
    }
    (places, triangles)
}

/// The largest distance between flat places and the exact ones, after the best rigid motion without
/// mirror.
pub(crate) fn apart(flat: &[Point2<f64>], exact: &[Point2<f64>]) -> f64 {
    let middle =
        |p: &[Point2<f64>]| p.iter().fold(nalgebra::Vector2::zeros(), |s, p| s + p.coords) / p.len() as f64;
    let (a, b) = (middle(flat), middle(exact));
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (p, q) in flat.iter().zip(exact) {
        let (p, q) = (p.coords - a, q.coords - b);
        cosine += p.dot(&q);
        sine += p.perp(&q);
    }
    let turn = nalgebra::Rotation2::new(f64::atan2(sine, cosine));
    flat.iter().zip(exact).map(|(p, q)| (turn * (p.coords - a) - (q.coords - b)).norm()).fold(0.0, f64::max)
}
