//! What goes into a garment's own process, and what comes out of it: a line of JSON each.

use super::folder::FolderContents;
use super::record::{GarmentFault, ReadFiles};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::PathBuf;
use std::time::Duration;

/// A garment to be run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct GarmentTask {
    pub(crate) pipeline: PathBuf,
    /// The manifest's folder, from which files are seen.
    pub(crate) folder: PathBuf,
    /// An empty folder for what the run gives.
    pub(crate) out: PathBuf,
    pub(crate) quality: Option<String>,
    /// Paths and values.
    pub(crate) set: Vec<(String, String)>,
    pub(crate) until: Option<String>,
    /// None runs without a cache.
    pub(crate) cache_dir: Option<PathBuf>,
    pub(crate) threads: u16,
    pub(crate) max_time: Option<Duration>,
    /// Names of the files that are kept; all where there is none.
    pub(crate) keep: Vec<String>,
    pub(crate) verify: bool,
}

/// What came of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct GarmentAnswer {
    pub(crate) exit: u8,
    pub(crate) fault: GarmentFault,
    pub(crate) quality: Value,
    pub(crate) certificate: Value,
    pub(crate) reads: ReadFiles,
    pub(crate) contents: FolderContents,
    /// Greatest resident memory.
    pub(crate) peak_bytes: Option<u64>,
    /// Why a file could not be written: the garment is not done then.
    pub(crate) unwritten: Option<String>,
    /// Whether it was stopped by a signal: it is not done either.
    pub(crate) cancelled: bool,
}
