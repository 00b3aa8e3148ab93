//! `Preview`: pictures of the model from front, back and side.
//!
//! See the renderer for method, cost and limits.

use crate::render::{Frame, Scene, View};
use image::{ImageFormat, RgbImage};
use rayon::prelude::*;
use std::io::Cursor;
use toile_core::prelude::*;

/// What of the model fills the pictures.
#[choice]
#[derive(Copy, Eq)]
pub enum Framing {
    /// The garment; the body runs out of the picture.
    Garment,
    /// Garment and body, head to feet.
    Whole,
}

/// Draws the model from the front, from behind and from the wearer's left.
///
/// Writes `front.png`, `back.png` and `side.png`.
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
    /// What fills the pictures.
    #[param(default = Framing::Garment)]
    frame: Framing,
}

impl Preview {
    /// Whether the garment fills its pictures, which are at least so high, px.
    pub(super) fn is_of_garment(&self, height: u32) -> bool {
        self.frame == Framing::Garment && self.size >= height
    }
}

#[stage]
impl Preview {
    pub(super) fn run(&self, model: &Model, cx: &Context) -> Result<OutputFiles, StageError> {
        super::check::check_model(model)?;
        let scene = Scene::new_in(model, cx);
        let frame = match self.frame {
            Framing::Garment => Frame::Garment,
            Framing::Whole => Frame::Whole,
        };
        let views = [
            ("front.png", View::front as fn(u32) -> View),
            ("back.png", View::back),
            ("side.png", View::side),
        ];
        let mut pictures = Vec::new();
        for (i, (path, view)) in views.into_iter().enumerate() {
            // One after the other, each on all threads: so a stop waits for one view at most.
            cx.check()?;
            cx.progress(i as f64 / 3.0, path);
            pictures.push((path, scene.render(&View { frame, ..view(self.size) })));
        }
        let files: Vec<Result<OutputFile, StageError>> = pictures.par_iter().map(file).collect();
        Ok(OutputFiles(files.into_iter().collect::<Result<_, _>>()?))
    }
}

fn file((path, picture): &(&str, RgbImage)) -> Result<OutputFile, StageError> {
    let mut bytes = Cursor::new(Vec::new());
    let fault = |e| StageError::internal(format!("{path} cannot be encoded: {e}"));
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(fault)?;
    Ok(OutputFile::new(*path, bytes.into_inner()))
}
