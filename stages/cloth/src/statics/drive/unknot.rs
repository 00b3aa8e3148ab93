//! Knots: cloth that crosses itself in a few places, and that its contacts do not take out of
//! itself.
//!
//! Method: the contours along which it crosses itself are shortened (see `contour`). Where that
//! leaves some, the nodes of what crosses, and the rings of nodes around them, move to the mean of
//! their neighbours again and again (Laplacian smoothing, Field 1988), which lays a fold that is
//! knotted flat. Then cloth comes to rest from there. Each try takes more rings. Cost: one more run
//! from near rest a try.

use crate::mesh::Sheet;
use crate::statics::drive::coarse_to_fine::Solve;
use crate::statics::drive::contour::uncross;
use crate::statics::forces::system::System;
use crate::statics::newton::patience::Patience;
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::{LevelReport, Progress};
use crate::statics::report::error::StaticsError;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Rings of nodes that are smoothed around what crosses, for each try.
const RINGS: [usize; 3] = [2, 4, 8];

/// How often they move to the mean of their neighbours.
const SWEEPS: usize = 30;

/// Steps in which some of the tangled nodes must come free; else they do not.
const PATIENCE: usize = 25;

impl Solve<'_> {
    /// Runs one level, and where cloth that was sewn through itself stays knotted, smooths the
    /// knots and runs it again.
    pub(crate) fn relax_uncrossed(
        &self,
        system: &mut System<'_>,
        sheet: &Sheet,
        layout: &[Vec3],
        x: &mut [Vec3],
        options: &NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<LevelReport, StaticsError> {
        if !self.plan.settings.sew_through {
            return self.relax(system, sheet, layout, x, options, &|_, _| false, progress);
        }
        let mut report = self.relax_until_stuck(system, sheet, layout, x, options, progress)?;
        for rings in RINGS {
            if !system.is_intersecting() {
                break;
            }
            if uncross(sheet, &self.plan.tree(sheet, x, false), &system.pinned, x) > 0 {
                smooth(sheet, x, &around(system, sheet, rings));
            }
            report = self.relax_until_stuck(system, sheet, layout, x, options, progress)?;
        }
        Ok(report)
    }

    /// Runs one level to rest, or until tangled nodes come free no more.
    fn relax_until_stuck(
        &self,
        system: &mut System<'_>,
        sheet: &Sheet,
        layout: &[Vec3],
        x: &mut [Vec3],
        options: &NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<LevelReport, StaticsError> {
        let patience = Patience::new((PATIENCE, 0.0));
        let is_stuck = |system: &System<'_>, _: &[Vec3]| {
            let count = tangled(system);
            !patience.goes_on(count as f64) && count > 0
        };
        self.relax(system, sheet, layout, x, options, &is_stuck, progress)
    }
}

/// How many nodes are tangled.
fn tangled(system: &System<'_>) -> usize {
    system.self_contact.as_ref().map_or(0, |c| c.intersecting.iter().filter(|t| **t).count())
}

/// The tangled nodes and so many rings of nodes around them, but for those that are pinned.
fn around(system: &System<'_>, sheet: &Sheet, rings: usize) -> Vec<bool> {
    let mut knotted = system.self_contact.as_ref().map_or_else(Vec::new, |c| c.intersecting.clone());
    for _ in 0..rings {
        let inner = knotted.clone();
        for [a, b] in sheet.edges().iter().map(|e| e.vertices.map(|v| v as usize)) {
            knotted[a] |= inner[b];
            knotted[b] |= inner[a];
        }
    }
    knotted.iter_mut().zip(&system.pinned).for_each(|(k, p)| *k &= !p);
    knotted
}

/// Moves the chosen nodes to the mean of their neighbours, again and again.
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
