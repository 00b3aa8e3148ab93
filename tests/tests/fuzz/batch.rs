//! Manifests of batches, and tables that manifests are made of.

use crate::{fuzz, spoil};
use toile_tests::{Answer, napkin, toile};

/// Whether what is refused is told by line.
fn is_answered(answer: &Answer) -> Result<(), String> {
    match answer.code {
        0 => Ok(()),
        3 if answer.err.contains("line ") => Ok(()),
        code => Err(format!("exit code {code}: {}", answer.err)),
    }
}

#[test]
fn manifests() {
    let dir = tempfile::tempdir().unwrap();
    napkin::write(dir.path()).unwrap();
    let path = |name: &str| dir.path().join(name).display().to_string();
    let (manifest, pipeline, out) = (path("m.jsonl"), path("napkin.ron"), path("out"));
    let check = |bytes: &[u8]| {
        std::fs::write(&manifest, bytes).unwrap();
        toile(&["batch", &manifest, "--pipeline", &pipeline, "--out", &out, "--check"])
    };
    let two = "{\"id\": \"a\", \"set\": {\"scene.file\": \"napkin.json\"}}\n{\"id\": \"b-2\"}\n";
    let values = "{\"id\": \"c\", \"set\": {\"stages.StaticEquilibrium.speed\": 0.02, \"name\": \"\\\"x\\\"\", \"a.b\": [\"x\", \"y\"], \"c\": true, \"d\": \"6 mm\"}}\n";
    let seeds = [two, values].map(|text| text.as_bytes().to_vec());
    assert_eq!([0, 1].map(|k| check(&seeds[k]).code), [0, 0]);
    fuzz("manifest", 1000, |dice| spoil::text(&seeds, dice), |bytes| is_answered(&check(bytes)));
}

#[test]
fn tables() {
    let dir = tempfile::tempdir().unwrap();
    napkin::write(dir.path()).unwrap();
    let table = dir.path().join("t.csv").display().to_string();
    let make = |bytes: &[u8]| {
        std::fs::write(&table, bytes).unwrap();
        toile(&["manifest", &table])
    };
    let seeds = [
        b"id,scene.file,name\na,napkin.json,\"\"\"x, y\"\"\"\nb,,6 mm\n".to_vec(),
        b"scene.file,id\r\nnapkin.json,a\r\n\r\nnapkin.json,b\r\n".to_vec(),
    ];
    assert_eq!([0, 1].map(|k| make(&seeds[k]).code), [0, 0]);
    let hold = |bytes: &[u8]| {
        let answer = make(bytes);
        match std::str::from_utf8(bytes) {
            // It is refused as a whole.
            Err(_) if answer.code == 3 => Ok(()),
            _ => is_answered(&answer),
        }
    };
    fuzz("table", 1000, |dice| spoil::text(&seeds, dice), hold);
}
