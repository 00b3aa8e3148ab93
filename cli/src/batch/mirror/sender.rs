//! Sends garments while others are run.
//!
//! A garment's record is sent last, and the one of an earlier garment in its place is removed
//! first: what has a record in the store is whole, whenever the batch is killed.

use super::Bucket;
use super::place::StorePlace;
use crate::batch::folder::{below, garment};
use crate::batch::record;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use toile_core::{Cancel, StageError};

/// Garments that are sent at a time.
const AT_A_TIME: usize = 4;
/// How long a batch that is told to stop goes on sending: less than the half minute that clusters
/// give.
const PATIENCE: Duration = Duration::from_secs(20);
/// Time between two looks whether it is told to.
const LOOK: Duration = Duration::from_millis(50);

/// What the threads share.
struct Sending {
    bucket: Arc<Bucket>,
    place: StorePlace,
    work: PathBuf,
    queue: Mutex<Receiver<String>>,
    /// Garments that are not sent yet.
    left: AtomicUsize,
    /// The first failure; nothing is sent after it.
    failed: Mutex<Option<StageError>>,
}

/// Sends garments of a folder to a place.
pub(super) struct StoreSender {
    sending: Arc<Sending>,
    queue: Option<Sender<String>>,
    /// Disconnected when all threads have ended.
    end: Receiver<()>,
}

impl StoreSender {
    /// Errors: the system starts no thread.
    pub(super) fn new(bucket: &Arc<Bucket>, place: &StorePlace, work: &Path) -> Result<Self, StageError> {
        let ((queue, taken), (ended, end)) = (channel(), channel());
        let sending = Arc::new(Sending {
            bucket: bucket.clone(),
            place: place.clone(),
            work: work.to_owned(),
            queue: Mutex::new(taken),
            left: AtomicUsize::new(0),
            failed: Mutex::default(),
        });
        for _ in 0..AT_A_TIME {
            let (sending, ended) = (sending.clone(), ended.clone());
            std::thread::Builder::new()
                .spawn(move || {
                    sending.serve();
                    drop(ended);
                })
                .map_err(|e| StageError::invalid(format!("the system starts no thread: {e}")))?;
        }
        Ok(StoreSender { sending, queue: Some(queue), end })
    }

    /// Sends a garment when its turn comes.
    ///
    /// Errors: an earlier one could not be sent.
    pub(super) fn send(&self, id: &str) -> Result<(), StageError> {
        if let Some(e) = self.sending.failure() {
            return Err(e);
        }
        self.sending.left.fetch_add(1, Ordering::SeqCst);
        // Who does not listen any more has failed, and says so at the end.
        self.queue.iter().for_each(|queue| drop(queue.send(id.to_owned())));
        Ok(())
    }

    /// Waits until all are sent, not for ever where the batch is told to stop. Gives how many are
    /// left.
    ///
    /// Errors: one could not be sent.
    pub(super) fn end(&mut self, cancel: &Cancel) -> Result<usize, StageError> {
        self.queue = None;
        let mut asked: Option<Instant> = None;
        while self.end.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
            if cancel.is_cancelled() && asked.get_or_insert_with(Instant::now).elapsed() > PATIENCE {
                break;
            }
        }
        let left = self.sending.left.load(Ordering::SeqCst);
        self.sending.failure().map_or(Ok(left), Err)
    }
}

impl Sending {
    fn serve(&self) {
        loop {
            let next = self.queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
            let Ok(id) = next else { return };
            if self.failure().is_some() {
                continue;
            }
            match sent(&self.bucket, &self.place, &garment(&self.work, &id), &id) {
                Ok(()) => drop(self.left.fetch_sub(1, Ordering::SeqCst)),
                Err(e) => {
                    self.failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(e);
                }
            }
        }
    }

    fn failure(&self) -> Option<StageError> {
        self.failed.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Sends a garment's folder.
///
/// Errors: the store refuses; a file cannot be read.
pub(super) fn sent(bucket: &Bucket, place: &StorePlace, folder: &Path, id: &str) -> Result<(), StageError> {
    let there = place.below(&format!("garments/{id}"));
    let mut names = Vec::new();
    below(folder, "", &mut names)
        .map_err(|e| StageError::invalid(format!("cannot read \"{}\": {e}", folder.display())))?;
    let sent = |name: &String| (format!("{there}/{name}"), folder.join(name));
    let (last, first): (Vec<_>, Vec<_>) =
        names.iter().map(sent).partition(|(key, _)| *key == record_of(&there));
    let old = bucket.below(&there)?;
    if old.contains_key(&record_of(&there)) {
        bucket.remove_all(&[record_of(&there)])?;
    }
    let is_kept = |key: &String| first.iter().chain(&last).any(|(own, _)| own == key);
    let gone: Vec<String> = old.into_keys().filter(|key| !is_kept(key)).collect();
    bucket.remove_all(&gone)?;
    bucket.send_all(&first)?;
    bucket.send_all(&last)
}

fn record_of(garment: &str) -> String {
    format!("{garment}/{}", record::FILE)
}
