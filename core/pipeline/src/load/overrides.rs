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
struct Edit {
    at: Range<usize>,
    before: String,
    value: String,
    after: String,
}

impl Edit {
    fn replace(at: &Range<usize>, value: &str) -> Self {
        Edit { at: at.clone(), before: String::new(), value: value.to_owned(), after: String::new() }
    }

    /// Puts `key: value` first into a group.
    fn insert(inside: usize, entries: &[GroupEntry], key: &str, value: &str) -> Self {
        let after = if entries.is_empty() { "" } else { ", " };
        Edit {
            at: inside..inside,
            before: format!("{key}: "),
            value: value.to_owned(),
            after: after.to_owned(),
        }
    }
}

/// What one override does to the text, and where in its value the value proper begins.
fn edit(text: &str, tree: &ValueTree, registry: &Registry, given: Given<'_>) -> Result<(Edit, usize), Fault> {
    let o = given.o;
    let value = parse(&o.value).map_err(|e| bad_value(given, &e))?;
    let read = read::file(text, tree, (registry, false), &mut Vec::new());
    let segments: Vec<&str> = o.path.split('.').collect();
    let value_at = value.span.start;
    let walk = OverrideWalk { text, registry, given, value: &o.value[value.span], segments: &segments };
    Ok((walk.top(tree, &read.sections, &read.stages)?, value_at))
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

/// One override on its way down the tree.
struct OverrideWalk<'a> {
    text: &'a str,
    registry: &'a Registry,
    given: Given<'a>,
    value: &'a str,
    segments: &'a [&'a str],
}

impl OverrideWalk<'_> {
    /// The first segment: a field of the file.
    fn top(&self, tree: &ValueTree, sections: &[Draft], stages: &[Draft]) -> Result<Edit, Fault> {
        let field = self.segments.first().copied().unwrap_or("");
        let known = read::top_level(self.registry);
        let ValueShape::Group { name: None, bracket: Bracket::Round, inside, entries } = &tree.shape else {
            return Err(self.fault(0, format!("there is no field `{field}`")));
        };
        if !known.contains(&field) {
            return Err(self.no_path(0, &format!("a pipeline has no field `{field}`"), &known));
        }
        let Some((key, value)) = self.entry(entries, field) else {
            return match self.segments.len() {
                1 => Ok(Edit::insert(*inside, entries, field, self.value)),
                _ => {
                    let fault = self.fault(0, format!("the file has no `{field}`"));
                    Err(fault.hint(format!("set all of it: `{}`", self.given.written(field, "..."))))
                }
            };
        };
        let section = sections.iter().find(|d| d.span == value.span && d.place != *key);
        match (field, section) {
            _ if self.segments.len() == 1 => Ok(Edit::replace(&value.span, self.value)),
            ("stages", _) => self.in_list(value, stages),
            (_, Some(draft)) => self.in_stage(1, value, draft),
            _ => self.inside(1, value),
        }
    }

    /// `stages.ID...`
    fn in_list(&self, list: &ValueTree, stages: &[Draft]) -> Result<Edit, Fault> {
        let id = self.segments[1];
        let Some(draft) = stages.iter().find(|d| d.id == id) else {
            let ids: Vec<&str> = stages.iter().map(|d| d.id.as_str()).collect();
            return Err(self.no_path(1, &format!("no stage in `stages` has the id `{id}`"), &ids));
        };
        let item = list.entries().iter().find(|e| e.value.span == draft.span);
        match item {
            Some(item) if self.segments.len() > 2 => self.in_stage(2, &item.value, draft),
            _ => Ok(Edit::replace(&draft.span, self.value)),
        }
    }

    /// A parameter of a stage, at segment `i`.
    fn in_stage(&self, i: usize, tree: &ValueTree, draft: &Draft) -> Result<Edit, Fault> {
        let field = self.segments[i];
        let params: Vec<&str> =
            draft.card.iter().flat_map(|c| &c.params).map(|p| p.name).chain(GENERIC).collect();
        let ValueShape::Group { inside, entries, .. } = &tree.shape else {
            return Err(self.fault(i - 1, format!("`{}` has no brackets", draft.name)));
        };
        if !params.contains(&field) {
            let message = format!("`{}` has no parameter `{field}`", draft.name);
            return Err(self.no_path(i, &message, &params));
        }
        if let ([GroupEntry { key: None, value }], Some(first)) = (entries.as_slice(), params.first()) {
            return match first == &field {
                true => self.inside(i + 1, value),
                // The one value without a name gets its name.
                false => {
                    let after = format!(", {first}: ");
                    Ok(Edit { after, ..Edit::insert(*inside, &[], field, self.value) })
                }
            };
        }
        match self.entry(entries, field) {
            Some((_, value)) => self.inside(i + 1, value),
            None if i + 1 == self.segments.len() => Ok(Edit::insert(*inside, entries, field, self.value)),
            None => {
                let whole = self.segments[..=i].join(".");
                let fault = self.fault(i, format!("the file gives no `{field}` to change a part of"));
                Err(fault.hint(format!("set all of it: `{}`", self.given.written(&whole, "..."))))
            }
        }
    }

    /// A value, and what is in it, at segment `i`.
    fn inside(&self, i: usize, tree: &ValueTree) -> Result<Edit, Fault> {
        let Some(segment) = self.segments.get(i) else { return Ok(Edit::replace(&tree.span, self.value)) };
        let ValueShape::Group { bracket, inside, entries, .. } = &tree.shape else {
            return Err(self.fault(i - 1, format!("`{}` has no parts", self.segments[i - 1])));
        };
        if let Some((_, value)) = self.entry(entries, segment) {
            return self.inside(i + 1, value);
        }
        let named = *bracket == Bracket::Curly || entries.iter().any(|e| e.key.is_some());
        if named && i + 1 == self.segments.len() {
            let key = if *bracket == Bracket::Curly { format!("{segment:?}") } else { (*segment).to_owned() };
            return Ok(Edit::insert(*inside, entries, &key, self.value));
        }
        let keys = self.keys(entries);
        let known: Vec<&str> = keys.iter().map(String::as_str).collect();
        Err(self.no_path(i, &format!("`{}` has no `{segment}`", self.segments[i - 1]), &known))
    }

    /// The entry of that name, or of that number in a list.
    fn entry<'t>(&self, entries: &'t [GroupEntry], name: &str) -> Option<(&'t Range<usize>, &'t ValueTree)> {
        let i = self.keys(entries).iter().position(|k| k == name)?;
        let entry = entries.get(i)?;
        Some((entry.key.as_ref().unwrap_or(&entry.value.span), &entry.value))
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
