//! Files that are spoilt at random: whatever a user hands in or a disk gives back is answered or
//! refused. No panic, no signal, no more than 2 GiB, no more than 20 s.
//!
//! A short run is among the tests. `.ci/wide` runs 100,000 cases a target with another seed:
//!
//!     FUZZ_CASES=100000 FUZZ_SEED=7 cargo test --release -p toile-tests --test fuzz
//!
//! A failure names the case and keeps its file in `out/fuzz`; `FUZZ_FROM=CASE FUZZ_CASES=1` with
//! the same seed makes it again. Where a signal ended the process, the case is the one in
//! `out/fuzz/TARGET.case`.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

mod batch;
mod cache;
mod dice;
mod plugin;
mod spoil;
mod texts;
mod views;

use dice::Dice;
use std::fs::File;
use std::io::{Seek, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

#[global_allocator]
static HEAP: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;

/// The longest that a case may take.
const MAX_TIME: Duration = Duration::from_secs(20);
/// The most bytes that may be held during a case.
const MAX_BYTES: usize = 2 << 30;

/// A number from the environment.
fn asked(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|n| n.parse().ok())
}

/// Runs the cases of a target, one target after another, so that time and memory are the case's
/// own. `usual` is how many are run where nobody asks; `spoilt` makes a case; `hold` must come back
/// from it, whatever it says.
fn fuzz(
    target: &str,
    usual: u64,
    spoilt: impl Fn(&mut Dice) -> Vec<u8>,
    mut hold: impl FnMut(&[u8]) -> Result<(), String>,
) {
    static ONE: Mutex<()> = Mutex::new(());
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let (seed, from) = (asked("FUZZ_SEED").unwrap_or(1994), asked("FUZZ_FROM").unwrap_or(0));
    let cases = asked("FUZZ_CASES").unwrap_or(usual);
    let folder = toile_tests::root().join("out/fuzz");
    std::fs::create_dir_all(&folder).unwrap();
    let kept = |case: u64| folder.join(format!("{target}-{seed}-{case}"));
    let mut mark = File::create(folder.join(format!("{target}.case"))).unwrap();
    for case in from..from + cases {
        let input = spoilt(&mut Dice::of(seed, target, case));
        mark.rewind().and_then(|()| write!(mark, "{case:<12}")).unwrap();
        let watch = Watch::new(target.to_owned(), kept(case), input.clone());
        let before = HEAP.current_usage();
        HEAP.reset_peak_usage();
        let outcome = catch_unwind(AssertUnwindSafe(|| hold(&input)));
        let grown = HEAP.peak_usage().saturating_sub(before);
        drop(watch);
        let fault = match outcome {
            Err(_) => Some("it panicked".to_owned()),
            Ok(Err(fault)) => Some(fault),
            Ok(Ok(())) => (grown > MAX_BYTES).then(|| format!("it held {} MiB", grown >> 20)),
        };
        if let Some(fault) = fault {
            std::fs::write(kept(case), &input).unwrap();
            panic!("{target}, seed {seed}, case {case}: {fault}; its file is {}", kept(case).display());
        }
    }
}

/// Ends the process where a case takes too long: a loop that does not end cannot be left otherwise.
struct Watch {
    done: Option<std::sync::mpsc::Sender<()>>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Watch {
    fn new(target: String, file: PathBuf, input: Vec<u8>) -> Self {
        let (done, waiting) = channel::<()>();
        let watch = move || {
            if waiting.recv_timeout(MAX_TIME) == Err(RecvTimeoutError::Timeout) {
                let _ = std::fs::write(&file, &input);
                eprintln!(
                    "{target}: a case takes more than {} s; its file is {}",
                    MAX_TIME.as_secs(),
                    file.display()
                );
                std::process::exit(1);
            }
        };
        Watch { done: Some(done), thread: Some(std::thread::spawn(watch)) }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.done.take();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
