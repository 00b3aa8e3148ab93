//! Edits of the vest, with comments all over it.
#![allow(clippy::unwrap_used, clippy::panic)]

use super::{PipelineEdit, edited};
use crate::load::tests::kit;
use crate::load::{Override, Pipeline, load};
use proptest::prelude::*;
use std::path::Path;

/// Comments stand where people put them: above, behind, within.
const TEXT: &str = r#"// A vest.
(
    // who
    name: "vest",
    photos: { // the photos
        "front": (file: "front.jpg", width: "52 cm"),
        "back":  (file: "back.jpg",  width: "52 cm"), // its back
    },
    style: Vest(),
    body: Mannequin(height: "172 cm"), /* made to measure */
    fabric: Preset("cotton poplin"),
    stages: [
        Mean(mask: Eight, radius: 1),   // grain
        Otsu(),
        Canny(low: 20, /* weak */ high: 60),
        GridMesher(edge: "12 mm"),      // the mesh
        Taubin(),
        Painter(),
        Glb(), Report()                 // files
    ],
)
"#;

fn set(path: &str, value: &str) -> PipelineEdit {
    PipelineEdit::Set { path: path.into(), value: value.into() }
}

fn remove(path: &str) -> PipelineEdit {
    PipelineEdit::Remove { path: path.into() }
}

fn swap(stage: &str, with: &str) -> PipelineEdit {
    PipelineEdit::Swap { stage: stage.into(), with: with.into() }
}

fn add(stage: &str, after: Option<&str>) -> PipelineEdit {
    PipelineEdit::Add { stage: stage.into(), after: after.map(str::to_owned) }
}

fn read(text: &str) -> Pipeline {
    load(text, "vest.ron", Path::new("."), &kit::registry(), &[]).unwrap_or_else(|f| panic!("{f}\n{text}"))
}

/// The lines that an edit takes out and those that it puts in.
#[track_caller]
fn changes(edit: PipelineEdit, out: &[&str], new: &[&str]) {
    let text = edited(TEXT, &kit::registry(), std::slice::from_ref(&edit)).unwrap();
    read(&text);
    let only = |a: &str, b: &str| -> Vec<String> {
        let lines = a.lines().filter(|line| !b.lines().any(|other| other == *line));
        lines.map(|line| line.trim_start().to_owned()).collect()
    };
    assert_eq!((only(TEXT, &text), only(&text, TEXT)), (owned(out), owned(new)), "{edit:?}\n{text}");
}

fn owned(lines: &[&str]) -> Vec<String> {
    lines.iter().map(|line| (*line).to_owned()).collect()
}

#[track_caller]
fn refused(edit: PipelineEdit, message: &str, hint: Option<&str>) {
    let fault = edited(TEXT, &kit::registry(), &[edit]).unwrap_err();
    assert_eq!((fault.message.as_str(), fault.hint.as_deref()), (message, hint));
}

#[test]
fn a_value_is_set_and_its_line_stays() {
    let (was, is) =
        ("GridMesher(edge: \"12 mm\"),      // the mesh", "GridMesher(edge: \"6 mm\"),      // the mesh");
    changes(set("stages.GridMesher.edge", "\"6 mm\""), &[was], &[is]);
    let (was, is) = ("Canny(low: 20, /* weak */ high: 60),", "Canny(low: 8, /* weak */ high: 60),");
    changes(set("stages.Canny.low", "8"), &[was], &[is]);
}

#[test]
fn a_field_that_joins_several_lines_gets_its_own() {
    let side = "\"side\": (file: \"side.jpg\", width: \"1 m\"),";
    changes(set("photos.side", "(file: \"side.jpg\", width: \"1 m\")"), &[], &[side]);
    let text = edited(TEXT, &kit::registry(), &[set("seams", "[]")]).unwrap();
    assert!(text.starts_with("// A vest.\n(\n    seams: [],\n    // who\n    name:"), "{text}");
}

#[test]
fn what_is_removed_takes_its_comma_and_leaves_comments() {
    changes(
        remove("stages.Canny.low"),
        &["Canny(low: 20, /* weak */ high: 60),"],
        &["Canny(/* weak */ high: 60),"],
    );
    changes(
        remove("stages.Mean.radius"),
        &["Mean(mask: Eight, radius: 1),   // grain"],
        &["Mean(mask: Eight),   // grain"],
    );
    changes(remove("stages.Taubin"), &["Taubin(),"], &[]);
    changes(
        remove("stages.Report"),
        &["Glb(), Report()                 // files"],
        &["Glb()                 // files"],
    );
    changes(
        remove("stages.Glb"),
        &["Glb(), Report()                 // files"],
        &["Report()                 // files"],
    );
    changes(remove("style"), &["style: Vest(),"], &[]);
    changes(
        remove("body"),
        &["body: Mannequin(height: \"172 cm\"), /* made to measure */"],
        &["/* made to measure */"],
    );
    changes(remove("fabric.name"), &["fabric: Preset(\"cotton poplin\"),"], &["fabric: Preset(),"]);
}

