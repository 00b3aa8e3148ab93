//! The digest of a file that a stage reads.

use std::path::Path;
use toile_core::artifact::Digest;
use toile_core::read_file;

/// The digest of a file's content; `None` where it cannot be read.
pub(crate) fn file_hash(path: &Path) -> Option<Digest> {
    read_file(path).ok().map(|bytes| Digest::of(&bytes))
}
