//! A triangle mesh of the plane that can be changed in place.
//!
//! Method: triangles with their neighbours across each side; sides that must stay are walls.
//! Points are inserted by Bowyer and Watson's cavity (1981), which stops at walls, so that a
//! constrained Delaunay mesh stays one; flips are Lawson's (1977) with an exact in-circle test.
//! Cost: every local change costs what it touches.
//! Limits: borders and walls are never moved or split.

use super::angles::{least_angle, least_angle_above};
use super::predicates::{in_circle, orient};
use toile_core::StageError;
use toile_core::artifact::Point2;

/// No triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// Legalising gives up after this many flips for one change: with exact tests it ends by
/// itself, the limit is there against a mesh that was not planar to begin with.
const MAX_FLIPS: usize = 10_000;

/// A planar triangle mesh with walls.
#[derive(Debug, Clone, Default)]
pub(crate) struct TriMesh {
    /// Vertices.
    pub points: Vec<Point2>,
    /// True where a vertex may be moved or removed.
    pub free: Vec<bool>,
    /// Counter-clockwise triangles; a removed one holds [`NONE`].
    pub tris: Vec<[u32; 3]>,
    /// The triangle across the side opposite each corner.
    adj: Vec<[u32; 3]>,
    wall: Vec<[bool; 3]>,
    /// A triangle at each vertex.
    at: Vec<u32>,
    /// Triangles that changed since the list was last taken.
    touched: Vec<u32>,
}

/// A side of a cavity: its ends, the triangle outside and whether it is a wall.
type CavitySide = (u32, u32, u32, bool);

