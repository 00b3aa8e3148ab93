//! What a writer gives.

/// A pattern as a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The file.
    pub bytes: Vec<u8>,
    /// The file of seams beside it, by the names that the file has; RON, as `sidecar` tells. Empty
    /// where nothing reads the file back.
    pub seams: String,
    /// What was decided, and what the format has no place for, a sentence each.
    pub notes: Vec<String>,
    /// What is lost that another may look for: seams, pieces, letters.
    pub warnings: Vec<String>,
}
