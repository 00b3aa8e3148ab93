//! Which edges are sewn to which, and where each panel goes on the body.

use crate::artifact::store::sound::finite;
use crate::artifact::{Artifact, ArtifactType, Kind, Measures, SeamKind};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

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

/// The part of the body that a panel covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Limb {
    /// Chest and back, with the shoulders (and the upper arms where the panel has sleeves).
    Torso,
    /// From the waist down.
    Legs,
    /// The wearer's left arm.
    LeftArm,
    /// The wearer's right arm.
    RightArm,
}

/// Where one panel starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PanelPlacement {
    /// The part of the body it covers.
    pub limb: Limb,
    /// True behind the body. Panel coordinates are as seen from outside, so the panel is turned.
    pub behind: bool,
    /// Pattern point that lies on `landmark`.
    pub anchor: crate::artifact::Point2,
    /// The landmark's name on the body, such as `neck_base`.
    pub landmark: &'static str,
}

/// The seams of a garment and the place of each of its panels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SewingPlan {
    /// Seams, in the order in which they are reported.
    pub seams: Vec<Seam>,
    /// Placement by panel name.
    pub placements: BTreeMap<String, PanelPlacement>,
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
        m.count("seams", self.seams.len()).count("panels", self.placements.len());
        m
    }

    fn check(&self) -> Result<(), String> {
        self.seams.iter().try_for_each(|s| s.kind.check())?;
        finite("anchor", self.placements.values().map(|p| &p.anchor.coords))
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        let lines: String = self.seams.iter().map(|s| s.name() + "\n").collect();
        vec![("txt", lines.into_bytes())]
    }
}
