//! Which triangles' boxes meet: the tree against itself.
//!
//! A branch meets itself where its children do, and where one child meets the other (Gottschalk, Lin, Manocha 1996 for two
//! trees). Branches run side by side; what they find is put together in their order, whatever the number of threads.

use super::{Awake, Bounds, ClothTree};

/// Levels of the tree below which a branch is one task.
const TASK_LEVELS: u32 = 6;

/// The boxes of triangles and of branches, and what is to be made of two triangles whose boxes meet.
struct Meeting<'m, T> {
    tree: &'m ClothTree,
    awake: Option<&'m Awake>,
    boxes: &'m [Bounds],
    fitted: &'m [Bounds],
    visit: &'m (dyn Fn(usize, usize, &mut Vec<T>) + Sync),
}

impl ClothTree {
    /// What `visit` adds for every pair of triangles whose boxes meet, the earlier one first; where not all look for others,
    /// of those that do.
    pub(super) fn meetings<T: Send>(
        &self,
        awake: Option<&Awake>,
        boxes: &[Bounds],
        fitted: &[Bounds],
        visit: &(dyn Fn(usize, usize, &mut Vec<T>) + Sync),
    ) -> Vec<T> {
        let mut found = Vec::new();
        Meeting { tree: self, awake, boxes, fitted, visit }.itself(0, TASK_LEVELS, &mut found);
        found
    }
}

impl<T: Send> Meeting<'_, T> {
    /// Whether neither of two branches looks for others.
    fn sleep(&self, a: u32, b: u32) -> bool {
        self.awake.is_some_and(|w| w.sleep(a, b))
    }

    fn itself(&self, k: u32, levels: u32, out: &mut Vec<T>) {
        if self.sleep(k, k) {
            return;
        }
        let branch = self.tree.branches[k as usize];
        if branch.count > 0 {
            return self.within(branch.first, branch.first + branch.count, out);
        }
        let (a, b) = (branch.first, branch.first + 1);
        let next = levels.saturating_sub(1);
        self.both(
            levels,
            out,
            |out| self.itself(a, next, out),
            |out| {
                self.both(levels, out, |out| self.itself(b, next, out), |out| self.other(a, b, next, out));
            },
        );
    }

    /// The branch `a` against `b`, which comes after it.
    fn other(&self, a: u32, b: u32, levels: u32, out: &mut Vec<T>) {
        if self.sleep(a, b) || !self.fitted[a as usize].meets(&self.fitted[b as usize]) {
            return;
        }
        let (left, right) = (self.tree.branches[a as usize], self.tree.branches[b as usize]);
        let next = levels.saturating_sub(1);
        match (left.count, right.count) {
            (0, 0) => {
                let [a, b, c, d] = [left.first, left.first + 1, right.first, right.first + 1];
                self.both(
                    levels,
                    out,
                    |out| {
                        self.other(a, c, next, out);
                        self.other(a, d, next, out);
                    },
                    |out| {
                        self.other(b, c, next, out);
                        self.other(b, d, next, out);
                    },
                );
            }
            (0, _) => {
                self.other(left.first, b, next, out);
                self.other(left.first + 1, b, next, out);
            }
            (_, 0) => {
                self.other(a, right.first, next, out);
                self.other(a, right.first + 1, next, out);
            }
            (n, m) => {
                for s in left.first..left.first + n {
                    for t in right.first..right.first + m {
                        self.test(s, t, out);
                    }
                }
            }
        }
    }

    fn within(&self, first: u32, end: u32, out: &mut Vec<T>) {
        for s in first..end {
            for t in s + 1..end {
                self.test(s, t, out);
            }
        }
    }

    fn test(&self, s: u32, t: u32, out: &mut Vec<T>) {
        let (s, t) = (s as usize, t as usize);
        if self.boxes[s].meets(&self.boxes[t]) && !self.awake.is_some_and(|w| w.are_still(s, t)) {
            (self.visit)(s, t, out);
        }
    }

    /// Both, one after the other or side by side: the same order of what they find.
    fn both(
        &self,
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
}
