//! Manifests: written by `toile manifest`, refused by line.

use super::{batch, line, ran, results, set, toile};
use std::fs;

#[test]
fn files_and_tables_make_a_manifest() {
    let dir = set(3);
    let (code, out, err) = ran(toile(
        dir.path(),
        &["manifest", "in/s?.json", "--field", "scene.file", "--out", "in/manifest.jsonl"],
    ));
    assert_eq!((code, out.as_str(), err.as_str()), (Some(0), "in/manifest.jsonl: 3 garments\n", ""));
    let text = fs::read_to_string(dir.path().join("in/manifest.jsonl")).unwrap();
    assert_eq!(text.lines().next(), Some(r#"{"id":"s0","set":{"scene.file":"s0.json"}}"#));
    assert_eq!(ran(batch(dir.path(), "out", &[])).0, Some(0));
    assert_eq!(results(dir.path(), "out").into_keys().collect::<Vec<_>>(), ["s0", "s1", "s2"]);
    let table = "id,scene.file,stages.StaticEquilibrium.speed\na,in/s0.json,0.02\nb,in/s1.json,\n";
    fs::write(dir.path().join("table.csv"), table).unwrap();
    let (code, out, _) = ran(toile(dir.path(), &["manifest", "table.csv"]));
    let lines = [
        r#"{"id":"a","set":{"scene.file":"in/s0.json","stages.StaticEquilibrium.speed":"0.02"}}"#,
        r#"{"id":"b","set":{"scene.file":"in/s1.json"}}"#,
    ];
    assert_eq!((code, out), (Some(0), lines.map(|l| format!("{l}\n")).concat()));
    let words = "error: say with --field which value each file is, like `--field pattern.file`; one CSV table needs none\n";
    assert_eq!(ran(toile(dir.path(), &["manifest", "in/s0.json"])), (Some(2), String::new(), words.into()));
    let none = ["manifest", "no*.json", "--field", "scene.file"];
    assert_eq!(
        ran(toile(dir.path(), &none)),
        (Some(3), String::new(), "error: there is no file \"no*.json\"\n".into())
    );
}

#[test]
fn a_manifest_with_faults_is_refused_by_line_and_nothing_is_run() {
    let dir = set(2);
    let text = [line(0), "{\"id\"\n".into(), line(1), line(0), line(9)].concat();
    fs::write(dir.path().join("in/manifest.jsonl"), text).unwrap();
    let (code, out, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!((code, out.as_str()), (Some(3), ""));
    let told: Vec<&str> = err.lines().collect();
    assert_eq!(
        told,
        [
            "error: \"in/manifest.jsonl\", line 2: EOF while parsing an object in column 5; a garment is written {\"id\": \"shirt1\", \"set\": {\"pattern.file\": \"a.json\"}}",
            "error: \"in/manifest.jsonl\", line 4: the id \"g0\" stands in line 1, too",
            "error: \"in/manifest.jsonl\", line 5: there is no file \"s9.json\" (\"scene.file\") beside the manifest or the pipeline",
            "  help: nothing was run; mend these lines, or leave them out with --skip-faulty",
        ]
    );
    assert!(!dir.path().join("out").exists());
    // The others can be run, and the exit code says that some were not.
    let (code, _, err) = ran(batch(dir.path(), "out", &["--skip-faulty"]));
    assert_eq!(code, Some(3), "{err}");
    assert_eq!(results(dir.path(), "out").into_keys().collect::<Vec<_>>(), ["g0", "g1"]);
    let (code, out, _) = ran(batch(dir.path(), "out", &["--json"]));
    let told: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, told["faults"][1]["line"].as_u64()), (Some(3), Some(4)));
}
