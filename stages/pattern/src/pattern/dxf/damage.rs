//! What may be wrong with a DXF file beyond repair.

use super::super::faults::PatternFault;
use super::super::letters::LettersFault;
use thiserror::Error;
use toile_core::ErrorCode;

/// Why a file is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum DxfDamage {
    #[error("it is a binary DXF")]
    Binary,
    #[error(transparent)]
    Letters(LettersFault),
    #[error("it has {bytes} bytes, {most} are the most")]
    Large { bytes: usize, most: usize },
    #[error("\"{value}\" at line {line} is no group code")]
    Code { value: String, line: usize },
    #[error("it ends at line {line}, within a pair of code and value")]
    Early { line: usize },
    #[error("\"{value}\" at line {line} is no number of a pattern")]
    Number { value: String, line: usize },
    #[error("it has {count} {what}, {most} are the most")]
    Many { what: &'static str, count: usize, most: usize },
    #[error("there are no pieces: no block has a boundary on layer 1")]
    NoPieces,
    #[error("there is no size \"{size}\"")]
    NoSize { size: String, known: Vec<String> },
    #[error("the units are \"{word}\", they are ENGLISH or METRIC")]
    Units { word: String },
    #[error(
        "piece \"{piece}\" (line {line}): its boundary is open by {gap_mm:.1} mm near ({x:.1}, {y:.1}) in the file's units"
    )]
    Open { piece: String, line: usize, gap_mm: f64, x: f64, y: f64 },
    #[error(
        "piece \"{piece}\" (line {line}): its boundary crosses itself near ({x:.1}, {y:.1}) in the file's units"
    )]
    Crosses { piece: String, line: usize, x: f64, y: f64 },
    #[error("piece \"{piece}\" (line {line}): its mirror line does not lie on its boundary")]
    Mirror { piece: String, line: usize },
    #[error("piece \"{piece}\" (line {line}): {what}")]
    Piece { piece: String, line: usize, what: String },
    #[error("{what}")]
    Size { what: String, remedy: String },
    #[error("{what}")]
    Unsewable { what: String, remedy: String },
}

impl DxfDamage {
    /// What the user may do about it.
    pub(super) fn remedy(&self) -> String {
        match self {
            DxfDamage::Letters(fault) => fault.remedy(),
            DxfDamage::Binary => "export it as ASCII DXF, release 12".into(),
            DxfDamage::Large { .. } | DxfDamage::Many { .. } => {
                "export fewer pieces or sizes at a time".into()
            }
            DxfDamage::Code { .. } | DxfDamage::Early { .. } | DxfDamage::Number { .. } => {
                "export the file again; a DXF is pairs of lines, a code and its value".into()
            }
            DxfDamage::NoPieces => "export it as AAMA or ASTM DXF, a block for each piece and size".into(),
            DxfDamage::NoSize { known, .. } => format!("the sizes are {}", known.join(", ")),
            DxfDamage::Units { .. } => "export it with its units".into(),
            DxfDamage::Open { .. } | DxfDamage::Crosses { .. } | DxfDamage::Piece { .. } => {
                "draw the boundary as one closed line that meets itself nowhere".into()
            }
            DxfDamage::Mirror { .. } => {
                "let the mirror line run along a straight edge of the boundary".into()
            }
            DxfDamage::Size { remedy, .. } | DxfDamage::Unsewable { remedy, .. } => remedy.clone(),
        }
    }

    /// As a fault of the file.
    pub(super) fn fault(&self) -> PatternFault {
        let param = match self {
            DxfDamage::NoSize { .. } => "size",
            DxfDamage::Letters(_) => "encoding",
            _ => "file",
        };
        let code = match self {
            DxfDamage::Crosses { .. } => ErrorCode::DegenerateTriangles,
            DxfDamage::NoSize { .. } | DxfDamage::Letters(_) => ErrorCode::InvalidParameter,
            DxfDamage::Binary
            | DxfDamage::Large { .. }
            | DxfDamage::Code { .. }
            | DxfDamage::Early { .. }
            | DxfDamage::Number { .. }
            | DxfDamage::Many { .. }
            | DxfDamage::NoPieces
            | DxfDamage::Units { .. }
            | DxfDamage::Open { .. }
            | DxfDamage::Mirror { .. }
            | DxfDamage::Piece { .. }
            | DxfDamage::Size { .. }
            | DxfDamage::Unsewable { .. } => ErrorCode::PatternLoading,
        };
        PatternFault { code, param, what: self.to_string(), remedy: Some(self.remedy()) }
    }
}
