//! Where in a pipeline's text a stage's error belongs.

use super::fault::{Fault, Faults};
use super::{Pipeline, parse};
use std::ops::Range;
use toile_core::{Node, StageError};

impl Pipeline {
    /// Puts a stage's error at its place in the file: at the element or parameter that it names, if
    /// the file gives it, else at the stage.
    pub fn locate(&self, node: &Node, error: &StageError) -> Faults {
        self.faults(vec![self.fault(node, error)])
    }

    /// The same as one fault of the text with its overrides.
    pub(crate) fn fault(&self, node: &Node, error: &StageError) -> Fault {
        let place = self.given(node, error).unwrap_or_else(|| node.place.clone());
        let message = format!("{}: {}", node.id, error.message);
        Fault::new(error.code.as_str(), message).at(&place, "").hint(error.hint.clone())
    }

    /// The place of the value that an error names, as deep as the file has it; none where the file
    /// gives no such parameter.
    pub(crate) fn given(&self, node: &Node, error: &StageError) -> Option<Range<usize>> {
        let span = node.params.get(error.param?)?;
        let value = self.text.get(span.clone())?;
        let Ok(mut tree) = parse(value) else { return Some(span.clone()) };
        for key in &error.path {
            match tree.entry(value, key) {
                Some(entry) => tree = entry.value.clone(),
                None => break,
            }
        }
        Some(span.start + tree.span.start..span.start + tree.span.end)
    }
}
