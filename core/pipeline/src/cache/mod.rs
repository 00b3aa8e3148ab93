//! A cache of what stages made, addressed by content.
//!
//! A stage that promises to be deterministic is run once for the same parameters, inputs, version
//! and files; after that its result comes from a folder. The unit is one run: a stage that is
//! mapped over a named set has one entry a panel, so that a changed front leaves the back alone.
//! Nothing is decoded before something needs it: the digests that keys are made of stand in small
//! manifests.
//!
//! Method: content addressing as in Nix (Dolstra 2004) and Bazel's action cache, with "constructive
//! traces" in the words of Mokhov, Mitchell and Peyton Jones, Build Systems à la Carte, 2018: equal
//! outputs of a stage that was run again stop the run right there, since keys are made of contents
//! and not of histories. Cost: a run that keeps its results encodes, hashes and writes each of them
//! once; a run that finds all of them reads one small file a stage and panel, and the files that it
//! gives. Limits: errors are not kept; a stage that does not declare `Deterministic`, and what
//! takes an output of it that cannot be stored, is always run.

mod causes;
mod key;
mod manifest;
mod size;
mod space;
mod store;
#[cfg(test)]
mod tests;

pub use causes::Cause;
pub(crate) use causes::{LastMade, RUN_SO_FAR};
pub(crate) use key::{Fed, Ingredients};
pub(crate) use manifest::{Blob, KeptValue, Manifest};
pub use size::Bytes;
pub use space::Usage;

use crate::file_hash::file_hash;
use crate::made::EntryResult;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use store::{FolderStore, Shelf};
use toile_core::artifact::{Artifact, Digest, Digester, Kind, stored};
use toile_core::{Card, MakePart, Memo, PortValue, StageError};

/// Bytes that the cache holds at most after a run, if not told otherwise: some twenty garments with
/// photos of 12 megapixels.
pub const DEFAULT_LIMIT: u64 = 2_000_000_000;

/// A folder of results. Several runs, and several programs, may use it at once.
#[derive(Debug)]
pub struct Cache {
    store: FolderStore,
    limit: u64,
    warnings: Mutex<Vec<String>>,
    /// False of a cache that only takes digests.
    keeps: bool,
    /// False after the first file that could not be written: a full disk stays full.
    writable: AtomicBool,
    wrote: AtomicBool,
}

/// What became of a search.
#[derive(Debug)]
pub(crate) enum CacheAnswer {
    /// It is there, whole as far as can be seen without reading it.
    Hit(Manifest),
    /// It is not, or no more.
    Miss(Miss),
}

/// Why nothing was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Miss {
    /// There is no such entry.
    Unknown,
    /// There was one for other contents of these files.
    Files(Vec<String>),
    /// It was pruned, all or in part.
    Pruned,
    /// It is damaged.
    Damaged(String),
}

/// Why an artifact could not be had from the cache.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Lost {
    /// It is gone, or of a kind that is not stored.
    Gone,
    /// What lies there is not what was put there.
    Damaged(String),
}

impl Cache {
    /// The cache in a folder, which is made when the first result is kept.
    pub fn new(folder: &Path) -> Self {
        let root = folder.join(format!("v{}", key::SCHEME));
        Cache {
            store: FolderStore { root },
            limit: DEFAULT_LIMIT,
            keeps: true,
            warnings: Mutex::default(),
            writable: AtomicBool::new(true),
            wrote: AtomicBool::new(false),
        }
    }

    /// A cache that keeps and finds nothing, for runs that only want the digests of their results.
    pub fn nowhere() -> Self {
        Cache { keeps: false, ..Cache::new(Path::new("")) }
    }

    /// The same cache with another limit, bytes.
    pub fn with_limit(self, limit: u64) -> Self {
        Cache { limit, ..self }
    }

    /// The folder of this version of the scheme.
    pub fn folder(&self) -> &Path {
        &self.store.root
    }

