//! Which stages of plugins were held to their contracts here.
//!
//! What a plugin promises is its author's word until somebody ran it. `toile doctor --contracts`
//! does, and what it found is kept in the cache's folder under the digest of the plugin's file, so
//! that `toile stage` says "checked" of the very library that was run, and "declared" again of one
//! that was built anew. The built-in stages are held to theirs by the project's own tests.

use std::collections::BTreeMap;
use std::path::PathBuf;
use toile_core::artifact::OutputFile;
use toile_core::testkit::is_checked;
use toile_core::{Card, Contract, StageError};
use toile_pipeline::write_files;

/// The file's name.
const FILE: &str = "contracts.txt";
/// Longer files are not looked at, bytes.
const LONGEST: u64 = 4 << 20;
/// Contracts that are kept, of all plugins together.
const MOST: usize = 10_000;

/// What is known of contracts.
pub(crate) struct Contracts {
    folder: Option<PathBuf>,
    /// Whether it was kept, by plugin, role, stage and contract.
    found: BTreeMap<String, bool>,
}

impl Contracts {
    /// What earlier runs of the doctor found; nothing where there is no folder, or no such file.
    pub(crate) fn open(folder: Option<PathBuf>) -> Self {
        let path = folder.as_ref().map(|f| f.join(FILE));
        let is_short = |p: &PathBuf| std::fs::metadata(p).is_ok_and(|m| m.is_file() && m.len() <= LONGEST);
        let text = path.filter(is_short).and_then(|p| std::fs::read_to_string(p).ok()).unwrap_or_default();
        let line = |line: &str| match line.split_once(' ')? {
            ("kept", key) => Some((key.to_owned(), true)),
            ("broken", key) => Some((key.to_owned(), false)),
            _ => None,
        };
        Contracts { folder, found: text.lines().filter_map(line).collect() }
    }

    /// What a contract of a card is worth: `checked`, `broken` or `declared`.
    pub(crate) fn word(&self, card: &Card, contract: Contract) -> &'static str {
        // The project's tests check the contracts of its own stages.
        let package = card.package.split(' ').next().unwrap_or_default();
        let is_own = card.plugin.is_none() && toile_stages::CRATES.contains(&package);
        let found = key(card, contract).and_then(|key| self.found.get(&key));
        match (found, is_own && is_checked(card, contract)) {
            (Some(false), _) => "broken",
            (Some(true), _) | (None, true) => "checked",
            (None, false) => "declared",
        }
    }

    /// Records whether a contract was kept; of plugins only, because the digest of their file
    /// identifies the build.
    pub(crate) fn note(&mut self, card: &Card, contract: Contract, kept: bool) {
        self.found.extend(key(card, contract).map(|key| (key, kept)));
    }

    /// Keeps all that is known.
    ///
    /// Errors: the folder cannot be written.
    pub(crate) fn keep(&self) -> Result<(), StageError> {
        let Some(folder) = self.folder.as_ref().filter(|_| !self.found.is_empty()) else { return Ok(()) };
        let line =
            |(key, kept): (&String, &bool)| format!("{} {key}\n", if *kept { "kept" } else { "broken" });
        let text: String = self.found.iter().take(MOST).map(line).collect();
        write_files(folder, &[OutputFile { path: FILE.into(), bytes: text.into_bytes() }]).map(|_| ())
    }
}

/// Names a contract of a stage of a plugin; none for a stage that is linked in.
fn key(card: &Card, contract: Contract) -> Option<String> {
    let plugin = card.plugin?.digest.hex();
    Some(format!("{plugin} {} {} {}", card.role.as_str(), card.name, contract.as_str()))
}
