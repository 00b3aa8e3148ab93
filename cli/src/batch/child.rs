//! A garment's own process, the hidden `toile run-garment`: runs it, judges it, looks at what it
//! gave.

use super::folder::contents;
use super::record::{GarmentFault, ReadFiles, relative};
use super::task::{GarmentAnswer, GarmentTask};
use super::{names, thumb};
use crate::args::{Arguments, CacheChoice, Command, Overrides, RunArgs};
use crate::run::{FAILED, RunEnd};
use crate::terminal::interrupt;
use crate::trading::apart;
use crate::{Streams, exit, run, verify};
use clap::Parser;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, PoisonError};
use std::time::Duration;
use toile_core::{ErrorCode, Registry};
use toile_pipeline::{Override, Reads, write_files};
use toile_trade::measure::peak;

/// The fault of a garment that has run, and whose files do not hold what is asked of them.
const FAILS: &str = "certificate_fails";

/// Runs the garment of this process.
pub(crate) fn run(registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let task = apart::task().and_then(|line| {
        serde_json::from_str::<GarmentTask>(&line).map_err(|e| format!("this is no garment's task: {e}"))
    });
    let answer = task.and_then(|task| answer(&task, registry));
    match answer.and_then(|answer| serde_json::to_string(&answer).map_err(|e| e.to_string())) {
        Ok(line) => {
            streams.say(line);
            exit::DONE
        }
        Err(why) => {
            streams.tell(format!("error: {why}"));
            exit::INVALID
        }
    }
}

fn answer(task: &GarmentTask, registry: &Registry) -> Result<GarmentAnswer, String> {
    // Files that the manifest names are seen from here, as those of a command line are.
    std::env::set_current_dir(&task.folder).map_err(|e| format!("the manifest's folder is gone: {e}"))?;
    let is_late = task.max_time.map(timer).unwrap_or_default();
    let reads = Reads::default();
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let ended = run::ended(
        &arguments(task),
        registry,
        Some(&reads),
        true,
        &mut Streams::new(None, &mut out, &mut err),
    );
    let RunEnd { code, unwritten } = ended;
    let told: Value = serde_json::from_slice(&out).unwrap_or_default();
    let mut answer = GarmentAnswer {
        exit: code,
        fault: fault(&told),
        quality: quality(&told),
        certificate: Value::Null,
        reads: seen(&reads, &task.folder),
        contents: contents(&task.out).map_err(|e| e.to_string())?,
        peak_bytes: None,
        unwritten: unwritten.map(|e| e.to_string()),
        cancelled: false,
    };
    let is_stopped = answer.fault.fault.as_deref() == Some(ErrorCode::Cancelled.as_str());
    match (is_stopped, is_late.load(Ordering::SeqCst), task.max_time) {
        (true, true, Some(limit)) => answer.fault = GarmentFault { stage: answer.fault.stage, ..late(limit) },
        (true, ..) => answer.cancelled = true,
        _ => {}
    }
    let is_made = [exit::DONE, exit::QUALITY].contains(&code) && answer.quality.is_object();
    if is_made && task.verify && task.until.is_none() {
        judge(&task.out, registry, &mut answer);
    }
    if answer.unwritten.is_none() && !answer.cancelled {
        answer.unwritten = finished(task, &answer.fault, &reads, is_made).err();
    }
    answer.contents = contents(&task.out).map_err(|e| e.to_string())?;
    answer.peak_bytes = peak();
    Ok(answer)
}

/// Asks the run to stop after that time; the flag says that it has.
fn timer(limit: Duration) -> Arc<AtomicBool> {
    let (late, flag) = (Arc::new(AtomicBool::new(false)), interrupt::on_ctrl_c());
    let raised = late.clone();
    std::thread::spawn(move || {
        std::thread::sleep(limit);
        raised.store(true, Ordering::SeqCst);
        flag.cancel();
    });
    late
}

/// The fault of a garment that has reached its time.
pub(crate) fn late(limit: Duration) -> GarmentFault {
    let seconds = limit.as_secs_f64();
    GarmentFault::new(
        ErrorCode::Timeout.as_str(),
        format!("it was stopped after {seconds} s, the limit of --max-time"),
    )
    .hint("give it more with --max-time, and run it again with --retry-only timeout")
}

