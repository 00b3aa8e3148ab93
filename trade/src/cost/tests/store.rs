//! The store of records, sound and damaged.

use super::kit::*;
use crate::cost::*;
use proptest::prelude::*;
use std::path::Path;

fn host() -> HostMachine {
    HostMachine { cpu: "A processor".into(), cores: 2 }
}

fn written(text: &str) -> (tempfile::TempDir, Opened) {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("costs.jsonl"), text).unwrap();
    let opened = CostStore::new(dir.path()).open(&host());
    (dir, opened)
}

fn warned(text: &str, words: &str) {
    let (dir, opened) = written(text);
    let path = dir.path().join("costs.jsonl");
    let all = format!("what earlier runs took, \"{}\", {words}", path.display());
    assert_eq!(opened, Opened { records: Vec::new(), warning: Some(all) });
}

fn text_of(host: HostMachine, version: &str) -> String {
    let collection = Collection { host, toile: version.into(), ..Collection::here(runs("a", 3, 0.1)) };
    collection.to_text()
}

#[test]
fn a_store_that_is_of_no_use_is_said_to_be() {
    let version = env!("CARGO_PKG_VERSION");
    let other = HostMachine { cpu: "Another".into(), cores: 64 };
    warned("", "is damaged; the shipped figures stand in");
    warned("nonsense\n{}", "is damaged; the shipped figures stand in");
    warned(
        &text_of(other, version),
        "is of another machine (Another, 64 cores); the shipped figures stand in",
    );
    warned(&text_of(host(), "0.0.1"), "was kept by version 0.0.1; the shipped figures stand in");
    let newer = text_of(host(), version).replace("\"scheme\":2", "\"scheme\":3");
    warned(&newer, "was kept by another version; the shipped figures stand in");
    assert_eq!(CostStore::new(Path::new("/nowhere/at/all")).open(&host()), Opened::default());
}

#[test]
fn a_damaged_line_of_the_store_loses_itself_alone() {
    let text = text_of(host(), env!("CARGO_PKG_VERSION")).replacen("{\"pipeline\"", "{\"pipe", 1);
    let (dir, opened) = written(&text);
    assert_eq!(opened.records, runs("a", 3, 0.1)[1..]);
    let path = dir.path().join("costs.jsonl");
    let words = format!("what earlier runs took, \"{}\", has 1 damaged line, left out", path.display());
    assert_eq!(opened.warning, Some(words));
}

#[test]
fn the_store_keeps_the_latest_runs_and_no_more() {
    let dir = tempfile::tempdir().unwrap();
    let store = CostStore::new(&dir.path().join("deep"));
    for run in runs("a", 30, 0.1).chunks(10) {
        store.add(&host(), run.to_vec()).unwrap();
    }
    let opened = store.open(&host());
    assert_eq!((opened.records.as_slice(), opened.warning), (&runs("a", 30, 0.1)[6..], None));
    // What another machine left makes place.
    let other = HostMachine { cores: 8, ..host() };
    store.add(&other, runs("b", 1, 0.1)).unwrap();
    assert_eq!(store.open(&other).records, runs("b", 1, 0.1));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}", bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = parse_collection(&text);
        let _ = parse_collection(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn a_spoilt_store_is_read_and_fitted_without_panic(at in 0usize..900, byte in any::<u8>(), cut in 0usize..900) {
        let mut bytes = text_of(host(), env!("CARGO_PKG_VERSION")).into_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(bytes.len().saturating_sub(cut % 300));
        if let Ok(collection) = parse_collection(&String::from_utf8_lossy(&bytes)) {
            let costs = Costs::fit(&collection.records, &[], 2);
            let e = costs.estimate(&place("a", "Otsu", "binariser"), &pixels(1e6), CostFigure::Wall);
            prop_assert!(e.is_none_or(|e| e.value.is_finite() && e.low <= e.value && e.value <= e.high));
        }
    }
}
