//! What may be wrong with a pattern of Seamly2D or Valentina beyond repair.

use super::super::faults::Fault;
use thiserror::Error;
use toile_core::{ErrorCode, nearest};
use toile_seamly::{SeamlyFault, ToolPlace};

/// Why a file is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum Damage {
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

impl Damage {
    /// What is wrong with a draft, whose file names those measurements.
    pub(super) fn draft(fault: SeamlyFault, named: Option<&str>) -> Self {
        Damage::Draft { fault: Box::new(fault), named: named.map(str::to_owned) }
    }

    /// What the user may do about it.
    pub(super) fn remedy(&self) -> String {
        match self {
            Damage::Draft { fault, named } => of_draft(fault, named.as_deref()),
            Damage::Many { .. } => "save the pieces in several files".into(),
            Damage::Crosses { .. } | Damage::Piece { .. } => {
                "let the piece's nodes follow each other around it, and its curves run in their direction"
                    .into()
            }
            Damage::NoFold { .. } => {
                "take \"place on fold\" out of the piece's label, or turn its grain line along the fold"
                    .into()
            }
            Damage::Mirror { .. } => "let the mirror line run along a straight edge of the outline".into(),
            Damage::Size { remedy, .. } | Damage::Unsewable { remedy, .. } => remedy.clone(),
        }
    }

    /// As a fault of the file.
    pub(super) fn fault(&self) -> Fault {
        let (code, param) = match self {
            Damage::Crosses { .. } => (ErrorCode::DegenerateTriangles, "file"),
            Damage::Draft { fault, .. } => match **fault {
                SeamlyFault::Size { what, .. } | SeamlyFault::OneSize { what } => {
                    (ErrorCode::InvalidParameter, what)
                }
                _ => (ErrorCode::PatternLoading, "file"),
            },
            Damage::Many { .. }
            | Damage::NoFold { .. }
            | Damage::Mirror { .. }
            | Damage::Piece { .. }
            | Damage::Size { .. }
            | Damage::Unsewable { .. } => (ErrorCode::PatternLoading, "file"),
        };
        Fault { code, param, what: self.to_string(), remedy: Some(self.remedy()) }
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
