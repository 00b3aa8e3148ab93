//! What may be wrong with an SVG file beyond repair.

use super::super::faults::Fault;
use std::fmt;
use thiserror::Error;
use toile_core::ErrorCode;

/// An element with its place in the file, both counted from 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    /// Its tag, and its id where it has one.
    pub element: String,
    pub line: u32,
    pub column: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (line {} column {})", self.element, self.line, self.column)
    }
}

/// Why a file is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum Damage {
    #[error("it is a compressed SVG")]
    Compressed,
    #[error("it is not UTF-8 text")]
    Encoding,
    #[error("it has {bytes} bytes, {most} are the most")]
    Large { bytes: usize, most: usize },
    #[error("it has more than {most} {what}")]
    Many { what: &'static str, most: usize },
    #[error("it is no XML at line {line} column {column}: {what}")]
    Xml { what: String, line: u32, column: u32 },
    #[error("its first element is \"{tag}\", not \"svg\"")]
    NotSvg { tag: String },
    #[error("{place}: \"{value}\" is no {attribute}")]
    Attribute { place: Place, attribute: &'static str, value: String },
    #[error("{place}: it uses itself")]
    Loop { place: Place },
    #[error("there are no pieces: it holds no closed line of a garment's size")]
    NoPieces,
    #[error("there are no pieces: it holds text alone")]
    TextAlone,
    #[error("there are no pieces: it holds a picture of pixels alone")]
    PictureAlone,
    #[error(
        "piece \"{piece}\", {place}: its outline is open by {gap_mm:.1} mm near ({x:.1}, {y:.1}) mm on the page"
    )]
    Open { piece: String, place: Place, gap_mm: f64, x: f64, y: f64 },
    #[error("piece \"{piece}\", {place}: its outline crosses itself near ({x:.1}, {y:.1}) mm on the page")]
    Crosses { piece: String, place: Place, x: f64, y: f64 },
    #[error("piece \"{piece}\", {place}: the fold does not lie along an edge of its outline")]
    Fold { piece: String, place: Place },
    #[error("piece \"{piece}\", {place}: {what}")]
    Piece { piece: String, place: Place, what: &'static str },
    #[error("{what}")]
    Size { what: String, remedy: String },
    #[error("{what}")]
    Unsewable { what: String, remedy: String },
}

impl Damage {
    /// What the user may do about it.
    pub(super) fn remedy(&self) -> String {
        match self {
            Damage::Compressed => "save it as plain SVG, not as svgz".into(),
            Damage::Encoding => "save it as UTF-8".into(),
            Damage::Large { .. } | Damage::Many { .. } => "save the pieces alone, or fewer at a time".into(),
            Damage::Xml { .. } => "save the file again as plain SVG".into(),
            Damage::NotSvg { .. } => "give a file that was saved as SVG".into(),
            Damage::Attribute { .. } => "draw the element again, or take it out".into(),
            Damage::Loop { .. } => "unlink the clone, or take it out".into(),
            Damage::NoPieces => {
                "draw every piece as a closed line, or as lines that meet end to end, in a group of its own"
                    .into()
            }
            Damage::TextAlone => "turn no outlines into text: export the pieces as paths".into(),
            Damage::PictureAlone => "trace the picture: pieces are read from paths".into(),
            Damage::Open { .. } | Damage::Crosses { .. } | Damage::Piece { .. } => {
                "draw the outline as one closed line that meets itself nowhere".into()
            }
            Damage::Fold { .. } => "let the line called fold run along a straight edge of the outline".into(),
            Damage::Size { remedy, .. } | Damage::Unsewable { remedy, .. } => remedy.clone(),
        }
    }

    /// As a fault of the file.
    pub(super) fn fault(&self) -> Fault {
        let code = match self {
            Damage::Crosses { .. } => ErrorCode::DegenerateTriangles,
            Damage::Compressed
            | Damage::Encoding
            | Damage::Large { .. }
            | Damage::Many { .. }
            | Damage::Xml { .. }
            | Damage::NotSvg { .. }
            | Damage::Attribute { .. }
            | Damage::Loop { .. }
            | Damage::NoPieces
            | Damage::TextAlone
            | Damage::PictureAlone
            | Damage::Open { .. }
            | Damage::Fold { .. }
            | Damage::Piece { .. }
            | Damage::Size { .. }
            | Damage::Unsewable { .. } => ErrorCode::PatternLoading,
        };
        Fault { code, param: "file", what: self.to_string(), remedy: Some(self.remedy()) }
    }
}
