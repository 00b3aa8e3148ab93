//! Size and completeness of a JPEG or PNG file, read from its structure alone.
//!
//! Decoders are lenient: a JPEG that was cut short comes back with its lower part grey, and a
//! header that claims 60,000 x 60,000 px makes them reserve memory first. So the structure is walked
//! before anything is decoded (ITU-T T.81 annex B for JPEG; ISO/IEC 15948 for PNG).
//!
//! Cost: one pass over the bytes, about 1 ms a megabyte. Limits: markers after a JPEG's end of
//! image (thumbnails, videos of phones) are not looked at.

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

/// The header of a JPEG or PNG; `None` where the bytes are neither, or end before the size.
pub(super) fn read(bytes: &[u8]) -> Option<Header> {
    match bytes {
        [0xFF, 0xD8, ..] => jpeg(bytes),
        [0x89, b'P', b'N', b'G', ..] => png(bytes),
        _ => None,
    }
}

/// True where the bytes begin like a JPEG or PNG.
pub(super) fn is_known(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xFF, 0xD8]) || bytes.starts_with(&[0x89, b'P', b'N', b'G'])
}

fn be(bytes: &[u8], at: usize, count: usize) -> Option<u64> {
    let slice = bytes.get(at..at.checked_add(count)?)?;
    Some(slice.iter().fold(0, |n, &b| n << 8 | u64::from(b)))
}

fn png(bytes: &[u8]) -> Option<Header> {
    let (width, height) = (be(bytes, 16, 4)?, be(bytes, 20, 4)?);
    Some(Header { width, height, complete: png_is_complete(bytes) })
}

/// Walks the chunks to `IEND`.
fn png_is_complete(bytes: &[u8]) -> bool {
    let mut at = 8;
    while let (Some(length), Some(kind)) = (be(bytes, at, 4), bytes.get(at + 4..at + 8)) {
        if kind == b"IEND" {
            return true;
        }
        at += 12 + length as usize;
    }
    false
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
