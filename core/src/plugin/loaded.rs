//! What a plugin brings, once it is loaded.

use crate::{Card, PluginId, Stage};
use std::path::PathBuf;
use std::sync::Arc;

/// A plugin that has passed every check.
#[derive(Debug, Clone)]
pub struct Plugin {
    /// Name, version and digest.
    pub id: PluginId,
    /// The file.
    pub file: PathBuf,
    /// The ABI that it was built for.
    pub abi: (u32, u32),
    /// Its stages' cards, in its order.
    pub cards: Vec<Card>,
    /// What makes a stage of each card.
    pub makers: Vec<Arc<dyn Make>>,
}

/// Makes stages of one type.
pub trait Make: std::fmt::Debug + Send + Sync {
    /// Makes a stage from its arguments as RON, `(bias: 3.0)`.
    ///
    /// Errors: a sentence on the argument at fault.
    fn make(&self, card: &Card, arguments: &str) -> Result<Box<dyn Stage>, String>;
}

/// A plugin that is not used, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refused {
    /// The file as it was named.
    pub file: String,
    /// One sentence in lower case.
    pub reason: String,
    /// What the user may do about it.
    pub hint: Option<String>,
}

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the plugin \"{}\" is refused: {}", self.file, self.reason)
    }
}

impl std::error::Error for Refused {}
