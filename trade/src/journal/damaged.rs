//! A line of a record that is not what was written.

use std::path::{Path, PathBuf};

/// A line that is left out, with its place; what it held is measured again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Damaged {
    path: PathBuf,
    /// From 1.
    line: usize,
    /// From 1.
    column: usize,
    why: String,
}

impl Damaged {
    pub(super) fn new(path: &Path, line: usize, e: &serde_json::Error) -> Self {
        // The parser sees one line only, and ends its message with "at line 1".
        let words = e.to_string();
        let why = words.split(" at line ").next().unwrap_or_default().to_owned();
        Damaged { path: path.to_owned(), line, column: e.column(), why }
    }
}

impl std::fmt::Display for Damaged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Damaged { path, line, column, why } = self;
        write!(f, "{}:{line}:{column}: the line is damaged and left out: {why}", path.display())
    }
}
