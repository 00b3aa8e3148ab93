//! A solid that a garment is sewn on before the body comes, in two parts: what is worn on the arms is kept out of the arms alone, all other
//! cloth out of the trunk alone. So seams close beside an arm that a sleeve is around.

use super::pieces::Pieces;
use super::plan::Plan;
use super::start::{StartError, moved_out};
use crate::contact::skin::Skin;
use crate::scene::Scene;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Trunk with legs, and arms.
#[derive(Debug, Clone, Copy)]
pub struct Form<'a> {
    /// Trunk and legs.
    pub trunk: &'a dyn Skin,
    /// The arms, if there are any.
    pub arms: Option<&'a dyn Skin>,
    /// How far trunk and arms stand from where those of the body are, m.
    pub shift: Vec3,
}

/// Which vertices of a scene are of panels that start nearer to the arms than to the trunk, in the mean.
pub(super) fn on_arms(scene: &Scene, form: &Form<'_>) -> Vec<bool> {
    let mut found = vec![false; scene.positions.len()];
    let Some(arms) = form.arms else { return found };
    for panel in &scene.panels {
        let points = &scene.positions[panel.vertices.clone()];
        let far = |skin: &dyn Skin| -> f64 {
            let near = skin.nearest(points, &vec![f64::INFINITY; points.len()]);
            near.iter().flatten().map(|n| n.distance.abs()).sum()
        };
        found[panel.vertices.clone()].fill(far(arms) < far(form.trunk));
    }
    found
}

/// Where the vertices start, those inside what keeps them out moved to its nearest point, what is on the arms along with them.
///
/// # Errors
/// As for [`moved_out`].
pub(super) fn start<E: From<StartError>>(
    scene: &Scene,
    form: &Form<'_>,
    on_arms: &[bool],
    join_gap: f64,
) -> Result<Vec<Vec3>, E> {
    let mut start = moved_out::<E>(scene, &scene.positions, Some(form.trunk), join_gap)?;
    if let Some(arms) = form.arms {
        let along: Vec<Vec3> = scene.positions.iter().map(|p| p + form.shift).collect();
        let out = moved_out::<E>(scene, &along, Some(arms), join_gap)?;
        start.iter_mut().zip(out).zip(on_arms).filter(|(_, on)| **on).for_each(|((p, out), _)| *p = out);
    }
    Ok(start)
}

impl Plan<'_> {
    /// Which nodes of level `k`, sewn or open, are on the arms: a seam between arm and trunk is not.
    pub(super) fn nodes_on_arms(&self, k: usize, open: bool) -> Vec<bool> {
        let pieces: &Pieces = &self.pieces[k];
        let of = |v: usize| self.on_arms[self.finest_of(k, v as u32) as usize];
        let vertices = 0..pieces.rest.len();
        if open {
            return vertices.map(of).collect();
        }
        let mut nodes = vec![true; pieces.nodes];
        for v in vertices {
            nodes[pieces.node[v] as usize] &= of(v);
        }
        nodes
    }
}