fn arguments(task: &GarmentTask) -> RunArgs {
    let set = task.set.iter().map(|(path, value)| Override { path: path.clone(), value: value.clone() });
    RunArgs {
        pipeline: task.pipeline.clone(),
        out: Some(task.out.clone()),
        until: task.until.clone(),
        also: Vec::new(),
        keep: false,
        overrides: Overrides { quality: task.quality.clone(), set: set.collect() },
        threads: Some(task.threads),
        json: true,
        watch: false,
        locked: false,
        verbose: false,
        cache: CacheChoice { no_cache: task.cache_dir.is_none(), cache_dir: task.cache_dir.clone() },
    }
}

/// What `toile run --json` says of a fault; none where all is well.
fn fault(told: &Value) -> GarmentFault {
    let text = |value: &Value| value.as_str().filter(|t| !t.is_empty()).map(str::to_owned);
    let first = &told["faults"][0];
    let missed = &told["shortfalls"][0];
    if told["error"].is_string() {
        GarmentFault {
            fault: text(&told["error"]),
            stage: text(&told["stage"]),
            message: text(&told["message"]),
            hint: text(&told["hint"]),
        }
    } else if first.is_object() {
        GarmentFault {
            fault: text(&first["code"]),
            stage: None,
            message: text(&first["message"]),
            hint: text(&first["hint"]),
        }
    } else if missed.is_array() {
        GarmentFault { fault: text(&missed[0]), message: text(&missed[1]), ..GarmentFault::default() }
    } else {
        GarmentFault::default()
    }
}

/// What the metrics say of the garment, without what differs from run to run.
fn quality(told: &Value) -> Value {
    if !told["stages"].is_array() {
        return Value::Null;
    }
    let mut garment = told["garment"].clone();
    if let Some(figures) = garment.as_object_mut() {
        figures.remove("threads");
        figures.remove("peak_memory_bytes");
    }
    json!({ "name": told["quality"], "garment": garment, "shortfalls": told["shortfalls"] })
}

/// The files that were read, as they are seen from the manifest's folder.
fn seen(reads: &Reads, folder: &Path) -> ReadFiles {
    let reads = reads.lock().unwrap_or_else(PoisonError::into_inner);
    let full = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    reads
        .iter()
        .map(|(path, content)| (relative(&full(path), folder).display().to_string(), *content))
        .collect()
}

/// Judges the garment from its files; a pipeline that writes no garment is not judged.
fn judge(folder: &Path, registry: &Registry, answer: &mut GarmentAnswer) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    if std::env::set_current_dir(folder).is_err() {
        return;
    }
    // As a user asks for it without any option; `.` is how the certificate names its files.
    let asked = Arguments::try_parse_from(["toile", "verify", ".", "--json"]);
    let Ok(Arguments { command: Command::Verify(asked), .. }) = asked else { return };
    let code = verify::verify(&asked, registry, &mut Streams::new(None, &mut out, &mut err));
    let told: Value = serde_json::from_slice(&out).unwrap_or_default();
    if !told["verdict"].is_string() {
        answer.certificate = json!({ "verdict": null, "not_judged": told["message"] });
        return;
    }
    let checks = told["checks"].as_array().cloned().unwrap_or_default();
    let failing: Vec<&Value> = checks.iter().filter(|c| c["verdict"] == "fails").collect();
    answer.certificate = json!({ "verdict": told["verdict"], "fails": failing });
    if code == exit::QUALITY && answer.fault.fault.is_none() {
        let names: Vec<&str> = failing.iter().filter_map(|c| c["name"].as_str()).collect();
        answer.exit = exit::QUALITY;
        answer.fault =
            GarmentFault::new(FAILS, format!("`toile verify` finds fault with {}", names.join(", ")));
    }
}

