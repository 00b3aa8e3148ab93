//! How much of a mask's contour lies where the photo has an edge.
//!
//! At each pixel of the contour the colours a little inside are held against those a little
//! outside, along the normal. There is an edge where they differ by more than is just visible and
//! by more than either side varies by itself. A bite out of a hem, a cut corner, a boundary in the
//! middle of cloth have none.
//!
//! Cost: eight looks a pixel of the contour.

use super::super::small::{Lab, SmallPhoto};

/// How far in and out colours are taken, small pixels.
const REACH: [f64; 3] = [1.5, 2.5, 3.5];
/// Half the side of the square over which the normal is taken, small pixels.
const NORMAL: isize = 3;
/// A difference of colour that is surely visible: twice the least that is (2.3).
const VISIBLE: f64 = 4.6;
/// An edge differs by more than so many standard deviations of its sides.
const CLEAR: f64 = 1.5;

/// What ends beside the frame lies at most so far from it, as a share of the shorter side: methods
/// take the rim, 0.03, for ground.
const BESIDE: f64 = 0.035;

/// The share of a mask's contour that lies on an edge of the photo, 0 to 1; the mask is of the
/// small picture's size. Where the contour runs along the frame it is not looked at.
pub(super) fn support(small: &SmallPhoto, mask: &[bool]) -> f64 {
    let (bare, total) = bare(small, mask);
    1.0 - bare.len() as f64 / total.max(1) as f64
}

/// How much of a mask's contour lies beside the frame and not on an edge of the photo, as a share
/// of the shorter side: there the garment goes on past the frame.
pub(super) fn bare_along_frame(small: &SmallPhoto, mask: &[bool]) -> f64 {
    let side = small.w.min(small.h) as f64;
    let beside = bare(small, mask).0.into_iter().filter(|i| (small.depth(*i) as f64) < BESIDE * side);
    beside.count() as f64 / side
}

/// The contour's pixels that lie on no edge of the photo, and how many it has in all.
fn bare(small: &SmallPhoto, mask: &[bool]) -> (Vec<usize>, usize) {
    let (w, h) = (small.w as isize, small.h as isize);
    let on = |x: isize, y: isize| x >= 0 && y >= 0 && x < w && y < h && mask[(y * w + x) as usize];
    let is_rim = |x: isize, y: isize| {
        on(x, y)
            && [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
                .iter()
                .any(|&(a, b)| a >= 0 && b >= 0 && a < w && b < h && !on(a, b))
    };
    let rim: Vec<usize> = (0..mask.len()).filter(|&i| is_rim(i as isize % w, i as isize / w)).collect();
    let is_bare = |i: &usize| {
        let (x, y) = (*i as isize % w, *i as isize / w);
        let mut normal = [0.0; 2];
        let square = (-NORMAL..=NORMAL).flat_map(|dy| (-NORMAL..=NORMAL).map(move |dx| (dx, dy)));
        for (dx, dy) in square.filter(|(dx, dy)| on(x + dx, y + dy)) {
            normal[0] -= dx as f64;
            normal[1] -= dy as f64;
        }
        let length = normal[0].hypot(normal[1]).max(1e-9);
        let colour = |t: f64| {
            let u = (x as f64 + t * normal[0] / length).round().clamp(0.0, (w - 1) as f64) as usize;
            let v = (y as f64 + t * normal[1] / length).round().clamp(0.0, (h - 1) as f64) as usize;
            small.lab[v * small.w + u]
        };
        let (a, inside) = spread(&REACH.map(|t| colour(-t)));
        let (b, outside) = spread(&REACH.map(|t| colour(t + 1.0)));
        (a - b).norm() < VISIBLE.max(CLEAR * (0.5 * (inside + outside)).sqrt())
    };
    let total = rim.len();
    (rim.into_iter().filter(is_bare).collect(), total)
}

fn spread(colours: &[Lab; 3]) -> (Lab, f64) {
    let mean = colours.iter().sum::<Lab>() / 3.0;
    (mean, colours.iter().map(|c| (c - mean).norm_squared()).sum::<f64>() / 3.0)
}
