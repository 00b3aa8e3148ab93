//! Whole stages swapped and added.

use super::{fault, own_line};
use crate::load::fault::Fault;
use crate::load::overrides::NEXT;
use crate::load::qualities::named;
use crate::load::read::{self, FileContents, GENERIC};
use crate::load::syntax::cut::comma_after;
use crate::load::syntax::draft::Draft;
use crate::load::syntax::tree::{GroupEntry, ValueShape, ValueTree};
use crate::load::{Override, parse};
use toile_core::Registry;

/// The text with another stage in a stage's place.
pub(super) fn swapped(
    text: &str,
    tree: &ValueTree,
    registry: &Registry,
    stage: &str,
    with: &str,
) -> Result<String, Box<Fault>> {
    let read = read::file(text, tree, (registry, false), &mut Vec::new());
    let all = || read.sections.iter().filter(|d| !d.is_table).chain(&read.stages);
    let Some(old) = all().find(|d| d.id == stage) else {
        let ids: Vec<&str> = all().map(|d| d.id.as_str()).collect();
        return Err(no_stage("the file", stage, &ids));
    };
    let new = StageText::of(with)?;
    let mut kept = Vec::new();
    if !new.gives("id") && (old.given_id.is_some() || is_named(text, &read, old)) && new.name != old.id {
        kept.push(format!("id: {:?}", old.id));
    }
    if let ([(first, _), ..], false) = (old.from.as_slice(), new.gives("from")) {
        let all: Vec<String> = old.from.iter().map(|(id, _)| format!("{id:?}")).collect();
        kept.push(match old.from.len() {
            1 => format!("from: {first:?}"),
            _ => format!("from: [{}]", all.join(", ")),
        });
    }
    let mut out = text.to_owned();
    out.replace_range(old.span.clone(), &new.with(&kept, registry));
    Ok(out)
}

/// Whether a stage or a quality names a stage by its id.
fn is_named(text: &str, read: &FileContents, draft: &Draft) -> bool {
    let of = |o: &Override| o.path.split('.').nth(1) == Some(&draft.id) && o.path.starts_with("stages.");
    let by_stage =
        read.sections.iter().chain(&read.stages).flat_map(|d| &d.from).any(|(id, _)| *id == draft.id);
    by_stage || named(text).iter().any(|quality| quality.set.iter().any(of))
}

/// The text with one stage more in its list.
pub(super) fn added(
    text: &str,
    tree: &ValueTree,
    registry: &Registry,
    stage: &str,
    after: Option<&str>,
) -> Result<String, Box<Fault>> {
    let new = StageText::of(stage)?.with(&[], registry);
    let Some(ValueShape::Group { inside, entries, .. }) =
        tree.entry(text, "stages").map(|entry| &entry.value.shape)
    else {
        return Err(fault("the file has no list of `stages`"));
    };
    let before = match after {
        None => entries.last(),
        Some(id) => {
            let read = read::file(text, tree, (registry, false), &mut Vec::new());
            if read.sections.iter().any(|d| d.id == id) {
                return Ok(insert_first(text, *inside, entries, &new));
            }
            let found = read.stages.iter().find(|d| d.id == id);
            let found = found.and_then(|d| entries.iter().find(|e| e.value.span == d.span));
            let ids: Vec<&str> = read.stages.iter().map(|d| d.id.as_str()).collect();
            Some(found.ok_or_else(|| no_stage("the list of `stages`", id, &ids))?)
        }
    };
    let mut out = text.to_owned();
    match before {
        None => out.insert_str(*inside, &new),
        Some(entry) => insert_after(&mut out, entry, &new),
    }
    Ok(out)
}

/// Puts a stage before all others of the list.
fn insert_first(text: &str, inside: usize, entries: &[GroupEntry], new: &str) -> String {
    let mut out = text.to_owned();
    match own_line(text, inside) {
        Some((at, indent)) if !entries.is_empty() => out.insert_str(at, &format!("{indent}{new},\n")),
        _ => out.insert_str(inside, &format!("{new}{}", if entries.is_empty() { "" } else { NEXT })),
    }
    out
}

/// Puts a stage behind another: on the next line where that one has a line of its own, else beside
/// it.
fn insert_after(text: &mut String, entry: &GroupEntry, new: &str) {
    let (start, end) = (entry.value.span.start, entry.value.span.end);
    let comma = comma_after(text, end);
    let line = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let indent = text[line..start].to_owned();
    let rest = text[comma.unwrap_or(end)..].find('\n').map(|n| comma.unwrap_or(end) + n);
    let ends = rest.filter(|at| {
        let rest = text[comma.unwrap_or(end)..*at].trim();
        rest.is_empty() || rest.starts_with("//")
    });
    match (ends, comma) {
        (Some(at), _) if indent.trim().is_empty() && line > 0 => {
            text.insert_str(at + 1, &format!("{indent}{new},\n"));
            if comma.is_none() {
                text.insert(end, ',');
            }
        }
        (_, Some(comma)) => text.insert_str(comma, &format!(" {new},")),
        (_, None) => text.insert_str(end, &format!(", {new}")),
    }
}

fn no_stage(place: &str, id: &str, ids: &[&str]) -> Box<Fault> {
    let near = toile_core::nearest(id, ids.iter().copied()).map(|near| format!("did you mean `{near}`?"));
    let list = (!ids.is_empty()).then(|| format!("there is {}", toile_core::quoted(ids)));
    Box::new(fault(format!("{place} has no stage `{id}`")).hint(near.or(list)))
}

/// A stage as a user writes it: `Otsu(bias: 3)`, or `Otsu` alone.
struct StageText<'a> {
    text: &'a str,
    name: &'a str,
    /// The byte after its bracket; none where it has none.
    inside: Option<usize>,
    /// The names of its arguments; none for one without.
    keys: Vec<Option<&'a str>>,
}

impl<'a> StageText<'a> {
    fn of(text: &'a str) -> Result<Self, Box<Fault>> {
        let no_stage =
            || Box::new(fault(format!("`{text}` is no stage")).hint("write `Name(field: value)`".to_owned()));
        let tree = parse(text).map_err(|_| no_stage())?;
        let own = &text[tree.span.clone()];
        let at = |span: &std::ops::Range<usize>| text.get(span.clone()).unwrap_or("");
        match &tree.shape {
            ValueShape::Name => Ok(StageText { text: own, name: own, inside: None, keys: Vec::new() }),
            ValueShape::Group { name: Some(name), inside, entries, .. } => Ok(StageText {
                text: own,
                name: at(name),
                inside: Some(inside - tree.span.start),
                keys: entries.iter().map(|e| e.key.as_ref().map(at)).collect(),
            }),
            _ => Err(no_stage()),
        }
    }

    fn gives(&self, key: &str) -> bool {
        self.keys.contains(&Some(key))
    }

    /// The stage with more arguments, which come first.
    fn with(&self, more: &[String], registry: &Registry) -> String {
        let Some(inside) = self.inside else { return format!("{}({})", self.name, more.join(", ")) };
        if more.is_empty() {
            return self.text.to_owned();
        }
        let first =
            registry.named(self.name).find_map(|card| card.params.first()).map_or(GENERIC[0], |p| p.name);
        let more = more.join(", ");
        let joint = match self.keys.as_slice() {
            [] => more,
            // The one value without a name gets its name.
            [None] => format!("{more}, {first}: "),
            _ => format!("{more}, "),
        };
        format!("{}{joint}{}", &self.text[..inside], &self.text[inside..])
    }
}
