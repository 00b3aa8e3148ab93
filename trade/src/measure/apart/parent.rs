//! A run's process from outside: started, waited for, ended.

use super::Apart;
use super::wire::{Task, read};
use crate::measure::{Missed, Ran};
use std::io::{Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use toile_core::{Cancel, ErrorCode, StageError};

/// How often the watchdog looks at the clock.
const WATCH: Duration = Duration::from_millis(20);
/// The number of the signal that Ctrl-C sends to all processes of a terminal.
const INTERRUPT: i32 = 2;
/// The number of the signal by which a system ends a process, often for want of memory.
const KILL: i32 = 9;
/// The longest line of a process's last words, characters.
const LAST_WORDS: usize = 200;

impl Apart {
    /// Runs a task in a process of its own.
    ///
    /// Errors: as the run's own; the process cannot be started, or ends without an answer.
    pub(crate) fn run(&self, task: &Task, cancel: &Cancel) -> Result<Ran, Missed> {
        let failed = |why: String| Missed::Failed(StageError::internal(why));
        let started = Instant::now();
        let mut child =
            self.start().map_err(|e| failed(format!("a run's own process cannot be started: {e}")))?;
        let (done, answer, words) =
            readers(&mut child).ok_or_else(|| failed("a process without output".into()))?;
        // A process that is gone takes no task; what it said is told below.
        let fed = send(&mut child, task);
        let ended = watch(&done, cancel, task.limit.map(|l| started + l));
        if ended.is_err() {
            let _ = child.kill();
        }
        let status = child.wait();
        let (answer, words) = (answer.join().unwrap_or_default(), words.join().unwrap_or_default());
        drop(fed);
        match (ended, status) {
            (Err(Ended::Cancelled), _) => Err(Missed::Cancelled),
            (Err(Ended::OverLimit), _) => Err(Missed::OverLimit(started.elapsed().as_secs_f64())),
            (Ok(()), Ok(status)) if status.success() => read(&answer),
            (Ok(()), Ok(status)) => Err(broken_off(status, &words, cancel)),
            (Ok(()), Err(e)) => Err(failed(format!("a run's own process is lost: {e}"))),
        }
    }

    fn start(&self) -> std::io::Result<Child> {
        Command::new(&self.program)
            .args(&self.arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
    }
}

/// Why a process is ended from here.
enum Ended {
    Cancelled,
    OverLimit,
}

type ReaderThread = JoinHandle<Vec<u8>>;

/// Threads that read what the process prints, and a channel that closes with its answer's end.
fn readers(child: &mut Child) -> Option<(Receiver<()>, ReaderThread, ReaderThread)> {
    let (mut out, mut err) = (child.stdout.take()?, child.stderr.take()?);
    let (open, done) = channel::<()>();
    let answer = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let _ = out.read_to_end(&mut bytes);
        drop(open);
        bytes
    });
    let words = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let _ = err.read_to_end(&mut bytes);
        bytes
    });
    Some((done, answer, words))
}

/// Writes the task; the input stays open as long as what is given back lives.
fn send(child: &mut Child, task: &Task) -> Option<std::process::ChildStdin> {
    let mut input = child.stdin.take()?;
    let line = serde_json::to_string(task).ok()? + "\n";
    let _ = input.write_all(line.as_bytes());
    let _ = input.flush();
    Some(input)
}

/// Waits until the answer has ended.
fn watch(done: &Receiver<()>, cancel: &Cancel, end: Option<Instant>) -> Result<(), Ended> {
    while matches!(done.recv_timeout(WATCH), Err(RecvTimeoutError::Timeout)) {
        if cancel.is_cancelled() {
            return Err(Ended::Cancelled);
        }
        if end.is_some_and(|end| Instant::now() >= end) {
            return Err(Ended::OverLimit);
        }
    }
    Ok(())
}

/// A process that ended by itself without an answer.
pub(super) fn broken_off(status: ExitStatus, words: &[u8], cancel: &Cancel) -> Missed {
    let signal = signal(status);
    if signal == Some(INTERRUPT) || cancel.is_cancelled() {
        return Missed::Cancelled;
    }
    let how = match (signal, status.code()) {
        (Some(signal), _) => format!("was ended by signal {signal}"),
        (None, Some(code)) => format!("ended with code {code}"),
        (None, None) => "ended".to_owned(),
    };
    let words = String::from_utf8_lossy(words);
    let last = words.lines().map(str::trim).rfind(|l| !l.is_empty());
    let last: String = last.map_or_else(String::new, |l| format!(": {l}")).chars().take(LAST_WORDS).collect();
    let e = StageError::new(ErrorCode::Internal, format!("the run's own process {how}{last}"));
    Missed::Failed(match signal {
        Some(KILL) => e.hint("a system that runs out of memory ends a process so"),
        _ => e,
    })
}

#[cfg(unix)]
fn signal(status: ExitStatus) -> Option<i32> {
    use std::os::unix::process::ExitStatusExt;
    status.signal()
}

#[cfg(not(unix))]
fn signal(_: ExitStatus) -> Option<i32> {
    None
}
