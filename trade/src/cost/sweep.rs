//! The settings over which stages are measured: a pipeline with other edge lengths and other sizes
//! of its photos.

use image::{GenericImageView, ImageFormat, imageops::FilterType};
use std::io::Cursor;
use std::path::Path;
use toile_core::artifact::OutputFile;
use toile_core::{Length, Role, StageError};
use toile_pipeline::{Override, Pipeline, fields_of, write_files};

/// Factors of the edge length and of the photos' sides.
const FACTORS: [(f64, f64); 7] =
    [(1.0, 1.0), (0.8, 1.0), (1.4, 1.0), (2.0, 1.0), (1.0, 0.6), (1.0, 1.3), (1.4, 0.75)];

/// A setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// In words: `edge x 1.4, photos x 0.75`.
    pub words: String,
    /// Overrides of the pipeline file that make it.
    pub overrides: Vec<Override>,
}

/// The settings of a pipeline. A pipeline without mesher and photos has one: its own. Photos of
/// other sizes are written below `folder`.
///
/// Errors: a photo cannot be read, or the folder cannot be written.
pub fn variations(pipeline: &Pipeline, folder: &Path) -> Result<Vec<Variation>, StageError> {
    let (edges, photos) = (edges(pipeline), photos(pipeline));
    let acts = |(edge, side): &(f64, f64)| {
        (*edge == 1.0 || !edges.is_empty()) && (*side == 1.0 || !photos.is_empty())
    };
    let chosen = FACTORS.into_iter().filter(acts);
    chosen.map(|(edge, side)| variation(pipeline, folder, (edge, &edges), (side, &photos))).collect()
}

fn variation(
    pipeline: &Pipeline,
    folder: &Path,
    (edge, edges): (f64, &[(String, f64)]),
    (side, photos): (f64, &[(String, String)]),
) -> Result<Variation, StageError> {
    let length = |metres: f64| format!("\"{}\"", Length::m((metres * edge * 1e4).round() / 1e4));
    let turned = edges.iter().filter(|_| edge != 1.0);
    let mut overrides: Vec<Override> =
        turned.map(|(id, own)| Override { path: format!("stages.{id}.edge"), value: length(*own) }).collect();
    for (name, file) in photos.iter().filter(|_| side != 1.0) {
        let path =
            resized(&pipeline.base.join(file), folder, &format!("{}-{name}-{side}", pipeline.name), side)?;
        overrides.push(Override { path: format!("photos.{name}.file"), value: format!("{path:?}") });
    }
    Ok(Variation { words: format!("edge x {edge}, photos x {side}"), overrides })
}

/// Meshers with their edge length, metres.
fn edges(pipeline: &Pipeline) -> Vec<(String, f64)> {
    let meshers = pipeline.nodes.iter().filter(|n| n.card.role == Role::Mesher);
    let edge = |n: &toile_core::Node| {
        let edge: Length = fields_of(&n.stage.params()).get("edge")?.trim_matches('"').parse().ok()?;
        Some((n.id.clone(), edge.metres()))
    };
    meshers.filter_map(edge).collect()
}

/// Photos that are files, with their sides' names.
fn photos(pipeline: &Pipeline) -> Vec<(String, String)> {
    let readers = pipeline.nodes.iter().filter(|n| n.card.role == Role::Reader);
    let maps = readers.filter_map(|n| fields_of(&n.stage.params()).remove("photos"));
    let file = |(name, entry): (String, String)| {
        let file = fields_of(&entry).remove("file")?;
        Some((name.trim_matches('"').to_owned(), file.trim_matches('"').to_owned()))
    };
    maps.flat_map(|map| fields_of(&map)).filter_map(file).collect()
}

/// Writes a photo with its sides scaled; returns its path.
fn resized(from: &Path, folder: &Path, name: &str, side: f64) -> Result<String, StageError> {
    let fail = |e: &dyn std::fmt::Display| {
        StageError::invalid(format!("cannot make another size of \"{}\": {e}", from.display()))
    };
    let photo = image::open(from).map_err(|e| fail(&e))?;
    let scaled = |n: u32| (f64::from(n) * side).round().max(1.0) as u32;
    let (w, h) = photo.dimensions();
    let other = photo.resize_exact(scaled(w), scaled(h), FilterType::Triangle).to_rgb8();
    let mut bytes = Cursor::new(Vec::new());
    other.write_to(&mut bytes, ImageFormat::Jpeg).map_err(|e| fail(&e))?;
    let file = OutputFile { path: format!("{name}.jpg"), bytes: bytes.into_inner() };
    let written = write_files(folder, &[file])?;
    let path = written.first().and_then(|p| p.canonicalize().ok());
    path.map(|p| p.display().to_string()).ok_or_else(|| fail(&"it was not written"))
}
