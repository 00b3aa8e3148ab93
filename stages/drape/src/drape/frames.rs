//! Frames of a motion: what a solver that steps in time records, and how the next one goes on.
//!
//! Recording is off unless a stage asks for it (`Frames`). Solvers that follow each other make one
//! motion with one time between frames. Limit: [`ROOM`] bytes of frames.

use std::sync::Arc;
use toile_cloth::motion::{Moved, Recorder};
use toile_core::artifact::RecordedMotion;
use toile_core::prelude::*;

/// Bytes of frames at most, all solvers together: 2 GB, 30,000 frames of a garment of 5,500
/// vertices.
const ROOM: usize = 2_000_000_000;

/// The recorder of a solver that records a frame every so many seconds, none at 0.
pub(super) fn recorder(every: f64, garment: &Garment, cx: &Context) -> Result<Option<Recorder>, StageError> {
    if every == 0.0 {
        return Ok(None);
    }
    let before = garment.motion.as_deref();
    if let Some(other) = before.filter(|m| m.every != every) {
        let text = format!(
            "`frames` is {every} s, and the solver before it has recorded a frame every {} s",
            other.every
        );
        return Err(StageError::new(ErrorCode::InvalidParameter, text)
            .hint("give both the same, or leave it to `Frames(every: ...)`")
            .at("frames"));
    }
    if before.is_some_and(|m| !is_of(m, garment)) {
        cx.warn("the mesh was cut finer since the motion began: its frames begin anew here");
    }
    let before = before.filter(|m| is_of(m, garment));
    let (begin, done, taken) = before.map_or((0.0, 0, 0), |m| (m.end, m.len(), m.positions.len()));
    Ok(Some(Recorder::new(every, begin, done, (ROOM / 12).saturating_sub(taken))))
}

/// Whether the frames are of this garment's mesh.
fn is_of(motion: &RecordedMotion, garment: &Garment) -> bool {
    motion.vertices == garment.positions.len() && motion.triangles == garment.triangles
}

/// Why a motion was stopped by its recorder.
pub(super) fn full(every: f64) -> StageError {
    StageError::new(
        ErrorCode::InvalidParameter,
        format!("the motion has more frames than fit into {} GB: one every {every} s", ROOM / 1_000_000_000),
    )
    .hint("take a longer time between them: `Frames(every: 0.04)`")
    .at("frames")
}

/// The motion so far, with what was recorded.
pub(super) fn after(
    recorder: Option<Recorder>,
    garment: &Garment,
    moved: &Moved,
) -> Option<Arc<RecordedMotion>> {
    let Some(recorder) = recorder else { return garment.motion.clone() };
    let mut motion = match garment.motion.as_deref().filter(|m| is_of(m, garment)) {
        Some(before) => before.clone(),
        None => RecordedMotion {
            every: recorder.every(),
            triangles: garment.triangles.clone(),
            vertices: garment.positions.len(),
            ..RecordedMotion::default()
        },
    };
    motion.positions.extend(recorder.positions);
    motion.end += moved.progress.time;
    Some(Arc::new(motion))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::{ImplicitEuler, SpringDraper};
    use super::*;
    use toile_fixtures::cloth::{hanging, plain};

    fn falling(frames: f64) -> SpringDraper {
        SpringDraper { time_limit: 0.1, damping: 0.0, least_step: 1e-6, frames, ..SpringDraper::default() }
    }

    fn sheet() -> Garment {
        hanging(0.1, 0.1, 0.02, &plain(500.0, 50.0, 1e-5)).0
    }

    fn places(garment: &Garment) -> Vec<[f32; 3]> {
        garment.positions.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect()
    }

    #[test]
    fn nothing_is_recorded_unless_it_is_asked_for() {
        let fallen = falling(0.0).run(&sheet(), None, &Context::quiet()).unwrap();
        assert!(fallen.motion.is_none());
    }

    #[test]
    fn the_frames_of_solvers_in_a_row_are_one_motion() {
        let (start, cx) = (sheet(), Context::quiet());
        let first = falling(0.02).run(&start, None, &cx).unwrap();
        let motion = first.motion.clone().unwrap();
        assert_eq!((motion.len(), motion.vertices), (6, start.positions.len()));
        assert_eq!(motion.frames().next().unwrap(), places(&start));
        // The last frame is the end, to a step of 0.4 ms, by which the motion is longer.
        let apart = motion.frames().last().unwrap().iter().zip(places(&first));
        let far = apart.flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).abs())).fold(0.0, f32::max);
        assert!(far < 5e-4, "{far}");
        // A fall from rest: 9.81 / 2 * t^2, with steps of 4 ms.
        let height = |k: usize| motion.frames().nth(k).unwrap()[0][1];
        assert!((height(0) - height(5) - 0.049).abs() < 0.003, "{}", height(0) - height(5));

        let second = falling(0.02).run(&first, None, &cx).unwrap();
        let all = second.motion.unwrap();
        assert_eq!(all.len(), 11);
        assert_eq!(all.positions[..motion.positions.len()], motion.positions);
        assert!((all.end - 0.2).abs() < 2e-3, "{}", all.end);
        all.check().unwrap();
    }

    #[test]
    fn recording_changes_no_bit_of_the_result() {
        let cx = Context::quiet();
        let [plain, recorded] = [0.0, 0.013].map(|every| falling(every).run(&sheet(), None, &cx).unwrap());
        assert_eq!(plain.positions, recorded.positions);
        assert_eq!(plain.velocities, recorded.velocities);
    }

    #[test]
    fn another_time_between_frames_is_refused() {
        let cx = Context::quiet();
        let first = falling(0.02).run(&sheet(), None, &cx).unwrap();
        let e = falling(0.05).run(&first, None, &cx).unwrap_err();
        assert_eq!(
            e.message,
            "`frames` is 0.05 s, and the solver before it has recorded a frame every 0.02 s"
        );
        assert_eq!(e.hint.as_deref(), Some("give both the same, or leave it to `Frames(every: ...)`"));
        assert_eq!(e.param, Some("frames"));
    }

    #[test]
    fn frames_begin_anew_on_another_mesh() {
        let cx = Context::quiet();
        let mut first = falling(0.02).run(&sheet(), None, &cx).unwrap();
        let motion =
            RecordedMotion { vertices: 3, triangles: vec![], ..first.motion.as_deref().unwrap().clone() };
        first.motion = Some(Arc::new(motion));
        cx.take_remarks();
        let second = falling(0.02).run(&first, None, &cx).unwrap();
        assert_eq!(second.motion.unwrap().len(), 6);
        let said = cx.take_remarks().warnings;
        assert_eq!(said[0], "the mesh was cut finer since the motion began: its frames begin anew here");
    }

    #[test]
    fn every_solver_in_time_records() {
        let time = super::super::InTime { longest: 0.05, frames: 0.01, ..Default::default() };
        let stage = ImplicitEuler { motion: time, ..ImplicitEuler::default() };
        let fallen = stage.run(&sheet(), None, None, &Context::quiet()).unwrap();
        assert_eq!(fallen.motion.unwrap().len(), 6);
    }
}
