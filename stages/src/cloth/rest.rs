//! When a motion is over.
//!
//! Method: the total energy (elastic, gravitational, of motion) is looked at in equal spans of
//! simulated time; the motion is over when it changes by less than a tolerance over a span
//! [METHODS 2], and when no vertex got far in that span: a vertex that trembles on a contact is fast
//! at any one step and yet goes nowhere. The rate at which the change shrinks tells how long rest is
//! away.

use super::simulation::Simulation;
use toile_core::artifact::Point3;

/// Simulated time between two looks, seconds.
const SPAN: f64 = 0.02;

/// The energy's last changes.
#[derive(Debug, Clone, Default)]
pub struct Rest {
    next: f64,
    energy: Option<f64>,
    change: Option<f64>,
    shrink: f64,
    places: Vec<Point3>,
    looked: f64,
    drift: Option<f64>,
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
        self.measure_drift(simulation);
        true
    }

    fn measure_drift(&mut self, simulation: &Simulation) {
        let (x, time) = (&simulation.state.x, simulation.time - self.looked);
        self.drift = (self.places.len() == x.len() && time > 0.0).then(|| {
            let ways = self.places.iter().zip(x).map(|(a, b)| (b - a).norm_squared());
            ways.fold(0.0, f64::max).sqrt() / time
        });
        self.places.clone_from(x);
        self.looked = simulation.time;
    }

    /// Greatest speed of a vertex, as its way over the last span, m/s.
    pub fn drift(&self) -> Option<f64> {
        self.drift
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
