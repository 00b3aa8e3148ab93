//! Knobs held against a pipeline, and settings of them as overrides of its file.
//!
//! A *slot* is a place in the pipeline that holds one stage. A knob turns the stage of a slot or
//! one of its parameters. A parameter knob by role (`mesher.edge`) acts on whatever stage is in the
//! slot, if it has the parameter; one by name (`GridMesher.edge`) on that stage alone. Where it has
//! nothing to act on it is left out of the setting, so that settings that differ in nothing are
//! one.
//!
//! - `bind`: knobs held against the pipeline; `place`: settings as places of a cube; `overrides`:
//!   settings as overrides of the file; `refine`, `reference`: what the reference has in their
//!   place.

mod bind;
mod overrides;
mod place;
mod reference;
mod refine;
#[cfg(test)]
mod tests;

pub use reference::ReferenceValue;

use crate::knobs::dial::Dial;
use std::collections::BTreeMap;
use toile_core::Card;

/// A knob of a pipeline.
#[derive(Debug, Clone, PartialEq)]
pub struct Knob {
    /// As the user knows it: `mesher.edge`.
    pub key: String,
    /// The index of its slot.
    pub slot: usize,
    /// The stage that it acts on; none where it acts on any that has the parameter.
    pub only: Option<String>,
    /// The parameter; none for the choice of the stage.
    pub param: Option<String>,
    /// What it may be.
    pub dial: Dial,
}

/// A place of the pipeline that knobs act on.
#[derive(Debug, Clone)]
pub struct KnobSlot {
    /// The path of its stage for overrides: `stages.GridMesher`, `body`.
    path: String,
    /// The card of the stage that the file has there.
    own: Card,
    /// Its parameters that the file gives, as text.
    given: BTreeMap<String, String>,
    /// All its parameters, as text.
    params: String,
}

/// The knobs of a pipeline with the slots that they act on.
#[derive(Debug, Clone)]
pub struct KnobBoard {
    /// The knobs, in the user's order; dimensions of the search.
    pub knobs: Vec<Knob>,
    slots: Vec<KnobSlot>,
    cards: Vec<Card>,
    /// What the reference has in place of the pipeline's own values.
    reference: Setting,
}

/// A setting: the value of every knob that acts, by its key.
pub type Setting = BTreeMap<String, String>;

/// A setting in a line: `mesher.edge 12 mm, solver Rest`.
pub fn setting_words(setting: &Setting) -> String {
    let one = |(key, value): (&String, &String)| format!("{key} {}", value.trim_matches('"'));
    setting.iter().map(one).collect::<Vec<_>>().join(", ")
}
