//! A photo of a garment that lies flat.

use super::{Artifact, ArtifactType, GrayImage, Kind, Measures, RgbImage, Shared};
use crate::artifact::store::sound::{ensure, positive};

/// An upright sRGB photo with its scale.
///
/// Pixel centres lie at integer coordinates; x grows to the right, y downwards.
#[derive(Debug, Clone)]
pub struct Photo {
    /// The pixels, sRGB, 8 bits a channel.
    pub pixels: Shared<RgbImage>,
    /// Opacity, where the file had an alpha channel that is not opaque everywhere.
    pub alpha: Option<Shared<GrayImage>>,
    /// Scale: pixels per metre in the plane of the garment.
    ///
    /// `None` until it is known: a width given for the garment (`width: "52 cm"`) needs its mask.
    pub px_per_metre: Option<f64>,
    /// The real width of the garment's bounding box, metres, where the pipeline gives it.
    pub garment_width: Option<f64>,
    /// True where the photo stands in for its mirror image (`back: MirrorOf("front")`).
    pub mirrored: bool,
    /// How many pixels of the file, to a side, were joined into each of these: 1 for the photo as
    /// it was read.
    ///
    /// Stages need not look at it: the runner brings the frames of outlines to the file's pixels.
    /// Who holds an outline against a photo of joined pixels takes its frame by
    /// [`PhotoFrame::joined`](super::PhotoFrame::joined).
    pub joined: u32,
    /// The file it was read from, for messages and the report.
    pub file: String,
}

impl Photo {
    /// The same photo with other pixels, as denoisers return it.
    pub fn with_pixels(&self, pixels: RgbImage) -> Photo {
        Photo { pixels: Shared::new(pixels), ..self.clone() }
    }
}

impl ArtifactType for Photo {
    const KIND: Kind = Kind("photo");
    const IN_SETS: bool = true;
}

impl Artifact for Photo {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let (w, h) = self.pixels.dimensions();
        let mean = mean_level(&self.pixels);
        let mut m = Measures::new();
        m.count("width_px", w as usize).count("height_px", h as usize);
        m.push("mean_level", mean, "grey levels", 0.5);
        m
    }

    fn check(&self) -> Result<(), String> {
        let (w, h) = self.pixels.dimensions();
        ensure(w > 0 && h > 0, || format!("it is {w} x {h} pixels"))?;
        if let Some(alpha) = &self.alpha {
            ensure(alpha.dimensions() == (w, h), || "its opacity has another size".to_owned())?;
        }
        ensure(self.joined > 0, || "each of its pixels is joined from none".to_owned())?;
        self.px_per_metre.map_or(Ok(()), |s| positive("scale", s))?;
        self.garment_width.map_or(Ok(()), |w| positive("garment's width", w))
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}

fn mean_level(pixels: &RgbImage) -> f64 {
    let sum: u64 = pixels.as_raw().iter().map(|&v| u64::from(v)).sum();
    sum as f64 / pixels.as_raw().len().max(1) as f64
}
