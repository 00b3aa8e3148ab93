//! A small picture of a garment, for the contact sheet: of a preview that its run gave, else of a
//! photo that it was made from.

use image::codecs::jpeg::JpegEncoder;
use image::{DynamicImage, ImageReader, Limits};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use toile_core::artifact::OutputFile;

/// The picture's file in a garment's folder.
pub(crate) const FILE: &str = "thumb.jpg";
/// The longest side, pixels.
const SIDE: u32 = 240;
/// How much of JPEG's quality is kept, of 100.
const QUALITY: u8 = 80;
/// The names that are taken first.
const FIRST: [&str; 2] = ["front.png", "sheet.jpg"];
/// The longest side of a picture that is made small, pixels.
const LARGEST: u32 = 20_000;

/// The small picture; none where there is nothing to show.
pub(crate) fn of(folder: &Path, photos: &[PathBuf]) -> Option<OutputFile> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut made: Vec<PathBuf> = entries.map(|e| e.path()).filter(|p| is_picture(p)).collect();
    made.sort_by_key(|path| {
        let rank = FIRST.iter().position(|name| path.ends_with(name)).unwrap_or(FIRST.len());
        (rank, path.clone())
    });
    made.iter().chain(photos.iter().filter(|p| is_picture(p))).find_map(|path| small(path))
}

fn is_picture(path: &Path) -> bool {
    let ending = path.extension().map_or_else(String::new, |e| e.to_string_lossy().to_ascii_lowercase());
    ["png", "jpg", "jpeg"].contains(&ending.as_str())
}

fn small(path: &Path) -> Option<OutputFile> {
    let bytes = toile_core::read_file(path).ok()?;
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok()?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LARGEST), Some(LARGEST));
    reader.limits(limits);
    let picture = on_white(&reader.decode().ok()?.thumbnail(SIDE, SIDE));
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, QUALITY).encode_image(&picture).ok()?;
    Some(OutputFile::new(FILE, jpeg))
}

/// A picture without what may be seen through.
fn on_white(picture: &DynamicImage) -> DynamicImage {
    let mut rgba = picture.to_rgba8();
    for pixel in rgba.pixels_mut() {
        let alpha = u32::from(pixel[3]);
        for channel in 0..3 {
            let mixed = (u32::from(pixel[channel]) * alpha + 255 * (255 - alpha)) / 255;
            pixel[channel] = u8::try_from(mixed).unwrap_or(u8::MAX);
        }
        pixel[3] = u8::MAX;
    }
    DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(rgba).to_rgb8())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use image::{Rgba, RgbaImage};

    #[test]
    fn a_preview_comes_before_a_photo_and_what_is_clear_is_white() {
        let dir = tempfile::tempdir().unwrap();
        let save = |name: &str, colour: [u8; 4]| {
            RgbaImage::from_pixel(480, 240, Rgba(colour)).save(dir.path().join(name)).unwrap();
        };
        let photo = dir.path().join("in/photo.png");
        std::fs::create_dir(dir.path().join("in")).unwrap();
        save("in/photo.png", [200, 0, 0, 255]);
        let shown = || {
            let file = of(dir.path(), std::slice::from_ref(&photo)).unwrap();
            let picture = image::load_from_memory(&file.bytes).unwrap().to_rgb8();
            assert_eq!((file.path.as_str(), picture.dimensions()), (FILE, (240, 120)));
            picture.get_pixel(100, 60).0.map(|c| c > 100)
        };
        assert_eq!(shown(), [true, false, false], "the photo");
        save("back.png", [0, 200, 0, 255]);
        assert_eq!(shown(), [false, true, false], "the preview");
        save("front.png", [0, 0, 0, 0]);
        assert_eq!(shown(), [true, true, true], "that of the front");
        assert!(of(&dir.path().join("none"), &[dir.path().join("in")]).is_none());
    }
}
