//! A manifest: a garment a line, `{"id": "...", "set": {"pattern.file": "a.json"}}`.
//!
//! A value is written as for `--set`, in RON; a text that is no value of RON (`6 mm`, `EU 42`) gets
//! its quotes here. A file is found from the manifest's folder, else from that of the pipeline. All
//! faults of a file come out at once, each with its line.

use crate::at_hand;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use toile_pipeline::Override;

/// The longest id: it becomes a folder's name.
const MAX_ID: usize = 100;

/// One garment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct GarmentLine {
    /// The line, from 1.
    pub(crate) line: usize,
    pub(crate) id: String,
    /// Its values, as the manifest writes them.
    pub(crate) set: Vec<Override>,
}

/// What is wrong with a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LineFault {
    /// The line, from 1.
    pub(crate) line: usize,
    pub(crate) message: String,
}

impl std::fmt::Display for LineFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

/// A line as it stands in the file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenLine {
    id: String,
    #[serde(default)]
    set: WrittenSet,
}

/// The values of a line in their order.
#[derive(Debug, Default)]
struct WrittenSet(Vec<(String, Value)>);

impl<'de> Deserialize<'de> for WrittenSet {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Pairs;
        impl<'de> Visitor<'de> for Pairs {
            type Value = WrittenSet;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object of paths and values, like {\"pattern.file\": \"a.json\"}")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<WrittenSet, A::Error> {
                let mut pairs: Vec<(String, Value)> = Vec::new();
                while let Some((path, value)) = map.next_entry::<String, Value>()? {
                    if pairs.iter().any(|(p, _)| *p == path) {
                        return Err(serde::de::Error::custom(format!("\"{path}\" is set twice")));
                    }
                    pairs.push((path, value));
                }
                Ok(WrittenSet(pairs))
            }
        }
        d.deserialize_map(Pairs)
    }
}

/// The sound lines of a manifest and what is wrong with the others. Empty lines count as none.
pub(crate) fn parse(bytes: &[u8]) -> (Vec<GarmentLine>, Vec<LineFault>) {
    let (mut garments, mut faults) = (Vec::new(), Vec::new());
    // An id without regard to case, since some disks have none: where it stands first.
    let mut seen: BTreeMap<String, (usize, String)> = BTreeMap::new();
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    for (i, text) in bytes.split(|b| *b == b'\n').enumerate() {
        let line = i + 1;
        match garment(line, text) {
            Ok(None) => {}
            Err(message) => faults.push(LineFault { line, message }),
            Ok(Some(garment)) => match seen.get(&garment.id.to_lowercase()) {
                Some((first, id)) => {
                    faults.push(LineFault { line, message: doubled(&garment.id, *first, id) })
                }
                None => {
                    seen.insert(garment.id.to_lowercase(), (line, garment.id.clone()));
                    garments.push(garment);
                }
            },
        }
    }
    if garments.is_empty() && faults.is_empty() {
        faults.push(LineFault { line: 1, message: "the manifest holds no garment".into() });
    }
    (garments, faults)
}

fn doubled(id: &str, first: usize, other: &str) -> String {
    match id == other {
        true => format!("the id \"{id}\" stands in line {first}, too"),
        false => {
            format!(
                "the id \"{id}\" is \"{other}\" of line {first} in other case, which some disks take for the same"
            )
        }
    }
}

fn garment(line: usize, text: &[u8]) -> Result<Option<GarmentLine>, String> {
    let text = std::str::from_utf8(text).map_err(|_| "it is not UTF-8 text".to_owned())?.trim();
    if text.is_empty() {
        return Ok(None);
    }
    let written: WrittenLine = serde_json::from_str(text).map_err(|e| no_garment(&e))?;
    check_id(&written.id)?;
    let set =
        written.set.0.into_iter().map(|(path, value)| setting(&path, &value)).collect::<Result<_, _>>()?;
    Ok(Some(GarmentLine { line, id: written.id, set }))
}

fn no_garment(e: &serde_json::Error) -> String {
    // Its words name a line, which is always the first.
    let words = e.to_string();
    let words = words.split(" at line ").next().unwrap_or_default();
    format!(
        "{words} in column {}; a garment is written {{\"id\": \"shirt1\", \"set\": {{\"pattern.file\": \"a.json\"}}}}",
        e.column()
    )
}

