//! A manifest in a store and the files that it names: fetched into the folder `inputs`, which lies
//! as the bucket does, so that `..` leads where it leads there.

use super::Bucket;
use super::place::{StorePlace, is_key};
use super::version::StoreListing;
use crate::batch::record::relative;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use toile_core::StageError;
use toile_core::artifact::OutputFile;
use toile_pipeline::write_files;

/// The folder of what is fetched.
const FOLDER: &str = "inputs";
/// Beside it: the states of the files that were fetched.
const STATES: &str = "inputs.json";
/// Files that are held in memory at a time.
const AT_A_TIME: usize = 16;

/// The inputs of a batch whose manifest lies in a store.
pub(crate) struct StoredInputs {
    bucket: Bucket,
    place: StorePlace,
    /// The work folder, in full.
    work: PathBuf,
    /// The manifest's folder on this machine.
    folder: PathBuf,
    /// What was seen of the bucket's folders; each is looked at once a batch.
    seen: Mutex<BTreeMap<String, StoreListing>>,
}

impl StoredInputs {
    /// Those of a manifest, which is fetched: with its place on this machine.
    ///
    /// Errors: the store refuses; there is no such manifest; it cannot be written.
    pub(super) fn fetched(
        bucket: Bucket,
        place: &StorePlace,
        work: &Path,
    ) -> Result<(Self, PathBuf), StageError> {
        let gone = || {
            StageError::invalid(format!("cannot read the manifest \"{place}\": there is no such file")).hint(
                format!("send it there first, or name another; \"{}\" is the bucket", place.of_bucket()),
            )
        };
        if place.key().is_empty() {
            return Err(gone());
        }
        let bytes = bucket.read(place.key())?.ok_or_else(gone)?;
        let work = std::path::absolute(work).unwrap_or_else(|_| work.to_owned());
        let manifest = work.join(FOLDER).join(place.key());
        let folder = manifest.parent().unwrap_or(&work).to_owned();
        write_files(&work.join(FOLDER), &[OutputFile::new(place.key(), bytes)])?;
        let seen = Mutex::default();
        Ok((StoredInputs { bucket, place: place.clone(), work, folder, seen }, manifest))
    }

    /// Looks which of these files the store has. They are named as they are seen from the
    /// manifest's folder; one that lies elsewhere is passed over.
    ///
    /// Errors: the store refuses.
    pub(crate) fn look<'a>(&self, files: impl IntoIterator<Item = &'a str>) -> Result<(), StageError> {
        let keys = files.into_iter().filter_map(|file| self.key(file));
        let folders: BTreeSet<String> = keys.map(|key| folder_of(&key).to_owned()).collect();
        for folder in folders {
            if !self.seen().contains_key(&folder) {
                let found = self.bucket.in_folder(&folder)?;
                self.seen().insert(folder, found);
            }
        }
        Ok(())
    }

    /// Whether the store has a file, by what was looked at.
    pub(crate) fn has(&self, file: &str) -> bool {
        let in_store =
            |key: &String| self.seen().get(folder_of(key)).is_some_and(|all| all.contains_key(key));
        self.key(file).is_some_and(|key| in_store(&key))
    }

    /// Fetches those of these files that the store has and this machine has not as they are there;
    /// removes those that the store has no more.
    ///
    /// Errors: the store refuses; a file cannot be written.
    pub(crate) fn bring<'a>(&self, files: impl IntoIterator<Item = &'a str>) -> Result<(), StageError> {
        let keys: BTreeSet<String> = files.into_iter().filter_map(|file| self.key(file)).collect();
        self.look_at(&keys)?;
        let root = self.work.join(FOLDER);
        let mut states = self.states();
        let mut wanted = Vec::new();
        for key in keys.iter().filter(|key| *key != self.place.key()) {
            let path = root.join(key);
            match self.seen().get(folder_of(key)).and_then(|all| all.get(key)) {
                Some(now) if path.is_file() && states.get(key).is_some_and(|was| now.is(was)) => {}
                Some(_) => wanted.push(key.clone()),
                // What cannot be removed is told where it is read.
                None => drop(std::fs::remove_file(path)),
            }
        }
        if wanted.is_empty() {
            return Ok(());
        }
        for some in wanted.chunks(AT_A_TIME) {
            let bytes = self.bucket.read_all(some)?;
            let found = some.iter().zip(bytes);
            let files: Vec<OutputFile> =
                found.filter_map(|(key, bytes)| Some(OutputFile::new(key.clone(), bytes?))).collect();
            write_files(&root, &files)?;
        }
        let seen = self.seen();
        for key in wanted {
            if let Some(now) = seen.get(folder_of(&key)).and_then(|all| all.get(&key)) {
                states.insert(key, now.clone());
            }
        }
        let text = serde_json::to_string(&states).map_err(|e| StageError::internal(e.to_string()))?;
        write_files(&self.work, &[OutputFile::new(STATES, text.into_bytes())]).map(drop)
    }

    /// Where a file of the manifest's lies on this machine once it is fetched.
    pub(crate) fn path(&self, file: &str) -> Option<PathBuf> {
        Some(self.work.join(FOLDER).join(self.key(file)?))
    }

    fn look_at(&self, keys: &BTreeSet<String>) -> Result<(), StageError> {
        let named: Vec<String> =
            keys.iter().map(|key| self.work.join(FOLDER).join(key).display().to_string()).collect();
        self.look(named.iter().map(String::as_str))
    }

    /// The key of a file as it is seen from the manifest's folder; none outside the bucket.
    fn key(&self, file: &str) -> Option<String> {
        let path = relative(&self.folder.join(file), &self.work.join(FOLDER));
        let parts: Option<Vec<&str>> = path.iter().map(|part| part.to_str()).collect();
        let is_below = !path.has_root() && !path.as_os_str().is_empty();
        parts.map(|parts| parts.join("/")).filter(|key| is_below && is_key(key))
    }

    /// What is known of files that were fetched before.
    fn states(&self) -> StoreListing {
        let bytes = toile_core::read_file(&self.work.join(STATES)).unwrap_or_default();
        serde_json::from_slice(&bytes).unwrap_or_default()
    }

    fn seen(&self) -> MutexGuard<'_, BTreeMap<String, StoreListing>> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn folder_of(key: &str) -> &str {
    key.rsplit_once('/').map_or("", |(folder, _)| folder)
}
