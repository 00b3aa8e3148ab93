//! How much of a mask's contour lies where the photo has an edge.
//!
//! At each pixel of the contour the colours a little inside are held against those a little outside, along the normal. There
//! is an edge where they differ by more than is just visible and by more than either side varies by itself. A bite out of a
//! hem, a cut corner, a boundary in the middle of cloth have none.
//!
//! Cost: eight looks a pixel of the contour.

use super::super::small::{Lab, Small};

/// What the photo says of a contour.
#[derive(Debug, Clone)]
pub(super) struct Contour {
    /// Share of it that lies on an edge of the photo, 0 to 1.
    pub support: f64,
    /// Its longest stretch without an edge, as a share of its length.
    pub longest: f64,
    /// The contour's pixels without an edge.
    pub bare: Vec<usize>,
    /// The median difference of colour across it, Lab units.
    pub contrast: f64,
}

/// How far in and out colours are taken, small pixels.
const REACH: [f64; 3] = [1.5, 2.5, 3.5];
/// Half the side of the square over which the normal is taken, small pixels.
const NORMAL: isize = 3;
/// A difference of colour that is surely visible: twice the least that is (2.3).
const VISIBLE: f64 = 4.6;
/// An edge differs by more than so many standard deviations of its sides.
const CLEAR: f64 = 1.5;

/// The contour of a mask of the small picture's size. Where it runs along the frame it is not looked at.
pub(super) fn contour(small: &Small, mask: &[bool]) -> Contour {
    let (w, h) = (small.w as isize, small.h as isize);
    let on = |x: isize, y: isize| x >= 0 && y >= 0 && x < w && y < h && mask[(y * w + x) as usize];
    let is_rim = |x: isize, y: isize| {
        on(x, y)
            && [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
                .iter()
                .any(|&(a, b)| a >= 0 && b >= 0 && a < w && b < h && !on(a, b))
    };
    let rim: Vec<usize> = (0..mask.len()).filter(|&i| is_rim(i as isize % w, i as isize / w)).collect();
    let mut bare = vec![false; mask.len()];
    let mut contrasts: Vec<f64> = Vec::new();
    for &i in &rim {
        let (x, y) = (i as isize % w, i as isize / w);
        let mut normal = [0.0; 2];
        for dy in -NORMAL..=NORMAL {
            for dx in -NORMAL..=NORMAL {
                if on(x + dx, y + dy) {
                    normal[0] -= dx as f64;
                    normal[1] -= dy as f64;
                }
            }
        }
        let length = normal[0].hypot(normal[1]).max(1e-9);
        let colour = |t: f64| {
            let u = (x as f64 + t * normal[0] / length).round().clamp(0.0, (w - 1) as f64) as usize;
            let v = (y as f64 + t * normal[1] / length).round().clamp(0.0, (h - 1) as f64) as usize;
            small.lab[v * small.w + u]
        };
        let (inside, outside) = (REACH.map(|t| colour(-t)), REACH.map(|t| colour(t + 1.0)));
        let (a, sa) = spread(&inside);
        let (b, sb) = spread(&outside);
        let contrast = (a - b).norm();
        contrasts.push(contrast);
        bare[i] = contrast < VISIBLE.max(CLEAR * (0.5 * (sa + sb)).sqrt());
    }
    contrasts.sort_by(f64::total_cmp);
    let total = rim.len().max(1) as f64;
    let without: Vec<usize> = rim.into_iter().filter(|&i| bare[i]).collect();
    Contour {
        support: 1.0 - without.len() as f64 / total,
        longest: longest(&bare, &without, w, h) as f64 / total,
        contrast: contrasts.get(contrasts.len() / 2).copied().unwrap_or(0.0),
        bare: without,
    }
}

fn spread(colours: &[Lab; 3]) -> (Lab, f64) {
    let mean = colours.iter().sum::<Lab>() / 3.0;
    (mean, colours.iter().map(|c| (c - mean).norm_squared()).sum::<f64>() / 3.0)
}

/// The pixels of the longest stretch; gaps of a pixel do not part it.
fn longest(bare: &[bool], pixels: &[usize], w: isize, h: isize) -> usize {
    let mut seen = vec![false; bare.len()];
    let mut most = 0;
    for &start in pixels {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let (mut stack, mut count) = (vec![start], 0);
        while let Some(i) = stack.pop() {
            count += 1;
            let (x, y) = (i as isize % w, i as isize / w);
            for v in (y - 2).max(0)..=(y + 2).min(h - 1) {
                for u in (x - 2).max(0)..=(x + 2).min(w - 1) {
                    let j = (v * w + u) as usize;
                    if bare[j] && !seen[j] {
                        seen[j] = true;
                        stack.push(j);
                    }
                }
            }
        }
        most = most.max(count);
    }
    most
}
