//! Pipelines of Toile: loading, planning and running them.
//!
//! A *pipeline* is a RON file that wires *stages*. [`load`] makes a checked graph of its text,
//! [`plan`] drops stages that no requested result needs, [`run`] runs the rest. What a stage and an
//! artifact are is said by [`toile_core`], on which alone the author of a stage depends.
//!
//! - `load`: loader, faults, graph, overrides, qualities, migrations of old files.
//! - `run`: planner and runner; [`cache`]: results of earlier runs; [`lock`]: what a run was made
//!   from.
//! - [`golden`]: sheets of measures that runs are held to.
//! - [`cost`], [`decide`]: what a run will take, and what it leaves out.
//! - [`plugin`]: stages in libraries.

mod beside;
pub mod cache;
pub mod cost;
pub mod decide;
mod file_hash;
pub mod golden;
mod load;
pub mod lock;
mod made;
mod metrics;
mod output;
#[allow(unsafe_code)]
pub mod plugin;
mod run;

pub use load::*;
pub use metrics::{GarmentMetrics, Metrics, StageMetrics};
pub use output::{check_folder, write_files};
pub use run::{
    Outlook, RunError, RunOptions, RunResult, RunWatch, SoFar, WATCHED, WatchedStage, add_implicit, forecast,
    plan, run,
};
