//! The crates of plugins/ through the border: what they give is what they give linked in, bit for bit.

use std::ffi::OsString;
use toile_core::testkit::{Trial, cases, folder, from_example};
use toile_core::{Card, Registry};
use toile_tests::plugins::library;

type Register = fn(&mut Registry);

const SHIPPED: [(&str, Register); 5] = [
    ("toile_guided", toile_guided::register),
    ("toile_ironed", toile_ironed::register),
    ("toile_lattice", toile_lattice::register),
    ("toile_sdf", toile_sdf::register),
    ("toile_tutorial", toile_tutorial::register),
];

/// The most cases of the suite that a stage is run on here; the contracts are checked on all.
const CASES: usize = 12;

#[test]
fn every_stage_gives_the_same_bits_loaded_and_linked_in() {
    let (_kept, dir) = folder().unwrap();
    for (name, register) in SHIPPED {
        let (mut linked, mut loaded) = (Registry::new(), Registry::new());
        register(&mut linked);
        loaded.load_plugin(&library(name), None).unwrap();
        for card in linked.cards() {
            let [own, foreign] = [&linked, &loaded].map(|r| from_example(r, card, &dir).unwrap());
            assert_eq!(own.params(), foreign.params());
            let turned =
                |c: &Card| c.params.iter().map(|p| (p.name, p.trades, p.finer, p.way)).collect::<Vec<_>>();
            assert_eq!(turned(card), turned(loaded.card(card.name).unwrap()));
            let mut answers = 0;
            for case in cases(card).iter().take(CASES) {
                let [a, b] =
                    [&own, &foreign].map(|s| Trial { stage: s.as_ref(), folder: &dir }.run(&case.inputs));
                assert_eq!(a.fingerprint(), b.fingerprint(), "{} on {}", card.name, case.name);
                answers += usize::from(a.answered());
            }
            assert!(answers > 0, "{} answers nothing", card.name);
        }
    }
}

#[test]
fn a_loaded_card_says_what_makes_a_stage_do_other_work() {
    let mut loaded = Registry::new();
    loaded.load_plugin(&library("toile_guided"), None).unwrap();
    let ways = loaded.card("Guided").unwrap().params.iter().filter(|p| p.way).map(|p| p.name);
    assert_eq!(ways.collect::<Vec<_>>(), ["guide"]);
}

/// Denoiser, mesher, collider and texturer of plugins in one pipeline.
const SWAPS: [&str; 4] = [
    "stages.NeighbourhoodMean=Guided()",
    "stages.GridMesher=LatticeMesher(edge: \"16 mm\")",
    "stages.BvhCollider=SdfCollider()",
    "stages.PhotoTexturer=Ironed()",
];

fn vest(registry: &Registry, plugins: &[OsString], out: &std::path::Path) -> (u8, String) {
    let vest = toile_tests::pipeline("vest.ron");
    let mut arguments: Vec<OsString> =
        ["toile", "run", &vest, "--no-cache", "--out"].map(OsString::from).into();
    arguments.push(out.into());
    SWAPS.iter().for_each(|s| arguments.extend(["--set".into(), OsString::from(s)]));
    plugins.iter().for_each(|p| arguments.extend(["--plugin".into(), p.clone()]));
    let mut err = Vec::new();
    let code = toile::command_with(registry, arguments, &mut Vec::new(), &mut err);
    (code, String::from_utf8_lossy(&err).into_owned())
}

#[test]
fn a_vest_of_plugins_is_the_same_loaded_and_linked_in() {
    let dir = tempfile::tempdir().unwrap();
    let [linked_out, loaded_out] = ["linked", "loaded"].map(|d| dir.path().join(d));
    let mut linked = toile::registry();
    SHIPPED.iter().for_each(|(_, register)| register(&mut linked));
    let plugins: Vec<OsString> = SHIPPED.iter().map(|(name, _)| library(name).into()).collect();
    assert_eq!(vest(&linked, &[], &linked_out), (0, String::new()));
    assert_eq!(vest(&toile::registry(), &plugins, &loaded_out), (0, String::new()));
    let [a, b] = [linked_out, loaded_out].map(|d| std::fs::read(d.join("garment.glb")).unwrap());
    assert!(a == b, "the two models differ");
}
