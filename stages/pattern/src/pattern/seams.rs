//! What readers of patterns without seams have in common: seams from a file or as proposals, then
//! outlines and a sewing plan.

use super::faults::refused;
use super::{follow, propose, sidecar};
use std::sync::Arc;
use toile_core::Remarks;
use toile_core::artifact::Artifact;
use toile_core::prelude::*;

/// What such a reader gives.
pub(super) type Read = (Pattern, Set<Outline>, SewingPlan, OutputFiles);

/// The pattern of these pieces with the seams of that file; where none is named, proposals as a
/// file.
///
/// Errors: those of the file of seams, all at once; else what is wrong with the pattern and its
/// remedy, as `unsewable` words them.
pub(super) fn sewn(
    (name, pieces): (String, Vec<Piece>),
    seams: &str,
    mut told: Remarks,
    unsewable: impl Fn(String, &str) -> StageError,
    cx: &Context,
) -> Result<Read, StageError> {
    let mut pattern = Pattern { name, pieces, seams: Vec::new() };
    let proposals = match seams.is_empty() {
        true => proposed(&pattern, &mut told),
        false => {
            let bytes = cx.read(seams).map_err(|e| e.at("seams"))?;
            pattern.seams = sidecar::read(&bytes, &pattern.pieces).map_err(|all| refused(seams, all))?;
            let broken = follow::broken(&pattern.pieces, &pattern.seams);
            if !broken.is_empty() {
                return Err(refused(seams, broken));
            }
            told.warnings.extend(follow::inside_out(&pattern.pieces, &pattern.seams));
            OutputFiles::default()
        }
    };
    super::tell(told, cx);
    pattern.check().map_err(|what| unsewable(what, "draw the piece again"))?;
    cx.check()?;
    let lowered = pattern.lower().map_err(|e| unsewable(e.to_string(), e.remedy()))?;
    super::tell(Remarks { notes: lowered.notes, warnings: lowered.warnings }, cx);
    let outlines = lowered.outlines.into_iter().map(|(name, o)| (name, Arc::new(o))).collect();
    Ok((pattern, Set(outlines), lowered.plan, proposals))
}

/// The file of proposed seams, with a warning that says how to use it.
fn proposed(pattern: &Pattern, told: &mut Remarks) -> OutputFiles {
    let seams = propose::proposed_seams(&pattern.pieces);
    told.warnings.push(match seams.len() {
        0 => "no seams are given, and none can be proposed: nothing is sewn. Write them into a file and give it as `seams`"
            .to_owned(),
        n => format!(
            "no seams are given, and nothing is sewn: {n} are proposed in seams.ron; look through it and give it as `seams`"
        ),
    });
    match seams.is_empty() {
        true => OutputFiles::default(),
        false => OutputFiles::one("seams.ron", sidecar::seams_file(&seams).into_bytes()),
    }
}

/// Whether the files are there; `named` is whether a file is named at all.
pub(super) fn looked(
    named: Result<(), StageError>,
    file: &str,
    seams: &str,
    placed: &Placed<'_>,
) -> Vec<StageError> {
    let pattern = named.and_then(|()| placed.cx.look(file)).map_err(|e| e.at("file"));
    let seams = match seams.is_empty() {
        true => Ok(()),
        false => placed.cx.look(seams).map_err(|e| e.at("seams")),
    };
    pattern.err().into_iter().chain(seams.err()).collect()
}
