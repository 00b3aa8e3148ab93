//! Pipeline files: from RON text to a checked graph of stages.
//!
//! [`load`] works in four steps, and collects the faults of all of them:
//!
//! 1. `parser`: the text becomes a syntax tree that knows the place of every name and value; after
//!    a syntax fault it is read on as it was probably meant (`repair`);
//! 2. `read`: fields, sections and stages are read, every parameter is checked by its own
//!    [`ParamDoc`](toile_core::ParamDoc), clean stages are made through typetag;
//! 3. `order`: stages get their ids, sections their place among the stages;
//! 4. `graph`: each input port finds the stage that feeds it; then `by_place` gives stages what
//!    follows from their place.
//!
//! The settings of a requested quality and the `--set` overrides are spliced into the text before
//! step 1, so that they pass the same checks; `qualities` are checked beside the file. `origin`
//! shows what is wrong where the user wrote it: in the file or in the option. `unused` lists the
//! stages of a file without faults whose results nothing uses.
//!
//! Cost: linear in the text, and in stages times names. Limits: [`MAX_BYTES`], [`MAX_STAGES`].
//!
//! Architecture invariant: nothing here knows a stage by name. Which top-level fields there are
//! is said by the registry's sections.

mod asked;
mod by_place;
mod differing;
mod edit;
mod fault;
mod graph;
mod json;
mod migrate;
mod old_name;
mod order;
mod origin;
mod overrides;
mod pick;
mod pipeline;
mod place;
mod plugins;
mod qualities;
mod read;
mod setting;
mod syntax;
pub(crate) mod words;

#[cfg(test)]
pub(crate) mod tests;

pub(crate) use asked::warnings;
pub use asked::{Reads, faults};
pub use differing::{Differing, differing};
pub use edit::{PipelineEdit, edited};
pub use fault::{Fault, FaultRecord, Faults, Label};
pub(crate) use graph::before_flatteners;
pub use json::to_json;
pub use migrate::{Migrated, migrate};
use overrides::Given;
pub use pipeline::Pipeline;
pub use plugins::{PluginUse, asked as plugins_asked, known as with_plugins};
pub use qualities::{
    Basis, MAX_QUALITIES, MAX_SETTINGS, Quality, Standing, fill as fill_qualities,
    without as without_qualities,
};
pub use setting::Override;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use toile_core::{Feed, Node, Registry};

/// The largest pipeline file, bytes: a thousand times what a garment needs.
pub const MAX_BYTES: usize = 4 << 20;

/// The most faults that one load reports; a file with more has one cause for most.
pub const MAX_FAULTS: usize = 200;

/// The most stages that a pipeline may hold; bounds the work of the graph check.
pub const MAX_STAGES: usize = 1000;

/// What a load changes in the file.
#[derive(Debug, Clone, Copy, Default)]
pub struct Changes<'a> {
    /// The quality whose settings are applied first.
    pub quality: Option<&'a str>,
    /// `--set`, applied after it.
    pub set: &'a [Override],
    /// True of the text of a [`Pipeline`] that was loaded before: settings of qualities were
    /// checked then, against the file as it was.
    pub again: bool,
    /// True where what stages find wrong comes out with the faults of the file: what
    /// [`faults`] finds where it has none. Files are then looked at.
    pub asks: bool,
}

/// Loads a pipeline file: `text` is its content, `file` the name to show, `base` the folder that
/// its paths are relative to.
///
/// Errs with every fault of the file at once.
pub fn load(
    text: &str,
    file: &str,
    base: &Path,
    registry: &Registry,
    overrides: &[Override],
) -> Result<Pipeline, Faults> {
    load_with(text, file, base, registry, &Changes { set: overrides, ..Changes::default() })
}

