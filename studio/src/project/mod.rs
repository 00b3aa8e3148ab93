//! A project: a folder with a pipeline, its inputs, the history of its text and its results.
//!
//! - `lock`: one studio a folder; `journal`: edits on the disk before they are answered; `undo`:
//!   the texts before and after; `text`: what is known of a text; `change`: changes as a page sends
//!   them; `begin`: templates and samples; `uploads`, `outputs`: files that come and go.

pub(crate) mod begin;
pub(crate) mod change;
mod journal;
mod lock;
pub(crate) mod outputs;
pub(crate) mod text;
mod undo;
mod uploads;

use crate::fault::StudioFault;
use begin::{BeginWith, beginning};
use change::StudioChange;
use journal::{EditJournal, JournalEntry, JournalStep};
use lock::FolderLock;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use text::CheckedText;
use toile_core::Registry;
use toile_core::artifact::{Digest, OutputFile};
use toile_pipeline::{MAX_BYTES, edited, with_plugins, write_files};
use undo::UndoSteps;

/// The name of a project's pipeline where none is named.
pub(crate) const PIPELINE: &str = "pipeline.ron";

/// The longest words of an edit, characters.
const MOST_WORDS: usize = 200;

/// A folder with a pipeline that is edited.
#[derive(Debug)]
pub struct StudioProject {
    folder: PathBuf,
    registry: Arc<Registry>,
    _lock: FolderLock,
    /// None before there is a pipeline.
    open: Option<OpenFile>,
    edit: u64,
    checked: Arc<CheckedText>,
}

/// A pipeline file with its history.
#[derive(Debug)]
struct OpenFile {
    name: String,
    text: String,
    /// As the file holds it.
    saved: String,
    undo: UndoSteps,
    journal: EditJournal,
}

impl StudioProject {
    /// Opens a pipeline file, or a folder with `pipeline.ron` in it or without. Edits that were not
    /// written into the file come back.
    ///
    /// Errors: another studio holds the folder; what the system says of folder and file.
    pub fn open(target: &Path, registry: Arc<Registry>) -> Result<Self, StudioFault> {
        let refused = |e: &std::io::Error| StudioFault::file("open", target, e);
        let meta = std::fs::metadata(target).map_err(|e| refused(&e))?;
        let real = target.canonicalize().map_err(|e| refused(&e))?;
        let (folder, name) = match meta.is_dir() {
            true => (real.clone(), PIPELINE.to_owned()),
            false => {
                let name = real.file_name().and_then(|n| n.to_str()).unwrap_or_default();
                (real.parent().unwrap_or(Path::new("/")).to_owned(), name.to_owned())
            }
        };
        let lock = FolderLock::take(&folder)?;
        let is_there = !meta.is_dir() || folder.join(&name).is_file();
        let mut project =
            StudioProject { folder, registry, _lock: lock, open: None, edit: 0, checked: Arc::default() };
        if is_there {
            project.take_up(&name)?;
        }
        Ok(project)
    }

    /// Reads the file, and the edits of its journal.
    fn take_up(&mut self, name: &str) -> Result<(), StudioFault> {
        let path = self.folder.join(name);
        let text = toile_core::read_text(&path).map_err(|e| StudioFault::file("read", &path, &e))?;
        let (journal, entries) = EditJournal::open(&self.folder, name, &digest(&text))?;
        let mut open = OpenFile {
            name: name.to_owned(),
            saved: text.clone(),
            text,
            undo: UndoSteps::default(),
            journal,
        };
        for entry in entries {
            open.take(&entry);
        }
        self.open = Some(open);
        self.edit += 1;
        self.check();
        Ok(())
    }

