//! Records which plugin the program is inside, so that code outside of the call can name it.
//!
//! Two have to. A plugin that calls `exit` ends the program from within, and the system's exit code
//! is that of the plugin: [`name_who_exits`] has the C library call back while a program ends, so
//! that a plugin that ends it is named. And a program that is asked to stop says what did not.
//!
//! Every call into a plugin notes itself for its thread, which costs two stores; calls that may be
//! long note themselves for all threads too. Limits: `_exit`, `abort` and a memory fault call no
//! handler and are not caught.

use std::cell::Cell;
use std::ffi::c_int;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

thread_local! {
    /// The plugin that this thread is in. Without a destructor, so that it can be read while the
    /// thread ends.
    static HERE: Cell<Option<&'static str>> = const { Cell::new(None) };
}

/// The calls under way that may be long: a number of each, the plugin and what it does.
static LONG: Mutex<Vec<(u64, String)>> = Mutex::new(Vec::new());

/// This thread is in a plugin until this is dropped.
pub struct Inside {
    before: Option<&'static str>,
}

/// Notes that this thread goes into a plugin; its words are interned.
pub fn inside(plugin: &'static str) -> Inside {
    Inside { before: HERE.replace(Some(plugin)) }
}

impl Drop for Inside {
    fn drop(&mut self) {
        HERE.set(self.before);
    }
}

/// A call that may be long, until this is dropped.
pub struct Long {
    number: u64,
    _inside: Inside,
}

/// Notes a call that may be long: `plugin "sdf" 0.1.0`, `its stage SdfCollider`.
pub fn long(plugin: &'static str, what: &str) -> Long {
    let mut all = LONG.lock().unwrap_or_else(PoisonError::into_inner);
    let number = all.last().map_or(0, |(n, _)| n + 1);
    all.push((number, format!("{plugin}, {what}")));
    Long { number, _inside: inside(plugin) }
}

impl Drop for Long {
    fn drop(&mut self) {
        LONG.lock().unwrap_or_else(PoisonError::into_inner).retain(|(n, _)| *n != self.number);
    }
}

/// The calls into plugins that are under way: `plugin "sdf" 0.1.0, its stage SdfCollider`.
pub fn under_way() -> Vec<String> {
    LONG.lock().unwrap_or_else(PoisonError::into_inner).iter().map(|(_, words)| words.clone()).collect()
}

/// Prints which plugin ends the program, and returns the exit code of the program.
pub type LastWords = fn(&str) -> c_int;

static LAST_WORDS: OnceLock<LastWords> = OnceLock::new();
static ENDING: AtomicBool = AtomicBool::new(false);

unsafe extern "C" {
    fn atexit(handler: extern "C" fn()) -> c_int;
    #[cfg(target_os = "linux")]
    fn at_quick_exit(handler: extern "C" fn()) -> c_int;
    fn _exit(code: c_int) -> !;
}

/// From now on a plugin that ends the program is named by `last_words`, which gives the exit code,
/// unless [`end`] came first.
///
/// For a program that ends by returning from `main` or by [`end`] alone.
pub fn name_who_exits(last_words: LastWords) {
    if LAST_WORDS.set(last_words).is_ok() {
        // If the C library accepts no more handlers, nothing changes.
        let _ = unsafe { atexit(at_exit) };
        #[cfg(target_os = "linux")]
        let _ = unsafe { at_quick_exit(at_exit) };
    }
}

/// Says that the program itself ends now.
pub fn end() {
    ENDING.store(true, Ordering::SeqCst);
}

extern "C" fn at_exit() {
    if ENDING.load(Ordering::SeqCst) {
        return;
    }
    // Not this thread: one that a plugin has made.
    let who = HERE.get().map(str::to_owned).or_else(|| {
        let all = LONG.try_lock().map(|all| all.iter().map(|(_, words)| words.clone()).collect::<Vec<_>>());
        Some(all.unwrap_or_default().join("; ")).filter(|words| !words.is_empty())
    });
    let Some(last_words) = LAST_WORDS.get() else { return };
    let code = last_words(who.as_deref().unwrap_or("a plugin"));
    let _ = std::io::stderr().flush();
    unsafe { _exit(code) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_are_known_while_they_last() {
        let is_there = |words: &str| under_way().iter().any(|w| w == words);
        let outer = long("plugin \"a\" 1", "its stage A");
        assert_eq!(HERE.get(), Some("plugin \"a\" 1"));
        {
            let _inner = inside("plugin \"b\" 2");
            assert_eq!(HERE.get(), Some("plugin \"b\" 2"));
        }
        assert_eq!(HERE.get(), Some("plugin \"a\" 1"));
        assert!(is_there("plugin \"a\" 1, its stage A"));
        drop(outer);
        assert!(HERE.get().is_none() && !is_there("plugin \"a\" 1, its stage A"));
    }
}
