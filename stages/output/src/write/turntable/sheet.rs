//! Rendered views as image sheets: of each view only the blocks of 8 x 8 px that the model is in,
//! one after the other.
//!
//! A page that has the mesh needs no transparency: beyond the model's outline its colours go on, so
//! that neither JPEG nor reading between pixels mixes them with a background.

use image::codecs::jpeg::JpegEncoder;
use image::{ImageBuffer, PixelWithColorType, Rgb, RgbImage, RgbaImage};
use toile_core::StageError;

/// Side of a block, px: JPEG's own.
pub(super) const BLOCK: u32 = 8;
/// Blocks in a row of a sheet.
pub(super) const SHEET_BLOCKS: u32 = 64;
/// Blocks this near to the model are kept as well, px: reading between pixels reaches beyond its
/// outline.
const AROUND: u32 = 3;
/// How far colours are spread softly beyond the outline, px; farther out a row goes on as it is.
const SPREAD: u32 = 8;

/// First block and number of blocks of each row of blocks of a view; 0 and 0 of an empty row.
pub(super) fn spans(view: &RgbaImage) -> Vec<[u8; 2]> {
    let (w, h) = view.dimensions();
    let mut ends: Vec<Option<[u32; 2]>> = vec![None; h.div_ceil(BLOCK) as usize];
    for (x, y, _) in view.enumerate_pixels().filter(|(_, _, p)| p.0[3] > 0) {
        let (low, high) = (x.saturating_sub(AROUND) / BLOCK, (x + AROUND).min(w - 1) / BLOCK);
        for row in [y.saturating_sub(AROUND) / BLOCK, (y + AROUND).min(h - 1) / BLOCK] {
            let end = &mut ends[row as usize];
            *end = Some(end.map_or([low, high], |[a, b]| [a.min(low), b.max(high)]));
        }
    }
    ends.into_iter().map(|e| e.map_or([0, 0], |[a, b]| [a as u8, (b - a + 1) as u8])).collect()
}

/// The view with its colours carried on beyond the outline, in the blocks that are kept.
fn spread(view: &RgbaImage, spans: &[[u8; 2]]) -> RgbImage {
    let (w, h) = view.dimensions();
    let mut out = RgbImage::from_fn(w, h, |x, y| {
        let [r, g, b, _] = view.get_pixel(x, y).0;
        Rgb([r, g, b])
    });
    let at = |x: u32, y: u32| (y * w + x) as usize;
    let mut known: Vec<bool> = view.pixels().map(|p| p.0[3] > 0).collect();
    let near = |x: u32, y: u32| {
        let row = spans[(y / BLOCK) as usize].map(u32::from);
        (row[0]..row[0] + row[1]).contains(&(x / BLOCK))
    };
    let all = (0..h).flat_map(|y| (0..w).map(move |x| [x, y]));
    let mut border: Vec<[u32; 2]> = all.filter(|&[x, y]| !known[at(x, y)] && near(x, y)).collect();
    for _ in 0..SPREAD {
        let (mut found, mut open) = (Vec::new(), Vec::new());
        for [x, y] in border {
            let near = (y.saturating_sub(1)..=(y + 1).min(h - 1))
                .flat_map(|j| (x.saturating_sub(1)..=(x + 1).min(w - 1)).map(move |i| (i, j)))
                .filter(|&(i, j)| known[at(i, j)]);
            match mean(&out, near) {
                Some(colour) => found.push(([x, y], colour)),
                None => open.push([x, y]),
            }
        }
        for ([x, y], colour) in &found {
            out.put_pixel(*x, *y, *colour);
            known[at(*x, *y)] = true;
        }
        border = open;
    }
    for y in 0..h {
        let mut last = None;
        for x in 0..w {
            match (known[at(x, y)], last) {
                (true, _) => last = Some(*out.get_pixel(x, y)),
                (false, Some(colour)) => out.put_pixel(x, y, colour),
                (false, None) => {}
            }
        }
    }
    out
}

fn mean(picture: &RgbImage, places: impl Iterator<Item = (u32, u32)>) -> Option<Rgb<u8>> {
    let (mut sum, mut n) = ([0u32; 3], 0);
    for (x, y) in places {
        let Rgb(c) = picture.get_pixel(x, y);
        (0..3).for_each(|k| sum[k] += u32::from(c[k]));
        n += 1;
    }
    (n > 0).then(|| Rgb(sum.map(|s| (s / n) as u8)))
}

/// Views packed into one picture, without gaps.
pub(super) fn packed(views: &[&RgbaImage], spans: &[&[[u8; 2]]]) -> RgbImage {
    let count: u32 = spans.iter().flat_map(|s| s.iter()).map(|s| u32::from(s[1])).sum();
    let mut sheet = RgbImage::from_pixel(
        SHEET_BLOCKS * BLOCK,
        count.div_ceil(SHEET_BLOCKS).max(1) * BLOCK,
        Rgb([128; 3]),
    );
    let mut n = 0;
    for (view, spans) in views.iter().zip(spans) {
        let full = spread(view, spans);
        let (w, h) = full.dimensions();
        for (row, [first, blocks]) in spans.iter().enumerate() {
            for column in u32::from(*first)..u32::from(*first) + u32::from(*blocks) {
                let to = [n % SHEET_BLOCKS * BLOCK, n / SHEET_BLOCKS * BLOCK];
                for (x, y) in (0..BLOCK).flat_map(|y| (0..BLOCK).map(move |x| (x, y))) {
                    let from = [(column * BLOCK + x).min(w - 1), (row as u32 * BLOCK + y).min(h - 1)];
                    sheet.put_pixel(to[0] + x, to[1] + y, *full.get_pixel(from[0], from[1]));
                }
                n += 1;
            }
        }
    }
    sheet
}

/// A sheet as JPEG, colours at full resolution.
pub(super) fn jpeg<P>(sheet: &ImageBuffer<P, Vec<u8>>, quality: u8) -> Result<Vec<u8>, StageError>
where
    P: PixelWithColorType<Subpixel = u8>,
{
    let mut bytes = Vec::new();
    let fault = |e| StageError::internal(format!("a sheet of views cannot be encoded: {e}"));
    sheet.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, quality)).map_err(fault)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    /// 24 x 16 px, a dot of 2 x 1 px in the block at (1, 1).
    fn dot() -> RgbaImage {
        let mut view = RgbaImage::new(24, 16);
        view.put_pixel(12, 13, Rgba([200, 100, 50, 255]));
        view.put_pixel(13, 13, Rgba([100, 100, 50, 10]));
        view
    }

    #[test]
    fn only_blocks_near_the_model_are_kept() {
        assert_eq!(spans(&dot()), [[0, 0], [1, 2]], "a pixel 3 px beside the dot is in the next block");
        assert_eq!(spans(&RgbaImage::new(24, 16)), [[0, 0], [0, 0]]);
    }

    #[test]
    fn blocks_follow_each_other_and_colours_go_on_beyond_the_outline() {
        let (view, own) = (dot(), spans(&dot()));
        let sheet = packed(&[&view, &view], &[&own, &own]);
        assert_eq!(sheet.dimensions(), (512, 8));
        assert_eq!(*sheet.get_pixel(4, 5), Rgb([200, 100, 50]), "where the dot is, in its block");
        assert_eq!(
            *sheet.get_pixel(16 + 4, 5),
            Rgb([200, 100, 50]),
            "the second view after both blocks of the first"
        );
        assert_eq!(*sheet.get_pixel(3, 5), Rgb([200, 100, 50]), "beside it");
        assert_eq!(*sheet.get_pixel(40, 5), Rgb([128; 3]), "after the last block");
    }
}
