//! A motion with another time between its frames: each lies on the straight way between two that
//! were recorded. Cost: as many places as are written.

use toile_core::artifact::RecordedMotion;

/// Difference below which two times count as equal, as a share of the time between two frames.
const SAME: f64 = 1e-9;

/// The motion with a frame every so many seconds, from the first to the last one that was recorded.
pub(super) fn resampled(motion: &RecordedMotion, every: f64) -> RecordedMotion {
    let frames: Vec<&[[f32; 3]]> = motion.frames().collect();
    let ratio = every / motion.every;
    let last = frames.len().saturating_sub(1) as f64;
    let mut positions = Vec::new();
    for k in 0.. {
        let at = k as f64 * ratio;
        if at > last + SAME {
            break;
        }
        let first = (at + SAME).floor().min(last);
        let share = (at - first).max(0.0) as f32;
        let (Some(a), b) = (frames.get(first as usize), frames.get(first as usize + 1)) else { break };
        match b.filter(|_| f64::from(share) > SAME) {
            Some(b) => positions
                .extend(a.iter().zip(*b).map(|(p, q)| std::array::from_fn(|c| p[c] + (q[c] - p[c]) * share))),
            None => positions.extend_from_slice(a),
        }
    }
    RecordedMotion { every, positions, ..motion.clone() }
}
