//! Seam closing forces, while a garment is sewn.
//!
//! The potential of a pair at gap `d` is `f sqrt(d² + s²)`, whose force is nearly constant above
//! the softening length `s`. Cost: O(1) a pair.

use crate::energy::Subset;
use crate::linear::{Pattern, add_at};
use crate::statics::forces::force::Force;
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// The closing force of one pair of nodes, which hardly depends on the gap.
#[derive(Debug, Clone, Copy)]
pub struct SeamForce {
    /// The nodes.
    pub nodes: [u32; 2],
    /// Force at large gaps, N.
    pub force: f64,
    /// Gap below which the force falls, m.
    pub softening: f64,
}

impl SeamForce {
    fn reach(&self, x: &[Vec3]) -> (Vec3, f64) {
        let d = x[self.nodes[1] as usize] - x[self.nodes[0] as usize];
        (d, (d.norm_squared() + self.softening * self.softening).sqrt())
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        self.force * self.reach(x).1
    }

    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        let (d, r) = self.reach(x);
        let pull = d * (self.force / r);
        g[self.nodes[0] as usize] -= pull;
        g[self.nodes[1] as usize] += pull;
    }

    fn add_matrix(&self, x: &[Vec3], pattern: &Pattern, values: &mut [Matrix3<f64>]) {
        let [i, j] = self.nodes;
        let (_, r) = self.reach(x);
        // The secant stiffness bounds the second derivative, so that Newton's step never
        // overshoots.
        let k = Matrix3::identity() * (self.force / r);
        values[i as usize] += k;
        values[j as usize] += k;
        if let Some(slot) = pattern.slot(i, j) {
            add_at(values, slot, &-k);
        }
    }
}

/// The closing forces of all seams.
#[derive(Debug, Clone)]
pub struct SeamForces(pub Vec<SeamForce>);

impl SeamForces {
    /// The widest gap of seams with a closing force, m.
    pub(crate) fn widest(&self, x: &[Vec3]) -> f64 {
        self.0.iter().map(|t| (x[t.nodes[0] as usize] - x[t.nodes[1] as usize]).norm()).fold(0.0, f64::max)
    }
}

impl Force for SeamForces {
    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn couplings(&self, visit: &mut dyn FnMut(&[u32])) {
        self.0.iter().for_each(|t| visit(&t.nodes));
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        self.0.iter().map(|t| t.value(x)).sum()
    }

    fn add_gradient(&self, x: &[Vec3], g: &mut [Vec3]) {
        self.0.iter().for_each(|t| t.add_gradient(x, g));
    }

    fn add_matrix(&self, x: &[Vec3], pattern: &Pattern, values: &mut [Matrix3<f64>]) {
        self.0.iter().for_each(|t| t.add_matrix(x, pattern, values));
    }

    fn restrict(&self, cut: &Subset) -> Box<dyn Force> {
        let touched = self.0.iter().filter(|t| cut.touches(&t.nodes));
        Box::new(Self(touched.map(|t| SeamForce { nodes: cut.renumbered(t.nodes), ..*t }).collect()))
    }
}

/// The widest gap of pairs of vertices, m.
pub(crate) fn widest(x: &[Vec3], pairs: &[[u32; 2]]) -> f64 {
    pairs.iter().map(|p| (x[p[0] as usize] - x[p[1] as usize]).norm()).fold(0.0, f64::max)
}
