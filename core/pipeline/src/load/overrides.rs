//! `--set PATH=VALUE`: changes to a pipeline file, spliced into its text before it is loaded.
//!
//! So a value from the command line passes the same checks as one in the file. A path walks the
//! text: `photos.front.file`, `body.height`, `stages.Canny2.low`, `stages.GridMesher`. What is
//! there is replaced; a field that is not there is put in as the first of its group.

use super::fault::Fault;
use super::origin::{InsertedText, TextChanges, Writer};
use super::parse;
use super::qualities::Quality;
use super::read::{self, GENERIC};
use super::setting::Override;
use crate::load::syntax::draft::Draft;
use crate::load::syntax::tree::{Bracket, GroupEntry, ValueShape, ValueTree};
use std::ops::Range;
use toile_core::Registry;

/// An override with where it comes from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Given<'a> {
    o: &'a Override,
    /// The quality that it is of; none where it is a `--set`.
    quality: Option<&'a str>,
}

impl<'a> Given<'a> {
    /// `--set` of the command line.
    pub(super) fn set(o: &'a Override) -> Self {
        Given { o, quality: None }
    }

    /// The settings of a quality.
    pub(super) fn of_quality(quality: &'a Quality) -> impl Iterator<Item = Given<'a>> {
        quality.set.iter().map(|o| Given { o, quality: Some(&quality.name) })
    }

    /// A path with a value as the user writes it: `--set 'a.b=...'`, in a quality `a.b=...`.
    fn written(&self, path: &str, value: &str) -> String {
        match self.quality {
            Some(_) => format!("{path}={value}"),
            None => format!("--set '{path}={value}'"),
        }
    }

    /// The option as it stands on the command line, without the shell's quotes.
    fn option(&self) -> String {
        format!("{OPTION}{}={}", self.o.path, self.o.value)
    }

    fn writer(&self, value_at: usize) -> Writer {
        match self.quality {
            Some(name) => Writer::Quality(name.to_owned()),
            None => Writer::Option(self.option(), OPTION.len() + self.o.path.len() + 1 + value_at),
        }
    }

    /// A fault of the override itself, at a part of `PATH=VALUE`.
    fn fault(&self, message: &str, at: Range<usize>) -> Fault {
        match self.quality {
            Some(_) => Fault::new("bad_override", format!("`{}`: {message}", self.o.path)).at(&(0..0), ""),
            None => {
                let at = OPTION.len() + at.start..OPTION.len() + at.end;
                Fault::new("bad_override", message).at(&at, "").of_option(self.option())
            }
        }
    }
}

/// What parts a field that is put in from the next one.
pub(super) const NEXT: &str = ", ";

/// What stands before the path on the command line.
const OPTION: &str = "--set ";

/// A text with overrides applied.
#[derive(Debug, Default)]
pub(super) struct Applied {
    pub(super) text: String,
    /// Where its parts come from.
    pub(super) origin: TextChanges,
    /// Overrides that could not be applied, by number.
    pub(super) refused: Vec<(usize, Fault)>,
}

/// Applies overrides in their order.
pub(super) fn apply(text: &str, registry: &Registry, overrides: &[Given<'_>]) -> Applied {
    let mut applied = Applied { text: text.to_owned(), ..Applied::default() };
    for (i, given) in overrides.iter().enumerate() {
        // A text that is no RON is reported by the load itself.
        let Ok(tree) = parse(&applied.text) else { break };
        match edit(&applied.text, &tree, registry, *given) {
            Ok((edit, value_at)) => applied.splice(&edit, i, given.writer(value_at)),
            Err(fault) => applied.refused.push((i, fault)),
        }
    }
    applied
}

impl Applied {
    fn splice(&mut self, edit: &Edit, number: usize, writer: Writer) {
        let Edit { at, before, value, after } = edit;
        self.text.replace_range(at.clone(), &format!("{before}{value}{after}"));
        let span = at.start..at.start + before.len() + value.len();
        let region = InsertedText { span, before: before.len(), number, writer };
        self.origin.note(at, before.len() + value.len() + after.len(), region);
    }
}

/// A change of the text.
pub(super) struct Edit {
    pub(super) at: Range<usize>,
    pub(super) before: String,
    pub(super) value: String,
    pub(super) after: String,
}

impl Edit {
    fn replace(at: &Range<usize>, value: &str) -> Self {
        Edit { at: at.clone(), before: String::new(), value: value.to_owned(), after: String::new() }
    }

    /// Puts `key: value` first into a group.
    fn insert(inside: usize, entries: &[GroupEntry], key: &str, value: &str) -> Self {
        let after = if entries.is_empty() { "" } else { NEXT };
        Edit {
            at: inside..inside,
            before: format!("{key}: "),
            value: value.to_owned(),
            after: after.to_owned(),
        }
    }
}

/// The edit of the text for one override, and the offset at which the user's value begins within
/// the inserted text.
pub(super) fn edit(
    text: &str,
    tree: &ValueTree,
    registry: &Registry,
    given: Given<'_>,
) -> Result<(Edit, usize), Fault> {
    let o = given.o;
    let value = parse(&o.value).map_err(|e| bad_value(given, &e))?;
    let written = &o.value[value.span.clone()];
    let edit = match spot(text, tree, registry, given)? {
        PathSpot::There { entries, number } => Edit::replace(&entries[number].value.span, written),
        PathSpot::Free { inside, entries, key } => Edit::insert(inside, entries, &key, written),
        PathSpot::Beside { inside, field, first } => {
            let after = format!(", {first}: ");
            Edit { after, ..Edit::insert(inside, &[], &field, written) }
        }
    };
    Ok((edit, value.span.start))
}

/// Where a path leads in a text.
pub(super) enum PathSpot<'t> {
    /// To a value that is there: the entries of its group, and its number among them.
    There { entries: &'t [GroupEntry], number: usize },
    /// To a field that its group does not give: the byte after the group's bracket.
    Free { inside: usize, entries: &'t [GroupEntry], key: String },
    /// To a parameter beside the one value without a name, which is that of the parameter `first`.
    Beside { inside: usize, field: String, first: &'static str },
}

/// Follows the path of an override.
pub(super) fn spot<'t>(
    text: &str,
    tree: &'t ValueTree,
    registry: &Registry,
    given: Given<'_>,
) -> Result<PathSpot<'t>, Fault> {
    let read = read::file(text, tree, (registry, false), &mut Vec::new());
    let segments: Vec<&str> = given.o.path.split('.').collect();
    let walk = OverrideWalk { text, registry, given, segments: &segments };
    walk.top(tree, &read.sections, &read.stages)
}

fn bad_value(given: Given<'_>, e: &Fault) -> Fault {
    let o = given.o;
    let in_quotes = o.value.len() > 1 && o.value.starts_with('"') && o.value.ends_with('"');
    if let (Some(place), true) = (e.labels.first().map(|l| l.span.clone()), in_quotes) {
        let from = o.path.len() + 1;
        return given.fault(&e.message, from + place.start..from + place.end).hint(e.hint.clone());
    }
    let message = format!("`{}` is no RON value: {}", o.value, e.message);
    let quoted = format!("\"{}\"", o.value.trim_matches(['"', '\'']));
    let hint = format!("text stands in quotes: `{}`", given.written(&o.path, &quoted));
    let from = o.path.len() + 1;
    given.fault(&message, from..from + o.value.len()).hint(hint)
}

/// One override, while its path is followed down the tree.
struct OverrideWalk<'a> {
    text: &'a str,
    registry: &'a Registry,
    given: Given<'a>,
    segments: &'a [&'a str],
}

