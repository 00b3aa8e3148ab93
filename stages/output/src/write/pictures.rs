//! `Pictures`: photos as picture files.

use crate::file_names::check_name;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbaImage};
use toile_core::prelude::*;

/// How a picture is stored.
#[choice]
#[derive(Copy, Eq)]
pub enum PictureFile {
    /// Every bit, and transparency; a large file.
    Png,
    /// Small, with a loss that is not seen at a quality of 90.
    Jpeg,
}

/// Writes photos as they are at this place of the pipeline, each under its name: a panorama as
/// `panorama.png`, a view between views as `view.png`, `front.png` after a denoiser.
///
/// JPEG has no transparency: what is transparent is black.
#[stage(
    role = Writer,
    source = "ISO/IEC 15948, 2004; ITU-T T.81, 1992",
    example = "Pictures(form: Jpeg)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Pictures {
    /// The kind of file.
    #[param(default = PictureFile::Png)]
    form: PictureFile,
    /// Quality of JPEG files; PNG has none.
    #[param(default = 90, min = 30, max = 100)]
    quality: u8,
}

#[stage]
impl Pictures {
    pub(super) fn run(&self, photos: Set<Photo>, cx: &Context) -> Result<OutputFiles, StageError> {
        let mut files = Vec::new();
        for (name, photo) in photos.iter() {
            cx.check()?;
            check_name(name)?;
            let (w, h) = photo.pixels.dimensions();
            if w == 0 || h == 0 {
                let text = format!("photo \"{name}\" has no pixels ({w} x {h})");
                return Err(StageError::invalid(text).hint("give a photo that shows something"));
            }
            files.push(self.file(name, photo)?);
        }
        if files.is_empty() {
            return Err(StageError::invalid("there are no photos").hint("add `photos` to the pipeline"));
        }
        Ok(OutputFiles(files))
    }
}

impl Pictures {
    fn file(&self, name: &str, photo: &Photo) -> Result<OutputFile, StageError> {
        let mut bytes = Vec::new();
        let pixels = photo.pixels.as_ref();
        let (w, h) = pixels.dimensions();
        let (path, done) = match (self.form, &photo.alpha) {
            (PictureFile::Jpeg, _) => (
                format!("{name}.jpg"),
                JpegEncoder::new_with_quality(&mut bytes, self.quality).encode_image(pixels),
            ),
            (PictureFile::Png, Some(alpha)) => {
                let mut both = RgbaImage::new(w, h);
                for ((to, p), a) in both.pixels_mut().zip(pixels.pixels()).zip(alpha.pixels()) {
                    to.0 = [p.0[0], p.0[1], p.0[2], a.0[0]];
                }
                let encoder = PngEncoder::new(&mut bytes);
                (format!("{name}.png"), encoder.write_image(both.as_raw(), w, h, ExtendedColorType::Rgba8))
            }
            (PictureFile::Png, None) => {
                let encoder = PngEncoder::new(&mut bytes);
                (format!("{name}.png"), encoder.write_image(pixels.as_raw(), w, h, ExtendedColorType::Rgb8))
            }
        };
        done.map_err(|e| StageError::internal(format!("{path} cannot be encoded: {e}")))?;
        Ok(OutputFile::new(path, bytes))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use image::{GrayImage, Rgb, RgbImage, Rgba};

    toile_core::contracts!(Pictures);

    fn written(text: &str, photo: Photo) -> (String, image::DynamicImage) {
        let stage: Pictures = toile_core::param::ron_options().from_str(text).unwrap();
        let set: Set<Photo> = [("front".to_owned(), photo)].into_iter().collect();
        let file = stage.run(set, &Context::quiet()).unwrap().0.remove(0);
        (file.path, image::load_from_memory(&file.bytes).unwrap())
    }

    #[test]
    fn a_photo_is_written_under_its_name() {
        let pixels = RgbImage::from_fn(9, 5, |x, y| Rgb([20 * x as u8, 30 * y as u8, 90]));
        let photo = toile_core::testkit::photo().with_pixels(pixels.clone());
        let (path, read) = written("()", photo.clone());
        assert_eq!((path.as_str(), read.to_rgb8()), ("front.png", pixels));
        let (path, read) = written("(form: Jpeg)", photo.clone());
        assert_eq!((path.as_str(), read.width()), ("front.jpg", 9));
        let alpha = Shared::new(GrayImage::from_fn(9, 5, |x, _| image::Luma([28 * x as u8])));
        let (_, read) = written("()", Photo { alpha: Some(alpha), ..photo });
        assert_eq!(*read.to_rgba8().get_pixel(3, 2), Rgba([60, 60, 90, 84]));
    }

    #[test]
    fn what_cannot_be_written_is_refused() {
        let stage = Pictures::default();
        let none: Set<Photo> = [].into_iter().collect();
        assert_eq!(stage.run(none, &Context::quiet()).unwrap_err().to_string(), "there are no photos");
        let named: Set<Photo> = [("a/b".to_owned(), toile_core::testkit::photo())].into_iter().collect();
        let error = stage.run(named, &Context::quiet()).unwrap_err().to_string();
        assert_eq!(
            error,
            "the file name \"a/b\" has a character other than letters, digits, space, '-', '_' and '.'"
        );
    }
}
