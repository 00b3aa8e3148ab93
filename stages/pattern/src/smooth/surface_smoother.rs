//! `SurfaceSmoother`: a garment in space, smoothed by the distances of its vertices to their mean
//! planes.

use super::surface::{PlaneSmoothing, smooth_to_planes};
use toile_core::prelude::*;

/// Smooths a garment in space: each vertex goes along the normal of its neighbours' mean plane
/// until it is as far from it as they are from theirs, so that wrinkles as short as the mesh's
/// edges go and even curves stay.
///
/// Where seams are joined the surface is one. Pinned vertices stay, and so do corners of the
/// border. Lengths are not kept, cloth leaves its rest, and what lies on the body may come into it:
/// look at strain and crossings, or put a draper behind it.
#[stage(
    role = Smoother,
    source = "thesis on 3D garment modelling from photos, 2012",
    example = "SurfaceSmoother(lambda: 0.5)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct SurfaceSmoother {
    /// Share of the way that a vertex goes in a round.
    #[param(default = 0.5, min = 0.0, max = 0.8)]
    lambda: f64,
    /// Number of rounds.
    #[param(default = 3, min = 0, max = 1000, trades, finer = "more")]
    iterations: u32,
    /// True where borders stay: hems, necklines, and the sides of seams that are still open.
    #[param(default = true)]
    hold_border: bool,
}

#[stage]
impl SurfaceSmoother {
    pub(crate) fn run(&self, garment: &Garment, cx: &Context) -> Result<Garment, StageError> {
        garment.check_solvable()?;
        let triangles: Vec<[u32; 3]> =
            garment.triangles.iter().map(|t| t.map(|v| garment.weld[v as usize])).collect();
        let how = PlaneSmoothing { lambda: self.lambda, rounds: 1, hold_border: self.hold_border };
        let mut stays = vec![false; garment.positions.len()];
        garment.pinned.iter().for_each(|v| stays[garment.weld[*v as usize] as usize] = true);
        let mut points = garment.positions.clone();
        for _ in 0..self.iterations {
            cx.check()?;
            let smoothed = smooth_to_planes(&points, &triangles, how);
            for v in 0..points.len() {
                let one = garment.weld[v] as usize;
                points[v] = if stays[one] { points[one] } else { smoothed[one] };
            }
        }
        let moved = points.iter().zip(&garment.positions).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
        cx.figure("moved", moved * 1e3, "mm");
        Ok(Garment { velocities: vec![Vector3::zeros(); points.len()], positions: points, ..garment.clone() })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use toile_core::testkit::dress;

    fn smoothed(garment: &Garment, hold_border: bool) -> Garment {
        SurfaceSmoother { lambda: 0.5, iterations: 5, hold_border }.run(garment, &Context::quiet()).unwrap()
    }

    /// The garment, a tube, with every other vertex farther from its axis by a hundredth.
    fn wrinkled() -> Garment {
        let mut garment = dress::sewn_garment();
        for (at, one) in garment.positions.iter_mut().zip(&garment.weld) {
            let wider = if one % 2 == 0 { 1.01 } else { 1.0 };
            (at.x, at.z) = (at.x * wider, at.z * wider);
        }
        garment
    }

    #[test]
    fn cloth_moves_and_seams_stay_closed() {
        let made = smoothed(&wrinkled(), true);
        assert_ne!(made.positions, wrinkled().positions);
        let is_one = |(v, w): (usize, &u32)| made.positions[v] == made.positions[*w as usize];
        assert!(made.weld.iter().enumerate().all(is_one));
        assert_eq!(made.velocities.len(), made.positions.len());
    }

    #[test]
    fn pinned_vertices_and_held_borders_stay() {
        let mut garment = wrinkled();
        garment.pinned = vec![0];
        let made = smoothed(&garment, false);
        assert_eq!(made.positions[0], garment.positions[0]);
        let before = wrinkled();
        let held = smoothed(&before, true);
        let joined = |v: u32| before.weld.iter().filter(|w| **w == before.weld[v as usize]).count() > 1;
        for panel in &before.panels {
            for v in panel.boundary.iter().filter(|v| !joined(**v)) {
                assert_eq!(held.positions[*v as usize], before.positions[*v as usize]);
            }
        }
    }
}
