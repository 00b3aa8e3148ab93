//! Named qualities: read, checked at every load, chosen, written.

use super::super::{Changes, Quality, Standing, fill_qualities, load_with, without_qualities};
use super::*;
use toile_core::Length;

/// The vest with a `qualities` field.
fn with(field: &str) -> String {
    kit::VEST.replace("    stages: [", &format!("    qualities: {field},\n    stages: ["))
}

const TWO: &str = r#"[
        Quality(name: "Draft", max_error: "10 mm", set: ["stages.GridMesher.edge=\"24 mm\""]),
        Quality(name: "Fine", max_error: "2 mm", set: [r"stages.Canny.low=5", "body=Mannequin()"], measured: "today"), // mine
    ]"#;

fn at(text: &str, quality: &str, sets: &[&str]) -> Result<Pipeline, Faults> {
    let set: Vec<Override> = sets.iter().map(|o| o.parse().unwrap()).collect();
    let changes = Changes { quality: Some(quality), set: &set, ..Changes::default() };
    load_with(text, "vest.ron", Path::new("pipelines"), &kit::registry(), &changes)
}

fn param(p: &Pipeline, id: &str) -> String {
    p.nodes[p.find(id).unwrap()].stage.params()
}

#[test]
fn a_quality_sets_what_it_says_and_set_comes_after_it() {
    let text = with(TWO);
    let plain = good(&text);
    assert_eq!((plain.qualities.len(), plain.quality.as_deref()), (2, None));
    assert!(param(&plain, "GridMesher").contains("12 mm"));
    assert_eq!(plain.qualities[1].words(Standing::Holds), "Fine (2 mm)");
    assert_eq!(plain.qualities[1].measured.as_deref(), Some("today"));

    let draft = at(&text, "Draft", &[]).unwrap();
    assert_eq!(draft.quality.as_deref(), Some("Draft"));
    assert!(param(&draft, "GridMesher").contains("24 mm"));
    let fine = at(&text, "Fine", &["stages.Canny.low=7"]).unwrap();
    assert_eq!(fine.quality.as_deref(), Some("Fine, changed by --set"));
    assert!(param(&fine, "Canny").contains("low: 7"), "{}", param(&fine, "Canny"));
    assert!(param(&fine, "GridMesher").contains("12 mm"));
}

#[test]
fn without_qualities_the_file_loads_as_before() {
    let plain = good(kit::VEST);
    assert!(plain.qualities.is_empty() && plain.quality.is_none());
    assert_eq!(plain.text, kit::VEST);
}

#[test]
fn a_name_that_there_is_not_word_for_word() {
    let shown = |text: &str, name: &str| at(text, name, &[]).unwrap_err().to_string();
    assert_eq!(
        shown(&with(TWO), "Drafd"),
        "vest.ron:11:5: the pipeline has no quality `Drafd`; did you mean `Draft`? there is `Draft`, `Fine`"
    );
    assert_eq!(
        shown(&with(TWO), "Best"),
        "vest.ron:11:5: the pipeline has no quality `Best`; there is `Draft`, `Fine`"
    );
    assert_eq!(
        shown(kit::VEST, "Draft"),
        "vest.ron:2:1: the pipeline has no quality `Draft`; it has none; \
         `toile tune PIPELINE --quality \"NAME=LENGTH\"` measures and writes one"
    );
    // Its place is that of the file as it stands, whatever is set.
    let moved = at(&with(TWO), "Best", &["name=\"a\nb\""]).unwrap_err().to_string();
    assert!(moved.starts_with("vest.ron:11:5: "), "{moved}");
}

