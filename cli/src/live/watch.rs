//! `toile run --watch`: runs again on every edit of the pipeline, of a file that it reads or of a
//! plugin.
//!
//! The few files of a pipeline are looked at five times a second: their times and sizes, and where
//! those differ their content. That needs no service of the system, works on every file system
//! (network drives too), and does not lose a file that an editor replaces by another. A change
//! counts once two looks in a row see the same, so that a file half written is not run.

use crate::args::RunArgs;
use crate::live::reads::{FileLook, look, note};
use crate::run::once;
use crate::{Streams, exit, refused, terminal::interrupt, terminal::stdin, with_plugins};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use toile_core::Registry;
use toile_core::artifact::Digest;
use toile_pipeline::plugin::plugin_files;
use toile_pipeline::{Reads, plugins_asked};

/// Time between two looks.
const PAUSE: Duration = Duration::from_millis(200);

/// Runs until Ctrl-C; `plugins` are those that the command line names.
pub(crate) fn watch(
    args: &RunArgs,
    plugins: &[PathBuf],
    registry: &Registry,
    streams: &mut Streams<'_>,
) -> u8 {
    if let Err(e) = stdin::refused(&args.pipeline, "cannot be watched") {
        return streams.refuse(false, e);
    }
    let cancel = interrupt::on_ctrl_c();
    let mut base = registry.clone();
    // Plugins may be built again while their former versions are loaded.
    base.load_plugins_apart();
    loop {
        let started = Instant::now();
        let reads: Reads = Arc::new(Mutex::new(BTreeMap::new()));
        note_named(&reads, &args.pipeline, plugins);
        let code = match with_plugins(&base, plugins) {
            (registry, true) => once(args, &registry, Some(&reads), streams),
            (registry, false) => refused(&registry, streams),
        };
        interrupt::end_writing();
        if cancel.is_cancelled() {
            return exit::DONE;
        }
        // What was edited while the stages ran has another content than they read.
        let used = reads.lock().unwrap_or_else(PoisonError::into_inner).clone();
        streams.notice(format!(
            "{} in {:.2} s; watching {} files, Ctrl-C ends it",
            if code == exit::DONE { "done" } else { "not done" },
            started.elapsed().as_secs_f64(),
            used.len()
        ));
        let Some(changed) = wait(&used, || cancel.is_cancelled()) else { return exit::DONE };
        let names: Vec<String> = changed.iter().map(|p| p.display().to_string()).collect();
        streams.notice(format!("changed: {}", names.join(", ")));
    }
}

/// Notes the pipeline and the plugins that it and the command line name: they are watched even
/// where one of them cannot be read.
fn note_named(reads: &Reads, pipeline: &Path, plugins: &[PathBuf]) {
    note(reads, pipeline);
    let text = toile_core::read_text(pipeline).unwrap_or_default();
    let folder = pipeline.parent().unwrap_or(Path::new(""));
    let asked = plugins_asked(&text).into_iter().map(|p| folder.join(p.file));
    asked.chain(plugins.iter().cloned()).flat_map(|p| plugin_files(&p)).for_each(|p| note(reads, &p));
}

/// The state of each file now; none for a file that does not exist.
type Looks = BTreeMap<PathBuf, Option<FileLook>>;

/// Waits until the content of a file differs from the one that was used and no longer changes.
/// Returns the changed files; none once `stopped`.
fn wait(used: &BTreeMap<PathBuf, Option<Digest>>, stopped: impl Fn() -> bool) -> Option<Vec<PathBuf>> {
    let mut last: Looks = used.keys().map(|path| (path.clone(), look(path, None))).collect();
    while !stopped() {
        std::thread::sleep(PAUSE);
        let now: Looks = last.iter().map(|(path, was)| (path.clone(), look(path, was.as_ref()))).collect();
        let changed = changed(used, &now);
        if !changed.is_empty() && now == last {
            return Some(changed);
        }
        last = now;
    }
    None
}

/// The files whose content differs from the one that was used.
fn changed(used: &BTreeMap<PathBuf, Option<Digest>>, now: &Looks) -> Vec<PathBuf> {
    let content = |path: &PathBuf| now.get(path).and_then(|look| look.as_ref()?.content);
    used.iter().filter(|(path, was)| content(path) != **was).map(|(path, _)| path.clone()).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_file_counts_as_changed_by_its_content_alone() {
        let dir = tempfile::tempdir().unwrap();
        let (path, missing) = (dir.path().join("a.ron"), dir.path().join("missing.jpg"));
        std::fs::write(&path, "one").unwrap();
        let reads: Reads = Arc::default();
        note(&reads, &path);
        note(&reads, &missing);
        let used = reads.lock().unwrap().clone();
        let now = || changed(&used, &used.keys().map(|p| (p.clone(), look(p, None))).collect());
        std::fs::write(&path, "one").unwrap();
        assert_eq!(now(), Vec::<PathBuf>::new());
        // As editors do: a new file takes the place of the old one.
        std::fs::write(dir.path().join("new"), "two").unwrap();
        std::fs::rename(dir.path().join("new"), &path).unwrap();
        assert_eq!(now(), vec![path.clone()]);
        std::fs::write(&missing, "here").unwrap();
        assert_eq!(now().len(), 2);
        std::fs::remove_file(&missing).unwrap();
        assert_eq!(wait(&used, || false), Some(vec![path]));
        assert_eq!(wait(&used, || true), None);
    }
}
