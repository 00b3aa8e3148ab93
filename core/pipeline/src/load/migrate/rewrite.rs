//! Edits of a file's text at the places that the syntax tree knows.

use super::Migrated;
use crate::load::fault::{Fault, LineStarts};
use crate::load::old_name::{Now, renamed};
use crate::load::syntax::cut::whole;
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
    /// It was removed; the text says what does its work now.
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
        let now = renamed(self.registry, &old);
        if let Some(now) = now {
            self.renamed(tree, span, &old, now, id);
        }
        let names = [Some(old.as_str()), now.map(|now| now.name)];
        for (i, entry) in entries.iter().enumerate() {
            self.argument(names.iter().flatten().copied().collect(), entries, i, entry);
        }
    }

    /// The new name of a stage, the argument that says what the old one said, and its id.
    fn renamed(&mut self, tree: &ValueTree, name: Range<usize>, old: &str, now: Now, id: Option<&str>) {
        let Now { name: new, with } = now;
        let called = if with.is_empty() { new.to_owned() } else { format!("{new}({with})") };
        let what = format!("stage {old} -> {called}");
        let ValueShape::Group { inside, entries, .. } = &tree.shape else {
            return self.edits.push(TextEdit { at: name, text: called, what });
        };
        self.edits.push(TextEdit { at: name, text: new.to_owned(), what });
        let with = (!with.is_empty()).then(|| with.to_owned());
        let mut added: Vec<String> = with.into_iter().chain(id.map(|id| format!("id: {id:?}"))).collect();
        if added.is_empty() {
            return;
        }
        // A comma behind them where others follow.
        added.extend((!entries.is_empty()).then(String::new));
        let what = id.map_or_else(String::new, |_| format!("{new}: keeps its id, which others read from"));
        self.edits.push(TextEdit { at: *inside..*inside, text: added.join(", "), what });
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
                self.edits.push(TextEdit { at: whole(self.text, entries, i), text: String::new(), what });
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
            self.faults.push(fault.hint("leave one of them out".to_owned()));
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
