//! What `toile tune` starts from and what it writes.

use crate::Streams;
use crate::args::TuneArgs;
use crate::terminal::interrupt;
use crate::trading::measuring::default_folder;
use crate::trading::study::{StudyRequest, measured};
use std::path::{Path, PathBuf};
use toile_core::StageError;
use toile_core::artifact::OutputFile;
use toile_pipeline::{Pipeline, write_files};
use toile_trade::knobs::source::Source;
use toile_trade::record::Trade;
use toile_trade::tune::check;

/// The measured front: read where a folder is named, else measured now.
pub(crate) fn front(
    args: &TuneArgs,
    source: &Source<'_>,
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> Result<(Trade, PathBuf), StageError> {
    if let Some(folder) = &args.from {
        let path = folder.join("trade.json");
        let refuse = |why: String| {
            StageError::invalid(format!("cannot read \"{}\": {why}", path.display()))
                .hint("--from is the folder of a `toile trade`")
        };
        let text = toile_core::read_text(&path).map_err(|e| refuse(e.to_string()))?;
        let trade: Trade = serde_json::from_str(&text).map_err(|e| refuse(e.to_string()))?;
        check(&trade, pipeline)?;
        return Ok((trade, folder.clone()));
    }
    let out = default_folder(&args.pipeline, None, "trade");
    let asked = StudyRequest {
        knobs: &args.knobs,
        out: out.clone(),
        until: None,
        points: None,
        starts: 3,
        study: &args.study,
    };
    measured(&asked, source, pipeline, streams).map(|trade| (trade, out))
}

/// The file to write, which must lie beside the pipeline: its paths are relative to its folder.
pub(crate) fn target(args: &TuneArgs) -> Result<PathBuf, StageError> {
    let stem = args.pipeline.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let file = args.out.clone().unwrap_or_else(|| args.pipeline.with_file_name(format!("{stem}-tuned.ron")));
    let folder = |path: &Path| match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new(".").canonicalize(),
        Some(parent) => parent.canonicalize(),
        None => Path::new(".").canonicalize(),
    };
    match (folder(&file), folder(&args.pipeline)) {
        (Ok(a), Ok(b)) if a == b => Ok(file),
        _ => Err(StageError::invalid(format!("\"{}\" is not in the folder of the pipeline", file.display()))
            .hint("paths in the pipeline are relative to its folder: write the tuned one beside it")),
    }
}

pub(crate) fn write(file: &Path, text: String) -> Result<(), StageError> {
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let path = file.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    interrupt::begin_writing();
    let written = write_files(folder, &[OutputFile { path, bytes: text.into_bytes() }]);
    interrupt::end_writing();
    written.map(|_| ())
}
