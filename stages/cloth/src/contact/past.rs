//! Finds cloth that has fallen past the body.
//!
//! A connected piece of cloth is past the body once its highest point lies below the lowest point
//! of the body, and below all cloth that is pinned or not past the body. Nothing can stop it then,
//! so the solver ends. Cost: O(n), one comparison per node while all nodes are above the lowest
//! point of the body. Limit: cloth that slides off is found only once it is wholly below.

use super::collision_surface::CollisionSurface;
use toile_geometry::Vec3;

/// The piece of a node without triangles.
pub const NO_PIECE: u32 = u32::MAX;

/// Least number of edges of the mesh in the narrower side of the body, at which a finer mesh would
/// fall, too.
const EDGES_ACROSS: f64 = 6.0;

/// The bounding box of a body, with one axis along gravity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyBox {
    /// The upward direction and two directions across it.
    axes: [Vec3; 3],
    low: [f64; 3],
    high: [f64; 3],
}

/// Cloth that has fallen past the body.
#[derive(Debug, Clone, PartialEq)]
pub struct Fallen {
    /// Its panels, as a list for messages.
    pub cloth: String,
    /// Where it started.
    pub start: Start,
    /// How tall the body is, m.
    pub body: f64,
    /// Whether a finer mesh would fall past, too.
    pub is_certain: bool,
}

/// Where cloth that fell past the body started.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// Beside it: the horizontal distance of the middle of the cloth from that of the body, m.
    Beside(Vec3),
    /// Wholly below it, by this distance, m.
    Below(f64),
    /// Around or above it.
    Around,
}

impl std::fmt::Display for Fallen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { cloth, body, .. } = self;
        match self.start {
            Start::Beside(way) => {
                // No "-0.00".
                let [x, y, z] = [-way.x, -way.y, -way.z].map(|v| (v * 100.0).round() / 100.0 + 0.0);
                write!(
                    f,
                    "the cloth of {cloth} falls past the body: its middle starts {:.3} m beside the body's; move it by ({x:.2}, {y:.2}, \
                     {z:.2}) m, around or above the body, which is {body:.2} m tall, and see that both are in the same unit of length",
                    way.norm()
                )
            }
            Start::Below(gap) => write!(
                f,
                "the cloth of {cloth} falls away from the body: it starts {gap:.2} m below it, and the body is {body:.2} m tall; place it \
                 around or above the body, and see that both are in the same unit of length"
            ),
            Start::Around => write!(
                f,
                "the cloth of {cloth} finds no hold on the body and falls past it; place it around the body, cut it narrower where the \
                 body is to hold it (a skirt at its waist) or raise the friction, and see that it is not too heavy and that the body, \
                 {body:.2} m tall, is in metres"
            ),
        }
    }
}

impl BodyBox {
    /// The box of a body; `None` where there is no body or no gravity.
    pub fn of(surface: &dyn CollisionSurface, gravity: &Vec3) -> Option<Self> {
        let up = -gravity.try_normalize(0.0)?;
        let least = up.iamin();
        let first = up.cross(&Vec3::ith(least, 1.0)).normalize();
        let axes = [up, first, up.cross(&first)];
        let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
        for (k, axis) in axes.iter().enumerate() {
            (low[k], high[k]) = (-surface.reach(&-axis)?, surface.reach(axis)?);
        }
        Some(Self { axes, low, high })
    }

