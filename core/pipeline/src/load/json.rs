//! A pipeline's RON text as a JSON value, in the form that docs/reference/pipeline.schema.json
//! describes: RON's `Name(field: value)` is `{"Name": {"field": value}}`, a choice `Eight` is
//! `"Eight"`, `None` is null.

use super::fault::Faults;
use super::parse;
use crate::load::syntax::tree::{Bracket, GroupEntry, ValueShape, ValueTree};
use serde_json::{Map, Value};
use toile_core::param::ron_options;

/// The text's value as JSON, for editors and programs; nothing is checked but the syntax.
///
/// Errors: the text is no RON.
pub fn to_json(text: &str, file: &str) -> Result<Value, Faults> {
    let tree = parse(text).map_err(|fault| Faults::new(file, text, vec![fault]))?;
    Ok(value(text, &tree))
}

fn value(text: &str, tree: &ValueTree) -> Value {
    let own = text.get(tree.span.clone()).unwrap_or("");
    match &tree.shape {
        ValueShape::Literal | ValueShape::Broken => literal(own),
        ValueShape::Name => name(own),
        ValueShape::Group { name: None, bracket: Bracket::Square, entries, .. } => list(text, entries),
        ValueShape::Group { name: None, entries, .. } if entries.iter().all(|e| e.key.is_none()) => {
            list(text, entries)
        }
        ValueShape::Group { name: None, entries, .. } => fields(text, entries),
        ValueShape::Group { name: Some(name), entries, .. } => {
            named(text, text.get(name.clone()).unwrap_or(""), entries)
        }
    }
}

/// A number, or a text without its quotes.
fn literal(own: &str) -> Value {
    let parsed = |own: &str| ron_options().from_str::<Value>(own).ok();
    parsed(own).unwrap_or_else(|| Value::from(own))
}

fn name(own: &str) -> Value {
    match own {
        "true" => Value::Bool(true),
        "false" => Value::Bool(false),
        "None" => Value::Null,
        choice => Value::from(choice),
    }
}

fn list(text: &str, entries: &[GroupEntry]) -> Value {
    entries.iter().map(|e| value(text, &e.value)).collect()
}

/// `field: value` or `"key": value`.
fn fields(text: &str, entries: &[GroupEntry]) -> Value {
    let key = |e: &GroupEntry| {
        let own = text.get(e.key.clone()?)?;
        Some(ron_options().from_str::<String>(own).unwrap_or_else(|_| own.to_owned()))
    };
    let pairs = entries.iter().filter_map(|e| Some((key(e)?, value(text, &e.value))));
    Value::Object(pairs.collect::<Map<_, _>>())
}

fn named(text: &str, name: &str, entries: &[GroupEntry]) -> Value {
    let inner = match entries {
        [one] if one.key.is_none() => value(text, &one.value),
        [first, ..] if first.key.is_none() => list(text, entries),
        _ => fields(text, entries),
    };
    match name {
        "Some" => inner,
        _ => Value::Object(Map::from_iter([(name.to_owned(), inner)])),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    #[test]
    fn names_lists_and_choices_have_one_form_each() {
        let text = r#"(name: "a", photos: { "front": (file: "f.jpg") }, stages: [Otsu(bias: -3, mask: Eight), Preset("x"),
            Match("a.b", "c.d"), Edge(at: (0.5, 60), last: None, first: Some(1), on: true), Glb()])"#;
        let want = json!({ "name": "a", "photos": { "front": { "file": "f.jpg" } }, "stages": [
            { "Otsu": { "bias": -3, "mask": "Eight" } }, { "Preset": "x" }, { "Match": ["a.b", "c.d"] },
            { "Edge": { "at": [0.5, 60], "last": null, "first": 1, "on": true } }, { "Glb": {} } ] });
        assert_eq!(to_json(text, "a.ron").unwrap(), want);
        assert!(to_json("(stages: [", "a.ron").is_err());
    }
}
