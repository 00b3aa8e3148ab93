//! Ctrl-C, and the other signals that ask a program to end (TERM, HUP): the run is asked to stop,
//! and the program is stopped where a stage does not listen; what did not listen is named.
//!
//! A plugin has longer than a stage of this program: the code that waits for it names it
//! (`toile_pipeline::plugin`). A second signal ends the program at once. HUP stays ignored where it
//! is, as under `nohup`.

use crate::{exit, terminal::last_words};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};
use toile_core::{Cancel, ErrorCode};
use toile_pipeline::plugin;

/// How long a stage has to stop by itself. Nothing is written before all stages are done, so
/// ending the program loses nothing.
const PATIENCE: Duration = Duration::from_millis(400);
/// How long a run whose plugin was left behind has to say so.
const MARGIN: Duration = Duration::from_secs(1);
/// Time between two looks.
const LOOK: Duration = Duration::from_millis(10);

static CURRENT: OnceLock<Cancel> = OnceLock::new();
static WRITING: AtomicBool = AtomicBool::new(false);
/// The stage at work, as the progress line names it.
static AT_WORK: Mutex<String> = Mutex::new(String::new());

/// A stop flag that Ctrl-C raises. Every call gives the same flag.
pub(crate) fn on_ctrl_c() -> Cancel {
    let cancel = CURRENT.get_or_init(|| {
        let cancel = Cancel::new();
        listen(cancel.clone());
        cancel
    });
    cancel.clone()
}

/// Waits for signals on a thread of its own. Without one, or with a handler that stands already,
/// the system's own way of stopping stays.
#[cfg(unix)]
fn listen(flag: Cancel) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let (ready, is_ready) = std::sync::mpsc::channel();
    let wait = move || {
        let hang_up = Some(SIGHUP).filter(|_| !is_hang_up_ignored());
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM].into_iter().chain(hang_up)) else { return };
        let _ = ready.send(());
        if signals.forever().next().is_some() {
            stop(&flag, || signals.pending().next().is_some());
        }
    };
    if std::thread::Builder::new().name("signals".into()).spawn(wait).is_ok() {
        let _ = is_ready.recv();
    }
}

#[cfg(not(unix))]
fn listen(flag: Cancel) {
    let stopping = AtomicBool::new(false);
    let _ = ctrlc::set_handler(move || {
        if !stopping.swap(true, Ordering::SeqCst) {
            stop(&flag, || false);
        }
    });
}

/// Whether the program was started with HUP ignored, as `nohup` does. Linux alone says.
#[cfg(unix)]
fn is_hang_up_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 1 == 1)
}

/// Asks everything to stop; ends the program where that does not help, or is asked for `again`.
fn stop(flag: &Cancel, mut again: impl FnMut() -> bool) {
    flag.cancel();
    let asked = Instant::now();
    let waits = plugin::patience();
    let patience = if waits.is_zero() { PATIENCE } else { waits + MARGIN };
    loop {
        std::thread::sleep(LOOK);
        let at_once = again();
        if !WRITING.load(Ordering::SeqCst) && (at_once || asked.elapsed() > patience) {
            cut_off(asked.elapsed());
        }
    }
}

/// Ends the program, and says what did not stop.
fn cut_off(after: Duration) -> ! {
    let mut who = plugin::under_way();
    if who.is_empty() {
        let stage = AT_WORK.lock().unwrap_or_else(PoisonError::into_inner).clone();
        who.push(if stage.is_empty() { "what was under way".to_owned() } else { format!("stage {stage}") });
    }
    let message = format!(
        "stopped: {} did not stop within {:.1} s of being asked",
        who.join("; "),
        after.as_secs_f64()
    );
    last_words::say(
        ErrorCode::Cancelled,
        &message,
        "the program was stopped there; files that were written before are complete",
    );
    last_words::leave(exit::STOPPED)
}

/// Names the stage at work.
pub(crate) fn at_work(stage: &str) {
    let mut at = AT_WORK.lock().unwrap_or_else(PoisonError::into_inner);
    if *at != stage {
        stage.clone_into(&mut at);
    }
}

/// Says that all files are written.
pub(crate) fn end_writing() {
    WRITING.store(false, Ordering::SeqCst);
}

/// Says that files are being written, which is not cut short.
pub(crate) fn begin_writing() {
    WRITING.store(true, Ordering::SeqCst);
}
