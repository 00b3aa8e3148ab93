//! When a motion is over.
//!
//! Method: the total energy (elastic, gravitational, of motion) is looked at in equal spans of
//! simulated time; the motion is over when it changes by less than a tolerance over a span
//! [METHODS 2]. The rate at which the change shrinks tells how long rest is away.

use super::simulation::Simulation;

/// Simulated time between two looks, seconds.
const SPAN: f64 = 0.02;

/// The energy's last changes.
#[derive(Debug, Clone, Default)]
pub struct Rest {
    next: f64,
    energy: Option<f64>,
    change: Option<f64>,
    shrink: f64,
}

impl Rest {
    /// True when a span has passed since the last look; the change is then up to date.
    pub fn look(&mut self, simulation: &Simulation) -> bool {
        if simulation.time < self.next {
            return false;
        }
        self.next = simulation.time + SPAN;
        let energy = simulation.energy() + simulation.kinetic_energy();
        let change = self.energy.map(|e| (energy - e).abs());
        if let (Some(old), Some(new)) = (self.change, change) {
            let ratio = (new / old.max(1e-300)).clamp(0.1, 10.0);
            self.shrink = if self.shrink > 0.0 { 0.8 * self.shrink + 0.2 * ratio } else { ratio };
        }
        (self.energy, self.change) = (Some(energy), change);
        true
    }

    /// The energy at the last look, J.
    pub fn energy(&self) -> f64 {
        self.energy.unwrap_or(0.0)
    }

    /// Its change over the last span, J.
    pub fn change(&self) -> Option<f64> {
        self.change
    }

    /// Simulated seconds until the change is below `tolerance`, at the present rate.
    pub fn time_left(&self, tolerance: f64) -> Option<f64> {
        let change = self.change.filter(|c| *c > tolerance)?;
        (self.shrink > 0.0 && self.shrink < 0.999)
            .then(|| (tolerance / change).ln() / self.shrink.ln() * SPAN)
    }

    /// Forgets what it has seen, as when other forces begin to act.
    pub fn restart(&mut self) {
        *self = Rest { next: self.next, ..Rest::default() };
    }
}
