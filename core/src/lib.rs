//! The framework of Toile.
//!
//! A *pipeline* is a RON file that wires *stages*; a stage reads *artifacts* and makes new ones.
//! This crate knows no stage by name and does no physics: it holds the artifacts' types, the
//! [`Stage`] trait, the registry, the pipeline loader, the graph check, the planner and the runner.
//!
//! A stage is a parameter struct and one typed function:
//!
//! ```
//! use toile_core::prelude::*;
//!
//! /// Turns dark into light.
//! #[stage(role = Denoiser, source = "none", example = "Invert(white: 200)")]
//! pub struct Invert {
//!     /// The level that becomes black.
//!     #[param(default = 255, min = 1, max = 255, unit = "grey levels")]
//!     white: u8,
//! }
//!
//! #[stage]
//! impl Invert {
//!     fn run(&self, photo: &Photo, _cx: &Context) -> Result<Photo, StageError> {
//!         let mut pixels = photo.pixels.as_ref().clone();
//!         pixels.iter_mut().for_each(|v| *v = self.white.saturating_sub(*v));
//!         Ok(photo.with_pixels(pixels))
//!     }
//! }
//!
//! let mut registry = Registry::new();
//! registry.add::<Invert>();
//! assert_eq!(registry.card("Invert").map(|c| c.params.len()), Some(1));
//! ```

// The macros' expansion names this crate; the tests of this crate use them too.
#[cfg(test)]
extern crate self as toile_core;

pub mod artifact;
mod beside;
pub mod cache;
mod context;
pub mod cost;
pub mod decide;
mod error;
mod files;
pub mod golden;
pub mod lock;
mod metrics;
mod output;
pub mod panics;
pub mod param;
pub mod pipeline;
#[allow(unsafe_code)]
pub mod plugin;
mod registry;
mod run;
mod stage;
#[cfg(any(test, feature = "testkit"))]
pub mod testkit;
mod text;

pub use artifact::{Artifact, ArtifactType, Kind};
pub use context::{Cancel, Context, Event, Listener, MAX_FILE_BYTES};
pub use error::{ErrorCode, StageError};
pub use files::{NoFile, ordinary, read_file, read_text};
pub use metrics::{Metrics, StageMetrics};
pub use output::{check_folder, write_files};
pub use param::{Finer, Length, ParamDoc, ParamFault, ParamType};
pub use registry::{Registry, Section, SectionValue};
pub use run::{
    Outlook, Reads, RunError, RunOptions, RunResult, SoFar, add_implicit, faults, forecast, plan, run,
};
pub use stage::{
    Arity, Card, Contract, InPort, Input, Inputs, OutPort, Output, Placed, PluginId, PortValue, Role, Set,
    Stage, StageMeta, StageType,
};
pub use toile_core_derive::{choice, plugin, stage};
// The `stage` macro's expansion names these.
#[doc(hidden)]
pub use {ron, serde, typetag};

/// What the author of a stage imports.
pub mod prelude {
    pub use crate::artifact::*;
    pub use crate::{
        Context, Contract, ErrorCode, Length, ParamType, Placed, Registry, Role, Section, SectionValue, Set,
        Stage, StageError, StageType, choice, stage,
    };
}
