//! Old files brought up to date.
#![allow(clippy::unwrap_used)]
use super::*;
use crate::load::tests::kit;
use proptest::prelude::*;
use toile_core::Migration;

/// The test kit's stages, with a history.
fn registry() -> Registry {
    let mut r = kit::registry();
    r.migrate(Migration::stage("Threshold", "Otsu"));
    r.migrate(Migration::renamed("Threshold", "offset", "bias"));
    r.migrate(Migration::joined("Darker", "Otsu", "bias: 3.0"));
    r.migrate(Migration::stage("Grid", "Lattice"));
    r.migrate(Migration::stage("Lattice", "GridMesher"));
    r.migrate(Migration::converted("GridMesher", "edge_mm", "edge", |mm| {
        mm.parse::<f64>().ok().map(|mm| format!("\"{mm} mm\""))
    }));
    r.migrate(Migration::removed("GridMesher", "rounds", "the mesh is improved until it is good"));
    r
}

const OLD: &str = r#"// A vest, from last year.
(
    stages: [
        Threshold( /* darker */ offset: 3.0),   // garment or ground
        Canny(from: "Threshold"),
        Grid(
            rounds: 4,       // enough
            edge_mm: 12,     // finer: slower
        ),
        Lattice(edge_mm: 8, rounds: 2, id: "fine"), Taubin(),
    ],
)
"#;

const NEW: &str = r#"// A vest, from last year.
(
    stages: [
        Otsu(id: "Threshold",  /* darker */ bias: 3.0),   // garment or ground
        Canny(from: "Threshold"),
        GridMesher(
            // enough
            edge: "12 mm",     // finer: slower
        ),
        GridMesher(edge: "8 mm", id: "fine"), Taubin(),
    ],
)
"#;

#[test]
fn an_old_file_gets_the_new_names_and_keeps_its_comments_order_and_ids() {
    let new = migrate(OLD, "vest.ron", &registry()).unwrap();
    assert_eq!(new.text, NEW);
    assert_eq!(
        new.changes,
        [
            "line 4: stage Threshold -> Otsu",
            "line 4: Otsu: keeps its id, which others read from",
            "line 4: Otsu: offset -> bias",
            "line 6: stage Grid -> GridMesher",
            "line 7: GridMesher: rounds removed: the mesh is improved until it is good",
            "line 8: GridMesher: edge_mm: 12 -> edge: \"12 mm\"",
            "line 10: stage Lattice -> GridMesher",
            "line 10: GridMesher: edge_mm: 8 -> edge: \"8 mm\"",
            "line 10: GridMesher: rounds removed: the mesh is improved until it is good",
        ]
    );
    let again = migrate(&new.text, "vest.ron", &registry()).unwrap();
    assert_eq!((again.text.as_str(), again.changes.len()), (NEW, 0));
}

#[test]
fn the_last_argument_goes_with_the_comma_before_it() {
    let text = "(stages: [GridMesher(edge: \"8 mm\", rounds: 2), GridMesher(rounds: 1)])";
    let new = migrate(text, "x.ron", &registry()).unwrap();
    assert_eq!(new.text, "(stages: [GridMesher(edge: \"8 mm\"), GridMesher()])");
}

#[test]
fn old_names_are_faults_that_name_the_command() {
    let faults =
        crate::load::load(OLD, "vest.ron", std::path::Path::new("."), &registry(), &[]).unwrap_err().faults;
    let told: Vec<(&str, &str)> = faults
        .iter()
        .filter(|f| f.code == "old_name")
        .map(|f| (f.message.as_str(), f.hint.as_deref().unwrap()))
        .collect();
    let hint = "`toile migrate` rewrites the file to the new names";
    assert!(told.contains(&("the stage `Threshold` is now called `Otsu`", hint)), "{told:?}");
    let text = "(stages: [GridMesher(edge_mm: 3, rounds: 1)])";
    let faults = crate::load::load(text, "x.ron", std::path::Path::new("."), &registry(), &[]).unwrap_err();
    let messages: Vec<&str> =
        faults.faults.iter().filter(|f| f.code == "old_name").map(|f| f.message.as_str()).collect();
    assert_eq!(
        messages,
        [
            "the parameter `edge_mm` is now called `edge`",
            "the parameter `rounds` was removed: the mesh is improved until it is good"
        ]
    );
}

