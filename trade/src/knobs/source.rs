//! A pipeline file that is loaded again and again, each time with other overrides.

use std::path::PathBuf;
use toile_core::{Node, Registry, SectionValue};
use toile_pipeline::{Changes, Faults, Override, Pipeline, add_implicit, load_with};

/// A pipeline file with what the user has set, ready to be loaded with other settings.
#[derive(Debug, Clone)]
pub struct Source<'a> {
    /// Its text.
    pub text: String,
    /// Its name, for messages.
    pub file: String,
    /// The folder that its paths are relative to.
    pub base: PathBuf,
    /// The named quality, before `set`.
    pub quality: Option<String>,
    /// `--set`, before all knobs.
    pub set: Vec<Override>,
    /// The stages there are.
    pub registry: &'a Registry,
}

impl Source<'_> {
    /// Loads it with further overrides, and with the stages that every pipeline gets.
    ///
    /// Errors: every fault of the file.
    pub fn load(&self, more: &[Override]) -> Result<Pipeline, Box<Faults>> {
        let all: Vec<Override> = self.set.iter().chain(more).cloned().collect();
        let changes = Changes { quality: self.quality.as_deref(), set: &all, ..Changes::default() };
        let loaded = load_with(&self.text, &self.file, &self.base, self.registry, &changes);
        let mut pipeline = loaded.map_err(Box::new)?;
        add_implicit(&mut pipeline, self.registry);
        Ok(pipeline)
    }
}

/// The path by which overrides reach a stage: in the list, or in a section of the file.
pub(crate) fn path_of(source: &Source<'_>, pipeline: &Pipeline, node: &Node) -> String {
    let sections = source.registry.sections().iter().filter_map(|s| match s.holds {
        SectionValue::Stage(role) if role == node.card.role => Some(s.field.to_owned()),
        _ => None,
    });
    let text = pipeline.text.get(node.span.clone()).unwrap_or("").to_owned();
    // In its own place a stage's own text changes nothing; anywhere else it does not load.
    let is_its = |path: &String| {
        let same = source.load(&[Override { path: path.clone(), value: text.clone() }]);
        same.is_ok_and(|p| p.text == pipeline.text)
    };
    let in_list = format!("stages.{}", node.id);
    sections.chain([in_list.clone()]).find(is_its).unwrap_or(in_list)
}
