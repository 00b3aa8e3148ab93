//! What a watcher is told while a run goes on.

use super::bench::{Bench, STAGES};
use crate::{RunOptions, RunWatch, WatchedStage, run};
use std::sync::{Arc, Mutex};
use toile_core::artifact::{ArtifactType, Kind, OutputFiles, Photo};
use toile_core::{Cancel, Listener, PortValue};

/// Notes a line a stage.
#[derive(Debug)]
struct Notes {
    kinds: Vec<Kind>,
    lines: Mutex<Vec<String>>,
}

impl RunWatch for Notes {
    fn kinds(&self) -> &[Kind] {
        &self.kinds
    }

    fn done(&self, stage: &WatchedStage<'_>) {
        let shown = |value: &PortValue| match value {
            PortValue::One(a) => a.kind().to_string(),
            PortValue::Set(kind, set) => format!("{} {kind}s", set.len()),
        };
        let outputs: Vec<String> = stage.outputs.iter().map(shown).collect();
        let cached = if stage.cached { " cached" } else { "" };
        let (figures, warnings) = (stage.figures.len(), stage.remarks.warnings.len());
        let skipped = stage.skipped.map_or_else(String::new, |why| format!(" skipped: {why}"));
        let line = format!(
            "{} {}: {}, {figures} figures, {warnings} warnings{cached}{skipped}",
            stage.index,
            stage.id,
            outputs.join(" ")
        );
        self.lines.lock().unwrap().push(line);
    }
}

fn watched(bench: &Bench, kinds: &[Kind], until: Option<&str>) -> Vec<String> {
    let notes = Arc::new(Notes { kinds: kinds.to_vec(), lines: Mutex::default() });
    let watch: Arc<dyn RunWatch> = notes.clone();
    let options = RunOptions {
        cache: Some(bench.cache()),
        watch: Some(watch),
        until: until.map(str::to_owned),
        ..RunOptions::default()
    };
    let listener: Arc<dyn Listener> = Arc::new(());
    run(&bench.pipeline(&[]), &options, &Cancel::new(), &listener).unwrap();
    std::mem::take(&mut *notes.lines.lock().unwrap())
}

#[test]
fn every_stage_is_told_of_with_what_it_made_though_it_comes_from_the_cache() {
    let bench = Bench::new("watch", STAGES);
    let made = [
        "0 Bytes2: 2 photos, 0 figures, 0 warnings",
        "1 Modulo: 2 photos, 2 figures, 2 warnings",
        "2 Levels: files, 0 figures, 0 warnings",
        "3 Log: files, 0 figures, 0 warnings",
    ];
    assert_eq!(watched(&bench, &[Photo::KIND], None), made);
    let again = made.map(|line| format!("{line} cached"));
    assert_eq!(watched(&bench, &[Photo::KIND, OutputFiles::KIND], None), again);
    let bare = watched(&bench, &[], None);
    assert_eq!(bare[0], "0 Bytes2: , 0 figures, 0 warnings cached", "nothing needed to be read");
    let until = watched(&bench, &[Photo::KIND], Some("Modulo"));
    assert_eq!(until[2], "2 Levels: , 0 figures, 0 warnings skipped: not needed until Modulo");
}