/// Refuses an id that cannot be a folder's name everywhere.
///
/// Errors: a sentence.
pub(crate) fn check_id(id: &str) -> Result<(), String> {
    let is_sound = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    let begins = id.starts_with(|c: char| c.is_ascii_alphanumeric());
    match id.len() <= MAX_ID && begins && !id.ends_with('.') && id.chars().all(is_sound) {
        true => Ok(()),
        false => Err(format!(
            "the id {id:?} is no folder's name; write up to {MAX_ID} letters, digits, `.`, `_` and `-`, a letter or digit first"
        )),
    }
}

/// A value as `--set` takes it, from one that a manifest or a program gives: a text that is no
/// value of RON gets its quotes.
///
/// Errors: a sentence.
pub(crate) fn setting(path: &str, value: &Value) -> Result<Override, String> {
    let path = path.trim();
    if path.is_empty() || path.contains('=') {
        return Err(format!("\"{path}\" is no path of a value, like \"body.height\""));
    }
    let value = match value {
        Value::String(text) if text.trim().is_empty() => {
            return Err(format!(
                "the value of \"{path}\" is empty; a text without letters is written \"\\\"\\\"\""
            ));
        }
        Value::String(text) => as_ron(path, text.trim()),
        Value::Number(_) | Value::Bool(_) => value.to_string(),
        Value::Array(all) if all.iter().all(|v| v.is_string() || v.is_number()) => value.to_string(),
        _ => {
            return Err(format!(
                "the value of \"{path}\" is no text, number, true, false or list of them; write others as text, in RON"
            ));
        }
    };
    Ok(Override { path: path.to_owned(), value })
}

/// A text as a value of RON: as it is where it is one, else in quotes.
fn as_ron(path: &str, text: &str) -> String {
    let raw = Override { path: path.to_owned(), value: text.to_owned() };
    let is_name = |part: &str| {
        part.starts_with(|c: char| c.is_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_alphanumeric() || c == '_')
    };
    let is_call =
        text.split_once('(').is_some_and(|(name, _)| is_name(name.trim_end()) && text.ends_with(')'));
    let is_value = text.starts_with(['"', '(', '[', '{', '\''])
        || ["r\"", "r#"].iter().any(|open| text.starts_with(open))
        || text.parse::<f64>().is_ok()
        || is_name(text)
        || is_call;
    // A field `file` needs no quotes.
    match is_value || path.ends_with("file") && at_hand::named(&raw).is_some() {
        true => text.to_owned(),
        false => format!("{text:?}"),
    }
}

