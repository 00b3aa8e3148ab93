//! The path of a stage for `--set` and for edits.

use crate::load::{Pipeline, parse};
use toile_core::Node;

impl Pipeline {
    /// The path of a stage: `stages.GridMesher`, `body`, `photos`; none of a stage that the file
    /// does not name.
    pub fn path_of(&self, node: &Node) -> Option<String> {
        let tree = parse(&self.text).ok()?;
        let holds = |span: &std::ops::Range<usize>| {
            span.start <= node.span.start && node.span.end <= span.end && !node.span.is_empty()
        };
        let entry = tree.entries().iter().find(|e| holds(&e.value.span))?;
        let field = self.text.get(entry.key.clone()?)?;
        Some(if field == "stages" { format!("stages.{}", node.id) } else { field.to_owned() })
    }
}
