//! `toile golden`: keeps text sheets of measures, and pictures, for every edge of a pipeline.
//!
//! The golden of `pipelines/vest.ron` is `pipelines/goldens/vest.txt` with its pictures in
//! `pipelines/goldens/vest/`.

use crate::args::{AcceptArgs, CheckArgs, Overrides};
use crate::failing::fail_run;
use crate::run::run_quietly;
use crate::validate::{checked, open};
use crate::{Streams, exit, terminal::interrupt, terminal::stdin};
use std::path::{Path, PathBuf};
use toile_core::RunLog;
use toile_core::artifact::OutputFile;
use toile_core::{Artifact, Registry, read_file, read_text};
use toile_pipeline::golden::{Arithmetic, Comparison, GoldenSheet, compare, parse};
use toile_pipeline::{Pipeline, RunError, write_files};
use toile_stages::engine::arithmetic;
use toile_stages::render::{ArtifactPicture, PictureForm, pictures_of};

/// The longest golden sheet, bytes.
const LONGEST: u64 = 64 << 20;

/// The places of a pipeline's golden.
struct GoldenPlaces {
    folder: PathBuf,
    stem: String,
}

impl GoldenPlaces {
    fn of(pipeline: &Path) -> Self {
        let folder = pipeline.parent().unwrap_or(Path::new(".")).join("goldens");
        let stem = pipeline.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        GoldenPlaces { folder, stem }
    }

    fn sheet(&self) -> PathBuf {
        self.folder.join(format!("{}.txt", self.stem))
    }
}

/// Runs every pipeline and names the first stage that differs from its golden.
pub(crate) fn check(args: &CheckArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    each(&args.pipelines, &args.overrides, registry, streams, |pipeline, path, streams| {
        let places = GoldenPlaces::of(path);
        let golden = match read(&places.sheet()) {
            Ok(Some(golden)) => golden,
            Ok(None) if args.allow_missing => {
                streams.say(format!("{}: skipped, it has no golden yet", path.display()));
                return Ok(exit::DONE);
            }
            Ok(None) => {
                let path = path.display();
                streams.tell(format!("error: {path}: it has no golden"));
                streams.tell(format!(
                    "  help: `toile golden accept {path}` records one, `--allow-missing` goes on without"
                ));
                return Ok(exit::INVALID);
            }
            Err(e) => {
                streams.tell(format!("error: {e}"));
                return Ok(exit::INVALID);
            }
        };
        let golden = known(golden, path, &args.overrides, registry);
        let log = run_quietly(pipeline, &interrupt::on_ctrl_c(), streams)?.log;
        let now = GoldenSheet::against(&golden, &log, &arithmetic()).made_by(pipeline);
        let found = compare(&golden, &now);
        Ok(report(path, &found, &log, &places, &args.out, streams))
    })
}

/// The golden with what it was made by: where it does not say, by the file as it stands, without
/// what the command line changes.
fn known(golden: GoldenSheet, path: &Path, overrides: &Overrides, registry: &Registry) -> GoldenSheet {
    let is_changed = !overrides.set.is_empty() || overrides.quality.is_some();
    if !golden.stages.is_empty() || !is_changed {
        return golden;
    }
    match open(path, &Overrides::default(), registry) {
        Ok(as_it_stands) => golden.made_by(&as_it_stands),
        Err(_) => golden,
    }
}

/// The golden in a file; none where there is no such file.
///
/// Errors: it cannot be read, or a line of it is wrong.
fn read(sheet: &Path) -> Result<Option<GoldenSheet>, String> {
    let unread = |why: String| format!("cannot read the golden \"{}\": {why}", sheet.display());
    match std::fs::metadata(sheet) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Ok(meta) if meta.len() > LONGEST => return Err(unread("it is longer than 64 MB".into())),
        _ => {}
    }
    let text = read_text(sheet).map_err(|e| unread(e.to_string()))?;
    parse(&text).map(Some).map_err(|e| format!("{}: {e}", sheet.display()))
}

/// Records new goldens, each from two equal runs.
pub(crate) fn accept(args: &AcceptArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    each(&args.pipelines, &Overrides::default(), registry, streams, |pipeline, path, streams| {
        let places = GoldenPlaces::of(path);
        let (log, sheet) = match twice(pipeline, streams)? {
            Ok(recorded) => recorded,
            Err(why) => {
                streams.tell(format!("error: {}: {why}; no golden is recorded", path.display()));
                return Ok(exit::QUALITY);
            }
        };
        let head = format!("# Golden of {}. Accept a new one with `toile golden accept`.\n\n", pipeline.name);
        let text = OutputFile {
            path: format!("{}.txt", places.stem),
            bytes: (head + &sheet.to_string()).into_bytes(),
        };
        let mut files = pictures(&log, &sheet, None, &places.stem);
        files.push(text);
        match write_files(&places.folder, &files) {
            Ok(_) => {
                streams.say(format!("{}: {} artifacts recorded", path.display(), sheet.sections.len()));
                Ok(exit::DONE)
            }
            Err(e) => {
                streams.tell(format!("error: {e}"));
                Ok(exit::INVALID)
            }
        }
    })
}

