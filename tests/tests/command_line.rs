//! The command line, as a newcomer uses it.

use serde_json::Value;
use std::path::Path;
use toile_pipeline::{Fault, load};
use toile_tests::{pipeline, toile};

#[test]
fn no_arguments_is_a_usage_error() {
    assert_eq!(toile(&[]).code, 2);
    assert_eq!(toile(&["run"]).code, 2);
    assert_eq!(toile(&["fly"]).code, 2);
}

#[test]
fn help_and_version_are_answers() {
    let help = toile(&["--help"]);
    assert_eq!((help.code, help.err.as_str()), (0, ""));
    assert!(help.out.contains("Run a pipeline"));
    assert_eq!(toile(&["--version"]).code, 0);
}

#[test]
fn the_shipped_pipelines_are_valid() {
    for name in toile_tests::PIPELINES {
        let answer = toile(&["validate", &pipeline(name)]);
        assert_eq!(answer.code, 0, "{}", answer.err);
    }
}

#[test]
fn stages_lists_every_role_and_its_default() {
    let answer = toile(&["stages"]);
    assert_eq!(answer.code, 0);
    for name in [
        "NeighbourhoodMean",
        "Otsu",
        "Canny",
        "GridMesher",
        "PlaneSmoother",
        "SpringStitcher",
        "BvhCollider",
        "PhotoTexturer",
    ] {
        assert!(answer.out.contains(name), "{name} is missing in\n{}", answer.out);
    }
}

#[test]
fn stages_as_json_is_one_object() {
    let answer = toile(&["stages", "--json"]);
    let json: Value = serde_json::from_str(&answer.out).unwrap();
    let stages = json["stages"].as_array().unwrap();
    assert!(stages.len() > 30, "{} stages", stages.len());
    for stage in stages {
        assert!(!stage["doc"].as_str().unwrap().is_empty(), "{stage}");
        for param in stage["params"].as_array().unwrap() {
            assert!(!param["doc"].as_str().unwrap().is_empty(), "{param}");
        }
    }
}

#[test]
fn a_stage_shows_its_card() {
    let answer = toile(&["stage", "Otsu"]);
    assert_eq!(answer.code, 0);
    for part in ["Otsu (binariser", "Takes:", "photo", "Gives:", "mask", "Parameters:", "Example:"] {
        assert!(answer.out.contains(part), "{part} is missing in\n{}", answer.out);
    }
}

#[test]
fn an_unknown_stage_gets_a_near_name() {
    let answer = toile(&["stage", "Otzu"]);
    assert_eq!(answer.code, 3);
    assert_eq!(answer.err, "error: there is no stage `Otzu`; did you mean `Otsu`?\n");
}

#[test]
fn explain_says_what_runs_and_what_does_not() {
    let answer = toile(&["explain", &pipeline("vest.ron"), "--until", "GridMesher"]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.out.contains("  run   GridMesher           takes outline from "), "{}", answer.out);
    assert!(
        answer.out.contains("  skip  StaticEquilibrium    not needed until GridMesher"),
        "{}",
        answer.out
    );
}

/// Faults of a lone stage that only say that nothing feeds it.
const UNFED: [&str; 2] = ["missing_input", "ambiguous_input"];

#[test]
fn every_example_of_a_card_is_valid() {
    let registry = toile::registry();
    for card in registry.cards() {
        // Alone in a file, a shared name means the stage whose role comes first.
        if registry.named(card.name).count() > 1 {
            let arguments = card.example.trim_start_matches(card.name);
            assert!(registry.make(card, arguments).is_ok(), "the example of {}, {:?}", card.name, card.role);
            continue;
        }
        let text = format!("(name: \"example\", stages: [{}])", card.example);
        let faults = match load(&text, card.name, Path::new("."), &registry, &[]) {
            Ok(_) => continue,
            Err(faults) => faults,
        };
        let own: Vec<&Fault> = faults.faults.iter().filter(|f| !UNFED.contains(&f.code)).collect();
        assert!(own.is_empty(), "the example of {}: {own:?}", card.name);
    }
}

#[test]
fn a_scene_named_from_the_current_folder_is_brought_to_rest() {
    let dir = tempfile::tempdir().unwrap();
    let scene = toile_tests::root().join("pipelines/samples/scene/skirt.json");
    let (set, out) = (format!("scene.file={}", scene.display()), dir.path().display().to_string());
    let answer = toile(&["run", &pipeline("scene.ron"), "--set", &set, "--out", &out, "--json"]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let metrics: Value = serde_json::from_str(&answer.out).unwrap();
    let g = &metrics["garment"];
    assert_eq!((&g["seam_gap_max_m"], &g["self_crossings"]), (&Value::from(0.0), &Value::from(0)));
    assert!(g["edge_strain"]["p99"].as_f64().unwrap() < 0.02 && g["converged"] == true, "{g}");
    let text = std::fs::read_to_string(dir.path().join("result.obj")).unwrap();
    let vertices = text.lines().filter(|l| l.starts_with("v ")).count();
    assert_eq!(vertices as u64, g["vertices"].as_u64().unwrap());
}

#[test]
fn a_batch_is_checked_anywhere_and_run_by_the_program_alone() {
    let dir = tempfile::tempdir().unwrap();
    toile_tests::napkin::write(dir.path()).unwrap();
    let path = |name: &str| dir.path().join(name).display().to_string();
    let (manifest, pipeline, out) = (path("m.jsonl"), path("napkin.ron"), path("out"));
    std::fs::write(&manifest, "{\"id\": \"a\"}\n").unwrap();
    let batch = ["batch", &manifest, "--pipeline", &pipeline, "--out", &out];
    let checked = toile(&[&batch[..], &["--check"]].concat());
    assert_eq!((checked.code, checked.out.as_str()), (0, "1 garment: 1 to run, 0 done or not asked for\n"));
    let answer = toile(&batch);
    assert_eq!(answer.code, 3);
    assert_eq!(
        answer.err,
        "error: a batch starts a process for each garment, which only the program can\n  help: call the command `toile`\n"
    );
    assert!(!dir.path().join("out").exists());
}
