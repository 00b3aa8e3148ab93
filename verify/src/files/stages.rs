//! What stages make for a check: a pattern by its reader, a fabric, a collider.

use super::fault::unreadable;
use std::any::Any;
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::Artifact;
use toile_core::{ArtifactType, Context, Inputs, PortValue, Stage, StageError};

/// The stage that reads a pattern's file, by its name, in the words of a pipeline:
/// `DxfPattern(file: "tank.dxf", seams: "seams.ron")`.
///
/// # Errors
/// No reader is known by the file's name.
pub fn reader_words(path: &Path, seams: Option<&Path>) -> Result<String, StageError> {
    let text = |p: &Path| format!("{:?}", p.display().to_string());
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let stage = match extension.as_deref() {
        Some("json") => "GarmentCode",
        Some("dxf") => "DxfPattern",
        Some("svg") => "SvgPattern",
        Some("sm2d" | "val") => "SeamlyPattern",
        _ => {
            let what = format!("\"{}\" is not a pattern by its name", path.display());
            return Err(unreadable(what)
                .hint("name a pattern of GarmentCode (.json), a .dxf, .svg, .sm2d or .val file"));
        }
    };
    let seams = seams.filter(|_| stage != "GarmentCode").map(|s| format!(", seams: {}", text(s)));
    Ok(format!("{stage}(file: {}{})", text(path), seams.unwrap_or_default()))
}

/// What a stage makes of these inputs, by its type.
///
/// # Errors
/// The stage's own, or it makes nothing of that type.
pub(super) fn made<T: ArtifactType>(
    stage: &dyn Stage,
    inputs: Vec<Option<PortValue>>,
    cx: &Context,
) -> Result<Arc<T>, StageError> {
    let values = stage.run_ports(&Inputs(inputs), cx)?;
    let typed = |value: PortValue| match value {
        PortValue::One(artifact) => (artifact as Arc<dyn Any + Send + Sync>).downcast::<T>().ok(),
        PortValue::Set(..) => None,
    };
    let name = stage.card().name;
    values.into_iter().find_map(typed).ok_or_else(|| {
        StageError::invalid(format!("`{name}` makes no {}", T::KIND)).hint("name a stage that makes one")
    })
}

/// An artifact for an input.
pub(super) fn one(artifact: impl Artifact) -> Option<PortValue> {
    Some(PortValue::One(Arc::new(artifact)))
}