    /// What went wrong with the cache itself since this was last asked.
    pub fn take_warnings(&self) -> Vec<String> {
        std::mem::take(&mut *self.warnings.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Looks for a run; `base` is the folder that files are relative to.
    pub(crate) fn find(&self, key: &Digest, base: &Path) -> CacheAnswer {
        if !self.keeps {
            return CacheAnswer::Miss(Miss::Unknown);
        }
        let first = match self.manifest(key) {
            Ok(Some(manifest)) => manifest,
            Ok(None) => return CacheAnswer::Miss(Miss::Unknown),
            Err(damage) => return CacheAnswer::Miss(Miss::Damaged(damage)),
        };
        let now: Vec<(String, Option<Digest>)> =
            first.reads.iter().map(|(path, _)| (path.clone(), file_hash(&base.join(path)))).collect();
        if now == first.reads {
            return self.whole(first);
        }
        match self.manifest(&key::with_reads(key, &now)) {
            Ok(Some(manifest)) => self.whole(manifest),
            Ok(None) => {
                let changed = now.into_iter().zip(first.reads).filter(|(a, b)| a != b);
                CacheAnswer::Miss(Miss::Files(changed.map(|((path, _), _)| path).collect()))
            }
            Err(damage) => CacheAnswer::Miss(Miss::Damaged(damage)),
        }
    }

    /// Notes that a run's files were used.
    pub(crate) fn touch(&self, key: &Digest, manifest: &Manifest) {
        let blobs = manifest.outputs.iter().flat_map(KeptValue::blobs).filter(|b| b.stored);
        blobs.for_each(|b| self.store.touch(&self.store.path(Shelf::Blobs, &b.digest)));
        self.names(key, manifest).iter().for_each(|name| {
            self.store.touch(&self.store.path(Shelf::Runs, name));
        });
    }

    /// Keeps a run: what the stage made, what it said and which files it read.
    pub(crate) fn keep(&self, key: &Digest, made: &EntryResult) -> Manifest {
        let mut reads = made.reads.clone();
        reads.sort();
        reads.dedup();
        let full = key::with_reads(key, &reads);
        let kept = made.outputs.iter().enumerate().map(|(port, value)| match value {
            PortValue::One(artifact) => KeptValue::One(self.keep_artifact(&full, port, "", artifact)),
            PortValue::Set(_, set) => {
                let blob = |(n, a): (&String, _)| (n.clone(), self.keep_artifact(&full, port, n, a));
                KeptValue::Set(set.iter().map(blob).collect())
            }
        });
        let manifest = Manifest::new(reads, kept.collect(), &made.figures, &made.remarks);
        let bytes = manifest.to_bytes();
        for name in self.names(key, &manifest) {
            self.write(&self.store.path(Shelf::Runs, &name), &bytes);
        }
        manifest
    }

    /// Reads an artifact back.
    pub(crate) fn load(&self, kind: Kind, blob: &Blob) -> Result<Arc<dyn Artifact>, Lost> {
        if !blob.stored {
            return Err(Lost::Gone);
        }
        let path = self.store.path(Shelf::Blobs, &blob.digest);
        let damaged = |why: String| {
            // What is made anew must find its place free.
            self.store.remove(&path);
            Lost::Damaged(why)
        };
        let bytes = self.store.read(&path).map_err(|e| damaged(e.to_string()))?.ok_or(Lost::Gone)?;
        if Digest::of(&bytes) != blob.digest {
            return Err(damaged("its content does not have its digest".into()));
        }
        stored::decode(kind, &bytes).map_err(|e| damaged(format!("it cannot be read: {e}")))
    }

    /// A part of the work of the stage `id`, kept under that name.
    fn part(
        &self,
        id: &str,
        name: &Digest,
        make: impl FnOnce() -> Result<Vec<u8>, StageError>,
    ) -> Result<Vec<u8>, StageError> {
        if !self.keeps {
            return make();
        }
        let path = self.store.path(Shelf::Parts, name);
        match self.store.read(&path) {
            Ok(Some(bytes)) => match manifest::open(&bytes) {
                Ok(part) => {
                    self.store.touch(&path);
                    return Ok(part.to_vec());
                }
                Err(why) => self.warn(format!("damaged cache entry of {id}: {why}; it is made anew")),
            },
            Ok(None) => {}
            Err(e) => self.warn(format!("damaged cache entry of {id}: {e}; it is made anew")),
        }
        let part = make()?;
        self.write(&path, &manifest::seal(&part));
        Ok(part)
    }

    /// Tells the user something about the cache itself.
    pub(crate) fn warn(&self, text: String) {
        let mut warnings = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        if !warnings.contains(&text) {
            warnings.push(text);
        }
    }

    /// The names under which a manifest lies: the key, and for a stage that reads files the key
    /// with them, so that going back to a file's older content finds the older result.
    fn names(&self, key: &Digest, manifest: &Manifest) -> Vec<Digest> {
        let full = (!manifest.reads.is_empty()).then(|| key::with_reads(key, &manifest.reads));
        std::iter::once(*key).chain(full).collect()
    }

    fn manifest(&self, name: &Digest) -> Result<Option<Manifest>, String> {
        let path = self.store.path(Shelf::Runs, name);
        let Some(bytes) = self.store.read(&path).map_err(|e| e.to_string())? else { return Ok(None) };
        Manifest::from_bytes(&bytes).map(Some)
    }

    /// A manifest counts only while all that it names is still there.
    fn whole(&self, manifest: Manifest) -> CacheAnswer {
        let blobs = manifest.outputs.iter().flat_map(KeptValue::blobs);
        let there = |b: Blob| !b.stored || self.store.path(Shelf::Blobs, &b.digest).is_file();
        match blobs.into_iter().all(there) {
            true => CacheAnswer::Hit(manifest),
            false => CacheAnswer::Miss(Miss::Pruned),
        }
    }

    fn keep_artifact(&self, key: &Digest, port: usize, name: &str, artifact: &Arc<dyn Artifact>) -> Blob {
        let Some(bytes) = stored::encode(artifact.as_ref()) else {
            return Blob { digest: key::of_unstored(key, port, name), stored: false };
        };
        let digest = Digest::of(&bytes);
        if !self.keeps {
            return Blob { digest, stored: false };
        }
        let path = self.store.path(Shelf::Blobs, &digest);
        // Equal content has the same name: it is written once.
        match std::fs::metadata(&path) {
            Ok(there) if there.is_file() && there.len() == bytes.len() as u64 => self.store.touch(&path),
            _ => self.write(&path, &bytes),
        }
        Blob { digest, stored: true }
    }

    fn write(&self, path: &Path, bytes: &[u8]) {
        if !self.keeps || !self.writable.load(Ordering::Relaxed) {
            return;
        }
        match self.store.write(path, bytes) {
            Ok(()) => self.wrote.store(true, Ordering::Relaxed),
            Err(e) => {
                self.writable.store(false, Ordering::Relaxed);
                let folder = self.store.root.display();
                self.warn(format!(
                    "cannot write to the cache \"{folder}\": {e}; the run goes on without keeping results"
                ));
            }
        }
    }
}

/// Where parts of one stage's work lie, under keys that begin with the stage's own.
pub(crate) struct Parts {
    cache: Arc<Cache>,
    stage: Digest,
}

impl Parts {
    /// Of the stage of that card, whatever its parameters and inputs.
    pub(crate) fn of(cache: &Arc<Cache>, card: &Card) -> Arc<dyn Memo> {
        Arc::new(Parts { cache: cache.clone(), stage: key::of_stage(card) })
    }
}

impl Memo for Parts {
    fn part(&self, id: &str, key: &Digester, make: MakePart<'_>) -> Result<Vec<u8>, StageError> {
        let mut d = Digester::new();
        d.text("toile part").bytes(&self.stage.0).bytes(&key.finish().0);
        self.cache.part(id, &d.finish(), make)
    }
}

/// The folder of the cache where nothing else is said: `XDG_CACHE_HOME`, else `.cache` in the home
/// folder.
///
/// The caller reads the environment; this crate does not.
pub fn default_folder(
    toile: Option<PathBuf>,
    xdg: Option<PathBuf>,
    home: Option<PathBuf>,
) -> Option<PathBuf> {
    let xdg = xdg.filter(|p| p.is_absolute()).map(|p| p.join("toile"));
    toile.or(xdg).or_else(|| home.map(|p| p.join(".cache/toile")))
}
