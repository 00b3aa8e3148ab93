//! Textures as PNG or JPEG.

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use rayon::prelude::*;
use toile_core::artifact::{Model, Texture};
use toile_core::{StageError, choice};

/// How textures are stored.
#[choice]
#[derive(Copy, Eq)]
pub enum TextureFormat {
    /// Small, with a loss that the eye does not see.
    Jpeg,
    /// Exact, several times as large.
    Png,
}

impl TextureFormat {
    /// `jpg`, `png`.
    pub(super) fn extension(self) -> &'static str {
        match self {
            TextureFormat::Jpeg => "jpg",
            TextureFormat::Png => "png",
        }
    }

    /// `image/jpeg`, `image/png`.
    pub(super) fn mime(self) -> &'static str {
        match self {
            TextureFormat::Jpeg => "image/jpeg",
            TextureFormat::Png => "image/png",
        }
    }

    /// All textures of a model, in order.
    pub(super) fn encode_all(self, model: &Model, quality: u8) -> Result<Vec<Vec<u8>>, StageError> {
        model.textures.par_iter().map(|t| self.encode(t, quality)).collect()
    }

    fn encode(self, texture: &Texture, quality: u8) -> Result<Vec<u8>, StageError> {
        let mut bytes = Vec::new();
        let pixels = &texture.pixels;
        let done = match self {
            TextureFormat::Jpeg => {
                pixels.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, quality))
            }
            TextureFormat::Png => pixels.write_with_encoder(PngEncoder::new_with_quality(
                &mut bytes,
                CompressionType::Fast,
                FilterType::Adaptive,
            )),
        };
        let fault = |e| StageError::invalid(format!("texture \"{}\" cannot be stored: {e}", texture.name));
        done.map(|()| bytes).map_err(fault)
    }
}
