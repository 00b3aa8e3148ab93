//! What may be wrong with an SVG file beyond repair.

use super::super::faults::PatternFault;
use super::super::letters::LettersFault;
use std::fmt;
use thiserror::Error;
use toile_core::ErrorCode;

/// An element with its place in the file, both counted from 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SvgPlace {
    /// Its tag, and its id where it has one.
    pub element: String,
    pub line: u32,
    pub column: u32,
}

impl fmt::Display for SvgPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (line {} column {})", self.element, self.line, self.column)
    }
}

/// Why a file is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum SvgDamage {
    #[error("it is a compressed SVG")]
    Compressed,
    #[error("it is not UTF-8 text")]
    Encoding,
    #[error(transparent)]
    Letters(LettersFault),
    #[error("it says that it is in \"{name}\", which is not so")]
    SaidEncoding { name: String },
    #[error("no layer and no group is called \"{size}\"")]
    NoSize { size: String, known: Vec<String> },
    #[error("it has {bytes} bytes, {most} are the most")]
    Large { bytes: usize, most: usize },
    #[error("it has more than {most} {what}")]
    Many { what: &'static str, most: usize },
    #[error("it is no XML at line {line} column {column}: {what}")]
    Xml { what: String, line: u32, column: u32 },
    #[error("its first element is \"{tag}\", not \"svg\"")]
    NotSvg { tag: String },
    #[error("{place}: \"{value}\" is no {attribute}")]
    Attribute { place: SvgPlace, attribute: &'static str, value: String },
    #[error("{place}: it uses itself")]
    Loop { place: SvgPlace },
    #[error("there are no pieces: it holds no closed line of a garment's size")]
    NoPieces,
    #[error("there are no pieces: it holds text alone")]
    TextAlone,
    #[error("there are no pieces: it holds a picture of pixels alone")]
    PictureAlone,
    #[error(
        "piece \"{piece}\", {place}: its outline is open by {gap_mm:.1} mm near ({x:.1}, {y:.1}) mm on the page"
    )]
    Open { piece: String, place: SvgPlace, gap_mm: f64, x: f64, y: f64 },
    #[error("piece \"{piece}\", {place}: its outline crosses itself near ({x:.1}, {y:.1}) mm on the page")]
    Crosses { piece: String, place: SvgPlace, x: f64, y: f64 },
    #[error("piece \"{piece}\", {place}: the fold does not lie along an edge of its outline")]
    Fold { piece: String, place: SvgPlace },
    #[error("piece \"{piece}\", {place}: {what}")]
    Piece { piece: String, place: SvgPlace, what: &'static str },
    #[error("{what}")]
    Size { what: String, remedy: String },
    #[error("{what}")]
    Unsewable { what: String, remedy: String },
}

impl SvgDamage {
    /// What the user may do about it.
    pub(super) fn remedy(&self) -> String {
        match self {
            SvgDamage::Compressed => "save it as plain SVG, not as svgz".into(),
            SvgDamage::Encoding | SvgDamage::SaidEncoding { .. } => {
                "save it as UTF-8, or say its encoding, such as `--set 'pattern.encoding=\"windows-1252\"'`".into()
            }
            SvgDamage::Letters(fault) => fault.remedy(),
            SvgDamage::NoSize { known, .. } if known.is_empty() => {
                "it has no layers or groups with names: draw each size in a layer that is called like it, or leave `size` out".into()
            }
            SvgDamage::NoSize { known, .. } => format!("there are {}", known.join(", ")),
            SvgDamage::Large { .. } | SvgDamage::Many { .. } => {
                "save the pieces alone, or fewer at a time".into()
            }
            SvgDamage::Xml { .. } => "save the file again as plain SVG".into(),
            SvgDamage::NotSvg { .. } => "give a file that was saved as SVG".into(),
            SvgDamage::Attribute { .. } => "draw the element again, or take it out".into(),
            SvgDamage::Loop { .. } => "unlink the clone, or take it out".into(),
            SvgDamage::NoPieces => {
                "draw every piece as a closed line, or as lines that meet end to end, in a group of its own"
                    .into()
            }
            SvgDamage::TextAlone => "turn no outlines into text: export the pieces as paths".into(),
            SvgDamage::PictureAlone => "trace the picture: pieces are read from paths".into(),
            SvgDamage::Open { .. } | SvgDamage::Crosses { .. } | SvgDamage::Piece { .. } => {
                "draw the outline as one closed line that meets itself nowhere".into()
            }
            SvgDamage::Fold { .. } => {
                "let the line called fold run along a straight edge of the outline".into()
            }
            SvgDamage::Size { remedy, .. } | SvgDamage::Unsewable { remedy, .. } => remedy.clone(),
        }
    }

    /// As a fault of the file.
    pub(super) fn fault(&self) -> PatternFault {
        let code = match self {
            SvgDamage::Crosses { .. } => ErrorCode::DegenerateTriangles,
            SvgDamage::Letters(_) | SvgDamage::NoSize { .. } => ErrorCode::InvalidParameter,
            SvgDamage::Compressed
            | SvgDamage::Encoding
            | SvgDamage::SaidEncoding { .. }
            | SvgDamage::Large { .. }
            | SvgDamage::Many { .. }
            | SvgDamage::Xml { .. }
            | SvgDamage::NotSvg { .. }
            | SvgDamage::Attribute { .. }
            | SvgDamage::Loop { .. }
            | SvgDamage::NoPieces
            | SvgDamage::TextAlone
            | SvgDamage::PictureAlone
            | SvgDamage::Open { .. }
            | SvgDamage::Fold { .. }
            | SvgDamage::Piece { .. }
            | SvgDamage::Size { .. }
            | SvgDamage::Unsewable { .. } => ErrorCode::PatternLoading,
        };
        let param = match self {
            SvgDamage::Letters(_) => "encoding",
            SvgDamage::NoSize { .. } => "size",
            _ => "file",
        };
        PatternFault { code, param, what: self.to_string(), remedy: Some(self.remedy()) }
    }
}
