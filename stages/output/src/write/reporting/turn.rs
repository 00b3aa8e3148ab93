//! The turntable in the report, and where a place on the garment comes from.
//!
//! A `Turntable` that ran before the report has made the views: the report shows them and draws
//! none itself.

use crate::write::origin::{self, Origins, PanelOrigin};
use crate::write::turntable::{STYLE, data_of, script};
use serde::Serialize;
use serde_json::{Value, json};
use toile_core::artifact::OutputFiles;

/// What the page needs to show the garment from all sides.
#[derive(Debug, Serialize)]
pub(crate) struct TurnedGarment {
    style: &'static str,
    script: String,
    /// JSON in which `<` is escaped.
    data: String,
    origins: String,
}

/// The turntable among the files of a run, with the origins where they are there as well.
pub(crate) fn turn<'a>(files: impl Iterator<Item = &'a OutputFiles>) -> Option<TurnedGarment> {
    let (mut data, mut origins) = (None, None);
    for file in files.flat_map(|f| &f.0) {
        if file.path.ends_with(".html") {
            data = std::str::from_utf8(&file.bytes).ok().and_then(data_of).map(str::to_owned).or(data);
        } else if file.path == origin::FILE {
            origins = serde_json::from_slice::<Origins>(&file.bytes).ok();
        }
    }
    let origins = origins
        .map_or_else(|| json!({}), |o| o.panels.iter().map(|p| (p.name.clone(), compact(p))).collect());
    let data = data?;
    Some(TurnedGarment {
        style: STYLE,
        script: script(&data),
        data,
        origins: origins.to_string().replace('<', "\\u003c"),
    })
}

/// Millimetres and whole pixels: what a person reads.
fn compact(p: &PanelOrigin) -> Value {
    let whole = |places: &[[f64; 2]], unit: f64| -> Vec<i64> {
        places.iter().flatten().map(|c| (c / unit).round() as i64).collect()
    };
    let edges: Vec<Value> = p.edges.iter().map(|(name, line)| json!([name, whole(line, 1e-3)])).collect();
    json!({
        "photo": p.photo.as_ref().map(|f| &f.file),
        "mm": whole(&p.positions, 1e-3),
        "px": whole(&p.pixels, 1.0),
        "triangles": p.triangles.as_flattened(),
        "edges": edges,
    })
}
