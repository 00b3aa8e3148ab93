//! Why a pattern cannot be lowered.

use super::super::EdgeRef;

/// Why a pattern cannot be lowered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LoweringError {
    /// The pattern itself is not sound.
    Unsound(String),
    /// Chains of edges that cut each other again and again.
    Endless {
        /// The seam.
        seam: String,
    },
    /// An edge that is on two sides of one seam.
    Itself {
        /// The seam.
        seam: String,
        /// The edge.
        edge: EdgeRef,
    },
}

impl std::fmt::Display for LoweringError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LoweringError::Unsound(what) => write!(f, "the pattern is not sound: {what}"),
            LoweringError::Endless { seam } => {
                write!(f, "the seam \"{seam}\" and others divide each other without end")
            }
            LoweringError::Itself { seam, edge } => write!(f, "the seam \"{seam}\" sews {edge} to itself"),
        }
    }
}

impl std::error::Error for LoweringError {}

impl LoweringError {
    /// What can be done about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            LoweringError::Unsound(_) => "correct the pattern's file",
            LoweringError::Endless { .. } => {
                "let every edge stand in one chain, and cut it by hand where chains end"
            }
            LoweringError::Itself { .. } => "cut the edge in two and sew its halves",
        }
    }
}