#[test]
fn a_value_that_cannot_be_converted_and_a_name_given_twice_are_left_to_the_user() {
    let text = "(stages: [GridMesher(edge_mm: fine)])";
    assert_eq!(migrate(text, "x.ron", &registry()).unwrap().text, text);
    let text = "(stages: [Threshold(offset: 1.0, bias: 2.0)])";
    let faults = migrate(text, "x.ron", &registry()).unwrap_err().faults;
    assert_eq!(faults[0].message, "`offset` is now called `bias`, which is given as well");
    assert_eq!(faults[0].hint.as_deref(), Some("leave one of them out"));
}

#[test]
fn a_stage_that_became_a_choice_of_another_says_which() {
    for (old, new) in [
        ("[Darker()]", "[Otsu(bias: 3.0)]"),
        ("[Darker(garment: Dark)]", "[Otsu(bias: 3.0, garment: Dark)]"),
        ("[Darker(), Canny(from: \"Darker\")]", "[Otsu(bias: 3.0, id: \"Darker\"), Canny(from: \"Darker\")]"),
        ("[Darker]", "[Otsu(bias: 3.0)]"),
    ] {
        let migrated = migrate(&format!("(stages: {old})"), "x.ron", &registry()).unwrap();
        assert_eq!(migrated.text, format!("(stages: {new})"));
        assert_eq!(migrated.changes[0], "line 1: stage Darker -> Otsu(bias: 3.0)");
    }
    let load =
        crate::load::load("(stages: [Darker()])", "x.ron", std::path::Path::new("."), &registry(), &[]);
    let faults = load.unwrap_err().faults;
    let old = faults.iter().find(|f| f.code == "old_name").unwrap();
    assert_eq!(old.message, "the stage `Darker` is now `Otsu(bias: 3.0)`");
}

const QUALITIES: &str = r#"(
    stages: [Threshold(), Grid(id: "fine"), Lattice(edge_mm: 9), Taubin()],
    qualities: [
        Quality(name: "Draft", max_error: "9 mm", set: [
            "stages.Threshold.offset=3.0",   // darker
            "stages.fine.edge_mm=12", "stages.fine.rounds=2",
            "stages.Taubin=Lattice(rounds: 1, edge_mm: 4)",
            "stages.Canny.low=3",
        ]),
        Quality(name: "Fine", max_error: "1 mm", set: ["stages.Lattice.rounds=9"]),
    ],
)"#;

#[test]
fn the_settings_of_qualities_get_the_new_names() {
    let new = migrate(QUALITIES, "x.ron", &registry()).unwrap();
    let set = new.text.split_once("qualities").unwrap().1;
    let expected = r#": [
        Quality(name: "Draft", max_error: "9 mm", set: [
            "stages.Otsu.bias=3.0",   // darker
            "stages.fine.edge=\"12 mm\"", 
            "stages.Taubin=GridMesher(edge: \"4 mm\")",
            "stages.Canny.low=3",
        ]),
        Quality(name: "Fine", max_error: "1 mm", set: []),
    ],
)"#;
    assert_eq!(set, expected);
    assert_eq!(
        new.changes[4..],
        [
            "line 5: quality Draft: stages.Threshold.offset=3.0 -> stages.Otsu.bias=3.0",
            "line 6: quality Draft: stages.fine.edge_mm=12 -> stages.fine.edge=\"12 mm\"",
            "line 6: quality Draft: stages.fine.rounds=2 removed: the mesh is improved until it is good",
            "line 7: quality Draft: stages.Taubin=Lattice(rounds: 1, edge_mm: 4) -> stages.Taubin=GridMesher(edge: \"4 mm\")",
            "line 10: quality Fine: stages.Lattice.rounds=9 removed: the mesh is improved until it is good",
        ]
    );
    let again = migrate(&new.text, "x.ron", &registry()).unwrap();
    assert_eq!((again.text.as_str(), again.changes.len()), (new.text.as_str(), 0));
}

#[test]
fn the_version_of_parameters_counts_the_changes() {
    assert_eq!(registry().params_version("GridMesher"), 5);
    assert_eq!(registry().params_version("Canny"), 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_cut_of_a_file_is_migrated_or_refused_and_once_is_enough(at in 0usize..400, cut in 0usize..40) {
        let at = (0..=at.min(OLD.len())).rev().find(|i| OLD.is_char_boundary(*i)).unwrap();
        let to = (at..=(at + cut).min(OLD.len())).rev().find(|i| OLD.is_char_boundary(*i)).unwrap();
        let text = format!("{}{}", &OLD[..at], &OLD[to..]);
        if let Ok(new) = migrate(&text, "x.ron", &registry()) {
            let again = migrate(&new.text, "x.ron", &registry());
            prop_assert_eq!(again.map(|a| a.text).ok(), Some(new.text));
        }
    }
}
