//! How a pipeline trades accuracy for time, measured, and settings picked by that measure.
//!
//! [`study`] runs a pipeline over its *knobs* and compares every garment with a converged
//! *reference*; [`tune`] picks from what was measured and verifies the choice by fresh runs.
//! docs/reference/trade.md defines every figure.
//!
//! - `source`, `split`, `knob`, `dial`, `slot`, `default_knobs`: the pipeline's file, what may be
//!   varied in it, and how a setting becomes overrides of the pipeline file;
//! - `sample`, `front`: which settings are tried, and which of them nothing beats;
//! - `surface`, `girth`, `silhouette`, `texture`, `errors`: how far a garment is from the
//!   reference;
//! - `jitter`, `ladder`, `richardson`, `floor`: the reference, the check that it has converged, its
//!   own spread, and how well it is known;
//! - `measure`: one run with its clocks; `apart`: in a process of its own; `study`: the whole,
//!   bounded by a budget, kept on disk, resumed; `journal`: how it is kept; `digest`: what tells
//!   pipelines and garments apart; `digits`: rounding of numbers for people;
//! - `decided`, `saving`, `ablate`: what a pipeline leaves out by facts of its scene, what that
//!   saves, and what reversing each decision changes;
//! - `cost`: what a run will take, predicted from what earlier runs took (docs/reference/costs.md);
//! - `tune`, `qualities`: settings for an error or a time, verified; `table`, `page`, `plot`: the
//!   output for people; `plot` draws the stability maps of the cloth engine as well.
//!
//! Invariant: nothing here runs inside a pipeline, but for the jitter of a start; what a stage
//! takes is timed here and by the runner, not by the stage.

pub mod ablate;
pub mod cost;
pub mod decided;
pub mod digest;
pub mod digits;
pub mod errors;
pub mod front;
mod girth;
mod journal;
pub mod knobs;
pub mod measure;
mod page;
pub mod plot;
pub mod qualities;
pub mod record;
pub mod reference;
pub mod saving;
mod silhouette;
pub mod study;
pub mod surface;
pub mod table;
mod texture;
pub mod tune;

pub use measure::processor_seconds;
pub use page::files;
