//! Wakes those who wait for news.

use tokio::sync::watch;

/// Counts what has changed. Clones count together.
#[derive(Debug, Clone)]
pub(crate) struct Pulse(watch::Sender<u64>);

impl Pulse {
    pub(crate) fn new() -> Self {
        Pulse(watch::Sender::new(0))
    }

    /// Says that there is news.
    pub(crate) fn beat(&self) {
        self.0.send_modify(|count| *count += 1);
    }

    /// Whether anybody waits for news.
    pub(crate) fn is_listened_to(&self) -> bool {
        self.0.receiver_count() > 0
    }

    /// Waits for news from now on.
    pub(crate) fn listen(&self) -> watch::Receiver<u64> {
        self.0.subscribe()
    }
}
