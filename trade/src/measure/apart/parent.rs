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

/// How a process of its own has ended.
#[derive(Debug)]
pub struct ProcessEnd<E> {
    /// What it has printed on standard output.
    pub answer: Vec<u8>,
    /// What it has printed on standard error.
    pub words: Vec<u8>,
    /// What the system says of its end.
    pub status: std::io::Result<ExitStatus>,
    /// Why it was ended from here; none where it ended by itself.
    pub stopped: Option<E>,
}

impl Apart {
    /// Starts the process with a line on its standard input, and waits for its end. `look` is asked
    /// with the process's id every 20 ms whether the process is to be ended, and why.
    ///
    /// # Errors
    /// A sentence: the process cannot be started.
    pub fn process<E>(
        &self,
        line: &str,
        mut look: impl FnMut(u32) -> Option<E>,
    ) -> Result<ProcessEnd<E>, String> {
        let mut child = self.start().map_err(|e| format!("a run's own process cannot be started: {e}"))?;
        let (done, answer, words) = readers(&mut child).ok_or("a process without output")?;
        // A process that is gone takes no task; its own message is reported below.
        let fed = send(&mut child, line);
        let id = child.id();
        let mut stopped = None;
        while stopped.is_none() && matches!(done.recv_timeout(WATCH), Err(RecvTimeoutError::Timeout)) {
            stopped = look(id);
        }
        if stopped.is_some() {
            let _ = child.kill();
        }
        let status = child.wait();
        let (answer, words) = (answer.join().unwrap_or_default(), words.join().unwrap_or_default());
        drop(fed);
        Ok(ProcessEnd { answer, words, status, stopped })
    }

    /// Runs a task in a process of its own.
    ///
    /// Errors: as the run's own; the process cannot be started, or ends without an answer.
    pub(crate) fn run(&self, task: &Task, cancel: &Cancel) -> Result<Ran, Missed> {
        let failed = |why: String| Missed::Failed(StageError::internal(why));
        let started = Instant::now();
        let end = task.limit.map(|l| started + l);
        let look = |_| match (cancel.is_cancelled(), end.is_some_and(|end| Instant::now() >= end)) {
            (true, _) => Some(Ended::Cancelled),
            (false, true) => Some(Ended::OverLimit),
            (false, false) => None,
        };
        let line = serde_json::to_string(task).map_err(|e| failed(e.to_string()))?;
        let ended = self.process(&line, look).map_err(failed)?;
        match (ended.stopped, ended.status) {
            (Some(Ended::Cancelled), _) => Err(Missed::Cancelled),
            (Some(Ended::OverLimit), _) => Err(Missed::OverLimit(started.elapsed().as_secs_f64())),
            (None, Ok(status)) if status.success() => read(&ended.answer),
            (None, Ok(status)) => Err(broken_off(status, &ended.words, cancel)),
            (None, Err(e)) => Err(failed(format!("a run's own process is lost: {e}"))),
        }
    }

    fn start(&self) -> std::io::Result<Child> {
        Command::new(&self.program)
            .args(self.launch.iter().chain(&self.arguments))
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
fn send(child: &mut Child, line: &str) -> Option<std::process::ChildStdin> {
    let mut input = child.stdin.take()?;
    let _ = input.write_all(format!("{line}\n").as_bytes());
    let _ = input.flush();
    Some(input)
}

/// A process that ended by itself without an answer.
pub(super) fn broken_off(status: ExitStatus, words: &[u8], cancel: &Cancel) -> Missed {
    let signal = signal(status);
    if signal == Some(INTERRUPT) || cancel.is_cancelled() {
        return Missed::Cancelled;
    }
    let e = StageError::new(
        ErrorCode::Internal,
        format!("the run's own process {}", end_in_words(status, words)),
    );
    Missed::Failed(match signal {
        Some(KILL) => e.hint("a system that is out of memory ends processes like this"),
        _ => e,
    })
}

/// How a process ended by itself, with the last line that it printed: `was ended by signal 6: stack
/// overflow`.
pub fn end_in_words(status: ExitStatus, words: &[u8]) -> String {
    let how = match (signal(status), status.code()) {
        (Some(signal), _) => format!("was ended by signal {signal}"),
        (None, Some(code)) => format!("ended with code {code}"),
        (None, None) => "ended".to_owned(),
    };
    let words = String::from_utf8_lossy(words);
    let last = words.lines().map(str::trim).rfind(|l| !l.is_empty());
    let last: String = last.map_or_else(String::new, |l| format!(": {l}")).chars().take(LAST_WORDS).collect();
    format!("{how}{last}")
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
