//! Which photo pixels a panel covers.
//!
//! Every triangle is scanned by rows of pixel centres; a pixel belongs to the panel when its centre
//! lies in or on a triangle of either winding, so that a mirrored photo needs no special case.
//! Cost: the panel's area in pixels. Exact up to rounding at the outline.

use image::GrayImage;
use toile_core::artifact::Point2;

/// A box of whole pixels, left and top included, right and bottom not; may reach past the photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PixelBox {
    pub(super) left: i64,
    pub(super) top: i64,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl PixelBox {
    /// Around points with a margin, as far as the photo with its own margin reaches; `None` beside
    /// the photo.
    pub(super) fn around(points: &[Point2], margin: u32, photo: (u32, u32)) -> Option<PixelBox> {
        let first = *points.first()?;
        let (lo, hi) = points.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
        let margin = i64::from(margin);
        let range = |lo: f64, hi: f64, size: u32| {
            let (from, to) = (lo.floor() as i64 - margin, hi.ceil() as i64 + margin);
            let (from, to) = (from.max(-margin), to.min(i64::from(size) - 1 + margin));
            let beside = hi < 0.0 || lo > f64::from(size) - 1.0;
            (!beside && from <= to).then(|| (from, (to - from + 1) as u32))
        };
        let ((left, width), (top, height)) = (range(lo.x, hi.x, photo.0)?, range(lo.y, hi.y, photo.1)?);
        Some(PixelBox { left, top, width, height })
    }

    /// Texture coordinates of a photo pixel: (0, 0) and (1, 1) are the box's outer corners, half a
    /// pixel beyond its first and last pixel centres.
    pub(super) fn uv(&self, px: &Point2) -> [f32; 2] {
        let share = |v: f64, from: i64, size: u32| ((v - from as f64 + 0.5) / f64::from(size)) as f32;
        [share(px.x, self.left, self.width), share(px.y, self.top, self.height)]
    }
}

/// Sets every pixel of the box that a triangle covers to 255.
pub(super) fn cover(picture: &mut GrayImage, points: &[Point2], triangles: &[[u32; 3]], area: PixelBox) {
    let origin = Point2::new(area.left as f64, area.top as f64);
    for t in triangles {
        let corners = t.map(|i| Point2::from(points[i as usize] - origin));
        fill(picture, corners);
    }
}

/// A panel of which the mask shows less than this share is not the one that it was made from.
const LEAST_SHOWN: f64 = 0.5;

/// Takes out what the mask of the photo does not show as garment. A mask of a photo that was
/// brought down has larger pixels.
pub(super) fn keep_shown(inside: &mut GrayImage, mask: &GrayImage, photo_width: u32, area: PixelBox) {
    let join = (f64::from(photo_width) / f64::from(mask.width().max(1))).round().max(1.0) as i64;
    let shown = |x: u32, y: u32| {
        let at = [i64::from(x) + area.left, i64::from(y) + area.top].map(|v| v.div_euclid(join));
        match at.map(u32::try_from) {
            [Ok(x), Ok(y)] if x < mask.width() && y < mask.height() => mask.get_pixel(x, y).0[0] != 0,
            _ => false,
        }
    };
    let is_kept = |(x, y, p): (u32, u32, &image::Luma<u8>)| p.0[0] != 0 && shown(x, y);
    let covered = inside.as_raw().iter().filter(|v| **v != 0).count() as f64;
    let kept = inside.enumerate_pixels().filter(|p| is_kept(*p)).count() as f64;
    if kept >= LEAST_SHOWN * covered {
        for (x, y, p) in inside.enumerate_pixels_mut() {
            if p.0[0] != 0 && !shown(x, y) {
                p.0[0] = 0;
            }
        }
    }
}

fn fill(picture: &mut GrayImage, corners: [Point2; 3]) {
    let (width, height) = picture.dimensions();
    let ys = corners.map(|p| p.y);
    let (lo, hi) = (
        ys.iter().copied().fold(f64::INFINITY, f64::min),
        ys.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    );
    let last = f64::from(height) - 1.0;
    for y in lo.ceil().max(0.0) as u32..=hi.floor().clamp(0.0, last) as u32 {
        let Some((from, to)) = crossing(&corners, f64::from(y)) else { continue };
        let from = from.ceil().max(0.0) as u32;
        let to = to.floor().min(f64::from(width) - 1.0);
        (f64::from(from) <= to)
            .then(|| (from..=to as u32).for_each(|x| picture.get_pixel_mut(x, y).0 = [255]));
    }
}

/// Where the row `y` enters and leaves a triangle.
fn crossing(corners: &[Point2; 3], y: f64) -> Option<(f64, f64)> {
    let mut range: Option<(f64, f64)> = None;
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        if y < a.y.min(b.y) || y > a.y.max(b.y) {
            continue;
        }
        let t = if a.y == b.y { 0.0 } else { (y - a.y) / (b.y - a.y) };
        let ends = if a.y == b.y { [a.x, b.x] } else { [a.x + t * (b.x - a.x); 2] };
        for x in ends {
            range = Some(range.map_or((x, x), |(lo, hi)| (lo.min(x), hi.max(x))));
        }
    }
    range
}
