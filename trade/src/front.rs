//! The Pareto front: settings that no other beats in time and error at once.
//!
//! Cost: one sort. Two points with both figures equal are both on the front.

/// A measured point: seconds and error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Seconds.
    pub time: f64,
    /// Error, any unit.
    pub error: f64,
}

impl Cost {
    /// True where it is nowhere worse than `other` and somewhere better.
    pub fn beats(&self, other: &Cost) -> bool {
        let nowhere_worse = self.time <= other.time && self.error <= other.error;
        nowhere_worse && (self.time < other.time || self.error < other.error)
    }
}

/// Indices of the points that nothing beats, by ascending time. Points that are not finite are
/// never among them.
pub fn front(costs: &[Cost]) -> Vec<usize> {
    let finite = |c: &Cost| c.time.is_finite() && c.error.is_finite();
    let mut order: Vec<usize> = (0..costs.len()).filter(|&i| finite(&costs[i])).collect();
    order.sort_by(|&a, &b| {
        costs[a]
            .time
            .total_cmp(&costs[b].time)
            .then(costs[a].error.total_cmp(&costs[b].error))
            .then(a.cmp(&b))
    });
    let mut kept: Vec<usize> = Vec::new();
    for i in order {
        let is_level = |k: &usize| costs[*k] == costs[i];
        match kept.last() {
            Some(k) if costs[*k].error <= costs[i].error && !is_level(k) => {}
            _ => kept.push(i),
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cost(time: f64, error: f64) -> Cost {
        Cost { time, error }
    }

    #[test]
    fn dearer_and_worse_is_off_the_front() {
        let costs = [cost(4.0, 1.0), cost(1.0, 4.0), cost(2.0, 5.0), cost(2.0, 2.0), cost(f64::NAN, 0.0)];
        assert_eq!(front(&costs), [1, 3, 0]);
        assert_eq!(front(&[]), [0; 0]);
    }

    proptest! {
        #[test]
        fn nothing_beats_the_front_and_something_beats_all_else(raw in prop::collection::vec((0..20u8, 0..20u8), 0..40)) {
            let costs: Vec<Cost> = raw.iter().map(|&(t, e)| cost(f64::from(t), f64::from(e))).collect();
            let front = front(&costs);
            for i in 0..costs.len() {
                let beaten = costs.iter().any(|c| c.beats(&costs[i]));
                prop_assert_eq!(front.contains(&i), !beaten);
            }
            prop_assert!(front.is_sorted_by(|a, b| costs[*a].time <= costs[*b].time));
        }
    }
}
