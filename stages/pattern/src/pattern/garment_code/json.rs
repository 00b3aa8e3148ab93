//! JSON as a tree that keeps the order of the file and everything that it says twice.
//!
//! Cost: linear in the text. Limits: [`MOST_VALUES`] values; nesting as deep as `serde_json` goes.

use super::damage::SpecificationDamage;
use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeSet;

/// Values in one file; the largest known garment has some ten thousand.
const MOST_VALUES: usize = 2_000_000;
/// Bytes of one file; the largest known garment has 70 kB.
const MOST_BYTES: usize = 16 << 20;

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Json {
    Null,
    Flag(bool),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    /// Fields in the order of the file, each as often as it stands there.
    Object(Vec<(String, Json)>),
}

impl Json {
    /// Reads a text.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, SpecificationDamage> {
        if bytes.len() > MOST_BYTES {
            return Err(SpecificationDamage::Large { bytes: bytes.len(), most: MOST_BYTES });
        }
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if bytes.iter().all(u8::is_ascii_whitespace) {
            return Err(SpecificationDamage::Empty);
        }
        // ASCII in 16 bits has a zero in every other byte.
        if bytes.iter().take(64).filter(|b| **b == 0).count() > bytes.len().min(64) / 4 {
            return Err(SpecificationDamage::Wide);
        }
        let commas = bytes.iter().filter(|b| **b == b',').count();
        if commas > MOST_VALUES {
            return Err(SpecificationDamage::Many {
                what: "values",
                of: "the file".into(),
                count: commas + 1,
                most: MOST_VALUES,
            });
        }
        let json: Self = serde_json::from_slice(bytes).map_err(|e| syntax(bytes, &e))?;
        json.each_once("the file").map(|()| json)
    }

    /// Refuses a field that stands twice in an object; panels of one name are reported by the
    /// reader.
    fn each_once(&self, of: &str) -> Result<(), SpecificationDamage> {
        match self {
            Json::Object(fields) => {
                let mut seen = BTreeSet::new();
                let twice = fields.iter().find(|(k, _)| !seen.insert(k)).filter(|_| of != "`panels`");
                match twice {
                    Some((field, _)) => {
                        Err(SpecificationDamage::Twice { field: field.clone(), of: of.to_owned() })
                    }
                    None => fields.iter().try_for_each(|(k, v)| v.each_once(&format!("`{k}`"))),
                }
            }
            Json::List(items) => items.iter().try_for_each(|v| v.each_once(of)),
            Json::Null | Json::Flag(_) | Json::Number(_) | Json::Text(_) => Ok(()),
        }
    }

    /// What it is, in words.
    pub(super) fn words(&self) -> &'static str {
        match self {
            Json::Null => "null",
            Json::Flag(_) => "true or false",
            Json::Number(_) => "a number",
            Json::Text(_) => "a text",
            Json::List(_) => "a list",
            Json::Object(_) => "an object",
        }
    }

    /// The field of that name of an object: the last, where there are more.
    pub(super) fn field(&self, name: &str) -> Option<&Json> {
        match self {
            Json::Object(fields) => fields.iter().rev().find(|(k, _)| k == name).map(|(_, v)| v),
            Json::Null | Json::Flag(_) | Json::Number(_) | Json::Text(_) | Json::List(_) => None,
        }
    }
}

/// Why a text is no JSON, with its place; numbers that Python writes and JSON does not know are
/// told apart.
fn syntax(bytes: &[u8], e: &serde_json::Error) -> SpecificationDamage {
    let (line, column) = (e.line(), e.column());
    let row = bytes.split(|b| *b == b'\n').nth(line.saturating_sub(1)).unwrap_or_default();
    // The parser may report the fault at the first letter of the word or behind it.
    let near = &row[column.saturating_sub(4).min(row.len())..(column + 9).min(row.len())];
    let strange = ["NaN", "Infinity"].into_iter().find(|w| near.windows(w.len()).any(|x| x == w.as_bytes()));
    if let Some(word) = strange {
        return SpecificationDamage::NoNumber { word, line, column };
    }
    let before = &row[..column.min(row.len())];
    let at = [&b"//"[..], b"/*"].iter().find_map(|c| row.windows(2).position(|w| w == *c));
    if let Some(at) = at.filter(|at| *at < before.len() + 1 && !before[..*at].contains(&b'"')) {
        return SpecificationDamage::Comment { line, column: at + 1 };
    }
    let text = e.to_string();
    let what = text.rsplit_once(" at line ").map_or(text.as_str(), |(what, _)| what);
    SpecificationDamage::Syntax { what: what.to_owned(), line, column }
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Tree)
    }
}

struct Tree;

impl<'de> Visitor<'de> for Tree {
    type Value = Json;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E: de::Error>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E: de::Error>(self, flag: bool) -> Result<Json, E> {
        Ok(Json::Flag(flag))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Json, E> {
        Ok(Json::Number(number))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Json, E> {
        Ok(Json::Text(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Json, A::Error> {
        let mut out = Vec::new();
        while let Some(value) = list.next_element()? {
            out.push(value);
        }
        Ok(Json::List(out))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Json, A::Error> {
        let mut out = Vec::new();
        while let Some(entry) = map.next_entry()? {
            out.push(entry);
        }
        Ok(Json::Object(out))
    }
}
