//! The JSON schema of pipeline files, written from the stages' cards.
//!
//! A pipeline file is RON; the schema describes the same values as JSON, for editors and for
//! programs that write pipelines. RON's names become JSON's objects of one field:
//!
//! | RON | JSON |
//! |---|---|
//! | `(name: "vest", stages: [...])` | `{"name": "vest", "stages": [...]}` |
//! | `Otsu(bias: 3)` | `{"Otsu": {"bias": 3}}` |
//! | `Canny()` | `{"Canny": {}}` |
//! | `Preset("poplin")`, a single value without a name | `{"Preset": "poplin"}` |
//! | `Eight`, a choice | `"Eight"` |
//! | `Sauvola(k: 0.1)`, a choice with values | `{"Sauvola": {"k": 0.1}}` |
//! | `Match("front.hem", "back.hem")` | `{"Match": ["front.hem", "back.hem"]}` |
//! | `(0.01, 60)` | `[0.01, 60]` |
//! | `None` | `null` |
//!
//! Types are read from the words by which cards describe them, so that a schema cannot say other
//! than the card.

mod kind;

use kind::{LENGTH, kind};
use serde_json::{Map, Value, json};
use toile_core::{Card, ParamDoc, Registry, SectionValue};
use toile_pipeline::{MAX_QUALITIES, MAX_SETTINGS};

/// What an id is made of: it names a folder.
const ID: &str = "^[A-Za-z0-9_-]{1,64}$";

/// The schema of the pipelines that a registry's stages make.
pub(crate) fn schema(registry: &Registry) -> Value {
    let mut defs = Map::new();
    registry.cards().for_each(|card| drop(defs.insert(key(registry, card), stage(card))));
    let any_stage: Vec<Value> = registry.cards().map(|c| reference(registry, c)).collect();
    let mut fields = Map::new();
    fields.insert("name".into(), json!({ "type": "string", "description": "The pipeline's name." }));
    fields
        .insert("stages".into(), json!({ "type": "array", "minItems": 1, "items": { "anyOf": any_stage } }));
    fields.insert("plugins".into(), plugins());
    fields.insert("qualities".into(), qualities());
    for section in registry.sections() {
        fields.insert(section.field.into(), section_schema(registry, section.holds));
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A pipeline of Toile as a JSON value",
        "description": "RON's `Name(field: value)` is written {\"Name\": {\"field\": value}}, a choice `Eight` \"Eight\".",
        "type": "object",
        "properties": fields,
        "required": ["stages"],
        "additionalProperties": false,
        "$defs": defs,
    })
}

/// A stage's name; with its role where two share it.
fn key(registry: &Registry, card: &Card) -> String {
    match registry.named(card.name).count() {
        1 => card.name.to_owned(),
        _ => format!("{}_{}", card.name, card.role.as_str().replace(' ', "_")),
    }
}

fn reference(registry: &Registry, card: &Card) -> Value {
    json!({ "$ref": format!("#/$defs/{}", key(registry, card)) })
}

fn plugins() -> Value {
    let pinned = json!({ "type": "object", "properties": { "file": { "type": "string" },
        "blake3": { "type": "string", "pattern": "^[0-9a-fA-F]{64}$" } }, "required": ["file"],
        "additionalProperties": false });
    json!({ "type": "array", "items": { "anyOf": [{ "type": "string" }, pinned] },
        "description": "Plugins to load, relative to the file." })
}

fn qualities() -> Value {
    let fields = json!({
        "name": { "type": "string", "pattern": "^[\\p{L}\\p{N}_-]([\\p{L}\\p{N} _-]{0,62}[\\p{L}\\p{N}_-])?$" },
        "max_error": { "type": "string", "pattern": LENGTH, "description": "95 % of the surface lie this near to the reference." },
        "set": { "type": "array", "maxItems": MAX_SETTINGS, "items": { "type": "string", "pattern": "^[^=]+=" },
            "description": "What it sets, each PATH=VALUE as for --set." },
        "measured": { "type": "string", "description": "The measurement that it rests on." },
        "measured_for": { "type": "string", "pattern": "^[0-9a-f]{16}-[0-9a-f]{16}$",
            "description": "What it was measured for: digests of the pipeline up to the garment and of its stages' versions." },
    });
    let quality = json!({ "type": "object", "properties": fields, "required": ["name", "max_error", "set"],
        "additionalProperties": false });
    let named = json!({ "type": "object", "properties": { "Quality": quality }, "required": ["Quality"],
        "additionalProperties": false });
    json!({ "type": "array", "items": named, "maxItems": MAX_QUALITIES,
        "description": "Named settings by the error that they keep; `toile tune --quality` measures them." })
}

fn section_schema(registry: &Registry, holds: SectionValue) -> Value {
    match holds {
        SectionValue::Stage(role) => {
            let fits: Vec<Value> = registry.of_role(role).map(|c| reference(registry, c)).collect();
            json!({ "anyOf": fits })
        }
        SectionValue::Table { stage, param } => {
            let doc = registry.card(stage).and_then(|c| c.params.iter().find(|p| p.name == param));
            doc.map_or(json!({}), parameter)
        }
    }
}

fn stage(card: &Card) -> Value {
    let mut fields = Map::new();
    fields.insert("id".into(), json!({ "type": "string", "pattern": ID }));
    let ids = json!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }] });
    fields.insert("from".into(), ids);
    card.params.iter().for_each(|p| drop(fields.insert(p.name.into(), parameter(p))));
    let named = json!({ "type": "object", "properties": fields, "additionalProperties": false });
    let value = match card.params.first() {
        Some(first) => json!({ "anyOf": [named, parameter(first)] }),
        None => named,
    };
    json!({
        "description": format!("{}: {}", card.role.as_str(), card.summary()),
        "type": "object",
        "properties": { card.name: value },
        "required": [card.name],
        "additionalProperties": false,
    })
}

fn parameter(p: &ParamDoc) -> Value {
    let mut schema = kind(&p.kind);
    bound(&mut schema, p);
    if let Value::Object(fields) = &mut schema {
        let unit = if p.unit.is_empty() { String::new() } else { format!(" [{}]", p.unit) };
        let range = p.range().map_or(String::new(), |r| format!(" ({r})"));
        let doc = p.doc.split_whitespace().collect::<Vec<_>>().join(" ");
        fields.insert("description".into(), json!(format!("{doc}{unit}{range}")));
        fields.insert("x-default".into(), json!(p.default));
    }
    schema
}

/// Ranges of plain numbers; those of lengths stand in the description, since a length is a text.
fn bound(schema: &mut Value, p: &ParamDoc) {
    if p.kind != "number" && p.kind != "whole number" {
        return;
    }
    let Value::Object(fields) = schema else { return };
    p.min.into_iter().for_each(|x| drop(fields.insert("minimum".into(), json!(x))));
    p.max.into_iter().for_each(|x| drop(fields.insert("maximum".into(), json!(x))));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_has_its_place_and_every_parameter_a_type() {
        let registry = crate::registry();
        let schema = schema(&registry);
        for card in registry.cards() {
            let stage = &schema["$defs"][key(&registry, card)]["properties"][card.name];
            let fields = stage.get("anyOf").map_or(stage, |choices| &choices[0]);
            for p in &card.params {
                let param = &fields["properties"][p.name];
                let typed = ["type", "anyOf", "const"].iter().any(|word| param.get(word).is_some());
                assert!(typed, "{}.{}: {} is not understood", card.name, p.name, p.kind);
            }
        }
    }
}
