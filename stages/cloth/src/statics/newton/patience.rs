//! Whether something still shrinks from step to step.

use std::cell::Cell;

/// The least value so far, and how many steps ago it was.
pub(crate) struct Patience {
    most: usize,
    share: f64,
    least: Cell<f64>,
    steps: Cell<usize>,
}

impl Patience {
    /// A value must shrink within `most` steps by more than that share of itself.
    pub(crate) fn new((most, share): (usize, f64)) -> Self {
        Self { most, share, least: Cell::new(f64::INFINITY), steps: Cell::new(0) }
    }

    /// Looks at the value after a step; whether it has shrunk of late.
    pub(crate) fn goes_on(&self, value: f64) -> bool {
        if value < (1.0 - self.share) * self.least.get() {
            self.least.set(value);
            self.steps.set(0);
        } else {
            self.steps.set(self.steps.get() + 1);
        }
        self.steps.get() < self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_goes_on_while_it_shrinks() {
        let patience = Patience::new((12, 0.01));
        let mut value = 1.0;
        for _ in 0..50 {
            value *= 0.98;
            assert!(patience.goes_on(value));
        }
        let steps = (0..50).take_while(|_| patience.goes_on(value)).count();
        assert_eq!(steps, 12 - 1);
    }
}
