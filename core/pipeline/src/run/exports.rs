//! A stage's artifacts as ordinary files: `stages/STAGE/PANEL.png`.
//!
//! Artifacts write themselves; pictures and tables are encoded here, so that the crates that make
//! them do not need the encoding libraries.

use super::typed;
use image::ImageFormat;
use serde::Serialize;
use std::io::Cursor;
use std::sync::Arc;
use toile_core::Artifact;
use toile_core::StageRecord;
use toile_core::artifact::{Fabric, Figures, Mask, OutputFile, Photo};

/// The files of all that a stage made.
pub(super) fn exports(record: &StageRecord) -> Vec<OutputFile> {
    let mut files = Vec::new();
    for value in &record.outputs {
        for (entry, artifact) in value.entries() {
            let stem = if entry.is_empty() { value.kind().0.replace(' ', "_") } else { entry.to_owned() };
            for (extension, bytes) in exported(artifact) {
                files.push(OutputFile { path: format!("stages/{}/{stem}.{extension}", record.id), bytes });
            }
        }
    }
    files
}

fn exported(artifact: &Arc<dyn Artifact>) -> Vec<(&'static str, Vec<u8>)> {
    let mut bytes = Cursor::new(Vec::new());
    // Writing to memory fails only for pictures of zero size, which have no file form.
    let written = if let Some(photo) = typed::<Photo>(artifact) {
        photo.pixels.write_to(&mut bytes, ImageFormat::Png)
    } else if let Some(mask) = typed::<Mask>(artifact) {
        mask.pixels.write_to(&mut bytes, ImageFormat::Png)
    } else if let Some(fabric) = typed::<Fabric>(artifact) {
        return json(fabric);
    } else if let Some(figures) = typed::<Figures>(artifact) {
        return json(&figures.garment);
    } else {
        return artifact.export();
    };
    written.map(|()| ("png", bytes.into_inner())).into_iter().collect()
}

fn json(table: &impl Serialize) -> Vec<(&'static str, Vec<u8>)> {
    serde_json::to_vec_pretty(table).map(|bytes| ("json", bytes)).into_iter().collect()
}
