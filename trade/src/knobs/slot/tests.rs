//! Knobs of a real pipeline file.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::knobs::default_knobs::default_knobs;
use crate::knobs::knob::KnobSpec;
use crate::knobs::source::Source;
use std::path::PathBuf;
use toile_core::artifact::Garment;
use toile_core::{Context, Length, Registry, StageError, stage};

const FILE: &str = r#"(
    name: "scene",
    scene: Scene(file: "skirt.json"),
    stages: [
        StaticEquilibrium(speed: 0.002),   // to rest
        GarmentObj(name: "result"),
    ],
)"#;

const VEST: &str = r#"(
    photos: { "front": (file: "a.jpg", width: "52 cm"), "back": MirrorOf("front") },
    style: Outline(style: Vest),
    body: Mannequin(edge: "14 mm"),
    fabric: Preset("cotton poplin"),
    stages: [
        Otsu(), Canny(), GridMesher(edge: "16 mm"), Arrange(), BvhCollider(thickness: "2 mm"), StaticEquilibrium(),
    ],
)"#;

fn registry() -> Registry {
    let mut registry = Registry::new();
    toile_stages::register(&mut registry);
    registry
}

fn source<'a>(text: &str, registry: &'a Registry) -> Source<'a> {
    Source {
        text: text.into(),
        file: "my.ron".into(),
        base: PathBuf::from("."),
        quality: None,
        set: Vec::new(),
        registry,
    }
}

/// The overrides at a place of the cube, as one line.
fn overrides(text: &str, knobs: &[&str], at: &[f64]) -> String {
    let registry = registry();
    let source = source(text, &registry);
    let board = board(&source, knobs).unwrap();
    let all = board.overrides(&board.setting(at));
    assert!(source.load(&all).is_ok(), "{all:?}");
    all.iter().map(|o| format!("{}={}", o.path, o.value)).collect::<Vec<_>>().join("; ")
}

#[test]
fn parts_of_an_edge_are_refined_by_what_they_are() {
    let registry = registry();
    let text = VEST.replace(
        "StaticEquilibrium(),",
        "StaticEquilibrium(), Subdivide(parts: 1), StaticEquilibrium(id: \"Settle\", from_here: true),",
    );
    let source = source(&text, &registry);
    let board = board(&source, &["Subdivide.parts=1,2,3", "Settle.speed=1e-4..1e-2"]).unwrap();
    let at = |power: i32| board.refined(f64::sqrt(2.0).powi(power));
    let parts = |power| at(power)["Subdivide.parts"].clone();
    assert_eq!([0, 1, 2, 3, 4, 5].map(parts), ["1", "1", "2", "3", "4", "6"]);
    // By the edge, where that is refined; else by what is.
    assert!((board.ratio(&at(1), &at(0)) - f64::sqrt(2.0)).abs() < 1e-2);
    assert_eq!(board.ratio(&at(3), &at(2)), 1.5);
    assert_eq!(board.ratio(&at(2), &at(2)), 1.0);
}

#[test]
fn one_number_written_twice_is_one_and_one_outside_a_range_is_near_nothing_in_it() {
    let registry = registry();
    let source = source(FILE, &registry);
    let board = board(&source, &["StaticEquilibrium.speed=1e-3,3e-3,1e-2"]).unwrap();
    let dial = &board.knobs[0].dial;
    assert!(dial.is_near("0.001", "1e-3", 0.1) && !dial.is_near("0.002", "3e-3", 0.1));
    assert_eq!(dial.place("0.003"), Some(0.5));
    let board = self::board(&source, &["StaticEquilibrium.speed=1e-2..1e-1"]).unwrap();
    let dial = &board.knobs[0].dial;
    assert!(dial.is_near("0.0101", "0.01", 0.03) && !dial.is_near("0.002", "0.01", 0.03));
}

fn board(source: &Source<'_>, knobs: &[&str]) -> Result<KnobBoard, StageError> {
    let specs: Vec<KnobSpec> = knobs.iter().map(|k| k.parse().unwrap()).collect();
    KnobBoard::new(source, &source.load(&[]).unwrap(), &specs)
}

fn refused(text: &str, knobs: &[&str]) -> (String, String) {
    let registry = registry();
    let e = board(&source(text, &registry), knobs).unwrap_err();
    (e.message, e.hint.unwrap_or_default())
}

