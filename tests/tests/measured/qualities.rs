//! Named qualities, from the measurement to a run: measured once, proved, written, checked, run.

use serde_json::Value;
use std::fs;
use std::path::Path;
use toile_pipeline::{Basis, Changes, Quality, fill_qualities, load_with};
use toile_tests::napkin::{self, PIPELINE};
use toile_tests::{Answer, PIPELINES, pipeline, toile};

fn on(dir: &Path, command: &str, file: &str, more: &[&str]) -> Answer {
    let file = dir.join(file).display().to_string();
    toile(&[&[command, &file], more].concat())
}

/// Measures three settings of the napkin in `DIR/out`.
fn measured(dir: &Path) -> String {
    napkin::write(dir).unwrap();
    let out = dir.join("out").display().to_string();
    let fixed =
        ["--knob", "StaticEquilibrium.speed=0.001..0.1", "--repeats", "1", "--starts", "1", "--points", "3"];
    let answer = on(dir, "trade", "napkin.ron", &[&["--out", &out, "--budget", "2m"], &fixed[..]].concat());
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    out
}

#[test]
fn qualities_are_measured_once_proved_written_checked_and_run() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let from = measured(dir);
    let asked = [
        "--from",
        &from,
        "--starts",
        "2",
        "--quality",
        "Rough=20 cm",
        "--quality",
        "Very fine=0.000001 mm",
        "--quality",
        "Mid=10 cm",
    ];
    let answer = on(dir, "tune", "napkin.ron", &asked);
    assert_eq!(answer.code, 4, "one is not kept: {}{}", answer.out, answer.err);
    let refused = "error: quality `Very fine`: an error of at most 0.000001 mm cannot be verified: the reference is known to ";
    assert!(answer.err.contains(refused), "{}", answer.err);
    assert!(
        answer.out.contains("Rough (20 cm): StaticEquilibrium.speed ")
            && answer.out.contains("Mid (10 cm): "),
        "{}",
        answer.out
    );
    assert_eq!(answer.out.matches("    2 of 2 moved starts within ").count(), 2, "{}", answer.out);

    let text = fs::read_to_string(dir.join("napkin-tuned.ron")).unwrap();
    assert!(text.starts_with(PIPELINE.trim_end().trim_end_matches(')')), "all else stays as it was: {text}");
    assert!(
        text.contains(
            "Quality(name: \"Rough\", max_error: \"20 cm\",\n            set: [\"stages.StaticEquilibrium.speed="
        ),
        "{text}"
    );
    assert!(
        text.contains(": 95 % of the surface within ")
            && text.contains(" mm of the reference (itself known to ")
            && text.contains(" s of processor time (toile "),
        "{text}"
    );

    let valid = on(dir, "validate", "napkin-tuned.ron", &[]);
    assert!(valid.out.ends_with("valid, 4 stages, qualities Rough (20 cm), Mid (10 cm)\n"), "{}", valid.out);
    run(dir);
    explained(dir);
    edited(dir);
    again(dir, &from);
}

/// The metrics of a run of the tuned file.
fn metrics(dir: &Path, more: &[&str]) -> Value {
    let out = dir.join("run").display().to_string();
    let answer = on(dir, "run", "napkin-tuned.ron", &[&["--out", &out, "--json"], more].concat());
    assert_eq!(answer.code, 0, "{}", answer.err);
    serde_json::from_str(&answer.out).unwrap()
}

fn run(dir: &Path) {
    assert_eq!(metrics(dir, &["--quality", "Rough"])["quality"], "Rough");
    let changed = metrics(dir, &["--quality", "Rough", "--set", "stages.StaticEquilibrium.speed=0.02"]);
    assert_eq!(changed["quality"], "Rough, changed by --set");
    assert!(metrics(dir, &[]).get("quality").is_none());
    let shown = on(
        dir,
        "run",
        "napkin-tuned.ron",
        &["--quality", "Rough", "--out", &dir.join("x").display().to_string()],
    );
    assert!(shown.out.contains("\nquality Rough\n"), "{}", shown.out);
    let wrong = on(dir, "run", "napkin-tuned.ron", &["--quality", "Ruogh", "--json"]);
    let faults: Value = serde_json::from_str(&wrong.out).unwrap();
    assert_eq!((wrong.code, faults["faults"][0]["code"].as_str()), (3, Some("unknown_quality")));
    assert_eq!(faults["faults"][0]["hint"], "did you mean `Rough`? there is `Rough`, `Mid`");
}

