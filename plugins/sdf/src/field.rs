//! The signed-distance grid.
//!
//! Making: nodes within [`BAND`] cells of a triangle get the exact distance to the closest one; the
//! closest triangle is then handed on from node to node by sweeps in eight directions (Bridson
//! 2003; Zhao 2005), which leaves distances far from the skin a little long now and then. The sign
//! is exact in the band and flows from there: no two nodes beyond the band that stand side by side
//! have skin between them. Cost: triangles times the nodes around each, and eight passes; 0.5 s for
//! the mannequin at 8 mm on one core. Asking: eight nodes and their trilinear value, some 20 ns,
//! where the skin is farther than [`NEAR`] cells. Nearer, the triangles that the eight nodes are
//! closest to are the guesses from which the closest point is walked to, some 200 ns: what is read
//! there is the distance itself. (Interpolated distances alone, linear or cubic, leave force and
//! energy at odds by a few per cent, and a solver that goes straight to rest never arrives.)
//! Limits: beyond the near zone walls thinner than a cell are not seen; at most [`MAX_NODES`].

use crate::skin::Skin;
use rayon::prelude::*;
use toile_core::artifact::{Body, Point3, Vector3};
use toile_core::{Context, Length, StageError};

/// The largest grid: 17 bytes per node while it is made, 8 afterwards.
const MAX_NODES: f64 = 4e7;
/// Cells around the skin with exact distances.
const BAND: f64 = 2.0;
/// Cells around the body's box.
const ROOM_CELLS: f64 = 3.0;
/// The least room around the body's box, metres: no solver looks farther for contacts.
const LEAST_ROOM: f64 = 0.05;
/// Slices whose bands are made before the stop flag is looked at.
const SLICES: usize = 4;
/// Cells from the skin within which the closest point is requested.
const NEAR: f64 = 1.5;
/// No triangle yet.
const NONE: u32 = u32::MAX;

/// What the field says at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Signed distance, metres, negative inside.
    pub distance: f64,
    /// Unit direction in which it grows.
    pub normal: Vector3,
}

/// Signed distances at the nodes of a grid.
#[derive(Debug)]
pub struct DistanceField {
    low: Point3,
    cell: f64,
    size: [usize; 3],
    values: Vec<f32>,
    /// The closest triangle of every node.
    closest: Vec<u32>,
    skin: Skin,
}

impl DistanceField {
    /// The field of a body with nodes `cell` metres apart.
    ///
    /// Errors: a body that is not closed; a grid of more than 40 million nodes.
    pub fn of(body: &Body, cell: f64, cx: &Context) -> Result<Self, StageError> {
        let skin = Skin::of(body)?;
        let mut field = DistanceField::around(body, cell, skin)?;
        cx.progress(0.1, format!("{} million nodes", field.nodes() as f64 / 1e6));
        let mut closest = field.band(&field.skin, cx)?;
        let known: Vec<bool> = closest.iter().map(|t| *t != NONE).collect();
        field.sweep(&field.skin, &mut closest, cx)?;
        field.values = field.signed(&field.skin, &closest, known, cx)?;
        field.closest = closest;
        Ok(field)
    }

    fn around(body: &Body, cell: f64, skin: Skin) -> Result<Self, StageError> {
        let (mut low, mut high) = (body.positions[0], body.positions[0]);
        body.positions.iter().for_each(|p| (low, high) = (low.inf(p), high.sup(p)));
        let room = Vector3::repeat((ROOM_CELLS * cell).max(LEAST_ROOM));
        let span = (high - low) + 2.0 * room;
        let counts = span.map(|s| (s / cell).ceil() + 1.0);
        let nodes = counts.product();
        if nodes.is_nan() || nodes > MAX_NODES {
            let least = Length::m((cell * (nodes / MAX_NODES).cbrt() * 1e4).ceil() / 1e4);
            return Err(StageError::invalid(format!(
                "cells of {} would make a grid of {:.0} million nodes, the limit is 40 million",
                Length::m(cell),
                nodes / 1e6
            ))
            .hint(format!("use cells of at least {least}"))
            .at("cell"));
        }
        let size = [counts.x as usize, counts.y as usize, counts.z as usize];
        Ok(DistanceField { low: low - room, cell, size, values: Vec::new(), closest: Vec::new(), skin })
    }

