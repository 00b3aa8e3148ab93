//! `toile golden`: keeps text sheets of measures, and pictures, for every edge of a pipeline.
//!
//! The golden of `pipelines/vest.ron` is `pipelines/goldens/vest.txt` with its pictures in
//! `pipelines/goldens/vest/`.

use crate::args::{GoldenArgs, Overrides};
use crate::run::{fail_run, run_quietly};
use crate::validate::open;
use crate::{Streams, exit, interrupt, stdin};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use toile_core::artifact::{OutputFile, RunLog};
use toile_core::golden::{Comparison, Sheet, compare, parse};
use toile_core::pipeline::Pipeline;
use toile_core::{Artifact, Registry, read_file, read_text, write_files};
use toile_stages::render::{Form, Picture, pictures_of};

/// The places of a pipeline's golden.
struct Places {
    folder: PathBuf,
    stem: String,
}

impl Places {
    fn of(pipeline: &Path) -> Self {
        let folder = pipeline.parent().unwrap_or(Path::new(".")).join("goldens");
        let stem = pipeline.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        Places { folder, stem }
    }

    fn sheet(&self) -> PathBuf {
        self.folder.join(format!("{}.txt", self.stem))
    }
}

/// Runs every pipeline and names the first stage that differs from its golden.
pub(crate) fn check(args: &GoldenArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    each(args, registry, streams, |args, pipeline, path, streams| {
        let places = Places::of(path);
        let text = match read_text(&places.sheet()) {
            Ok(text) => text,
            Err(e) if e.kind() == ErrorKind::NotFound => {
                streams.say(format!("{}: skipped, it has no golden yet", path.display()));
                return Ok(exit::DONE);
            }
            Err(e) => {
                streams.tell(format!("error: cannot read the golden \"{}\": {e}", places.sheet().display()));
                return Ok(exit::INVALID);
            }
        };
        let golden = match parse(&text) {
            Ok(golden) => golden,
            Err(e) => {
                streams.tell(format!("error: {}: {e}", places.sheet().display()));
                return Ok(exit::INVALID);
            }
        };
        let log = run_quietly(pipeline, &interrupt::on_ctrl_c(), streams)?.log;
        let found = compare(&golden, &Sheet::of(&log));
        Ok(report(path, &found, &log, &places, &args.out, streams))
    })
}

/// Records new goldens, each from two equal runs.
pub(crate) fn accept(args: &GoldenArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    each(args, registry, streams, |_, pipeline, path, streams| {
        let first = run_quietly(pipeline, &interrupt::on_ctrl_c(), streams)?.log;
        let second = run_quietly(pipeline, &interrupt::on_ctrl_c(), streams)?.log;
        let (sheet, again) = (Sheet::of(&first), Sheet::of(&second));
        if sheet != again {
            let stage = compare(&sheet, &again);
            let name =
                stage.first_stage().or(stage.moved.first().map(String::as_str)).unwrap_or("?").to_owned();
            streams.tell(format!(
                "error: {}: two runs differ, first at {name}; no golden is recorded",
                path.display()
            ));
            return Ok(exit::QUALITY);
        }
        let places = Places::of(path);
        let head = format!("# Golden of {}. Accept a new one with `toile golden accept`.\n\n", pipeline.name);
        let text = OutputFile {
            path: format!("{}.txt", places.stem),
            bytes: (head + &sheet.to_string()).into_bytes(),
        };
        let mut files = pictures(&first, &sheet, None, &places.stem);
        files.push(text);
        match write_files(&places.folder, &files) {
            Ok(_) => {
                streams.say(format!("{}: {} artifacts recorded", path.display(), sheet.0.len()));
                Ok(exit::DONE)
            }
            Err(e) => {
                streams.tell(format!("error: {e}"));
                Ok(exit::INVALID)
            }
        }
    })
}

