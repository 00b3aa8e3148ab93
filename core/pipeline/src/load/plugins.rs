//! The plugins that a pipeline names: `plugins: ["libsdf.so", (file: "libx.so", blake3: "...")]`.

use super::fault::Fault;
use crate::load::syntax::tree::{Bracket, GroupEntry, ValueShape, ValueTree};
use crate::plugin::load_plugin;
use std::ops::Range;
use std::path::Path;
use toile_core::Registry;
use toile_core::param::ron_options;

/// A plugin that a pipeline asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PluginUse {
    /// The library as the file names it, relative to the file.
    pub file: String,
    /// The BLAKE3 digest that it must have.
    pub blake3: Option<String>,
    /// Where the file names it.
    pub span: Range<usize>,
}

/// The code of a plugin that is refused.
pub(super) const REFUSED: &str = "plugin_refused";

/// Hexadecimal digits of a digest.
const DIGITS: usize = 64;

/// Reads the field's value.
pub(super) fn read(text: &str, value: &ValueTree, faults: &mut Vec<Fault>) -> Vec<PluginUse> {
    let bad = |message: &str, span: &Range<usize>| Fault::new("bad_value", message).at(span, "");
    let ValueShape::Group { name: None, bracket: Bracket::Square, entries, .. } = &value.shape else {
        if !value.is_broken {
            faults.push(bad("`plugins` must be a list of texts", &value.span));
        }
        return Vec::new();
    };
    let whole = entries.iter().filter(|e| !e.value.is_broken);
    let read = whole.map(|e| one(text, &e.value).map_err(|(what, span)| bad(&what, &span)));
    read.filter_map(|r| r.map_err(|f| faults.push(f)).ok()).collect()
}

type Wrong = (String, Range<usize>);

fn one(text: &str, value: &ValueTree) -> Result<PluginUse, Wrong> {
    let wrong = || {
        (
            "`plugins` must be text in quotes, or (file: \"...\", blake3: \"...\")".to_owned(),
            value.span.clone(),
        )
    };
    let words = |tree: &ValueTree| -> Result<String, Wrong> {
        let parsed = text.get(tree.span.clone()).and_then(|t| ron_options().from_str(t).ok());
        parsed.ok_or_else(|| ("`plugins` must be text in quotes".to_owned(), tree.span.clone()))
    };
    let ValueShape::Group { name: None, bracket: Bracket::Round, entries, .. } = &value.shape else {
        return Ok(PluginUse { file: words(value)?, blake3: None, span: value.span.clone() });
    };
    let mut found = PluginUse { file: String::new(), blake3: None, span: value.span.clone() };
    for (i, entry) in entries.iter().enumerate() {
        let name = |e: &GroupEntry| e.key.as_ref().and_then(|k| text.get(k.clone()));
        let key = entry.key.as_ref().filter(|_| entries[..i].iter().any(|e| name(e) == name(entry)));
        if let Some(key) = key {
            return Err((format!("the field `{}` is given twice", name(entry).unwrap_or("")), key.clone()));
        }
        match entry.key.as_ref().and_then(|k| text.get(k.clone())) {
            Some("file") => found.file = words(&entry.value)?,
            Some("blake3") => found.blake3 = Some(digest(words(&entry.value)?, &entry.value)?),
            _ => return Err(wrong()),
        }
    }
    if found.file.is_empty() { Err(wrong()) } else { Ok(found) }
}

fn digest(text: String, at: &ValueTree) -> Result<String, Wrong> {
    match text.len() == DIGITS && text.chars().all(|c| c.is_ascii_hexdigit()) {
        true => Ok(text),
        false => Err((format!("`blake3` must be {DIGITS} hexadecimal digits"), at.span.clone())),
    }
}

/// The plugins that a pipeline's text asks for, as far as it can be understood; its faults are
/// reported by the load itself.
pub fn asked(text: &str) -> Vec<PluginUse> {
    let Some(tree) = crate::load::syntax::repair::read(text).0 else { return Vec::new() };
    let named =
        tree.entries().iter().find(|e| e.key.as_ref().and_then(|k| text.get(k.clone())) == Some("plugins"));
    named.map(|e| read(text, &e.value, &mut Vec::new())).unwrap_or_default()
}

/// A registry with the stages of the plugins that a text asks for; `base` is the folder that their
/// paths are relative to. What is refused is left out: the load of the text says why.
pub fn known(text: &str, base: &Path, registry: &Registry) -> Registry {
    let mut registry = registry.clone();
    load(text, base, &mut registry);
    registry
}

/// Loads what the text asks for into the registry; what is refused becomes a fault at its place.
pub(super) fn load(text: &str, base: &Path, registry: &mut Registry) -> Vec<Fault> {
    let asked = asked(text);
    let loads = asked.into_iter().filter_map(|p| {
        let refused = load_plugin(registry, &base.join(&p.file), p.blake3.as_deref()).err()?;
        let message = format!("the plugin \"{}\" is refused: {}", p.file, refused.reason);
        Some(Fault::new(REFUSED, message).at(&p.span, "").hint(refused.hint))
    });
    loads.collect()
}
