//! Otsu's split on colour: the one axis of Lab along which the middle of the frame differs most
//! from its rim.
//!
//! The axis is Fisher's discriminant of the rim's and the middle's colours (Fisher, The use of
//! multiple measurements in taxonomic problems, 1936); along it the threshold is Otsu's (1979). It
//! knows one ground and one garment and no neighbours, so that it errs where the other methods do
//! not.
//!
//! Cost: two looks at every small pixel.

use super::super::background::{in_middle, rim_width};
use super::super::otsu::otsu;
use super::super::small::{Lab, SmallPhoto};
use nalgebra::Matrix3;

/// Added to the scatter, squared Lab units: noise of a camera.
const NOISE: f64 = 4.0;
/// Levels to a unit of the axis, which is scaled so that both means lie 100 levels apart.
const LEVELS: f64 = 100.0;

/// The garment's side of the split; `None` where rim or middle are empty or do not differ.
pub(super) fn colour_split(small: &SmallPhoto, rim: f64) -> Option<Vec<bool>> {
    let at_rim: Vec<bool> = (0..small.lab.len()).map(|i| small.depth(i) < rim_width(small, rim)).collect();
    let middle: Vec<bool> = (0..small.lab.len()).map(|i| in_middle(small, i)).collect();
    let (ground, garment) = (small.colours(&at_rim), small.colours(&middle));
    let ((b, scatter_b), (f, scatter_f)) = (scatter(&ground)?, scatter(&garment)?);
    let axis = (scatter_b + scatter_f + Matrix3::identity() * NOISE).try_inverse()? * (f - b);
    let apart = axis.dot(&(f - b));
    if apart <= 0.0 {
        return None;
    }
    let level = |c: &Lab| (78.0 + LEVELS * axis.dot(&(c - b)) / apart).clamp(0.0, 255.0) as u8;
    let mut bins = [0u64; 256];
    let seen = || small.lab.iter().zip(&small.seen).filter(|(_, seen)| **seen);
    seen().for_each(|(c, _)| bins[usize::from(level(c))] += 1);
    let split = otsu(&bins)?;
    Some(small.lab.iter().zip(&small.seen).map(|(c, seen)| *seen && level(c) > split.threshold).collect())
}

/// Mean and covariance.
fn scatter(colours: &[Lab]) -> Option<(Lab, Matrix3<f64>)> {
    let n = colours.len() as f64;
    if colours.is_empty() {
        return None;
    }
    let mean = colours.iter().sum::<Lab>() / n;
    let covariance = colours.iter().map(|c| (c - mean) * (c - mean).transpose()).sum::<Matrix3<f64>>() / n;
    Some((mean, covariance))
}
