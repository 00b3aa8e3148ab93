//! The numbers of a factor: of single or of double precision.
//!
//! A factor in single precision takes half of the memory and of the time. Its solution is held
//! against the matrix in double precision and refined (Wilkinson 1963; Carson, Higham 2018); where
//! that does not help, the matrix is too ill conditioned, and is factored in double precision.

use faer::traits::RealField;
use std::iter::Sum;
use std::ops::{AddAssign, Div, Mul, Sub, SubAssign};

/// How precise the factor of each step's matrix is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Single where that solves the step well, else double.
    #[default]
    Mixed,
    /// Always double.
    Double,
}

/// A number of a factor.
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
    /// The nearest number.
    fn of(value: f64) -> Self;
    /// Of double precision, the same number.
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