/// Leaves the files that are to be kept, a small picture, and where the garment failed the reason.
///
/// Errors: a file cannot be written or removed.
fn finished(task: &GarmentTask, fault: &GarmentFault, reads: &Reads, is_made: bool) -> Result<(), String> {
    let photos: Vec<PathBuf> = {
        let reads = reads.lock().unwrap_or_else(PoisonError::into_inner);
        reads.iter().filter(|(_, content)| content.is_some()).map(|(path, _)| path.clone()).collect()
    };
    if let Some(file) = thumb::of(&task.out, &photos) {
        write_files(&task.out, &[file]).map_err(|e| e.to_string())?;
    }
    if !is_made {
        return leave_reason(&task.out, fault);
    }
    match task.keep.is_empty() {
        true => Ok(()),
        false => keep_only(&task.out, &task.keep).map_err(|e| format!("cannot remove what is not kept: {e}")),
    }
}

/// Writes why a garment failed beside what it had made.
///
/// Errors: a sentence.
pub(crate) fn leave_reason(folder: &Path, fault: &GarmentFault) -> Result<(), String> {
    let lines = [(&fault.message, ""), (&fault.hint, "help: ")];
    let text: String =
        lines.iter().filter_map(|(text, head)| Some(format!("{head}{}\n", text.as_ref()?))).collect();
    let path = folder.join(FAILED).join("reason.txt");
    // What a stage says goes further; a run that was stopped says less than why it was.
    if path.is_file() && fault.fault.as_deref() != Some(ErrorCode::Timeout.as_str()) {
        return Ok(());
    }
    verify::write_text(&path, &text).map_err(|e| e.to_string())
}

/// Removes files of other names from a garment's folder.
fn keep_only(folder: &Path, keep: &[String]) -> std::io::Result<()> {
    let is_kept =
        |name: &str| name == thumb::FILE || keep.iter().any(|pattern| names::matches(pattern, name));
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        match (is_kept(&entry.file_name().to_string_lossy()), entry.file_type()?.is_dir()) {
            (true, _) => {}
            (false, true) => std::fs::remove_dir_all(entry.path())?,
            (false, false) => std::fs::remove_file(entry.path())?,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn faults_are_told_by_their_kind() {
        let told = json!({ "error": "stitching_error", "stage": "Sew", "message": "a seam stays open", "hint": "sew it" });
        let stage = Some("Sew".to_owned());
        assert_eq!(
            fault(&told),
            GarmentFault {
                stage,
                ..GarmentFault::new("stitching_error", "a seam stays open").hint("sew it")
            }
        );
        let told =
            json!({ "valid": false, "faults": [{ "code": "unknown_stage", "message": "no such" }, {}] });
        assert_eq!(fault(&told), GarmentFault::new("unknown_stage", "no such"));
        let told = json!({ "stages": [], "shortfalls": [["static_equilibrium", "it moves"]] });
        assert_eq!(fault(&told), GarmentFault::new("static_equilibrium", "it moves"));
        assert_eq!(fault(&json!({ "stages": [], "shortfalls": [] })), GarmentFault::default());
    }

    #[test]
    fn figures_of_the_machine_are_left_out() {
        let garment = json!({ "steps": 3, "threads": 2, "peak_memory_bytes": 5 });
        let told =
            json!({ "stages": [], "quality": "Draft", "garment": garment, "shortfalls": [], "wall_s": 1.0 });
        let wanted = json!({ "name": "Draft", "garment": { "steps": 3 }, "shortfalls": [] });
        assert_eq!(quality(&told), wanted);
        assert_eq!(quality(&json!({ "error": "timeout" })), Value::Null);
    }

    #[test]
    fn only_files_that_are_named_are_kept() {
        let dir = tempfile::tempdir().unwrap();
        for name in ["garment.glb", "front.png", "back.png", "report.html", thumb::FILE] {
            std::fs::write(dir.path().join(name), "").unwrap();
        }
        std::fs::create_dir(dir.path().join("stages")).unwrap();
        keep_only(dir.path(), &["garment.glb".into(), "f*.png".into()]).unwrap();
        let mut names: Vec<_> = std::fs::read_dir(dir.path())
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(names, ["front.png", "garment.glb", thumb::FILE]);
    }
}
