//! Results in a store: which garments are there, and what is sent.

use super::Bucket;
use super::place::StorePlace;
use super::sender::StoreSender;
use super::version::{FileVersion, StoreListing};
use crate::batch::record::{self, GarmentRecord};
use crate::batch::thumb;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use toile_core::{Cancel, StageError};

/// What all shares write, in the order in which it is sent: the last one says that all is there.
const FILES: [&str; 3] = ["costs.jsonl", "index.html", "results.jsonl"];

/// The results of a batch that are kept in a store.
pub(crate) struct StoredResults {
    bucket: Arc<Bucket>,
    pub(super) place: StorePlace,
    /// The work folder.
    work: PathBuf,
    there: Mutex<There>,
    sender: Mutex<Option<StoreSender>>,
}

/// What is known of the store.
#[derive(Default)]
struct There {
    /// The files of all garments, when they were looked at last.
    files: StoreListing,
    /// Records that were fetched, with their state.
    records: BTreeMap<String, (FileVersion, GarmentRecord)>,
}

impl StoredResults {
    pub(super) fn new(bucket: Bucket, place: &StorePlace, work: &Path) -> Self {
        let (there, sender) = Default::default();
        StoredResults { bucket: Arc::new(bucket), place: place.clone(), work: work.to_owned(), there, sender }
    }

    /// Looks what the store has, and fetches the records of these garments.
    ///
    /// Errors: the store refuses.
    pub(super) fn look<'a>(&self, ids: impl IntoIterator<Item = &'a str>) -> Result<(), StageError> {
        let files = self.bucket.below(&self.place.below("garments"))?;
        let mut there = self.there();
        there.files = files;
        let mut records = std::mem::take(&mut there.records);
        records.retain(|id, (was, _)| there.files.get(&self.record_of(id)).is_some_and(|now| now.is(was)));
        let wanted: Vec<(&str, FileVersion)> = ids
            .into_iter()
            .filter(|id| !records.contains_key(*id))
            .filter_map(|id| Some((id, there.files.get(&self.record_of(id))?.clone())))
            .collect();
        let keys: Vec<String> = wanted.iter().map(|(id, _)| self.record_of(id)).collect();
        let found = self.bucket.read_all(&keys)?;
        // What is no record of this version is none: the garment is run again.
        let read = |bytes: Option<Vec<u8>>| serde_json::from_slice::<GarmentRecord>(&bytes?).ok();
        for ((id, version), bytes) in wanted.into_iter().zip(found) {
            if let Some(record) = read(bytes) {
                records.insert(id.to_owned(), (version, record));
            }
        }
        there.records = records;
        Ok(())
    }

    /// The record of a garment that was fetched.
    pub(super) fn record(&self, id: &str) -> Option<GarmentRecord> {
        self.there().records.get(id).map(|(_, record)| record.clone())
    }

    /// Whether the store has a small picture of a garment.
    pub(super) fn has_picture(&self, id: &str) -> bool {
        self.there().files.contains_key(&self.place.below(&format!("garments/{id}/{}", thumb::FILE)))
    }

    /// Sends a garment of the work folder when its turn comes.
    ///
    /// Errors: an earlier one could not be sent.
    pub(super) fn send(&self, id: &str) -> Result<(), StageError> {
        let mut sender = self.sender.lock().unwrap_or_else(PoisonError::into_inner);
        if sender.is_none() {
            *sender = Some(StoreSender::new(&self.bucket, &self.place, &self.work)?);
        }
        sender.as_ref().map_or(Ok(()), |sender| sender.send(id))
    }

    /// Waits until all garments are sent; gives how many are left where the batch is told to stop.
    ///
    /// Errors: one could not be sent.
    pub(super) fn end_sending(&self, cancel: &Cancel) -> Result<usize, StageError> {
        let sender = self.sender.lock().unwrap_or_else(PoisonError::into_inner).take();
        sender.map_or(Ok(0), |mut sender| sender.end(cancel))
    }

    /// Which state the results of all are in.
    ///
    /// Errors: the store refuses.
    pub(super) fn version(&self) -> Result<Option<FileVersion>, StageError> {
        self.bucket.version(&self.place.below(FILES[2]))
    }

    /// Sends what all shares write, from the work folder; whether no other share has done so since
    /// the results were in that state.
    ///
    /// Errors: the store refuses; a file cannot be read.
    pub(super) fn send_shared(&self, was: Option<FileVersion>) -> Result<bool, StageError> {
        let [first @ .., last] = FILES.map(|name| (self.place.below(name), self.work.join(name)));
        let bytes = toile_core::read_file(&last.1)
            .map_err(|e| StageError::invalid(format!("cannot read \"{}\": {e}", last.1.display())))?;
        self.bucket.send_all(&first)?;
        self.bucket.send_if(&last.0, bytes, was)
    }

    fn record_of(&self, id: &str) -> String {
        self.place.below(&format!("garments/{id}/{}", record::FILE))
    }

    fn there(&self) -> MutexGuard<'_, There> {
        self.there.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
