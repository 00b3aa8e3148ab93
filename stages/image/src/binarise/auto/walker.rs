//! Which side a random walk reaches first: the frame's rim or the frame's middle.
//!
//! A walker steps from pixel to pixel, less readily across a step of colour (Grady, Random walks
//! for image segmentation, IEEE PAMI 28(11), 2006). The chance that it comes to the middle before
//! it comes to the rim is the solution of a Laplace equation on the grid, found by conjugate
//! gradients. It knows edges alone and no colour of either side: a weak edge that goes all around
//! is enough, and a print, which is as unlike its cloth as cloth and ground are, does not part
//! them.
//!
//! Cost: some 100 rounds of ten operations a pixel; 20 ms at 200 pixels. Limits: on a patterned
//! ground the edges of the pattern hold the walker up, and the boundary lies at any of them.

use super::super::background::rim_width;
use super::super::small::SmallPhoto;
use crate::grid::{Grid, StoppingRule};
use toile_core::prelude::*;

/// How much a step of colour holds the walker up, against the mean square of all steps.
const BETA: f64 = 1.0;
/// What passes across the largest step: keeps every pixel in reach.
const LEAST: f64 = 1e-3;
/// When the rounds end.
const END: StoppingRule = StoppingRule { residual: 1e-3, rounds: 400 };

/// The chance of each pixel to be garment, 0 to 1; `inside` is known to be garment, the rim ground.
pub(super) fn walk(
    small: &SmallPhoto,
    inside: &[bool],
    rim: f64,
    cx: &Context,
) -> Result<Vec<f64>, StageError> {
    let (w, h) = (small.w, small.h);
    let n = w * h;
    let rim = rim_width(small, rim);
    let fixed: Vec<Option<f64>> = (0..n)
        .map(|i| match (inside[i], small.depth(i) < rim || !small.seen[i]) {
            (_, true) => Some(0.0),
            (true, false) => Some(1.0),
            _ => None,
        })
        .collect();
    let (right, down) = weights(small, inside);
    Grid { width: w, right, down }.between_fixed(&fixed, &END, cx)
}

/// How readily a walker passes to the right and down; zero past the frame. Steps within what is
/// known to be garment do not count in the mean, so that a print's edges do not hide the cloth's.
fn weights(small: &SmallPhoto, inside: &[bool]) -> (Vec<f64>, Vec<f64>) {
    let (w, n) = (small.w, small.lab.len());
    let step = |i: usize, j: usize| (small.lab[i] - small.lab[j]).norm_squared();
    let pairs = |next: usize, is_last: &dyn Fn(usize) -> bool| -> Vec<f64> {
        (0..n).map(|i| if is_last(i) { 0.0 } else { step(i, i + next) }).collect()
    };
    let across = pairs(1, &|i| i % w + 1 == w);
    let along = pairs(w, &|i| i + w >= n);
    let open = |steps: &[f64]| {
        let free = steps.iter().zip(inside).filter(|(_, inside)| !**inside);
        free.fold((0.0, 0), |(sum, count), (step, _)| (sum + step, count + 1))
    };
    let ((a, m), (b, k)) = (open(&across), open(&along));
    let mean = (a + b) / f64::from(m + k).max(1.0);
    let beta = if mean > 0.0 { BETA / mean } else { 0.0 };
    let weight = |d: &f64| (-beta * d).exp() + LEAST;
    let within = |steps: &[f64], is_last: &dyn Fn(usize) -> bool| -> Vec<f64> {
        steps.iter().enumerate().map(|(i, d)| if is_last(i) { 0.0 } else { weight(d) }).collect()
    };
    (within(&across, &|i| i % w + 1 == w), within(&along, &|i| i + w >= n))
}
