//! Panics as words.
//!
//! A panic is a bug of the program or of a stage, never of its input. It ends the present work with
//! an error that has the panic's message, its place in the source and what to do; the program
//! continues, so that it can report this and clean up.

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

/// What the user may do about a bug.
pub const REPORT: &str = "this is a bug, please report it with the pipeline and the command";

/// How many places are remembered: panics of threads that run at once.
const KEPT: usize = 16;

/// The last panics: what was said, and where.
static PLACES: Mutex<VecDeque<(String, String)>> = Mutex::new(VecDeque::new());

/// From now on panics print nothing by themselves, and their places are remembered for [`caught`].
/// With `RUST_BACKTRACE` set they are printed as usual.
pub fn quiet() {
    let usual = std::panic::take_hook();
    let loud = std::env::var_os("RUST_BACKTRACE").is_some_and(|v| v != "0");
    std::panic::set_hook(Box::new(move |info| {
        if let Some(at) = info.location() {
            let mut places = PLACES.lock().unwrap_or_else(PoisonError::into_inner);
            places.truncate(KEPT - 1);
            places.push_front((
                said(info.payload()).unwrap_or_default(),
                format!("{}:{}", at.file(), at.line()),
            ));
        }
        if loud {
            usual(info);
        }
    }));
}

/// Does the work; a panic in it becomes words:
/// `index out of bounds: ... (core/pipeline/src/run/recall.rs:40)`.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(words)
}

/// What a panic says, and where it was where that is remembered.
pub fn words(payload: Box<dyn Any + Send>) -> String {
    let text = said(payload.as_ref()).unwrap_or_default();
    // Dropping a payload may panic again, and then nothing could be reported.
    std::mem::forget(payload);
    let places = PLACES.lock().unwrap_or_else(PoisonError::into_inner);
    match places.iter().find(|(what, _)| *what == text) {
        Some((_, at)) => format!("{text} ({at})"),
        None => text,
    }
}

fn said(payload: &(dyn Any + Send)) -> Option<String> {
    let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    text.or_else(|| payload.downcast_ref::<crate::StageError>().map(ToString::to_string))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::panic)]
    use super::*;

    #[test]
    fn a_panic_becomes_what_it_said() {
        assert_eq!(caught(|| 3), Ok(3));
        assert_eq!(caught(|| -> u8 { panic!("no {}", "way") }), Err("no way".into()));
        assert_eq!(caught(|| -> u8 { std::panic::panic_any(3) }), Err(String::new()));
        struct Twice;
        impl Drop for Twice {
            fn drop(&mut self) {
                panic!("again");
            }
        }
        assert_eq!(caught(|| -> u8 { std::panic::panic_any(Twice) }), Err(String::new()));
    }
}