    /// How many nodes it has.
    pub fn nodes(&self) -> usize {
        self.size.iter().product()
    }

    /// Distance of its nodes, metres.
    pub fn cell(&self) -> f64 {
        self.cell
    }

    fn node(&self, i: usize, j: usize, k: usize) -> Point3 {
        self.low + Vector3::new(i as f64, j as f64, k as f64) * self.cell
    }

    fn slice(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// The nodes of one axis within the band of an interval.
    fn span(&self, axis: usize, from: f64, to: f64) -> std::ops::Range<usize> {
        let index = |x: f64| (x - self.low[axis]) / self.cell;
        let (a, b) = (index(from) - BAND, index(to) + BAND);
        (a.ceil().max(0.0) as usize)..((b.floor() + 1.0).max(0.0) as usize).min(self.size[axis])
    }

    /// The closest triangle of every node in the band, slice by slice.
    fn band(&self, skin: &Skin, cx: &Context) -> Result<Vec<u32>, StageError> {
        let range = |t: &[Point3; 3], axis: usize| {
            let x = t.map(|p| p[axis]);
            self.span(axis, x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]))
        };
        let mut in_slice: Vec<Vec<u32>> = vec![Vec::new(); self.size[2]];
        for (t, corners) in skin.corners.iter().enumerate() {
            range(corners, 2).for_each(|k| in_slice[k].push(t as u32));
        }
        let mut closest = vec![NONE; self.nodes()];
        for (group, slices) in closest.chunks_mut(SLICES * self.slice()).enumerate() {
            cx.check()?;
            slices.par_chunks_mut(self.slice()).enumerate().for_each(|(s, nodes)| {
                let k = group * SLICES + s;
                let mut best = vec![f64::INFINITY; nodes.len()];
                for &t in &in_slice[k] {
                    let corners = &skin.corners[t as usize];
                    for j in range(corners, 1) {
                        for i in range(corners, 0) {
                            let d = skin.distance_squared(&self.node(i, j, k), t as usize);
                            let n = j * self.size[0] + i;
                            // Triangles come in ascending order, so ties go to the first.
                            if d < best[n] {
                                (best[n], nodes[n]) = (d, t);
                            }
                        }
                    }
                }
                let reach = (BAND * self.cell).powi(2);
                nodes.iter_mut().zip(best).filter(|(_, d)| *d > reach).for_each(|(t, _)| *t = NONE);
            });
        }
        Ok(closest)
    }

    /// Hands the closest triangle on, in eight directions.
    fn sweep(&self, skin: &Skin, closest: &mut [u32], cx: &Context) -> Result<(), StageError> {
        let [nx, ny, nz] = self.size;
        let mut best: Vec<f64> = vec![f64::INFINITY; closest.len()];
        let strides = [1, nx, nx * ny];
        for pass in 0..8u32 {
            cx.progress(0.3 + 0.07 * f64::from(pass), "distances");
            let way = |axis: u32, n: usize, i: usize| if pass >> axis & 1 == 0 { i } else { n - 1 - i };
            for k in 0..nz {
                cx.check()?;
                for j in 0..ny {
                    for i in 0..nx {
                        let at = [way(0, nx, i), way(1, ny, j), way(2, nz, k)];
                        let n = at[0] + nx * (at[1] + ny * at[2]);
                        let p = self.node(at[0], at[1], at[2]);
                        if best[n] == f64::INFINITY && closest[n] != NONE {
                            best[n] = skin.distance_squared(&p, closest[n] as usize);
                        }
                        for axis in 0..3 {
                            let first = if pass >> axis & 1 == 0 { 0 } else { self.size[axis] - 1 };
                            if at[axis] == first {
                                continue;
                            }
                            let from = if first == 0 { n - strides[axis] } else { n + strides[axis] };
                            let t = closest[from];
                            if t == NONE || t == closest[n] {
                                continue;
                            }
                            let d = skin.distance_squared(&p, t as usize);
                            if d < best[n] {
                                (best[n], closest[n]) = (d, t);
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Distances with their signs: exact in the band, from a neighbour beyond it.
    fn signed(
        &self,
        skin: &Skin,
        closest: &[u32],
        known: Vec<bool>,
        cx: &Context,
    ) -> Result<Vec<f32>, StageError> {
        let [nx, ny, _] = self.size;
        let at = |n: usize| self.node(n % nx, n / nx % ny, n / (nx * ny));
        let mut values: Vec<f32> = closest
            .par_iter()
            .enumerate()
            .map(|(n, t)| match *t {
                NONE => f32::INFINITY,
                t => skin.signed(&at(n), t as usize) as f32,
            })
            .collect();
        cx.check()?;
        self.flow(&mut values, known);
        Ok(values)
    }

    /// Carries signs from known nodes to their neighbours until all are known.
    fn flow(&self, values: &mut [f32], mut known: Vec<bool>) {
        let [nx, ny, nz] = self.size;
        let mut open: Vec<u32> = (0..values.len() as u32).filter(|&n| known[n as usize]).collect();
        while let Some(n) = open.pop() {
            let n = n as usize;
            let (i, j, k) = (n % nx, n / nx % ny, n / (nx * ny));
            let steps = [
                (i > 0, n.wrapping_sub(1)),
                (i + 1 < nx, n + 1),
                (j > 0, n.wrapping_sub(nx)),
                (j + 1 < ny, n + nx),
                (k > 0, n.wrapping_sub(nx * ny)),
                (k + 1 < nz, n + nx * ny),
            ];
            for (_, m) in steps.into_iter().filter(|s| s.0) {
                if !known[m] {
                    known[m] = true;
                    values[m] = values[m].abs().copysign(values[n]);
                    open.push(m as u32);
                }
            }
        }
    }

    /// Distance and normal at a place; `None` where it is no finite number.
    pub fn at(&self, p: &Point3) -> Option<Reading> {
        if !p.iter().all(|x| x.is_finite()) {
            return None;
        }
        let (low, high) = (self.low, self.low + self.extent());
        let inner = p.sup(&low).inf(&high);
        let reading = self.inside(&inner);
        match p - inner {
            out if out == Vector3::zeros() => Some(reading),
            _ => Some(beyond(p, &inner, &reading)),
        }
    }

    /// Signed distance alone, for points inside the grid.
    pub(crate) fn distance(&self, p: &Point3) -> f64 {
        self.at(p).map_or(f64::INFINITY, |r| r.distance)
    }

    fn extent(&self) -> Vector3 {
        let [x, y, z] = self.size.map(|n| (n - 1) as f64 * self.cell);
        Vector3::new(x, y, z)
    }

    /// Trilinear value and its gradient; near the skin the closest point, from what the cell's
    /// nodes are closest to.
    fn inside(&self, p: &Point3) -> Reading {
        let q = (p - self.low) / self.cell;
        let base = [0, 1, 2].map(|a| (q[a].max(0.0) as usize).min(self.size[a] - 2));
        let f = Vector3::from_fn(|a, _| q[a] - base[a] as f64);
        let (sx, sy) = (self.size[0], self.slice());
        let first = base[0] + sx * base[1] + sy * base[2];
        let nodes = [0, 1, sx, sx + 1, sy, sy + 1, sy + sx, sy + sx + 1].map(|o| first + o);
        let v = nodes.map(|n| f64::from(self.values[n]));
        let lerp = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let edges = [0, 2, 4, 6].map(|k| lerp(v[k], v[k + 1], f.x));
        let distance = lerp(lerp(edges[0], edges[1], f.y), lerp(edges[2], edges[3], f.y), f.z);
        if distance.abs() < NEAR * self.cell
            && let Some(on) = self.skin.closest(p, nodes.iter().map(|&n| self.closest[n]))
        {
            return Reading { distance: on.distance, normal: on.normal };
        }
        let along_x = |k: usize| v[k + 1] - v[k];
        let gradient = Vector3::new(
            lerp(lerp(along_x(0), along_x(2), f.y), lerp(along_x(4), along_x(6), f.y), f.z),
            lerp(edges[1] - edges[0], edges[3] - edges[2], f.z),
            lerp(edges[2] - edges[0], edges[3] - edges[1], f.y),
        );
        Reading { distance, normal: gradient.try_normalize(0.0).unwrap_or_else(Vector3::y) }
    }
}

/// Beyond the grid: from the skin's point that is closest to the grid's rim.
fn beyond(p: &Point3, rim: &Point3, there: &Reading) -> Reading {
    let skin = rim - there.normal * there.distance;
    let gap = p - skin;
    Reading { distance: gap.norm(), normal: gap.try_normalize(0.0).unwrap_or(there.normal) }
}
