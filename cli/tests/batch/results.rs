//! What a batch gives, what it does again and what not.

use super::{batch, content, line, ran, results, set, toile, write_scene};
use serde_json::{Value, json};
use std::fs;

#[test]
fn a_garment_is_a_folder_a_line_and_a_place_on_the_contact_sheet() {
    let dir = set(3);
    let (code, out, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!(code, Some(0), "{err}");
    let page = dir.path().join("out/index.html");
    assert_eq!(out, format!("3 garments: 3 good\n{}\n", page.display()));
    assert!(err.starts_with("3 garments: 3 to run, 0 done or not asked for\n"), "{err}");
    let lines = results(dir.path(), "out");
    let first = &lines["g0"];
    assert_eq!(
        (&first["exit"], &first["fault"], &first["certificate"]["verdict"]),
        (&json!(0), &Value::Null, &json!("holds"))
    );
    assert_eq!(first["quality"]["garment"]["triangles"], 2);
    assert_eq!(first["inputs"].as_str().unwrap().len(), 64);
    assert!(first["version"].as_str().unwrap().starts_with(env!("CARGO_PKG_VERSION")));
    assert_ne!(first["result"], lines["g1"]["result"], "each garment has a scene of its own");
    for file in ["result.obj", "metrics.json", "certificate.json", "record.json"] {
        assert!(dir.path().join("out/garments/g2").join(file).is_file(), "{file}");
    }
    let html = fs::read_to_string(page).unwrap();
    assert!(html.contains("<h1>3 garments: 3 good</h1>") && html.contains("href=\"garments/g2/\""), "{html}");
    let costs = fs::read_to_string(dir.path().join("out/costs.jsonl")).unwrap();
    let cost: Value = serde_json::from_str(costs.lines().next().unwrap()).unwrap();
    assert!(cost["seconds"].as_f64().unwrap() > 0.0 && cost["bytes"].as_u64().unwrap() > 100, "{cost}");
}

#[test]
fn a_garment_is_what_toile_run_gives() {
    let dir = set(1);
    assert_eq!(ran(batch(dir.path(), "out", &[])).0, Some(0));
    let run = ["run", "sheet.ron", "--set", "scene.file=in/s0.json", "--out", "alone", "--no-cache"];
    assert_eq!(ran(toile(dir.path(), &run)).0, Some(0));
    let obj = |folder: &str| fs::read(dir.path().join(folder).join("result.obj")).unwrap();
    assert_eq!(obj("out/garments/g0"), obj("alone"));
}

#[test]
fn what_is_done_is_known_by_the_content_of_its_inputs() {
    let dir = set(3);
    let again = |more: &[&str]| {
        let (code, out, err) = ran(batch(dir.path(), "out", more));
        assert_eq!(code, Some(0), "{out}{err}");
        err.lines().next().unwrap_or_default().to_owned()
    };
    again(&[]);
    let whole = content(dir.path(), "out");
    assert_eq!(again(&[]), "3 garments: 0 to run, 3 done or not asked for");
    // The same content, written anew.
    write_scene(dir.path(), 1, 0.01 + 1e-4);
    assert_eq!(again(&[]), "3 garments: 0 to run, 3 done or not asked for");
    // Another content under the same name.
    write_scene(dir.path(), 1, 0.02);
    assert_eq!(again(&[]), "3 garments: 1 to run, 2 done or not asked for");
    assert_ne!(content(dir.path(), "out"), whole);
    write_scene(dir.path(), 1, 0.01 + 1e-4);
    assert_eq!(again(&[]), "3 garments: 1 to run, 2 done or not asked for");
    assert_eq!(content(dir.path(), "out"), whole);
    // A value of all garments, and one of the pipeline.
    assert_eq!(
        again(&["--set", "stages.StaticEquilibrium.speed=0.02"]),
        "3 garments: 3 to run, 0 done or not asked for"
    );
    // A garment that is asked for is run, done or not.
    assert_eq!(
        again(&["--only", "g2", "--set", "stages.StaticEquilibrium.speed=0.02"]),
        "3 garments: 1 to run, 2 done or not asked for"
    );
    let check = ran(batch(dir.path(), "out", &["--check"]));
    assert_eq!(check, (Some(0), "3 garments: 3 to run, 0 done or not asked for\n".into(), String::new()));
}

#[test]
fn only_files_that_are_named_are_kept() {
    let dir = set(1);
    assert_eq!(ran(batch(dir.path(), "out", &["--keep", "*.obj"])).0, Some(0));
    let entries = fs::read_dir(dir.path().join("out/garments/g0")).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["record.json", "result.obj"]);
    assert_eq!(results(dir.path(), "out")["g0"]["certificate"]["verdict"], "holds");
}

