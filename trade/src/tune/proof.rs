//! What fresh runs of a setting showed.

use super::Wish;
use crate::errors::Millimetres;
use crate::record::{Clock, Measured};

/// A setting that was proved.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingProof {
    /// The index of its point.
    pub point: usize,
    /// The fresh run.
    pub fresh: Measured,
    /// Distances of the moved starts.
    pub starts: Vec<Millimetres>,
    /// Moved starts that failed.
    pub failed: Vec<String>,
}

impl SettingProof {
    /// Moved starts that keep an error.
    pub fn kept(&self, max_error_mm: f64) -> usize {
        self.starts.iter().filter(|m| m.p95 <= max_error_mm).count()
    }

    /// The worst of the fresh run and of the moved starts: 95 % of the surface, mm.
    pub fn worst_mm(&self) -> f64 {
        self.starts.iter().map(|m| m.p95).fold(self.fresh.errors.distance_mm.p95, f64::max)
    }

    pub(super) fn is_good(&self, wish: &Wish, clock: Clock) -> bool {
        let starts =
            wish.max_error_mm.is_none_or(|e| self.failed.is_empty() && self.kept(e) == self.starts.len());
        wish.is_kept(self.fresh.errors.distance_mm.p95, self.fresh.time(clock)) && self.fresh.sound && starts
    }

    /// How the moved starts ended, where an error was asked for:
    /// `10 of 10 moved starts within 2 mm, the worst 1.31 mm`.
    pub fn starts_in_words(&self, wish: &Wish) -> Option<String> {
        let e = wish.max_error_mm.filter(|_| !self.starts.is_empty())?;
        let worst = self.starts.iter().map(|m| m.p95).fold(0.0, f64::max);
        let (kept, all) = (self.kept(e), self.starts.len() + self.failed.len());
        Some(format!("{kept} of {all} moved starts within {e} mm, the worst {worst:.2} mm"))
    }

    pub(super) fn words(&self, wish: &Wish, clock: Clock) -> String {
        let mut text = format!(
            "a fresh run takes {:.2} s ({}), 95 % within {:.2} mm",
            self.fresh.time(clock),
            clock.as_str(),
            self.fresh.errors.distance_mm.p95
        );
        if let Some(e) = wish.max_error_mm.filter(|_| !self.starts.is_empty() || !self.failed.is_empty()) {
            let (kept, all) = (self.kept(e), self.starts.len() + self.failed.len());
            text += &format!(", {kept} of {all} moved starts within {e} mm");
        }
        text
    }
}