/// The record and the sheet of two equal runs, or why there is none that a later run could be held
/// against.
fn twice(
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> Result<Result<(RunLog, GoldenSheet), String>, RunError> {
    let arithmetic = arithmetic();
    let first = run_quietly(pipeline, &interrupt::on_ctrl_c(), streams)?.log;
    let second = run_quietly(pipeline, &interrupt::on_ctrl_c(), streams)?.log;
    let sheet = |log: &RunLog| GoldenSheet::of(log, &arithmetic).made_by(pipeline);
    let (sheet, again) = (sheet(&first), sheet(&second));
    if sheet != again {
        let stage = compare(&sheet, &again);
        let name = stage.first_stage().or(stage.moved.first().map(String::as_str)).unwrap_or("?");
        return Ok(Err(format!("two runs differ, first at {name}")));
    }
    if let Some((section, measure)) = sheet.endless() {
        return Ok(Err(format!("{section}: its {measure} is no finite number")));
    }
    Ok(match parse(&sheet.to_string()) {
        Ok(_) => Ok((first, sheet)),
        Err(e) => Err(format!("its sheet could not be read back: {e}")),
    })
}

/// Opens every pipeline and keeps the worst exit code.
fn each(
    pipelines: &[PathBuf],
    overrides: &Overrides,
    registry: &Registry,
    streams: &mut Streams<'_>,
    work: impl Fn(&Pipeline, &Path, &mut Streams<'_>) -> Result<u8, RunError>,
) -> u8 {
    let mut worst = exit::DONE;
    for path in pipelines {
        if let Err(e) = stdin::refused(path, "has no goldens beside it") {
            worst = worst.max(streams.refuse(false, e));
            continue;
        }
        let code = match checked(path, overrides, registry) {
            Ok(pipeline) => match work(&pipeline, path, streams) {
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

/// What may have moved bits, a line each.
fn cause(found: &Comparison) -> Vec<String> {
    let by_machine = match found.arithmetic {
        Arithmetic::Same if !found.changes.is_empty() => None,
        Arithmetic::Same => {
            Some("by other code, or other input: the golden was recorded with this machine's arithmetic")
        }
        Arithmetic::Other => Some(
            "the golden was recorded with other arithmetic: another processor or C library, or other code",
        ),
        Arithmetic::Unknown => Some("the golden does not say with which arithmetic it was recorded"),
    };
    let by_user = found.changes.iter().map(|change| format!("otherwise than when it was recorded: {change}"));
    by_user.chain(by_machine.map(str::to_owned)).collect()
}

fn report(
    path: &Path,
    found: &Comparison,
    log: &RunLog,
    places: &GoldenPlaces,
    out: &Path,
    streams: &mut Streams<'_>,
) -> u8 {
    for title in &found.moved {
        streams.say(format!("{}: {title}: bits moved within tolerance", path.display()));
    }
    let Some(first) = found.first_stage() else {
        if !found.moved.is_empty() {
            cause(found).iter().for_each(|line| streams.say(format!("{}: {line}", path.display())));
        }
        streams.say(format!("{}: agrees with its golden", path.display()));
        return exit::DONE;
    };
    streams.tell(format!("{}: first stage that differs: {first}", path.display()));
    for d in &found.differences {
        streams.tell(format!("  {}: {}", d.section, d.message));
    }
    if let (Arithmetic::Same, Some(from)) = (found.arithmetic, &found.moves_from) {
        streams.tell(format!("  bits move from {from} on"));
    }
    cause(found).iter().for_each(|line| streams.tell(format!("  {line}")));
    let files = both_pictures(found, log, places);
    match write_files(out, &files) {
        Ok(_) => streams.tell(format!("  pictures of both in {}", out.join(&places.stem).display())),
        Err(e) => streams.tell(format!("  no pictures: {e}")),
    }
    exit::QUALITY
}

/// The golden's picture and today's for every artifact that differs.
fn both_pictures(found: &Comparison, log: &RunLog, places: &GoldenPlaces) -> Vec<OutputFile> {
    let differing: Vec<&str> = found.differences.iter().map(|d| d.section.as_str()).collect();
    let mut files = pictures(log, &GoldenSheet::of(log, ""), Some(&differing), &places.stem);
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
fn pictures(log: &RunLog, sheet: &GoldenSheet, only: Option<&[&str]>, stem: &str) -> Vec<OutputFile> {
    let made = log.stages.iter().flat_map(|r| &r.outputs).flat_map(|v| v.entries());
    let drawn = made.filter(|(_, a)| a.kind().0 != "files");
    let chosen = sheet
        .sections
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
    let file = |(i, picture): (usize, ArtifactPicture)| {
        let (extension, bytes) = match picture.form {
            PictureForm::Png(bytes) => ("png", bytes),
            PictureForm::Jpeg(bytes) => ("jpg", bytes),
            PictureForm::Svg(text) => ("svg", text.into_bytes()),
        };
        OutputFile { path: format!("{stem}/{}.{i}.{extension}", title.replace(' ', ".")), bytes }
    };
    pictures_of(artifact, None, PICTURE_HEIGHT).into_iter().enumerate().map(file).collect()
}
