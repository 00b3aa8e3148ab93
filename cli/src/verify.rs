//! `toile verify`: whether a finished garment is sound, from its files alone.

use crate::args::VerifyArgs;
use crate::{Streams, exit};
use std::path::Path;
use toile_core::StageError;
use toile_core::artifact::OutputFile;
use toile_pipeline::write_files;
use toile_verify::CheckLimits;
use toile_verify::files::{AskedFiles, certify};

/// The certificate's name beside a garment.
const FILE: &str = "certificate.json";

/// Judges a garment; exit code 4 where a check fails, 3 where a file cannot be read.
pub(crate) fn verify(args: &VerifyArgs, streams: &mut Streams<'_>) -> u8 {
    match certified(args) {
        Err(e) => refused(args.json, &e, streams),
        Ok((holds, lines)) => {
            lines.into_iter().for_each(|line| streams.say(line));
            if holds { exit::DONE } else { exit::QUALITY }
        }
    }
}

fn refused(json: bool, e: &StageError, streams: &mut Streams<'_>) -> u8 {
    match (json, &e.hint) {
        (true, _) => {
            streams.say(serde_json::json!({ "error": e.code.as_str(), "message": e.message, "hint": e.hint }))
        }
        (false, hint) => {
            streams.tell(format!("error: {}", e.message));
            hint.iter().for_each(|hint| streams.tell(format!("  help: {hint}")));
        }
    }
    exit::INVALID
}

/// Whether the garment holds, and what is said of it; the certificate is written.
fn certified(args: &VerifyArgs) -> Result<(bool, Vec<String>), StageError> {
    let mut limits = CheckLimits { tight: f64::from(args.max_tight) / 100.0, ..CheckLimits::default() };
    if let Some(gap) = args.max_gap {
        limits.gap = gap.metres();
    }
    let asked = AskedFiles {
        garment: args.garment.clone(),
        pattern: args.pattern.clone(),
        seams: args.seams.clone(),
        body: args.body.clone(),
        compare: args.compare.clone(),
        unit: args.unit.map(|u| u.metres()),
        limits,
    };
    let (certificate, folder) = certify(&asked)?;
    let text = serde_json::to_string_pretty(&certificate)
        .map_err(|e| StageError::internal(format!("the certificate cannot be written: {e}")))?;
    let path = args.out.clone().unwrap_or_else(|| folder.join(FILE));
    write(&path, &text)?;
    let lines = match args.json {
        true => vec![text],
        false => {
            certificate.words().into_iter().chain([format!("certificate: {}", path.display())]).collect()
        }
    };
    Ok((certificate.holds(), lines))
}

/// Writes the certificate, beside its place and renamed.
fn write(path: &Path, text: &str) -> Result<(), StageError> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    write_files(folder, &[OutputFile::new(name, format!("{text}\n").into_bytes())])?;
    Ok(())
}