/// Opens every pipeline and keeps the worst exit code.
fn each(
    args: &GoldenArgs,
    registry: &Registry,
    streams: &mut Streams<'_>,
    work: impl Fn(&GoldenArgs, &Pipeline, &Path, &mut Streams<'_>) -> Result<u8, toile_core::RunError>,
) -> u8 {
    let mut worst = exit::DONE;
    for path in &args.pipelines {
        if let Err(e) = stdin::refused(path, "has no goldens beside it") {
            worst = worst.max(streams.refuse(false, e));
            continue;
        }
        let code = match open(path, &Overrides::default(), registry) {
            Ok(pipeline) => match work(args, &pipeline, path, streams) {
                Ok(code) => code,
                Err(e) => fail_run(&pipeline, &e, false, streams),
            },
            Err(faults) => {
                streams.fault(&faults);
                exit::INVALID
            }
        };
        worst = worst.max(code);
    }
    worst
}

fn report(
    path: &Path,
    found: &Comparison,
    log: &RunLog,
    places: &Places,
    out: &Path,
    streams: &mut Streams<'_>,
) -> u8 {
    for title in &found.moved {
        streams.say(format!("{}: {title}: bits moved within tolerance", path.display()));
    }
    let Some(first) = found.first_stage() else {
        streams.say(format!("{}: agrees with its golden", path.display()));
        return exit::DONE;
    };
    streams.tell(format!("{}: first stage that differs: {first}", path.display()));
    for d in &found.differences {
        streams.tell(format!("  {}: {}", d.section, d.message));
    }
    let files = both_pictures(found, log, places);
    match write_files(out, &files) {
        Ok(_) => streams.tell(format!("  pictures of both in {}", out.join(&places.stem).display())),
        Err(e) => streams.tell(format!("  no pictures: {e}")),
    }
    exit::QUALITY
}

/// The golden's picture and today's for every artifact that differs.
fn both_pictures(found: &Comparison, log: &RunLog, places: &Places) -> Vec<OutputFile> {
    let differing: Vec<&str> = found.differences.iter().map(|d| d.section.as_str()).collect();
    let mut files = pictures(log, &Sheet::of(log), Some(&differing), &places.stem);
    let was: Vec<OutputFile> = files
        .iter()
        .filter_map(|f| {
            let bytes = read_file(&places.folder.join(&f.path)).ok()?;
            let (stem, extension) = f.path.rsplit_once('.')?;
            Some(OutputFile { path: format!("{stem}.golden.{extension}"), bytes })
        })
        .collect();
    files.extend(was);
    files
}

/// Pictures of a run's artifacts by section title, all or only those named.
fn pictures(log: &RunLog, sheet: &Sheet, only: Option<&[&str]>, stem: &str) -> Vec<OutputFile> {
    let made = log.stages.iter().flat_map(|r| &r.outputs).flat_map(|v| v.entries());
    let drawn = made.filter(|(_, a)| a.kind().0 != "files");
    let chosen = sheet
        .0
        .iter()
        .zip(drawn)
        .filter(|(section, _)| only.is_none_or(|names| names.contains(&section.title().as_str())));
    chosen
        .flat_map(|(section, (_, artifact))| artifact_pictures(stem, &section.title(), artifact.as_ref()))
        .collect()
}

/// Height of a golden's pictures, px: enough to see a fold, small enough to keep in the repository.
const PICTURE_HEIGHT: u32 = 240;

/// Every picture of one artifact as a file named after its section.
fn artifact_pictures(stem: &str, title: &str, artifact: &dyn Artifact) -> Vec<OutputFile> {
    let file = |(i, picture): (usize, Picture)| {
        let (extension, bytes) = match picture.form {
            Form::Png(bytes) => ("png", bytes),
            Form::Jpeg(bytes) => ("jpg", bytes),
            Form::Svg(text) => ("svg", text.into_bytes()),
        };
        OutputFile { path: format!("{stem}/{}.{i}.{extension}", title.replace(' ', ".")), bytes }
    };
    pictures_of(artifact, None, PICTURE_HEIGHT).into_iter().enumerate().map(file).collect()
}