#[test]
fn a_range_is_turned_by_factors_between_its_ends() {
    let knobs = ["mesher.edge=6..24 mm"];
    for (at, value) in [(0.0, "6 mm"), (0.5, "12 mm"), (1.0, "24 mm"), (0.75, "17 mm")] {
        assert_eq!(overrides(VEST, &knobs, &[at]), format!("stages.GridMesher.edge=\"{value}\""));
    }
}

#[test]
fn another_stage_takes_over_what_it_knows_and_the_knobs_of_its_role() {
    let knobs = ["mesher=GridMesher,DelaunayMesher", "mesher.edge=6..24 mm", "GridMesher.edge=1..2 mm"];
    assert_eq!(overrides(VEST, &knobs[..1], &[0.9]), "stages.GridMesher=DelaunayMesher(edge: \"16 mm\")");
    assert_eq!(overrides(VEST, &knobs[..2], &[0.9, 0.0]), "stages.GridMesher=DelaunayMesher(edge: \"6 mm\")");
    // A knob of the one stage does not act on the other.
    let only = [knobs[0], knobs[2]];
    assert_eq!(overrides(VEST, &only, &[0.9, 0.0]), "stages.GridMesher=DelaunayMesher(edge: \"16 mm\")");
    assert_eq!(overrides(VEST, &only, &[0.1, 0.0]), "stages.GridMesher.edge=\"1 mm\"");
}

#[test]
fn stages_of_sections_lists_and_stages_brought_in_can_be_turned() {
    assert_eq!(overrides(VEST, &["body.edge=10..20 mm"], &[0.0]), "body.edge=\"10 mm\"");
    assert_eq!(
        overrides(VEST, &["collider.volume=Aabb,KDop(14)"], &[0.9]),
        "stages.BvhCollider.volume=KDop(14)"
    );
    let knobs = ["Xpbd.dt=0.002..0.008", "solver=StaticEquilibrium,Xpbd"];
    assert_eq!(
        overrides(FILE, &knobs, &[0.9, 0.5]),
        "stages.StaticEquilibrium=Xpbd(dt: 0.004, speed: 0.002)"
    );
    assert_eq!(overrides(FILE, &knobs, &[0.1, 0.5]), "");
    assert_eq!(overrides(VEST, &["mesher.edge=8 mm,12 mm"], &[0.9]), "stages.GridMesher.edge=\"12 mm\"");
}

#[test]
fn the_own_setting_and_its_refinements() {
    let registry = registry();
    let source = source(VEST, &registry);
    let board = board(
        &source,
        &["mesher.edge=8..32 mm", "solver=StaticEquilibrium,Xpbd", "StaticEquilibrium.speed=1e-4..1e-2"],
    )
    .unwrap();
    let words = |s: Setting| s.into_iter().map(|(k, v)| format!("{k} {v}")).collect::<Vec<_>>().join(", ");
    assert_eq!(
        words(board.own()),
        "StaticEquilibrium.speed 0.005, mesher.edge \"16 mm\", solver StaticEquilibrium"
    );
    assert_eq!(
        words(board.refined(2.0)),
        "StaticEquilibrium.speed 0.0025, mesher.edge \"8 mm\", solver StaticEquilibrium"
    );
    let fine = board.refined(4.0);
    assert!(board.is_finer(&fine, 1.9) && !board.is_finer(&board.refined(2.0), 1.3));
    assert!(
        board.is_too_fine(&board.refined(4.0), &fine, 1.3) && !board.is_too_fine(&board.own(), &fine, 1.3)
    );
    // What stands at a place is found there again.
    let setting = board.setting(&[0.9, 0.3, 0.7]);
    assert_eq!(board.setting(&board.place(&setting)), setting);
}

