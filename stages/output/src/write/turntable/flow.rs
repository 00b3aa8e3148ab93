//! The flow between neighbouring views, for a page that interpolates without depth.
//!
//! Each view has up to four neighbours: around on either side, above and below. What the page holds
//! is set down in `docs/reference/turntable.md`. Cost: a field of blocks for each view and
//! neighbour.

use super::{numbers, sheet};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{GrayImage, Rgba, RgbaImage};
use rayon::prelude::*;
use serde_json::{Value, json};
use toile_core::{Context, StageError};
use toile_views::flow::{BLOCK, PARTS, Pyramid, Vector, motion};

/// Quality of the sheets that hold the coverage: what JPEG leaves beside an outline is cut off by
/// the page.
const COVER_QUALITY: u8 = 30;
/// Blocks of a sheet along a block of the flow.
const PER_BLOCK: usize = BLOCK / sheet::BLOCK as usize;

/// The flow of every view to its neighbours.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn flow(
    views: &[RgbaImage],
    spans: &[Vec<[u8; 2]>],
    around: usize,
    cx: &Context,
) -> Result<Value, StageError> {
    let of = |k: usize| {
        let (own, mut bytes) = (Pyramid::of(&views[k]), Vec::new());
        for other in neighbours(k, around, views.len()).into_iter().flatten() {
            cx.check()?;
            let field = motion(&own, &Pyramid::of(&views[other]), cx)?;
            let columns = field.columns;
            encode(&field.whole(), columns, &spans[k], &mut bytes);
        }
        Ok(bytes)
    };
    let bytes: Vec<Vec<u8>> = (0..views.len()).into_par_iter().map(of).collect::<Result<_, StageError>>()?;
    Ok(json!({
        "block": BLOCK,
        "parts": PARTS,
        "vectors": STANDARD.encode(bytes.concat()),
    }))
}

/// The views to the right, to the left, above and below, where there are any.
fn neighbours(view: usize, around: usize, count: usize) -> [Option<usize>; 4] {
    let (tier, v) = (view / around * around, view % around);
    [
        Some(tier + (v + 1) % around),
        Some(tier + (v + around - 1) % around),
        Some(view + around).filter(|n| *n < count),
        view.checked_sub(around),
    ]
}

/// The vectors of the blocks that are in the sheets, each as its difference to the one before.
fn encode(vectors: &[Vector], columns: usize, spans: &[[u8; 2]], bytes: &mut Vec<u8>) {
    let mut last = [0, 0];
    for (k, v) in vectors.iter().enumerate() {
        if is_kept(k % columns, k / columns, spans) {
            (0..2).for_each(|c| numbers::push(bytes, i64::from(v[c]) - i64::from(last[c])));
            last = *v;
        }
    }
}

/// Whether a block of the flow holds a block of the sheets.
fn is_kept(column: usize, row: usize, spans: &[[u8; 2]]) -> bool {
    let rows = row * PER_BLOCK..((row + 1) * PER_BLOCK).min(spans.len());
    let (first, end) = (column * PER_BLOCK, (column + 1) * PER_BLOCK);
    spans[rows].iter().any(|[a, n]| usize::from(*a) < end && usize::from(*a) + usize::from(*n) > first)
}

/// The coverage of the views of one sheet as a grey JPEG, laid out as their colours are.
///
/// # Errors
/// When it cannot be encoded.
pub(super) fn cover(views: &[&RgbaImage], spans: &[&[[u8; 2]]]) -> Result<String, StageError> {
    let grey = |v: &&RgbaImage| {
        let (w, h) = v.dimensions();
        RgbaImage::from_fn(w, h, |x, y| {
            let a = v.get_pixel(x, y).0[3];
            Rgba([a, a, a, 255])
        })
    };
    let covers: Vec<RgbaImage> = views.iter().map(grey).collect();
    let packed = sheet::packed(&covers.iter().collect::<Vec<_>>(), spans);
    let one = GrayImage::from_fn(packed.width(), packed.height(), |x, y| {
        image::Luma([packed.get_pixel(x, y).0[0]])
    });
    Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(sheet::jpeg(&one, COVER_QUALITY)?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_have_neighbours_all_around_and_within_the_tiers() {
        assert_eq!(neighbours(0, 4, 8), [Some(1), Some(3), Some(4), None]);
        assert_eq!(neighbours(7, 4, 8), [Some(4), Some(6), None, Some(3)]);
        assert_eq!(neighbours(2, 4, 4), [Some(3), Some(1), None, None]);
    }

    #[test]
    fn only_blocks_of_the_sheets_have_vectors() {
        // Two rows of sheet blocks per block: the second holds sheet block 3, so the second block
        // is kept.
        let mut bytes = Vec::new();
        encode(&[[9, 9], [3, -1], [9, 9], [4, 0], [4, 0], [4, 0]], 3, &[[0, 0], [3, 1], [0, 6]], &mut bytes);
        assert_eq!(bytes, [6, 1, 2, 2, 0, 0, 0, 0]);
    }
}
