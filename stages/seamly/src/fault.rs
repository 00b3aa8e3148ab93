//! What may be wrong with a pattern, its measurements or its formulas.

use std::fmt;
use thiserror::Error;

/// Where a tool stands in a pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ToolPlace {
    /// The name of its draft block; empty for increments.
    pub block: String,
    /// What it is called in the file: `tool 12 "A3" (endLine)`, `increment "#ease"`.
    pub tool: String,
    /// Its line in the file, counted from 1.
    pub line: u32,
}

impl fmt::Display for ToolPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.block.is_empty() {
            write!(f, "block \"{}\", ", self.block)?;
        }
        write!(f, "{} (line {})", self.tool, self.line)
    }
}

/// Why a pattern is refused, with its place.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SeamlyFault {
    /// Bytes that are no text.
    #[error("it is not UTF-8 text")]
    Encoding,
    /// More than is read.
    #[error("it has {bytes} bytes, {most} are the most")]
    Large {
        /// Bytes that it has.
        bytes: usize,
        /// The most.
        most: usize,
    },
    /// More of something than is read.
    #[error("it has more than {most} {what}")]
    Many {
        /// What there is too much of.
        what: &'static str,
        /// The most.
        most: usize,
    },
    /// Text that is no XML.
    #[error("it is no XML at line {line} column {column}: {what}")]
    Xml {
        /// What is wrong.
        what: String,
        /// The line, from 1.
        line: u32,
        /// The column, from 1.
        column: u32,
    },
    /// XML of something else.
    #[error("its first element is \"{tag}\", not \"{expected}\"")]
    Root {
        /// What it is.
        tag: String,
        /// What it should be.
        expected: &'static str,
    },
    /// Measurements in the form of Valentina before 0.3.
    #[error("its measurements are in the form of version {version}, which Valentina wrote before 2015")]
    OldMeasurements {
        /// The version of the form.
        version: String,
    },
    /// A unit that is none of the three.
    #[error("its unit is \"{word}\", which is none of mm, cm and inch")]
    Unit {
        /// What it says.
        word: String,
    },
    /// A size that the measurements do not have.
    #[error("the measurements have no {what} {asked}: it goes from {least} to {most}")]
    Size {
        /// The size or the height.
        what: &'static str,
        /// What is asked for.
        asked: f64,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
    /// A size is asked for, and the measurements are of one person, or there are none.
    #[error("a {what} is asked for, but the measurements have one size")]
    OneSize {
        /// The size or the height.
        what: &'static str,
    },
    /// An attribute that a tool needs and does not have.
    #[error("{place}: it has no \"{attribute}\"")]
    Lacking {
        /// The tool.
        place: ToolPlace,
        /// What it lacks.
        attribute: String,
    },
    /// An attribute that is no number.
    #[error("{place}: its \"{attribute}\" is \"{value}\", which is no number")]
    Number {
        /// The tool.
        place: ToolPlace,
        /// The attribute.
        attribute: String,
        /// What it is.
        value: String,
    },
    /// A formula that cannot be read.
    #[error(
        "{place}: the formula of its \"{attribute}\" is wrong at character {at}: {what} in \"{formula}\""
    )]
    Formula {
        /// The tool.
        place: ToolPlace,
        /// The attribute.
        attribute: String,
        /// The formula.
        formula: String,
        /// The character, from 1.
        at: usize,
        /// What is wrong.
        what: String,
    },
    /// A formula without a value, such as a division by nought.
    #[error("{place}: the formula of its \"{attribute}\" has no finite value: \"{formula}\"")]
    Infinite {
        /// The tool.
        place: ToolPlace,
        /// The attribute.
        attribute: String,
        /// The formula.
        formula: String,
    },
    /// A formula that names what there is none of.
    #[error("{place}: there is no {what} \"{name}\" for its \"{attribute}\", which is \"{formula}\"")]
    Unknown {
        /// The tool.
        place: ToolPlace,
        /// The attribute.
        attribute: String,
        /// The formula.
        formula: String,
        /// What it is by its name: a measurement, an increment, a length or angle of the draft.
        what: &'static str,
        /// Its name.
        name: String,
        /// Whether any measurements were read.
        measured: bool,
        /// Names that there are.
        known: Vec<String>,
    },
    /// Increments or measurements that need each other.
    #[error("{place}: {}", ring(names))]
    Cycle {
        /// Where it was met.
        place: ToolPlace,
        /// The names, each needing the next, the last the first.
        names: Vec<String>,
    },
    /// A measurement whose own formula is wrong.
    #[error("{place}: the measurement \"{name}\" has no value: {what}")]
    Measurement {
        /// Where it was needed.
        place: ToolPlace,
        /// Its name.
        name: String,
        /// What is wrong.
        what: String,
    },
    /// An object that there is none of, or that stands behind what uses it.
    #[error("{place}: its \"{attribute}\" is object {id}, {}", if *later { "which stands after it" } else { "which there is none of" })]
    Reference {
        /// The tool.
        place: ToolPlace,
        /// The attribute.
        attribute: String,
        /// The object.
        id: u32,
        /// Whether the file has it further down.
        later: bool,
    },
    /// An object of another kind than the tool needs.
    #[error("{place}: its \"{attribute}\" is object {id}, which is no {expected}")]
    Kind {
        /// The tool.
        place: ToolPlace,
        /// The attribute.
        attribute: String,
        /// The object.
        id: u32,
        /// What it should be.
        expected: &'static str,
    },
    /// A tool that is not known here.
    #[error("{place}: the tool is not supported")]
    Unsupported {
        /// The tool.
        place: ToolPlace,
    },
    /// A construction without a result.
    #[error("{place}: {what}")]
    Impossible {
        /// The tool.
        place: ToolPlace,
        /// Why there is none.
        what: &'static str,
    },
    /// A piece that is none.
    #[error("{place}: {what}")]
    Piece {
        /// The piece.
        place: ToolPlace,
        /// What is wrong with it.
        what: &'static str,
    },
    /// A pattern of draft blocks alone.
    #[error("there are no pieces: it holds draft blocks alone")]
    NoPieces,
}

