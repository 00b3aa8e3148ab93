//! What is kept of a garment that was run: its line of the results, what it took, and what went
//! into it, by which a later batch knows that it is done.

use crate::live::reads::look;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use toile_core::artifact::{Digest, Digester};

/// The record's file in a garment's folder. A folder with one is whole.
pub(crate) const FILE: &str = "record.json";

/// A line of `results.jsonl`. It is the same to the bit for the same inputs, wherever and however
/// often it was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ResultLine {
    pub(crate) id: String,
    /// Of the program, its plugins, the pipeline, all values and the content of all files.
    pub(crate) inputs: Digest,
    /// The exit code of `toile run`, or of `toile verify` where that found a fault.
    pub(crate) exit: u8,
    #[serde(flatten)]
    pub(crate) fault: GarmentFault,
    /// The named quality, the garment's figures, and the limits that it misses.
    pub(crate) quality: Value,
    /// `verdict` and failing checks of `toile verify`; null where it was not judged.
    pub(crate) certificate: Value,
    /// Number of files.
    pub(crate) files: usize,
    /// Of the files' names and content, but for those that hold times.
    pub(crate) result: Digest,
    pub(crate) version: String,
}

/// Why a garment is none, or no good one.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct GarmentFault {
    /// The stable word; none where all is well.
    pub(crate) fault: Option<String>,
    /// The stage that failed.
    pub(crate) stage: Option<String>,
    pub(crate) message: Option<String>,
    pub(crate) hint: Option<String>,
}

impl GarmentFault {
    /// A fault of that kind.
    pub(crate) fn new(kind: &str, message: impl Into<String>) -> Self {
        GarmentFault { fault: Some(kind.to_owned()), message: Some(message.into()), ..Self::default() }
    }

    pub(crate) fn hint(self, hint: &str) -> Self {
        GarmentFault { hint: Some(hint.to_owned()), ..self }
    }
}

/// A line of `costs.jsonl`: what differs from run to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct CostLine {
    pub(crate) id: String,
    pub(crate) seconds: f64,
    /// Greatest resident memory, where the system reports it.
    pub(crate) peak_bytes: Option<u64>,
    /// Bytes of all its files.
    pub(crate) bytes: u64,
}

/// Files that a garment was made of, as they are seen from the manifest's folder; none for one that
/// was not there.
pub(crate) type ReadFiles = BTreeMap<String, Option<Digest>>;

/// What lies in a garment's folder as `record.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct GarmentRecord {
    /// Of all that went in but the files' content.
    pub(crate) ticket: Digest,
    /// The values, as the manifest writes them.
    pub(crate) set: Vec<(String, String)>,
    pub(crate) reads: ReadFiles,
    pub(crate) line: ResultLine,
    pub(crate) costs: CostLine,
}

impl GarmentRecord {
    /// That of a garment's folder; none where there is no whole one.
    pub(crate) fn read(folder: &Path) -> Option<Self> {
        serde_json::from_slice(&toile_core::read_file(&folder.join(FILE)).ok()?).ok()
    }

    /// Whether the same garment would be made now.
    pub(crate) fn is_of(&self, ticket: &Digest, files: &FileDigests<'_>) -> bool {
        self.ticket == *ticket && self.reads.iter().all(|(path, content)| files.of(path) == *content)
    }
}

/// The digest of all inputs.
pub(crate) fn inputs(ticket: &Digest, reads: &ReadFiles) -> Digest {
    let mut d = Digester::new();
    d.bytes(&ticket.0).count(reads.len());
    for (path, content) in reads {
        d.text(path).bytes(&content.map_or([0; 32], |c| c.0));
    }
    d.finish()
}

/// The content of files, each read once a batch.
pub(crate) struct FileDigests<'a> {
    folder: &'a Path,
    known: Mutex<BTreeMap<String, Option<Digest>>>,
}

impl<'a> FileDigests<'a> {
    /// Of files as they are seen from a folder.
    pub(crate) fn seen_from(folder: &'a Path) -> Self {
        FileDigests { folder, known: Mutex::default() }
    }

    /// The digest of a file; none where it cannot be read.
    pub(crate) fn of(&self, path: &str) -> Option<Digest> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner).get(path).copied();
        known.unwrap_or_else(|| {
            let content = look(&self.folder.join(path), None).and_then(|l| l.content);
            self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned(), content);
            content
        })
    }
}

/// A path as it is seen from a folder, so that both may be moved together; both are full paths.
pub(crate) fn relative(path: &Path, folder: &Path) -> PathBuf {
    let (path, folder) = (plain(path), plain(folder));
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return path;
    }
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => drop(plain.pop()),
            part => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_path_is_seen_from_a_folder() {
        let seen =
            |path: &str, folder: &str| relative(Path::new(path), Path::new(folder)).display().to_string();
        assert_eq!(seen("/a/b/c.json", "/a/b"), "c.json");
        assert_eq!(seen("/a/x/../b/./c.json", "/a/d"), "../b/c.json");
        assert_eq!(seen("/a/b.json", "/c/d"), "../../a/b.json");
    }

    #[test]
    fn a_garment_is_done_while_its_inputs_are_the_same() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.json");
        std::fs::write(&path, "one").unwrap();
        let ticket = Digest::of(b"ticket");
        let reads = ReadFiles::from([("a.json".into(), Some(Digest::of(b"one"))), ("none".into(), None)]);
        let line = ResultLine {
            id: "a".into(),
            inputs: inputs(&ticket, &reads),
            exit: 5,
            fault: GarmentFault::new("timeout", "it took too long").hint("wait"),
            quality: Value::Null,
            certificate: Value::Null,
            files: 0,
            result: ticket,
            version: "1".into(),
        };
        let costs = CostLine { id: "a".into(), seconds: 0.1 + 0.2, peak_bytes: None, bytes: 0 };
        let set = vec![("a.b".to_owned(), "1".to_owned())];
        let record = GarmentRecord { ticket, set, reads, line, costs };
        std::fs::write(dir.path().join(FILE), serde_json::to_string(&record).unwrap()).unwrap();
        let back = GarmentRecord::read(dir.path()).unwrap();
        assert_eq!(back, record);
        let is_done = |ticket: &Digest| back.is_of(ticket, &FileDigests::seen_from(dir.path()));
        assert!(is_done(&ticket) && !is_done(&Digest::of(b"other")));
        std::fs::write(dir.path().join("none"), "").unwrap();
        assert!(!is_done(&ticket), "a file that was not there is there now");
        std::fs::remove_file(dir.path().join("none")).unwrap();
        std::fs::write(&path, "two").unwrap();
        assert!(!is_done(&ticket));
        std::fs::write(dir.path().join(FILE), "{").unwrap();
        assert_eq!(GarmentRecord::read(dir.path()), None);
    }
}
