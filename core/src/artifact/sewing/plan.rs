//! Which edges are sewn to which.

use crate::artifact::{Artifact, ArtifactType, Kind, Measures, SeamKind};
use serde::{Deserialize, Serialize};

/// An edge of a panel, written `"front.shoulder_left"` in a pipeline file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct EdgeRef {
    /// The panel's name.
    pub panel: String,
    /// The edge's or inner line's name.
    pub edge: String,
}

impl TryFrom<String> for EdgeRef {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        match text.split_once('.') {
            Some((panel, edge)) if !panel.is_empty() && !edge.is_empty() => {
                Ok(EdgeRef { panel: panel.to_owned(), edge: edge.to_owned() })
            }
            _ => Err(format!("\"{text}\" is not an edge; write \"panel.edge\", like \"front.hem\"")),
        }
    }
}

impl From<EdgeRef> for String {
    fn from(e: EdgeRef) -> String {
        e.to_string()
    }
}

impl std::fmt::Display for EdgeRef {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.panel, self.edge)
    }
}

/// Two edges that are sewn together.
///
/// Both run counter-clockwise around their own panels, so a seam pairs the start of `a` with the
/// **end** of `b`, as two pieces laid face to face meet. `reversed` pairs start with start.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// One edge.
    pub a: EdgeRef,
    /// The other.
    pub b: EdgeRef,
    /// How they meet.
    pub kind: SeamKind,
    /// True where start is sewn to start.
    pub reversed: bool,
}

impl Seam {
    /// Its name in reports: `front.side_left + back.side_left`.
    pub fn name(&self) -> String {
        format!("{} + {}", self.a, self.b)
    }
}

/// The seams of a garment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SewingPlan {
    /// Seams, in the order in which they are reported.
    pub seams: Vec<Seam>,
}

impl ArtifactType for SewingPlan {
    const KIND: Kind = Kind("sewing plan");
    const IN_SETS: bool = false;
}

impl Artifact for SewingPlan {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.count("seams", self.seams.len());
        m
    }

    fn check(&self) -> Result<(), String> {
        self.seams.iter().try_for_each(|s| s.kind.check())
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        let lines: String = self.seams.iter().map(|s| s.name() + "\n").collect();
        vec![("txt", lines.into_bytes())]
    }
}
