//! Why a stage would run again: what it was last made from beside what it would be made from now,
//! field by field.
//!
//! For every pipeline file, stage and entry the cache keeps the ingredients of the last run. They
//! are for people alone: no result depends on them.

use super::manifest::{sealed, unsealed};
use super::{Cache, Fed, Ingredients, KeptValue, Manifest};
use crate::load::{Pipeline, fields_of};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use toile_core::artifact::Digest;

/// What a stage was last made from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct LastMade {
    ingredients: Ingredients,
    reads: Vec<(String, Option<Digest>)>,
    /// Names of the set on each output port; none for a single artifact.
    pub(crate) sets: Vec<Option<Vec<String>>>,
}

/// The maker's name of a port that takes the run's own record.
pub(crate) const RUN_SO_FAR: &str = "the run so far";

/// One thing that differs, or that does not.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// The pipeline's stage was never run here, or its record is gone.
    NeverRun,
    /// Another stage stands under this id now.
    Stage {
        /// Its name before.
        from: String,
        /// Its name now.
        to: String,
    },
    /// Its algorithm is another.
    Version {
        /// Before.
        from: u32,
        /// Now.
        to: u32,
    },
    /// The plugin that holds it is another.
    Plugin,
    /// A parameter.
    Param {
        /// Its name.
        name: String,
        /// Its value before, as RON; none where it is new.
        from: Option<String>,
        /// Its value now; none where it is no more.
        to: Option<String>,
    },
    /// An input.
    Input {
        /// The id of the stage that makes it, or `the run so far`.
        from: String,
        /// True where its content is as before.
        same: bool,
        /// The entries of a set that changed, where they can be told.
        entries: Vec<String>,
    },
    /// An input whose maker would itself run again, so that its content is not known yet.
    Upstream(String),
    /// A file that the stage reads.
    File(String),
    /// All is as before, but the result was pruned.
    Pruned,
    /// All is as before, but the cache's entry is damaged.
    Damaged(String),
    /// The stage does not promise the same result for the same input, so that it is always run.
    NotDeterministic,
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bare = |text: &Option<String>| match text {
            Some(text) => text.trim_matches('"').to_owned(),
            None => "(none)".to_owned(),
        };
        match self {
            Cause::NeverRun => f.write_str("never run"),
            Cause::Stage { from, to } => write!(f, "stage {from} -> {to}"),
            Cause::Version { from, to } => write!(f, "stage version {from} -> {to}"),
            Cause::Plugin => f.write_str("its plugin changed"),
            Cause::Param { name, from, to } => write!(f, "{name} {} -> {}", bare(from), bare(to)),
            Cause::Input { from, same: true, .. } => write!(f, "upstream \"{from}\" unchanged"),
            Cause::Input { from, entries, .. } if entries.is_empty() => {
                write!(f, "upstream \"{from}\" changed")
            }
            Cause::Input { from, entries, .. } => {
                write!(f, "upstream \"{from}\" changed ({})", entries.join(", "))
            }
            Cause::Upstream(from) if from == RUN_SO_FAR => f.write_str("a stage before it would run again"),
            Cause::Upstream(from) => write!(f, "upstream \"{from}\" would run again"),
            Cause::File(path) => write!(f, "file {path} changed"),
            Cause::Pruned => f.write_str("its result was pruned"),
            Cause::Damaged(why) => write!(f, "damaged entry: {why}"),
            Cause::NotDeterministic => f.write_str("it is not deterministic and always runs"),
        }
    }
}

impl Cache {
    /// Notes what a stage was made from, for the next [`Cache::last`].
    pub(crate) fn note(&self, pipeline: &Pipeline, id: &str, ingredients: &Ingredients, manifest: &Manifest) {
        if !self.keeps {
            return;
        }
        let path = self.last_path(pipeline, id, &ingredients.entry);
        let names = |kept: &KeptValue| match kept {
            KeptValue::One(_) => None,
            KeptValue::Set(set) => Some(set.keys().cloned().collect()),
        };
        let sets = manifest.outputs.iter().map(names).collect();
        let last = LastMade { ingredients: ingredients.clone(), reads: manifest.reads.clone(), sets };
        let bytes = sealed(&last);
        match self.store.read(&path).ok().flatten().as_ref() == Some(&bytes) {
            true => self.store.touch(&path),
            false => self.write(&path, &bytes),
        }
    }

