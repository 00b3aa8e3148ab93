//! Object stores: the batch works in a local folder as ever, and what lies in a store is fetched
//! before and sent after.
//!
//! ```text
//! store --inputs--> work/inputs --batch--> work/garments/ID --sender--> store
//! store --records--> which garments are done
//! ```
//!
//! `place` is how a command line names a store; `client` a bucket by the crate `object_store`, and
//! `without` what stands for it in a program that has none; `version` the state of a file there.

#[cfg(feature = "object-store")]
mod client;
mod inputs;
mod place;
mod results;
mod sender;
mod version;
#[cfg(not(feature = "object-store"))]
mod without;

#[cfg(feature = "object-store")]
use client::Bucket;
#[cfg(not(feature = "object-store"))]
use without::NoBucket as Bucket;

use super::manifest::GarmentLine;
use super::record::{GarmentRecord, ReadFiles};
use crate::args::BatchArgs;
use crate::at_hand;
use crate::terminal::stdin;
use inputs::StoredInputs;
use place::StorePlace;
use results::StoredResults;
use std::path::{Path, PathBuf};
use toile_core::{Cancel, StageError};

/// How often the results of all are written anew where other shares write them at the same time.
const MOST_ROUNDS: usize = 50;

/// What of a batch lies in a store; nothing of one that has paths of this machine alone.
#[derive(Default)]
pub(crate) struct Mirror {
    inputs: Option<StoredInputs>,
    results: Option<StoredResults>,
}

impl Mirror {
    /// Opens the stores that the arguments name and fetches the manifest. Gives the arguments with
    /// paths of this machine in their place.
    ///
    /// Errors: an argument is no place; the program has no stores; the store refuses; what is asked
    /// for does not go with a store.
    pub(crate) fn open(args: &BatchArgs) -> Result<(BatchArgs, Self), StageError> {
        let manifest = StorePlace::named(&args.manifest)?;
        let out = args.out.as_deref().map(StorePlace::named).transpose()?.flatten();
        if StorePlace::named(&args.pipeline)?.is_some() {
            let name = args.pipeline.display();
            return Err(StageError::invalid(format!("the pipeline \"{name}\" lies in a store"))
                .hint("fetch it first: a pipeline and its own files are read from this machine"));
        }
        let usual = || PathBuf::from("out").join(stdin::stem(&args.manifest));
        let work = match (&out, &args.work) {
            (None, Some(_)) => {
                return Err(StageError::invalid("--work goes with results in a store alone")
                    .hint("name the folder with --out, or a store, like --out s3://bucket/out"));
            }
            (None, None) => args.out.clone().unwrap_or_else(usual),
            (Some(_), work) => work.clone().unwrap_or_else(usual),
        };
        if let (Some(out), true) = (&out, args.deadline.is_some()) {
            return Err(StageError::invalid(format!(
                "--deadline chooses a quality in a folder that all shares see, and \"{out}\" is none"
            ))
            .hint("choose it once with a folder of this machine, then name it: --quality NAME"));
        }
        let mut local = BatchArgs { out: Some(work.clone()), work: None, ..args.clone() };
        let mut mirror = Mirror::default();
        if let Some(out) = out {
            mirror.results = Some(StoredResults::new(Bucket::open(&out)?, &out, &work));
        }
        if let Some(manifest) = manifest {
            let (inputs, path) = StoredInputs::fetched(Bucket::open(&manifest)?, &manifest, &work)?;
            (mirror.inputs, local.manifest) = (Some(inputs), path);
        }
        Ok((local, mirror))
    }

    /// Looks which files of garments the store has.
    ///
    /// Errors: the store refuses.
    pub(crate) fn look_at_inputs(&self, garments: &[GarmentLine]) -> Result<(), StageError> {
        let Some(inputs) = &self.inputs else { return Ok(()) };
        inputs.look(named(garments).iter().map(String::as_str))
    }