#[test]
fn a_comma_behind_a_comment_goes_with_its_entry() {
    let text = TEXT.replace("Taubin(),", "Taubin() /* smooth */,");
    let text = edited(&text, &kit::registry(), &[remove("stages.Taubin")]).unwrap();
    read(&text);
    assert!(text.contains("/* smooth */\n        Painter(),"), "{text}");
}

#[test]
fn the_last_of_a_list_goes() {
    let text = edited(TEXT, &kit::registry(), &[remove("photos.back"), remove("photos.front")]).unwrap();
    assert!(text.contains("photos: { // the photos\n        // its back\n    },"), "{text}");
}

#[test]
fn a_stage_is_swapped_and_keeps_what_others_name() {
    let (was, is) = ("GridMesher(edge: \"12 mm\"),      // the mesh", "DelaunayMesher(),      // the mesh");
    changes(swap("GridMesher", "DelaunayMesher"), &[was], &[is]);
    changes(
        swap("Preset", "Preset(name: \"denim\")"),
        &["fabric: Preset(\"cotton poplin\"),"],
        &["fabric: Preset(name: \"denim\"),"],
    );
    let kept = |text: &str, swap: PipelineEdit, line: &str| {
        let text = edited(text, &kit::registry(), &[swap]).unwrap();
        assert!(text.contains(line), "{text}");
        read(&text);
    };
    let named = TEXT.replace("Canny(", "Canny(from: [\"Otsu\", \"Mean\"], ");
    kept(&named, swap("Otsu", "Local()"), "Local(id: \"Otsu\"),");
    kept(&named, swap("Canny", "Laplacian(3)"), "Laplacian(from: [\"Otsu\", \"Mean\"], threshold: 3),");
    let quality = TEXT.replace("\n)\n", "\n    qualities: [Quality(name: \"Draft\", max_error: \"9 mm\", set: [\"stages.GridMesher.edge=\\\"20 mm\\\"\"])],\n)\n");
    kept(
        &quality,
        swap("GridMesher", "DelaunayMesher(edge: \"9 mm\")"),
        "DelaunayMesher(id: \"GridMesher\", edge: \"9 mm\"),",
    );
}

#[test]
fn a_stage_is_added_beside_or_below() {
    changes(
        add("Glb(id: \"more\")", Some("Glb")),
        &["Glb(), Report()                 // files"],
        &["Glb(), Glb(id: \"more\"), Report()                 // files"],
    );
    changes(add("Taubin(id: \"more\")", Some("Taubin")), &[], &["Taubin(id: \"more\"),"]);
    changes(
        add("Glb(id: \"more\")", None),
        &["Glb(), Report()                 // files"],
        &["Glb(), Report(), Glb(id: \"more\")                 // files"],
    );
    changes(add("Mean(id: \"more\")", Some("Vest")), &[], &["Mean(id: \"more\"),"]);
    let text = edited(TEXT, &kit::registry(), &[add("Mean(id: \"more\")", Some("Photos"))]).unwrap();
    assert!(text.contains("stages: [\n        Mean(id: \"more\"),\n        Mean(mask"), "{text}");
    let short = "(photos: {}, stages: [Otsu()])";
    let text = edited(short, &kit::registry(), &[add("Mean", Some("Photos"))]).unwrap();
    assert_eq!(text, "(photos: {}, stages: [Mean(), Otsu()])");
    let text = TEXT.replace("Glb(), Report()  ", "Glb()");
    let text = edited(&text, &kit::registry(), &[add("Report", None)]).unwrap();
    assert!(text.contains("        Glb(),               // files\n        Report(),\n    ],"), "{text}");
}

#[test]
fn what_cannot_be_edited_is_said() {
    let no_path = "no stage in `stages` has the id `GridMeshr`";
    refused(remove("stages.GridMeshr.edge"), no_path, Some("did you mean `stages.GridMesher.edge`?"));
    refused(
        remove("stages.Otsu.bias"),
        "the file does not give `stages.Otsu.bias`",
        Some("it has its default already"),
    );
    refused(remove("seams.0"), "the file has no `seams`", None);
    refused(swap("Otso", "Local()"), "the file has no stage `Otso`", Some("did you mean `Otsu`?"));
    refused(swap("Otsu", "3"), "`3` is no stage", Some("write `Name(field: value)`"));
    refused(
        add("Glb()", Some("Reprot")),
        "the list of `stages` has no stage `Reprot`",
        Some("did you mean `Report`?"),
    );
    refused(
        set("name", "x y"),
        "`x y` is no RON value: expected the end, found `y`",
        Some("text stands in quotes: `--set 'name=\"x y\"'`"),
    );
}

