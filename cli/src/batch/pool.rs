//! The pool: a process a garment, as many at a time as there are cores and memory for.
//!
//! A garment starts when what it is expected to take fits beside those that run. Where together
//! they take more than there is, the one that is farthest above what was expected is ended and run
//! again alone, so that what comes of a garment does not depend on its neighbours.

use super::child::late;
use super::memory;
use super::record::GarmentFault;
use super::task::{GarmentAnswer, GarmentTask};
use crate::exit;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};
use toile_core::{Cancel, ErrorCode};
use toile_pipeline::cache::Bytes;
use toile_trade::measure::apart::{Apart, ProcessEnd, end_in_words};

/// Time between two looks at the memory of all.
const TICK: Duration = Duration::from_millis(50);
/// How long a garment that has reached its time has to stop by itself and leave what it made.
const GRACE: Duration = Duration::from_secs(5);

/// What garments may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PoolLimits {
    pub(crate) cores: usize,
    /// Most garments at a time.
    pub(crate) jobs: usize,
    /// Bytes of all that run.
    pub(crate) memory: u64,
    /// Bytes of one.
    pub(crate) max_memory: u64,
    pub(crate) max_time: Option<Duration>,
}

/// How a garment has ended.
#[derive(Debug)]
pub(crate) enum GarmentEnd {
    Answered(Box<GarmentAnswer>),
    /// Its process ended without an answer: the exit code of that.
    Broken(u8, GarmentFault),
}

/// A garment that is through.
#[derive(Debug)]
pub(crate) struct EndedGarment {
    /// Its place in the manifest.
    pub(crate) place: usize,
    pub(crate) end: GarmentEnd,
    pub(crate) seconds: f64,
    /// Greatest resident memory that was seen, bytes.
    pub(crate) peak: u64,
}

/// What is to be done with a garment that is through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AfterGarment {
    Kept,
    /// It lacked a file that is there now.
    Again,
}

/// What is asked of the pool's owner.
pub(crate) trait Garments {
    /// What a garment is expected to take, bytes.
    fn expected(&mut self, place: usize) -> u64;
    /// Its task, on so many threads.
    ///
    /// Errors: a sentence that ends the batch.
    fn task(&mut self, place: usize, threads: u16) -> Result<GarmentTask, String>;
    /// Keeps what came of it.
    ///
    /// Errors: a sentence that ends the batch.
    fn ended(&mut self, garment: EndedGarment) -> Result<AfterGarment, String>;
}

/// EndedFor a process is ended from here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum EndedFor {
    Stopped,
    TooLate,
    TooMuch,
    Crowded,
}

/// A garment at work.
struct AtWork {
    expected: u64,
    held: Arc<AtomicU64>,
    crowded: Arc<AtomicBool>,
}

/// What a garment's thread gives back.
struct Through {
    place: usize,
    ended: Result<ProcessEnd<EndedFor>, String>,
    seconds: f64,
    peak: u64,
}

/// Runs the garments in their order; a garment that was stopped with the batch is not told.
///
/// Errors: a sentence; what was at work is ended and not kept.
pub(crate) fn run(
    program: &Apart,
    places: impl IntoIterator<Item = usize>,
    limits: &PoolLimits,
    cancel: &Cancel,
    garments: &mut dyn Garments,
) -> Result<(), String> {
    let mut queue: VecDeque<(usize, Option<u64>)> = places.into_iter().map(|place| (place, None)).collect();
    let mut at_work: BTreeMap<usize, AtWork> = BTreeMap::new();
    let stop = Arc::new(AtomicBool::new(false));
    let (send, receive) = channel();
    let mut outcome = Ok(());
    std::thread::scope(|scope| {
        loop {
            if cancel.is_cancelled() {
                stop.store(true, Ordering::SeqCst);
            }
            while !stop.load(Ordering::SeqCst) && at_work.len() < limits.jobs {
                let Some((place, known)) = queue.front().copied() else { break };
                let expected = known.unwrap_or_else(|| garments.expected(place)).min(limits.memory);
                if !at_work.is_empty() && taken(&at_work) + expected > limits.memory {
                    queue[0].1 = Some(expected);
                    break;
                }
                let threads = limits.cores / limits.jobs.min(at_work.len() + queue.len()).max(1);
                queue.pop_front();
                let threads = u16::try_from(threads.max(1)).unwrap_or(u16::MAX);
                let started = garments.task(place, threads).and_then(|task| {
                    let line = serde_json::to_string(&task).map_err(|e| e.to_string())?;
                    let look = ProcessLook::new(*limits, &stop);
                    let own = AtWork { expected, held: look.held.clone(), crowded: look.crowded.clone() };
                    let (send, program) = (send.clone(), program.clone());
                    std::thread::Builder::new()
                        .spawn_scoped(scope, move || attend(&program, place, &line, look, &send))
                        .map_err(|e| format!("the system starts no thread: {e}"))?;
                    Ok(own)
                });
                match started {
                    Ok(own) => drop(at_work.insert(place, own)),
                    Err(why) => {
                        outcome = Err(why);
                        stop.store(true, Ordering::SeqCst);
                    }
                }
            }
            if at_work.is_empty() {
                break;
            }
            match receive.recv_timeout(TICK) {
                Err(RecvTimeoutError::Timeout) => relieve(&at_work, limits.memory),
                Err(RecvTimeoutError::Disconnected) => break,
                Ok(through) => {
                    at_work.remove(&through.place);
                    let place = through.place;
                    let kept = match told(through, limits) {
                        Ok(Some(garment)) => garments.ended(garment).map(|after| {
                            if after == AfterGarment::Again {
                                queue.push_front((place, None));
                            }
                        }),
                        Ok(None) if !stop.load(Ordering::SeqCst) => {
                            queue.push_back((place, Some(limits.memory)));
                            Ok(())
                        }
                        Ok(None) => Ok(()),
                        Err(why) => Err(why),
                    };
                    if let Err(why) = kept
                        && outcome.is_ok()
                    {
                        outcome = Err(why);
                        stop.store(true, Ordering::SeqCst);
                    }
                }
            }
        }
    });
    outcome
}

