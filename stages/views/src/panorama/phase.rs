//! Shifts that two pictures may have to each other, by phase correlation.
//!
//! Method: the inverse Fourier transform of `A conj(B) / |A conj(B)|` is greatest at the shift
//! (Kuglin, Hines 1975). The pictures are laid on a field twice as large, so that each shift has a
//! place of its own, and fade out at their borders. Where little overlaps, the greatest value may
//! be another: several are given. Cost: three transforms of the field. Library: rustfft.

use crate::picture::GreyPlane;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Shifts that are given.
const CANDIDATES: usize = 12;
/// Shifts nearer than this to a greater one are the same, px.
const APART: usize = 3;
/// The share of a side over which a picture fades out at either end.
const FADE: f64 = 0.08;
/// Waves shorter than this are damped, px: noise and the pixels' own grid.
const SHORTEST: f64 = 2.5;

/// The most likely shifts `s` with `a(p) = b(p - s)`, whole pixels, the likeliest first.
pub(super) fn candidates(a: &GreyPlane, b: &GreyPlane) -> Vec<[i32; 2]> {
    let size = [a.width.max(b.width), a.height.max(b.height)].map(|n| (2 * n.max(1)).next_power_of_two());
    let field = FourierField::new(size);
    let (mut a, b) = (field.spectrum(a), field.spectrum(b));
    for (k, (p, q)) in a.iter_mut().zip(&b).enumerate() {
        let cross = *p * q.conj();
        *p = cross * (field.damping(k) / cross.norm().max(1e-12));
    }
    peaks(&field.back(a), size)
}

/// Transforms of one size.
struct FourierField {
    size: [usize; 2],
    forward: [Arc<dyn Fft<f32>>; 2],
    backward: [Arc<dyn Fft<f32>>; 2],
}

impl FourierField {
    fn new(size: [usize; 2]) -> FourierField {
        let mut planner = FftPlanner::new();
        let forward = size.map(|n| planner.plan_fft_forward(n));
        FourierField { size, forward, backward: size.map(|n| planner.plan_fft_inverse(n)) }
    }

    /// The spectrum of a picture less its mean, faded out; transposed.
    fn spectrum(&self, plane: &GreyPlane) -> Vec<Complex<f32>> {
        let seen = plane.levels.iter().zip(&plane.seen).filter(|(_, s)| **s).map(|(l, _)| f64::from(*l));
        let n = seen.clone().count().max(1);
        let mean = (seen.sum::<f64>() / n as f64) as f32;
        let mut values = vec![Complex::new(0.0, 0.0); self.size[0] * self.size[1]];
        for (y, row) in values.chunks_exact_mut(self.size[0]).take(plane.height).enumerate() {
            let fade = faded(y, plane.height);
            let own = y * plane.width..(y + 1) * plane.width;
            for (x, k) in own.enumerate() {
                if plane.seen[k] {
                    row[x].re = (plane.levels[k] - mean) * fade * faded(x, plane.width);
                }
            }
        }
        self.forward[0].process(&mut values);
        let mut values = transposed(&values, self.size[0], self.size[1]);
        self.forward[1].process(&mut values);
        values
    }

    /// The inverse transform of a transposed field, which is no longer transposed.
    fn back(&self, mut values: Vec<Complex<f32>>) -> Vec<Complex<f32>> {
        let [w, h] = self.size;
        self.backward[1].process(&mut values);
        let mut values = transposed(&values, h, w);
        self.backward[0].process(&mut values);
        values
    }

    /// The weight of a wave, of a transposed field.
    fn damping(&self, k: usize) -> f32 {
        let [w, h] = self.size;
        let wave = |i: usize, n: usize| i.min(n - i) as f64 / n as f64;
        let waves = wave(k / h, w).hypot(wave(k % h, h)) * SHORTEST;
        (-waves.powi(4)).exp() as f32
    }
}

/// One in the middle, down to zero at both ends.
fn faded(x: usize, length: usize) -> f32 {
    let ramp = FADE * length as f64;
    let near = (x.min(length - 1 - x) as f64 + 0.5) / ramp.max(1.0);
    if near >= 1.0 { 1.0 } else { (0.5 - 0.5 * (std::f64::consts::PI * near).cos()) as f32 }
}

fn transposed(values: &[Complex<f32>], width: usize, height: usize) -> Vec<Complex<f32>> {
    let mut out = Vec::with_capacity(values.len());
    for x in 0..width {
        out.extend((0..height).map(|y| values[y * width + x]));
    }
    out
}

/// Places of the greatest values, apart from each other, as shifts of either sign.
fn peaks(values: &[Complex<f32>], [w, h]: [usize; 2]) -> Vec<[i32; 2]> {
    let mut left: Vec<f32> = values.iter().map(|v| v.re).collect();
    let signed = |x: usize, n: usize| if x > n / 2 { x as i32 - n as i32 } else { x as i32 };
    let mut found = Vec::new();
    for _ in 0..CANDIDATES {
        let best =
            left.iter().enumerate().fold((0, f32::MIN), |b, (k, v)| if *v > b.1 { (k, *v) } else { b });
        if best.1 <= 0.0 {
            break;
        }
        let (x, y) = (best.0 % w, best.0 / w);
        found.push([signed(x, w), signed(y, h)]);
        for j in 0..=2 * APART {
            for i in 0..=2 * APART {
                left[(y + h + j - APART) % h * w + (x + w + i - APART) % w] = f32::MIN;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panorama::tests::noise;

    fn part(x: i32, y: i32) -> GreyPlane {
        let levels = (0..60 * 80).map(|k| noise(f64::from(k % 80 + x), f64::from(k / 80 + y)));
        GreyPlane { width: 80, height: 60, levels: levels.collect(), seen: vec![true; 60 * 80] }
    }

    #[test]
    fn a_shift_is_the_first_of_the_candidates() {
        for [x, y] in [[0, 0], [31, -4], [-40, 9], [5, 30]] {
            assert_eq!(candidates(&part(0, 0), &part(x, y))[0], [x, y]);
        }
    }

    #[test]
    fn a_blank_picture_has_no_peak_and_no_panic() {
        let blank = GreyPlane { width: 5, height: 1, levels: vec![3.0; 5], seen: vec![true; 5] };
        assert!(candidates(&blank, &blank).len() <= CANDIDATES);
        let unseen = GreyPlane { seen: vec![false; 5], ..blank.clone() };
        assert!(candidates(&unseen, &blank).is_empty());
    }
}
