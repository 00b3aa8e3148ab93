//! Clocks.

use serde::{Deserialize, Serialize};

/// Which clock the front is drawn by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Clock {
    /// What passes for the user.
    #[default]
    Wall,
    /// Processor time of all threads: use it on a busy machine.
    Cpu,
}

impl Clock {
    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            Clock::Wall => "wall",
            Clock::Cpu => "cpu",
        }
    }
}
