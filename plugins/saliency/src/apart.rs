//! Work on a thread of its own.
//!
//! A network is run in one call, which takes most of a second and cannot be stopped. It is
//! therefore made apart, while the stage asks whether it is to stop; the thread of a run that was
//! stopped ends by itself, and what it made is dropped.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;
use toile_core::{Context, StageError};

/// How often the stage asks whether it is to stop.
const ASK: Duration = Duration::from_millis(10);

/// What `work` gives.
///
/// # Errors
/// Cancelled; the system has no thread; the work broke off.
pub(crate) fn apart<T: Send + 'static>(
    cx: &Context,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, StageError> {
    let (tell, told) = channel();
    let thread = thread::Builder::new().name("saliency".into());
    // Nobody listens any more where the run was stopped.
    let started = thread.spawn(move || drop(tell.send(work())));
    started.map_err(|e| StageError::internal(format!("the system gives no thread: {e}")))?;
    loop {
        match told.recv_timeout(ASK) {
            Ok(made) => return Ok(made),
            Err(RecvTimeoutError::Timeout) => cx.check()?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(StageError::internal("the mask was not finished"));
            }
        }
    }
}
