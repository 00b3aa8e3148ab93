//! What runs on this machine took, kept from run to run beside the cache's results.
//!
//! `costs.jsonl` in the cache's folder, bounded: of each stage the latest runs are kept. It is
//! written whole beside its place and renamed. Two runs that end at once may lose the records of
//! one of them.

use super::record::{CostRecord, HostMachine};
use super::shipped::{Collection, LONGEST, parse};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toile_core::StageError;
use toile_core::artifact::OutputFile;
use toile_pipeline::write_files;

/// The file's name.
const FILE: &str = "costs.jsonl";
/// Runs of a stage that are kept.
const RUNS: usize = 24;
/// Words behind every reason not to use what is there.
const INSTEAD: &str = "the shipped figures stand in";

/// The file.
#[derive(Debug, Clone)]
pub struct CostStore {
    folder: PathBuf,
}

/// What was found in it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Opened {
    /// Records of this machine and program.
    pub records: Vec<CostRecord>,
    /// What is wrong with the file.
    pub warning: Option<String>,
}

impl CostStore {
    /// The store in a folder, which is made when the first run is kept.
    pub fn new(folder: &Path) -> Self {
        CostStore { folder: folder.to_owned() }
    }

    /// Reads it; nothing where there is no file yet, and nothing with a warning where it is of no
    /// use.
    pub fn open(&self, host: &HostMachine) -> Opened {
        let path = self.folder.join(FILE);
        let refused = |why: &str| Opened {
            records: Vec::new(),
            warning: Some(format!("what earlier runs took, \"{}\", {why}; {INSTEAD}", path.display())),
        };
        match std::fs::metadata(&path) {
            Err(e) if is_missing(&e) => return Opened::default(),
            Ok(meta) if meta.len() > LONGEST as u64 => return refused("is longer than 8 MB"),
            _ => {}
        }
        let text = match toile_core::read_file(&path) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(e) if is_missing(&e) => return Opened::default(),
            Err(e) => return refused(&format!("cannot be read ({e})")),
        };
        match parse(&text) {
            Err(why) => refused(why),
            Ok(c) if c.toile != env!("CARGO_PKG_VERSION") => {
                refused(&format!("was kept by version {}", c.toile))
            }
            Ok(c) if c.host != *host => refused(&format!("is of another machine ({})", c.host)),
            Ok(c) => Opened { warning: damaged(c.damaged, &path), records: c.records },
        }
    }

    /// Adds the records of a run; what is there of another machine or program makes place.
    ///
    /// Errors: the folder cannot be written.
    pub fn add(&self, host: &HostMachine, new: Vec<CostRecord>) -> Result<(), StageError> {
        let mut records = self.open(host).records;
        records.extend(new);
        let collection = Collection { host: host.clone(), ..Collection::here(latest(records)) };
        let bytes = collection.to_text().into_bytes();
        write_files(&self.folder, &[OutputFile { path: FILE.into(), bytes }]).map(|_| ())
    }
}

fn is_missing(e: &std::io::Error) -> bool {
    matches!(e.kind(), std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory)
}

fn damaged(lines: usize, path: &Path) -> Option<String> {
    let word = if lines == 1 { "line" } else { "lines" };
    (lines > 0).then(|| {
        format!("what earlier runs took, \"{}\", has {lines} damaged {word}, left out", path.display())
    })
}

/// The latest runs of each stage, in their order.
fn latest(records: Vec<CostRecord>) -> Vec<CostRecord> {
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    let mut kept: Vec<CostRecord> = records
        .into_iter()
        .rev()
        .filter(|r| {
            let n = count.entry(r.stage.clone()).or_default();
            *n += 1;
            *n <= RUNS
        })
        .collect();
    kept.reverse();
    kept
}
