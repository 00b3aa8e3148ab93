//! The discrete orientation polytope: `D` slabs of fixed directions, k = 2 D faces.
//!
//! Klosowski et al. 1998. 6-DOP is the axis-aligned box; 14 cuts its corners, 18 its edges, 26
//! both.

use super::{BoundingVolume, PAD};
use crate::Vec3;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

/// The slabs' directions: 3 along the axes, 4 along the cube's diagonals, 6 along its faces'.
const DIRECTIONS: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
];

/// Square root of three.
const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// A polytope of `D` slabs: 3, 7, 9 or 13.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KDop<const D: usize> {
    min: [f64; D],
    max: [f64; D],
}

impl<const D: usize> KDop<D> {
    /// The place of its `i`th slab in the list of directions: 18-DOP leaves the diagonals out.
    const fn slot(i: usize) -> usize {
        if D == 9 && i >= 3 { i + 4 } else { i }
    }

    /// Length of its `i`th direction, and that length's reciprocal.
    const fn length(i: usize) -> (f64, f64) {
        match Self::slot(i) {
            0..3 => (1.0, 1.0),
            3..7 => (SQRT_3, 1.0 / SQRT_3),
            _ => (SQRT_2, FRAC_1_SQRT_2),
        }
    }

    fn project(p: &Vec3) -> [f64; D] {
        std::array::from_fn(|i| {
            let [x, y, z] = DIRECTIONS[Self::slot(i)];
            x * p.x + y * p.y + z * p.z
        })
    }
}

impl<const D: usize> BoundingVolume for KDop<D> {
    fn fit(points: &[Vec3]) -> Self {
        let mut k = KDop { min: [f64::INFINITY; D], max: [f64::NEG_INFINITY; D] };
        for p in points {
            let s = Self::project(p);
            k.min = std::array::from_fn(|i| k.min[i].min(s[i]));
            k.max = std::array::from_fn(|i| k.max[i].max(s[i]));
        }
        // Along the axes nothing is rounded.
        let size = (0..3).map(|i| k.min[i].abs().max(k.max[i].abs())).sum::<f64>();
        for i in 3..D {
            let pad = PAD * size;
            k.min[i] -= pad;
            k.max[i] += pad;
        }
        k
    }

    fn merge(&self, other: &Self) -> Self {
        KDop {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
        }
    }

    fn near(&self, other: &Self, reach: f64) -> bool {
        (0..D).all(|i| {
            let reach = reach * Self::length(i).0 * if i < 3 { 1.0 } else { 1.0 + PAD };
            self.min[i] - other.max[i] <= reach && other.min[i] - self.max[i] <= reach
        })
    }

    fn distance_squared(&self, p: &Vec3) -> f64 {
        let s = Self::project(p);
        let gap = |i: usize| (self.min[i] - s[i]).max(s[i] - self.max[i]).max(0.0);
        let straight = (0..3).map(|i| gap(i) * gap(i)).sum();
        // Slightly less, so that the rounding of the lengths is on the safe side.
        let slanted = (3..D).map(|i| gap(i) * Self::length(i).1 * (1.0 - PAD)).fold(0.0, f64::max);
        f64::max(straight, slanted * slanted)
    }

    fn size(&self) -> f64 {
        (0..3).map(|i| self.max[i] - self.min[i]).sum()
    }
}
