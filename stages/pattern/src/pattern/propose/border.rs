//! The free edges around what is sewn so far.
//!
//! Every free edge knows the free edge that follows it, across the seams that end there, and the
//! angle of cloth at its start. Cost of a seam: constant.

use super::sheet::Sheet;

/// The state of the edges while seams are taken.
#[derive(Debug, Clone)]
pub(super) struct Border {
    pub(super) free: Vec<bool>,
    pub(super) next: Vec<usize>,
    pub(super) last: Vec<usize>,
    /// The cloth at the start of the edge, degrees.
    pub(super) angle: Vec<f64>,
    /// Whether a seam ends at the start of the edge.
    pub(super) crosses: Vec<bool>,
    /// The part of the garment that a piece belongs to, as the number of one of its pieces.
    group: Vec<usize>,
}

impl Border {
    pub(super) fn of(sheet: &Sheet) -> Self {
        let n = sheet.edges.len();
        let mut last = vec![0; n];
        sheet.next.iter().enumerate().for_each(|(e, after)| last[*after] = e);
        Border {
            free: vec![true; n],
            next: sheet.next.clone(),
            last,
            angle: sheet.angle.clone(),
            crosses: vec![false; n],
            group: (0..sheet.boxes.len()).collect(),
        }
    }

    /// Sews a run of edges to another, both counter-clockwise: the start of one meets the end of
    /// the other.
    pub(super) fn sew(&mut self, sheet: &Sheet, a: &[usize], b: &[usize]) {
        let ([Some(&a0), Some(&a1)], [Some(&b0), Some(&b1)]) = ([a.first(), a.last()], [b.first(), b.last()])
        else {
            return;
        };
        let (before_a, before_b) = (self.last[a0], self.last[b0]);
        let (after_a, after_b) = (self.next[a1], self.next[b1]);
        a.iter().chain(b).for_each(|e| self.free[*e] = false);
        let (at_a, at_b) = (self.angle[a0], self.angle[b0]);
        match (before_a == a1, before_b == b1) {
            // A whole ring is sewn to a run: the ends of the run meet.
            (true, false) => self.join(before_b, after_b, at_a + at_b),
            (false, true) => self.join(before_a, after_a, at_a + at_b),
            _ => {}
        }
        // Where the runs follow each other, the seam ends inside the cloth.
        if before_a != b1 {
            self.join(before_a, after_b, at_a);
        }
        if before_b != a1 {
            self.join(before_b, after_a, at_b);
        }
        let (x, y) = (self.group_of(sheet.edges[a0].piece), self.group_of(sheet.edges[b0].piece));
        self.group[x.max(y)] = x.min(y);
    }

    fn join(&mut self, before: usize, after: usize, more: f64) {
        // A run may close on itself: then the neighbour is a sewn edge and nothing is left there.
        if !self.free[before] || !self.free[after] {
            return;
        }
        self.next[before] = after;
        self.last[after] = before;
        self.angle[after] += more;
        self.crosses[after] = true;
    }

    pub(super) fn group_of(&self, piece: usize) -> usize {
        let mut at = piece;
        while self.group[at] != at {
            at = self.group[at];
        }
        at
    }

    /// The rings of free edges.
    pub(super) fn rings(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.free.len()];
        let mut out = Vec::new();
        for first in (0..self.free.len()).filter(|e| self.free[*e]) {
            let mut ring = Vec::new();
            let mut at = first;
            while self.free[at] && !seen[at] {
                seen[at] = true;
                ring.push(at);
                at = self.next[at];
            }
            if !ring.is_empty() {
                out.push(ring);
            }
        }
        out
    }
}