/// Loads a pipeline file with one of its qualities.
///
/// Errs as [`load`], and where the file has no quality of that name.
pub fn load_with(
    text: &str,
    file: &str,
    base: &Path,
    registry: &Registry,
    changes: &Changes<'_>,
) -> Result<Pipeline, Faults> {
    if text.len() > MAX_BYTES {
        let message = format!("the file has {} bytes, the limit is {MAX_BYTES}", text.len());
        return Err(Faults::new(file, text, vec![Fault::new("too_large", message).at(&(0..0), "")]));
    }
    // Overrides may name a plugin, and may name stages of plugins.
    let mut registry = registry.clone();
    let mut refused = plugins::load(text, base, &mut registry);
    let (mut applied, known) = applied(text, &registry, changes);
    if plugins::asked(&applied.text) != plugins::asked(text) || !refused.is_empty() {
        refused = plugins::load(&applied.text, base, &mut registry);
    }
    let mut faults: Vec<Fault> = std::mem::take(&mut applied.refused).into_iter().map(|(_, f)| f).collect();
    faults.append(&mut refused);
    let told = |faults: Vec<Fault>, origin: &origin::TextChanges| -> Vec<Fault> {
        faults.into_iter().map(|fault| origin.told(fault)).chain(known.clone()).collect()
    };
    let lacks_plugin = faults.iter().any(|f| f.code == plugins::REFUSED);
    let Some((read, drafts, feeds)) = check(&applied.text, (&registry, lacks_plugin), &mut faults) else {
        return Err(Faults::new(file, text, told(faults, &applied.origin)));
    };
    let is_clean = faults.is_empty() && known.is_empty();
    let of_values = faults.iter().all(|f| f.code == "bad_value");
    if !is_clean && !changes.asks {
        return Err(Faults::new(file, text, told(faults, &applied.origin)));
    }
    let is_doubled = |f: &&Fault| f.code == "duplicate_field";
    let doubled = faults.iter().filter(is_doubled).flat_map(|f| f.labels.iter().map(|l| l.span.clone()));
    let doubled: Vec<Range<usize>> = doubled.collect();
    let mut found = told(faults, &applied.origin);
    let stem = || Path::new(file).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let (name, plugins) = (read.name.unwrap_or_else(stem), read.plugins);
    let (qualities, quality) = (read.qualities, changes.words());
    let made = syntax::draft::finished(drafts, feeds);
    // What feeds a stage is not known of a file with other faults than values.
    let syntax::draft::Finished { mut nodes, own, alone } = if of_values { made } else { made.apart() };
    by_place::settle(&mut nodes, &applied.text, &registry);
    let written = (text.to_owned(), applied.origin);
    let (base, file_name) = (base.to_owned(), file.to_owned());
    let mut pipeline = Pipeline {
        name,
        file: file_name,
        text: applied.text,
        base,
        nodes,
        plugins,
        qualities,
        quality,
        written,
    };
    if is_clean {
        return Ok(pipeline);
    }
    // What a stage says of a part with a key that is given twice would only follow from that.
    let is_spared = |node: &Node| doubled.iter().any(|place| within(place, &node.span));
    let asked = |i: usize| own.get(i) == Some(&true) && !pipeline.nodes.get(i).is_some_and(is_spared);
    let more = asked::faults(&pipeline, asked, None);
    found.extend(more.err().into_iter().flat_map(|f| f.faults));
    for node in alone.into_iter().filter(|node| !is_spared(node)) {
        pipeline.nodes = vec![node];
        found.extend(asked::faults(&pipeline, |_| true, None).err().into_iter().flat_map(|f| f.faults));
    }
    Err(Faults::new(file, text, found))
}

/// Whether a place lies in another.
fn within(place: &Range<usize>, other: &Range<usize>) -> bool {
    other.start <= place.start && place.end <= other.end && !other.is_empty()
}

impl Changes<'_> {
    /// The quality in words.
    fn words(&self) -> Option<String> {
        let changed = if self.set.is_empty() { "" } else { ", changed by --set" };
        self.quality.map(|name| format!("{name}{changed}"))
    }
}

