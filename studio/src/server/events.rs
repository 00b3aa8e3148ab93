//! News as they come: server-sent events.

use super::answer::{AnswerBody, HttpAnswer, with};
use crate::studio::Studio;
use hyper::header::{self, HeaderValue};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::sync::watch::Receiver;
use tokio::time::{sleep, timeout};

/// The least time between two states.
const LEAST: Duration = Duration::from_millis(100);
/// The most time without a word, so that a lost connection is noticed.
const MOST: Duration = Duration::from_secs(15);

/// One page that listens.
struct EventFeed {
    studio: Arc<Studio>,
    news: Receiver<u64>,
    /// The state as it was sent last.
    sent: String,
    /// The number of the note of progress that was sent last.
    progress: u64,
}

impl EventFeed {
    /// The next events; waits for them.
    async fn next(&mut self) -> String {
        if !self.sent.is_empty() {
            sleep(LEAST).await;
            match timeout(MOST, self.news.changed()).await {
                Ok(Ok(())) => {}
                // Nothing is new, or nothing will be.
                _ => return ":\n\n".to_owned(),
            }
        }
        self.news.mark_unchanged();
        let mut events = String::new();
        let studio = self.studio.clone();
        // An edit on its way to the disk is waited for.
        let state = tokio::task::spawn_blocking(move || studio.state(false).to_string()).await;
        let state = state.unwrap_or_default();
        if state != self.sent && !state.is_empty() {
            events.push_str(&format!("event: state\ndata: {state}\n\n"));
            self.sent = state;
        }
        let (number, progress) = self.studio.progress();
        if let Some(progress) = progress.filter(|_| number != self.progress) {
            events.push_str(&format!("event: progress\ndata: {progress}\n\n"));
        }
        self.progress = number;
        // An empty piece would end nothing, and say nothing.
        if events.is_empty() { ":\n\n".to_owned() } else { events }
    }
}

/// The answer that goes on, until nobody listens.
pub(super) fn events(studio: Arc<Studio>) -> HttpAnswer {
    let news = studio.pulse().listen();
    let mut feed = EventFeed { studio, news, sent: String::new(), progress: 0 };
    let (sender, pieces) = mpsc::channel(1);
    tokio::spawn(async move { while sender.send(feed.next().await).await.is_ok() {} });
    with(AnswerBody::Pieces(pieces), header::CONTENT_TYPE, HeaderValue::from_static("text/event-stream"))
}