impl OverrideWalk<'_> {
    /// For a path whose first segment is a field of the file.
    fn top<'t>(
        &self,
        tree: &'t ValueTree,
        sections: &[Draft],
        stages: &[Draft],
    ) -> Result<PathSpot<'t>, Fault> {
        let field = self.segments.first().copied().unwrap_or("");
        let known = read::top_level(self.registry);
        let ValueShape::Group { name: None, bracket: Bracket::Round, inside, entries } = &tree.shape else {
            return Err(self.fault(0, format!("there is no field `{field}`")));
        };
        if !known.contains(&field) {
            return Err(self.no_path(0, &format!("a pipeline has no field `{field}`"), &known));
        }
        let Some(number) = self.number(entries, field) else {
            return match self.segments.len() {
                1 => Ok(PathSpot::Free { inside: *inside, entries, key: field.to_owned() }),
                _ => {
                    let fault = self.fault(0, format!("the file has no `{field}`"));
                    Err(fault.hint(format!("set all of it: `{}`", self.given.written(field, "..."))))
                }
            };
        };
        let GroupEntry { key, value } = &entries[number];
        let is_stage = |d: &&Draft| d.span == value.span && key.as_ref() != Some(&d.place);
        match (field, sections.iter().find(is_stage)) {
            _ if self.segments.len() == 1 => Ok(PathSpot::There { entries, number }),
            ("stages", _) => self.in_list(value.entries(), stages),
            (_, Some(draft)) => self.in_stage(1, value, draft),
            _ => self.inside(1, entries, number),
        }
    }

    /// `stages.ID...`
    fn in_list<'t>(&self, entries: &'t [GroupEntry], stages: &[Draft]) -> Result<PathSpot<'t>, Fault> {
        let id = self.segments[1];
        let draft = stages.iter().find(|d| d.id == id);
        let number = draft.and_then(|d| entries.iter().position(|e| e.value.span == d.span));
        let (Some(draft), Some(number)) = (draft, number) else {
            let ids: Vec<&str> = stages.iter().map(|d| d.id.as_str()).collect();
            return Err(self.no_path(1, &format!("no stage in `stages` has the id `{id}`"), &ids));
        };
        match self.segments.len() > 2 {
            true => self.in_stage(2, &entries[number].value, draft),
            false => Ok(PathSpot::There { entries, number }),
        }
    }

    /// A parameter of a stage, at segment `i`.
    fn in_stage<'t>(&self, i: usize, tree: &'t ValueTree, draft: &Draft) -> Result<PathSpot<'t>, Fault> {
        let field = self.segments[i];
        let params: Vec<&'static str> =
            draft.card.iter().flat_map(|c| &c.params).map(|p| p.name).chain(GENERIC).collect();
        let ValueShape::Group { inside, entries, .. } = &tree.shape else {
            return Err(self.fault(i - 1, format!("`{}` has no brackets", draft.name)));
        };
        if !params.contains(&field) {
            let message = format!("`{}` has no parameter `{field}`", draft.name);
            return Err(self.no_path(i, &message, &params));
        }
        if let ([GroupEntry { key: None, .. }], Some(first)) = (entries.as_slice(), params.first()) {
            return match *first == field {
                true => self.inside(i + 1, entries, 0),
                // The one value without a name gets its name.
                false => Ok(PathSpot::Beside { inside: *inside, field: field.to_owned(), first }),
            };
        }
        match self.number(entries, field) {
            Some(number) => self.inside(i + 1, entries, number),
            None if i + 1 == self.segments.len() => {
                Ok(PathSpot::Free { inside: *inside, entries, key: field.to_owned() })
            }
            None => {
                let whole = self.segments[..=i].join(".");
                let fault = self.fault(i, format!("the file has no `{field}`"));
                Err(fault.hint(format!("set all of it: `{}`", self.given.written(&whole, "..."))))
            }
        }
    }

    /// An entry of a group, and what is in it, at segment `i`.
    fn inside<'t>(&self, i: usize, entries: &'t [GroupEntry], number: usize) -> Result<PathSpot<'t>, Fault> {
        let Some(segment) = self.segments.get(i) else { return Ok(PathSpot::There { entries, number }) };
        let ValueShape::Group { bracket, inside, entries, .. } = &entries[number].value.shape else {
            return Err(self.fault(i - 1, format!("`{}` has no parts", self.segments[i - 1])));
        };
        if let Some(number) = self.number(entries, segment) {
            return self.inside(i + 1, entries, number);
        }
        let named = *bracket == Bracket::Curly || entries.iter().any(|e| e.key.is_some());
        if named && i + 1 == self.segments.len() {
            let key = if *bracket == Bracket::Curly { format!("{segment:?}") } else { (*segment).to_owned() };
            return Ok(PathSpot::Free { inside: *inside, entries, key });
        }
        let keys = self.keys(entries);
        let known: Vec<&str> = keys.iter().map(String::as_str).collect();
        Err(self.no_path(i, &format!("`{}` has no `{segment}`", self.segments[i - 1]), &known))
    }

    /// The number of the entry of that name; in a list its name is its number.
    fn number(&self, entries: &[GroupEntry], name: &str) -> Option<usize> {
        self.keys(entries).iter().position(|k| k == name)
    }

    fn keys(&self, entries: &[GroupEntry]) -> Vec<String> {
        let key = |(i, e): (usize, &GroupEntry)| match &e.key {
            Some(key) => self.text.get(key.clone()).unwrap_or("").trim_matches('"').to_owned(),
            None => i.to_string(),
        };
        entries.iter().enumerate().map(key).collect()
    }

    /// A fault at segment `i` of the path.
    fn fault(&self, i: usize, message: impl AsRef<str>) -> Fault {
        let from: usize = self.segments.iter().take(i).map(|s| s.len() + 1).sum();
        self.given.fault(message.as_ref(), from..from + self.segments.get(i).map_or(0, |s| s.len()))
    }

    /// Segment `i` names nothing: proposes the path with the nearest name in its place.
    fn no_path(&self, i: usize, message: &str, known: &[&str]) -> Fault {
        let near = toile_core::nearest(self.segments[i], known.iter().copied()).map(|near| {
            let path: Vec<&str> =
                self.segments.iter().enumerate().map(|(j, s)| if i == j { near } else { s }).collect();
            format!("did you mean `{}`?", path.join("."))
        });
        let list = (!known.is_empty()).then(|| format!("there is {}", toile_core::quoted(known)));
        self.fault(i, message).hint(near.or(list))
    }
}
