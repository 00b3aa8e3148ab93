//! Which pixels of a photo belong to the garment.

use super::{Artifact, ArtifactType, GrayImage, Kind, Measures, Shared};
use crate::artifact::store::sound::ensure;

/// A binary picture in the frame of its photo: 255 on the garment, 0 off it, nothing else.
#[derive(Debug, Clone)]
pub struct Mask {
    /// The pixels, 0 or 255.
    pub pixels: Shared<GrayImage>,
}

impl Mask {
    /// How many pixels are on the garment.
    pub fn area_px(&self) -> usize {
        self.pixels.as_raw().iter().filter(|&&v| v != 0).count()
    }

    /// The box of the garment's pixels: left, top, right, bottom, all inclusive.
    pub fn bounds(&self) -> Option<[u32; 4]> {
        let (w, _) = self.pixels.dimensions();
        let mut bounds: Option<[u32; 4]> = None;
        for (y, row) in self.pixels.as_raw().chunks_exact(w.max(1) as usize).enumerate() {
            let Some(left) = row.iter().position(|&v| v != 0) else { continue };
            let right = row.iter().rposition(|&v| v != 0).unwrap_or(left);
            let (l, r, y) = (left as u32, right as u32, y as u32);
            bounds = Some(match bounds {
                None => [l, y, r, y],
                Some([bl, bt, br, _]) => [bl.min(l), bt, br.max(r), y],
            });
        }
        bounds
    }
}

impl ArtifactType for Mask {
    const KIND: Kind = Kind("mask");
    const IN_SETS: bool = true;
}

impl Artifact for Mask {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let area = self.area_px();
        let [l, t, r, b] = self.bounds().unwrap_or([0; 4]);
        let mut m = Measures::new();
        m.push("area", area as f64, "px", area as f64 * 1e-3);
        m.push("box_width", f64::from(r - l), "px", 2.0).push("box_height", f64::from(b - t), "px", 2.0);
        m
    }

    fn check(&self) -> Result<(), String> {
        let (w, h) = self.pixels.dimensions();
        ensure(w > 0 && h > 0, || format!("it is {w} x {h} pixels"))?;
        let grey = self.pixels.as_raw().iter().find(|&&v| v != 0 && v != 255);
        ensure(grey.is_none(), || "it has pixels between 0 and 255".to_owned())
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}
