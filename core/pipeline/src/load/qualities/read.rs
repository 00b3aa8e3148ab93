//! The entries of `qualities`, as far as they stand for themselves.

use super::{Basis, MAX_QUALITIES, MAX_SETTINGS, Quality};
use crate::load::fault::Fault;
use crate::load::syntax::tree::{Bracket, GroupEntry, ValueShape, ValueTree};
use crate::load::{Override, parse};
use std::ops::Range;
use toile_core::Length;
use toile_core::param::ron_options;

/// The fields of an entry.
const FIELDS: [&str; 5] = ["name", "max_error", "set", "measured", "measured_for"];
/// How one is written.
const FORM: &str = "Quality(name: \"Draft\", max_error: \"10 mm\", set: [...])";

/// Reads the field's value; an entry with a fault is left out.
pub(in crate::load) fn read(text: &str, value: &ValueTree, faults: &mut Vec<Fault>) -> Vec<Quality> {
    let ValueShape::Group { name: None, bracket: Bracket::Square, entries, .. } = &value.shape else {
        let fault = Fault::new("bad_value", "`qualities` wants a list").at(&value.head(), "");
        faults.push(fault.hint(format!("write `qualities: [{FORM}]`")));
        return Vec::new();
    };
    if let Some(extra) = entries.get(MAX_QUALITIES) {
        let message = format!("{} qualities, the limit is {MAX_QUALITIES}", entries.len());
        faults.push(Fault::new("too_large", message).at(&extra.value.head(), ""));
    }
    let mut qualities: Vec<Quality> = Vec::new();
    for entry in entries.iter().take(MAX_QUALITIES) {
        let Some(quality) = (QualityReader { text, faults }).quality(&entry.value) else { continue };
        match qualities.iter().find(|q| q.name == quality.name) {
            Some(first) => {
                let message = format!("two qualities are called `{}`", quality.name);
                let fault = Fault::new("duplicate_quality", message);
                faults.push(fault.at(&quality.place, "second").at(&first.place, "first"));
            }
            None => qualities.push(quality),
        }
    }
    qualities
}

/// The qualities of a text; those that can be read.
pub(in crate::load) fn named(text: &str) -> Vec<Quality> {
    let Ok(tree) = parse(text) else { return Vec::new() };
    field(text, &tree).map(|e| read(text, &e.value, &mut Vec::new())).unwrap_or_default()
}

/// The field in a file's tree.
pub(super) fn field<'t>(text: &str, tree: &'t ValueTree) -> Option<&'t GroupEntry> {
    let is_it = |e: &&GroupEntry| e.key.as_ref().and_then(|k| text.get(k.clone())) == Some("qualities");
    tree.entries().iter().find(is_it)
}

/// The quality of that name.
///
/// Errors: there is none; the fault names those that there are.
pub(in crate::load) fn choose(
    text: &str,
    qualities: Vec<Quality>,
    name: &str,
) -> Result<Quality, Box<Fault>> {
    let known: Vec<String> = qualities.iter().map(|q| q.name.clone()).collect();
    if let Some(quality) = qualities.into_iter().find(|q| q.name == name) {
        return Ok(quality);
    }
    let tree = parse(text).ok();
    let place = tree.as_ref().and_then(|t| field(text, t)?.key.clone());
    let place = place.or_else(|| tree.map(|t| t.head())).unwrap_or(0..0);
    let names: Vec<&str> = known.iter().map(String::as_str).collect();
    let fault = Fault::new("unknown_quality", format!("the pipeline has no quality `{name}`")).at(&place, "");
    let none = "it has none; `toile tune PIPELINE --quality \"NAME=LENGTH\"` measures and writes one";
    let list = || format!("there is {}", toile_core::quoted(&names));
    let hint = match names.as_slice() {
        [] => none.to_owned(),
        _ => toile_core::hint(name, "there is", &names).unwrap_or_else(list),
    };
    Err(Box::new(fault.hint(hint)))
}

/// One entry on its way.
struct QualityReader<'a> {
    text: &'a str,
    faults: &'a mut Vec<Fault>,
}

