//! What may be wrong with a GarmentCode file beyond repair: one list, each with its place and what
//! to do.

use super::super::faults::PatternFault;
use thiserror::Error;
use toile_core::{ErrorCode, nearest};

/// Why a file is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum SpecificationDamage {
    #[error("it is empty")]
    Empty,
    #[error("it is text of 16 bits a letter (UTF-16)")]
    Wide,
    #[error("a comment stands at line {line} column {column}")]
    Comment { line: usize, column: usize },
    #[error("it is no JSON: {what} at line {line} column {column}")]
    Syntax { what: String, line: usize, column: usize },
    #[error("{word} at line {line} column {column} is no number")]
    NoNumber { word: &'static str, line: usize, column: usize },
    #[error("it has {bytes} bytes, {most} are the most")]
    Large { bytes: usize, most: usize },
    #[error("{of} has {count} {what}, {most} are the most")]
    Many { what: &'static str, of: String, count: usize, most: usize },
    #[error("{of} has no `{field}`")]
    Missing { field: String, of: String },
    #[error("{at} is {found}, {wanted} is wanted")]
    Type { at: String, found: &'static str, wanted: &'static str },
    #[error("there are no panels")]
    NoPanels,
    #[error("two panels are called \"{panel}\"")]
    Doubled { panel: String },
    #[error("`panel_order` names the panel \"{panel}\", which is missing")]
    MissingPanel { panel: String },
    #[error("`units_in_meter` is {value}, it must be above 0 and at most 1e6")]
    Units { value: f64 },
    #[error("`curvature_coords` is \"{word}\", it is \"relative\" or \"absolute\"")]
    Coordinates { word: String },
    #[error("{at} is {value}, beyond what cloth reaches")]
    Far { at: String, value: f64 },
    #[error("panel \"{panel}\" has {edges} edges, 2 are the least")]
    FewEdges { panel: String, edges: usize },
    #[error("edge {edge} of panel \"{panel}\" names vertex {vertex}, the panel has {count}")]
    NoVertex { panel: String, edge: usize, vertex: f64, count: usize },
    #[error(
        "edge {edge} of panel \"{panel}\" has the curvature \"{kind}\" with {params} parameters, which is none"
    )]
    Curvature { panel: String, edge: usize, kind: String, params: usize },
    #[error("edge {edge} of panel \"{panel}\" has no length and is stitched")]
    NoLength { panel: String, edge: usize },
    #[error(
        "a control point of edge {edge} of panel \"{panel}\" lies {times:.0} times the edge's length away from it"
    )]
    Overshoot { panel: String, edge: usize, times: f64 },
    #[error("the radius of edge {edge} of panel \"{panel}\" is {radius}")]
    Radius { panel: String, edge: usize, radius: f64 },
    #[error(
        "the loop of panel \"{panel}\" is open: edge {edge} ends {gap_mm:.1} mm from where edge {next} starts"
    )]
    Open { panel: String, edge: usize, next: usize, gap_mm: f64 },
    #[error(
        "panel \"{panel}\" crosses itself: edge {edge} meets edge {other} near ({x:.1}, {y:.1}) in the file's units"
    )]
    Crosses { panel: String, edge: usize, other: usize, x: f64, y: f64 },
    #[error("panel \"{panel}\" encloses no area")]
    NoArea { panel: String },
    #[error("stitch {stitch} has {sides} sides, 2 are wanted")]
    Sides { stitch: usize, sides: usize },
    #[error("stitch {stitch} ends with \"{word}\", which is no word of the format")]
    Word { stitch: usize, word: String },
    #[error("stitch {stitch} sews panel \"{panel}\", which the file does not have")]
    NoPanel { stitch: usize, panel: String, known: Vec<String> },
    #[error("stitch {stitch} sews edge {edge} of panel \"{panel}\", which has {count} edges")]
    NoEdge { stitch: usize, panel: String, edge: f64, count: usize },
    #[error("stitch {stitch} sews edge {edge} of panel \"{panel}\" to itself")]
    Itself { stitch: usize, panel: String, edge: usize },
    #[error("stitches {stitch} and {other} sew the same edges in opposite directions")]
    Contradiction { stitch: usize, other: usize },
    #[error("stitches {stitch} and {other} are mirror images of each other and run in opposite ways")]
    Opposed { stitch: usize, other: usize },
    #[error("{count} stitches of panel \"{panel}\" run against the way in which it is placed")]
    Turned { panel: String, count: usize },
    #[error("edge {edge} of panel \"{panel}\" is sewn by stitch {stitch} and by stitch {other}")]
    Shared { panel: String, edge: usize, stitch: usize, other: usize },
    #[error("`{field}` stands twice in {of}")]
    Twice { field: String, of: String },
    #[error("{what}")]
    Unsewable { what: String, remedy: &'static str },
}

