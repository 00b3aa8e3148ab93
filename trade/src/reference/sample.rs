//! Which settings to try: a space-filling start, then the gaps of the front.
//!
//! The start is Halton's sequence (1960) in the unit cube of the knobs, its bases the first primes:
//! any number of points covers the cube evenly, and more can be added. Then every gap between
//! neighbours on the front (in decades of time plus decades of error, the two open ends included)
//! is a place to look: the setting half-way between its two ends, or, where that is known, a step
//! of one knob away from an end, with steps that halve.
//!
//! Cost: nothing beside a run. Limits: the midpoint of two settings need not lie on the front; what
//! lies far from any measured point is only found by the start.

use crate::front::Cost;

/// One base a knob; more knobs use them again from the start, shifted.
const PRIMES: [u32; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

/// Steps away from a point of the front, as shares of a knob's range.
const STEPS: [f64; 4] = [0.25, 0.125, 0.0625, 0.031_25];

/// The `i`-th point of the start.
pub fn halton(i: usize, dimensions: usize) -> Vec<f64> {
    let shifted = |d: usize| {
        (radical_inverse(i as u64 + 1, PRIMES[d % PRIMES.len()]) + 0.37 * (d / PRIMES.len()) as f64).fract()
    };
    (0..dimensions).map(shifted).collect()
}

fn radical_inverse(mut i: u64, base: u32) -> f64 {
    let (base, mut share, mut sum) = (u64::from(base), 1.0, 0.0);
    while i > 0 {
        share /= base as f64;
        sum += (i % base) as f64 * share;
        i /= base;
    }
    sum
}

/// Places to look at next, the best first; `front` holds place and cost of the front's points by
/// ascending time. Knobs marked in `discrete` are not averaged: both values of a pair are tried.
pub fn candidates(front: &[(Vec<f64>, Cost)], discrete: &[bool]) -> Vec<Vec<f64>> {
    let mut gaps: Vec<(f64, Vec<Vec<f64>>)> =
        front.windows(2).map(|w| (gap(&w[0].1, &w[1].1), between(&w[0].0, &w[1].0, discrete))).collect();
    gaps.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut all: Vec<Vec<f64>> = gaps.into_iter().flat_map(|(_, places)| places).collect();
    for step in STEPS {
        all.extend(front.iter().flat_map(|(place, _)| around(place, step, discrete)));
    }
    all
}

/// Decades between two costs.
fn gap(a: &Cost, b: &Cost) -> f64 {
    let decades = |x: f64, y: f64| (x.max(1e-9) / y.max(1e-9)).log10().abs();
    decades(a.time, b.time) + decades(a.error, b.error)
}

fn between(a: &[f64], b: &[f64], discrete: &[bool]) -> Vec<Vec<f64>> {
    let mix = |ends: [&[f64]; 2]| -> Vec<f64> {
        (0..a.len()).map(|k| if discrete[k] { ends[0][k] } else { (a[k] + b[k]) / 2.0 }).collect()
    };
    let differs = (0..a.len()).any(|k| discrete[k] && a[k] != b[k]);
    if differs { vec![mix([a, b]), mix([b, a])] } else { vec![mix([a, b])] }
}

fn around(place: &[f64], step: f64, discrete: &[bool]) -> Vec<Vec<f64>> {
    let moved = |k: usize, by: f64| {
        let mut p = place.to_vec();
        p[k] = (p[k] + by).clamp(0.0, 1.0);
        p
    };
    (0..place.len()).filter(|&k| !discrete[k]).flat_map(|k| [moved(k, step), moved(k, -step)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_start_is_halton() {
        let found: Vec<Vec<f64>> = (0..3).map(|i| halton(i, 2)).collect();
        let exact = [[0.5, 1.0 / 3.0], [0.25, 2.0 / 3.0], [0.75, 1.0 / 9.0]];
        for (f, e) in found.iter().zip(exact) {
            assert!((f[0] - e[0]).abs() < 1e-12 && (f[1] - e[1]).abs() < 1e-12, "{f:?}");
        }
    }

    #[test]
    fn the_start_leaves_no_quarter_of_the_square_empty() {
        for x in 0..4 {
            for y in 0..4 {
                let inside = |p: &[f64]| (p[0] * 4.0) as usize == x && (p[1] * 4.0) as usize == y;
                assert!((0..40).any(|i| inside(&halton(i, 2))), "{x} {y}");
            }
        }
    }

    #[test]
    fn the_widest_gap_comes_first_and_choices_are_not_averaged() {
        let at = |place: [f64; 2], time, error| (place.to_vec(), Cost { time, error });
        let front = [at([0.25, 0.9], 1.0, 10.0), at([0.25, 0.7], 2.0, 9.0), at([0.75, 0.1], 90.0, 0.1)];
        let found = candidates(&front, &[true, false]);
        for (f, exact) in found.iter().zip([[0.25, 0.4], [0.75, 0.4], [0.25, 0.8]]) {
            assert!((f[0] - exact[0]).abs() < 1e-12 && (f[1] - exact[1]).abs() < 1e-12, "{f:?}");
        }
    }

    proptest! {
        #[test]
        fn candidates_stay_in_the_cube(raw in prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64, 1e-3..1e3f64, 1e-3..1e2f64), 0..8)) {
            let front: Vec<(Vec<f64>, Cost)> =
                raw.iter().map(|&(a, b, time, error)| (vec![a, b], Cost { time, error })).collect();
            for c in candidates(&front, &[false, true]) {
                prop_assert!(c.len() == 2 && c.iter().all(|x| (0.0..=1.0).contains(x)));
            }
        }
    }
}
