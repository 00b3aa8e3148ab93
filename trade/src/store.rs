//! What was measured so far, on disk after every setting, so that a later session goes on from it.
//!
//! `DIR/trade.jsonl`: the first line says what was measured (program, pipeline, the files that it reads with their
//! digests, the reference), each further line is a setting. It is written whole beside its place and renamed, so that a
//! stop leaves no half line. A file of another program, pipeline or photo is not gone on from: it is put aside as
//! `trade.old.jsonl`.

use crate::record::{Point, Reference, SCHEME};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toile_core::artifact::{Artifact, Digester, Garment, OutputFile};
use toile_core::cache::Hash;
use toile_core::pipeline::Pipeline;
use toile_core::{StageError, write_files};

/// The file's name.
const FILE: &str = "trade.jsonl";

/// The first line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// [`SCHEME`].
    pub scheme: u32,
    /// The program's version.
    pub toile: String,
    /// Digest of the pipeline as it is, of the knobs that are refined for the reference, and of the stage that ends runs.
    pub base: String,
    /// Files that the pipeline reads, with the digests of their contents.
    pub reads: BTreeMap<String, Option<String>>,
    /// The reference.
    pub reference: Reference,
}

/// The file with its content.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    /// The first line.
    pub head: Head,
    /// The settings.
    pub points: Vec<Point>,
}

impl Store {
    /// A new store; nothing is written yet.
    pub fn new(
        folder: &Path,
        base: String,
        reads: BTreeMap<String, Option<String>>,
        reference: Reference,
    ) -> Self {
        let head =
            Head { scheme: SCHEME, toile: env!("CARGO_PKG_VERSION").to_owned(), base, reads, reference };
        Store { folder: folder.to_owned(), head, points: Vec::new() }
    }

    /// The store of an earlier session of the same pipeline; none where there is none, or the reason why what is there is
    /// not gone on from.
    pub fn open(folder: &Path, base: &str) -> Result<Option<Self>, String> {
        let Ok(text) = std::fs::read_to_string(folder.join(FILE)) else { return Ok(None) };
        let mut lines = text.lines();
        let head: Head = lines
            .next()
            .and_then(|l| serde_json::from_str(l).ok())
            .ok_or("it is of another version or damaged")?;
        if head.scheme != SCHEME || head.toile != env!("CARGO_PKG_VERSION") {
            return Err(format!("it was made by version {}", head.toile));
        }
        if head.base != base {
            return Err("the pipeline or what is refined has changed".into());
        }
        if let Some((path, _)) = head.reads.iter().find(|(path, digest)| content(path) != **digest) {
            return Err(format!("\"{path}\" has changed"));
        }
        // A damaged line loses itself alone.
        let points = lines.filter_map(|l| serde_json::from_str(l).ok()).collect();
        Ok(Some(Store { folder: folder.to_owned(), head, points }))
    }

    /// Puts a file aside that is not gone on from.
    pub fn put_aside(folder: &Path) {
        let _ = std::fs::rename(folder.join(FILE), folder.join("trade.old.jsonl"));
    }

    /// Adds a setting, and writes.
    ///
    /// Errors: the folder cannot be written.
    pub fn add(&mut self, point: Point) -> Result<(), StageError> {
        self.points.push(point);
        self.write()
    }

    /// Writes all of it.
    ///
    /// Errors: the folder cannot be written.
    pub fn write(&self) -> Result<(), StageError> {
        let line = |e: Result<String, serde_json::Error>| {
            e.map_err(|e| StageError::internal(format!("a setting cannot be written: {e}")))
        };
        let mut text = line(serde_json::to_string(&self.head))? + "\n";
        for point in &self.points {
            text += &(line(serde_json::to_string(point))? + "\n");
        }
        write_files(&self.folder, &[OutputFile { path: FILE.into(), bytes: text.into_bytes() }]).map(|_| ())
    }
}

fn content(path: &str) -> Option<String> {
    std::fs::read(path).ok().map(|bytes| Hash::of(&bytes).hex())
}

/// What tells one pipeline from another: its stages with versions, plugins and parameters.
pub fn digest(pipeline: &Pipeline, more: &[&str]) -> String {
    let mut d = Digester::new();
    for node in &pipeline.nodes {
        d.text(node.card.name)
            .text(node.card.role.as_str())
            .count(node.card.version as usize)
            .text(&node.stage.params());
        d.text(&node.card.plugin.map_or_else(String::new, |p| p.digest.hex()));
    }
    more.iter().for_each(|text| {
        d.text(text);
    });
    d.finish().short()
}

/// Names a garment by its content.
pub(crate) fn garment_digest(garment: &Garment) -> String {
    let mut d = Digester::new();
    garment.digest(&mut d);
    d.finish().hex()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::record::Outcome;

    fn reference() -> Reference {
        let levels = Vec::new();
        let ease_mm = BTreeMap::new();
        let stopped = "it stopped moving".to_owned();
        Reference {
            ratio: 2.0,
            levels,
            mean: None,
            p95: None,
            displacement: None,
            stopped,
            spread: None,
            ease_mm,
        }
    }

    fn point(key: &str) -> Point {
        let outcome = Outcome::OverLimit { seconds: 3.0 };
        Point { key: key.into(), setting: BTreeMap::new(), overrides: Vec::new(), outcome }
    }

    fn kept(folder: &Path) -> Store {
        let photo = folder.join("photo.jpg");
        std::fs::write(&photo, "a photo").unwrap();
        let path = photo.display().to_string();
        let reads = BTreeMap::from([(path.clone(), content(&path))]);
        let mut store = Store::new(folder, "base".into(), reads, reference());
        store.add(point("one")).unwrap();
        store.add(point("two")).unwrap();
        store
    }

    #[test]
    fn a_later_session_finds_every_setting() {
        let dir = tempfile::tempdir().unwrap();
        assert!(Store::open(dir.path(), "base").unwrap().is_none());
        let store = kept(dir.path());
        let again = Store::open(dir.path(), "base").unwrap().unwrap();
        assert_eq!((again.head, again.points), (store.head, store.points));
    }

    #[test]
    fn a_damaged_line_loses_itself_alone() {
        let dir = tempfile::tempdir().unwrap();
        kept(dir.path());
        let path = dir.path().join(FILE);
        let text = std::fs::read_to_string(&path).unwrap().replace("\"key\":\"one\"", "\"key\":\"one");
        std::fs::write(&path, text).unwrap();
        let again = Store::open(dir.path(), "base").unwrap().unwrap();
        assert_eq!(again.points, [point("two")]);
    }

    #[test]
    fn what_has_changed_is_not_gone_on_from() {
        let dir = tempfile::tempdir().unwrap();
        kept(dir.path());
        let refused = |base: &str| Store::open(dir.path(), base).unwrap_err();
        assert_eq!(refused("other"), "the pipeline or what is refined has changed");
        let photo = dir.path().join("photo.jpg");
        std::fs::write(&photo, "another").unwrap();
        assert_eq!(refused("base"), format!("\"{}\" has changed", photo.display()));
        std::fs::write(dir.path().join(FILE), "nonsense").unwrap();
        assert_eq!(refused("base"), "it is of another version or damaged");
        Store::put_aside(dir.path());
        assert!(Store::open(dir.path(), "base").unwrap().is_none());
    }
}
