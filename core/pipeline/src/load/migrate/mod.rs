//! Old pipeline files: what was renamed or removed since they were written, and how a file is
//! brought up to date.
//!
//! A stage's crate lists every such change beside its registration,
//! `registry.migrate(Migration::renamed(...))`, for good: the number of changes is the version of
//! the stage's parameters. A parameter whose meaning changes gets a new name, so that a file needs
//! no version of its own: an old name says what it meant.
//!
//! A file is rewritten by edits of its text at the places that the syntax tree knows, so that
//! comments, order and layout stay. The settings of its named qualities are rewritten as well
//! (`qualities`). Cost: linear in the text for each rewritten argument. Limits: a value is
//! converted as text; what a change cannot convert is left, and the load names it.
//!
//! - [`Migration`](toile_core::Migration): what a crate lists; `old_name` (beside this): what the
//!   load says; `rewrite`, `qualities`: what becomes of the text.

mod qualities;
mod rewrite;
#[cfg(test)]
mod tests;

use super::fault::Faults;
use super::read::FileContents;
use super::{parse, read};
use crate::load::syntax::draft::Draft;
use crate::load::syntax::tree::{GroupEntry, ValueTree};
use rewrite::Migrator;
use std::ops::Range;
use toile_core::Registry;

/// A file brought up to date.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Migrated {
    /// The new text; the old one where nothing had to change.
    pub text: String,
    /// What was changed, `line 12: stage LaplacianEdges -> Laplacian`, in the order of the text.
    pub changes: Vec<String>,
}

/// Rewrites a pipeline's text to the names that stages and parameters have now.
///
/// Errors: the text is no RON, or gives a parameter under its old name and its new one.
pub fn migrate(text: &str, file: &str, registry: &Registry) -> Result<Migrated, Faults> {
    let tree = parse(text).map_err(|fault| Faults::new(file, text, vec![fault]))?;
    let drafts = read::file(text, &tree, (registry, false), &mut Vec::new());
    let mut m = Migrator { text, registry, edits: Vec::new(), faults: Vec::new() };
    for draft in drafts.sections.iter().chain(&drafts.stages).filter(|d| !d.is_table) {
        if let Some(stage) = find(&tree, &draft.span) {
            let keeps_id = is_read_from(draft, &drafts) && draft.given_id.is_none();
            m.stage(stage, keeps_id.then_some(draft.id.as_str()));
        }
    }
    m.qualities(&tree, &drafts);
    match m.faults.is_empty() {
        true => Ok(m.finish()),
        false => Err(Faults::new(file, text, m.faults)),
    }
}

/// Whether another stage names a stage by its id.
fn is_read_from(draft: &Draft, drafts: &FileContents) -> bool {
    drafts.stages.iter().flat_map(|d| &d.from).any(|(id, _)| *id == draft.id)
}

/// The value at a place.
fn find<'t>(tree: &'t ValueTree, span: &Range<usize>) -> Option<&'t ValueTree> {
    if tree.span == *span {
        return Some(tree);
    }
    let inside = |t: &&GroupEntry| t.value.span.start <= span.start && span.end <= t.value.span.end;
    find(&tree.entries().iter().find(inside)?.value, span)
}
