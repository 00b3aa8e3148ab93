//! Which of several starts a garment is sewn from.
//!
//! Method: a placement that moved pieces by a rule leaves the other starts that the rule chose
//! against. Where the first does not sew cleanly on the coarsest mesh, each of the others is sewn
//! on it, too, and the best goes on. Cost: some tenths of a second a start, and nothing where the
//! garment has no other. Limits: what only a finer mesh can follow is not seen.

use nalgebra::Vector3;
use rayon::prelude::*;
use toile_cloth::scene::Scene;
use toile_cloth::statics::drive::solve::{Collider as EngineCollider, StaticEquilibrium as Solver};
use toile_cloth::statics::drive::trial::StartTrial;
use toile_cloth::stopper::Stopper;
use toile_core::prelude::*;

/// The first start in words.
const PLACED: &str = "as the pieces are placed";

/// The scene with its vertices at the start that sews best; what was tried is noted.
pub(super) fn at_the_best(
    mut scene: Scene,
    garment: &Garment,
    solver: &Solver,
    collider: Option<EngineCollider<'_>>,
    stopper: &Stopper,
    cx: &Context,
) -> Result<Scene, StageError> {
    let tried = |scene: &Scene| solver.try_start(scene, collider, &[], stopper).ok();
    if garment.starts.is_empty() {
        return Ok(scene);
    }
    let first = tried(&scene);
    cx.check()?;
    if first.is_some_and(|trial| trial.is_clean()) {
        return Ok(scene);
    }
    let positions =
        |start: &GarmentStart| -> Vec<Vector3<f64>> { start.positions.iter().map(|p| p.coords).collect() };
    let others: Vec<Option<StartTrial>> = garment
        .starts
        .par_iter()
        .map(|start| tried(&Scene { positions: positions(start), ..scene.clone() }))
        .collect();
    cx.check()?;
    let all: Vec<(&str, Option<StartTrial>)> = std::iter::once((PLACED, first))
        .chain(garment.starts.iter().map(|s| s.told.as_str()).zip(others))
        .collect();
    let best = best(&all);
    cx.note(told(&all, best));
    if let Some(start) = best.checked_sub(1).and_then(|k| garment.starts.get(k)) {
        scene.positions = positions(start);
    }
    Ok(scene)
}

/// The number of the best trial; the first of those that are alike.
fn best(all: &[(&str, Option<StartTrial>)]) -> usize {
    let better = |a: Option<StartTrial>, b: Option<StartTrial>| match (a, b) {
        (Some(a), Some(b)) => a.is_better(&b),
        (one, other) => one.is_some() && other.is_none(),
    };
    (1..all.len()).fold(0, |best, k| if better(all[k].1, all[best].1) { k } else { best })
}

fn told(all: &[(&str, Option<StartTrial>)], best: usize) -> String {
    let one = |(k, (name, trial)): (usize, &(&str, Option<StartTrial>))| {
        let result = match trial {
            None => "it cannot be sewn".to_owned(),
            Some(t) if t.gap > 0.0 => format!("a seam stays {:.0} mm open", t.gap * 1e3),
            Some(t) if t.crossings + t.pierced > 0 => {
                format!("all seams close, {} pairs cross, the body comes through {}", t.crossings, t.pierced)
            }
            Some(_) => "all seams close and nothing crosses".to_owned(),
        };
        let sunk = trial.filter(|t| t.has_sunk()).map(|t| format!(", it sinks by {:.0} mm", t.sunk * 1e3));
        let taken = if k == best { "; taken" } else { "" };
        format!("{name}: {result}{}{taken}", sunk.unwrap_or_default())
    };
    let lines: Vec<String> = all.iter().enumerate().map(one).collect();
    format!("{} starts were sewn on a coarse mesh. {}", all.len(), lines.join(". "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(gap: f64, crossings: usize) -> Option<StartTrial> {
        Some(StartTrial { gap, crossings, pierced: 0, sunk: 0.0 })
    }

    #[test]
    fn the_start_whose_seams_close_and_where_nothing_crosses_is_taken() {
        let best_of = |all: &[Option<StartTrial>]| best(&all.iter().map(|t| ("", *t)).collect::<Vec<_>>());
        assert_eq!(best_of(&[trial(0.072, 0), trial(0.0, 4)]), 1);
        assert_eq!(best_of(&[trial(0.0, 4), trial(0.0, 0)]), 1);
        assert_eq!(best_of(&[trial(0.0, 4), trial(0.0, 2)]), 0, "how much crosses is chance");
        assert_eq!(best_of(&[trial(0.0, 0), trial(0.0, 0)]), 0, "the first of those alike");
        assert_eq!(best_of(&[None, trial(0.4, 0)]), 1);
        assert_eq!(best_of(&[trial(0.075, 0), trial(0.072, 0)]), 0, "3 mm are chance");
        let sunk = trial(0.0, 0).map(|t| StartTrial { sunk: 0.2, ..t });
        assert_eq!(
            best_of(&[sunk, trial(0.0, 4)]),
            1,
            "what slides off the shoulders is worse than crossings"
        );
        assert_eq!(best_of(&[sunk, trial(0.1, 0)]), 1, "nearer to its place");
        assert_eq!(best_of(&[sunk, trial(0.3, 0)]), 0);
        assert_eq!(best_of(&[trial(0.0, 9), trial(0.0, 5)]), 0, "the difference is chance");
        assert_eq!(best_of(&[trial(0.0, 9), trial(0.0, 4)]), 1);
    }

    #[test]
    fn what_was_tried_is_told() {
        let all = [(PLACED, trial(0.072, 0)), ("with the legs where the file puts them", trial(0.0, 0))];
        assert_eq!(
            told(&all, 1),
            "2 starts were sewn on a coarse mesh. as the pieces are placed: a seam stays 72 mm open. \
             with the legs where the file puts them: all seams close and nothing crosses; taken"
        );
        let sunk = trial(0.0, 3).map(|t| StartTrial { sunk: 0.2, ..t });
        assert_eq!(
            told(&[(PLACED, sunk), ("closed", trial(0.0, 0))], 1),
            "2 starts were sewn on a coarse mesh. as the pieces are placed: all seams close, 3 pairs cross, the body comes through 0, \
             it sinks by 200 mm. closed: all seams close and nothing crosses; taken"
        );
    }
}
