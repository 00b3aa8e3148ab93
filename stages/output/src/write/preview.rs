//! `Preview`: pictures of the model from front, back and side, and a sheet of them beside the
//! photo.
//!
//! See the renderer for method, cost and limits.

use crate::render::{Frame, ModelScene, PictureForm, View, jpeg, thumbnail};
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
/// Writes `front.png`, `back.png` and `side.png`, on request pictures from other sides
/// (`turn_060.png`), and `sheet.jpg`: the photo, front, back, left side and three-quarter view in
/// one row.
#[stage(
    role = Writer,
    version = 2,
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
    /// Sides from which further pictures are drawn: 0 is the wearer's front, 90 the wearer's left.
    #[param(default = Vec::new(), min = 0, max = 359, unit = "deg")]
    turns: Vec<u32>,
    /// Height of `sheet.jpg`; none is written where it is not given.
    #[param(default = None, min = 64, max = 2048)]
    sheet: Option<u32>,
}

impl Preview {
    /// Whether the garment fills its pictures, which are at least so high, px.
    pub(super) fn is_of_garment(&self, height: u32) -> bool {
        self.frame == Framing::Garment && self.size >= height
    }

    /// A side that is named twice would be written twice.
    fn fault(&self) -> Option<StageError> {
        let twice = self.turns.iter().enumerate().find(|(i, t)| self.turns[..*i].contains(t))?.1;
        let e = StageError::new(ErrorCode::InvalidParameter, format!("`turns` has {twice} twice"));
        Some(e.at("turns").hint("take one of them out"))
    }
}

#[stage]
impl Preview {
    pub(super) fn run(
        &self,
        model: &Model,
        #[original] photos: Option<Set<Photo>>,
        cx: &Context,
    ) -> Result<OutputFiles, StageError> {
        super::check::check_model(model)?;
        self.fault().map_or(Ok(()), Err)?;
        let scene = ModelScene::draft_in(model, cx)?;
        let frame = match self.frame {
            Framing::Garment => Frame::Garment,
            Framing::Whole => Frame::Whole,
        };
        let own = [
            ("front.png", View::front as fn(u32) -> View),
            ("back.png", View::back),
            ("side.png", View::side),
        ];
        let turned = |turn: &u32| {
            (format!("turn_{turn:03}.png"), View::turned(f64::from(*turn).to_radians(), self.size))
        };
        let views: Vec<(String, View)> = own
            .into_iter()
            .map(|(path, view)| (path.to_owned(), view(self.size)))
            .chain(self.turns.iter().map(turned))
            .collect();
        let drawn = |(path, view): (String, View)| {
            let picture = scene.render(&View { frame, ..view });
            // What is made after a stop is unfinished.
            cx.check()?;
            file(&path, &picture)
        };
        let mut files: Vec<OutputFile> =
            views.into_par_iter().map(drawn).collect::<Result<_, StageError>>()?;
        if let Some(height) = self.sheet {
            let mut row: Vec<RgbImage> =
                photo_of(photos.as_ref()).map(|p| thumbnail(&p.pixels, height)).into_iter().collect();
            for view in [View::front, View::back, View::side, View::three_quarter] {
                cx.check()?;
                row.push(scene.render(&View { frame, ..view(height) }));
            }
            cx.check()?;
            let Some(PictureForm::Jpeg(bytes)) = jpeg(&beside(&row)) else {
                return Err(StageError::internal("sheet.jpg cannot be encoded"));
            };
            files.push(OutputFile::new("sheet.jpg", bytes));
        }
        Ok(OutputFiles(files))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.fault().into_iter().collect()
    }
}

/// The photo of a sheet: that of the front, or the first one.
fn photo_of(photos: Option<&Set<Photo>>) -> Option<&Photo> {
    let photos = photos?;
    photos.get("front").or_else(|| photos.0.values().next().map(AsRef::as_ref))
}

/// Pictures from left to right, upper edges in line, on white.
fn beside(row: &[RgbImage]) -> RgbImage {
    let height = row.iter().map(RgbImage::height).max().unwrap_or(1);
    let width = row.iter().map(RgbImage::width).sum::<u32>().max(1);
    let mut sheet = RgbImage::from_pixel(width, height, image::Rgb([255; 3]));
    let mut x = 0;
    for picture in row {
        image::imageops::replace(&mut sheet, picture, i64::from(x), 0);
        x += picture.width();
    }
    sheet
}

fn file(path: &str, picture: &RgbImage) -> Result<OutputFile, StageError> {
    let mut bytes = Cursor::new(Vec::new());
    let fault = |e| StageError::internal(format!("{path} cannot be encoded: {e}"));
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(fault)?;
    Ok(OutputFile::new(path, bytes.into_inner()))
}
