//! How much a set of photos is, before they are decoded.

use super::decode::upright_size;
use super::resolve::resolve;
use super::{PhotoEntry, PhotoFile};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use toile_core::cost::{Quantity, Size, garment_area};
use toile_core::{Context, Length};

/// Pixels of the photos and of the files, bytes of the files, and a guess at the garment's area;
/// none where a photo cannot be read.
///
/// Cost: the files are read, not decoded.
pub(super) fn size(entries: &BTreeMap<String, PhotoEntry>, cx: &Context) -> Option<Size> {
    let mut files: BTreeMap<&str, (usize, (u32, u32))> = BTreeMap::new();
    let (mut pixels, mut area) = (0.0, 0.0);
    for name in entries.keys() {
        let (photo, _) = resolve(entries, name).ok()?;
        let (_, (w, h)) = match files.entry(&photo.file) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                let bytes = cx.read(&photo.file).ok()?;
                *new.insert((bytes.len(), upright_size(&bytes)?))
            }
        };
        let (w, h) = (f64::from(w), f64::from(h));
        pixels += w * h;
        area += garment_area(w, h, width(photo, w));
    }
    let bytes: usize = files.values().map(|(bytes, _)| bytes).sum();
    let decoded: f64 = files.values().map(|(_, (w, h))| f64::from(*w) * f64::from(*h)).sum();
    let size = Size::new().with(Quantity::Pieces, entries.len() as f64);
    let size = size.with(Quantity::Pixels, pixels).with(Quantity::Bytes, bytes as f64);
    Some(size.with(Quantity::Decoded, decoded).with(Quantity::Area, area))
}

/// The garment's width, metres; that of the frame where only the scale is known.
pub(super) fn width(photo: &PhotoFile, width_px: f64) -> f64 {
    let by_scale = photo.px_per_metre.map(|scale| width_px / scale);
    photo.width.map(Length::metres).or(by_scale).unwrap_or(0.0)
}
