//! Old pipeline files: what was renamed or removed since they were written, and how a file is brought up to date.
//!
//! A stage's crate lists every such change beside its registration, `registry.migrate(Migration::renamed(...))`,
//! for good: the number of changes is the version of the stage's parameters. A parameter whose meaning changes gets a new
//! name, so that a file needs no version of its own: an old name says what it meant.
//!
//! A file is rewritten by edits of its text at the places that the syntax tree knows, so that comments, order and
//! layout stay. The settings of its named qualities are rewritten as well (`qualities`). Cost: linear in the text for each rewritten argument. Limits: a value is converted as text; what a change cannot convert
//! is left, and the load names it.

mod qualities;

use super::draft::Draft;
use super::fault::{Fault, Faults, Lines};
use super::read::Read;
use super::tree::{Entry, Shape, Tree};
use super::{parse, read};
use crate::Registry;
use std::ops::Range;

/// One change of a stage's name or parameters.
#[derive(Debug, Clone, Copy)]
pub struct Migration {
    /// The stage: its old name where that changed, else the one it has.
    pub stage: &'static str,
    /// What changed.
    pub change: Change,
}

/// What changed.
#[derive(Debug, Clone, Copy)]
pub enum Change {
    /// The stage has another name.
    Stage {
        /// The new name.
        to: &'static str,
    },
    /// A parameter has another name, and its value may be written in another way.
    Param {
        /// The old name.
        from: &'static str,
        /// The new name.
        to: &'static str,
        /// The new value from the old one, both as RON; none where the value is no such thing.
        convert: fn(&str) -> Option<String>,
    },
    /// A parameter is no more.
    Removed {
        /// Its name.
        param: &'static str,
        /// What does its work now.
        why: &'static str,
    },
}

impl Migration {
    /// The stage `from` is now called `to`.
    pub const fn stage(from: &'static str, to: &'static str) -> Self {
        Migration { stage: from, change: Change::Stage { to } }
    }

    /// The parameter `from` is now called `to`.
    pub fn renamed(stage: &'static str, from: &'static str, to: &'static str) -> Self {
        Self::converted(stage, from, to, |value| Some(value.to_owned()))
    }

    /// The parameter `from` is now `to`, with its value written in another way.
    pub const fn converted(
        stage: &'static str,
        from: &'static str,
        to: &'static str,
        convert: fn(&str) -> Option<String>,
    ) -> Self {
        Migration { stage, change: Change::Param { from, to, convert } }
    }

    /// The parameter is no more; `why` says what does its work now.
    pub const fn removed(stage: &'static str, param: &'static str, why: &'static str) -> Self {
        Migration { stage, change: Change::Removed { param, why } }
    }

    fn of_param(&self, stage: &str, param: &str) -> bool {
        let name = match self.change {
            Change::Stage { .. } => return false,
            Change::Param { from, .. } => from,
            Change::Removed { param, .. } => param,
        };
        self.stage == stage && name == param
    }
}

/// What a user does about an old name.
const REPAIR: &str = "`toile migrate` rewrites the file to the new names";

/// The fault of an old stage name, and the new name.
pub(super) fn old_stage(registry: &Registry, name: &str) -> Option<(Fault, &'static str)> {
    let to = renamed(registry, name)?;
    let fault = Fault::new("old_name", format!("the stage `{name}` is now called `{to}`"));
    Some((fault.hint(REPAIR.to_owned()), to))
}

/// The fault of a parameter's old name.
pub(super) fn old_param(registry: &Registry, stage: &str, param: &str) -> Option<Fault> {
    let migration = registry.migrations().iter().find(|m| m.of_param(stage, param))?;
    let message = match migration.change {
        Change::Stage { .. } => return None,
        Change::Param { to, .. } => format!("the parameter `{param}` is now called `{to}`"),
        Change::Removed { why, .. } => format!("the parameter `{param}` was removed: {why}"),
    };
    Some(Fault::new("old_name", message).hint(REPAIR.to_owned()))
}

