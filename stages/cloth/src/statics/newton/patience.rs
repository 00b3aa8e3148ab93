//! Whether a value still shrinks from step to step. Cost: O(1).

use std::cell::Cell;

/// How fast a value must shrink.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patience {
    /// Steps within which it must shrink.
    pub(crate) steps: usize,
    /// Share of itself by which it must shrink.
    pub(crate) share: f64,
}

/// The least value so far, and how many steps ago it was.
pub(crate) struct Shrinking {
    patience: Patience,
    least: Cell<f64>,
    steps: Cell<usize>,
}

impl Shrinking {
    pub(crate) fn new(patience: Patience) -> Self {
        Self { patience, least: Cell::new(f64::INFINITY), steps: Cell::new(0) }
    }

    /// Takes the value after a step, and returns whether it has shrunk within the allowed steps.
    pub(crate) fn goes_on(&self, value: f64) -> bool {
        if value < (1.0 - self.patience.share) * self.least.get() {
            self.least.set(value);
            self.steps.set(0);
        } else {
            self.steps.set(self.steps.get() + 1);
        }
        self.steps.get() < self.patience.steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_goes_on_while_it_shrinks() {
        let shrinking = Shrinking::new(Patience { steps: 12, share: 0.01 });
        let mut value = 1.0;
        for _ in 0..50 {
            value *= 0.98;
            assert!(shrinking.goes_on(value));
        }
        let steps = (0..50).take_while(|_| shrinking.goes_on(value)).count();
        assert_eq!(steps, 12 - 1);
    }
}
