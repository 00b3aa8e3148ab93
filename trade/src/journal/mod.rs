//! What was measured so far, on disk after every step, so that a later session goes on from it.
//!
//! `DIR/NAME.jsonl`: the first line says what was measured (program, pipeline, the files that it
//! reads with their digests, what else the measurement rests on), each further line is one step. It
//! is written whole beside its place and renamed, so that a stop leaves no half line; a line that
//! is damaged all the same is left out, and said to be. A file of another program, pipeline or
//! photo is not gone on from: it is put aside as `NAME.old.jsonl`.

mod damaged;
#[cfg(test)]
mod tests;

pub(crate) use damaged::Damaged;

use crate::digest::changed;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use toile_core::artifact::OutputFile;
use toile_core::{StageError, read_file};
use toile_pipeline::write_files;

/// What kind of record it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct JournalKind {
    /// The file's name, without its ending.
    pub(crate) name: &'static str,
    /// The version of the form.
    pub(crate) scheme: u32,
    /// Said where the record is of another state of the pipeline.
    pub(crate) changed: &'static str,
}

impl JournalKind {
    fn file(&self) -> String {
        format!("{}.jsonl", self.name)
    }
}

/// The first line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct JournalHeader<H> {
    /// The version of the form.
    scheme: u32,
    /// The program's version.
    toile: String,
    /// Digest of the pipeline as it is and of what else must be the same.
    base: String,
    /// Files that the pipeline reads, with the digests of their contents.
    pub(crate) reads: BTreeMap<String, Option<String>>,
    /// What else the measurement rests on.
    #[serde(flatten)]
    pub(crate) on: H,
}

impl<H> JournalHeader<H> {
    /// Whether a later session may go on; the reason where it may not.
    fn fits(&self, kind: JournalKind, base: &str) -> Result<(), String> {
        if self.scheme != kind.scheme || self.toile != env!("CARGO_PKG_VERSION") {
            return Err(format!("it was made by version {}", self.toile));
        }
        if self.base != base {
            return Err(kind.changed.into());
        }
        match changed(&self.reads) {
            Some(path) => Err(format!("\"{path}\" has changed")),
            None => Ok(()),
        }
    }
}

/// A record with its content.
#[derive(Debug)]
pub(crate) struct Journal<H, L> {
    folder: PathBuf,
    kind: JournalKind,
    /// The first line.
    pub(crate) head: JournalHeader<H>,
    /// The steps.
    pub(crate) lines: Vec<L>,
    /// Lines that were left out.
    pub(crate) damaged: Vec<Damaged>,
}

impl<H: Serialize + DeserializeOwned, L: Serialize + DeserializeOwned> Journal<H, L> {
    /// A new record; nothing is written yet.
    pub(crate) fn new(
        folder: &Path,
        kind: JournalKind,
        base: String,
        reads: BTreeMap<String, Option<String>>,
        on: H,
    ) -> Self {
        let head = JournalHeader {
            scheme: kind.scheme,
            toile: env!("CARGO_PKG_VERSION").to_owned(),
            base,
            reads,
            on,
        };
        Journal { folder: folder.to_owned(), kind, head, lines: Vec::new(), damaged: Vec::new() }
    }

    /// The record of an earlier session of the same pipeline; none where there is none, or the
    /// reason why what is there is not gone on from.
    pub(crate) fn open(folder: &Path, kind: JournalKind, base: &str) -> Result<Option<Self>, String> {
        let path = folder.join(kind.file());
        let bytes = match read_file(&path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(format!("it cannot be read: {e}")),
        };
        let mut lines = bytes.split(|b| *b == b'\n');
        let head: JournalHeader<H> = lines
            .next()
            .and_then(|l| serde_json::from_slice(l).ok())
            .ok_or("it is of another version or damaged")?;
        head.fits(kind, base)?;
        let mut found =
            Journal { folder: folder.to_owned(), kind, head, lines: Vec::new(), damaged: Vec::new() };
        for (number, line) in (2..).zip(lines).filter(|(_, line)| !line.is_empty()) {
            match serde_json::from_slice(line) {
                Ok(line) => found.lines.push(line),
                Err(e) => found.damaged.push(Damaged::new(&path, number, &e)),
            }
        }
        Ok(Some(found))
    }

    /// Puts a file aside that is not gone on from.
    pub(crate) fn put_aside(folder: &Path, kind: JournalKind) {
        let _ = std::fs::rename(folder.join(kind.file()), folder.join(format!("{}.old.jsonl", kind.name)));
    }

    /// The record of an earlier session, as [`Journal::open`]; what is put aside and what is left
    /// out of it is told.
    pub(crate) fn taken_up(
        folder: &Path,
        kind: JournalKind,
        base: &str,
        tell: &mut dyn FnMut(String),
    ) -> Option<Self> {
        let earlier = Self::open(folder, kind, base).unwrap_or_else(|why| {
            tell(format!("what is in {} is put aside: {why}", folder.display()));
            Self::put_aside(folder, kind);
            None
        });
        earlier.iter().flat_map(|j| &j.damaged).for_each(|d| tell(d.to_string()));
        earlier
    }

    /// Adds a step, and writes.
    ///
    /// Errors: the folder cannot be written.
    pub(crate) fn add(&mut self, line: L) -> Result<(), StageError> {
        self.lines.push(line);
        self.write()
    }

    /// Writes all of it.
    ///
    /// Errors: the folder cannot be written.
    pub(crate) fn write(&self) -> Result<(), StageError> {
        let mut bytes = line(&self.head)?;
        for step in &self.lines {
            bytes.extend(line(step)?);
        }
        write_files(&self.folder, &[OutputFile { path: self.kind.file(), bytes }]).map(drop)
    }
}

/// A value as a line.
fn line(value: &impl Serialize) -> Result<Vec<u8>, StageError> {
    let mut bytes = serde_json::to_vec(value)
        .map_err(|e| StageError::internal(format!("a step of the record cannot be written: {e}")))?;
    bytes.push(b'\n');
    Ok(bytes)
}
