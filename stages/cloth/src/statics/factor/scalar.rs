//! The scalar of a factor: single or double precision.
//!
//! A factor in single precision takes half of the memory and of the time. Its solution is checked
//! with the matrix in double precision and refined (iterative refinement: Wilkinson 1963; Carson,
//! Higham 2018). Where that does not converge, the matrix is too ill conditioned and is factored in
//! double precision.

use faer::traits::RealField;
use std::iter::Sum;
use std::ops::{AddAssign, Div, Mul, Sub, SubAssign};

/// Precision of the factor of the matrix of each step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Single precision where it solves the step well enough, otherwise double.
    #[default]
    Mixed,
    /// Always double precision.
    Double,
}

/// A scalar of a factor.
pub trait Real:
    RealField
    + Copy
    + Sum
    + AddAssign
    + SubAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + PartialOrd
{
    /// Zero.
    const ZERO: Self;
    /// The nearest number of this precision.
    fn of(value: f64) -> Self;
    /// The same number in double precision.
    fn wide(self) -> f64;
}

impl Real for f64 {
    const ZERO: Self = 0.0;

    #[inline]
    fn of(value: f64) -> Self {
        value
    }

    #[inline]
    fn wide(self) -> f64 {
        self
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;

    #[inline]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline]
    fn wide(self) -> f64 {
        f64::from(self)
    }
}