impl SpecificationDamage {
    /// What the user may do about it.
    pub(super) fn remedy(&self) -> String {
        match self {
            SpecificationDamage::Empty => "give the file that GarmentCode wrote, a `_specification.json`".into(),
            SpecificationDamage::Wide => "save it as UTF-8".into(),
            SpecificationDamage::Comment { .. } => "JSON has no comments: take it out".into(),
            SpecificationDamage::Syntax { .. } => "write the file again with the program that made it".into(),
            SpecificationDamage::NoNumber { .. } => "give the number that is meant; JSON knows no such word".into(),
            SpecificationDamage::Large { .. } | SpecificationDamage::Many { .. } => "no garment needs so many: is it the file that is meant?".into(),
            SpecificationDamage::Type { wanted, .. } => format!("write {wanted} there, as GarmentCode does"),
            SpecificationDamage::Missing { .. } => {
                "GarmentCode writes `pattern` with `panels` and `stitches`, and `properties`; is it a `_specification.json`?".into()
            }
            SpecificationDamage::NoPanels => "draft the garment again; an empty pattern cannot be sewn".into(),
            SpecificationDamage::Doubled { .. } => "give each panel a name of its own".into(),
            SpecificationDamage::MissingPanel { .. } => "add the panel, or take its name out of `panel_order`".into(),
            SpecificationDamage::Units { .. } => "write 100 for centimetres".into(),
            SpecificationDamage::Coordinates { .. } => "GarmentCode writes \"relative\"".into(),
            SpecificationDamage::Far { .. } => "correct the number, or `units_in_meter`".into(),
            SpecificationDamage::FewEdges { .. } => "draw the panel as a closed loop of edges".into(),
            SpecificationDamage::NoVertex { .. } => "vertices are counted from 0".into(),
            SpecificationDamage::Curvature { .. } => {
                "`quadratic` has 1 control point, `cubic` 2, `circle` a radius and two flags".into()
            }
            SpecificationDamage::NoLength { .. } => "draw the edge, or take its stitch out".into(),
            SpecificationDamage::Overshoot { .. } => {
                "correct the control point; where it is meant in the panel's coordinates, write \"absolute\" as `curvature_coords`".into()
            }
            SpecificationDamage::Radius { .. } => "give a radius above 0; the flags say to which side the arc turns".into(),
            SpecificationDamage::Open { .. } => "close the loop: gaps of up to 5 mm are closed by themselves".into(),
            SpecificationDamage::Crosses { .. } | SpecificationDamage::NoArea { .. } => "draw the panel so that its edges meet at corners alone".into(),
            SpecificationDamage::Sides { .. } => "a stitch names two edges".into(),
            SpecificationDamage::Word { .. } => "the only word is \"right_wrong\"".into(),
            SpecificationDamage::NoPanel { panel, known, .. } => match nearest(panel, known.iter().map(String::as_str)) {
                Some(near) => format!("add the panel, or take the stitch out; or did you mean \"{near}\"?"),
                None => "add the panel, or take the stitch out".into(),
            },
            SpecificationDamage::NoEdge { .. } => "edges are counted from 0".into(),
            SpecificationDamage::Itself { .. } => "cut the edge in two and sew its halves".into(),
            SpecificationDamage::Contradiction { .. } => "keep the stitch that is meant".into(),
            SpecificationDamage::Opposed { .. } => "take \"right_wrong\" out of one of them, or give it to both".into(),
            SpecificationDamage::Turned { .. } => "correct the panel's `rotation`, or the stitches".into(),
            SpecificationDamage::Shared { .. } => "keep the stitch that is meant".into(),
            SpecificationDamage::Twice { .. } => "keep the one that is meant".into(),
            SpecificationDamage::Unsewable { remedy, .. } => (*remedy).into(),
        }
    }

    /// As a fault of the file.
    pub(super) fn fault(&self) -> PatternFault {
        let code = match self {
            SpecificationDamage::Crosses { .. } | SpecificationDamage::NoArea { .. } => {
                ErrorCode::DegenerateTriangles
            }
            SpecificationDamage::Empty
            | SpecificationDamage::Wide
            | SpecificationDamage::Comment { .. }
            | SpecificationDamage::Syntax { .. }
            | SpecificationDamage::NoNumber { .. }
            | SpecificationDamage::Large { .. }
            | SpecificationDamage::Many { .. }
            | SpecificationDamage::Missing { .. }
            | SpecificationDamage::Type { .. }
            | SpecificationDamage::NoPanels
            | SpecificationDamage::Doubled { .. }
            | SpecificationDamage::MissingPanel { .. }
            | SpecificationDamage::Units { .. }
            | SpecificationDamage::Coordinates { .. }
            | SpecificationDamage::Far { .. }
            | SpecificationDamage::FewEdges { .. }
            | SpecificationDamage::NoVertex { .. }
            | SpecificationDamage::Curvature { .. }
            | SpecificationDamage::NoLength { .. }
            | SpecificationDamage::Overshoot { .. }
            | SpecificationDamage::Radius { .. }
            | SpecificationDamage::Open { .. }
            | SpecificationDamage::Sides { .. }
            | SpecificationDamage::Word { .. }
            | SpecificationDamage::NoPanel { .. }
            | SpecificationDamage::NoEdge { .. }
            | SpecificationDamage::Itself { .. }
            | SpecificationDamage::Contradiction { .. }
            | SpecificationDamage::Opposed { .. }
            | SpecificationDamage::Turned { .. }
            | SpecificationDamage::Shared { .. }
            | SpecificationDamage::Twice { .. }
            | SpecificationDamage::Unsewable { .. } => ErrorCode::PatternLoading,
        };
        PatternFault { code, param: "file", what: self.to_string(), remedy: Some(self.remedy()) }
    }
}
