//! The framework of Toile.
//!
//! A *pipeline* is a RON file that wires *stages*; a stage reads *artifacts* and makes new ones.
//! This crate knows no stage by name and does no physics: it holds the artifacts' types, the
//! [`Stage`] trait, parameters and their checks, the registry, and the plugin ABI. Pipelines are
//! loaded and run by `toile-pipeline`, which the author of a stage does not need.
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

// The macros' expansion names this crate, which uses them too.
extern crate self as toile_core;

pub mod artifact;
mod context;
pub mod cost;
pub mod decide;
mod error;
mod files;
mod migration;
mod near;
pub mod panics;
mod parallel;
pub mod param;
#[allow(unsafe_code)]
pub mod plugin;
mod registry;
mod remarks;
mod runlog;
mod stage;
#[cfg(any(test, feature = "testkit"))]
pub mod testkit;
#[doc(hidden)]
pub mod text;
#[cfg(feature = "typetag")]
mod typed;

pub use artifact::{Artifact, ArtifactType, Kind};
pub use context::{Cancel, Context, Event, Listener, MakePart, Memo};
pub use error::{ErrorCode, StageError};
pub use files::{MAX_FILE_BYTES, NoFile, ordinary, read_file, read_text};
pub use migration::{Change, Migration};
pub use near::{hint, nearest, quoted};
pub use param::{Finer, Length, ParamDoc, ParamFault, ParamType};
pub use registry::{Registry, Section, SectionValue};
pub use remarks::Remarks;
pub use runlog::{Failure, RunLog, StageRecord};
pub use stage::{
    Arity, ByPlace, Card, Contract, Feed, InPort, Input, Inputs, Known, Node, OutPort, Output, Placed,
    PluginId, PortValue, Role, Set, Stage, StageMeta, StageType, needed_for,
};
pub use toile_core_derive::{choice, params, plugin, stage};
// The `stage` macro's expansion names these.
#[cfg(feature = "typetag")]
#[doc(hidden)]
pub use typetag;
#[doc(hidden)]
pub use {ron, serde};

/// The `stage` macro's implementation of [`Stage`]: typetag then finds the stage by its name.
#[cfg(feature = "typetag")]
#[doc(hidden)]
#[macro_export]
macro_rules! stage_impl {
    ($($implementation:tt)*) => {
        use $crate::typetag;

        #[typetag::serde]
        $($implementation)*
    };
}

/// The `stage` macro's implementation of [`Stage`].
#[cfg(not(feature = "typetag"))]
#[doc(hidden)]
#[macro_export]
macro_rules! stage_impl {
    ($($implementation:tt)*) => { $($implementation)* };
}

/// What the author of a stage imports.
pub mod prelude {
    pub use crate::artifact::*;
    pub use crate::{
        Context, Contract, ErrorCode, Length, ParamType, Placed, Registry, Role, RunLog, Section,
        SectionValue, Set, Stage, StageError, StageRecord, StageType, choice, params, stage,
    };
}
