//! Edits of a file's text at the places that the syntax tree knows.

use super::Migrated;
use crate::load::fault::{Fault, LineStarts};
use crate::load::old_name::renamed;
use crate::load::syntax::tree::{GroupEntry, ValueShape, ValueTree};
use std::ops::Range;
use toile_core::{Change, Registry};

pub(super) struct TextEdit {
    pub(super) at: Range<usize>,
    pub(super) text: String,
    pub(super) what: String,
}

/// What became of a parameter.
pub(super) enum Followed {
    /// It is as it was, or its value cannot be converted.
    Same,
    /// It is no more, with what does its work now.
    Removed(&'static str),
    /// Its new name and value.
    Renamed(String, String),
}

pub(super) struct Migrator<'a> {
    pub(super) text: &'a str,
    pub(super) registry: &'a Registry,
    pub(super) edits: Vec<TextEdit>,
    pub(super) faults: Vec<Fault>,
}

impl Migrator<'_> {
    pub(super) fn at(&self, span: &Range<usize>) -> &str {
        self.text.get(span.clone()).unwrap_or("")
    }

    /// A stage; `id` is its id where another stage names it, which must stay.
    pub(super) fn stage(&mut self, tree: &ValueTree, id: Option<&str>) {
        let (span, entries) = match &tree.shape {
            ValueShape::Group { name: Some(name), entries, .. } => (name.clone(), entries.as_slice()),
            ValueShape::Name => (tree.span.clone(), &[][..]),
            _ => return,
        };
        let old = self.at(&span).to_owned();
        let new = renamed(self.registry, &old);
        if let Some(new) = new {
            let what = format!("stage {old} -> {new}");
            self.edits.push(TextEdit { at: span, text: new.to_owned(), what });
            if let (Some(id), ValueShape::Group { inside, .. }) = (id, &tree.shape) {
                let comma = if entries.is_empty() { "" } else { ", " };
                let what = format!("{new}: keeps its id, which others read from");
                self.edits.push(TextEdit { at: *inside..*inside, text: format!("id: {id:?}{comma}"), what });
            }
        }
        let names = [Some(old.as_str()), new];
        for (i, entry) in entries.iter().enumerate() {
            self.argument(names.iter().flatten().copied().collect(), entries, i, entry);
        }
    }

    /// What became of a parameter of a stage that has had these names.
    pub(super) fn followed(&self, stages: &[&str], param: &str, value: &str) -> Followed {
        let (mut name, mut value) = (param.to_owned(), value.to_owned());
        for m in self.registry.migrations() {
            if !stages.iter().any(|s| m.of_param(s, &name)) {
                continue;
            }
            match m.change {
                Change::Stage { .. } => {}
                Change::Removed { why, .. } => return Followed::Removed(why),
                Change::Param { to, convert, .. } => match convert(&value) {
                    Some(new) => (name, value) = (to.to_owned(), new),
                    None => return Followed::Same,
                },
            }
        }
        if name == param { Followed::Same } else { Followed::Renamed(name, value) }
    }

    /// One argument of a stage that has had these names.
    fn argument(&mut self, stages: Vec<&str>, entries: &[GroupEntry], i: usize, entry: &GroupEntry) {
        let Some(key) = &entry.key else { return };
        let (old, mut value) = (self.at(key).to_owned(), self.at(&entry.value.span).to_owned());
        let stage = stages.last().copied().unwrap_or("");
        let name = match self.followed(&stages, &old, &value) {
            Followed::Same => return,
            Followed::Removed(why) => {
                let what = format!("{stage}: {old} removed: {why}");
                self.edits.push(TextEdit { at: self.whole(entries, i), text: String::new(), what });
                return;
            }
            Followed::Renamed(name, new) => {
                value = new;
                name
            }
        };
        if let Some(twice) = entries.iter().filter_map(|e| e.key.as_ref()).find(|k| self.at(k) == name) {
            let message = format!("`{old}` is now called `{name}`, which is given as well");
            let fault = Fault::new("old_name", message).at(key, "old name").at(twice, "new name");
            self.faults.push(fault.hint("leave one of them away".to_owned()));
            return;
        }
        let same = value == self.at(&entry.value.span);
        let what = match same {
            true => format!("{stage}: {old} -> {name}"),
            false => format!("{stage}: {old}: {} -> {name}: {value}", self.at(&entry.value.span)),
        };
        self.edits.push(TextEdit { at: key.clone(), text: name, what });
        if !same {
            self.edits.push(TextEdit { at: entry.value.span.clone(), text: value, what: String::new() });
        }
    }

    /// The place of an argument with its comma and the white space that only it needed; comments
    /// stay.
    pub(super) fn whole(&self, entries: &[GroupEntry], i: usize) -> Range<usize> {
        let entry = &entries[i];
        let mut start = entry.key.as_ref().map_or(entry.value.span.start, |k| k.start);
        let mut end = entry.value.span.end;
        let after = |at: usize| self.text.get(at..).unwrap_or("");
        let blank = |rest: &str| rest.len() - rest.trim_start_matches([' ', '\t']).len();
        let comma = blank(after(end));
        if after(end + comma).starts_with(',') {
            end += comma + 1;
            end += blank(after(end));
        } else if let Some(before) = i.checked_sub(1).map(|b| entries[b].value.span.end) {
            // The last of a list without a last comma takes the comma before it.
            let between = self.text.get(before..start).unwrap_or("");
            if between.trim() == "," {
                start = before;
            }
        }
        let line = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let alone = self.text[line..start].trim().is_empty();
        match after(end).find('\n') {
            Some(rest) if alone && after(end)[..rest].trim().is_empty() => line..end + rest + 1,
            _ => start..end,
        }
    }

    pub(super) fn finish(mut self) -> Migrated {
        self.edits.sort_by_key(|e| (e.at.start, e.at.end));
        let lines = LineStarts::of(self.text);
        let place = |e: &TextEdit| lines.position(self.text, e.at.start).0;
        let told = self.edits.iter().filter(|e| !e.what.is_empty());
        let changes = told.map(|e| format!("line {}: {}", place(e), e.what)).collect();
        let (mut text, mut done) = (String::with_capacity(self.text.len()), 0);
        for edit in &self.edits {
            // Two removed neighbours may share a comma.
            text.push_str(self.text.get(done..edit.at.start.max(done)).unwrap_or(""));
            text.push_str(&edit.text);
            done = done.max(edit.at.end);
        }
        text.push_str(self.text.get(done..).unwrap_or(""));
        Migrated { text, changes }
    }
}