    /// Makes changes, all or none, of the text of that number; gives the new number. `words` say
    /// what was done. A `draft` may have faults.
    ///
    /// Errors: `stale` where somebody else was first; what cannot be changed; faults that the text
    /// would have; what the system says of the journal.
    pub fn edit(
        &mut self,
        edit: u64,
        words: &str,
        changes: &[StudioChange],
        draft: bool,
    ) -> Result<u64, StudioFault> {
        self.fresh(edit)?;
        if changes.is_empty() {
            return Err(StudioFault::malformed("there is no change in `changes`"));
        }
        let mut text = self.opened()?.text.clone();
        for change in changes {
            text = match (change.edit(), change) {
                (Some(edit), _) => {
                    edited(&text, &with_plugins(&text, &self.folder, &self.registry), &[edit])?
                }
                (None, StudioChange::Text(text)) => text.clone(),
                (None, _) => text,
            };
        }
        if text.len() > MAX_BYTES {
            let message = format!("the text has {} bytes, the limit is {MAX_BYTES}", text.len());
            return Err(StudioFault::new("too_large", message));
        }
        let checked = self.looked_at(&text)?;
        if !draft && checked.is_worse_than(&self.checked) {
            let fault = StudioFault::new("faults", "the edit would leave a file with faults");
            let first = checked.faults.first().map(|f| f.message.clone());
            return Err(StudioFault { hint: first, faults: checked.faults, ..fault });
        }
        let step = if draft { JournalStep::Draft } else { JournalStep::Edit };
        self.take(JournalEntry { step, words: shortened(words), text }, checked)
    }

    /// Takes the last edit back; gives the new number.
    ///
    /// Errors: `stale`, and `nothing` where there is none.
    pub fn undo(&mut self, edit: u64) -> Result<u64, StudioFault> {
        self.fresh(edit)?;
        let undone = self.opened()?.undo.before();
        let (words, text) = undone.ok_or_else(|| StudioFault::new("nothing", "there is nothing to undo"))?;
        let checked = self.looked_at(&text)?;
        self.take(JournalEntry { step: JournalStep::Undo, words, text }, checked)
    }

    /// Makes the last edit again that was taken back; gives the new number.
    ///
    /// Errors: as [`Self::undo`].
    pub fn redo(&mut self, edit: u64) -> Result<u64, StudioFault> {
        self.fresh(edit)?;
        let done = self.opened()?.undo.after();
        let (words, text) = done.ok_or_else(|| StudioFault::new("nothing", "there is nothing to redo"))?;
        let checked = self.looked_at(&text)?;
        self.take(JournalEntry { step: JournalStep::Redo, words, text }, checked)
    }

    /// Writes the text into its file; gives the file's name.
    ///
    /// Errors: another program has changed the file (a second call writes all the same); what the
    /// system says.
    pub fn save(&mut self) -> Result<String, StudioFault> {
        let folder = self.folder.clone();
        let open = self.opened_mut()?;
        let path = folder.join(&open.name);
        match std::fs::read(&path) {
            Ok(there) if there != open.saved.as_bytes() && there != open.text.as_bytes() => {
                open.saved = String::from_utf8_lossy(&there).into_owned();
                let message = format!("\"{}\" was changed by another program", open.name);
                return Err(StudioFault::new("changed", message).hint("save once more to write over it"));
            }
            _ => {}
        }
        let file = OutputFile::new(open.name.clone(), open.text.clone().into_bytes());
        write_files(&folder, &[file]).map_err(|e| StudioFault::new("file", e.message))?;
        open.saved = open.text.clone();
        open.journal.begin(&digest(&open.text))?;
        Ok(open.name.clone())
    }

    /// Writes the pipeline that a project begins with, and its inputs; gives the new number. Where
    /// it begins anew, the pipeline takes the place of the present text, which [`Self::undo`]
    /// brings back.
    ///
    /// Errors: `exists` where there is one and it is not to begin anew; what there is not; what the
    /// system says.
    pub(crate) fn begin(&mut self, with: &BeginWith) -> Result<u64, StudioFault> {
        let path = self.folder.join(PIPELINE);
        let is_first = self.open.is_none();
        if if is_first { path.exists() } else { !with.anew } {
            let message = "the project has a pipeline already";
            return Err(StudioFault::new("exists", message).hint("begin another in an empty folder"));
        }
        let begun = beginning(with, &self.registry)?;
        if let Some(file) = with.files().find(|file| !self.folder.join(file).is_file()) {
            return Err(StudioFault::not_found(format!("the project has no file \"{file}\"")));
        }
        let mut files = Vec::new();
        if is_first {
            files.push(OutputFile::new(PIPELINE, begun.text.clone().into_bytes()));
        }
        for (name, bytes) in begun.inputs {
            // A file of that name may be the user's.
            match std::fs::read(self.folder.join(name)) {
                Ok(there) if there == bytes => {}
                Ok(_) => {
                    let message = format!("the folder holds another file \"{name}\"");
                    return Err(StudioFault::new("exists", message).hint("begin in an empty folder"));
                }
                Err(_) => files.push(OutputFile::new(name, bytes.to_vec())),
            }
        }
        write_files(&self.folder, &files).map_err(|e| StudioFault::new("file", e.message))?;
        if !is_first {
            let words = format!("begin with {}", with.name());
            return self.edit(self.edit, &words, &[StudioChange::Text(begun.text)], true);
        }
        self.take_up(PIPELINE)?;
        Ok(self.edit)
    }

