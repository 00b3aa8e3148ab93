//! A library that is loaded, and stays so.

use libloading::Library;
use std::mem::ManuallyDrop;
use toile_core::PluginId;

/// A library that is loaded.
///
/// It stays so until the program ends: threads of its own may outlive its last object, and code
/// that is taken from under a thread ends the program.
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
