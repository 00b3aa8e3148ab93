//! Where a measurement was made.

use serde::{Deserialize, Serialize};

/// Where it was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// `linux x86_64`.
    pub system: String,
    /// Cores that the system offers.
    pub cores: usize,
    /// Threads that the stages used.
    pub threads: usize,
    /// Load of the machine over a minute at the end, where the system reports it: beyond the
    /// threads used, others worked too.
    pub load: Option<f64>,
}

impl Machine {
    /// This one.
    pub fn here() -> Self {
        let load = std::fs::read_to_string("/proc/loadavg").ok();
        Machine {
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            threads: rayon::current_num_threads(),
            load: load.and_then(|l| l.split(' ').next()?.parse().ok()),
        }
    }
}
