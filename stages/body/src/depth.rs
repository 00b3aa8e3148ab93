//! How far the body reaches to the front and to the back at a given (x, y).
//!
//! Triangles are binned by their boxes in the xy plane. Cost: one bin's triangles a query.

use toile_core::artifact::{Body, Point3};

/// Side of a bin, metres: about one triangle of a mannequin.
const BIN: f64 = 0.02;
/// Distance that a straight line should keep from the skin above and below, metres.
const CLEARANCE: f64 = 0.006;

/// The body as seen along z.
#[derive(Debug)]
pub struct DepthMap<'a> {
    body: &'a Body,
    origin: [f64; 2],
    counts: [usize; 2],
    bins: Vec<Vec<u32>>,
}

impl<'a> DepthMap<'a> {
    /// Bins a body.
    pub fn new(body: &'a Body) -> Self {
        let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in &body.positions {
            lo = [lo[0].min(p.x), lo[1].min(p.y)];
            hi = [hi[0].max(p.x), hi[1].max(p.y)];
        }
        let counts = [0, 1].map(|k| (((hi[k] - lo[k]) / BIN).max(0.0) as usize + 1).min(4096));
        let mut map = DepthMap { body, origin: lo, counts, bins: vec![Vec::new(); counts[0] * counts[1]] };
        for (i, t) in body.triangles.iter().enumerate() {
            map.insert(i as u32, t.map(|v| body.positions[v as usize]));
        }
        map
    }

    fn insert(&mut self, index: u32, corners: [Point3; 3]) {
        let range = |k: usize| {
            let c = corners.map(|p| p[k]);
            let (lo, hi) = (c[0].min(c[1]).min(c[2]), c[0].max(c[1]).max(c[2]));
            self.bin(k, lo)..=self.bin(k, hi)
        };
        let (columns, rows) = (range(0), range(1));
        for row in rows {
            for column in columns.clone() {
                self.bins[row * self.counts[0] + column].push(index);
            }
        }
    }

    fn bin(&self, axis: usize, at: f64) -> usize {
        (((at - self.origin[axis]) / BIN).max(0.0) as usize).min(self.counts[axis] - 1)
    }

    /// Whether the body lies between two places, one before the other.
    pub fn is_between(&self, p: &Point3, q: &Point3) -> bool {
        let middle = nalgebra::center(p, q);
        let (near, far) = (p.z.min(q.z), p.z.max(q.z));
        let spans = [-CLEARANCE, CLEARANCE].into_iter().filter_map(|dy| self.span(middle.x, middle.y + dy));
        spans.into_iter().any(|(lo, hi)| near < hi && lo < far)
    }

    /// The least and the greatest z of the skin over (x, y); `None` beside the body.
    pub fn span(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let bin = &self.bins[self.bin(1, y) * self.counts[0] + self.bin(0, x)];
        let hits = bin.iter().filter_map(|&t| {
            depth_at(self.body.triangles[t as usize].map(|v| self.body.positions[v as usize]), x, y)
        });
        hits.fold(None, |span, z| {
            let (lo, hi) = span.unwrap_or((z, z));
            Some((z.min(lo), z.max(hi)))
        })
    }
}

/// The z of a triangle over (x, y); `None` beside it or where it stands on edge.
fn depth_at([a, b, c]: [Point3; 3], x: f64, y: f64) -> Option<f64> {
    let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    let v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
    let w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
    let inside = v >= -1e-9 && w >= -1e-9 && v + w <= 1.0 + 1e-9;
    inside.then(|| a.z + v * (b.z - a.z) + w * (c.z - a.z))
}
