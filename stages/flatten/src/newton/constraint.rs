//! Equality constraints on flat places, as shares without unit.

use nalgebra::{Point2, Vector2};

/// One equation that the flat places fulfil.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Constraint {
    /// The length of a chain of vertices, `length / target = 1`.
    ChainLength {
        /// The vertices, in order.
        vertices: Vec<u32>,
        /// Its length, in units of length of the problem, above 0.
        target: f64,
        /// What x and y are multiplied with before lengths are taken: the cloth relaxed from its
        /// tension.
        scale: Vector2<f64>,
    },
    /// A weighted sum of places has no part along `direction`: the mean grain stays upright.
    Balance {
        /// Vertices and their weights.
        weights: Vec<(u32, f64)>,
        /// The direction, unit length.
        direction: Vector2<f64>,
    },
}

impl Constraint {
    pub(super) fn value(&self, q: &[Point2<f64>]) -> f64 {
        match self {
            Self::ChainLength { vertices, target, scale } => {
                let length = |w: &[u32]| (q[w[1] as usize] - q[w[0] as usize]).component_mul(scale).norm();
                vertices.windows(2).map(length).sum::<f64>() / target - 1.0
            }
            Self::Balance { weights, direction } => {
                weights.iter().map(|(v, w)| w * q[*v as usize].coords.dot(direction)).sum()
            }
        }
    }

    pub(super) fn gradient(&self, q: &[Point2<f64>], add: &mut dyn FnMut(u32, Vector2<f64>)) {
        match self {
            Self::ChainLength { vertices, target, scale } => {
                for w in vertices.windows(2) {
                    let along = (q[w[1] as usize] - q[w[0] as usize]).component_mul(scale);
                    let pull = along.component_mul(scale) / (along.norm().max(f64::MIN_POSITIVE) * target);
                    add(w[1], pull);
                    add(w[0], -pull);
                }
            }
            Self::Balance { weights, direction } => {
                weights.iter().for_each(|(v, w)| add(*v, direction * *w));
            }
        }
    }
}

/// The length of the line through these vertices.
pub(crate) fn chain_length(vertices: &[u32], q: &[Point2<f64>]) -> f64 {
    vertices.windows(2).map(|w| (q[w[1] as usize] - q[w[0] as usize]).norm()).sum()
}
