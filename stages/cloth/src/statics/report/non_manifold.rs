//! Repairs non-manifold edges that sewing would make.
//!
//! Where both panels at a seam have an ear (a triangle with two sides on it) between the same
//! points of the seam, the third sides of the ears join the same two points. After sewing four
//! triangles would share that edge. Method: the edge is flipped in one panel (Lawson 1977); the
//! vertices stay. Edges along a seam stay, however many sheets it joins. Cost: O(n log n). Limit:
//! an edge stays if its flip would invert a triangle.

use crate::scene::Seam;
use crate::statics::levels::coarsen::signed_quality;
use crate::statics::levels::pieces::Pieces;

/// Least shape quality (1 equilateral) of a triangle that a flip makes.
const LEAST_QUALITY: f64 = 0.05;

/// A side of a triangle: the vertices at its ends, the triangle, and the vertex opposite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct TriangleSide {
    ends: [u32; 2],
    triangle: usize,
    apex: u32,
}

/// Two triangles and their corners after a flip.
type Flipped = [(usize, [u32; 3]); 2];

impl Pieces {
    /// Flips edges that more than two triangles would share once the seams are joined, except those
    /// along a seam.
    pub(crate) fn part_ears(&mut self, seams: &[Seam]) {
        let found = self.non_manifold_edges();
        if found.is_empty() {
            return;
        }
        let along = self.along(seams);
        for sides in found {
            if along.binary_search(&self.sewn(&sides[0])).is_ok() {
                continue;
            }
            let flips = sides.chunk_by(|a, b| a.ends == b.ends).filter_map(|s| self.flip(s));
            if let Some((_, changed)) = flips.max_by(|a, b| a.0.total_cmp(&b.0)) {
                changed.into_iter().for_each(|(t, corners)| self.triangles[t] = corners);
            }
        }
    }

    /// The nodes of an edge, ascending.
    fn sewn(&self, s: &TriangleSide) -> [u32; 2] {
        let [a, b] = s.ends.map(|v| self.node[v as usize]);
        [a.min(b), a.max(b)]
    }

    /// The edges between pairs of a seam that follow each other, ascending.
    fn along(&self, seams: &[Seam]) -> Vec<[u32; 2]> {
        let steps = seams.iter().flat_map(|s| s.pairs.windows(2)).map(|w| {
            let [a, b] = [w[0][0], w[1][0]].map(|v| self.node[v as usize]);
            [a.min(b), a.max(b)]
        });
        let mut all: Vec<[u32; 2]> = steps.collect();
        all.sort_unstable();
        all
    }

    /// The sides of triangles at each sewn edge that has more than two.
    fn non_manifold_edges(&self) -> Vec<Vec<TriangleSide>> {
        let mut all: Vec<([u32; 2], TriangleSide)> = self
            .triangles
            .iter()
            .enumerate()
            .flat_map(|(t, c)| sides(t, *c))
            .map(|s| (self.sewn(&s), s))
            .collect();
        all.sort_unstable();
        let groups = all.chunk_by(|a, b| a.0 == b.0).filter(|g| g.len() > 2);
        groups.map(|g| g.iter().map(|(_, s)| *s).collect()).collect()
    }

    /// The two triangles after a flip of an edge, and the worse of their qualities.
    fn flip(&self, sides: &[TriangleSide]) -> Option<(f64, Flipped)> {
        let &[s, t] = sides else { return None };
        let is_there =
            |s: &TriangleSide| s.ends.iter().chain([&s.apex]).all(|v| self.triangles[s.triangle].contains(v));
        if !sides.iter().all(is_there) {
            return None;
        }
        let mut changed =
            [(s.triangle, s.ends[0], t.apex), (t.triangle, s.ends[1], s.apex)].map(|(triangle, at, apex)| {
                let out = if at == s.ends[0] { s.ends[1] } else { s.ends[0] };
                (triangle, self.triangles[triangle].map(|c| if c == out { apex } else { c }))
            });
        changed.sort_unstable();
        let quality = |c: &[u32; 3]| signed_quality(&c.map(|v| self.rest[v as usize]));
        let worst = changed.iter().map(|(_, c)| quality(c)).fold(1.0, f64::min);
        (worst > LEAST_QUALITY).then_some((worst, changed))
    }
}

fn sides(triangle: usize, [a, b, c]: [u32; 3]) -> [TriangleSide; 3] {
    [[a, b, c], [b, c, a], [c, a, b]].map(|[a, b, apex]| TriangleSide {
        ends: [a.min(b), a.max(b)],
        triangle,
        apex,
    })
}

#[cfg(test)]
mod tests;
