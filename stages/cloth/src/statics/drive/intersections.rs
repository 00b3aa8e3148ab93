//! Intersection resolution for cloth that contact alone does not pull out of itself.
//!
//! Method: the intersection contours are minimised (see `contour`). If crossings are left, their
//! nodes and the rings of nodes around them are smoothed (Laplacian smoothing, Field 1988), which
//! flattens a knotted fold. Then the level is relaxed again from there. Each try takes more rings.
//! Cost: one more run from near rest a try. Limits: after the last try crossings may be left.

use crate::mesh::Sheet;
use crate::statics::drive::coarse_to_fine::{LevelMesh, Solve};
use crate::statics::drive::contour::uncross;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::newton::patience::{Patience, Shrinking};
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::{LevelReport, Progress};
use crate::statics::report::error::StaticsError;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Rings of nodes that are smoothed around the crossings, for each try.
const RINGS: [usize; 3] = [2, 4, 8];

/// Sweeps of smoothing a try.
const SWEEPS: usize = 30;

/// Steps within which the number of intersecting nodes must fall; otherwise the run ends.
const PATIENCE: Patience = Patience { steps: 25, share: 0.0 };

impl Solve<'_> {
    /// Relaxes a level. Where cloth that was sewn through itself still intersects itself, smooths
    /// it and relaxes it again.
    pub(crate) fn relax_uncrossed(
        &self,
        mesh: LevelMesh<'_>,
        system: &mut System<'_>,
        x: &mut [Vec3],
        options: &NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<LevelReport, StaticsError> {
        if !self.plan.settings.sew_through {
            return self.relax(mesh, system, x, options, &|_, _| false, progress);
        }
        let mut report = self.relax_until_stuck(mesh, system, x, options, progress)?;
        for rings in RINGS {
            if !system.is_intersecting() {
                break;
            }
            let tree = self.plan.tree(mesh.k, mesh.sheet, x, false);
            if uncross(mesh.sheet, &tree, &system.pinned, x) > 0 {
                smooth(mesh.sheet, x, &around(system, mesh.sheet, rings));
            }
            report = self.relax_until_stuck(mesh, system, x, options, progress)?;
        }
        Ok(report)
    }

    /// Relaxes a level until it is at rest, or the number of intersecting nodes falls no more.
    fn relax_until_stuck(
        &self,
        mesh: LevelMesh<'_>,
        system: &mut System<'_>,
        x: &mut [Vec3],
        options: &NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<LevelReport, StaticsError> {
        let shrinking = Shrinking::new(PATIENCE);
        let is_stuck = |system: &System<'_>, _: &[Vec3]| {
            let count = intersecting(system);
            !shrinking.goes_on(count as f64) && count > 0
        };
        self.relax(mesh, system, x, options, &is_stuck, progress)
    }
}

/// How many nodes are intersecting.
fn intersecting(system: &System<'_>) -> usize {
    system.get::<SelfContact>().map_or(0, |c| c.intersecting.iter().filter(|t| **t).count())
}

/// The intersecting nodes and so many rings of nodes around them, without pinned nodes.
fn around(system: &System<'_>, sheet: &Sheet, rings: usize) -> Vec<bool> {
    let mut chosen = system.get::<SelfContact>().map_or_else(Vec::new, |c| c.intersecting.clone());
    for _ in 0..rings {
        let inner = chosen.clone();
        for [a, b] in sheet.edges().iter().map(|e| e.vertices.map(|v| v as usize)) {
            chosen[a] |= inner[b];
            chosen[b] |= inner[a];
        }
    }
    chosen.iter_mut().zip(&system.pinned).for_each(|(c, p)| *c &= !p);
    chosen
}

/// Moves the chosen nodes to the mean of their neighbours, sweep by sweep.
fn smooth(sheet: &Sheet, x: &mut [Vec3], chosen: &[bool]) {
    for _ in 0..SWEEPS {
        let mut sums = vec![(Vec3::zeros(), 0.0); x.len()];
        for [a, b] in sheet.edges().iter().map(|e| e.vertices.map(|v| v as usize)) {
            for (to, from) in [(a, b), (b, a)] {
                sums[to].0 += x[from];
                sums[to].1 += 1.0;
            }
        }
        for ((p, (sum, count)), _) in x.iter_mut().zip(&sums).zip(chosen).filter(|(_, c)| **c) {
            if *count > 0.0 {
                *p = sum / *count;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::generate;
    use crate::statics::levels::assemble::cloths;
    use crate::statics::levels::pieces::Pieces;
    use toile_geometry::cloth_tree::ClothTree;

    #[test]
    fn a_knot_is_smoothed_away_and_the_cloth_around_it_stays() {
        let scene = generate::drape(12);
        let sheet = Pieces::new(&scene).sewn_sheet(&cloths(&scene)).unwrap();
        let flat = scene.positions.clone();
        let tree = ClothTree::new(sheet.triangles(), &flat);
        let mut x = flat.clone();
        // A vertex pulled over the next cells and down through them.
        let knot = 6 * 13 + 6;
        x[knot] = (flat[knot + 2] + flat[knot + 3] + flat[knot + 15]) / 3.0 - Vec3::y() * 0.01;
        x[knot + 1] += Vec3::y() * 0.02;
        assert!(!tree.crossings(&x).is_empty());
        let mut chosen = vec![false; x.len()];
        for row in 4..=8 {
            (4..=10).for_each(|c| chosen[row * 13 + c] = true);
        }
        smooth(&sheet, &mut x, &chosen);
        assert!(tree.crossings(&x).is_empty());
        let kept = x.iter().zip(&flat).zip(&chosen).filter(|(_, c)| !**c);
        assert!(kept.clone().count() > 100 && kept.into_iter().all(|((x, p), _)| x == p));
    }
}
