//! `Usdz`: the model as USDZ, a scene of Universal Scene Description with its textures in one
//! archive (Pixar, 2018).
//!
//! The scene is written as text (USDA), the surfaces as `UsdPreviewSurface`. Cost: the encoding of
//! the textures and some 60 bytes of text a vertex. Limits: 4 GiB; `UsdPreviewSurface` has no
//! sheen, and *replace* becomes light of the surface's own.

mod materials;
mod scene;
#[cfg(test)]
mod tests;
pub(in crate::write) mod text;
pub(in crate::write) mod zip;

use super::check::check_model;
use super::copyright::check_copyright;
use super::glb::digest;
use super::shown::shown;
use super::sides::with_wrong_sides;
use super::texture_file::TextureFormat;
use crate::file_names::{check_name, plain_names};
use scene::{About, scene};
use toile_core::prelude::*;

/// Writes the model as one USDZ file, which phones and USD programs open.
///
/// Metres, Y up, the wearer faces +Z. The scene and its textures lie in an archive without
/// compression; normal maps and variants are kept.
#[stage(
    role = Writer,
    source = "Pixar, Usdz file format specification, 2018",
    example = "Usdz(name: \"garment\", textures: Jpeg, quality: 88)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Usdz {
    /// The file's name without its extension.
    #[param(default = "garment".to_owned())]
    name: String,
    /// How textures are stored.
    #[param(default = TextureFormat::Jpeg)]
    textures: TextureFormat,
    /// Quality of JPEG textures.
    #[param(default = 88, min = 1, max = 100, trades)]
    quality: u8,
    /// Whether the body is written, where the model has one.
    #[param(default = true)]
    body: bool,
    /// Who holds the rights to the file: `copyright` in the data of its layer.
    #[param(default = None)]
    copyright: Option<String>,
}

#[stage]
impl Usdz {
    pub(super) fn run(&self, model: &Model, _cx: &Context) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        check_copyright(self.copyright.as_deref())?;
        check_model(model)?;
        let about = About { copyright: self.copyright.as_deref(), digest: digest(model) };
        let mut model = shown(model, self.body)?;
        with_wrong_sides(&mut model);
        let images = self.textures.encode_all(&model, self.quality)?;
        let names = plain_names(model.textures.iter().map(|t| t.name.as_str()));
        let path = |name: &String| format!("textures/{name}.{}", self.textures.extension());
        let paths: Vec<String> = names.iter().map(path).collect();
        // The first file is the scene that is opened.
        let mut files = vec![("scene.usda".to_owned(), scene(&model, &paths, &about).into_bytes())];
        files.extend(paths.into_iter().zip(images));
        Ok(OutputFiles::one(&format!("{}.usdz", self.name), zip::stored(&files)?))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        let name = check_name(&self.name).err();
        name.into_iter().chain(check_copyright(self.copyright.as_deref()).err()).collect()
    }
}
