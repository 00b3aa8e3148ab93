//! The published seam force: two points of a seam attract each other in proportion to their
//! distance, `f = c d`, `E = c d² / 2` (Fan, Zhou, Wang, Yuen, 1999). Cost: O(1) a pair. Limit: the
//! pull fades as the points come near, so cloth under tension keeps a gap.

use super::{Assembled, Blocks, Element, Projection, Subset, Vec3, add_block_of};
use nalgebra::Matrix3;

/// Pairs of nodes that attract each other, all with one stiffness.
#[derive(Debug, Clone, PartialEq)]
pub struct SeamSprings {
    pairs: Vec<[u32; 2]>,
    stiffness: f64,
}

impl SeamSprings {
    /// The energy of these pairs; stiffness in N/m.
    #[must_use]
    pub fn new(pairs: Vec<[u32; 2]>, stiffness: f64) -> Assembled<2, Self> {
        Assembled(Self { pairs, stiffness })
    }
}

impl Element<2> for SeamSprings {
    type State = Blocks<2>;

    fn name(&self) -> &'static str {
        "seam force"
    }

    fn count(&self) -> usize {
        self.pairs.len()
    }

    fn nodes(&self, e: usize) -> [u32; 2] {
        self.pairs[e]
    }

    fn value(&self, _: usize, x: &[Vec3; 2]) -> f64 {
        0.5 * self.stiffness * (x[1] - x[0]).norm_squared()
    }

    fn gradient(&self, _: usize, x: &[Vec3; 2]) -> [Vec3; 2] {
        let pull = (x[1] - x[0]) * self.stiffness;
        [-pull, pull]
    }

    fn state(&self, _: usize, _: &[Vec3; 2], _: Projection) -> Blocks<2> {
        let block = Matrix3::identity() * self.stiffness;
        [[block, -block], [-block, block]]
    }

    fn add_block(&self, _: usize, state: &Blocks<2>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        add_block_of(state, row, column, sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let pairs = elements.iter().map(|&e| subset.renumbered(self.pairs[e])).collect();
        Self { pairs, stiffness: self.stiffness }
    }
}