    /// How tall the body is, m.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.high[0] - self.low[0]
    }

    /// Its lowest point along gravity, m.
    #[must_use]
    pub fn lowest(&self) -> f64 {
        self.low[0]
    }

    /// The height of the highest point of the body under cloth with its vertices at `x`, by a
    /// raster of vertical rays. `meets` returns the height at which a ray down from a point above
    /// the body meets it. `None` where no ray does.
    pub fn highest_under(
        &self,
        x: &[Vec3],
        ways: usize,
        meets: impl Fn(&Vec3) -> Option<f64>,
    ) -> Option<f64> {
        let side = |k: usize| {
            let along = || x.iter().map(|p| p.dot(&self.axes[k]));
            let (low, high) =
                (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max));
            (low.max(self.low[k]), high.min(self.high[k]))
        };
        let (a, b) = (side(1), side(2));
        if a.0 > a.1 || b.0 > b.1 {
            return None;
        }
        let step = |(low, high): (f64, f64), i: usize| low + (high - low) * (i as f64 + 0.5) / ways as f64;
        let from = |i: usize| {
            let above = self.high[0] + self.height().max(f64::MIN_POSITIVE);
            self.axes[0] * above + self.axes[1] * step(a, i % ways) + self.axes[2] * step(b, i / ways)
        };
        (0..ways * ways).filter_map(|i| meets(&from(i))).reduce(f64::max)
    }

    /// Whether cloth with edges of that length, m, falls past the body only where finer cloth does,
    /// too.
    #[must_use]
    pub fn resolves(&self, edge: f64) -> bool {
        let across = [1, 2].map(|k| self.high[k] - self.low[k]);
        edge * EDGES_ACROSS <= across[0].min(across[1])
    }

    /// Whether each piece is past the body; empty where none is. `piece` is the piece of each node,
    /// or [`NO_PIECE`], and `held` says which nodes are pinned.
    #[must_use]
    pub fn past(&self, x: &[Vec3], piece: &[u32], held: &[bool]) -> Vec<bool> {
        let height = |p: &Vec3| p.dot(&self.axes[0]);
        if x.iter().all(|p| height(p) >= self.low[0]) {
            return Vec::new();
        }
        let count = piece.iter().filter(|p| **p != NO_PIECE).max().map_or(0, |p| *p as usize + 1);
        let mut spans = vec![(f64::INFINITY, f64::NEG_INFINITY); count];
        let mut is_held = vec![false; count];
        for ((p, &k), &held) in x.iter().zip(piece).zip(held).filter(|((_, k), _)| **k != NO_PIECE) {
            let (low, high) = &mut spans[k as usize];
            (*low, *high) = (low.min(height(p)), high.max(height(p)));
            is_held[k as usize] |= held;
        }
        let lowest_held = spans.iter().zip(&is_held).filter(|(_, h)| **h).map(|(s, _)| s.0);
        let mut floor = lowest_held.fold(self.low[0], f64::min);
        let mut from_the_top: Vec<usize> = (0..count).filter(|&k| !is_held[k]).collect();
        from_the_top.sort_by(|&a, &b| spans[b].1.total_cmp(&spans[a].1).then(a.cmp(&b)));
        let mut past = vec![false; count];
        for k in from_the_top {
            let (low, high) = spans[k];
            past[k] = high < floor;
            if !past[k] {
                floor = floor.min(low);
            }
        }
        if past.contains(&true) { past } else { Vec::new() }
    }

    /// Where cloth with its vertices at `x` starts.
    #[must_use]
    pub fn start(&self, x: &[Vec3]) -> Start {
        let mut gaps = [0.0; 3];
        let mut way = Vec3::zeros();
        for (k, axis) in self.axes.iter().enumerate() {
            let along = || x.iter().map(|p| p.dot(axis));
            let (low, high) =
                (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max));
            gaps[k] = (self.low[k] - high).max(if k == 0 { 0.0 } else { low - self.high[k] }).max(0.0);
            if k > 0 {
                way += axis * (0.5 * (low + high) - 0.5 * (self.low[k] + self.high[k]));
            }
        }
        match gaps {
            [0.0, 0.0, 0.0] => Start::Around,
            [below, 0.0, 0.0] => Start::Below(below),
            _ => Start::Beside(way),
        }
    }
}

/// The panels of fallen cloth, as a list for messages: each with its name, how many vertices have
/// fallen, and how many there are.
#[must_use]
pub fn list(panels: &[(&str, usize, usize)]) -> String {
    /// Panels that are named at most.
    const NAMED: usize = 3;
    let name = |&(name, fallen, all): &(&str, usize, usize)| match fallen == all {
        true => format!("'{name}'"),
        false => format!("'{name}' (a part of it)"),
    };
    let mut names: Vec<String> = panels.iter().take(NAMED).map(name).collect();
    if panels.len() > NAMED {
        names.push(format!("{} more", panels.len() - NAMED));
    }
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) => format!("{} and {last}", before.join(", ")),
        None => "no panel".into(),
    }
}

#[cfg(test)]
mod tests;
