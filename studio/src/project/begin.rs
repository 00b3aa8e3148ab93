//! What a project begins with: the shipped templates, and the samples with their photos.
//!
//! The samples are part of the program, 1.4 MB, so that a page has something to show wherever the
//! program lies.

use super::uploads::check_name;
use crate::fault::StudioFault;
use serde::Deserialize;
use toile_core::param::ron_text;
use toile_core::{Length, Registry};
use toile_pipeline::{PipelineEdit, edited};

/// What a project is to begin with.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BeginWith {
    /// A photo of a garment that lies flat, in the project's folder.
    #[serde(default)]
    pub(crate) photo: Option<String>,
    /// The garment's real width in it; without one a bank card in the photo gives the scale.
    #[serde(default)]
    pub(crate) width: Option<String>,
    /// A pattern file in the project's folder.
    #[serde(default)]
    pub(crate) pattern: Option<String>,
    /// The measurements of a pattern that is drafted to measure, in the project's folder.
    #[serde(default)]
    pub(crate) measurements: Option<String>,
    /// A sample.
    #[serde(default)]
    pub(crate) sample: Option<String>,
    /// Whether it may take the place of the project's pipeline, as an edit.
    #[serde(default)]
    pub(crate) anew: bool,
}

impl BeginWith {
    /// The files in the project's folder that it names.
    pub(super) fn files(&self) -> impl Iterator<Item = &String> {
        self.photo.iter().chain(&self.pattern).chain(&self.measurements)
    }

    /// What it begins with, for the words of an edit.
    pub(super) fn name(&self) -> &str {
        self.files().next().or(self.sample.as_ref()).map_or("", String::as_str)
    }
}

/// A pipeline with its inputs.
#[derive(Debug)]
pub(super) struct Beginning {
    pub(super) text: String,
    /// Names and contents of files beside it.
    pub(super) inputs: Vec<(&'static str, &'static [u8])>,
}

/// A shipped pipeline, the folder of its inputs as it stands in it, and the inputs.
struct ShippedSample {
    name: &'static str,
    text: &'static str,
    folder: &'static str,
    inputs: &'static [(&'static str, &'static [u8])],
}

macro_rules! shipped {
    ($path:literal) => {
        include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../pipelines/", $path))
    };
}

macro_rules! pipeline {
    ($path:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../pipelines/", $path))
    };
}

const PHOTO: &str = pipeline!("photo.ron");
const PATTERN: &str = pipeline!("pattern.ron");

const SAMPLES: [ShippedSample; 5] = [
    ShippedSample {
        name: "vest",
        text: pipeline!("vest.ron"),
        folder: "samples/vest/",
        inputs: &[
            ("front.jpg", shipped!("samples/vest/front.jpg")),
            ("back.jpg", shipped!("samples/vest/back.jpg")),
        ],
    },
    ShippedSample {
        name: "tshirt",
        text: pipeline!("tshirt.ron"),
        folder: "samples/tshirt/",
        inputs: &[
            ("front.jpg", shipped!("samples/tshirt/front.jpg")),
            ("back.jpg", shipped!("samples/tshirt/back.jpg")),
        ],
    },
    ShippedSample {
        name: "skirt",
        text: pipeline!("photo_skirt.ron"),
        folder: "samples/skirt/",
        inputs: &[("front.jpg", shipped!("samples/skirt/front.jpg"))],
    },
    ShippedSample {
        name: "trousers",
        text: pipeline!("photo_trousers.ron"),
        folder: "samples/trousers/",
        inputs: &[("front.jpg", shipped!("samples/trousers/front.jpg"))],
    },
    ShippedSample {
        name: "shirt_pattern",
        text: PATTERN,
        folder: "samples/pattern/",
        inputs: &[("shirt_specification.json", shipped!("samples/pattern/shirt_specification.json"))],
    },
];

/// The pipeline that is asked for.
///
/// Errors: nothing is named, or what there is not.
pub(super) fn beginning(with: &BeginWith, registry: &Registry) -> Result<Beginning, StudioFault> {
    let measurements = with.measurements.as_deref();
    let bare = with.width.is_none() && measurements.is_none();
    match (&with.photo, &with.pattern, &with.sample) {
        (Some(photo), None, None) if measurements.is_none() => {
            of_photo(photo, with.width.as_deref(), registry)
        }
        (None, Some(pattern), None) if with.width.is_none() => of_pattern(pattern, measurements, registry),
        (None, None, Some(name)) if bare => sample(name),
        _ => Err(StudioFault::malformed("a project begins with a photo, a pattern or a sample")
            .hint("{\"photo\": \"tee.jpg\", \"width\": \"76 cm\"}")),
    }
}

fn sample(name: &str) -> Result<Beginning, StudioFault> {
    let Some(sample) = SAMPLES.iter().find(|s| s.name == name) else {
        let names: Vec<&str> = SAMPLES.iter().map(|s| s.name).collect();
        return Err(StudioFault::new("not_found", format!("there is no sample \"{name}\""))
            .hint(format!("there is {}", toile_core::quoted(&names))));
    };
    Ok(Beginning { text: sample.text.replace(sample.folder, ""), inputs: sample.inputs.to_vec() })
}

/// A photo without a width has a bank card in it: the template's width is that of its own sample.
fn of_photo(photo: &str, width: Option<&str>, registry: &Registry) -> Result<Beginning, StudioFault> {
    check_name(photo)?;
    let mut edits = vec![set("photos.front.file", ron_text(&photo))];
    match width {
        Some(width) => {
            let length: Length = width.parse().map_err(StudioFault::malformed)?;
            edits.push(set("photos.front.width", ron_text(&length)));
        }
        None => {
            edits.push(set("photos.front.scale", "BankCard".to_owned()));
            edits.push(PipelineEdit::Remove { path: "photos.front.width".to_owned() });
        }
    }
    made(PHOTO, registry, &edits)
}

fn of_pattern(
    pattern: &str,
    measurements: Option<&str>,
    registry: &Registry,
) -> Result<Beginning, StudioFault> {
    check_name(pattern)?;
    let ending = pattern.rsplit('.').next().unwrap_or("").to_lowercase();
    let file = ron_text(&pattern);
    let reader = match (ending.as_str(), measurements) {
        ("json", None) => format!("GarmentCode(file: {file})"),
        ("dxf", None) => format!("DxfPattern(file: {file})"),
        ("svg", None) => format!("SvgPattern(file: {file})"),
        ("sm2d" | "val", None) => format!("SeamlyPattern(file: {file})"),
        ("sm2d" | "val", Some(measurements)) => {
            check_name(measurements)?;
            format!("SeamlyPattern(file: {file}, measurements: {})", ron_text(&measurements))
        }
        ("json" | "dxf" | "svg", Some(_)) => {
            let message = format!("\"{pattern}\" is not drafted to measure: it takes no measurements");
            return Err(StudioFault::malformed(message).hint("give it alone"));
        }
        _ => {
            let message = format!("\"{pattern}\" is no pattern file that is known by its ending");
            return Err(StudioFault::malformed(message).hint("json, dxf, svg, sm2d or val"));
        }
    };
    made(PATTERN, registry, &[set("pattern", reader)])
}

fn set(path: &str, value: String) -> PipelineEdit {
    PipelineEdit::Set { path: path.to_owned(), value }
}

fn made(template: &str, registry: &Registry, edits: &[PipelineEdit]) -> Result<Beginning, StudioFault> {
    Ok(Beginning { text: edited(template, registry, edits)?, inputs: Vec::new() })
}
