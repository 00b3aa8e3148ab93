//! Edits of a pipeline's text as a program makes them for a user: parameters set and removed,
//! stages swapped, added and removed. Comments and layout stay.
//!
//! Paths are those of `--set`, and so is the way in which values are put in (`overrides`); a field
//! that joins a group of several lines gets a line of its own. Cost: one reading of the text for
//! each edit. Limits: nothing is checked but that the text can still be found its way in; whether
//! it is a pipeline is said by [`load`](super::load).

mod path;
mod stage;
#[cfg(test)]
mod tests;

use super::fault::Fault;
use super::overrides::{self, Given, NEXT, PathSpot};
use super::{Override, parse};
use crate::load::syntax::cut::removed;
use crate::load::syntax::tree::ValueTree;
use stage::{added, swapped};
use toile_core::Registry;

/// One edit of a pipeline's text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PipelineEdit {
    /// Puts a value at a path, as `--set` does.
    Set {
        /// `stages.GridMesher.edge`.
        path: String,
        /// A RON value: `"6 mm"` with its quotes.
        value: String,
    },
    /// Takes out a parameter, which then has its default, an entry of a list or map, a section or a
    /// whole stage.
    Remove {
        /// `stages.Canny.smooth`, `stages.Canny`.
        path: String,
    },
    /// Puts another stage into a stage's place. It keeps the place's `id` and `from` where it
    /// brings none; a stage that others name by its id keeps that, too.
    Swap {
        /// The id of a stage, in the list or in a section.
        stage: String,
        /// The other, as it is written: `GradedMesher(edge: "12 mm")`.
        with: String,
    },
    /// Adds a stage to the list.
    Add {
        /// As it is written: `PatternPdf()`.
        stage: String,
        /// The id of the stage that it follows, that of a section for the first place of the list;
        /// none for the last.
        after: Option<String>,
    },
}

/// The text after edits, each of which sees what the ones before it left; all of them or none.
///
/// The registry must know the stages of the text's plugins ([`with_plugins`](super::with_plugins)).
///
/// Errors: the first edit that cannot be made; the fault is at no place of the text.
pub fn edited(text: &str, registry: &Registry, edits: &[PipelineEdit]) -> Result<String, Box<Fault>> {
    let mut text = text.to_owned();
    for edit in edits {
        let tree = parse(&text)?;
        text = match edit {
            PipelineEdit::Set { path, value } => set(&text, &tree, registry, path, value)?,
            PipelineEdit::Remove { path } => remove(&text, &tree, registry, path)?,
            PipelineEdit::Swap { stage, with } => swapped(&text, &tree, registry, stage, with)?,
            PipelineEdit::Add { stage, after } => added(&text, &tree, registry, stage, after.as_deref())?,
        };
    }
    Ok(text)
}

/// The code of a fault of an edit.
const BAD_EDIT: &str = "bad_edit";

/// A fault of an edit, at no place of the text.
fn fault(message: impl Into<String>) -> Box<Fault> {
    Box::new(Fault::new(BAD_EDIT, message).at(&(0..0), ""))
}

/// A fault of an override in the words of an edit.
fn told(fault: Fault) -> Box<Fault> {
    Box::new(Fault::new(BAD_EDIT, fault.message).at(&(0..0), "").hint(fault.hint))
}

fn set(
    text: &str,
    tree: &ValueTree,
    registry: &Registry,
    path: &str,
    value: &str,
) -> Result<String, Box<Fault>> {
    let set = Override { path: path.to_owned(), value: value.to_owned() };
    let (edit, _) = overrides::edit(text, tree, registry, Given::set(&set)).map_err(told)?;
    let mut out = text.to_owned();
    let own = own_line(text, edit.at.start).filter(|_| edit.at.is_empty() && edit.after == NEXT);
    match own {
        Some((at, indent)) => out.insert_str(at, &format!("{indent}{}{},\n", edit.before, edit.value)),
        None => out.replace_range(edit.at, &format!("{}{}{}", edit.before, edit.value, edit.after)),
    }
    Ok(out)
}

/// Where a group that begins before `inside` has its first line, and how that is indented; none
/// where something stands in the line of its bracket.
fn own_line(text: &str, inside: usize) -> Option<(usize, &str)> {
    let (rest, after) = text.get(inside..)?.split_once('\n')?;
    if !rest.trim().is_empty() && !rest.trim_start().starts_with("//") {
        return None;
    }
    let next = after.lines().find(|line| !line.trim().is_empty())?;
    Some((inside + rest.len() + 1, &next[..next.len() - next.trim_start().len()]))
}

fn remove(text: &str, tree: &ValueTree, registry: &Registry, path: &str) -> Result<String, Box<Fault>> {
    let set = Override { path: path.to_owned(), value: String::new() };
    let found = overrides::spot(text, tree, registry, Given::set(&set)).map_err(|fault| {
        // What `--set` proposes to set is of no use here.
        let hint = fault.hint.clone().filter(|hint| !hint.starts_with("set all of it"));
        told(fault.hint(hint))
    })?;
    match found {
        PathSpot::There { entries, number } => Ok(removed(text, entries, number)),
        PathSpot::Free { .. } | PathSpot::Beside { .. } => {
            let fault = fault(format!("the file does not give `{path}`"));
            Err(Box::new(fault.hint("it has its default already".to_owned())))
        }
    }
}
