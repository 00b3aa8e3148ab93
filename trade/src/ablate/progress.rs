//! How far an ablation is.

/// What is told on the way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AblationProgress {
    /// Something about earlier sessions.
    Note(String),
    /// A run that begins.
    Run(RunStep),
}

/// A run that begins, and how many are done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunStep {
    /// Runs that are done, those of earlier sessions as well.
    pub done: usize,
    /// Runs in all.
    pub all: usize,
    /// The run that begins, in words.
    pub what: String,
}

impl std::fmt::Display for RunStep {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "run {} of {}: {}", self.done + 1, self.all, self.what)
    }
}