/// A ring of names in words.
fn ring(names: &[String]) -> String {
    match names {
        [first, inner @ .., _] if !inner.is_empty() => {
            format!("\"{first}\" needs itself, by way of \"{}\"", inner.join("\", \""))
        }
        [first, ..] => format!("\"{first}\" needs itself"),
        [] => "it needs itself".to_owned(),
    }
}

impl SeamlyFault {
    /// What can be done about it.
    pub fn remedy(&self) -> String {
        match self {
            SeamlyFault::Encoding => "save it as UTF-8".into(),
            SeamlyFault::Large { .. } | SeamlyFault::Many { .. } => {
                "save the pieces in several files, or take out pictures".into()
            }
            SeamlyFault::Xml { .. } => "save it again in Seamly2D or Valentina".into(),
            SeamlyFault::Root { expected, .. } => format!("give a file of Seamly2D or Valentina: {expected}"),
            SeamlyFault::OldMeasurements { .. } => {
                "open the measurements in SeamlyMe or Tape and save them".into()
            }
            SeamlyFault::Unit { .. } => "set the unit in Seamly2D or Valentina".into(),
            SeamlyFault::Size { what, least, .. } => {
                format!("`--set pattern.{what}={least}` takes the least")
            }
            SeamlyFault::OneSize { what } => {
                format!("leave `{what}` out, or name a file of several sizes as `measurements`")
            }
            SeamlyFault::Lacking { .. } | SeamlyFault::Number { .. } => {
                "delete the tool in Seamly2D or Valentina and draw it again".into()
            }
            SeamlyFault::Formula { .. } | SeamlyFault::Infinite { .. } => {
                "correct the formula in Seamly2D or Valentina".into()
            }
            SeamlyFault::Unknown { measured: false, what: "measurement", .. } => {
                "give the file with the measurements: `--set 'pattern.measurements=\"body.smis\"'`".into()
            }
            SeamlyFault::Unknown { what: "measurement", name, .. } => {
                format!("add \"{name}\" to the measurements in SeamlyMe or Tape")
            }
            SeamlyFault::Unknown { .. } => "correct the name in the formula".into(),
            SeamlyFault::Cycle { .. } => "give one of them a number instead of a formula".into(),
            SeamlyFault::Measurement { .. } => "correct the measurement in SeamlyMe or Tape".into(),
            SeamlyFault::Reference { .. } | SeamlyFault::Kind { .. } => {
                "open it in Seamly2D or Valentina, which names the same object, and delete the tool".into()
            }
            SeamlyFault::Unsupported { .. } => {
                "draw its result with points and curves, or export the pieces as DXF and read them with \
                 `DxfPattern`"
                    .into()
            }
            SeamlyFault::Impossible { .. } => {
                "correct the tool in Seamly2D or Valentina, or give the measurements that the pattern was \
                 drawn for"
                    .into()
            }
            SeamlyFault::Piece { .. } => "draw the piece again: its nodes follow each other around it".into(),
            SeamlyFault::NoPieces => "make pieces of the draft in Seamly2D or Valentina".into(),
        }
    }
}
