//! The boundary of a mask as closed loops.
//!
//! Method: follow the cracks between garment and ground pixels with the garment on the left
//! (crack following, Rosenfeld and Kak, 1976); the loop's points are the middles of the cracks, the
//! mask's half-way crossings. Garment pixels that touch only at a corner are kept apart, so that
//! no loop touches itself. Cost: one pass over the mask, and the loops' lengths. Limits: staircases
//! of half a pixel, which [`super::refine`] removes.

use image::GrayImage;
use toile_core::artifact::{Point2, polygon_area};

/// A closed loop in pixels with y up (`(x, -row)`); area positive for outer loops, negative for
/// holes.
#[derive(Debug, Clone)]
pub(crate) struct CrackLoop {
    pub(crate) points: Vec<Point2>,
    pub(crate) area: f64,
}

/// Steps to the right, down, left and up on the lattice of pixel corners.
const STEPS: [[i64; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
const DOWN: usize = 1;

/// All loops of the mask, in the order of their first pixel from the top.
pub(crate) fn loops(mask: &GrayImage) -> Vec<CrackLoop> {
    let (w, h) = mask.dimensions();
    let mut seen = vec![false; w as usize * h as usize];
    let mut found = Vec::new();
    for (j, row) in mask.as_raw().chunks_exact(w.max(1) as usize).enumerate() {
        let mut before = 0;
        for (i, &here) in row.iter().enumerate() {
            if here != 0 && before == 0 && !seen[j * w as usize + i] {
                found.push(follow(mask, [i as i64, j as i64], &mut seen));
            }
            before = here;
        }
    }
    found
}

/// Follows one loop from the left crack of pixel `start` downwards; marks the left cracks passed.
fn follow(mask: &GrayImage, start: [i64; 2], seen: &mut [bool]) -> CrackLoop {
    let (w, h) = mask.dimensions();
    let raw = mask.as_raw();
    let on = |x: i64, y: i64| {
        (0..i64::from(w)).contains(&x)
            && (0..i64::from(h)).contains(&y)
            && raw[y as usize * w as usize + x as usize] != 0
    };
    let (mut at, mut dir) = (start, DOWN);
    let mut points = Vec::new();
    loop {
        if dir == DOWN {
            seen[at[1] as usize * w as usize + at[0] as usize] = true;
        }
        let [dx, dy] = STEPS[dir];
        // The lattice point (i, j) is the upper left corner of pixel (i, j).
        points.push(Point2::new(at[0] as f64 + dx as f64 / 2.0 - 0.5, 0.5 - at[1] as f64 - dy as f64 / 2.0));
        at = [at[0] + dx, at[1] + dy];
        dir = turn(on, at, dir);
        if at == start && dir == DOWN {
            break;
        }
    }
    CrackLoop { area: polygon_area(&points), points }
}

/// The direction in which the loop leaves a lattice point that it reached in direction `dir`.
fn turn(on: impl Fn(i64, i64) -> bool, [i, j]: [i64; 2], dir: usize) -> usize {
    // Pixels ahead to the left and to the right.
    let (left, right) = match dir {
        0 => ((i, j - 1), (i, j)),
        1 => ((i, j), (i - 1, j)),
        2 => ((i - 1, j), (i - 1, j - 1)),
        _ => ((i - 1, j - 1), (i, j - 1)),
    };
    match (on(left.0, left.1), on(right.0, right.1)) {
        (false, _) => (dir + 3) % 4,
        (true, false) => dir,
        (true, true) => (dir + 1) % 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mask(rows: &[&str]) -> GrayImage {
        GrayImage::from_fn(rows[0].len() as u32, rows.len() as u32, |x, y| {
            image::Luma([255 * u8::from(rows[y as usize].as_bytes()[x as usize] == b'#')])
        })
    }

    #[test]
    fn a_ring_has_an_outer_loop_and_a_hole() {
        let found = loops(&mask(&["....", ".##.", "....", "###.", "#.#.", "###."]));
        let count = |sign: f64| found.iter().filter(|l| l.area * sign > 0.0).count();
        assert_eq!((count(1.0), count(-1.0)), (2, 1));
    }

    #[test]
    fn pixels_that_touch_at_a_corner_are_apart() {
        assert_eq!(loops(&mask(&["#.", ".#"])).len(), 2);
        // Through a corner the ground is one: two holes that touch at a corner are one loop.
        assert_eq!(loops(&mask(&["####", "#.##", "##.#", "####"])).len(), 2);
    }

    #[test]
    fn a_mask_may_fill_the_picture() {
        let found = loops(&mask(&["##", "##"]));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].points.len(), 8);
        assert!(found[0].area > 0.0);
    }
}