#[test]
fn the_reference_may_have_values_of_its_own() {
    let registry = registry();
    let source = source(&FILE.replace("0.002", "0.002, bending_continuation: false"), &registry);
    let knobs = [
        "StaticEquilibrium.speed=1e-4..1e-2",
        "StaticEquilibrium.bending_continuation=true,false",
        "solver=StaticEquilibrium,Xpbd",
    ];
    let given = |reference: &[&str]| {
        let values: Vec<ReferenceValue> = reference.iter().map(|r| r.parse().unwrap()).collect();
        board(&source, &knobs).unwrap().with_reference(&values)
    };
    let words = |s: Setting| s.into_iter().map(|(k, v)| format!("{k} {v}")).collect::<Vec<_>>().join(", ");
    let board = given(&["StaticEquilibrium.bending_continuation=true"]).unwrap();
    assert_eq!(
        words(board.own()),
        "StaticEquilibrium.bending_continuation false, StaticEquilibrium.speed 0.002, solver StaticEquilibrium"
    );
    assert_eq!(
        words(board.refined(2.0)),
        "StaticEquilibrium.bending_continuation true, StaticEquilibrium.speed 0.001, solver StaticEquilibrium"
    );
    let refused = |reference: &str| {
        let e = given(&[reference]).unwrap_err();
        (e.message, e.hint.unwrap_or_default())
    };
    for (reference, message, hint) in [
        (
            "solver=Xpbd",
            "--reference `solver`: the reference keeps the pipeline's own stages",
            "name a parameter, like `StaticEquilibrium.bending_continuation=true`",
        ),
        (
            "StaticEquilibrium.steps=900",
            "--reference `StaticEquilibrium.steps`: there is no such knob",
            "add `--knob \"StaticEquilibrium.steps=...\"`, or give it by --set",
        ),
        (
            "StaticEquilibrium.bending_continuation=yes",
            "`StaticEquilibrium.bending_continuation`: `bending_continuation` must be true | false, found `yes`",
            "",
        ),
    ] {
        assert_eq!(refused(reference), (message.to_owned(), hint.to_owned()));
    }
    let form = Err("write KEY=VALUE, like `StaticEquilibrium.bending_continuation=true`".to_owned());
    assert_eq!("StaticEquilibrium.bending_continuation=".parse::<ReferenceValue>(), form);
}

/// A stage as third parties write it, with names of its own.
#[stage(role = Draper, source = "none", example = "Turner()")]
struct Turner {
    /// Turns.
    #[param(default = 40, min = 1, max = 1000, trades, finer = "more")]
    turns: u32,
    /// Cell of its lattice.
    #[param(default = Length::mm(8.0), min = 1e-3, max = 0.1, trades, finer = "less")]
    cell: Length,
    /// No resolution.
    #[param(default = 2.0, trades)]
    edge: f64,
}

#[stage]
impl Turner {
    fn run(&self, garment: &Garment, _cx: &Context) -> Result<Garment, StageError> {
        Ok(garment.clone())
    }
}

#[test]
fn a_stage_of_a_third_party_says_which_of_its_parameters_are_resolutions() {
    let mut registry = registry();
    registry.add::<Turner>();
    let source = source(&FILE.replace("StaticEquilibrium(speed: 0.002)", "Turner(turns: 20)"), &registry);
    let knobs = ["Turner.turns=10..100", "Turner.cell=4..20 mm", "Turner.edge=1..5"];
    let board = board(&source, &knobs).unwrap();
    let words = |s: &Setting| s.iter().map(|(k, v)| format!("{k} {v}")).collect::<Vec<_>>().join(", ");
    let (own, fine) = (board.own(), board.refined(4.0));
    assert_eq!(words(&own), "Turner.cell \"8 mm\", Turner.edge 2.0, Turner.turns 20");
    assert_eq!(words(&fine), "Turner.cell \"2 mm\", Turner.edge 2.0, Turner.turns 80");
    // Cells must be finer than what is judged, turns need not.
    assert!(board.is_finer(&fine, 1.3) && !board.is_finer(&own, 1.3));
    let mut turned = own.clone();
    turned.insert("Turner.turns".into(), "1000".into());
    assert!(!board.is_too_fine(&turned, &fine, 1.3));
    turned.insert("Turner.cell".into(), "\"2 mm\"".into());
    assert!(board.is_too_fine(&turned, &fine, 1.3));
    let found = default_knobs(&source.load(&[]).unwrap(), &registry);
    let found: Vec<String> = found.iter().map(KnobSpec::key).collect();
    assert_eq!(found, ["solver", "Turner.turns", "Turner.cell"]);
}

#[test]
fn a_pipeline_without_knobs_gets_its_resolutions_and_stages() {
    let registry = registry();
    let pipeline = source(VEST, &registry).load(&[]).unwrap();
    let found: Vec<String> = default_knobs(&pipeline, &registry).iter().map(KnobSpec::key).collect();
    assert_eq!(
        found,
        ["mesher.edge", "mesher", "solver", "StaticEquilibrium.speed", "StaticEquilibrium.non_static"]
    );
    let scene = source(FILE, &registry).load(&[]).unwrap();
    assert_eq!(
        default_knobs(&scene, &registry).iter().map(KnobSpec::key).collect::<Vec<_>>(),
        ["solver", "StaticEquilibrium.speed"]
    );
}

