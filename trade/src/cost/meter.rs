//! Clocks and memory of one stage after the other.

use cpu_time::ProcessTime;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use toile_core::cost::Used;
use toile_pipeline::cost::Meter;

/// A program's count of the memory that it holds.
#[derive(Debug, Clone, Copy)]
pub struct MemoryCount {
    /// Bytes held now; 0 where they are not counted.
    pub held: fn() -> usize,
    /// Most bytes held since the peak was last forgotten.
    pub peak: fn() -> usize,
    /// Forgets the peak.
    pub forget: fn(),
}

/// Measures stages. Processor time and memory are the process's: nothing else of it may work
/// meanwhile.
#[derive(Debug)]
pub struct Stopwatch {
    memory: MemoryCount,
    began: Mutex<Option<Began>>,
}

#[derive(Debug, Clone, Copy)]
struct Began {
    wall: Instant,
    cpu: Option<ProcessTime>,
    held: usize,
}

impl Stopwatch {
    /// Stopped.
    pub fn new(memory: MemoryCount) -> Self {
        Stopwatch { memory, began: Mutex::new(None) }
    }
}

impl Meter for Stopwatch {
    fn start(&self) {
        (self.memory.forget)();
        let held = (self.memory.held)();
        let began = Began { wall: Instant::now(), cpu: ProcessTime::try_now().ok(), held };
        *self.began.lock().unwrap_or_else(PoisonError::into_inner) = Some(began);
    }

    fn stop(&self) -> Used {
        let Some(began) = self.began.lock().unwrap_or_else(PoisonError::into_inner).take() else {
            return Used::default();
        };
        let cpu = began.cpu.and_then(|c| c.try_elapsed().ok());
        let counted = |bytes: usize| (began.held > 0).then(|| bytes.saturating_sub(began.held) as u64);
        Used {
            wall_s: began.wall.elapsed().as_secs_f64(),
            cpu_s: cpu.map(|c| c.as_secs_f64()),
            peak_bytes: counted((self.memory.peak)()),
            kept_bytes: counted((self.memory.held)()),
        }
    }
}
