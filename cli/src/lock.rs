//! `toile lock` and `toile run --locked`: what a pipeline was made of, kept beside it as
//! `PIPELINE.lock`.

use crate::args::{LockArgs, Overrides};
use crate::failing::fail_run;
use crate::validate::open;
use crate::{Streams, cache, exit, terminal::interrupt, terminal::stdin, terminal::threads};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_core::artifact::OutputFile;
use toile_core::{Listener, Registry};
use toile_pipeline::cache::Cache;
use toile_pipeline::lock::Lock;
use toile_pipeline::{Pipeline, RunOptions, RunResult, faults, run as run_stages, write_files};

/// Runs every pipeline and writes its lock.
pub(crate) fn lock(args: &LockArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let codes = args.pipelines.iter().map(|path| one(path, args, registry, streams));
    codes.max().unwrap_or(exit::DONE)
}

fn one(path: &Path, args: &LockArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    if let Err(e) = stdin::refused(path, "has no place for a lock beside it") {
        return streams.refuse(false, e);
    }
    let pipeline = match open(path, &Overrides::default(), registry) {
        Ok(pipeline) => pipeline,
        Err(faults) => {
            streams.fault(&faults);
            return exit::INVALID;
        }
    };
    if let Err(faults) = faults(&pipeline, |_| true, None) {
        streams.fault(&faults);
        return exit::INVALID;
    }
    let cache = cache::chosen(&args.cache, streams).unwrap_or_else(|| Arc::new(Cache::nowhere()));
    let options = RunOptions { cache: Some(cache.clone()), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let pool = threads::pool(None, streams);
    let outcome =
        threads::in_pool(pool, || run_stages(&pipeline, &options, &interrupt::on_ctrl_c(), &listener));
    for warning in cache.take_warnings() {
        streams.warn(warning);
    }
    match outcome {
        Err(e) => fail_run(&pipeline, &e, false, streams),
        Ok(result) => write(path, &Lock::of(&pipeline, registry, &result), streams),
    }
}

fn write(pipeline: &Path, lock: &Lock, streams: &mut Streams<'_>) -> u8 {
    let path = beside(pipeline);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    match write_files(folder, &[OutputFile { path: name, bytes: lock.to_text().into_bytes() }]) {
        Ok(_) => {
            streams.say(format!("{}: {} stages locked", path.display(), lock.stages.len()));
            exit::DONE
        }
        Err(e) => {
            streams.tell(format!("error: {e}"));
            exit::INVALID
        }
    }
}

/// The lock's place: `vest.ron.lock` beside `vest.ron`.
fn beside(pipeline: &Path) -> PathBuf {
    let mut name = pipeline.as_os_str().to_owned();
    name.push(".lock");
    PathBuf::from(name)
}

/// The lock of a pipeline that is to be run against it.
///
/// Errors: one sentence for the user.
pub(crate) fn read(pipeline: &Path) -> Result<Lock, String> {
    let path = beside(pipeline);
    let name = path.display();
    let text = toile_core::read_text(&path).map_err(|e| {
        format!("cannot read the lock \"{name}\": {e}; `toile lock {}` writes one", pipeline.display())
    })?;
    Lock::from_text(&text).map_err(|e| format!("cannot use the lock \"{name}\": {e}"))
}

/// Says what differs from the lock; the exit code is that of a result that is not as it should be.
pub(crate) fn compare(
    lock: &Lock,
    pipeline: &Pipeline,
    registry: &Registry,
    run: &RunResult,
    streams: &mut Streams<'_>,
) -> u8 {
    let differences = lock.differences(&Lock::held_against(pipeline, registry, run));
    for line in &differences {
        streams.tell(format!("lock: {line}"));
    }
    if differences.is_empty() { exit::DONE } else { exit::QUALITY }
}
