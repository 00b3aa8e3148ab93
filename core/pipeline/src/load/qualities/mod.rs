//! Named qualities: settings of a pipeline by the error that they keep.
//!
//! ```ron
//! qualities: [
//!     Quality(name: "Draft", max_error: "10 mm",
//!         set: ["stages.GridMesher.edge=\"24 mm\""],
//!         measured: "2026-11-22: 95 % of the surface within 8.3 mm, ...",
//!         measured_for: "5f2a90c4d1e8b377-1c2d3e4f5a6b7c8d"),
//! ],
//! ```
//!
//! A quality promises a measured error, of the pipeline that it was measured for, and nothing else;
//! `toile tune PIPELINE --quality NAME=LENGTH` measures and writes it. Its settings are overrides
//! in the form of `--set`. Every load of the file checks each of them against the file as it
//! stands, so that a fault of a quality shows before the quality is requested.
//!
//! - `read`: the field's entries; `check`: their settings; `write`: the field put into a file's
//!   text; `basis`: what a claim was measured for, and whether that is the pipeline at hand.
//!
//! Cost: one more check of the pipeline for each quality. Limits: [`MAX_QUALITIES`],
//! [`MAX_SETTINGS`].

mod basis;
mod check;
mod read;
mod write;

pub use basis::{Basis, Standing};
pub(super) use check::settings;
pub(super) use read::{choose, named, read};
pub use write::{fill, without};

use super::setting::Override;
use std::ops::Range;
use toile_core::Length;

/// The most qualities of a file: each is checked at every load.
pub const MAX_QUALITIES: usize = 20;

/// The most settings of one: each takes a pass over the text.
pub const MAX_SETTINGS: usize = 100;

/// A named setting of a pipeline, defined by the error that it keeps.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    /// Its name: `Draft`.
    pub name: String,
    /// 95 % of the draped surface lie no farther from the reference.
    pub max_error: Length,
    /// What it sets, in this order.
    pub set: Vec<Override>,
    /// The measurement that it rests on, in words, with its day; none where it is promised only.
    pub measured: Option<String>,
    /// What it was measured for; none where that is not known.
    pub basis: Option<Basis>,
    /// Its name in the file.
    place: Range<usize>,
    /// Its settings in the file.
    places: Vec<Range<usize>>,
}

impl Quality {
    /// A quality that stands in no file yet.
    pub fn new(name: String, max_error: Length, set: Vec<Override>, measured: Option<String>) -> Self {
        Quality { name, max_error, set, measured, basis: None, place: 0..0, places: Vec::new() }
    }

    /// The same, measured for a pipeline.
    #[must_use]
    pub fn measured_for(self, basis: Basis) -> Self {
        Quality { basis: Some(basis), ..self }
    }

    /// Where its settings stand in the file that it was read from.
    pub(super) fn places(&self) -> &[Range<usize>] {
        &self.places
    }

    /// In words with what its claim is worth: `Draft (10 mm)`,
    /// `Fine (2 mm, measured for another pipeline)`.
    pub fn words(&self, standing: Standing) -> String {
        let doubt = standing.words().map_or_else(String::new, |words| format!(", {words}"));
        format!("{} ({}{doubt})", self.name, self.max_error)
    }

    /// Whether a text may be the name of one: 1 to 64 letters, digits, `_`, `-` and spaces between
    /// them.
    pub fn is_name(text: &str) -> bool {
        let fit = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | ' ');
        !text.is_empty() && text.chars().count() <= 64 && text.chars().all(fit) && text.trim() == text
    }
}
