//! `Preview`: pictures of the model from front, back and side.
//!
//! See the renderer for method, cost and limits.

use crate::render::{Scene, View};
use image::ImageFormat;
use std::io::Cursor;
use toile_core::prelude::*;

/// Draws the model from the front, from behind and from the wearer's left.
///
/// Writes `front.png`, `back.png` and `side.png`, framed to the garment.
#[stage(
    role = Writer,
    source = "z-buffer: Catmull, 1974; shadows: Williams, 1978; mip-maps: Williams, 1983",
    example = "Preview(size: 900)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct Preview {
    /// Height of the pictures; their width is four fifths of it.
    #[param(default = 900, min = 16, max = 4096, unit = "px", trades)]
    size: u32,
}

#[stage]
impl Preview {
    pub(super) fn run(&self, model: &Model, cx: &Context) -> Result<OutputFiles, StageError> {
        super::check::check_model(model)?;
        let scene = Scene::new(model);
        let views = [
            ("front.png", View::front(self.size)),
            ("back.png", View::back(self.size)),
            ("side.png", View::side(self.size)),
        ];
        let mut files = Vec::new();
        for (i, (path, view)) in views.into_iter().enumerate() {
            cx.check()?;
            cx.progress(i as f64 / 3.0, path);
            let mut bytes = Cursor::new(Vec::new());
            let fault = |e| StageError::internal(format!("{path} cannot be encoded: {e}"));
            scene.render(&view).write_to(&mut bytes, ImageFormat::Png).map_err(fault)?;
            files.push(OutputFile { path: path.to_owned(), bytes: bytes.into_inner() });
        }
        Ok(OutputFiles(files))
    }
}
