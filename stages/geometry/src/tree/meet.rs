//! Which things of a tree are near each other: the tree against itself.
//!
//! A part meets itself where its children do, and where one child meets the other (Gottschalk, Lin,
//! Manocha 1996 for two trees). Parts run side by side; what they find is put together in their
//! order, whatever the number of threads.

use super::VolumeTree;
use crate::volume::BoundingVolume;
use std::ops::Range;

/// Levels of the tree below which a part is one task.
const TASK_LEVELS: u32 = 6;

/// What two things are compared by, and what is to be made of those that are near each other.
pub struct Meeting<'m, V, T> {
    /// Volumes of the parts.
    pub parts: &'m [V],
    /// Volumes of the things.
    pub things: &'m [V],
    /// How near they must be.
    pub reach: f64,
    /// Which parts and which things look for others; without it all do. Two of which neither looks
    /// are passed over.
    pub active: Option<(&'m [bool], &'m [bool])>,
    /// Told of every two things whose volumes are within reach, the earlier one first.
    pub visit: &'m (dyn Fn(usize, usize, &mut Vec<T>) + Sync),
}

impl VolumeTree {
    /// What `visit` adds for every two things that are near each other; the order depends on the
    /// tree alone.
    pub fn meetings<V: BoundingVolume, T: Send>(&self, meeting: &Meeting<'_, V, T>) -> Vec<T> {
        let mut found = Vec::new();
        if !self.is_empty() {
            TreeWalk { tree: self, meeting }.itself(0, TASK_LEVELS, &mut found);
        }
        found
    }
}

struct TreeWalk<'w, V, T> {
    tree: &'w VolumeTree,
    meeting: &'w Meeting<'w, V, T>,
}

impl<V: BoundingVolume, T: Send> TreeWalk<'_, V, T> {
    /// Whether neither of two parts looks for others.
    fn sleep(&self, a: u32, b: u32) -> bool {
        self.meeting.active.is_some_and(|(parts, _)| !parts[a as usize] && !parts[b as usize])
    }

    fn itself(&self, k: u32, levels: u32, out: &mut Vec<T>) {
        if self.sleep(k, k) {
            return;
        }
        let Some((a, b)) = self.tree.children(k) else {
            return self.in_leaf(self.tree.leaf(k), out);
        };
        let next = levels.saturating_sub(1);
        both(
            levels,
            out,
            |out| self.itself(a, next, out),
            |out| both(levels, out, |out| self.itself(b, next, out), |out| self.other(a, b, next, out)),
        );
    }

    /// The part `a` against `b`, which comes after it.
    fn other(&self, a: u32, b: u32, levels: u32, out: &mut Vec<T>) {
        let volumes = self.meeting.parts;
        if self.sleep(a, b) || !volumes[a as usize].near(&volumes[b as usize], self.meeting.reach) {
            return;
        }
        let next = levels.saturating_sub(1);
        let each = |pairs: [(u32, u32); 2]| {
            move |out: &mut Vec<T>| pairs.into_iter().for_each(|(a, b)| self.other(a, b, next, out))
        };
        match (self.tree.children(a), self.tree.children(b)) {
            (Some((a, b)), Some((c, d))) => both(levels, out, each([(a, c), (a, d)]), each([(b, c), (b, d)])),
            (Some((l, r)), None) => each([(l, b), (r, b)])(out),
            (None, Some((l, r))) => each([(a, l), (a, r)])(out),
            (None, None) => self.leaves(self.tree.leaf(a), &self.tree.leaf(b), out),
        }
    }

    fn leaves(&self, left: Range<usize>, right: &Range<usize>, out: &mut Vec<T>) {
        for s in left {
            right.clone().for_each(|t| self.test(s, t, out));
        }
    }

    fn in_leaf(&self, leaf: Range<usize>, out: &mut Vec<T>) {
        for s in leaf.clone() {
            (s + 1..leaf.end).for_each(|t| self.test(s, t, out));
        }
    }

    fn test(&self, s: usize, t: usize, out: &mut Vec<T>) {
        let Meeting { things, reach, active, visit, .. } = self.meeting;
        if things[s].near(&things[t], *reach) && !active.is_some_and(|(_, looks)| !looks[s] && !looks[t]) {
            visit(s, t, out);
        }
    }
}

/// Both, one after the other or side by side: the same order of what they find.
fn both<T: Send>(
    levels: u32,
    out: &mut Vec<T>,
    first: impl FnOnce(&mut Vec<T>) + Send,
    second: impl FnOnce(&mut Vec<T>) + Send,
) {
    if levels == 0 {
        first(out);
        return second(out);
    }
    let mut found = Vec::new();
    rayon::join(|| first(out), || second(&mut found));
    out.append(&mut found);
}
