//! Pictures whose ground has been cut away already: their opacity is the mask.
//!
//! Programs that remove the ground write such pictures, with a margin or cropped to the garment,
//! and then the garment touches the frame and is not cut by it. But a photo may be transparent
//! along its frame for other reasons: rounded corners, a round crop, the wedges that a turn leaves.
//! What is opaque in those is convex and the same turned by half; a garment is not both.
//!
//! Cost: two looks at every pixel's opacity, and the hull of the rows' ends (Andrew's monotone
//! chain, 1979). Limits: a photo whose perspective was corrected may be merely convex, as a skirt
//! is; a warning says what is taken for a skirt.

use super::tone::{OPAQUE, mark, rim_share};
use image::GrayImage;
use toile_core::prelude::*;

/// A picture whose rim is transparent to this share has had its ground cut away.
const RIM: f64 = 0.9;
/// Below this share of the picture, what is transparent is a detail of the frame.
const LEAST_TRANSPARENT: f64 = 0.02;
/// From this share of its hull on, the opaque part is convex.
const CONVEX: f64 = 0.97;

/// The opaque part counts as symmetric if at most this share of it differs from itself turned by
/// 180 degrees.
const SYMMETRIC: f64 = 0.03;

/// The garment of a picture whose ground was cut away.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CutOut {
    /// What is opaque.
    pub(super) mask: GrayImage,
    /// Whether its shape leaves no doubt.
    pub(super) sure: bool,
}

/// The garment of a picture whose ground was cut away; none for an ordinary photo.
pub(super) fn cut_out(photo: &Photo) -> Option<CutOut> {
    let alpha = photo.alpha.as_deref()?;
    let found = |sure| Some(CutOut { mask: mark(alpha, |_, a| a >= OPAQUE), sure });
    if rim_share(alpha, None, |a| a < OPAQUE) >= RIM {
        return found(true);
    }
    let pixels = alpha.as_raw();
    let opaque = pixels.iter().filter(|a| **a >= OPAQUE).count() as f64;
    if opaque > (1.0 - LEAST_TRANSPARENT) * pixels.len() as f64 {
        return None;
    }
    if opaque < CONVEX * hull_area(alpha) {
        return found(true);
    }
    let turned = pixels.iter().zip(pixels.iter().rev());
    let differs = turned.filter(|(a, b)| (**a >= OPAQUE) != (**b >= OPAQUE)).count() as f64;
    if differs <= SYMMETRIC * opaque { None } else { found(false) }
}

/// Area of the convex hull of the opaque pixels, in pixels.
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

    fn read(shape: impl Fn(f64, f64) -> bool) -> Option<bool> {
        let (w, h) = (120, 100);
        let alpha = GrayImage::from_fn(w, h, |x, y| {
            let (x, y) = ((f64::from(x) + 0.5) / f64::from(w), (f64::from(y) + 0.5) / f64::from(h));
            Luma([if shape(2.0 * x - 1.0, 2.0 * y - 1.0) { 255 } else { 0 }])
        });
        let found = cut_out(&Photo {
            pixels: image::RgbImage::new(w, h).into(),
            alpha: Some(alpha.into()),
            px_per_metre: None,
            garment_width: None,
            mirrored: false,
            joined: 1,
            file: "front.png".into(),
        });
        found.map(|f| f.sure)
    }

    #[test]
    fn a_shape_with_hollows_is_a_garment_cut_out_with_or_without_a_margin() {
        // A tee: a trunk, and sleeves that reach the frame.
        for scale in [1.0, 1.5] {
            let tee = move |x: f64, y: f64| {
                let (x, y) = (scale * x.abs(), scale * y);
                y.abs() < 1.0 && x < 1.0 && (x < 0.6 || y < -0.4)
            };
            assert_eq!(read(tee), Some(true), "{scale}");
        }
    }

    #[test]
    fn a_skirt_is_convex_and_not_the_same_upside_down() {
        assert_eq!(read(|x, y| x.abs() < 0.7 + 0.3 * y), Some(false));
    }

    #[test]
    fn a_photo_with_transparent_corners_or_wedges_is_none() {
        let round = |x: f64, y: f64| x * x + y * y < 1.0;
        let rounded = |x: f64, y: f64| (x.abs() - 0.6).max(0.0).hypot((y.abs() - 0.6).max(0.0)) < 0.4;
        let turned = |x: f64, y: f64| (x + 0.05 * y).abs() < 0.97 && (y - 0.05 * x).abs() < 0.97;
        let corner = |x: f64, y: f64| x + y > -1.8;
        for shape in [&round as &dyn Fn(f64, f64) -> bool, &rounded, &turned, &corner, &|_, _| true] {
            assert_eq!(read(shape), None);
        }
    }

    #[test]
    fn the_hull_of_a_rectangle_is_itself() {
        let alpha = GrayImage::from_fn(30, 20, |x, y| Luma([if x > 3 && y > 4 { 255 } else { 0 }]));
        assert_eq!(hull_area(&alpha), 26.0 * 15.0);
        assert_eq!(hull_area(&GrayImage::new(3, 3)), 0.0);
    }
}
