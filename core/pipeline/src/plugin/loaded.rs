//! A library that is loaded, and stays so.

use libloading::Library;
use std::mem::ManuallyDrop;
use toile_core::PluginId;

/// A library that is loaded.
///
/// It stays loaded until the program ends: its own threads may run longer than its last object
/// lives, and unloading code that a thread runs would crash the program.
#[derive(Debug)]
pub(super) struct LoadedLibrary {
    id: PluginId,
    words: &'static str,
    _library: ManuallyDrop<Library>,
}

impl LoadedLibrary {
    /// Keeps a library; `words` name the plugin.
    pub(super) fn new(id: PluginId, words: &'static str, library: Library) -> Self {
        LoadedLibrary { id, words, _library: ManuallyDrop::new(library) }
    }

    /// Which plugin it is.
    pub(super) fn id(&self) -> PluginId {
        self.id
    }

    /// The plugin in words: `plugin "sdf" 0.1.0`.
    pub(super) fn words(&self) -> &'static str {
        self.words
    }
}
