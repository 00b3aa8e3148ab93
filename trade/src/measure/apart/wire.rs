//! What goes into a run's process and what comes out of it.

use crate::measure::{Missed, Ran};
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;
use toile_core::artifact::stored::{decode, encode};
use toile_core::{Artifact, ArtifactType, ErrorCode, Length, StageError};
use toile_pipeline::Pipeline;

/// A run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Task {
    /// The pipeline's text with all overrides in it.
    pub(crate) text: String,
    /// Its name, for messages.
    pub(crate) file: String,
    /// The folder that its paths are relative to.
    pub(crate) base: PathBuf,
    /// The stage that ends it.
    pub(crate) until: Option<String>,
    /// Stages that run though nothing asks for them.
    pub(crate) also: Vec<String>,
    /// Move of the start: metres as the bits of a number, and seed.
    pub(crate) moved: Option<(u64, u64)>,
    /// Folder of a cache.
    pub(crate) cache: Option<PathBuf>,
    /// Threads.
    pub(crate) threads: usize,
    /// Longest time; the parent keeps it.
    #[serde(skip)]
    pub(crate) limit: Option<Duration>,
}

impl Task {
    /// A run of a loaded pipeline, with as many threads as there are here.
    pub(crate) fn of(pipeline: &Pipeline) -> Self {
        Task {
            text: pipeline.text.clone(),
            file: pipeline.file.clone(),
            base: pipeline.base.clone(),
            threads: rayon::current_num_threads(),
            ..Task::default()
        }
    }

    /// From a moved start. The amount goes as it is, bit by bit.
    pub(crate) fn moved(self, (amount, seed): (Length, u64)) -> Self {
        Task { moved: Some((amount.metres().to_bits(), seed)), ..self }
    }

    /// The move of its start.
    pub(super) fn moved_by(&self) -> Option<(Length, u64)> {
        self.moved.map(|(bits, seed)| (Length::m(f64::from_bits(bits)), seed))
    }
}

/// The first line of an answer.
#[derive(Debug, Serialize, Deserialize)]
enum AnswerHeader {
    /// It ran; the artifacts follow, each with its kind and its number of bytes.
    Ran { figures: RunFigures, parts: Vec<(String, usize)> },
    /// A stage failed.
    Failed { code: String, message: String, hint: Option<String> },
}

/// What a run gives beside its artifacts.
#[derive(Debug, Serialize, Deserialize)]
struct RunFigures {
    stages_s: BTreeMap<String, f64>,
    wall_s: f64,
    cpu_s: f64,
    peak_memory_bytes: Option<u64>,
    reads: BTreeMap<String, Option<String>>,
}

/// An answer as bytes.
///
/// Errors: a sentence on what cannot be written; nothing of this crate's own.
pub(super) fn write(ran: Result<Ran, Missed>) -> Result<Vec<u8>, String> {
    let (head, bytes) = match ran {
        Ok(ran) => {
            let (parts, bytes) = parts(&ran)?;
            (AnswerHeader::Ran { figures: figures(ran), parts }, bytes)
        }
        Err(missed) => {
            let StageError { code, message, hint, .. } = missed.into();
            (AnswerHeader::Failed { code: code.to_string(), message, hint }, Vec::new())
        }
    };
    let mut out = serde_json::to_vec(&head).map_err(|e| e.to_string())?;
    out.push(b'\n');
    out.extend(bytes);
    Ok(out)
}

fn figures(ran: Ran) -> RunFigures {
    let Ran { stages_s, wall_s, cpu_s, peak_memory_bytes, reads, .. } = ran;
    RunFigures { stages_s, wall_s, cpu_s, peak_memory_bytes, reads }
}

type AnswerParts = (Vec<(String, usize)>, Vec<u8>);

fn parts(ran: &Ran) -> Result<AnswerParts, String> {
    let body = ran.body.as_ref().map(|b| b as &dyn Artifact);
    let model = ran.model.as_ref().map(|m| m as &dyn Artifact);
    let figures = ran.figures.as_ref().map(|f| f as &dyn Artifact);
    let all = [Some(&ran.garment as &dyn Artifact), body, model, figures];
    let (mut parts, mut bytes) = (Vec::new(), Vec::new());
    for artifact in all.into_iter().flatten() {
        let stored = encode(artifact).ok_or_else(|| format!("a {} has no record", artifact.kind()))?;
        parts.push((artifact.kind().0.to_owned(), stored.len()));
        bytes.extend(stored);
    }
    Ok((parts, bytes))
}

/// An answer from its bytes.
///
/// Errors: the run failed; the bytes are no answer, which is a fault of the program's own.
pub(super) fn read(bytes: &[u8]) -> Result<Ran, Missed> {
    let broken =
        |why: &str| Missed::Failed(StageError::internal(format!("a run's own process answers with {why}")));
    let end = bytes.iter().position(|b| *b == b'\n').ok_or_else(|| broken("no whole line"))?;
    match serde_json::from_slice(&bytes[..end]).map_err(|e| broken(&e.to_string()))? {
        AnswerHeader::Failed { code, message, hint } => {
            let code = ErrorCode::ALL.into_iter().find(|c| c.as_str() == code);
            let e = StageError::new(code.unwrap_or(ErrorCode::Internal), message);
            Err(Missed::Failed(StageError { hint, ..e }))
        }
        AnswerHeader::Ran { figures, parts } => {
            let artifacts = Artifacts::read(&parts, &bytes[end + 1..]);
            artifacts.and_then(|artifacts| artifacts.ran(figures)).map_err(|why| broken(&why))
        }
    }
}

/// The bytes of each artifact by its kind.
struct Artifacts<'a>(BTreeMap<&'a str, &'a [u8]>);

impl<'a> Artifacts<'a> {
    fn read(parts: &'a [(String, usize)], mut bytes: &'a [u8]) -> Result<Self, String> {
        let mut found = BTreeMap::new();
        for (kind, count) in parts {
            let (own, rest) = bytes.split_at_checked(*count).ok_or("an artifact cut short")?;
            found.insert(kind.as_str(), own);
            bytes = rest;
        }
        Ok(Artifacts(found))
    }

    /// The artifact of a type; none where the run made none.
    fn one<T: ArtifactType + Clone>(&self) -> Result<Option<T>, String> {
        let Some(bytes) = self.0.get(T::KIND.0) else { return Ok(None) };
        let artifact =
            decode(T::KIND, bytes).map_err(|why| format!("a {} that is unsound: {why}", T::KIND))?;
        let any: &dyn Any = artifact.as_ref();
        Ok(any.downcast_ref::<T>().cloned())
    }

    fn ran(&self, figures: RunFigures) -> Result<Ran, String> {
        let RunFigures { stages_s, wall_s, cpu_s, peak_memory_bytes, reads } = figures;
        let garment = self.one()?.ok_or("no garment")?;
        let (body, model, figures) = (self.one()?, self.one()?, self.one()?);
        Ok(Ran { garment, body, model, figures, stages_s, wall_s, cpu_s, peak_memory_bytes, reads })
    }
}