    /// What a stage of a pipeline was last made from.
    pub(crate) fn last(&self, pipeline: &Pipeline, id: &str, entry: &str) -> Option<LastMade> {
        let bytes = self.store.read(&self.last_path(pipeline, id, entry)).ok()??;
        unsealed(&bytes).ok()
    }

    fn last_path(&self, pipeline: &Pipeline, id: &str, entry: &str) -> PathBuf {
        let file = Path::new(&pipeline.file);
        let full = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        let hex = Digest::of(full.display().to_string().as_bytes()).hex();
        // An entry's name may hold what no file's name may.
        let entry =
            if entry.is_empty() { String::new() } else { Digest::of(entry.as_bytes()).hex()[..16].into() };
        self.store.root.join("last").join(&hex[..16]).join(format!("{id}.{entry}"))
    }
}

impl LastMade {
    /// The differences to what the stage would be made from now; `base` is the folder that files
    /// are relative to. Inputs that are as before stand last.
    pub(crate) fn compare(&self, now: &Ingredients, base: &Path) -> Vec<Cause> {
        let was = &self.ingredients;
        let mut causes = Vec::new();
        if (&was.name, &was.role) != (&now.name, &now.role) {
            causes.push(Cause::Stage { from: was.name.clone(), to: now.name.clone() });
        } else {
            if was.version != now.version {
                causes.push(Cause::Version { from: was.version, to: now.version });
            }
            if was.plugin != now.plugin {
                causes.push(Cause::Plugin);
            }
            causes.extend(params(&was.params, &now.params));
        }
        let changed = |(path, hash): &(String, Option<Digest>)| super::file_hash(&base.join(path)) != *hash;
        causes.extend(self.reads.iter().filter(|r| changed(r)).map(|(path, _)| Cause::File(path.clone())));
        let mut inputs: Vec<Cause> = now.inputs.iter().filter_map(|used| self.input(used)).collect();
        inputs.sort_by_key(|c| matches!(c, Cause::Input { same: true, .. }));
        inputs.dedup();
        causes.extend(inputs);
        causes
    }

    fn input(&self, now: &super::key::FedPort) -> Option<Cause> {
        let was = self.ingredients.inputs.iter().find(|u| u.port == now.port).map(|u| &u.value);
        if now.value == Fed::Nothing && was.is_none_or(|w| *w == Fed::Nothing) {
            return None;
        }
        if now.value == Fed::Unknown {
            return Some(Cause::Upstream(now.from.clone()));
        }
        let entries = match (was, &now.value) {
            (Some(Fed::Set(was)), Fed::Set(now)) => {
                let names: BTreeSet<&String> = was.keys().chain(now.keys()).collect();
                names.into_iter().filter(|n| was.get(*n) != now.get(*n)).cloned().collect()
            }
            _ => Vec::new(),
        };
        Some(Cause::Input { from: now.from.clone(), same: was == Some(&now.value), entries })
    }
}

/// Parameters that differ.
fn params(was: &str, now: &str) -> Vec<Cause> {
    if was == now {
        return Vec::new();
    }
    let (was, now): (BTreeMap<_, _>, BTreeMap<_, _>) = (fields_of(was), fields_of(now));
    let names: BTreeSet<&String> = was.keys().chain(now.keys()).collect();
    let differing = names.into_iter().filter(|n| was.get(*n) != now.get(*n));
    differing
        .map(|name| Cause::Param {
            name: name.clone(),
            from: was.get(name).cloned(),
            to: now.get(name).cloned(),
        })
        .collect()
}
