//! What a pattern says before its tools: its unit, the file of its measurements, its increments.

use super::draft::DraftValues;
use super::fault::{SeamlyFault, ToolPlace};
use super::measure::Grade;
use super::source::{attribute, children, line, says, short, text, tree, words};
use super::unit::LengthUnit;
use roxmltree::Node;

/// The head of a pattern.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternHead {
    /// The unit of its numbers.
    pub unit: LengthUnit,
    /// The file of its measurements as it names it, relative to its own folder.
    pub measurements: Option<String>,
    /// The size that it was left at.
    pub grade: Grade,
}

impl PatternHead {
    /// Reads the head of a pattern.
    pub fn read(bytes: &[u8]) -> Result<Self, SeamlyFault> {
        PatternHead::of(tree(text(bytes)?)?.root_element())
    }

    pub(crate) fn of(root: Node<'_, '_>) -> Result<Self, SeamlyFault> {
        let tag = root.tag_name().name();
        if tag != "pattern" {
            return Err(SeamlyFault::Root { tag: short(tag), expected: "pattern" });
        }
        let named = children(root, &["measurements"]).next();
        let path = named.and_then(|n| attribute(n, "path")).map(str::to_owned);
        let measurements = path.or_else(|| words(root, "measurements"));
        let unit = match named.and_then(|n| attribute(n, "unit")) {
            // The oldest patterns say their unit with the measurements.
            Some("mm") => LengthUnit::Millimetre,
            Some("inch") => LengthUnit::Inch,
            _ => LengthUnit::of(root)?,
        };
        let gradation = children(root, &["gradation"]).find(|n| says(*n, "custom") == Some(true));
        let figure = |name| gradation.and_then(|n| attribute(n, name))?.parse::<f64>().ok();
        let kept = [figure("defSize"), figure("defHeight")];
        Ok(PatternHead { unit, measurements, grade: Grade { kept, ..Grade::default() } })
    }
}

/// The increments of a pattern: `increments` of Valentina, `variables` of Seamly2D, and those that
/// are worked out behind the draft.
pub(crate) fn increments(root: Node<'_, '_>, values: &mut DraftValues) {
    let lists = children(root, &["increments", "variables", "previewCalculations"]);
    for node in lists.flat_map(|n| children(n, &["increment", "variable"])) {
        // The oldest increments are a number.
        let formula = attribute(node, "formula").or_else(|| attribute(node, "base"));
        if let (Some(name), Some(formula)) = (attribute(node, "name"), formula) {
            let tool = format!("increment \"{}\"", short(name));
            values.increment(name, formula, ToolPlace { block: String::new(), tool, line: line(node) });
        }
    }
}
