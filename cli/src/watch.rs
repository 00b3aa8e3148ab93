//! `toile run --watch`: runs again on every edit of the pipeline, of a file that it reads or of a plugin.
//!
//! The few files of a pipeline are looked at five times a second: their times and sizes, and where those
//! differ their content. That needs no service of the system, works on every file system (network drives too), and does
//! not lose a file that an editor replaces by another. A change counts once two looks in a row see the same,
//! so that a file half written is not run.

use crate::args::RunArgs;
use crate::run::once;
use crate::{Streams, exit, interrupt};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};
use toile_core::cache::Hash;
use toile_core::pipeline::Pipeline;
use toile_core::{Metrics, Reads, Registry};

/// Time between two looks.
const PAUSE: Duration = Duration::from_millis(200);

/// Runs until Ctrl-C.
pub(crate) fn watch(args: &RunArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let cancel = interrupt::on_ctrl_c();
    loop {
        let reads: Reads = Arc::new(Mutex::new(BTreeSet::from([args.pipeline.clone()])));
        // What changes while the stages run is seen after them: this is how the files were before.
        let started = Instant::now();
        let before = Files::look(&plus_known(&args.pipeline, &reads));
        let code = once(args, registry, Some(&reads), streams);
        interrupt::end_writing();
        if cancel.is_cancelled() {
            return exit::DONE;
        }
        let paths = reads.lock().unwrap_or_else(PoisonError::into_inner).clone();
        streams.tell(format!(
            "{} in {:.2} s; watching {} files, Ctrl-C ends it",
            if code == exit::DONE { "done" } else { "not done" },
            started.elapsed().as_secs_f64(),
            paths.len()
        ));
        let Some(changed) = Files::look(&paths).wait(&before, || cancel.is_cancelled()) else {
            return exit::DONE;
        };
        let names: Vec<String> = changed.iter().map(|p| p.display().to_string()).collect();
        streams.tell(format!("changed: {}", names.join(", ")));
    }
}

/// The pipeline's own file: what it reads is known after its first run.
fn plus_known(pipeline: &Path, reads: &Reads) -> BTreeSet<PathBuf> {
    let mut known = reads.lock().unwrap_or_else(PoisonError::into_inner).clone();
    known.insert(pipeline.to_owned());
    known
}

/// The files that a pipeline names beside those that its stages read: its plugins.
pub(crate) fn plugins(pipeline: &Pipeline, reads: &Reads) {
    let paths = pipeline.plugins.iter().map(|p| pipeline.base.join(&p.file));
    reads.lock().unwrap_or_else(PoisonError::into_inner).extend(paths);
}

/// How many stages ran and how many came from the cache.
pub(crate) fn counts(metrics: &Metrics) -> String {
    let ran = metrics.stages.iter().filter(|s| s.skipped.is_none());
    let (cached, run): (Vec<_>, Vec<_>) = ran.partition(|s| s.cached);
    format!("{} stages run, {} from the cache", run.len(), cached.len())
}

/// What tells one content of a file from another; none of a file that is not there.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Look {
    modified: Option<SystemTime>,
    size: u64,
    content: Option<Hash>,
}

/// The state of some files.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Files(BTreeMap<PathBuf, Option<Look>>);

impl Files {
    fn look(paths: &BTreeSet<PathBuf>) -> Self {
        Files(paths.iter().map(|p| (p.clone(), look(p, None))).collect())
    }

    /// The state now; a file whose time and size are as before is not read again.
    fn again(&self) -> Self {
        Files(self.0.iter().map(|(p, was)| (p.clone(), look(p, was.as_ref()))).collect())
    }

    /// The files whose content is another than in `self`.
    fn changed(&self, now: &Files) -> Vec<PathBuf> {
        let content = |look: &Option<Look>| look.as_ref().and_then(|l| l.content);
        let other =
            |p: &PathBuf, was: &Option<Look>| now.0.get(p).is_some_and(|is| content(is) != content(was));
        self.0.iter().filter(|(p, was)| other(p, was)).map(|(p, _)| p.clone()).collect()
    }

    /// Waits until a content changes and then stays; none once `stopped`. `before` is how some files were when the
    /// run began.
    fn wait(self, before: &Files, stopped: impl Fn() -> bool) -> Option<Vec<PathBuf>> {
        let mut base = self.clone();
        base.0.extend(before.0.clone());
        let mut last = self;
        loop {
            if stopped() {
                return None;
            }
            std::thread::sleep(PAUSE);
            let now = last.again();
            let changed = base.changed(&now);
            if !changed.is_empty() && now == last {
                return Some(changed);
            }
            last = now;
        }
    }
}

fn look(path: &Path, was: Option<&Look>) -> Option<Look> {
    let meta = std::fs::metadata(path).ok()?;
    let (modified, size) = (meta.modified().ok(), meta.len());
    let same = was.filter(|w| w.modified == modified && w.size == size);
    let content = match same {
        Some(was) => was.content,
        None => std::fs::read(path).ok().map(|bytes| Hash::of(&bytes)),
    };
    Some(Look { modified, size, content })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_file_counts_as_changed_by_its_content_alone() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.ron");
        std::fs::write(&path, "one").unwrap();
        let paths = BTreeSet::from([path.clone(), dir.path().join("missing.jpg")]);
        let before = Files::look(&paths);
        std::fs::write(&path, "one").unwrap();
        assert_eq!(before.changed(&before.again()), Vec::<PathBuf>::new());
        // As editors do: a new file takes the place of the old one.
        std::fs::write(dir.path().join("new"), "two").unwrap();
        std::fs::rename(dir.path().join("new"), &path).unwrap();
        assert_eq!(before.changed(&before.again()), [path.clone()]);
        std::fs::write(dir.path().join("missing.jpg"), "here").unwrap();
        assert_eq!(before.changed(&before.again()).len(), 2);
    }
}
