//! The journal: every edit since the file was last written, on the disk before it is answered.
//!
//! A line of JSON each. The first holds the digest of the file that the edits began from; where the
//! file is another one by now, the journal is put aside under `.old` and nothing of it is taken up.
//! A last line that is cut off was never answered. Cost: a write and a sync of one text an edit;
//! a long journal is begun anew with the present text.

use super::lock::KEPT;
use crate::fault::StudioFault;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

/// A journal longer than this, bytes, is begun anew: some thousand edits.
const LONGEST: u64 = 16 << 20;

/// What an entry did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum JournalStep {
    Edit,
    /// An edit on its way.
    Draft,
    Undo,
    Redo,
}

/// One edit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct JournalEntry {
    pub(super) step: JournalStep,
    pub(super) words: String,
    /// The whole text after it.
    pub(super) text: String,
}

/// The first line.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
struct JournalBase {
    base: String,
}

/// A journal that goes on.
#[derive(Debug)]
pub(super) struct EditJournal {
    path: PathBuf,
    file: File,
    bytes: u64,
    base: String,
}

impl EditJournal {
    /// Takes up the journal of a file in a folder, whose content has the digest `base`; gives the
    /// edits that were not written into the file.
    ///
    /// Errors: the system's.
    pub(super) fn open(
        folder: &Path,
        file: &str,
        base: &str,
    ) -> Result<(Self, Vec<JournalEntry>), StudioFault> {
        let name = if file == super::PIPELINE { "journal".to_owned() } else { format!("{file}.journal") };
        let path = folder.join(KEPT).join(name);
        let refused = |e: io::Error| StudioFault::file("write", &path, &e);
        let bytes = std::fs::read(&path).unwrap_or_default();
        let (entries, good) = read(&bytes, base);
        if entries.is_empty() && !bytes.is_empty() && base_of(&bytes).as_deref() != Some(base) {
            let aside = path.with_extension("old");
            // A journal that cannot be put aside is lost, the file is not.
            let _ = std::fs::rename(&path, aside);
        }
        let mut file =
            File::options().create(true).truncate(false).write(true).open(&path).map_err(refused)?;
        let end = if entries.is_empty() { 0 } else { good as u64 };
        file.set_len(end).and_then(|()| file.seek(io::SeekFrom::Start(end))).map_err(refused)?;
        let mut journal = EditJournal { path: path.clone(), file, bytes: end, base: base.to_owned() };
        if end == 0 {
            journal.write(&JournalBase { base: base.to_owned() })?;
        }
        Ok((journal, entries))
    }

    /// Puts an edit on the disk.
    ///
    /// Errors: the system's.
    pub(super) fn append(&mut self, entry: &JournalEntry) -> Result<(), StudioFault> {
        if self.bytes > LONGEST {
            self.begin(&self.base.clone())?;
            let step = if entry.step == JournalStep::Draft { JournalStep::Draft } else { JournalStep::Edit };
            return self.write(&JournalEntry { step, ..entry.clone() });
        }
        self.write(entry)
    }

    /// Begins anew: the file was written, and has this digest.
    ///
    /// Errors: the system's.
    pub(super) fn begin(&mut self, base: &str) -> Result<(), StudioFault> {
        let emptied = self.file.set_len(0).and_then(|()| self.file.rewind());
        emptied.map_err(|e| StudioFault::file("write", &self.path, &e))?;
        self.bytes = 0;
        base.clone_into(&mut self.base);
        self.write(&JournalBase { base: base.to_owned() })
    }

    fn write(&mut self, line: &impl Serialize) -> Result<(), StudioFault> {
        let mut bytes = serde_json::to_vec(line).map_err(|e| StudioFault::new("internal", e.to_string()))?;
        bytes.push(b'\n');
        let written = self.file.write_all(&bytes).and_then(|()| self.file.sync_data());
        if let Err(e) = written {
            // What stands there in part is taken back, or cut off by the next reader.
            let _ =
                self.file.set_len(self.bytes).and_then(|()| self.file.seek(io::SeekFrom::Start(self.bytes)));
            return Err(StudioFault::file("write", &self.path, &e));
        }
        self.bytes += bytes.len() as u64;
        Ok(())
    }
}

fn base_of(bytes: &[u8]) -> Option<String> {
    let first = bytes.split(|b| *b == b'\n').next()?;
    serde_json::from_slice::<JournalBase>(first).ok().map(|b| b.base)
}

/// The whole entries of a journal that began from `base`, and how many bytes they take with it.
fn read(bytes: &[u8], base: &str) -> (Vec<JournalEntry>, usize) {
    if base_of(bytes).as_deref() != Some(base) {
        return (Vec::new(), 0);
    }
    let (mut entries, mut good) = (Vec::new(), 0);
    for (k, line) in bytes.split_inclusive(|b| *b == b'\n').enumerate() {
        let entry = serde_json::from_slice(line.strip_suffix(b"\n").unwrap_or(b""));
        match entry {
            _ if k == 0 => {}
            Ok(entry) => entries.push(entry),
            Err(_) => break,
        }
        good += line.len();
    }
    (entries, good)
}