fn explained(dir: &Path) {
    let explained = on(dir, "explain", "napkin-tuned.ron", &["--quality", "Mid"]);
    let title = "napkin: 4 stages, quality Mid; qualities: Rough (20 cm), Mid (10 cm)\n";
    assert!(explained.out.starts_with(title), "{}", explained.out);
}

/// A claim holds for what it was measured for, and no longer.
fn edited(dir: &Path) {
    let out = dir.join("edited").display().to_string();
    let with = |more: &[&str]| {
        on(dir, "run", "napkin-tuned.ron", &[&["--quality", "Mid", "--out", &out], more].concat())
    };
    assert_eq!(with(&[]).err, "");
    // What acts on the garment: the cloth, in the scene's own file.
    let mut stiffer = napkin::scene();
    stiffer["material"]["bend"] = 2e-5.into();
    fs::write(dir.join("napkin.json"), stiffer.to_string()).unwrap();
    let words = "Rough (20 cm, measured for another pipeline), Mid (10 cm, measured for another pipeline)";
    let valid = on(dir, "validate", "napkin-tuned.ron", &[]);
    assert!(valid.code == 0 && valid.out.ends_with(&format!(", qualities {words}\n")), "{}", valid.out);
    let explained = on(dir, "explain", "napkin-tuned.ron", &[]);
    assert!(
        explained.out.starts_with(&format!("napkin: 4 stages; qualities: {words}\n")),
        "{}",
        explained.out
    );
    let told = with(&[]);
    let warning = "warning: quality Mid: measured for another pipeline; whether it keeps 10 cm here is not known\n  \
                   help: `toile tune PIPELINE --quality \"Mid=10 cm\"` measures it\n";
    assert_eq!((told.code, told.err.as_str()), (0, warning));
    assert!(told.out.contains("\nquality Mid, measured for another pipeline\n"), "{}", told.out);
    napkin::write(dir).unwrap();
    // A copy under another name is the same scene; a setting that acts is another pipeline.
    fs::copy(dir.join("napkin.json"), dir.join("copy.json")).unwrap();
    let copy = dir.join("copy.json").display().to_string();
    assert_eq!(with(&["--set", &format!("scene.file={copy:?}")]).err, "");
    assert!(
        with(&["--set", "stages.StaticEquilibrium.steps=400"])
            .err
            .starts_with("warning: quality Mid: measured for another pipeline; ")
    );
    // Without the digest nobody knows.
    let tuned = fs::read_to_string(dir.join("napkin-tuned.ron")).unwrap();
    let line = |l: &&str| !l.trim_start().starts_with("measured_for: ");
    let bare: Vec<String> =
        tuned.lines().filter(line).map(|l| l.replace("cores)\",", "cores)\"),")).collect();
    fs::write(dir.join("bare.ron"), bare.join("\n")).unwrap();
    let valid = on(dir, "validate", "bare.ron", &[]);
    assert!(
        valid.out.contains("Rough (20 cm, not known what it was measured for)"),
        "{}{}",
        valid.out,
        valid.err
    );
}

/// A shipped pipeline's text with each quality measured for the pipeline as it is.
fn stamped(name: &str) -> (String, String) {
    let (file, registry) = (pipeline(name), toile::registry());
    let base = Path::new(&file).parent().unwrap();
    let text = fs::read_to_string(&file).unwrap();
    let load = |quality: Option<&str>| {
        load_with(&text, name, base, &registry, &Changes { quality, ..Changes::default() }).unwrap()
    };
    let stamp = |q: &Quality| q.clone().measured_for(Basis::of(&load(Some(&q.name))));
    let qualities: Vec<Quality> = load(None).qualities.iter().map(stamp).collect();
    let stamped = fill_qualities(&text, &qualities).unwrap();
    (text, stamped)
}

/// Where a pipeline or its stages changed and the measurement still holds (the golden's bits are
/// the same, or it was made anew):
/// `UPDATE_QUALITIES=1 cargo test --release -p toile-tests --test whole qualities::the_shipped`.
#[test]
fn the_shipped_qualities_were_measured_for_their_pipelines() {
    for name in PIPELINES {
        let (text, stamped) = stamped(name);
        if std::env::var_os("UPDATE_QUALITIES").is_some() {
            fs::write(pipeline(name), &stamped).unwrap();
        } else {
            assert_eq!(
                text, stamped,
                "{name}: its qualities were measured for another pipeline; see the head of this test"
            );
        }
    }
}