/// What garments at work take, or are expected to.
fn taken(at_work: &BTreeMap<usize, AtWork>) -> u64 {
    at_work.values().map(|w| w.expected.max(w.held.load(Ordering::SeqCst))).sum()
}

/// Ends one garment where all take more than there is.
fn relieve(at_work: &BTreeMap<usize, AtWork>, memory: u64) {
    let held = |w: &AtWork| w.held.load(Ordering::SeqCst);
    let is_crowded = at_work.values().map(held).sum::<u64>() > memory;
    let one_goes = at_work.values().any(|w| w.crowded.load(Ordering::SeqCst));
    if at_work.len() < 2 || !is_crowded || one_goes {
        return;
    }
    let above = |w: &AtWork| held(w).saturating_sub(w.expected);
    if let Some(most) = at_work.values().max_by_key(|w| above(w)) {
        most.crowded.store(true, Ordering::SeqCst);
    }
}

/// Looks at a garment's process from time to time.
struct ProcessLook {
    limits: PoolLimits,
    started: Instant,
    stop: Arc<AtomicBool>,
    held: Arc<AtomicU64>,
    crowded: Arc<AtomicBool>,
    peak: u64,
}

impl ProcessLook {
    fn new(limits: PoolLimits, stop: &Arc<AtomicBool>) -> Self {
        let (held, crowded) = Default::default();
        ProcessLook { limits, started: Instant::now(), stop: stop.clone(), held, crowded, peak: 0 }
    }

    fn at(&mut self, process: u32) -> Option<EndedFor> {
        let held = memory::held(process).unwrap_or(0);
        self.held.store(held, Ordering::SeqCst);
        self.peak = self.peak.max(held);
        let end = self.limits.max_time.map(|limit| limit + GRACE);
        if self.stop.load(Ordering::SeqCst) {
            Some(EndedFor::Stopped)
        } else if held > self.limits.max_memory {
            Some(EndedFor::TooMuch)
        } else if self.crowded.load(Ordering::SeqCst) {
            Some(EndedFor::Crowded)
        } else if end.is_some_and(|end| self.started.elapsed() > end) {
            Some(EndedFor::TooLate)
        } else {
            None
        }
    }
}

fn attend(program: &Apart, place: usize, line: &str, mut look: ProcessLook, send: &Sender<Through>) {
    let mut ended = program.process(line, |process| look.at(process));
    let seconds = look.started.elapsed().as_secs_f64();
    // Ctrl-C reaches the process as soon as the batch, which notes it with its next look.
    if let Ok(end) = &mut ended
        && end.stopped.is_none()
        && answer(end).is_none()
    {
        std::thread::sleep(3 * TICK);
        end.stopped = look.stop.load(Ordering::SeqCst).then_some(EndedFor::Stopped);
    }
    // Who does not listen any more has ended with an error of its own.
    let _ = send.send(Through { place, ended, seconds, peak: look.peak });
}

/// What a process has answered; none where it broke off.
fn answer(end: &ProcessEnd<EndedFor>) -> Option<GarmentAnswer> {
    serde_json::from_slice::<GarmentAnswer>(&end.answer).ok().filter(|answer| !answer.cancelled)
}

/// How a garment has ended; none where it has not, and may be run again.
///
/// Errors: its process could not be started.
fn told(through: Through, limits: &PoolLimits) -> Result<Option<EndedGarment>, String> {
    let Through { place, ended, seconds, peak } = through;
    let ended = ended?;
    let broken = |code, fault| GarmentEnd::Broken(code, fault);
    let end = match ended.stopped {
        Some(EndedFor::Stopped | EndedFor::Crowded) => return Ok(None),
        Some(EndedFor::TooLate) => broken(exit::STOPPED, late(limits.max_time.unwrap_or_default())),
        Some(EndedFor::TooMuch) => broken(exit::STOPPED, too_much(limits.max_memory)),
        None => match answer(&ended) {
            Some(answer) => GarmentEnd::Answered(Box::new(answer)),
            None => broke_off(&ended),
        },
    };
    Ok(Some(EndedGarment { place, end, seconds, peak }))
}

/// The fault of a garment that takes too much memory.
fn too_much(most: u64) -> GarmentFault {
    let most = Bytes(most);
    GarmentFault::new(
        "out_of_memory",
        format!("it took more than {most}, the limit of --max-memory or --memory"),
    )
    .hint("run it again on a machine with more, with --retry-only out_of_memory")
}

fn crashed(how: &str) -> GarmentFault {
    GarmentFault::new("crashed", format!("its process {how}"))
        .hint("run it again alone with --only; a system that is out of memory ends processes by signal 9")
}

/// A process that ended by itself and without an answer.
fn broke_off(ended: &ProcessEnd<EndedFor>) -> GarmentEnd {
    let Ok(status) = ended.status else {
        return GarmentEnd::Broken(exit::BUG, crashed("is lost"));
    };
    let how = end_in_words(status, &ended.words);
    match status.code() {
        Some(code) if code == i32::from(exit::BUG) => {
            let fault = GarmentFault::new(ErrorCode::Internal.as_str(), format!("its process {how}"));
            GarmentEnd::Broken(exit::BUG, fault)
        }
        _ => GarmentEnd::Broken(exit::BUG, crashed(&how)),
    }
}
