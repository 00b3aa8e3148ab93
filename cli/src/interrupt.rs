//! Ctrl-C: asks the run to stop, and stops the program where a stage does not listen.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use toile_core::Cancel;

/// How long a stage has to stop by itself. Nothing is written before all stages are done, so
/// ending the program loses nothing.
const PATIENCE: Duration = Duration::from_millis(400);

static CURRENT: OnceLock<Cancel> = OnceLock::new();
static WRITING: AtomicBool = AtomicBool::new(false);

/// A stop flag that Ctrl-C raises. Every call gives the same flag.
pub(crate) fn on_ctrl_c() -> Cancel {
    let cancel = CURRENT.get_or_init(|| {
        let cancel = Cancel::new();
        let flag = cancel.clone();
        // A second handler cannot be set; then the system's own way of stopping stays.
        let _ = ctrlc::set_handler(move || {
            flag.cancel();
            std::thread::sleep(PATIENCE);
            if !WRITING.load(Ordering::SeqCst) {
                std::process::exit(i32::from(crate::exit::STOPPED));
            }
        });
        cancel
    });
    cancel.clone()
}

/// Says that all files are written.
pub(crate) fn end_writing() {
    WRITING.store(false, Ordering::SeqCst);
}

/// Says that files are being written, which is not cut short.
pub(crate) fn begin_writing() {
    WRITING.store(true, Ordering::SeqCst);
}