#[test]
fn an_edit_of_a_shipped_pipeline_voids_its_claims() {
    let valid = |set: &[&str]| toile(&[&["validate", &pipeline("vest.ron")], set].concat());
    let plain = valid(&[]);
    assert!(
        plain.out.ends_with(", qualities Draft (2 mm), Standard (1 mm), Fine (0.7 mm)\n"),
        "{}",
        plain.out
    );
    for set in [
        "fabric=Preset(name: \"denim\", hysteresis: true)",
        "stages.GridMesher.edge=\"30 mm\"",
        "stages.GridMesher=DelaunayMesher(edge: \"16 mm\")",
        "photos.front.width=\"53 cm\"",
    ] {
        let edited = valid(&["--set", set]);
        assert!(
            edited.out.contains("Draft (2 mm, measured for another pipeline), Standard (1 mm, measured "),
            "{set}: {}",
            edited.out
        );
    }
    for set in ["name=\"mine\"", "stages.PhotoTexturer.shading=Keep"] {
        assert_eq!(valid(&["--set", set]).out, plain.out, "{set}");
    }
}

/// Measured anew, one takes its own place; a tuned file, which is another, has none.
fn again(dir: &Path, from: &str) {
    let own = dir.join("napkin-tuned.ron").display().to_string();
    let same = ["--from", from, "--starts", "1"];
    let one = ["--quality", "Mid=12 cm", "--out", &own];
    let answer = on(dir, "tune", "napkin-tuned.ron", &[&same[..], &one].concat());
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    let valid = on(dir, "validate", "napkin-tuned.ron", &[]);
    assert!(valid.out.ends_with("qualities Rough (20 cm), Mid (12 cm)\n"), "{}", valid.out);
    let tuned = dir.join("other.ron").display().to_string();
    let answer = on(
        dir,
        "tune",
        "napkin-tuned.ron",
        &[&same[..], &["--max-error", "20 cm", "--out", &tuned]].concat(),
    );
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    assert!(!fs::read_to_string(&tuned).unwrap().contains("qualities"));
}

#[test]
fn what_is_asked_for_is_checked_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    napkin::write(dir).unwrap();
    let tune = |more: &[&str]| on(dir, "tune", "napkin.ron", more);
    let twice = tune(&["--quality", "A=1 mm", "--quality", "A=2 mm"]);
    assert_eq!((twice.code, twice.err.as_str()), (2, "error: the quality `A` is given twice\n"));
    let form = tune(&["--quality", "Draft"]);
    assert!(
        form.err.contains("`Draft` is no quality; write NAME=LENGTH, like `Draft=10 mm`"),
        "{}",
        form.err
    );
    assert_eq!(tune(&["--quality", "A=1 mm", "--max-error", "1 mm"]).code, 2);
    let none = on(dir, "run", "napkin.ron", &["--quality", "Draft"]);
    assert_eq!(none.code, 3);
    assert!(
        none.err.contains("the pipeline has no quality `Draft`")
            && none.err.contains("it has none; `toile tune"),
        "{}",
        none.err
    );
}

#[test]
fn a_setting_that_does_not_fit_is_a_fault_of_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    napkin::write(dir).unwrap();
    let wrong = "    qualities: [Quality(name: \"A\", max_error: \"1 mm\", set: [\"stages.StaticEquilibrium.sped=1\"])],\n    stages";
    fs::write(dir.join("napkin.ron"), PIPELINE.replacen("    stages", wrong, 1)).unwrap();
    let answer = on(dir, "validate", "napkin.ron", &["--json"]);
    let faults: Value = serde_json::from_str(&answer.out).unwrap();
    let fault = &faults["faults"][0];
    assert_eq!((answer.code, &fault["line"], &fault["column"]), (3, &5.into(), &61.into()));
    assert_eq!(
        fault["message"],
        "quality `A`: `stages.StaticEquilibrium.sped`: `StaticEquilibrium` has no parameter `sped`"
    );
    assert_eq!(fault["hint"], "did you mean `stages.StaticEquilibrium.speed`?");
}
