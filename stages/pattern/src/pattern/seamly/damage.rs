//! What may be wrong with a pattern of Seamly2D or Valentina beyond repair.

use super::super::faults::PatternFault;
use thiserror::Error;
use toile_core::{ErrorCode, nearest};
use toile_seamly::{SeamlyFault, ToolPlace};

/// Why a file is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum DraftDamage {
    #[error("{fault}")]
    Draft { fault: Box<SeamlyFault>, named: Option<String> },
    #[error("it has {count} pieces, {most} are the most")]
    Many { count: usize, most: usize },
    #[error("{place}: its outline crosses itself near ({x:.1}, {y:.1}) of the draft")]
    Crosses { place: ToolPlace, x: f64, y: f64 },
    #[error("{place}: it is cut on the fold, and no straight edge of it runs along its grain")]
    NoFold { place: ToolPlace },
    #[error("{place}: its mirror line does not lie on its outline")]
    Mirror { place: ToolPlace },
    #[error("{place}: {what}")]
    Piece { place: ToolPlace, what: &'static str },
    #[error("{what}")]
    Size { what: String, remedy: String },
    #[error("{what}")]
    Unsewable { what: String, remedy: String },
}

impl DraftDamage {
    /// What is wrong with a draft, whose file names those measurements.
    pub(super) fn draft(fault: SeamlyFault, named: Option<&str>) -> Self {
        DraftDamage::Draft { fault: Box::new(fault), named: named.map(str::to_owned) }
    }

    /// What the user may do about it.
    pub(super) fn remedy(&self) -> String {
        match self {
            DraftDamage::Draft { fault, named } => of_draft(fault, named.as_deref()),
            DraftDamage::Many { .. } => "save the pieces in several files".into(),
            DraftDamage::Crosses { .. } | DraftDamage::Piece { .. } => {
                "let the piece's nodes follow each other around it, and its curves run in their direction"
                    .into()
            }
            DraftDamage::NoFold { .. } => {
                "take \"place on fold\" out of the piece's label, or turn its grain line along the fold"
                    .into()
            }
            DraftDamage::Mirror { .. } => {
                "let the mirror line run along a straight edge of the outline".into()
            }
            DraftDamage::Size { remedy, .. } | DraftDamage::Unsewable { remedy, .. } => remedy.clone(),
        }
    }

    /// As a fault of the file.
    pub(super) fn fault(&self) -> PatternFault {
        let (code, param) = match self {
            DraftDamage::Crosses { .. } => (ErrorCode::DegenerateTriangles, "file"),
            DraftDamage::Draft { fault, .. } => match **fault {
                SeamlyFault::Size { what, .. } | SeamlyFault::OneSize { what } => {
                    (ErrorCode::InvalidParameter, what)
                }
                _ => (ErrorCode::PatternLoading, "file"),
            },
            DraftDamage::Many { .. }
            | DraftDamage::NoFold { .. }
            | DraftDamage::Mirror { .. }
            | DraftDamage::Piece { .. }
            | DraftDamage::Size { .. }
            | DraftDamage::Unsewable { .. } => (ErrorCode::PatternLoading, "file"),
        };
        PatternFault { code, param, what: self.to_string(), remedy: Some(self.remedy()) }
    }
}

/// With the name that may be meant, and the file of measurements that the pattern names.
fn of_draft(fault: &SeamlyFault, named: Option<&str>) -> String {
    let SeamlyFault::Unknown { name, known, measured, what, .. } = fault else { return fault.remedy() };
    match (named, nearest(name, known.iter().map(String::as_str))) {
        (_, Some(near)) => format!("did you mean \"{near}\"? {}", fault.remedy()),
        (Some(named), None) if !measured && *what == "measurement" => format!(
            "the pattern names \"{named}\" for its measurements, which is not there; {}",
            fault.remedy()
        ),
        _ => fault.remedy(),
    }
}