/// A vest whose folds one mesh finds and a finer one keeps.
fn refined_vest() -> String {
    VEST.replace(
        "StaticEquilibrium(),",
        "StaticEquilibrium(), Subdivide(parts: 2), StaticEquilibrium(id: \"Settle\", from_here: true),",
    )
}

#[test]
fn where_a_draped_garment_is_refined_its_parts_are_turned_and_the_mesh_that_finds_the_folds_stays() {
    let registry = registry();
    let pipeline = source(&refined_vest(), &registry).load(&[]).unwrap();
    let found = default_knobs(&pipeline, &registry);
    assert_eq!(
        found.iter().map(KnobSpec::key).collect::<Vec<_>>(),
        ["Subdivide.parts", "Settle.speed", "Settle.non_static"]
    );
    let board = KnobBoard::new(&source(&refined_vest(), &registry), &pipeline, &found).unwrap();
    // Half and twice the parts.
    assert!(
        board.setting(&[0.0, 0.5])["Subdivide.parts"] == "1"
            && board.setting(&[1.0, 0.5])["Subdivide.parts"] == "4"
    );
}

#[test]
fn parts_of_an_edge_are_a_resolution_in_space_that_a_fiftieth_does_not_change() {
    let registry = registry();
    let text = refined_vest();
    let source = source(&text, &registry);
    let board = board(&source, &["Subdivide.parts=1,2,3", "Settle.speed=1e-4..1e-2"]).unwrap();
    let (own, near, far) = (board.own(), board.refined(1.02), board.refined(2.0));
    assert_eq!((&*near["Subdivide.parts"], &*far["Subdivide.parts"]), ("2", "4"));
    assert!(near != own && !board.differ_in_space(&near, &own) && board.differ_in_space(&far, &own));
    // A reference of four parts may judge three, not four.
    assert!(board.is_finer(&far, 1.3) && !board.is_finer(&own, 1.3));
    assert!(board.is_too_fine(&far, &far, 1.3) && !board.is_too_fine(&own, &far, 1.3));
}

#[test]
fn faults_word_for_word() {
    for (knob, message, hint) in [
        ("mehser.edge=6..24 mm", "the pipeline has no stage or role `mehser`", "did you mean `mesher`?"),
        ("mesher.egde=6..24 mm", "`mesher` has no parameter `egde`", "did you mean `mesher.edge`?"),
        (
            "mesher=GridMesher,DelauneyMesher",
            "no mesher is called `DelauneyMesher`",
            "did you mean `DelaunayMesher`?",
        ),
        ("mesher.edge=6..24", "`mesher.edge` is a length", "write the unit, like `6..24 mm`"),
        ("StaticEquilibrium.speed=1..2 mm", "`StaticEquilibrium.speed` is a number", "write bare numbers"),
        (
            "solver=1..2",
            "`solver` is a stage, which has no range",
            "list stages, like `solver=StaticEquilibrium,Xpbd`, or name a parameter, like `solver.edge=6..24 mm`",
        ),
        (
            "collider.volume=1..2",
            "`collider.volume` is Aabb | Sphere | Obb | KDop(...), which has no range",
            "list its values with commas",
        ),
        ("mesher.edge=6..2400 mm", "`mesher.edge`: `edge` is 2.4 m, above its greatest value 1 m", ""),
    ] {
        assert_eq!(refused(VEST, &[knob]), (message.to_owned(), hint.to_owned()));
    }
    assert_eq!(
        refused(VEST, &["solver=StaticEquilibrium,Xpbd", "solver=StaticEquilibrium,Projective"]).0,
        "there are two knobs `solver`"
    );
    for (knobs, message) in [
        (
            ["StaticEquilibrium=StaticEquilibrium,Xpbd", "solver=StaticEquilibrium,Projective"],
            "the knobs `StaticEquilibrium` and `solver` act on the same target",
        ),
        (
            ["StaticEquilibrium.speed=1e-3..1e-2", "solver.speed=1e-2..1e-1"],
            "the knobs `StaticEquilibrium.speed` and `solver.speed` act on the same target",
        ),
    ] {
        assert_eq!(refused(VEST, &knobs), (message.to_owned(), "leave one of them out".to_owned()));
    }
}
