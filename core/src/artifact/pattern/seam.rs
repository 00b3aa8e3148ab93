//! Seams of a pattern: chains of edges that are sewn together.

use super::super::{EdgeRef, SeamKind};

/// An edge as one link of a seam's side.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EdgeUse {
    /// The edge, or the inner line.
    pub edge: EdgeRef,
    /// True where the side runs along it from its end to its start.
    pub reversed: bool,
}

/// Two or more sides that are sewn together, or the one side of an elastic band along an edge or
/// line. Each side is a chain of edges; all sides run the same way, so that their starts meet, and
/// their ends.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternSeam {
    /// Its name in reports.
    pub name: String,
    /// How the sides meet.
    pub kind: SeamKind,
    /// The sides, each of at least one edge.
    pub sides: Vec<Vec<EdgeUse>>,
}
