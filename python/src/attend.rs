//! Work on a thread of its own, while the thread that asked for it tells how it goes and listens
//! for Ctrl-C.
//!
//! The interpreter is free meanwhile, so that other threads of Python run, and so do stages in
//! Python.

use crate::error::panicked;
use pyo3::prelude::*;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use toile_core::{Cancel, Event, Listener, panics};

/// How often the waiting thread looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(30);
/// How long work that was asked to stop is waited for; then it is left to end by itself.
const PATIENCE: Duration = Duration::from_millis(800);
/// The least time between two words on the progress of one stage.
const PAUSE: Duration = Duration::from_millis(100);

/// What the working thread says.
enum Message<T> {
    /// A stage, an entry of its sets, how far it is and what it does.
    Progress(String, String, f64, String),
    Done(Result<T, String>),
}

/// Passes progress on, not too often.
struct Reporter<T> {
    send: Sender<Message<T>>,
    last: Mutex<Option<(String, Instant)>>,
}

impl<T: Send> Listener for Reporter<T> {
    fn event(&self, stage: &str, entry: &str, event: &Event) {
        let Event::Progress { share, text } = event else { return };
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let is_soon = last.as_ref().is_some_and(|(id, at)| id == stage && at.elapsed() < PAUSE);
        if is_soon && *share < 1.0 {
            return;
        }
        *last = Some((stage.to_owned(), Instant::now()));
        let _ = self.send.send(Message::Progress(stage.to_owned(), entry.to_owned(), *share, text.clone()));
    }
}

/// Does the work; `progress` is called with stage, entry, share and text, on the present thread.
///
/// Errors: what `progress` raises, and the exception of a signal, `KeyboardInterrupt` of Ctrl-C;
/// the work is asked to stop then. A panic in the work.
pub(crate) fn attended<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Cancel, Arc<dyn Listener>) -> T + Send + 'static,
) -> PyResult<T> {
    let (send, receive) = channel::<Message<T>>();
    let cancel = Cancel::new();
    let (flag, reporter) = (cancel.clone(), Reporter { send: send.clone(), last: Mutex::default() });
    let run = move || {
        let outcome = panics::caught(|| work(flag, Arc::new(reporter)));
        let _ = send.send(Message::Done(outcome));
    };
    std::thread::Builder::new().name("toile".into()).spawn(run)?;
    let receive = Mutex::new(receive);
    let mut stopped: Option<(PyErr, Instant)> = None;
    loop {
        let told = py.detach(|| next(&receive));
        let raised = match told {
            Ok(Message::Done(outcome)) => {
                return match stopped {
                    Some((e, _)) => Err(e),
                    None => outcome.map_err(|words| panicked(py, &words)),
                };
            }
            Ok(Message::Progress(..)) if stopped.is_some() => Ok(()),
            Ok(Message::Progress(stage, entry, share, text)) => match progress {
                Some(call) => call.call1((stage, entry, share, text)).map(drop),
                None => Ok(()),
            },
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => Err(panicked(py, "the thread of a run ended")),
        };
        if stopped.is_none()
            && let Err(e) = raised.and_then(|()| py.check_signals())
        {
            cancel.cancel();
            stopped = Some((e, Instant::now()));
        }
        if let Some((e, _)) = stopped.take_if(|(_, since)| since.elapsed() > PATIENCE) {
            return Err(e);
        }
    }
}

fn next<T>(receive: &Mutex<Receiver<Message<T>>>) -> Result<Message<T>, RecvTimeoutError> {
    receive.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK)
}