impl TriMesh {
    /// From counter-clockwise triangles; `walls` are sides that must stay.
    pub(crate) fn new(
        points: Vec<Point2>,
        free: Vec<bool>,
        tris: Vec<[u32; 3]>,
        walls: &[[u32; 2]],
    ) -> Result<Self, StageError> {
        let n = tris.len();
        let mut mesh = TriMesh {
            at: vec![NONE; points.len()],
            points,
            free,
            tris,
            adj: vec![[NONE; 3]; n],
            wall: vec![[false; 3]; n],
            touched: Vec::new(),
        };
        let mut sides: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * n);
        for (t, tri) in mesh.tris.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (tri[(k + 1) % 3], tri[(k + 2) % 3]);
                sides.push((a.min(b), a.max(b), (3 * t + k) as u32));
                mesh.at[tri[k] as usize] = t as u32;
            }
        }
        sides.sort_unstable();
        let mut walls: Vec<(u32, u32)> = walls.iter().map(|w| (w[0].min(w[1]), w[0].max(w[1]))).collect();
        walls.sort_unstable();
        for pair in sides.chunk_by(|s, t| (s.0, s.1) == (t.0, t.1)) {
            let wall = walls.binary_search(&(pair[0].0, pair[0].1)).is_ok();
            match pair {
                [one] => mesh.set_side(one.2, NONE, wall),
                [one, two] => {
                    mesh.set_side(one.2, two.2 / 3, wall);
                    mesh.set_side(two.2, one.2 / 3, wall);
                }
                _ => return Err(StageError::internal("a side of the mesh has more than two triangles")),
            }
        }
        Ok(mesh)
    }

    fn set_side(&mut self, side: u32, neighbour: u32, wall: bool) {
        let (t, k) = (side as usize / 3, side as usize % 3);
        self.adj[t][k] = neighbour;
        self.wall[t][k] = wall;
    }

    /// The corners' positions.
    pub(crate) fn corners(&self, t: u32) -> [Point2; 3] {
        self.tris[t as usize].map(|v| self.points[v as usize])
    }

    /// The least angle of a triangle, radians.
    pub(crate) fn angle(&self, t: u32) -> f64 {
        let [a, b, c] = self.corners(t);
        least_angle(a, b, c)
    }

    /// True where the triangle has not been removed.
    pub(crate) fn lives(&self, t: u32) -> bool {
        self.tris[t as usize][0] != NONE
    }

    /// Triangles that changed since the last call.
    pub(crate) fn take_touched(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.touched)
    }

    /// The triangles round a vertex, counter-clockwise; from border to border where it lies on
    /// the border.
    pub(crate) fn star(&self, v: u32) -> Vec<u32> {
        let mut out = Vec::with_capacity(8);
        let start = self.at[v as usize];
        if start == NONE {
            return out;
        }
        // Back to the border first, or all the way round.
        let mut first = start;
        loop {
            let previous = self.adj[first as usize][(self.corner(first, v) + 2) % 3];
            if previous == NONE || previous == start {
                break;
            }
            first = previous;
        }
        let mut t = first;
        loop {
            out.push(t);
            t = self.adj[t as usize][(self.corner(t, v) + 1) % 3];
            if t == NONE || t == first {
                return out;
            }
        }
    }

    fn corner(&self, t: u32, v: u32) -> usize {
        let tri = self.tris[t as usize];
        if tri[0] == v {
            0
        } else if tri[1] == v {
            1
        } else {
            2
        }
    }

    /// The side of `t` that faces the triangle `n`.
    fn side_to(&self, t: u32, n: u32) -> usize {
        let adj = self.adj[t as usize];
        if adj[0] == n {
            0
        } else if adj[1] == n {
            1
        } else {
            2
        }
    }

    /// Walks from triangle `t` to the one that holds `p`; `None` where a wall or the border is in
    /// the way.
    pub(crate) fn walk(&self, mut t: u32, p: Point2) -> Option<u32> {
        let mut from = t;
        for _ in 0..self.tris.len() {
            let [a, b, c] = self.corners(t);
            let sides = [orient(b, c, p), orient(c, a, p), orient(a, b, p)];
            let out = (0..3).filter(|&k| sides[k] < 0.0 && self.adj[t as usize][k] != from);
            let Some(k) = out.min_by(|&i, &j| sides[i].total_cmp(&sides[j])) else { return Some(t) };
            if self.wall[t as usize][k] || self.adj[t as usize][k] == NONE {
                return None;
            }
            from = t;
            t = self.adj[t as usize][k];
        }
        None
    }

    /// The triangles whose circles hold `p`, reached from `t` without crossing a wall, and the
    /// cavity's sides counter-clockwise seen from `p`.
    fn cavity(&self, t: u32, p: Point2) -> (Vec<u32>, Vec<CavitySide>) {
        let (mut inside, mut sides) = (vec![t], Vec::new());
        let mut k = 0;
        while k < inside.len() {
            let t = inside[k];
            for i in 0..3 {
                let (n, wall) = (self.adj[t as usize][i], self.wall[t as usize][i]);
                if !wall && inside.contains(&n) {
                    continue;
                }
                let [a, b, c] = if n == NONE { [p; 3] } else { self.corners(n) };
                if n != NONE && !wall && in_circle(a, b, c, p) > 0.0 {
                    inside.push(n);
                } else {
                    let tri = self.tris[t as usize];
                    sides.push((tri[(i + 1) % 3], tri[(i + 2) % 3], n, wall));
                }
            }
            k += 1;
        }
        // Drops sides whose triangle on the far side joined the cavity after they were listed.
        sides.retain(|s| s.2 == NONE || s.3 || !inside.contains(&s.2));
        (inside, sides)
    }

    /// By how much inserting `p`, which lies in triangle `t`, raises the least angle (radians): of
    /// the triangles that it would make over those it would replace. `None` where that is no more
    /// than `gain`, or cannot be.
    pub(crate) fn try_insert(&self, t: u32, p: Point2, gain: f64) -> Option<f64> {
        let (inside, sides) = self.cavity(t, p);
        let old = inside.iter().map(|&t| self.angle(t)).fold(f64::INFINITY, f64::min);
        let at = |v: u32| self.points[v as usize];
        let new = least_angle_above(sides.iter().map(|s| [at(s.0), at(s.1), p]), old + gain);
        // A disc has two sides more than triangles, and passes every corner once.
        let mut corners: Vec<u32> = sides.iter().map(|s| s.0).collect();
        corners.sort_unstable();
        corners.dedup();
        let disc = sides.len() == inside.len() + 2 && corners.len() == sides.len();
        new.filter(|_| disc).map(|new| new - old)
    }

    /// Inserts the free vertex `p`, which lies in triangle `t`.
    pub(crate) fn insert(&mut self, t: u32, p: Point2) -> u32 {
        let (mut slots, sides) = self.cavity(t, p);
        let v = self.points.len() as u32;
        self.points.push(p);
        self.free.push(true);
        while slots.len() < sides.len() {
            slots.push(self.tris.len() as u32);
            self.tris.push([NONE; 3]);
            self.adj.push([NONE; 3]);
            self.wall.push([false; 3]);
        }
        self.at.push(slots[0]);
        for (&(a, b, n, wall), &t) in sides.iter().zip(&slots) {
            self.tris[t as usize] = [a, b, v];
            let next = sides.iter().position(|s| s.0 == b).map_or(NONE, |i| slots[i]);
            let before = sides.iter().position(|s| s.1 == a).map_or(NONE, |i| slots[i]);
            self.adj[t as usize] = [next, before, n];
            self.wall[t as usize] = [false, false, wall];
            self.at[a as usize] = t;
            if n != NONE {
                let k = self.side_of(n, b, a);
                self.adj[n as usize][k] = t;
            }
        }
        self.touched.extend(slots);
        v
    }

    /// The side of `t` that runs from `a` to `b`.
    fn side_of(&self, t: u32, a: u32, b: u32) -> usize {
        let tri = self.tris[t as usize];
        (0..3).find(|&k| tri[(k + 1) % 3] == a && tri[(k + 2) % 3] == b).unwrap_or(0)
    }

    /// Flips sides near the given triangles until all are Delaunay.
    pub(crate) fn legalise(&mut self, start: &[u32]) {
        let mut todo: Vec<(u32, usize)> = start.iter().flat_map(|&t| (0..3).map(move |k| (t, k))).collect();
        let mut flips = 0;
        while let Some((t, k)) = todo.pop() {
            let n = self.adj[t as usize][k];
            if n == NONE || self.wall[t as usize][k] || !self.lives(t) {
                continue;
            }
            let far = self.points[self.tris[n as usize][self.side_to(n, t)] as usize];
            let [a, b, c] = self.corners(t);
            if in_circle(a, b, c, far) > 0.0 && flips < MAX_FLIPS && self.flip(t, k) {
                flips += 1;
                todo.extend([(t, 0), (t, 1), (t, 2), (n, 0), (n, 1), (n, 2)]);
            }
        }
    }

    /// The corners of the quadrilateral about the side opposite corner `k` of `t`, from that corner
    /// on, so that the side runs from the second to the fourth; none for a wall or a border.
    pub(crate) fn quad(&self, t: u32, k: usize) -> Option<[Point2; 4]> {
        let n = self.adj[t as usize][k];
        if n == NONE || self.wall[t as usize][k] {
            return None;
        }
        let far = self.tris[n as usize][self.side_to(n, t)];
        let tri = self.tris[t as usize];
        Some([tri[k], tri[(k + 1) % 3], far, tri[(k + 2) % 3]].map(|v| self.points[v as usize]))
    }

    /// Turns the side opposite corner `k` of `t` in its quadrilateral; false where that is not
    /// convex.
    pub(crate) fn flip(&mut self, t: u32, k: usize) -> bool {
        let n = self.adj[t as usize][k];
        let m = self.side_to(n, t);
        let tri = self.tris[t as usize];
        let (a, b, c) = (tri[k], tri[(k + 1) % 3], tri[(k + 2) % 3]);
        let d = self.tris[n as usize][m];
        let at = |v: u32| self.points[v as usize];
        if orient(at(a), at(b), at(d)) <= 0.0 || orient(at(a), at(d), at(c)) <= 0.0 {
            return false;
        }
        let (t_adj, t_wall) = (self.adj[t as usize], self.wall[t as usize]);
        let (n_adj, n_wall) = (self.adj[n as usize], self.wall[n as usize]);
        // In n the order is d, c, b.
        let (bd, dc) = ((m + 1) % 3, (m + 2) % 3);
        let (ca, ab) = ((k + 1) % 3, (k + 2) % 3);
        self.tris[t as usize] = [a, b, d];
        self.adj[t as usize] = [n_adj[bd], n, t_adj[ab]];
        self.wall[t as usize] = [n_wall[bd], false, t_wall[ab]];
        self.tris[n as usize] = [a, d, c];
        self.adj[n as usize] = [n_adj[dc], t_adj[ca], t];
        self.wall[n as usize] = [n_wall[dc], t_wall[ca], false];
        self.relink(n_adj[bd], n, t);
        self.relink(t_adj[ca], t, n);
        for v in [a, b, d] {
            self.at[v as usize] = t;
        }
        self.at[c as usize] = n;
        self.touched.extend([t, n]);
        true
    }

    fn relink(&mut self, of: u32, old: u32, new: u32) {
        if of != NONE {
            let k = self.side_to(of, old);
            self.adj[of as usize][k] = new;
        }
    }

    /// The least angle round `v` if it stood at `p`.
    pub(crate) fn star_angle(&self, star: &[u32], v: u32, p: Point2) -> f64 {
        let at = |w: u32| if w == v { p } else { self.points[w as usize] };
        let angle = |t: &u32| {
            let [a, b, c] = self.tris[*t as usize].map(at);
            least_angle(a, b, c)
        };
        star.iter().map(angle).fold(f64::INFINITY, f64::min)
    }

    /// The least angle round `v` if it stood at `p`, where that is above `bound` (radians, 0 to
    /// pi).
    pub(crate) fn star_angle_above(&self, star: &[u32], v: u32, p: Point2, bound: f64) -> Option<f64> {
        let at = |w: u32| if w == v { p } else { self.points[w as usize] };
        least_angle_above(star.iter().map(|&t| self.tris[t as usize].map(at)), bound)
    }

    /// Moves a free vertex.
    pub(crate) fn put(&mut self, star: &[u32], v: u32, p: Point2) {
        self.points[v as usize] = p;
        self.touched.extend_from_slice(star);
    }

    /// The least angle that drawing the inner vertex `v` onto its neighbour `w` would leave;
    /// negative where it cannot be.
    pub(crate) fn collapse_angle(&self, star: &[u32], v: u32, w: u32) -> f64 {
        let shared = self.star(w).iter().filter(|t| star.contains(t)).count();
        let ring = self.ring(star, v);
        let common = self.ring(&self.star(w), w).iter().filter(|x| ring.contains(x)).count();
        if shared != 2 || common != 2 {
            return -1.0;
        }
        let rest: Vec<u32> = star.iter().copied().filter(|&t| !self.tris[t as usize].contains(&w)).collect();
        self.star_angle(&rest, v, self.points[w as usize])
    }

    /// The neighbours of a vertex.
    pub(crate) fn ring(&self, star: &[u32], v: u32) -> Vec<u32> {
        let mut out: Vec<u32> =
            star.iter().flat_map(|&t| self.tris[t as usize]).filter(|&w| w != v).collect();
        out.sort_unstable();
        out.dedup();
        out
    }

    /// Draws the inner vertex `v`, which no wall touches, onto its neighbour `w`.
    pub(crate) fn collapse(&mut self, star: &[u32], v: u32, w: u32) {
        for &t in star {
            let (kv, tri) = (self.corner(t, v), self.tris[t as usize]);
            if !tri.contains(&w) {
                self.tris[t as usize][kv] = w;
                self.touched.push(t);
                continue;
            }
            let kw = self.corner(t, w);
            let (outer, inner) = (self.adj[t as usize][kv], self.adj[t as usize][kw]);
            let wall = self.wall[t as usize][kv];
            for (of, new) in [(outer, inner), (inner, outer)] {
                if of != NONE {
                    let k = self.side_to(of, t);
                    self.adj[of as usize][k] = new;
                    self.wall[of as usize][k] = wall;
                }
            }
            let keep = if inner == NONE { outer } else { inner };
            for x in tri {
                self.at[x as usize] = keep;
            }
            self.tris[t as usize] = [NONE; 3];
            self.adj[t as usize] = [NONE; 3];
        }
        // Both triangles on the side are gone; whatever stands in the rest of the star is alive.
        for &t in star.iter().filter(|&&t| self.tris[t as usize][0] != NONE) {
            for x in self.tris[t as usize] {
                self.at[x as usize] = t;
            }
        }
        self.at[v as usize] = NONE;
        self.free[v as usize] = false;
    }

    /// The living triangles.
    pub(crate) fn living(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.tris.len() as u32).filter(|&t| self.lives(t))
    }
}

impl TriMesh {
    /// For every triangle, whether it lies in the region to the left of the given walls.
    pub(crate) fn left_of(&self, walls: &[[u32; 2]]) -> Result<Vec<bool>, StageError> {
        let mut inside = vec![false; self.tris.len()];
        let mut todo = Vec::new();
        for w in walls {
            let Some(t) = self.star(w[0]).into_iter().find(|&t| self.runs(t, *w)) else {
                return Err(StageError::internal("a segment of the outline is not in the triangulation"));
            };
            todo.push(t);
        }
        while let Some(t) = todo.pop() {
            if std::mem::replace(&mut inside[t as usize], true) {
                continue;
            }
            let across = |k: usize| (!self.wall[t as usize][k]).then_some(self.adj[t as usize][k]);
            todo.extend((0..3).filter_map(across).filter(|&n| n != NONE && !inside[n as usize]));
        }
        Ok(inside)
    }

    /// True where a side of `t` runs from `w[0]` to `w[1]`.
    fn runs(&self, t: u32, w: [u32; 2]) -> bool {
        let tri = self.tris[t as usize];
        (0..3).any(|k| [tri[k], tri[(k + 1) % 3]] == w)
    }
}