#[test]
fn faults_of_settings_are_found_by_every_load_each_at_its_place() {
    let text = with(
        r#"[
        Quality(name: "A", max_error: "1 mm", set: ["stages.Grid.edge=\"1 mm\"", "stages.Canny.low=NaN"]),
        Quality(name: "B", max_error: "1 mm", set: ["fabrics=Preset()", "stages.Canny.lo=1", "stages.Otsu.bias=x y"]),
        Quality(name: "C", max_error: "1 mm", set: ["plugins=[]", "qualities.0.name=\"D\"", "stages.Otsu=Taubin()"]),
        Quality(name: "D", max_error: "1 mm", set: ["stages.Canny=Painter()"]),
    ]"#,
    );
    let expected = "\
vest.ron:12:53: quality `A`: `stages.Grid.edge`: no stage in `stages` has the id `Grid`; there is `Mean`, `Otsu`, `Canny`, `GridMesher`, `Taubin`, `Painter`, `Glb`, `Report`
vest.ron:12:82: quality `A`: `stages.Canny.low`: `low` is NaN, which is not a finite number
vest.ron:13:53: quality `B`: `fabrics`: a pipeline has no field `fabrics`; did you mean `fabric`?
vest.ron:13:73: quality `B`: `stages.Canny.lo`: `Canny` has no parameter `lo`; did you mean `stages.Canny.low`?
vest.ron:13:94: quality `B`: `stages.Otsu.bias`: `x y` is no RON value: expected the end, found `y`; text stands in quotes: `stages.Otsu.bias=\"x y\"`
vest.ron:14:53: quality `C`: a quality cannot set `plugins`
vest.ron:14:67: quality `C`: a quality cannot set `qualities`";
    let shown = faults(&text);
    let (own, graph): (Vec<&str>, Vec<&str>) = shown.lines().partition(|l| !l.starts_with("vest.ron:15:"));
    assert_eq!(own.join("\n"), expected);
    assert!(!graph.is_empty(), "a stage in the wrong place is found");
    assert!(graph.iter().all(|l| l.contains(": quality `D`: ")), "{graph:?}");
    // The same faults with `--set` and whichever quality is requested, each once.
    let count = shown.lines().count();
    assert_eq!(set(&text, &["name=\"x\""]).unwrap_err().faults.len(), count);
    assert_eq!(at(&text, "D", &[]).unwrap_err().faults.len(), count);
}

#[test]
fn the_form_of_an_entry_word_for_word() {
    let form = "write `Quality(name: \"Draft\", max_error: \"10 mm\", set: [...])`";
    let shown = |field: &str| faults(&with(field));
    assert_eq!(
        shown("3"),
        "vest.ron:11:16: `qualities` must be a list; write `qualities: [Quality(name: \"Draft\", max_error: \"10 mm\", set: [...])]`"
    );
    assert_eq!(shown("[Draft()]"), format!("vest.ron:11:17: expected a quality; {form}"));
    assert_eq!(
        shown("[Quality(nam: \"A\", max_error: 3, set: \"x\")]"),
        format!(
            "vest.ron:11:17: the quality lacks `name`; {form}\n\
             vest.ron:11:25: unknown field `nam`; did you mean `name`? a quality has `name`, `max_error`, `set`, `measured`, `measured_for`\n\
             vest.ron:11:46: `max_error` must be text in quotes\n\
             vest.ron:11:54: `set` must be a list of texts; write `set: [\"stages.GridMesher.edge=\\\"24 mm\\\"\"]`"
        )
    );
    assert_eq!(
        shown(
            "[Quality(name: \"A=B\", max_error: \"0 mm\", set: [\"x\"]), Quality(name: \"A\", max_error: \"3\", set: [])]"
        ),
        "vest.ron:11:31: a quality's name has 1 to 64 letters, digits, `_`, `-` and spaces between them\n\
         vest.ron:11:49: `max_error`: an error is above zero\n\
         vest.ron:11:63: `x` is not PATH=VALUE, like `body.height=\"1.8 m\"`\n\
         vest.ron:11:100: `max_error`: \"3\" is not a length; write a number and a unit, like \"12 mm\" (mm, cm, m, in)"
    );
    let twice = "[Quality(name: \"A\", max_error: \"1 mm\", set: []), Quality(name: \"A\", max_error: \"2 mm\", set: [])]";
    assert_eq!(shown(twice), "vest.ron:11:79: two qualities are called `A`");
    assert_eq!(places(&with(twice)), [[("\"A\"".into(), "second".into()), ("\"A\"".into(), "first".into())]]);
}