impl QualityReader<'_> {
    fn fault(&mut self, code: &'static str, message: impl Into<String>, at: &Range<usize>) {
        self.faults.push(Fault::new(code, message).at(at, ""));
    }

    fn at(&self, span: &Range<usize>) -> &str {
        self.text.get(span.clone()).unwrap_or("")
    }

    fn quality(&mut self, value: &ValueTree) -> Option<Quality> {
        let (name, entries) = match &value.shape {
            ValueShape::Group { name: Some(name), bracket: Bracket::Round, entries, .. }
                if self.at(name) == "Quality" =>
            {
                (name.clone(), entries)
            }
            _ => {
                let fault = Fault::new("not_a_quality", "expected a quality").at(&value.head(), "");
                self.faults.push(fault.hint(format!("write `{FORM}`")));
                return None;
            }
        };
        self.known(entries);
        let title = self.field(entries, "name").map(|v| (self.name(v), v.span.clone()));
        let error = self.field(entries, "max_error").map(|v| self.length(v));
        let set = self.field(entries, "set").map(|v| self.settings(v));
        let measured = self.field(entries, "measured").map(|v| self.words("measured", v));
        let basis = self.field(entries, "measured_for").map(|v| self.basis(v));
        for (field, given) in
            [("name", title.is_some()), ("max_error", error.is_some()), ("set", set.is_some())]
        {
            if !given {
                let fault = Fault::new("missing_field", format!("the quality lacks `{field}`")).at(&name, "");
                self.faults.push(fault.hint(format!("write `{FORM}`")));
            }
        }
        let (title, place) = title?;
        let (set, places) = set??.into_iter().unzip();
        let measured = measured.map_or(Some(None), |words| words.map(Some))?;
        let basis = basis.map_or(Some(None), |basis| basis.map(Some))?;
        Some(Quality { name: title?, max_error: error??, set, measured, basis, place, places })
    }

    /// Reports fields that there are not, that are given twice, or that have no name.
    fn known(&mut self, entries: &[GroupEntry]) {
        let mut seen: Vec<(&str, &Range<usize>)> = Vec::new();
        for entry in entries {
            let Some(key) = &entry.key else {
                self.fault("unnamed_value", "a value without a field name", &entry.value.span);
                continue;
            };
            let name = self.text.get(key.clone()).unwrap_or("");
            if let Some((_, first)) = seen.iter().find(|(n, _)| *n == name) {
                let fault = Fault::new("duplicate_field", format!("the field `{name}` is given twice"));
                self.faults.push(fault.at(key, "again here").at(first, "first here"));
            } else if !FIELDS.contains(&name) {
                let fault = Fault::new("unknown_field", format!("unknown field `{name}`")).at(key, "");
                self.faults.push(fault.hint(toile_core::hint(name, "a quality has", &FIELDS)));
            }
            seen.push((name, key));
        }
    }

    fn field<'t>(&self, entries: &'t [GroupEntry], name: &str) -> Option<&'t ValueTree> {
        let is_it = |e: &&GroupEntry| e.key.as_ref().is_some_and(|k| self.at(k) == name);
        entries.iter().find(is_it).map(|e| &e.value)
    }

    fn words(&mut self, field: &str, value: &ValueTree) -> Option<String> {
        let parsed = ron_options().from_str(self.at(&value.span)).ok();
        if parsed.is_none() && !value.is_broken {
            self.fault("bad_value", format!("`{field}` wants text in quotes"), &value.span);
        }
        parsed
    }

    fn basis(&mut self, value: &ValueTree) -> Option<Basis> {
        let words = self.words("measured_for", value)?;
        let parsed = words.parse::<Basis>();
        parsed.map_err(|why| self.fault("bad_value", format!("`measured_for`: {why}"), &value.span)).ok()
    }

    fn name(&mut self, value: &ValueTree) -> Option<String> {
        let name = self.words("name", value)?;
        if Quality::is_name(&name) {
            return Some(name);
        }
        let message = "a quality's name has 1 to 64 letters, digits, `_`, `-` and spaces between them";
        self.fault("bad_value", message, &value.span);
        None
    }

    fn length(&mut self, value: &ValueTree) -> Option<Length> {
        let words = self.words("max_error", value)?;
        let message = match words.parse::<Length>() {
            Ok(length) if length.metres() > 0.0 => return Some(length),
            Ok(_) => "an error is above zero".to_owned(),
            Err(why) => why,
        };
        self.fault("bad_value", format!("`max_error`: {message}"), &value.span);
        None
    }

    /// The list of `PATH=VALUE`, each with its place; none where one of them has a fault.
    fn settings(&mut self, value: &ValueTree) -> Option<Vec<(Override, Range<usize>)>> {
        let ValueShape::Group { name: None, bracket: Bracket::Square, entries, .. } = &value.shape else {
            let fault = Fault::new("bad_value", "`set` wants a list of texts").at(&value.head(), "");
            let form = "write `set: [\"stages.GridMesher.edge=\\\"24 mm\\\"\"]`";
            self.faults.push(fault.hint(form.to_owned()));
            return None;
        };
        if let Some(extra) = entries.get(MAX_SETTINGS) {
            let message = format!("{} settings, the limit is {MAX_SETTINGS}", entries.len());
            self.fault("too_large", message, &extra.value.head());
            return None;
        }
        let one = |e: &GroupEntry| {
            let words = self.words("set", &e.value)?;
            match words.parse::<Override>() {
                Ok(change) => Some((change, e.value.span.clone())),
                Err(why) => {
                    self.fault("bad_value", why, &e.value.span);
                    None
                }
            }
        };
        // Every fault of the list is wanted, not the first alone.
        let read: Vec<Option<(Override, Range<usize>)>> = entries.iter().map(one).collect();
        read.into_iter().collect()
    }
}