/// The name that a stage has now; none where it never changed, or where it is a stage's name again.
fn renamed(registry: &Registry, name: &str) -> Option<&'static str> {
    let step = |name: &str| {
        registry.migrations().iter().find_map(|m| match m.change {
            Change::Stage { to } if m.stage == name && registry.card(name).is_none() => Some(to),
            _ => None,
        })
    };
    let mut to = step(name)?;
    // Each change is taken once at most, so that a circle ends.
    for _ in registry.migrations() {
        to = step(to).unwrap_or(to);
    }
    Some(to)
}

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
    let drafts = read::file(text, &tree, registry, &mut Vec::new());
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
fn is_read_from(draft: &Draft, drafts: &Read) -> bool {
    drafts.stages.iter().flat_map(|d| &d.from).any(|(id, _)| *id == draft.id)
}

/// The value at a place.
fn find<'t>(tree: &'t Tree, span: &Range<usize>) -> Option<&'t Tree> {
    if tree.span == *span {
        return Some(tree);
    }
    let inside = |t: &&Entry| t.value.span.start <= span.start && span.end <= t.value.span.end;
    find(&tree.entries().iter().find(inside)?.value, span)
}

struct Edit {
    at: Range<usize>,
    text: String,
    what: String,
}

/// What became of a parameter.
enum Followed {
    /// It is as it was, or its value cannot be converted.
    Same,
    /// It is no more, with what does its work now.
    Removed(&'static str),
    /// Its new name and value.
    Renamed(String, String),
}

struct Migrator<'a> {
    text: &'a str,
    registry: &'a Registry,
    edits: Vec<Edit>,
    faults: Vec<Fault>,
}