#[test]
fn too_many_are_refused() {
    let one = |i: usize| format!("Quality(name: \"Q{i}\", max_error: \"1 mm\", set: [])");
    let many: Vec<String> = (0..21).map(one).collect();
    assert!(faults(&with(&format!("[{}]", many.join(", ")))).ends_with(": 21 qualities, the limit is 20"));
    let sets = vec!["\"name=\\\"x\\\"\""; 101].join(", ");
    let long = format!("[Quality(name: \"Q\", max_error: \"1 mm\", set: [{sets}])]");
    assert!(faults(&with(&long)).ends_with(": 101 settings, the limit is 100"));
}

#[test]
fn a_faulty_file_is_not_reported_once_more_for_each_quality() {
    let text = with(TWO).replace("Otsu()", "Otzu()");
    assert_eq!(faults(&text), "vest.ron:17:9: unknown stage `Otzu`; did you mean `Otsu`?");
}

#[test]
fn settings_need_not_fit_what_overrides_made_of_the_file() {
    let text = with(TWO);
    let changed = set(&text, &["stages.GridMesher=DelaunayMesher()"]).unwrap();
    // The changed text by itself is another file, which its qualities do not fit any more.
    assert!(read(&changed.text).is_err());
    let changes = Changes { again: true, ..Changes::default() };
    let again = load_with(&changed.text, "vest.ron", Path::new("pipelines"), &kit::registry(), &changes);
    assert_eq!(again.unwrap().text, changed.text);
}

fn quality(name: &str, set: &[&str]) -> Quality {
    let set = set.iter().map(|o| o.parse().unwrap()).collect();
    Quality::new(name.into(), Length::mm(4.0), set, Some("measured \"so\"".into()))
}

#[test]
fn qualities_are_written_last_and_all_else_stays() {
    let draft = quality("Draft", &["stages.GridMesher.edge=\"30 mm\"", "stages.Canny.low=3"]);
    let once = fill_qualities(kit::VEST, std::slice::from_ref(&draft)).unwrap();
    let block = "    qualities: [\n        Quality(name: \"Draft\", max_error: \"4 mm\",\n            \
                 set: [\"stages.GridMesher.edge=\\\"30 mm\\\"\", \"stages.Canny.low=3\"],\n            \
                 measured: \"measured \\\"so\\\"\"),\n    ],\n)\n";
    assert_eq!(once, kit::VEST.replace("\n)\n", &format!("\n{block}")));
    let loaded = good(&once);
    assert_eq!(
        (loaded.qualities[0].set.clone(), loaded.qualities[0].max_error),
        (draft.set, Length::mm(4.0))
    );
    assert_eq!(without_qualities(&once).unwrap(), kit::VEST);
    assert_eq!(without_qualities(kit::VEST).unwrap(), kit::VEST);
}

#[test]
fn one_of_a_name_takes_its_place_and_others_follow() {
    let text = with(TWO);
    let filled = fill_qualities(&text, &[quality("Draft", &[]), quality("Mid", &["name=\"m\""])]).unwrap();
    let names: Vec<String> = good(&filled).qualities.iter().map(|q| q.words(Standing::Holds)).collect();
    assert_eq!(names, ["Draft (4 mm)", "Fine (2 mm)", "Mid (4 mm)"]);
    assert!(filled.contains("measured: \"today\"), // mine\n        Quality(name: \"Mid\""), "{filled}");
    // A last entry without a comma gets one, past the comment behind it.
    let bare = kit::VEST.replace("\"back.side_right\") ],", "\"back.side_right\") ] /* , */ // the end,");
    let filled = fill_qualities(&bare, &[quality("A", &[])]).unwrap();
    assert!(filled.contains(") ], /* , */ // the end,\n    qualities: [\n"), "{filled}");
    assert_eq!(good(&filled).qualities.len(), 1);
    for field in ["[]", "[ /* none */ ]"] {
        let filled = fill_qualities(&with(field), &[quality("A", &[]), quality("B", &[])]).unwrap();
        assert_eq!(good(&filled).qualities.len(), 2, "{filled}");
    }
    let flat = "(stages: [Photos({})])";
    assert!(fill_qualities(flat, &[quality("A", &[])]).is_ok_and(|t| super::super::parse(&t).is_ok()));
}
