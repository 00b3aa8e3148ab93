//! A panic must not cross the plugin ABI: it ends here, as a status and a message.

use super::abi;
use crate::panics;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    /// The message of the last failure on this thread, for errors in calls that have no other way.
    static LAST: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs the inside of an entry point; its failure or panic becomes a status.
pub fn guarded(work: impl FnOnce() -> Result<(), String>) -> i32 {
    let (status, message) = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => return abi::OK,
        Ok(Err(message)) => (abi::FAILED, message),
        Err(payload) => (abi::PANICKED, panics::words(payload)),
    };
    LAST.with(|last| *last.borrow_mut() = message);
    status
}

/// The message of the last failure on this thread, good until the next one.
pub fn last_failure() -> abi::Text {
    LAST.with(|last| abi::Text::of(&last.borrow()))
}

/// A status in words: `panicked`.
pub fn meaning(status: i32) -> String {
    match status {
        abi::FAILED => "failed".into(),
        abi::PANICKED => "panicked".into(),
        other => format!("gave back {other}, which means nothing,"),
    }
}
