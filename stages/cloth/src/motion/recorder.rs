//! Records the places of all vertices at equal steps of time.
//!
//! A motion's own steps are shorter and end where contacts and phases want them; a frame lies on
//! the straight way between the two steps about its time. Cost: 12 bytes a vertex and frame.

use super::SAME_TIME;
use toile_geometry::Vec3;

/// Frames of one motion, or of several that follow each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorder {
    every: f64,
    begin: f64,
    next: usize,
    room: usize,
    /// Places of all vertices of the scene, frame after frame, m.
    pub positions: Vec<[f32; 3]>,
    /// Whether it had no room for a frame: the motion was stopped there.
    pub is_full: bool,
}

impl Recorder {
    /// A frame every so many seconds, above 0, with room for so many places. The motion begins at
    /// `begin` s of all motions together, of which `done` frames are there.
    #[must_use]
    pub fn new(every: f64, begin: f64, done: usize, room: usize) -> Self {
        Self { every, begin, next: done, room, positions: Vec::new(), is_full: false }
    }

    /// Time between two frames, s.
    #[must_use]
    pub fn every(&self) -> f64 {
        self.every
    }

    /// Whether a frame is due at `time` of this motion.
    pub(super) fn is_due(&self, time: f64) -> bool {
        self.next as f64 * self.every <= self.begin + time + SAME_TIME
    }

    /// Takes the frames between two steps, each a time and places; false where there is no room for
    /// them.
    pub(super) fn pass(&mut self, from: (f64, &[Vec3]), to: (f64, &[Vec3])) -> bool {
        while self.is_due(to.0) {
            if self.positions.len() + to.1.len() > self.room {
                self.is_full = true;
                return false;
            }
            let due = self.next as f64 * self.every - self.begin;
            let share = ((due - from.0) / (to.0 - from.0)).clamp(0.0, 1.0);
            let share = if share.is_nan() { 1.0 } else { share };
            let between = from.1.iter().zip(to.1).map(|(p, q)| p + (q - p) * share);
            self.positions.extend(between.map(|p| [p.x as f32, p.y as f32, p.z as f32]));
            self.next += 1;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_lie_at_equal_times_whatever_the_steps() {
        let mut recorder = Recorder::new(0.1, 0.0, 0, 100);
        let at = |t: f64| [Vec3::new(t, 0.0, 1.0)];
        let mut time = 0.0;
        for step in [0.03, 0.04, 0.06, 0.001, 0.25] {
            let next = time + step;
            assert!(recorder.pass((time, &at(time)), (next, &at(next))));
            time = next;
        }
        let x: Vec<f32> = recorder.positions.iter().map(|p| p[0]).collect();
        assert_eq!(x, [0.0, 0.1, 0.2, 0.3]);
        // Another motion goes on at 0.381 s.
        let mut second = Recorder::new(0.1, time, 4, 100);
        assert!(!second.is_due(0.01));
        assert!(second.pass((0.0, &at(time)), (0.05, &at(time + 0.05))));
        assert!((second.positions[0][0] - 0.4).abs() < 1e-6 && second.positions.len() == 1);
    }

    #[test]
    fn it_is_full_when_there_is_no_room() {
        let mut recorder = Recorder::new(0.1, 0.0, 0, 2);
        let x = [Vec3::zeros()];
        assert!(recorder.pass((0.0, &x), (0.15, &x)) && !recorder.is_full);
        assert!(!recorder.pass((0.15, &x), (0.25, &x)) && recorder.is_full);
    }
}
