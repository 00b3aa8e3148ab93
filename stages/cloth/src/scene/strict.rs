//! Finds unknown and duplicate fields of a scene.
//!
//! The JSON reader would ignore unknown fields and take the last of duplicate ones. Method: one
//! pass over the text, which is known to be JSON. The known fields come from the structure that an
//! object is read into, so that there is one list. Cost: O(bytes).

use super::raw::{
    RawAir, RawBand, RawBody, RawContact, RawHeld, RawLimit, RawMaterial, RawPanel, RawPhase, RawScene,
    RawSeam,
};
use serde::de::value::Error;
use serde::{Deserialize, Deserializer, de, forward_to_deserialize_any};
use std::collections::BTreeSet;

/// More faults than this have one cause.
const MAX_FAULTS: usize = 20;

/// The path of everything within an unknown field.
const NOWHERE: &str = "?";

/// An unknown or duplicate field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldFault {
    /// Its name.
    pub field: String,
    /// What it stands in: `a panel`.
    pub of: &'static str,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// The fields that there are; none where it is one of them, but stands twice.
    pub known: &'static [&'static str],
}

impl std::fmt::Display for FieldFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { field, of, line, column, known } = self;
        let short: String = field.chars().take(40).collect();
        match known.is_empty() {
            true => {
                write!(f, "the field `{short}` of {of} is given twice, again at line {line} column {column}")
            }
            false => write!(f, "unknown field `{short}` of {of} at line {line} column {column}"),
        }
    }
}

/// An object that the walk is in.
struct Object {
    /// Where it stands: `panels.material`.
    path: String,
    /// The name under which the next value stands.
    field: String,
    seen: BTreeSet<String>,
}

/// All faults of a JSON text, in the order of their places.
pub(super) fn faults(text: &[u8]) -> Vec<FieldFault> {
    let mut faults = Vec::new();
    // None stands for a list: its objects have its path.
    let mut around: Vec<Option<Object>> = Vec::new();
    let mut is_name = false;
    let mut at = 0;
    while at < text.len() && faults.len() < MAX_FAULTS {
        match text[at] {
            b'{' => {
                let outer = around.iter().rev().flatten().next();
                let path = outer.map_or(String::new(), |o| match (fields(&o.path), &*o.path) {
                    (None, _) => NOWHERE.into(),
                    (_, "") => o.field.clone(),
                    (_, path) => format!("{path}.{}", o.field),
                });
                around.push(Some(Object { path, field: String::new(), seen: BTreeSet::new() }));
                is_name = true;
            }
            b'[' => {
                around.push(None);
                is_name = false;
            }
            b'}' | b']' => {
                around.pop();
                is_name = false;
            }
            b',' => is_name = matches!(around.last(), Some(Some(_))),
            b':' => is_name = false,
            b'"' => {
                let end = end_of_text(text, at);
                if let (true, Some(Some(object))) = (is_name, around.last_mut()) {
                    let name = serde_json::from_slice(&text[at..end]);
                    let name = name.unwrap_or_else(|_| String::from_utf8_lossy(&text[at..end]).into_owned());
                    let fault = object.enter(name);
                    faults.extend(fault.map(|(field, of, known)| {
                        let (line, column) = place(text, at);
                        FieldFault { field, of, line, column, known }
                    }));
                }
                at = end - 1;
            }
            _ => {}
        }
        at += 1;
    }
    faults
}

impl Object {
    /// Takes note of a name; what is wrong with it.
    fn enter(&mut self, name: String) -> Option<(String, &'static str, &'static [&'static str])> {
        self.field.clone_from(&name);
        let (of, known) = fields(&self.path)?;
        if !known.contains(&name.as_str()) {
            return Some((name, of, known));
        }
        let is_new = self.seen.insert(name.clone());
        (!is_new).then_some((name, of, &[]))
    }
}

/// What the object at a path is, and its fields.
pub(super) fn fields(path: &str) -> Option<(&'static str, &'static [&'static str])> {
    Some(match path {
        "" => ("the scene", fields_of::<RawScene>()),
        "panels" => ("a panel", fields_of::<RawPanel>()),
        "seams" => ("a seam", fields_of::<RawSeam>()),
        "bands" => ("a band", fields_of::<RawBand>()),
        "strain_limit" => ("the strain limit", fields_of::<RawLimit>()),
        "body" => ("the body", fields_of::<RawBody>()),
        "material" | "panels.material" => ("a material", fields_of::<RawMaterial>()),
        "phases" => ("a phase", fields_of::<RawPhase>()),
        "phases.air" => ("the air", fields_of::<RawAir>()),
        "held" => ("what is held", fields_of::<RawHeld>()),
        "held.contacts" => ("a contact", fields_of::<RawContact>()),
        _ => return None,
    })
}

/// The fields of a structure, as its own reader asks for them.
fn fields_of<T: for<'de> Deserialize<'de>>() -> &'static [&'static str] {
    struct Ask<'a>(&'a mut &'static [&'static str]);
    impl<'de> Deserializer<'de> for Ask<'_> {
        type Error = Error;

        fn deserialize_any<V: de::Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
            Err(de::Error::custom("only asked"))
        }

        fn deserialize_struct<V: de::Visitor<'de>>(
            self,
            _: &'static str,
            fields: &'static [&'static str],
            visitor: V,
        ) -> Result<V::Value, Error> {
            *self.0 = fields;
            self.deserialize_any(visitor)
        }

        forward_to_deserialize_any! {
            bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
            newtype_struct seq tuple tuple_struct map enum identifier ignored_any
        }
    }
    let mut fields: &'static [&'static str] = &[];
    let _ = T::deserialize(Ask(&mut fields));
    fields
}

/// One behind the closing quote of the text that begins at `start`.
fn end_of_text(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while at < text.len() && text[at] != b'"' {
        at += if text[at] == b'\\' { 2 } else { 1 };
    }
    (at + 1).min(text.len())
}

/// Line and column, from 1, of a byte.
fn place(text: &[u8], at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line = 1 + before.iter().filter(|b| **b == b'\n').count();
    let start = before.iter().rposition(|b| *b == b'\n').map_or(0, |k| k + 1);
    (line, 1 + String::from_utf8_lossy(&before[start..]).chars().count())
}
