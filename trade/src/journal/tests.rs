//! Records that are gone on with, damaged, or of something else.
#![allow(clippy::unwrap_used)]
use super::*;
use crate::digest::content;

const KIND: JournalKind = JournalKind { name: "steps", scheme: 3, changed: "the pipeline has changed" };

/// What the record rests on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct On {
    ratio: f64,
}

/// A step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Step {
    key: String,
    seconds: f64,
}

type Steps = Journal<On, Step>;

fn step(key: &str) -> Step {
    Step { key: key.into(), seconds: 0.1 + 0.2 }
}

fn kept(folder: &Path) -> Steps {
    let photo = folder.join("photo.jpg");
    std::fs::write(&photo, "a photo").unwrap();
    let path = photo.display().to_string();
    let reads = BTreeMap::from([(path.clone(), content(&path))]);
    let mut steps = Steps::new(folder, KIND, "base".into(), reads, On { ratio: 2f64.sqrt() });
    steps.add(step("one")).unwrap();
    steps.add(step("two")).unwrap();
    steps
}

fn open(folder: &Path, base: &str) -> Result<Option<Steps>, String> {
    Steps::open(folder, KIND, base)
}

/// The record's text changed.
fn edit(folder: &Path, change: impl Fn(&str) -> String) {
    let path = folder.join("steps.jsonl");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, change(&text)).unwrap();
}

#[test]
fn a_later_session_finds_every_step_to_the_last_bit() {
    let dir = tempfile::tempdir().unwrap();
    assert!(open(dir.path(), "base").unwrap().is_none());
    let steps = kept(dir.path());
    let again = open(dir.path(), "base").unwrap().unwrap();
    assert_eq!((again.head, again.lines, again.damaged), (steps.head, steps.lines, Vec::new()));
}

#[test]
fn a_damaged_line_loses_itself_alone_and_is_told_with_its_place() {
    let dir = tempfile::tempdir().unwrap();
    kept(dir.path());
    let path = dir.path().join("steps.jsonl").display().to_string();
    let left_out = |change: &dyn Fn(&str) -> String| {
        kept(dir.path());
        edit(dir.path(), change);
        let mut told = Vec::new();
        let steps = Steps::taken_up(dir.path(), KIND, "base", &mut |line| told.push(line)).unwrap();
        (steps.lines, told)
    };
    let (lines, told) = left_out(&|text| text.replace("\"one\"", "\"one"));
    let words = format!("{path}:2:14: the line is damaged and left out: expected `,` or `}}`");
    assert_eq!((lines, told), (vec![step("two")], vec![words]));
    // Torn at its end.
    let (lines, told) = left_out(&|text| text[..text.len() - 10].to_owned());
    let words = format!("{path}:3:27: the line is damaged and left out: EOF while parsing a value");
    assert_eq!((lines.len(), told.len()), (1, 1));
    assert!(told[0].starts_with(&format!("{path}:3:")), "{told:?} {words}");
}

#[test]
fn a_record_that_was_torn_anywhere_is_no_panic_and_holds_nothing_new() {
    let dir = tempfile::tempdir().unwrap();
    let steps = kept(dir.path());
    let path = dir.path().join("steps.jsonl");
    let whole = std::fs::read(&path).unwrap();
    for cut in 0..whole.len() {
        std::fs::write(&path, &whole[..cut]).unwrap();
        match open(dir.path(), "base") {
            Ok(found) => assert!(steps.lines.starts_with(&found.unwrap().lines), "{cut}"),
            Err(why) => assert_eq!(why, "it is of another version or damaged", "{cut}"),
        }
    }
    std::fs::write(&path, [&whole[..], &[0xff, 0xfe, b'\n']].concat()).unwrap();
    let found = open(dir.path(), "base").unwrap().unwrap();
    assert_eq!((found.lines, found.damaged.len()), (steps.lines, 1), "what is no text is a damaged line");
}

#[test]
fn what_has_changed_is_not_gone_on_from() {
    let dir = tempfile::tempdir().unwrap();
    kept(dir.path());
    let refused = |base: &str| open(dir.path(), base).unwrap_err();
    assert_eq!(refused("other"), "the pipeline has changed");
    let photo = dir.path().join("photo.jpg");
    std::fs::write(&photo, "another").unwrap();
    assert_eq!(refused("base"), format!("\"{}\" has changed", photo.display()));
    edit(dir.path(), |text| text.replace(&format!("\"{}\"", env!("CARGO_PKG_VERSION")), "\"0.0.7\""));
    assert_eq!(refused("base"), "it was made by version 0.0.7");
    edit(dir.path(), |_| "nonsense".into());
    assert_eq!(refused("base"), "it is of another version or damaged");
    let mut told = Vec::new();
    assert!(Steps::taken_up(dir.path(), KIND, "base", &mut |line| told.push(line)).is_none());
    let words =
        format!("what is in {} is put aside: it is of another version or damaged", dir.path().display());
    assert_eq!(told, [words]);
    assert!(open(dir.path(), "base").unwrap().is_none());
    assert_eq!(std::fs::read_to_string(dir.path().join("steps.old.jsonl")).unwrap(), "nonsense");
}
