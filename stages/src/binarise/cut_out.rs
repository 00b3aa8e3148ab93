//! Pictures whose ground has been cut away already: their opacity is the mask.
//!
//! Programs that remove the ground write such pictures, with a margin or cropped to the garment, and then the garment touches
//! the frame and is not cut by it. But a photo may be transparent along its frame for other reasons: rounded corners, a round
//! crop, the wedges that a turn or a perspective leaves. What is opaque in those is convex; the outline of most garments is not.
//!
//! Cost: one look at every pixel's opacity, and the hull of the rows' ends (Andrew's monotone chain, 1979). Limits: a skirt
//! laid straight is convex as well; there the opacity counts only where the method of the binariser finds no garment.

use super::tone::{OPAQUE, mark, rim_share};
use image::GrayImage;
use toile_core::prelude::*;

/// A picture whose rim is transparent to this share has had its ground cut away.
const RIM: f64 = 0.9;
/// Below this share of the picture, what is transparent is a detail of the frame.
const LEAST_TRANSPARENT: f64 = 0.02;
/// From this share of its hull on, the opaque part is convex.
const CONVEX: f64 = 0.97;

/// What a picture's opacity says of the garment.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Opacity {
    /// Nothing.
    Nothing,
    /// It is the mask.
    Mask(GrayImage),
    /// It is the mask, unless the picture shows a garment on a ground all the same.
    Perhaps(GrayImage),
}

/// Reads a photo's opacity.
pub(super) fn opacity(photo: &Photo) -> Opacity {
    let Some(alpha) = photo.alpha.as_deref() else { return Opacity::Nothing };
    let mask = || mark(alpha, |_, a| a >= OPAQUE);
    if rim_share(alpha, None, |a| a < OPAQUE) >= RIM {
        return Opacity::Mask(mask());
    }
    let opaque = alpha.as_raw().iter().filter(|a| **a >= OPAQUE).count() as f64;
    if opaque > (1.0 - LEAST_TRANSPARENT) * alpha.as_raw().len() as f64 {
        return Opacity::Nothing;
    }
    match opaque < CONVEX * hull_area(alpha) {
        true => Opacity::Mask(mask()),
        false => Opacity::Perhaps(mask()),
    }
}

/// Area of the convex hull of the opaque pixels, squares of a pixel.
fn hull_area(alpha: &GrayImage) -> f64 {
    let mut corners: Vec<[i64; 2]> = Vec::new();
    for (y, row) in (0..).zip(alpha.as_raw().chunks_exact(alpha.width().max(1) as usize)) {
        let is_opaque = |a: &u8| *a >= OPAQUE;
        let ends = row.iter().position(is_opaque).zip(row.iter().rposition(is_opaque));
        let Some((left, right)) = ends.map(|(l, r)| (l as i64, r as i64 + 1)) else { continue };
        corners.extend([[left, y], [right, y], [left, y + 1], [right, y + 1]]);
    }
    corners.sort_unstable();
    corners.dedup();
    let forward = chain(corners.iter());
    let back = chain(corners.iter().rev());
    let hull: Vec<[i64; 2]> = forward.into_iter().chain(back).collect();
    let cross = |(a, b): (&[i64; 2], &[i64; 2])| a[0] * b[1] - a[1] * b[0];
    let doubled: i64 = hull.iter().zip(hull.iter().cycle().skip(1)).map(cross).sum();
    doubled.abs() as f64 / 2.0
}

/// One half of the hull of points in order, without its last point.
fn chain<'a>(points: impl Iterator<Item = &'a [i64; 2]>) -> Vec<[i64; 2]> {
    let mut hull: Vec<[i64; 2]> = Vec::new();
    for p in points {
        let turns = |[a, b]: [[i64; 2]; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0;
        while let [.., a, b] = hull[..] {
            if turns([a, b]) {
                break;
            }
            hull.pop();
        }
        hull.push(*p);
    }
    hull.pop();
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Luma;

    fn read(shape: impl Fn(f64, f64) -> bool) -> Opacity {
        let (w, h) = (120, 100);
        let alpha = GrayImage::from_fn(w, h, |x, y| {
            let (x, y) = ((f64::from(x) + 0.5) / f64::from(w), (f64::from(y) + 0.5) / f64::from(h));
            Luma([if shape(2.0 * x - 1.0, 2.0 * y - 1.0) { 255 } else { 0 }])
        });
        opacity(&Photo {
            pixels: image::RgbImage::new(w, h).into(),
            alpha: Some(alpha.into()),
            px_per_metre: None,
            garment_width: None,
            mirrored: false,
            joined: 1,
            file: "front.png".into(),
        })
    }

    #[test]
    fn a_shape_with_hollows_is_a_garment_cut_out_with_or_without_a_margin() {
        // A tee: a trunk, and sleeves that reach the frame.
        for scale in [1.0, 1.5] {
            let tee = move |x: f64, y: f64| {
                let (x, y) = (scale * x.abs(), scale * y);
                y.abs() < 1.0 && x < 1.0 && (x < 0.6 || y < -0.4)
            };
            assert!(matches!(read(tee), Opacity::Mask(_)), "{scale}");
        }
    }

    #[test]
    fn a_convex_shape_may_be_a_skirt_or_the_frame_of_a_photo() {
        let round = |x: f64, y: f64| x * x + y * y < 1.0;
        let skirt = |x: f64, y: f64| x.abs() < 0.7 + 0.3 * y;
        let turned = |x: f64, y: f64| (x + 0.2 * y).abs() < 0.85 && (y - 0.2 * x).abs() < 0.85;
        assert!(matches!(read(skirt), Opacity::Perhaps(_)));
        assert!(matches!(read(turned), Opacity::Perhaps(_)));
        assert!(matches!(read(round), Opacity::Perhaps(_)));
    }

    #[test]
    fn a_small_transparent_corner_says_nothing() {
        assert_eq!(read(|x, y| x + y > -1.8), Opacity::Nothing);
        assert_eq!(read(|_, _| true), Opacity::Nothing);
    }

    #[test]
    fn the_hull_of_a_rectangle_is_itself() {
        let alpha = GrayImage::from_fn(30, 20, |x, y| Luma([if x > 3 && y > 4 { 255 } else { 0 }]));
        assert_eq!(hull_area(&alpha), 26.0 * 15.0);
        assert_eq!(hull_area(&GrayImage::new(3, 3)), 0.0);
    }
}