/// The files that lines name and that are not there: neither in these folders nor in the store, of
/// which `is_stored` tells.
pub(crate) fn missing(
    garments: &[GarmentLine],
    folders: [&Path; 2],
    is_stored: &dyn Fn(&str) -> bool,
) -> Vec<LineFault> {
    let missing = |g: &GarmentLine| {
        let files = g.set.iter().filter_map(|o| Some((&o.path, at_hand::named(o)?)));
        let gone = files.filter(|(_, file)| {
            !is_stored(file) && !folders.iter().any(|folder| folder.join(file).is_file())
        });
        gone.map(|(path, file)| LineFault {
            line: g.line,
            message: format!("there is no file \"{file}\" (\"{path}\") beside the manifest or the pipeline"),
        })
        .collect::<Vec<_>>()
    };
    garments.iter().flat_map(missing).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn faults(text: &str) -> Vec<String> {
        parse(text.as_bytes()).1.iter().map(ToString::to_string).collect()
    }

    fn value(json: &str) -> String {
        let (garments, faults) = parse(format!("{{\"id\": \"a\", \"set\": {{{json}}}}}").as_bytes());
        assert_eq!(faults, []);
        garments[0].set[0].value.clone()
    }

    #[test]
    fn a_line_is_a_garment() {
        let text = "{\"id\": \"a\", \"set\": {\"pattern.file\": \"a.json\", \"body.size\": \"EU 42\"}}\n\n{\"id\": \"b-2\"}\r\n";
        let (garments, faults) = parse(text.as_bytes());
        assert_eq!(faults, []);
        let set = |path: &str, value: &str| Override { path: path.into(), value: value.into() };
        let first = vec![set("pattern.file", "a.json"), set("body.size", "\"EU 42\"")];
        assert_eq!(garments[0], GarmentLine { line: 1, id: "a".into(), set: first });
        assert_eq!(garments[1], GarmentLine { line: 3, id: "b-2".into(), set: vec![] });
    }

    #[test]
    fn values_are_those_of_set_and_other_texts_get_quotes() {
        assert_eq!(value(r#""fabric": "Preset(\"denim\")""#), "Preset(\"denim\")");
        assert_eq!(value(r#""stages.GridMesher.edge": "6 mm""#), "\"6 mm\"");
        assert_eq!(value(r#""stages.GridMesher.edge": "\"6 mm\"""#), "\"6 mm\"");
        assert_eq!(value(r#""a.kind": "Fine""#), "Fine");
        assert_eq!(value(r#""a.low": 20"#), "20");
        assert_eq!(value(r#""a.low": "-2.5""#), "-2.5");
        assert_eq!(value(r#""a.on": true"#), "true");
        assert_eq!(value(r#""a.garments": ["a.json", "b.json"]"#), r#"["a.json","b.json"]"#);
        assert_eq!(value(r#""photos.front.file": "my photo.jpg""#), "my photo.jpg");
    }

    #[test]
    fn faults_are_told_by_line_all_at_once() {
        let form = "; a garment is written {\"id\": \"shirt1\", \"set\": {\"pattern.file\": \"a.json\"}}";
        let text = "{\"id\": \"a\"}\n{\"id\": \"a\"}\n{\"id\": \"A\"}\n{\"id\": \nno\n{\"id\": \"a/b\"}\n{\"id\": \"c\", \"sets\": 1}\n{\"id\": \"d\", \"set\": {\"x\": null}}\n{\"id\": \"e\", \"set\": {\"x\": 1, \"x\": 2}}\n{\"id\": \"f\", \"set\": {\"x\": \" \"}}\n";
        assert_eq!(
            faults(text),
            [
                "line 2: the id \"a\" stands in line 1, too".to_owned(),
                "line 3: the id \"A\" is \"a\" of line 1 in other case, which some disks take for the same".into(),
                format!("line 4: EOF while parsing a value in column 6{form}"),
                format!("line 5: expected ident in column 2{form}"),
                "line 6: the id \"a/b\" is no folder's name; write up to 100 letters, digits, `.`, `_` and `-`, a letter or digit first".into(),
                format!("line 7: unknown field `sets`, expected `id` or `set` in column 18{form}"),
                "line 8: the value of \"x\" is no text, number, true, false or list of them; write others as text, in RON".into(),
                format!("line 9: \"x\" is set twice in column 35{form}"),
                "line 10: the value of \"x\" is empty; a text without letters is written \"\\\"\\\"\"".into(),
            ]
        );
        assert_eq!(faults("\n \n"), ["line 1: the manifest holds no garment"]);
        assert_eq!(parse(b"{\"id\": \"a\"}\n\xff\n").1[0].to_string(), "line 2: it is not UTF-8 text");
    }

    #[test]
    fn a_missing_file_is_told_by_line() {
        let dir = tempfile::tempdir().unwrap();
        let [beside, pipeline] = ["m", "p"].map(|name| dir.path().join(name));
        [&beside, &pipeline].iter().for_each(|folder| std::fs::create_dir(folder).unwrap());
        std::fs::write(beside.join("a.json"), "").unwrap();
        std::fs::write(pipeline.join("b.json"), "").unwrap();
        let line = |id: &str| format!("{{\"id\": \"{id}\", \"set\": {{\"pattern.file\": \"{id}.json\"}}}}\n");
        let (garments, _) = parse(["a", "b", "c"].map(line).concat().as_bytes());
        let words =
            "line 3: there is no file \"c.json\" (\"pattern.file\") beside the manifest or the pipeline";
        let told = missing(&garments, [&beside, &pipeline], &|_| false);
        assert_eq!(told.iter().map(ToString::to_string).collect::<Vec<_>>(), [words]);
        assert_eq!(missing(&garments, [&beside, &pipeline], &|file| file == "c.json"), []);
    }
}
