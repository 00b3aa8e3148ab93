//! A tree of boxes over things that stand still: what of them lies about a place.

use super::{Bounds, Branch};
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The boxes of a tree whose leaves hold things in the order of the tree.
#[derive(Debug, Clone)]
pub(in crate::contact) struct Over {
    branches: Vec<Branch>,
    boxes: Vec<Bounds>,
}

impl Over {
    /// The boxes over things of which `bounds` tells each.
    pub(in crate::contact) fn new(branches: Vec<Branch>, bounds: impl Fn(u32) -> Bounds) -> Self {
        let mut boxes = vec![Bounds { low: Vec3::zeros(), high: Vec3::zeros() }; branches.len()];
        for (k, b) in branches.iter().enumerate().rev() {
            boxes[k] = match b.count {
                0 => boxes[b.first as usize].with(&boxes[b.first as usize + 1]),
                n => (b.first + 1..b.first + n).fold(bounds(b.first), |all, f| all.with(&bounds(f))),
            };
        }
        Self { branches, boxes }
    }

    /// Visits everything in the leaves whose boxes meet `around`, in the order of the tree.
    pub(in crate::contact) fn within(&self, around: &Bounds, mut visit: impl FnMut(u32)) {
        // The tree is as deep as the logarithm of its size.
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.boxes.is_empty());
        while depth > 0 {
            depth -= 1;
            let k = stack[depth] as usize;
            if !self.boxes[k].meets(around) {
                continue;
            }
            let branch = self.branches[k];
            if branch.count == 0 {
                (stack[depth], stack[depth + 1]) = (branch.first + 1, branch.first);
                depth += 2;
                continue;
            }
            (branch.first..branch.first + branch.count).for_each(&mut visit);
        }
    }
}
