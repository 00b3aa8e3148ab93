//! Types as cards describe them in words.

use serde_json::{Map, Value, json};

/// A number and a unit.
pub(super) const LENGTH: &str = "^\\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?\\s*(mm|cm|m|in)\\s*$";

/// The schema of a type as a card's words describe it; anything goes for words that are not known.
pub(super) fn kind(words: &str) -> Value {
    let words = words.trim();
    let choices = split(words, " | ");
    if let Some(inner) = words.strip_suffix(" (or None)") {
        return json!({ "anyOf": [kind(inner), { "type": "null" }] });
    }
    if let Some(inner) = words.strip_prefix("list of ") {
        return json!({ "type": "array", "items": kind(inner) });
    }
    match words {
        "number" => return json!({ "type": "number" }),
        "whole number" => return json!({ "type": "integer" }),
        "length" => return json!({ "type": "string", "pattern": LENGTH }),
        "true | false" => return json!({ "type": "boolean" }),
        "text" => return json!({ "type": "string" }),
        "panel.edge" => return json!({ "type": "string", "pattern": "^[^.]+\\.[^.]+$" }),
        "..." => return json!({}),
        _ => {}
    }
    if choices.len() > 1 {
        return json!({ "anyOf": choices.into_iter().map(kind).collect::<Vec<_>>() });
    }
    if let Some(inner) = enclosed(words, '{', '}').and_then(|w| w.strip_prefix("name: ")) {
        return json!({ "type": "object", "additionalProperties": kind(inner) });
    }
    if let Some(inner) = enclosed(words, '(', ')') {
        return group(inner);
    }
    match words.split_once('(') {
        None if is_name(words) => json!({ "const": words }),
        Some((name, rest)) if is_name(name) => {
            let value = group(rest.strip_suffix(')').unwrap_or(rest));
            json!({ "type": "object", "properties": { name: value }, "required": [name], "additionalProperties": false })
        }
        _ => json!({}),
    }
}

/// What stands between brackets: named fields, one value, or several in their order.
fn group(inner: &str) -> Value {
    let parts = split(inner, ", ");
    let named: Option<Vec<(&str, &str)>> = parts.iter().map(|p| p.split_once(": ")).collect();
    match (named, parts.as_slice()) {
        (Some(fields), _) => {
            let fields: Map<String, Value> =
                fields.into_iter().map(|(name, words)| (name.to_owned(), kind(words))).collect();
            json!({ "type": "object", "properties": fields })
        }
        (None, [one]) => kind(one),
        (None, several) => {
            let n = several.len();
            let items: Vec<Value> = several.iter().map(|w| kind(w)).collect();
            json!({ "type": "array", "prefixItems": items, "minItems": n, "maxItems": n })
        }
    }
}

fn is_name(word: &str) -> bool {
    word.starts_with(char::is_uppercase) && word.chars().all(|c| c.is_alphanumeric() || c == '_')
}

fn enclosed(words: &str, open: char, close: char) -> Option<&str> {
    words.strip_prefix(open)?.strip_suffix(close)
}

/// Cuts at a separator outside of all brackets.
fn split<'a>(words: &'a str, by: &str) -> Vec<&'a str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0, 0);
    for (i, c) in words.char_indices() {
        match c {
            '(' | '{' | '[' => depth += 1,
            ')' | '}' | ']' => depth -= 1,
            _ => {}
        }
        if depth == 0 && i >= start && words[i..].starts_with(by) {
            parts.push(&words[start..i]);
            start = i + by.len();
        }
    }
    parts.push(&words[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_types() {
        assert_eq!(
            kind("list of (number, number)"),
            json!({ "type": "array", "items": {
            "type": "array", "prefixItems": [{ "type": "number" }, { "type": "number" }], "minItems": 2, "maxItems": 2 } })
        );
        assert_eq!(
            kind("whole number (or None)"),
            json!({ "anyOf": [{ "type": "integer" }, { "type": "null" }] })
        );
        assert_eq!(kind("Y | Z"), json!({ "anyOf": [{ "const": "Y" }, { "const": "Z" }] }));
        let mean = json!({ "type": "object", "properties": { "Mean": { "type": "object", "properties": { "offset": {} } } },
            "required": ["Mean"], "additionalProperties": false });
        assert_eq!(kind("Mean(offset: ...) | Flat"), json!({ "anyOf": [mean, { "const": "Flat" }] }));
        let photos = kind("{name: (file: text, width: length) | MirrorOf(text)}");
        let entry = &photos["additionalProperties"]["anyOf"];
        assert_eq!(entry[0]["properties"]["file"], json!({ "type": "string" }));
        assert_eq!(entry[1]["properties"]["MirrorOf"], json!({ "type": "string" }));
    }
}
