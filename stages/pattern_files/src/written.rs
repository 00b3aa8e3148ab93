//! What a writer gives.

/// A pattern as a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The file.
    pub bytes: Vec<u8>,
    /// The file of seams beside it, by the names that the file has; RON, as `sidecar` tells. Empty where nothing reads the file
    /// back.
    pub seams: String,
    /// What the file does not hold, and what was decided, a sentence each.
    pub notes: Vec<String>,
}
