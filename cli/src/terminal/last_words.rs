//! What the program prints if it does not end in the usual way: a plugin ends it, or something that
//! was asked to stop does not stop.

use crate::exit;
use serde_json::json;
use std::io::{IsTerminal, Write, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering};
use toile_core::ErrorCode;
use toile_pipeline::plugin;

/// Whether the answer is to be JSON.
static JSON: AtomicBool = AtomicBool::new(false);

/// The program ends by itself once this is dropped; before, a plugin that ends it is named.
pub(crate) struct Alive;

impl Alive {
    pub(crate) fn new() -> Self {
        plugin::name_who_exits(ended_by);
        Alive
    }
}

impl Drop for Alive {
    fn drop(&mut self) {
        plugin::end();
    }
}

/// Says whether the answer is to be JSON.
pub(crate) fn as_json(json: bool) {
    JSON.store(json, Ordering::SeqCst);
}

/// Ends the program.
pub(crate) fn leave(code: u8) -> ! {
    plugin::end();
    std::process::exit(i32::from(code))
}

fn ended_by(who: &str) -> std::ffi::c_int {
    let message = format!("{who} ended the program from within, by `exit`");
    say(ErrorCode::Internal, &message, "this is a bug of the plugin, please report it to its author");
    i32::from(exit::BUG)
}

/// Prints an error where no stream is available. Output that cannot be written is lost.
pub(crate) fn say(code: ErrorCode, message: &str, hint: &str) {
    if JSON.load(Ordering::SeqCst) {
        let record = json!({ "error": code.as_str(), "message": message, "hint": hint });
        let mut out = stdout();
        let _ = writeln!(out, "{record}").and_then(|()| out.flush());
        return;
    }
    let mut err = stderr();
    // A progress line may stand there.
    let line = if err.is_terminal() { "\n" } else { "" };
    let _ = writeln!(err, "{line}error: {message}\n  help: {hint}");
}