#[test]
fn shares_give_the_bits_of_the_whole() {
    let dir = set(15);
    assert_eq!(ran(batch(dir.path(), "whole", &["--jobs", "1"])).0, Some(0));
    let whole = content(dir.path(), "whole");
    assert_eq!(whole.keys().filter(|name| name.ends_with("result.obj")).count(), 15);
    for count in [2, 7] {
        let out = format!("shares{count}");
        let shares: Vec<_> = (1..=count)
            .map(|number| {
                batch(dir.path(), &out, &["--shard", &format!("{number}/{count}"), "--jobs", "3"])
                    .spawn()
                    .unwrap()
            })
            .collect();
        for share in shares {
            assert_eq!(share.wait_with_output().unwrap().status.code(), Some(0));
        }
        assert!(content(dir.path(), &out) == whole, "{count} shares");
    }
    assert_eq!(ran(batch(dir.path(), "wrong", &["--shard", "3/2"])).0, Some(2));
}

#[test]
fn the_answer_is_one_object_for_programs() {
    let dir = set(2);
    let (code, out, _) = ran(batch(dir.path(), "out", &["--json"]));
    let told: Value = serde_json::from_str(&out).unwrap();
    let folder = dir.path().join("out").display().to_string();
    assert_eq!(code, Some(0));
    let all = json!({ "garments": 2, "good": 2, "faults": {}, "left": 0 });
    let mut whole = all.clone();
    (whole["share"], whole["stopped"], whole["folder"]) = (all, false.into(), folder.into());
    assert_eq!(told, whole);
}

#[test]
fn a_share_answers_for_its_own_garments() {
    let dir = set(3);
    fs::write(dir.path().join("in/s1.json"), "{").unwrap();
    assert_eq!(ran(batch(dir.path(), "out", &["--shard", "2/3"])).0, Some(4));
    let (code, out, _) = ran(batch(dir.path(), "out", &["--shard", "1/3"]));
    assert_eq!(code, Some(0), "the fault is of another share");
    let told: Vec<&str> = out.lines().take(2).collect();
    assert_eq!(
        told,
        ["share 1/3, 1 garment: 1 good", "3 garments: 1 good, 1 pattern_loading, 1 not run yet"]
    );
    let (_, out, _) = ran(batch(dir.path(), "out", &["--shard", "1/3", "--json"]));
    let told: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(told["share"], json!({ "garments": 1, "good": 1, "faults": {}, "left": 0 }));
    assert_eq!(told["faults"], json!({ "pattern_loading": 1 }));
}

#[test]
fn a_garment_may_be_added_to_a_manifest() {
    let dir = set(3);
    fs::write(dir.path().join("in/manifest.jsonl"), [0, 1].map(line).concat()).unwrap();
    assert_eq!(ran(batch(dir.path(), "out", &[])).0, Some(0));
    fs::write(dir.path().join("in/manifest.jsonl"), [2, 1, 0].map(line).concat()).unwrap();
    let (_, _, err) = ran(batch(dir.path(), "out", &[]));
    assert!(err.starts_with("3 garments: 1 to run, 2 done"), "{err}");
    let text = fs::read_to_string(dir.path().join("out/results.jsonl")).unwrap();
    let ids: Vec<&str> = text.lines().map(|l| l.split('"').nth(3).unwrap()).collect();
    assert_eq!(ids, ["g2", "g1", "g0"], "in the manifest's order");
}
