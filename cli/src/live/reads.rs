//! Files that a run reads, as they were then.

use std::path::Path;
use std::sync::PoisonError;
use std::time::SystemTime;
use toile_core::artifact::Digest;
use toile_pipeline::plugin::plugin_files;
use toile_pipeline::{Pipeline, Reads};

/// Notes the plugins of a pipeline that may have got them by `--set`.
pub(crate) fn note_plugins(pipeline: &Pipeline, reads: &Reads) {
    let named = pipeline.plugins.iter().flat_map(|p| plugin_files(&pipeline.base.join(&p.file)));
    named.for_each(|p| note(reads, &p));
}

/// Notes a file as it is now.
pub(crate) fn note(reads: &Reads, path: &Path) {
    let content = look(path, None).and_then(|l| l.content);
    reads.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned(), content);
}

/// Modification time, size and digest of a file; the digest is none where the file does not exist.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FileLook {
    modified: Option<SystemTime>,
    size: u64,
    pub(crate) content: Option<Digest>,
}

/// Looks at a file; one whose time and size are as before is not read again.
pub(crate) fn look(path: &Path, was: Option<&FileLook>) -> Option<FileLook> {
    let meta = std::fs::metadata(path).ok()?;
    let (modified, size) = (meta.modified().ok(), meta.len());
    let same = was.filter(|w| w.modified == modified && w.size == size);
    let content = match same {
        Some(was) => was.content,
        None => toile_core::read_file(path).ok().map(|bytes| Digest::of(&bytes)),
    };
    Some(FileLook { modified, size, content })
}
