//! The oriented box.
//!
//! Gottschalk, Lin, Manocha 1996: axes from the covariance of the points, overlap by the
//! separating-axis test of 15 axes. A single triangle takes its own frame. Two boxes are merged
//! in the best of three frames: each one's own, and the principal axes of the two filled boxes.

use super::{BoundingVolume, PAD};
use crate::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

/// Squared sine below which two axes count as parallel: their cross product separates nothing that
/// the axes themselves do not.
const PARALLEL: f64 = 1e-10;

/// A box along axes of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obb {
    /// Its middle.
    pub center: Vec3,
    /// Orthonormal axes, as columns.
    pub axes: Matrix3<f64>,
    /// Half lengths along the axes.
    pub half: Vec3,
}

impl Obb {
    /// The box along given axes that spans a range on each, widened slightly against rounding.
    fn along(axes: Matrix3<f64>, low: Vec3, high: Vec3) -> Self {
        let center = axes * ((low + high) / 2.0);
        let half = (high - low) / 2.0;
        let pad = PAD * (center.amax() + half.amax());
        Obb { center, axes, half: half.add_scalar(pad) }
    }

    fn around(axes: Matrix3<f64>, points: &[Vec3]) -> Self {
        let far = Vec3::repeat(f64::INFINITY);
        let (low, high) = points.iter().fold((far, -far), |(low, high), p| {
            let s = axes.tr_mul(p);
            (low.inf(&s), high.sup(&s))
        });
        Self::along(axes, low, high)
    }

    /// The range of the box along each of the given axes.
    fn range(&self, axes: &Matrix3<f64>) -> (Vec3, Vec3) {
        let c = axes.tr_mul(&self.center);
        let h = axes.tr_mul(&self.axes).abs() * self.half;
        (c - h, c + h)
    }

    fn merged(axes: Matrix3<f64>, a: &Obb, b: &Obb) -> Self {
        let ((la, ha), (lb, hb)) = (a.range(&axes), b.range(&axes));
        Self::along(axes, la.inf(&lb), ha.sup(&hb))
    }

    /// Three times the covariance of a box evenly filled.
    fn spread(&self) -> Matrix3<f64> {
        self.axes * Matrix3::from_diagonal(&self.half.component_mul(&self.half)) * self.axes.transpose()
    }

    fn half_area(&self) -> f64 {
        let h = self.half;
        h.x * h.y + h.y * h.z + h.z * h.x
    }

    fn smaller(self, other: Obb) -> Obb {
        if other.half_area() < self.half_area() { other } else { self }
    }
}

/// The frame of up to three points: along the longest side, and across.
fn triangle_frame(points: &[Vec3]) -> Matrix3<f64> {
    let at = |i: usize| points[i.min(points.len() - 1)];
    let sides = [at(1) - at(0), at(2) - at(1), at(0) - at(2)];
    let longest =
        sides.iter().fold(sides[0], |a, b| if b.norm_squared() > a.norm_squared() { *b } else { a });
    let Some(x) = longest.try_normalize(0.0) else { return Matrix3::identity() };
    let n = sides[0].cross(&sides[1]);
    frame(&x, &n).unwrap_or_else(|| Matrix3::from_columns(&[x, across(&x).cross(&x), across(&x)]))
}

/// The frame of a unit vector and of another vector, made square to it; `None` for parallel ones.
fn frame(x: &Vec3, towards: &Vec3) -> Option<Matrix3<f64>> {
    let z = towards.try_normalize(0.0)?;
    // Twice, because the first time leaves the rounding of a small remainder.
    let z = (z - x * z.dot(x)).try_normalize(1e-3)?;
    let z = (z - x * z.dot(x)).normalize();
    Some(Matrix3::from_columns(&[*x, z.cross(x), z]))
}

/// A unit vector square to a unit vector.
fn across(x: &Vec3) -> Vec3 {
    let mut least = Vec3::zeros();
    least[x.iamin()] = 1.0;
    x.cross(&least).normalize()
}

/// The covariance of points.
fn covariance(points: &[Vec3]) -> Matrix3<f64> {
    let mean = points.iter().sum::<Vec3>() / points.len() as f64;
    points.iter().map(|p| p - mean).map(|d| d * d.transpose()).sum()
}

/// The eigenvectors of a covariance, as columns.
fn principal_axes(covariance: &Matrix3<f64>) -> Matrix3<f64> {
    let axes = SymmetricEigen::new(covariance / covariance.amax().max(f64::MIN_POSITIVE)).eigenvectors;
    let square = (axes.tr_mul(&axes) - Matrix3::identity()).amax() < 1e-12;
    if square { axes } else { Matrix3::identity() }
}

impl BoundingVolume for Obb {
    fn fit(points: &[Vec3]) -> Self {
        let axes =
            if points.len() > 3 { principal_axes(&covariance(points)) } else { triangle_frame(points) };
        Obb::around(Matrix3::identity(), points).smaller(Obb::around(axes, points))
    }

    fn merge(&self, other: &Self) -> Self {
        let apart = (other.center - self.center) / 2.0;
        let spread = self.spread() + other.spread() + apart * apart.transpose() * 6.0;
        [self.axes, other.axes]
            .into_iter()
            .fold(Obb::merged(principal_axes(&spread), self, other), |best, axes| {
                best.smaller(Obb::merged(axes, self, other))
            })
    }

    fn near(&self, other: &Self, reach: f64) -> bool {
        let turn = self.axes.tr_mul(&other.axes);
        let apart = self.axes.tr_mul(&(other.center - self.center));
        let (a, b, wide) = (self.half, other.half, turn.abs());
        let slack = 1.0 + PAD;
        for i in 0..3 {
            let rb = wide[(i, 0)] * b[0] + wide[(i, 1)] * b[1] + wide[(i, 2)] * b[2];
            if apart[i].abs() > (a[i] + rb + reach) * slack {
                return false;
            }
        }
        for j in 0..3 {
            let ra = wide[(0, j)] * a[0] + wide[(1, j)] * a[1] + wide[(2, j)] * a[2];
            if apart.dot(&turn.column(j)).abs() > (b[j] + ra + reach) * slack {
                return false;
            }
        }
        !(0..9).any(|k| separated_across(k / 3, k % 3, &turn, &wide, &apart, (&a, &b), reach))
    }

    fn distance_squared(&self, p: &Vec3) -> f64 {
        let s = self.axes.tr_mul(&(p - self.center));
        (s.abs() - self.half).map(|d| d.max(0.0)).norm_squared() * (1.0 - PAD)
    }

    fn size(&self) -> f64 {
        self.half.sum()
    }
}

/// True where the cross product of axis `i` of the first and `j` of the second box separates them.
fn separated_across(
    i: usize,
    j: usize,
    turn: &Matrix3<f64>,
    wide: &Matrix3<f64>,
    apart: &Vec3,
    (a, b): (&Vec3, &Vec3),
    reach: f64,
) -> bool {
    let length_squared = 1.0 - turn[(i, j)] * turn[(i, j)];
    if length_squared < PARALLEL {
        return false;
    }
    let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
    let ra = a[i1] * wide[(i2, j)] + a[i2] * wide[(i1, j)];
    let rb = b[j1] * wide[(i, j2)] + b[j2] * wide[(i, j1)];
    let gap = (apart[i2] * turn[(i1, j)] - apart[i1] * turn[(i2, j)]).abs();
    // Rounding is relative to the boxes' sizes, not to the short axis.
    let rounding = PAD * (a.amax() + b.amax() + apart.amax());
    gap > ra + rb + reach * length_squared.sqrt() * (1.0 + PAD) + rounding
}
