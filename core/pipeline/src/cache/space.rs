//! How much room the cache takes, and making room.
//!
//! What was used longest ago goes first; a file's modification time is its last use. A run at work
//! that loses a file to pruning makes its content anew.

use super::Cache;
use crate::beside;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::SystemTime;

/// What lies in the cache.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Usage {
    /// Runs of stages that can be found.
    pub runs: usize,
    /// Artifacts.
    pub artifacts: usize,
    /// All files together, bytes.
    pub bytes: u64,
}

struct CacheFile {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
}

impl Cache {
    /// Counts what lies in the cache; nothing where there is no cache yet.
    pub fn usage(&self) -> io::Result<Usage> {
        let count = |shelf: &str| Ok::<_, io::Error>(files(&self.folder().join(shelf))?.len());
        let bytes = files(self.folder())?.iter().map(|e| e.bytes).sum();
        Ok(Usage { runs: count("runs")?, artifacts: count("blobs")?, bytes })
    }

    /// Deletes what was used longest ago until at most `limit` bytes are left, and what programs
    /// that were killed have left; returns the bytes freed.
    pub fn prune(&self, limit: u64) -> io::Result<u64> {
        let mut entries = files(self.folder())?;
        let left = |e: &&CacheFile| e.path.file_name().and_then(|n| n.to_str()).is_some_and(is_left);
        entries.iter().filter(left).for_each(|e| beside::remove_if_left(&e.path));
        entries.sort_by(|a, b| (a.used, &a.path).cmp(&(b.used, &b.path)));
        let total: u64 = entries.iter().map(|e| e.bytes).sum();
        let mut freed = 0;
        for entry in &entries {
            if total - freed <= limit {
                break;
            }
            match fs::remove_file(&entry.path) {
                Ok(()) => freed += entry.bytes,
                // Another run was faster.
                Err(e) if e.kind() == io::ErrorKind::NotFound => freed += entry.bytes,
                Err(e) => return Err(e),
            }
        }
        Ok(freed)
    }

    /// Deletes everything; returns the bytes freed.
    pub fn clear(&self) -> io::Result<u64> {
        let bytes = self.usage()?.bytes;
        match fs::remove_dir_all(self.folder()) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
            _ => Ok(bytes),
        }
    }

    /// Keeps the cache below its limit after a run that wrote to it.
    pub(crate) fn tidy(&self) {
        if self.wrote.swap(false, Ordering::Relaxed)
            && let Err(e) = self.prune(self.limit)
        {
            self.warn(format!("cannot prune the cache \"{}\": {e}", self.folder().display()));
        }
    }
}

/// Whether a file was on its way; versions before the first release named them `.tmp` and six
/// letters.
fn is_left(name: &str) -> bool {
    beside::is_on_its_way(name) || name.starts_with(".tmp")
}

/// All files below a folder; none where it does not exist.
fn files(folder: &Path) -> io::Result<Vec<CacheFile>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let listing = match fs::read_dir(&folder) {
            Ok(listing) => listing,
            Err(e) if e.kind() == io::ErrorKind::NotFound => continue,
            Err(e) => return Err(e),
        };
        for item in listing {
            let item = item?;
            // A file that another run took away meanwhile does not count.
            let Ok(meta) = item.metadata() else { continue };
            match meta.is_dir() {
                true => folders.push(item.path()),
                false => found.push(CacheFile {
                    path: item.path(),
                    bytes: meta.len(),
                    used: meta.modified().unwrap_or(SystemTime::UNIX_EPOCH),
                }),
            }
        }
    }
    Ok(found)
}