    /// The number of the present text.
    pub fn number(&self) -> u64 {
        self.edit
    }

    /// The present text; empty before there is one.
    pub fn text(&self) -> &str {
        self.open.as_ref().map_or("", |open| &open.text)
    }

    /// Whether the file holds the present text.
    pub fn is_saved(&self) -> bool {
        self.open.as_ref().is_none_or(|open| open.text == open.saved)
    }

    /// The words of the edit that [`Self::undo`] takes back.
    pub fn can_undo(&self) -> Option<&str> {
        self.open.as_ref()?.undo.can_undo()
    }

    /// The words of the edit that [`Self::redo`] makes again.
    pub fn can_redo(&self) -> Option<&str> {
        self.open.as_ref()?.undo.can_redo()
    }

    /// The file's name; none before there is one.
    pub fn file(&self) -> Option<&str> {
        Some(&self.open.as_ref()?.name)
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What is known of the text.
    pub(crate) fn checked(&self) -> Arc<CheckedText> {
        self.checked.clone()
    }

    fn fresh(&self, edit: u64) -> Result<(), StudioFault> {
        match edit == self.edit {
            true => Ok(()),
            false => {
                let message = format!("the text is at edit {}, not at {edit}", self.edit);
                Err(StudioFault::new("stale", message).hint("take the new state, and edit that"))
            }
        }
    }

    fn opened(&self) -> Result<&OpenFile, StudioFault> {
        self.open.as_ref().ok_or_else(no_pipeline)
    }

    fn opened_mut(&mut self) -> Result<&mut OpenFile, StudioFault> {
        self.open.as_mut().ok_or_else(no_pipeline)
    }

    fn looked_at(&self, text: &str) -> Result<CheckedText, StudioFault> {
        let open = self.opened()?;
        Ok(CheckedText::of(text, (&open.name, &self.folder), &self.registry, &self.checked))
    }

    fn check(&mut self) {
        if let Ok(checked) = self.looked_at(self.text()) {
            self.checked = Arc::new(checked);
        }
    }

    /// Puts an edit on the disk, then into memory.
    fn take(&mut self, entry: JournalEntry, checked: CheckedText) -> Result<u64, StudioFault> {
        let open = self.opened_mut()?;
        open.journal.append(&entry)?;
        open.take(&entry);
        self.checked = Arc::new(checked);
        self.edit += 1;
        Ok(self.edit)
    }
}

impl OpenFile {
    fn take(&mut self, entry: &JournalEntry) {
        match entry.step {
            JournalStep::Edit => self.undo.push(&entry.words, &self.text, false),
            JournalStep::Draft => self.undo.push(&entry.words, &self.text, true),
            JournalStep::Undo => self.undo.undo(&self.text),
            JournalStep::Redo => self.undo.redo(&self.text),
        }
        self.text.clone_from(&entry.text);
    }
}

/// Keeps a file that a user gives in the project's folder; gives its name there.
pub(crate) fn upload(folder: &Path, name: &str, bytes: &[u8]) -> Result<String, StudioFault> {
    uploads::keep(folder, name, bytes)
}

/// The files that runs have written.
pub(crate) fn written(folder: &Path) -> Vec<Value> {
    outputs::list(folder)
}

/// One of them.
pub(crate) fn written_file(folder: &Path, path: &str) -> Result<Vec<u8>, StudioFault> {
    outputs::read(folder, path)
}

fn no_pipeline() -> StudioFault {
    StudioFault::new("no_pipeline", "the project has no pipeline yet")
        .hint("begin with a photo, a pattern file or a sample")
}

fn digest(text: &str) -> String {
    Digest::of(text.as_bytes()).hex()
}

/// The words of an edit in one line.
fn shortened(words: &str) -> String {
    let line: String = words.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.is_empty() {
        true => "edit".to_owned(),
        false => line.chars().take(MOST_WORDS).collect(),
    }
}
