//! The crates of plugins/ through the plugin ABI: what they give is what they give linked in, bit
//! for bit.

use std::ffi::OsString;
use toile_core::testkit::{Trial, cases, folder, from_example};
use toile_core::{Card, Registry};
use toile_pipeline::plugin::load_plugin;
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
        load_plugin(&mut loaded, &library(name), None).unwrap();
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
    load_plugin(&mut loaded, &library("toile_guided"), None).unwrap();
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
#[ignore = "slow: .ci/wide"]
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

#[test]
fn what_a_plugin_promises_is_declared_until_the_doctor_ran_it() {
    let dir = tempfile::tempdir().unwrap();
    let (file, cache) = (library("toile_tutorial").display().to_string(), dir.path().display().to_string());
    let with = ["--plugin", &file, "--cache-dir", &cache];
    let call = |arguments: &[&str]| toile_tests::toile(&[arguments, &with].concat());
    let card = || call(&["stage", "Dust"]).out;
    let words = "\nPromises:\n  Deterministic            declared\n  ThreadInvariant          declared\n  Cancellable              declared\n  \
                 (declared: nobody ran it here; `toile doctor Dust --contracts` does)\n";
    assert!(card().contains(words), "{}", card());
    assert!(call(&["stage", "Dust", "--json"]).out.contains("\"checked\":[]"));

    let answer = call(&["doctor", "Dust", "--contracts"]);
    assert_eq!(answer.code, 0, "{}", answer.out);
    assert!(answer.out.contains("\n    ThreadInvariant          kept "), "{}", answer.out);
    let checked = "\nPromises:\n  Deterministic            checked\n  ThreadInvariant          checked\n  Cancellable              checked\n";
    assert!(card().contains(checked) && !card().contains("declared"), "{}", card());
    assert!(
        call(&["stage", "Dust", "--json"])
            .out
            .contains("\"checked\":[\"Deterministic\",\"ThreadInvariant\",\"Cancellable\"]")
    );
    // The built-in stages are held to theirs by the project's own tests.
    assert!(call(&["stage", "Otsu"]).out.contains("  Deterministic            checked\n"));

    // Of another build of the library nothing is known.
    let copy = dir.path().join("libcopy.so");
    let mut bytes = std::fs::read(&file).unwrap();
    bytes.push(0);
    std::fs::write(&copy, bytes).unwrap();
    let copy = copy.display().to_string();
    let other = toile_tests::toile(&["stage", "Dust", "--plugin", &copy, "--cache-dir", &cache]);
    assert!(other.out.contains("  Deterministic            declared\n"), "{}{}", other.out, other.err);
}
