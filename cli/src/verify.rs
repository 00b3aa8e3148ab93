//! `toile verify`: whether a finished garment is sound, from its files alone.

use crate::args::VerifyArgs;
use crate::failing::fail_load;
use crate::{Streams, exit};
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::OutputFile;
use toile_core::{Node, Registry, Role, Stage, StageError};
use toile_pipeline::{Faults, Pipeline, load, write_files};
use toile_verify::CheckLimits;
use toile_verify::files::{AskedFiles, ClothStages, certify, reader_words};

/// The certificate's name beside a garment.
const FILE: &str = "certificate.json";

/// Why nothing is judged.
enum Unverified {
    /// The words of the options.
    Options(Box<Faults>),
    /// A file.
    File(StageError),
}

impl From<StageError> for Unverified {
    fn from(e: StageError) -> Self {
        Unverified::File(e)
    }
}

/// Judges a garment; exit code 4 where a check fails, 3 where a file cannot be read.
pub(crate) fn verify(args: &VerifyArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    match certified(args, registry) {
        Err(Unverified::Options(faults)) => fail_load(&faults, args.json, streams),
        Err(Unverified::File(e)) => refused(args.json, &e, streams),
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

/// The stages that read the pattern and say what the garment is made of, as a pipeline: so options
/// pass the checks of one, and `--set` means what it means there.
fn stages(args: &VerifyArgs, registry: &Registry) -> Result<Pipeline, Unverified> {
    let mut fields = Vec::new();
    if let Some(pattern) = &args.pattern {
        fields.push(format!("pattern: {}", reader_words(pattern, args.seams.as_deref())?));
    }
    if let Some(fabric) = &args.fabric {
        let is_stage = fabric.contains('(');
        let words = if is_stage { fabric.clone() } else { format!("Preset(name: {fabric:?})") };
        fields.push(format!("fabric: {words}"));
    }
    let friction = args.friction.map(|f| format!("friction: {f:?}")).unwrap_or_default();
    fields.push(format!("stages: [BvhCollider({friction})]"));
    let text = format!("(\n    {},\n)\n", fields.join(",\n    "));
    let set = crate::at_hand::found(&args.set);
    load(&text, "the options of `toile verify`", Path::new("."), registry, &set)
        .map_err(|faults| Unverified::Options(Box::new(faults)))
}

/// Takes the first stage of a role.
fn take(stages: &mut Vec<Node>, role: Role) -> Option<Arc<dyn Stage>> {
    let at = stages.iter().position(|n| n.card.role == role)?;
    Some(Arc::from(stages.remove(at).stage))
}

/// Whether the garment holds, and what is said of it; the certificate is written.
fn certified(args: &VerifyArgs, registry: &Registry) -> Result<(bool, Vec<String>), Unverified> {
    let mut limits = CheckLimits { tight: f64::from(args.max_tight) / 100.0, ..CheckLimits::default() };
    if let Some(gap) = args.max_gap {
        limits.gap = gap.metres();
    }
    if let Some(shift) = args.max_shift {
        limits.shift = shift.metres();
    }
    let mut stages = stages(args, registry)?.nodes;
    let reader = take(&mut stages, Role::Reader);
    let cloth = take(&mut stages, Role::Fabric)
        .zip(take(&mut stages, Role::Collider))
        .map(|(fabric, collider)| ClothStages { fabric, collider });
    let asked = AskedFiles {
        garment: args.garment.clone(),
        pattern: args.pattern.clone(),
        seams: args.seams.clone(),
        reader,
        cloth,
        body: args.body.clone(),
        compare: args.compare.clone(),
        unit: args.unit.map(|u| u.metres()),
        up: args.up,
        limits,
    };
    let (certificate, folder) = certify(&asked)?;
    let text = serde_json::to_string_pretty(&certificate)
        .map_err(|e| StageError::internal(format!("the certificate cannot be written: {e}")))?;
    let path = args.out.clone().unwrap_or_else(|| folder.join(FILE));
    write_text(&path, &format!("{text}\n"))?;
    let lines = match args.json {
        true => vec![text],
        false => {
            certificate.words().into_iter().chain([format!("certificate: {}", path.display())]).collect()
        }
    };
    Ok((certificate.holds(), lines))
}

/// Writes a file of text, beside its place and renamed.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), StageError> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    write_files(folder, &[OutputFile::new(name, text.as_bytes().to_vec())])?;
    Ok(())
}
