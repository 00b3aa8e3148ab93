//! Which state of a file a store holds.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A state of a file: another content has another one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct FileVersion {
    pub(crate) e_tag: Option<String>,
    pub(crate) version: Option<String>,
}

impl FileVersion {
    /// Whether nothing has been written in between; not known of a store that names no states.
    pub(crate) fn is(&self, other: &Self) -> bool {
        (self.e_tag.is_some() || self.version.is_some()) && self == other
    }
}

/// Keys of a bucket and the state of each file.
pub(crate) type StoreListing = BTreeMap<String, FileVersion>;