impl Migrator<'_> {
    fn at(&self, span: &Range<usize>) -> &str {
        self.text.get(span.clone()).unwrap_or("")
    }

    /// A stage; `id` is its id where another stage names it, which must stay.
    fn stage(&mut self, tree: &Tree, id: Option<&str>) {
        let (span, entries) = match &tree.shape {
            Shape::Group { name: Some(name), entries, .. } => (name.clone(), entries.as_slice()),
            Shape::Name => (tree.span.clone(), &[][..]),
            _ => return,
        };
        let old = self.at(&span).to_owned();
        let new = renamed(self.registry, &old);
        if let Some(new) = new {
            let what = format!("stage {old} -> {new}");
            self.edits.push(Edit { at: span, text: new.to_owned(), what });
            if let (Some(id), Shape::Group { inside, .. }) = (id, &tree.shape) {
                let comma = if entries.is_empty() { "" } else { ", " };
                let what = format!("{new}: keeps its id, which others read from");
                self.edits.push(Edit { at: *inside..*inside, text: format!("id: {id:?}{comma}"), what });
            }
        }
        let names = [Some(old.as_str()), new];
        for (i, entry) in entries.iter().enumerate() {
            self.argument(names.iter().flatten().copied().collect(), entries, i, entry);
        }
    }

    /// What became of a parameter of a stage that has had these names.
    fn followed(&self, stages: &[&str], param: &str, value: &str) -> Followed {
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
    fn argument(&mut self, stages: Vec<&str>, entries: &[Entry], i: usize, entry: &Entry) {
        let Some(key) = &entry.key else { return };
        let (old, mut value) = (self.at(key).to_owned(), self.at(&entry.value.span).to_owned());
        let stage = stages.last().copied().unwrap_or("");
        let name = match self.followed(&stages, &old, &value) {
            Followed::Same => return,
            Followed::Removed(why) => {
                let what = format!("{stage}: {old} removed: {why}");
                self.edits.push(Edit { at: self.whole(entries, i), text: String::new(), what });
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
        self.edits.push(Edit { at: key.clone(), text: name, what });
        if !same {
            self.edits.push(Edit { at: entry.value.span.clone(), text: value, what: String::new() });
        }
    }

    /// The place of an argument with its comma and the white space that only it needed; comments stay.
    fn whole(&self, entries: &[Entry], i: usize) -> Range<usize> {
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

    fn finish(mut self) -> Migrated {
        self.edits.sort_by_key(|e| (e.at.start, e.at.end));
        let lines = Lines::of(self.text);
        let place = |e: &Edit| lines.position(self.text, e.at.start).0;
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::tests::kit;
    use super::*;
    use proptest::prelude::*;

    /// The test kit's stages, with a history.
    fn registry() -> Registry {
        let mut r = kit::registry();
        r.migrate(Migration::stage("Threshold", "Otsu"));
        r.migrate(Migration::renamed("Threshold", "offset", "bias"));
        r.migrate(Migration::stage("Grid", "Lattice"));
        r.migrate(Migration::stage("Lattice", "GridMesher"));
        r.migrate(Migration::converted("GridMesher", "edge_mm", "edge", |mm| {
            mm.parse::<f64>().ok().map(|mm| format!("\"{mm} mm\""))
        }));
        r.migrate(Migration::removed("GridMesher", "rounds", "the mesh is improved until it is good"));
        r
    }

    const OLD: &str = r#"// A vest, from last year.
(
    stages: [
        Threshold( /* darker */ offset: 3.0),   // garment or ground
        Canny(from: "Threshold"),
        Grid(
            rounds: 4,       // enough
            edge_mm: 12,     // finer: slower
        ),
        Lattice(edge_mm: 8, rounds: 2, id: "fine"), Taubin(),
    ],
)
"#;

    const NEW: &str = r#"// A vest, from last year.
(
    stages: [
        Otsu(id: "Threshold",  /* darker */ bias: 3.0),   // garment or ground
        Canny(from: "Threshold"),
        GridMesher(
            // enough
            edge: "12 mm",     // finer: slower
        ),
        GridMesher(edge: "8 mm", id: "fine"), Taubin(),
    ],
)
"#;

    #[test]
    fn an_old_file_gets_the_new_names_and_keeps_its_comments_order_and_ids() {
        let new = migrate(OLD, "vest.ron", &registry()).unwrap();
        assert_eq!(new.text, NEW);
        assert_eq!(
            new.changes,
            [
                "line 4: stage Threshold -> Otsu",
                "line 4: Otsu: keeps its id, which others read from",
                "line 4: Otsu: offset -> bias",
                "line 6: stage Grid -> GridMesher",
                "line 7: GridMesher: rounds removed: the mesh is improved until it is good",
                "line 8: GridMesher: edge_mm: 12 -> edge: \"12 mm\"",
                "line 10: stage Lattice -> GridMesher",
                "line 10: GridMesher: edge_mm: 8 -> edge: \"8 mm\"",
                "line 10: GridMesher: rounds removed: the mesh is improved until it is good",
            ]
        );
        let again = migrate(&new.text, "vest.ron", &registry()).unwrap();
        assert_eq!((again.text.as_str(), again.changes.len()), (NEW, 0));
    }

    #[test]
    fn the_last_argument_goes_with_the_comma_before_it() {
        let text = "(stages: [GridMesher(edge: \"8 mm\", rounds: 2), GridMesher(rounds: 1)])";
        let new = migrate(text, "x.ron", &registry()).unwrap();
        assert_eq!(new.text, "(stages: [GridMesher(edge: \"8 mm\"), GridMesher()])");
    }

    #[test]
    fn old_names_are_faults_that_name_the_command() {
        let faults = crate::pipeline::load(OLD, "vest.ron", std::path::Path::new("."), &registry(), &[])
            .unwrap_err()
            .faults;
        let told: Vec<(&str, &str)> = faults
            .iter()
            .filter(|f| f.code == "old_name")
            .map(|f| (f.message.as_str(), f.hint.as_deref().unwrap()))
            .collect();
        let hint = "`toile migrate` rewrites the file to the new names";
        assert!(told.contains(&("the stage `Threshold` is now called `Otsu`", hint)), "{told:?}");
        let text = "(stages: [GridMesher(edge_mm: 3, rounds: 1)])";
        let faults =
            crate::pipeline::load(text, "x.ron", std::path::Path::new("."), &registry(), &[]).unwrap_err();
        let messages: Vec<&str> =
            faults.faults.iter().filter(|f| f.code == "old_name").map(|f| f.message.as_str()).collect();
        assert_eq!(
            messages,
            [
                "the parameter `edge_mm` is now called `edge`",
                "the parameter `rounds` was removed: the mesh is improved until it is good"
            ]
        );
    }

    #[test]
    fn a_value_that_cannot_be_converted_and_a_name_given_twice_are_left_to_the_user() {
        let text = "(stages: [GridMesher(edge_mm: fine)])";
        assert_eq!(migrate(text, "x.ron", &registry()).unwrap().text, text);
        let text = "(stages: [Threshold(offset: 1.0, bias: 2.0)])";
        let faults = migrate(text, "x.ron", &registry()).unwrap_err().faults;
        assert_eq!(faults[0].message, "`offset` is now called `bias`, which is given as well");
        assert_eq!(faults[0].hint.as_deref(), Some("leave one of them away"));
    }

    const QUALITIES: &str = r#"(
    stages: [Threshold(), Grid(id: "fine"), Lattice(edge_mm: 9), Taubin()],
    qualities: [
        Quality(name: "Draft", max_error: "9 mm", set: [
            "stages.Threshold.offset=3.0",   // darker
            "stages.fine.edge_mm=12", "stages.fine.rounds=2",
            "stages.Taubin=Lattice(rounds: 1, edge_mm: 4)",
            "stages.Canny.low=3",
        ]),
        Quality(name: "Fine", max_error: "1 mm", set: ["stages.Lattice.rounds=9"]),
    ],
)"#;

    #[test]
    fn the_settings_of_qualities_get_the_new_names() {
        let new = migrate(QUALITIES, "x.ron", &registry()).unwrap();
        let set = new.text.split_once("qualities").unwrap().1;
        let expected = r#": [
        Quality(name: "Draft", max_error: "9 mm", set: [
            "stages.Otsu.bias=3.0",   // darker
            "stages.fine.edge=\"12 mm\"", 
            "stages.Taubin=GridMesher(edge: \"4 mm\")",
            "stages.Canny.low=3",
        ]),
        Quality(name: "Fine", max_error: "1 mm", set: []),
    ],
)"#;
        assert_eq!(set, expected);
        assert_eq!(
            new.changes[4..],
            [
                "line 5: quality Draft: stages.Threshold.offset=3.0 -> stages.Otsu.bias=3.0",
                "line 6: quality Draft: stages.fine.edge_mm=12 -> stages.fine.edge=\"12 mm\"",
                "line 6: quality Draft: stages.fine.rounds=2 removed: the mesh is improved until it is good",
                "line 7: quality Draft: stages.Taubin=Lattice(rounds: 1, edge_mm: 4) -> stages.Taubin=GridMesher(edge: \"4 mm\")",
                "line 10: quality Fine: stages.Lattice.rounds=9 removed: the mesh is improved until it is good",
            ]
        );
        let again = migrate(&new.text, "x.ron", &registry()).unwrap();
        assert_eq!((again.text.as_str(), again.changes.len()), (new.text.as_str(), 0));
    }

    #[test]
    fn the_version_of_parameters_counts_the_changes() {
        assert_eq!(registry().params_version("GridMesher"), 5);
        assert_eq!(registry().params_version("Canny"), 1);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_cut_of_a_file_is_migrated_or_refused_and_once_is_enough(at in 0usize..400, cut in 0usize..40) {
            let at = (0..=at.min(OLD.len())).rev().find(|i| OLD.is_char_boundary(*i)).unwrap();
            let to = (at..=(at + cut).min(OLD.len())).rev().find(|i| OLD.is_char_boundary(*i)).unwrap();
            let text = format!("{}{}", &OLD[..at], &OLD[to..]);
            if let Ok(new) = migrate(&text, "x.ron", &registry()) {
                let again = migrate(&new.text, "x.ron", &registry());
                prop_assert_eq!(again.map(|a| a.text).ok(), Some(new.text));
            }
        }
    }
}
