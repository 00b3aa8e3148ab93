//! Size and completeness of a picture, read from its file's structure alone.
//!
//! Decoders are lenient: a JPEG that was cut short comes back with its lower part grey, and a
//! header that claims 60,000 x 60,000 px makes them reserve memory first. So the structure is
//! walked before anything is decoded (ITU-T T.81 annex B for JPEG; ISO/IEC 15948 for PNG; RFC 9649
//! for WebP; `tiff`).
//!
//! A PNG may hold texts and a colour profile, packed. Nothing here uses them, and unpacked they may
//! be a thousand times as large as the file, so they are left out before a decoder sees them.
//!
//! Cost: one pass over the bytes, about 1 ms a megabyte. Limits: markers after a JPEG's end of
//! image (thumbnails, videos of phones) are not looked at.

use super::form::PictureFormat;
use super::tiff::Directory;
use std::borrow::Cow;

/// What a file's structure tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    /// Pixels across, as stored (before any turning).
    pub width: u64,
    /// Pixels down.
    pub height: u64,
    /// False where the file ends before its picture does.
    pub complete: bool,
}

/// The header of a picture of a kind that is read; `None` where the bytes are of another, or end
/// before the size.
pub(super) fn read(form: PictureFormat, bytes: &[u8]) -> Option<Header> {
    match form {
        PictureFormat::Jpeg => jpeg(bytes),
        PictureFormat::Png => png(bytes),
        PictureFormat::WebP => webp(bytes),
        PictureFormat::Tiff => {
            let directory = Directory::read(bytes)?;
            let (width, height) = directory.size()?;
            Some(Header { width, height, complete: directory.is_complete() })
        }
        PictureFormat::Other(_) => None,
    }
}

/// The bytes without what is packed in them and not used.
pub(super) fn without_extras(form: PictureFormat, bytes: &[u8]) -> Cow<'_, [u8]> {
    let is_extra = |kind: &[u8]| matches!(kind, b"iCCP" | b"zTXt" | b"iTXt" | b"tEXt");
    if form != PictureFormat::Png || !chunks(bytes).any(|(kind, _)| is_extra(kind)) {
        return Cow::Borrowed(bytes);
    }
    let signature = bytes.get(..8).unwrap_or(bytes).to_vec();
    let kept = chunks(bytes).filter(|(kind, _)| !is_extra(kind));
    Cow::Owned(kept.fold(signature, |mut all, (_, chunk)| {
        all.extend_from_slice(chunk);
        all
    }))
}

fn be(bytes: &[u8], at: usize, count: usize) -> Option<u64> {
    let slice = bytes.get(at..at.checked_add(count)?)?;
    Some(slice.iter().fold(0, |n, &b| n << 8 | u64::from(b)))
}

fn png(bytes: &[u8]) -> Option<Header> {
    let (width, height) = (be(bytes, 16, 4)?, be(bytes, 20, 4)?);
    Some(Header { width, height, complete: png_is_complete(bytes) })
}

fn png_is_complete(bytes: &[u8]) -> bool {
    chunks(bytes).any(|(kind, _)| kind == b"IEND")
}

/// The chunks of a PNG up to `IEND`, each with its kind; the last may be cut short.
fn chunks(bytes: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    let mut at = Some(8);
    std::iter::from_fn(move || {
        let from = at?;
        let (length, kind) = (be(bytes, from, 4)?, bytes.get(from + 4..from + 8)?);
        let to = from + 12 + length as usize;
        at = (kind != b"IEND").then_some(to);
        Some((kind, &bytes[from..to.min(bytes.len())]))
    })
}

/// A WebP is a RIFF file: a first chunk that tells the size, and others. All must lie in the file,
/// which says how long it is.
fn webp(bytes: &[u8]) -> Option<Header> {
    let le = |at: usize, count: usize| {
        let slice = bytes.get(at..at.checked_add(count)?)?;
        Some(slice.iter().rev().fold(0, |n, &b| n << 8 | u64::from(b)))
    };
    let (width, height) = match bytes.get(12..16)? {
        b"VP8 " => (le(26, 2)? & 0x3FFF, le(28, 2)? & 0x3FFF),
        b"VP8L" => {
            let both = le(21, 4)?;
            ((both & 0x3FFF) + 1, (both >> 14 & 0x3FFF) + 1)
        }
        b"VP8X" => (le(24, 3)? + 1, le(27, 3)? + 1),
        _ => return None,
    };
    let end = 8 + le(4, 4)?;
    let mut at = 12;
    while at + 8 <= end {
        let length = le(at as usize + 4, 4)?;
        at += 8 + length + length % 2;
    }
    // The last byte fills up to an even number, and some writers leave it out.
    let complete = at.max(end) <= bytes.len() as u64 + 1;
    Some(Header { width, height, complete })
}

fn jpeg(bytes: &[u8]) -> Option<Header> {
    let mut size = None;
    let mut at = 2;
    let complete = loop {
        let Some(marker) = next_marker(bytes, &mut at) else { break false };
        match marker {
            END_OF_IMAGE => break true,
            0x01 | 0xD0..=0xD7 => continue,
            _ => {}
        }
        let Some(length) = be(bytes, at, 2) else { break false };
        if is_frame(marker) {
            size = be(bytes, at + 5, 2).zip(be(bytes, at + 3, 2));
        }
        at += length.max(2) as usize;
        // Entropy-coded data follow a scan header; `next_marker` skips them, as their 0xFF bytes
        // are stuffed.
    };
    size.map(|(width, height)| Header { width, height, complete })
}

const END_OF_IMAGE: u8 = 0xD9;

/// Start of frame, but not the Huffman, extension and arithmetic tables that share its range.
fn is_frame(marker: u8) -> bool {
    matches!(marker, 0xC0..=0xCF) && !matches!(marker, 0xC4 | 0xC8 | 0xCC)
}

/// The next marker at or after `at`, which moves behind it.
fn next_marker(bytes: &[u8], at: &mut usize) -> Option<u8> {
    loop {
        let rest = bytes.get(*at..)?;
        *at += rest.iter().position(|&b| b == 0xFF)? + 1;
        match *bytes.get(*at)? {
            // Stuffed data byte, or fill bytes before a marker.
            0x00 | 0xFF => {}
            marker => {
                *at += 1;
                return Some(marker);
            }
        }
    }
}
