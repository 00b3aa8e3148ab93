//! docs/guide/writing-a-stage.md explains this crate: every block that names a file is part of that
//! file, and the blocks together are all of it.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// Blocks by the file that stands behind their language.
fn blocks(page: &str) -> BTreeMap<String, Vec<String>> {
    let mut blocks: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for part in page.split("\n```").skip(1) {
        let (head, body) = part.split_once('\n').unwrap_or((part, ""));
        if let Some((_, file)) = head.split_once(' ') {
            blocks.entry(file.to_owned()).or_default().push(body.to_owned());
        }
    }
    blocks
}

#[test]
fn the_page_is_the_crate() {
    let page = std::fs::read_to_string(root().join("docs/guide/writing-a-stage.md")).unwrap();
    let blocks = blocks(&page);
    let files = ["Cargo.toml", "src/lib.rs", "tests/dust.rs", "benches/dust.rs"];
    let names: Vec<String> = files.iter().map(|f| format!("plugins/tutorial/{f}")).collect();
    assert!(names.iter().all(|n| blocks.contains_key(n)), "{:?}", blocks.keys());
    for (file, parts) in &blocks {
        let text = std::fs::read_to_string(root().join(file)).unwrap();
        let mut rest = text.as_str();
        for part in parts {
            let at = rest.find(part.trim_end()).unwrap_or(usize::MAX);
            assert!(at != usize::MAX, "{file} does not hold, in this order:\n{part}");
            let skipped = rest[..at].trim();
            let told = skipped.is_empty() || file.ends_with("Cargo.toml");
            assert!(told, "the page leaves out of {file}:\n{skipped}");
            rest = &rest[at + part.trim_end().len()..];
        }
        let told = rest.trim().is_empty() || file.ends_with("Cargo.toml");
        assert!(told, "the page leaves out of {file}:\n{}", rest.trim());
    }
}