#[test]
fn all_edits_are_made_or_none() {
    let edits = [set("name", "\"a\""), set("nime", "\"b\"")];
    assert_eq!(edited(TEXT, &kit::registry(), &edits).unwrap_err().message, "a pipeline has no field `nime`");
    let text = edited(TEXT, &kit::registry(), &[set("name", "\"a\""), set("name", "\"b\"")]).unwrap();
    assert_eq!(read(&text).name, "b");
    assert!(edited("(stages: [", &kit::registry(), &[]).is_ok(), "nothing to do");
    assert!(edited("(stages: [", &kit::registry(), &[remove("name")]).is_err());
}

#[test]
fn every_stage_has_the_path_by_which_it_is_set() {
    let pipeline = read(TEXT);
    let paths: Vec<Option<String>> = pipeline.nodes.iter().map(|node| pipeline.path_of(node)).collect();
    let paths: Vec<&str> = paths.iter().map(|p| p.as_deref().unwrap()).collect();
    for path in ["photos", "style", "body", "fabric", "stages.Mean", "stages.Report"] {
        assert!(paths.contains(&path), "{path}: {paths:?}");
    }
    for path in paths.iter().filter(|p| **p != "photos") {
        let id = &pipeline.nodes[paths.iter().position(|p| p == path).unwrap()].id;
        let set = Override { path: (*path).into(), value: format!("{id}()") };
        let changed = load(TEXT, "vest.ron", Path::new("."), &kit::registry(), &[set]);
        changed.unwrap_or_else(|faults| panic!("{path}: {faults}"));
    }
}

fn any_edit() -> impl Strategy<Value = PipelineEdit> {
    let ids =
        ["Mean", "Otsu", "Canny", "GridMesher", "Taubin", "Painter", "Glb", "Report", "Mannequin", "Preset"];
    let id = proptest::sample::select(ids.to_vec());
    let stages = [
        "Local()",
        "Otsu(bias: 3)",
        "DelaunayMesher",
        "Taubin(id: \"again\")",
        "Preset(\"denim\")",
        "Report()",
    ];
    let stage = proptest::sample::select(stages.to_vec());
    let params = ["radius", "bias", "low", "high", "edge", "height", "name", "id"];
    let values = ["3", "\"6 mm\"", "\"x\"", "Eight"];
    let places =
        ["photos.back", "photos.front.width", "seams", "style", "name", "body.height", "fabric.scale"];
    prop_oneof![
        (id.clone(), proptest::sample::select(params.to_vec()), proptest::sample::select(values.to_vec()))
            .prop_map(|(id, param, value)| set(&format!("stages.{id}.{param}"), value)),
        (id.clone(), proptest::sample::select(params.to_vec()))
            .prop_map(|(id, param)| remove(&format!("stages.{id}.{param}"))),
        id.clone().prop_map(|id| remove(&format!("stages.{id}"))),
        proptest::sample::select(places.to_vec()).prop_map(remove),
        (proptest::sample::select(places.to_vec()), proptest::sample::select(values.to_vec()))
            .prop_map(|(path, value)| set(path, value)),
        (id.clone(), stage.clone()).prop_map(|(id, stage)| swap(id, stage)),
        (proptest::option::of(id), stage).prop_map(|(id, stage)| add(stage, id)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_edits_leave_a_text_that_is_read_with_all_its_comments(edits in proptest::collection::vec(any_edit(), 1..12)) {
        let mut text = TEXT.to_owned();
        for edit in edits {
            let Ok(new) = edited(&text, &kit::registry(), std::slice::from_ref(&edit)) else { continue };
            prop_assert!(super::parse(&new).is_ok(), "{edit:?}\n{text}\n{new}");
            let comments = ["// A vest.", "// who", "// grain", "// the mesh", "// files", "// its back"];
            // What stands within a part goes with it.
            for comment in comments.iter().filter(|c| text.contains(**c) && !new.contains(**c)) {
                prop_assert!(*comment == "// its back" && edit != remove("photos.back"), "{edit:?} takes {comment}\n{new}");
            }
            let _ = load(&new, "vest.ron", Path::new("."), &kit::registry(), &[]);
            text = new;
        }
    }
}
