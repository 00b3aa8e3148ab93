//! The settings of a file's named qualities, brought up to date with the stages that they set.
//!
//! A setting is text in the form of `--set`: its path names a stage by its id, which changes with
//! the stage's name where the file gives none, and a parameter; its value may be a whole stage.
//! Limit: a path into the parts of a value follows the parameter's new name, but what it points at
//! is left.

use super::super::qualities::{Quality, named};
use super::super::read::FileContents;
use super::super::{Override, parse};
use super::is_read_from;
use super::rewrite::{Followed, Migrator, TextEdit};
use crate::load::old_name::renamed;
use crate::load::syntax::cut::whole;
use crate::load::syntax::draft::Draft;
use crate::load::syntax::tree::{GroupEntry, ValueTree};
use std::ops::Range;
use toile_core::param::ron_text;

/// What becomes of a setting.
enum MigratedSetting {
    Same,
    Removed(String),
    Changed(Override),
}

/// The stage that a setting's path leads to.
struct MigratedStage {
    /// How many segments of the path name it.
    segments: usize,
    /// The path to it, as it is after the migration.
    path: String,
    /// The name that the file gives it.
    stage: String,
}

impl Migrator<'_> {
    /// Rewrites the settings of every quality.
    pub(super) fn qualities(&mut self, tree: &ValueTree, drafts: &FileContents) {
        for quality in named(self.text) {
            let places = quality.places().to_vec();
            for (setting, place) in quality.set.iter().zip(&places) {
                match self.setting(setting, tree, drafts) {
                    MigratedSetting::Same => {}
                    MigratedSetting::Changed(new) => self.rewrite(&quality, setting, &new, place),
                    MigratedSetting::Removed(why) => self.remove(&quality, setting, why, tree, place),
                }
            }
        }
    }

    fn rewrite(&mut self, quality: &Quality, old: &Override, new: &Override, at: &Range<usize>) {
        let (old, new) = (written(old), written(new));
        let what = format!("quality {}: {old} -> {new}", quality.name);
        self.edits.push(TextEdit { at: at.clone(), text: ron_text(&new), what });
    }

    fn remove(
        &mut self,
        quality: &Quality,
        old: &Override,
        why: String,
        tree: &ValueTree,
        at: &Range<usize>,
    ) {
        let Some((entries, i)) = entry(tree, at) else { return };
        let what = format!("quality {}: {} removed: {why}", quality.name, written(old));
        self.edits.push(TextEdit { at: whole(self.text, entries, i), text: String::new(), what });
    }

    fn setting(&self, o: &Override, tree: &ValueTree, drafts: &FileContents) -> MigratedSetting {
        let segments: Vec<&str> = o.path.split('.').collect();
        let Some(target) = self.target(&segments, tree, drafts) else { return MigratedSetting::Same };
        let mut new = Override { path: target.path.clone(), value: o.value.clone() };
        match &segments[target.segments..] {
            [] => new.value = self.whole_stage(&o.value),
            [param, parts @ ..] => {
                let now = renamed(self.registry, &target.stage).map(|now| now.name);
                let stages: Vec<&str> = [Some(target.stage.as_str()), now].into_iter().flatten().collect();
                let (param, value) = match self.followed(&stages, param, &o.value) {
                    Followed::Removed(why) => return MigratedSetting::Removed(why.to_owned()),
                    Followed::Renamed(name, value) if parts.is_empty() => (name, value),
                    Followed::Renamed(name, _) => (name, o.value.clone()),
                    Followed::Same => ((*param).to_owned(), o.value.clone()),
                };
                new.path = [&[target.path.as_str(), param.as_str()], parts].concat().join(".");
                new.value = value;
            }
        }
        if new == *o { MigratedSetting::Same } else { MigratedSetting::Changed(new) }
    }

    /// The stage of the file that a path leads to: one of the list by its id, or a section. An id
    /// that the file has not may be that of a stage which an earlier setting puts there.
    fn target(&self, segments: &[&str], tree: &ValueTree, drafts: &FileContents) -> Option<MigratedStage> {
        if segments.first() == Some(&"stages") {
            let id = *segments.get(1)?;
            let draft = drafts.stages.iter().find(|d| d.id == id);
            let stage = draft.map_or(id, |d| d.name.as_str()).to_owned();
            let path = format!("stages.{}", self.new_id(id, draft, drafts));
            return Some(MigratedStage { segments: 2, path, stage });
        }
        let field = *segments.first()?;
        let is_field = |e: &&GroupEntry| e.key.as_ref().is_some_and(|k| self.at(k) == field);
        let value = &tree.entries().iter().find(is_field)?.value;
        let draft = drafts.sections.iter().find(|d| d.span == value.span && !d.is_table)?;
        Some(MigratedStage { segments: 1, path: field.to_owned(), stage: draft.name.clone() })
    }

    fn new_id(&self, id: &str, draft: Option<&Draft>, drafts: &FileContents) -> String {
        let is_own = draft.is_some_and(|d| d.given_id.is_some() || is_read_from(d, drafts) || d.name != id);
        let new = if is_own { None } else { renamed(self.registry, id) };
        new.map_or(id, |now| now.name).to_owned()
    }

    /// A whole stage as a value, with its new names.
    fn whole_stage(&self, value: &str) -> String {
        let Ok(tree) = parse(value) else { return value.to_owned() };
        let mut inner =
            Migrator { text: value, registry: self.registry, edits: Vec::new(), faults: Vec::new() };
        inner.stage(&tree, None);
        // What is given twice is left, and the load names it.
        if inner.faults.is_empty() { inner.finish().text } else { value.to_owned() }
    }
}

fn written(o: &Override) -> String {
    format!("{}={}", o.path, o.value)
}

/// The list that an entry stands in, and its number.
fn entry<'t>(tree: &'t ValueTree, at: &Range<usize>) -> Option<(&'t [GroupEntry], usize)> {
    let entries = tree.entries();
    match entries.iter().position(|e| e.value.span == *at) {
        Some(i) => Some((entries, i)),
        None => {
            let covers = |e: &&GroupEntry| e.value.span.start <= at.start && at.end <= e.value.span.end;
            entry(&entries.iter().find(covers)?.value, at)
        }
    }
}