/// The text with the changes, and faults of the text as it stands; a quality with a fault is not
/// applied, since its fault says it all.
fn applied(text: &str, registry: &Registry, changes: &Changes<'_>) -> (overrides::Applied, Vec<Fault>) {
    let mut faults = if changes.again { Vec::new() } else { qualities::settings(text, registry) };
    let chosen =
        changes.quality.map(|name| qualities::choose(text, qualities::named(text), name)).transpose();
    let chosen = chosen.map_err(|fault| faults.push(*fault)).ok().flatten().filter(|_| faults.is_empty());
    let of_quality = chosen.iter().flat_map(Given::of_quality);
    let given: Vec<Given<'_>> = of_quality.chain(changes.set.iter().map(Given::set)).collect();
    (overrides::apply(text, registry, &given), faults)
}

/// Reads and connects the stages; none where the text cannot be understood. The registry may lack a
/// plugin that is refused.
fn check(
    text: &str,
    (registry, lacks_plugin): (&Registry, bool),
    faults: &mut Vec<Fault>,
) -> Option<(read::FileContents, Vec<syntax::draft::Draft>, Vec<Vec<Feed>>)> {
    let (tree, mut of_syntax) = syntax::repair::read(text);
    faults.append(&mut of_syntax);
    let mut tree = tree?;
    syntax::escapes::controls(text, &mut tree, faults);
    read::doubled_keys(text, &tree, faults);
    let mut read = read::file(text, &tree, (registry, lacks_plugin), faults);
    let drafts = order::place(std::mem::take(&mut read.sections), std::mem::take(&mut read.stages));
    let feeds = graph::connect(&drafts, registry, faults);
    // What `ron` alone finds is rare (an unknown extension), and weaker than our own words.
    if let (true, Some(fault)) = (faults.is_empty(), refused_by_ron(text)) {
        faults.push(fault);
    }
    Some((read, drafts, feeds))
}

/// The fields of a stage's parameters, `(lambda: 0.5)`: name and value as text; none where it is no
/// such text.
pub fn fields_of(params: &str) -> BTreeMap<String, String> {
    let Ok(tree) = parse(params) else { return BTreeMap::new() };
    let text = |span: &Range<usize>| params.get(span.clone()).unwrap_or("").to_owned();
    let field = |e: &syntax::tree::GroupEntry| Some((text(e.key.as_ref()?), text(&e.value.span)));
    tree.entries().iter().filter_map(field).collect()
}

/// Every text in a stage's parameters.
pub(crate) fn texts_of(params: &str) -> Vec<String> {
    fn walk(params: &str, tree: &syntax::tree::ValueTree, texts: &mut Vec<String>) {
        let text = params.get(tree.span.clone()).filter(|t| t.starts_with(['"', 'r']));
        texts.extend(text.and_then(|t| toile_core::param::ron_options().from_str::<String>(t).ok()));
        tree.entries().iter().for_each(|e| walk(params, &e.value, texts));
    }
    let mut texts = Vec::new();
    if let Ok(tree) = parse(params) {
        walk(params, &tree, &mut texts);
    }
    texts
}

pub(crate) fn parse(text: &str) -> Result<syntax::tree::ValueTree, Fault> {
    syntax::parser::parse(text).map_err(|e| syntax::repair::plain(&e))
}

fn refused_by_ron(text: &str) -> Option<Fault> {
    let bare = text.trim_start_matches('\u{feff}');
    let e = toile_core::param::ron_options().from_str::<serde::de::IgnoredAny>(bare).err()?;
    let (message, at) = toile_core::param::ron_fault(bare, &e);
    let from = text.len() - bare.len() + at.unwrap_or(0);
    let to = text[from..].chars().next().map_or(from, |c| from + c.len_utf8());
    Some(Fault::new("syntax", message).at(&(from..to), ""))
}
