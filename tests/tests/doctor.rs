//! `toile doctor`.

use serde_json::Value;
use toile_core::prelude::*;
use toile_tests::toile;

fn doctor(registry: &Registry, arguments: &[&str]) -> (u8, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let code = toile::command_with(registry, [&["toile", "doctor"], arguments].concat(), &mut out, &mut err);
    (code, String::from_utf8(out).unwrap())
}

#[test]
fn every_built_in_stage_is_well() {
    let answer = toile(&["doctor", "--json"]);
    let found: Value = serde_json::from_str(&answer.out).unwrap();
    let stages = found["stages"].as_array().unwrap();
    assert_eq!(stages.len(), toile::registry().cards().count());
    let unwell: Vec<&Value> = stages.iter().filter(|s| s["health"] != "works").collect();
    assert!(unwell.is_empty(), "{unwell:#?}");
    assert_eq!((answer.code, &found["failing"]), (0, &Value::from(0)));
}

/// Panics on whatever it is given.
#[stage(role = Denoiser, source = "none", example = "Fainting()")]
pub struct Fainting;

#[stage]
impl Fainting {
    #[allow(clippy::panic)]
    fn run(&self, _photo: &Photo, _cx: &Context) -> Result<Photo, StageError> {
        panic!("too hot")
    }
}

/// Its example is not its own.
#[stage(role = Denoiser, source = "none", example = "Misquoted(level: 3)")]
pub struct Misquoted;

#[stage]
impl Misquoted {
    fn run(&self, photo: &Photo, _cx: &Context) -> Result<Photo, StageError> {
        Ok(photo.clone())
    }
}

/// Wants what is not there.
#[stage(role = Denoiser, source = "none", example = "Choosy()")]
pub struct Choosy;

#[stage]
impl Choosy {
    fn run(&self, _photo: &Photo, _cx: &Context) -> Result<Photo, StageError> {
        Err(StageError::invalid("not in this light"))
    }
}

#[test]
fn what_fails_is_named_with_its_reason() {
    let mut registry = Registry::new();
    registry.add::<Fainting>().add::<Misquoted>().add::<Choosy>();
    let (code, text) = doctor(&registry, &[]);
    let lines: Vec<&str> = text.lines().collect();
    let line = |name: &str| lines.iter().find(|l| l.contains(name)).unwrap();
    assert!(line("Fainting").starts_with("fails"), "{text}");
    assert!(line("Fainting").ends_with("on a vest, it panicked: too hot"), "{text}");
    assert!(line("Misquoted").contains("its example `Misquoted(level: 3)` does not load: "), "{text}");
    assert!(
        line("Choosy").starts_with("refuses") && line("Choosy").ends_with("a vest: not in this light"),
        "{text}"
    );
    assert_eq!(lines.last(), Some(&"3 stages, 2 fail"));
    assert_eq!(code, 70);
}

#[test]
fn a_plugin_that_is_none_is_refused_with_its_reason() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("libnone.so");
    std::fs::write(&file, "no library").unwrap();
    let (code, text) = doctor(&Registry::new(), &["--plugin", file.to_str().unwrap()]);
    assert!(text.starts_with("refused  "), "{text}");
    assert!(text.ends_with("0 stages, none fails; 1 plugin was refused\n"), "{text}");
    assert_eq!(code, 70);
}

#[test]
fn contracts_are_tried_when_that_is_asked_for() {
    let answer = toile(&["doctor", "Otsu", "PlaneSmoother", "--contracts"]);
    assert_eq!(answer.code, 0, "{}", answer.out);
    let line = answer.out.lines().find(|l| l.trim_start().starts_with("ScaleEquivariant")).unwrap();
    assert!(line.contains(" kept     ") && line.ends_with(" cases answered"), "{line}");
    let last = answer.out.lines().last().unwrap();
    assert!(
        last.starts_with("2 stages, none fails; contracts: ") && last.ends_with(" kept, 0 broken, 0 untried"),
        "{last}"
    );
    let unknown = toile(&["doctor", "Otzu"]);
    assert_eq!(
        (unknown.code, unknown.err.as_str()),
        (3, "error: there is no stage `Otzu`; did you mean `Otsu`?\n")
    );
}

/// Promises what it does not keep.
#[stage(role = Denoiser, source = "none", example = "Fickle()", contracts(RefusesEmpty))]
pub struct Fickle;

#[stage]
impl Fickle {
    fn run(&self, photo: &Photo, _cx: &Context) -> Result<Photo, StageError> {
        Ok(photo.clone())
    }
}

#[test]
fn a_promise_of_a_strange_stage_is_declared_and_one_that_is_broken_is_told() {
    let mut registry = Registry::new();
    registry.add::<Fickle>();
    let (mut out, mut err) = (Vec::new(), Vec::new());
    toile::command_with(&registry, ["toile", "stage", "Fickle"], &mut out, &mut err);
    let card = String::from_utf8(out).unwrap();
    assert!(card.contains("\n  RefusesEmpty             declared\n  (declared: nobody ran it here; `toile doctor Fickle --contracts` does)\n"), "{card}");
    let (code, text) = doctor(&registry, &["--contracts"]);
    assert!(text.contains("\n    RefusesEmpty             broken   "), "{text}");
    assert!(text.ends_with("1 stages, none fails; contracts: 0 kept, 1 broken, 0 untried\n"), "{text}");
    assert_eq!(code, 70);
}
