//! What kind of picture a file is, by its first bytes.
//!
//! Kinds that are not read are named all the same: who is told that a photo "is a HEIC picture"
//! knows what to export.
//!
//! Source: the signatures of each format's specification; ISO/IEC 23008-12 for the brands of HEIC,
//! AVIF and CR3.

use super::tiff;

/// A kind of picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PictureFormat {
    /// JPEG.
    Jpeg,
    /// PNG.
    Png,
    /// WebP.
    WebP,
    /// TIFF.
    Tiff,
    /// One that is not read, in words: `a HEIC picture`.
    Other(&'static str),
}

/// Kinds that are not read: where their signature lies, the signature, their words.
const OTHERS: [(usize, &[u8], &str); 14] = [
    (0, b"GIF8", "a GIF picture"),
    (0, b"BM", "a BMP picture"),
    (0, b"8BPS", "a Photoshop file"),
    (0, b"%PDF", "a PDF document"),
    (0, b"<svg", "an SVG drawing"),
    (0, b"<?xml", "an SVG drawing"),
    (0, &[0xFF, 0x0A], "a JPEG XL picture"),
    (4, b"JXL \r\n\x87\n", "a JPEG XL picture"),
    (4, b"jP  \r\n\x87\n", "a JPEG 2000 picture"),
    (0, b"FUJIFILMCCD-RAW", RAW),
    (0, b"IIU\0", RAW),
    (0, b"IIRO", RAW),
    (0, b"IIRS", RAW),
    (0, b"MMOR", RAW),
];
const RAW: &str = "a camera's raw picture";

/// The kind of picture that bytes begin like; none where they begin like none.
pub(super) fn form(bytes: &[u8]) -> Option<PictureFormat> {
    match bytes {
        [0xFF, 0xD8, ..] => return Some(PictureFormat::Jpeg),
        [0x89, b'P', b'N', b'G', ..] => return Some(PictureFormat::Png),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => return Some(PictureFormat::WebP),
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => {
            return Some(if tiff::is_raw(bytes) { PictureFormat::Other(RAW) } else { PictureFormat::Tiff });
        }
        [_, _, _, _, b'f', b't', b'y', b'p', ..] => return brand(bytes).map(PictureFormat::Other),
        _ => {}
    }
    let begins = |(at, signature, _): &&(usize, &[u8], &str)| {
        bytes.get(*at..).is_some_and(|b| b.starts_with(signature))
    };
    OTHERS.iter().find(begins).map(|(_, _, words)| PictureFormat::Other(words))
}

/// What a file of the ISO base media format holds, by its major brand, else by those that it is
/// compatible with.
fn brand(bytes: &[u8]) -> Option<&'static str> {
    let length = bytes.get(..4).map_or(0, |b| b.iter().fold(0, |n, b| n << 8 | usize::from(*b)));
    let list = bytes.get(8..length.clamp(12, 256).min(bytes.len()))?;
    // The second is the version of the first.
    let brands = list.chunks_exact(4).enumerate().filter(|(i, _)| *i != 1).map(|(_, brand)| brand);
    let named = brands.filter_map(|brand| match brand {
        b"heic" | b"heix" | b"heim" | b"heis" | b"hevc" | b"hevx" | b"hevm" | b"hevs" => {
            Some("a HEIC picture")
        }
        b"avif" | b"avis" => Some("an AVIF picture"),
        b"crx " => Some(RAW),
        _ => None,
    });
    let general = list.starts_with(b"mif1") || list.starts_with(b"msf1");
    named.into_iter().next().or(general.then_some("a HEIC picture")).or(Some("a film"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_told_by_their_first_bytes() {
        let cases: [(&[u8], Option<PictureFormat>); 12] = [
            (b"\xFF\xD8\xFF\xE0", Some(PictureFormat::Jpeg)),
            (b"\x89PNG\r\n\x1A\n", Some(PictureFormat::Png)),
            (b"RIFF\x10\0\0\0WEBPVP8 ", Some(PictureFormat::WebP)),
            (b"RIFF\x10\0\0\0WAVEfmt ", None),
            (b"MM\0*\0\0\0\x08", Some(PictureFormat::Tiff)),
            (b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", Some(PictureFormat::Other("a HEIC picture"))),
            (b"\0\0\0\x1Cftypmif1\0\0\0\0mif1avifmiaf", Some(PictureFormat::Other("an AVIF picture"))),
            (b"\0\0\0\x18ftypmif1\0\0\0\0mif1miaf", Some(PictureFormat::Other("a HEIC picture"))),
            (b"\0\0\0\x18ftypisom\0\0\x02\0isomiso2", Some(PictureFormat::Other("a film"))),
            (b"GIF89a", Some(PictureFormat::Other("a GIF picture"))),
            (b"a recipe for soup", None),
            (b"", None),
        ];
        for (bytes, expected) in cases {
            assert_eq!(form(bytes), expected, "{bytes:?}");
        }
    }
}
