//! A photo with what was taken for the garment drawn into it, for a look at why it was refused.

use image::{GrayImage, Rgb, RgbImage};
use toile_core::prelude::*;

/// The outline, and where the garment meets the frame, sRGB.
const LINE: [u8; 3] = [255, 0, 120];
/// What is left of the ground's light.
const GROUND: f64 = 0.4;
/// Width of the line, as a share of the photo's shorter side.
const WIDTH: f64 = 0.004;

/// The photo with its ground darkened, the outline of the mask drawn, and a band where the mask
/// meets the frame.
pub(super) fn marked(photo: &Photo, mask: &GrayImage) -> Photo {
    let (w, h) = mask.dimensions();
    let reach = (WIDTH * f64::from(w.min(h))).ceil().max(1.0) as i64;
    let on = |x: i64, y: i64| {
        let inside = x >= 0 && y >= 0 && x < i64::from(w) && y < i64::from(h);
        inside.then(|| mask.get_pixel(x as u32, y as u32).0[0] > 127)
    };
    let pixel = |x: u32, y: u32| {
        let (x, y) = (i64::from(x), i64::from(y));
        let is_on = on(x, y) == Some(true);
        // Outside of the photo there is neither: a garment that extends there has a band, and no
        // outline.
        let around = [(reach, 0), (-reach, 0), (0, reach), (0, -reach)].map(|(dx, dy)| on(x + dx, y + dy));
        let is_line = around.iter().any(|there| match there {
            Some(there) => *there != is_on,
            None => is_on,
        });
        let own = photo.pixels.get_pixel(x as u32, y as u32).0;
        Rgb(match (is_line, is_on) {
            (true, _) => LINE,
            (false, true) => own,
            (false, false) => own.map(|c| (GROUND * f64::from(c)) as u8),
        })
    };
    Photo { pixels: Shared::new(RgbImage::from_fn(w, h, pixel)), alpha: None, ..photo.clone() }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use image::Luma;
    use toile_core::testkit::shapes;

    #[test]
    fn the_garment_keeps_its_colours_and_is_outlined_where_it_ends_or_meets_the_frame() {
        let photo =
            Photo { pixels: Shared::new(RgbImage::from_pixel(9, 9, Rgb([100; 3]))), ..shapes::photo() };
        // On in the four left columns.
        let mask = GrayImage::from_fn(9, 9, |x, _| Luma([if x < 4 { 255 } else { 0 }]));
        let found = marked(&photo, &mask).pixels;
        let row: Vec<[u8; 3]> = (0..9).map(|x| found.get_pixel(x, 4).0).collect();
        let (own, dark) = ([100; 3], [40; 3]);
        assert_eq!(row, [LINE, own, own, LINE, LINE, dark, dark, dark, dark]);
    }
}
