//! What is known of a photo besides its pixels.

/// What is known besides the photo.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ScaleOptions {
    /// Focal length on 35 mm film, mm, 8 to 400 (EXIF `FocalLengthIn35mmFilm`); `None` for a
    /// phone's main lens.
    pub focal_35mm: Option<f64>,
}
