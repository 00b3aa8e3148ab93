//! `Origin`: where every triangle of the garment comes from, for `toile why RESULT --face N`.
//!
//! Written beside the results as `origin.json`: for each panel its flat vertices, their pixels in
//! the photo, the triangles, and the named edges of its outline; and which vertices the seams join.
//! [`trace`] reads it back together with a result, [`flat`] gives what it says of the flat pieces.
//! Cost: one pass over the garment. Limit: the result's triangles must stand in the garment's
//! order, as the writers of this crate leave them; where the counts say otherwise the trace is
//! refused.

mod flat;
mod result;
mod trace;

pub use flat::{FlatPanel, FlatPieces, FlatSeam, flat};
pub use trace::{Trace, trace};

use crate::texture::of_panel;
use serde::{Deserialize, Serialize};
use toile_core::prelude::*;

/// The file's name.
pub const FILE: &str = "origin.json";

/// Writes where every triangle comes from: panel, place in the panel, outline edge and photo pixel.
///
/// Every pipeline that makes a garment has it; `toile why out/vest/garment.glb --face 100` reads
/// it.
#[stage(
    role = Writer,
    version = 3,
    source = "none",
    example = "Origin()",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Origin {}

#[stage]
impl Origin {
    fn run(
        &self,
        garment: &Garment,
        panels: Option<Set<Panel>>,
        #[original] photos: Option<Set<Photo>>,
        _cx: &Context,
    ) -> Result<OutputFiles, StageError> {
        let origins = origins(garment, panels.as_ref(), photos.as_ref());
        let bytes = serde_json::to_vec(&origins)
            .map_err(|e| StageError::internal(format!("the origins cannot be written: {e}")))?;
        Ok(OutputFiles::one(FILE, bytes))
    }
}

/// What the file holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Origins {
    pub(super) panels: Vec<PanelOrigin>,
    /// Seams; none in files of version 2 and before.
    #[serde(default)]
    pub(super) seams: Vec<SeamOrigin>,
}

/// One seam.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SeamOrigin {
    pub(super) name: String,
    /// Its kind's word and figures.
    pub(super) kind: String,
    pub(super) figures: Vec<f64>,
    /// Vertices that are sewn together, counted through all panels in their order.
    pub(super) pairs: Vec<[u32; 2]>,
}

/// One panel, in the garment's order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct PanelOrigin {
    pub(super) name: String,
    pub(super) photo: Option<PhotoOrigin>,
    /// Flat positions, metres.
    pub(super) positions: Vec<[f64; 2]>,
    /// Pixels in the photo, one per vertex, or none.
    pub(super) pixels: Vec<[f64; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Named edges of the outline as chains of flat places, metres: the garment's mesh may be a
    /// finer one than the panel's.
    pub(super) edges: Vec<(String, Vec<[f64; 2]>)>,
}

/// A photo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct PhotoOrigin {
    /// Its file, relative to the pipeline.
    pub(super) file: String,
    /// True where the panel is its mirror image.
    pub(super) mirrored: bool,
}

/// Rounds to a hundredth of a millimetre, or of a pixel: what is finer says nothing, and makes the
/// file twice as long.
fn rounded(x: f64, unit: f64) -> f64 {
    (x / unit).round() / (1.0 / unit).round()
}

fn place(v: &Point2) -> [f64; 2] {
    [v.x, v.y].map(|c| rounded(c, 1e-5))
}

fn chains(panel: &Panel) -> Vec<(String, Vec<[f64; 2]>)> {
    let at = |&i: &u32| panel.positions.get(i as usize).map(place);
    panel.edges.iter().map(|e| (e.name.clone(), e.vertices.iter().filter_map(at).collect())).collect()
}

fn origins(garment: &Garment, panels: Option<&Set<Panel>>, photos: Option<&Set<Photo>>) -> Origins {
    let of = |p: &GarmentPanel| {
        let first = p.vertices.start as u32;
        let flat = panels.and_then(|set| set.get(&p.name));
        let photo = photos.and_then(|set| of_panel(set, &p.name)).filter(|_| !p.photo_px.is_empty());
        PanelOrigin {
            name: p.name.clone(),
            photo: photo.map(|f| PhotoOrigin { file: f.file.clone(), mirrored: f.mirrored }),
            positions: garment.rest[p.vertices.clone()].iter().map(place).collect(),
            pixels: p.photo_px.iter().map(|v| [v.x, v.y].map(|c| rounded(c, 1e-2))).collect(),
            triangles: garment.triangles[p.triangles.clone()]
                .iter()
                .map(|t| t.map(|i| i.saturating_sub(first)))
                .collect(),
            edges: flat.map(chains).unwrap_or_default(),
        }
    };
    let seam = |s: &GarmentSeam| SeamOrigin {
        name: s.name.clone(),
        kind: s.kind.word().to_owned(),
        figures: s.kind.figures(),
        pairs: s.pairs.clone(),
    };
    Origins {
        panels: garment.panels.iter().map(of).collect(),
        seams: garment.seams.iter().map(seam).collect(),
    }
}
