//! Where the words of a piece stand on it.
//!
//! Method: the greatest size at which the block of words, lying or upright, fits between all lines
//! of the piece; of the places where it fits the one nearest to the piece's middle. Cost: sizes
//! times places times lines, some milliseconds a piece. Limit: on a piece that is too small for the
//! least size the words stand over its lines.

use crate::font;
use crate::inside::{bounds, contains, crosses};
use toile_core::artifact::{Point2, Vector2};

/// Sizes of the name that are tried, mm.
const SIZES: [f64; 8] = [9.0, 7.5, 6.0, 5.0, 4.0, 3.2, 2.6, 2.0];
/// Places that are tried across and along.
const PLACES: usize = 24;
/// From line to line, as a share of their size.
const LEADING: f64 = 1.35;
/// Around the words, as a share of the size of the name.
const AROUND: f64 = 0.35;

/// Words keep away from curves that are followed to this, metres.
pub(crate) const ROUGH: f64 = 2e-4;

/// A line of words: its text, its size as a share of that of the name, and whether it is bold.
pub(crate) type LabelLine = (String, f64, bool);

/// A place for a block of words, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LabelPlace {
    /// Its middle.
    pub at: Point2,
    /// The size of the name.
    pub size: f64,
    /// Whether the words run upwards.
    pub upright: bool,
}

/// The place for the words of a piece; the polygon is its outline, lines are all that is drawn on
/// it, mm.
pub(crate) fn place(words: &[LabelLine], polygon: &[Point2], lines: &[[Point2; 2]]) -> LabelPlace {
    let (lo, hi) = bounds(polygon);
    let middle = nalgebra::center(&lo, &hi);
    let mut inside: Vec<Point2> = places(lo, hi).filter(|at| contains(polygon, *at)).collect();
    inside.sort_by(|a, b| (a - middle).norm().total_cmp(&(b - middle).norm()));
    for size in SIZES {
        for upright in [false, true] {
            let half = half(words, size, upright);
            let free = |at: &&Point2| !lines.iter().any(|[a, b]| crosses(*a, *b, (*at - half, *at + half)));
            if let Some(at) = inside.iter().find(free) {
                return LabelPlace { at: *at, size, upright };
            }
        }
    }
    LabelPlace { at: middle, size: SIZES[SIZES.len() - 1], upright: false }
}

/// Half the size of the block.
fn half(words: &[LabelLine], size: f64, upright: bool) -> Vector2 {
    let wide =
        words.iter().map(|(text, share, bold)| font::width(text, size * share, *bold)).fold(0.0, f64::max);
    let [w, h] = [wide, height(words, size)].map(|s| s / 2.0 + AROUND * size);
    if upright { Vector2::new(h, w) } else { Vector2::new(w, h) }
}

/// The height of the block, mm.
pub(crate) fn height(words: &[LabelLine], size: f64) -> f64 {
    words.iter().map(|(_, share, _)| size * share * LEADING).sum()
}

/// From one line to the next, mm.
pub(crate) fn leading(share: f64, size: f64) -> f64 {
    size * share * LEADING
}

fn places(lo: Point2, hi: Point2) -> impl Iterator<Item = Point2> {
    let at = move |k: usize| {
        let [i, j] = [k % PLACES, k / PLACES].map(|n| (n as f64 + 0.5) / PLACES as f64);
        Point2::new(lo.x + (hi.x - lo.x) * i, lo.y + (hi.y - lo.y) * j)
    };
    (0..PLACES * PLACES).map(at)
}
