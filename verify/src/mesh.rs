//! What is wrong with triangles as such, by joined vertices.
//!
//! Method: sides are sorted by their ends. Within a panel two triangles that share a side must run
//! along it in opposite ways. A hole of three sides is a triangle that is missing. Cost: O(n log
//! n).

use std::collections::BTreeSet;
use toile_core::artifact::Garment;

/// Height over the longest side below which a triangle has no area: some digits above rounding.
const LEAST_QUALITY: f64 = 1e-9;

/// The triangles at fault, by their numbers in the garment; each list ascending.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MeshFaults {
    /// Without area.
    pub degenerate: Vec<u32>,
    /// With the vertices of one before in their panel.
    pub doubled: Vec<u32>,
    /// That run along a side the same way as their neighbour in their panel, or lie turned in the
    /// flat: by one of each pair.
    pub turned: Vec<u32>,
    /// Around which a single triangle is missing: one of its neighbours.
    pub pinholes: Vec<u32>,
    /// Sides of three triangles or more: no fault, cloth is sewn in layers.
    pub crowded: usize,
}

/// Finds them.
#[must_use]
pub fn faults(garment: &Garment, flat_known: bool) -> MeshFaults {
    let welded: Vec<[u32; 3]> =
        garment.triangles.iter().map(|t| t.map(|v| garment.weld[v as usize])).collect();
    let mut found = MeshFaults::default();
    for panel in &garment.panels {
        // The corner of a pocket may be sewn onto a triangle of what it lies on.
        let mut seen = BTreeSet::new();
        for k in panel.triangles.clone() {
            let mut key = welded[k];
            key.sort_unstable();
            let is_flat = quality(garment, &garment.triangles[k]) <= LEAST_QUALITY;
            if is_flat || key[0] == key[1] || key[1] == key[2] {
                found.degenerate.push(k as u32);
            } else if !seen.insert(key) {
                found.doubled.push(k as u32);
            }
        }
    }
    let mut turned: BTreeSet<u32> = BTreeSet::new();
    for panel in &garment.panels {
        turned.extend(turned_sides(garment, panel.triangles.clone()));
        if flat_known {
            turned.extend(turned_flat(garment, panel.triangles.clone()));
        }
    }
    found.turned = turned.into_iter().collect();
    (found.crowded, found.pinholes) = open_sides(&welded);
    found
}

/// Height over the longest side; 0 for a triangle without sides.
fn quality(garment: &Garment, t: &[u32; 3]) -> f64 {
    let [a, b, c] = t.map(|v| garment.positions[v as usize]);
    let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    if longest > 0.0 { (b - a).cross(&(c - a)).norm() / longest } else { 0.0 }
}

/// Sides as (lower end, higher end, runs upwards, triangle), sorted.
fn sides(triangles: impl Iterator<Item = (u32, [u32; 3])>) -> Vec<(u32, u32, bool, u32)> {
    let all = triangles.flat_map(|(k, t)| {
        [0, 1, 2].map(|c| (t[c], t[(c + 1) % 3])).map(|(a, b)| (a.min(b), a.max(b), a < b, k))
    });
    let mut all: Vec<_> = all.filter(|s| s.0 != s.1).collect();
    all.sort_unstable();
    all
}

fn turned_sides(garment: &Garment, of: std::ops::Range<usize>) -> Vec<u32> {
    let own = of.map(|k| (k as u32, garment.triangles[k]));
    let sides = sides(own);
    let pairs = sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|c| c.len() == 2);
    pairs.filter(|c| c[0].2 == c[1].2).map(|c| c[1].3).collect()
}

fn turned_flat(garment: &Garment, of: std::ops::Range<usize>) -> Vec<u32> {
    let area = |k: usize| {
        let [a, b, c] = garment.triangles[k].map(|v| garment.rest[v as usize]);
        (b - a).perp(&(c - a))
    };
    let whole: f64 = of.clone().map(area).sum();
    of.filter(|k| area(*k) * whole < 0.0).map(|k| k as u32).collect()
}

/// How many sides have three triangles or more, and a neighbour of each hole of three sides.
fn open_sides(welded: &[[u32; 3]]) -> (usize, Vec<u32>) {
    let sides = sides((0..).zip(welded.iter().copied()));
    let of = |s: &[(u32, u32, bool, u32)]| s.len();
    let chunks = || sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
    let crowded = chunks().filter(|c| of(c) > 2).count();
    let mut open: Vec<(u32, u32, u32)> = chunks()
        .filter(|c| of(c) == 1)
        .map(|c| if c[0].2 { (c[0].0, c[0].1, c[0].3) } else { (c[0].1, c[0].0, c[0].3) })
        .collect();
    open.sort_unstable();
    let from = |v: u32| {
        let first = open.partition_point(|s| s.0 < v);
        open[first..].iter().copied().take_while(move |s| s.0 == v)
    };
    // The rim of a lone triangle is no hole.
    let closes = |s: &&(u32, u32, u32)| {
        let (a, b, t) = **s;
        from(b).any(|(_, c, u)| t != u && a < b && a < c && from(c).any(|s| s.1 == a))
    };
    (crowded, open.iter().filter(closes).map(|s| s.2).collect())
}
