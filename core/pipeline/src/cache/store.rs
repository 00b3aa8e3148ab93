//! The cache's files: written whole or not at all, believed only where their content has their
//! name.
//!
//! Below the cache's folder: `blobs/ab/<digest>` holds encoded artifacts, `runs/ab/<key>`
//! manifests, `parts/ab/<key>` parts of stages' work, `last/<pipeline>/<stage>` what a pipeline's
//! stages were last made from. A file is written beside its place and renamed, so that two runs at
//! once can share the folder. The time of a file's last use is its modification time. Only ordinary
//! files are opened: a pipe in the place of one would be waited for.

use crate::beside;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use toile_core::artifact::Digest;
use toile_core::{ordinary, read_file};

/// What a file of the store is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shelf {
    /// Encoded artifacts, named by their own digest.
    Blobs,
    /// Manifests, named by the key of what they were made from.
    Runs,
    /// Parts of stages' work, named by what they depend on.
    Parts,
}

impl Shelf {
    fn folder(self) -> &'static str {
        match self {
            Shelf::Blobs => "blobs",
            Shelf::Runs => "runs",
            Shelf::Parts => "parts",
        }
    }
}

/// A folder of files.
#[derive(Debug, Clone)]
pub(super) struct FolderStore {
    pub(super) root: PathBuf,
}

impl FolderStore {
    pub(super) fn path(&self, shelf: Shelf, name: &Digest) -> PathBuf {
        let hex = name.hex();
        self.root.join(shelf.folder()).join(&hex[..2]).join(&hex)
    }

    /// The bytes under that name; `None` where there is no such file.
    pub(super) fn read(&self, path: &Path) -> io::Result<Option<Vec<u8>>> {
        match read_file(path) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
            Err(e) => Err(e),
        }
    }

    /// Writes a file whole or not at all.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let folder = path.parent().unwrap_or(&self.root);
        fs::create_dir_all(folder)?;
        let mut temp = beside::new_in(folder)?;
        temp.write_all(bytes)?;
        temp.persist(path).map_err(|e| e.error)?;
        Ok(())
    }

    /// Says that a file was used now. One that cannot be touched is only forgotten earlier.
    pub(super) fn touch(&self, path: &Path) {
        if ordinary(path).is_ok()
            && let Ok(file) = File::open(path)
        {
            let _ = file.set_modified(SystemTime::now());
        }
    }

    /// Takes a file away, so that a good one can take its place.
    pub(super) fn remove(&self, path: &Path) {
        let _ = fs::remove_file(path);
    }
}