    /// Fetches the files that garments name.
    ///
    /// Errors: the store refuses; a file cannot be written.
    pub(crate) fn bring_inputs<'a>(
        &self,
        garments: impl IntoIterator<Item = &'a GarmentLine>,
    ) -> Result<(), StageError> {
        let Some(inputs) = &self.inputs else { return Ok(()) };
        inputs.bring(named(garments).iter().map(String::as_str))
    }

    /// Whether the store has a file that is seen from the manifest's folder, by what was looked at.
    pub(crate) fn has_input(&self, file: &str) -> bool {
        self.inputs.as_ref().is_some_and(|inputs| inputs.has(file))
    }

    /// Whether the results are kept in a store.
    pub(crate) fn has_results(&self) -> bool {
        self.results.is_some()
    }

    /// Fetches the records of these garments.
    ///
    /// Errors: the store refuses.
    pub(crate) fn fetch_records(&self, ids: &[&str]) -> Result<(), StageError> {
        self.results.as_ref().map_or(Ok(()), |results| results.look(ids.iter().copied()))
    }

    /// Fetches the files that these garments were made of, by the records that were fetched.
    ///
    /// Errors: the store refuses; a file cannot be written.
    pub(crate) fn fetch_reads(&self, ids: &[&str]) -> Result<(), StageError> {
        let (Some(results), Some(inputs)) = (&self.results, &self.inputs) else { return Ok(()) };
        let records: Vec<GarmentRecord> = ids.iter().filter_map(|id| results.record(id)).collect();
        inputs.bring(records.iter().flat_map(|record| record.reads.keys().map(String::as_str)))
    }

    /// The record of a garment in the store, if that was fetched.
    pub(crate) fn record(&self, id: &str) -> Option<GarmentRecord> {
        self.results.as_ref()?.record(id)
    }

    /// Whether the store has a small picture of a garment.
    pub(crate) fn has_picture(&self, id: &str) -> bool {
        self.results.as_ref().is_some_and(|results| results.has_picture(id))
    }

    /// Fetches what a garment looked for and did not find; whether there is now a file that was not
    /// there for it, so that it has to be run again.
    ///
    /// Errors: the store refuses; a file cannot be written.
    pub(crate) fn brings_missing(&self, reads: &ReadFiles) -> Result<bool, StageError> {
        let Some(inputs) = &self.inputs else { return Ok(false) };
        let missing = || reads.iter().filter(|(_, content)| content.is_none()).map(|(file, _)| file.as_str());
        inputs.bring(missing())?;
        Ok(missing().filter_map(|file| inputs.path(file)).any(|path| path.is_file()))
    }

    /// Sends a garment of the work folder when its turn comes.
    ///
    /// Errors: an earlier one could not be sent.
    pub(crate) fn send(&self, id: &str) -> Result<(), StageError> {
        self.results.as_ref().map_or(Ok(()), |results| results.send(id))
    }

    /// Sends a garment of the work folder that the store has not as it is here. Whether it is sent.
    ///
    /// Errors: an earlier one could not be sent.
    pub(crate) fn send_unsent(&self, id: &str, own: &GarmentRecord) -> Result<bool, StageError> {
        let Some(results) = &self.results else { return Ok(false) };
        // What it took differs from run to run.
        let is_same = |there: &GarmentRecord| {
            (there.ticket, &there.reads, &there.line) == (own.ticket, &own.reads, &own.line)
        };
        match results.record(id) {
            Some(there) if is_same(&there) => Ok(false),
            _ => results.send(id).map(|()| true),
        }
    }

    /// Waits until all garments are sent; gives how many are left where the batch is told to stop.
    ///
    /// Errors: one could not be sent.
    pub(crate) fn end_sending(&self, cancel: &Cancel) -> Result<usize, StageError> {
        self.results.as_ref().map_or(Ok(0), |results| results.end_sending(cancel))
    }

    /// Writes what all shares write together, and sends it. `write` does so in the work folder, by
    /// the records of these garments among others. Another share may do the same: who finds that it
    /// has done so since looks again, so that the last one knows what all have sent.
    ///
    /// Errors: those of `write`; the store refuses.
    pub(crate) fn write_shared<T>(
        &self,
        ids: &[&str],
        write: &dyn Fn() -> Result<T, StageError>,
    ) -> Result<T, StageError> {
        let Some(results) = &self.results else { return write() };
        for _ in 0..MOST_ROUNDS {
            let was = results.version()?;
            results.look(ids.iter().copied())?;
            let written = write()?;
            if results.send_shared(was)? {
                return Ok(written);
            }
        }
        Err(StageError::invalid(format!(
            "other shares write the results in \"{}\" all the time",
            results.place
        ))
        .hint("start the batch again when they have ended, with --merge"))
    }

    /// Where the results are kept: the store, else the folder.
    pub(crate) fn results_in_words(&self, folder: &Path) -> String {
        self.results
            .as_ref()
            .map_or_else(|| folder.display().to_string(), |results| results.place.to_string())
    }
}

/// The files that garments name, or may name.
fn named<'a>(garments: impl IntoIterator<Item = &'a GarmentLine>) -> Vec<String> {
    garments.into_iter().flat_map(|g| g.set.iter().flat_map(at_hand::mentioned)).collect()
}

#[cfg(all(test, feature = "object-store"))]
mod tests;
