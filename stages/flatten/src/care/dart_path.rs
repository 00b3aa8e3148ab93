//! Ways along edges from the inside of a flat piece to its boundary (Dijkstra 1959), cheap near a
//! ray.

use crate::linear::Graph;
use crate::surface::PieceSurface;
use nalgebra::{Point2, Vector2};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// At this distance from the ray, a share of the piece's extent, a way costs twice its length; it
/// grows with the square.
const BESIDE: f64 = 0.02;

/// What every search of one piece shares.
pub(super) struct Ways<'a> {
    flat: &'a [Point2<f64>],
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    on_boundary: Vec<bool>,
}

/// Costs in whole steps, so that equal ways compare equal on every machine.
const STEPS: f64 = 1e9;

impl<'a> Ways<'a> {
    pub(super) fn new(surface: &PieceSurface, flat: &'a [Point2<f64>]) -> Self {
        let graph = Graph::new(flat.len(), surface.triangles(), &[]);
        let (starts, neighbours) = graph.both_ways();
        let mut on_boundary = vec![false; flat.len()];
        surface.loops().iter().flatten().for_each(|&v| on_boundary[v as usize] = true);
        Self { flat, starts, neighbours, on_boundary }
    }

    pub(super) fn is_on_boundary(&self, v: u32) -> bool {
        self.on_boundary[v as usize]
    }

    pub(super) fn neighbours(&self, v: u32) -> &[u32] {
        &self.neighbours[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// The cheapest way to `tip` from the boundary near the ray from the tip along `direction`, its
    /// first vertex alone on the boundary; none from the boundary to itself.
    pub(super) fn to_boundary(&self, tip: u32, direction: Vector2<f64>) -> Option<Vec<u32>> {
        if self.is_on_boundary(tip) {
            return None;
        }
        let unit = self.extent() / STEPS;
        let mut cost = vec![u64::MAX; self.flat.len()];
        let mut from = vec![tip; self.flat.len()];
        cost[tip as usize] = 0;
        let mut waiting = BinaryHeap::from([Reverse((0u64, tip))]);
        while let Some(Reverse((so_far, v))) = waiting.pop() {
            if so_far > cost[v as usize] {
                continue;
            }
            if self.is_on_boundary(v) {
                return Some(self.way(v, tip, &from));
            }
            for &u in self.neighbours(v) {
                let edge = self.flat[u as usize] - self.flat[v as usize];
                let from_tip = nalgebra::center(&self.flat[u as usize], &self.flat[v as usize])
                    - self.flat[tip as usize];
                let beside = (from_tip - direction * from_tip.dot(&direction).max(0.0)).norm();
                let price = 1.0 + (beside / (BESIDE * STEPS * unit)).powi(2);
                let total = so_far.saturating_add((edge.norm() * price / unit) as u64 + 1);
                if total < cost[u as usize] {
                    (cost[u as usize], from[u as usize]) = (total, v);
                    waiting.push(Reverse((total, u)));
                }
            }
        }
        None
    }

    fn way(&self, end: u32, tip: u32, from: &[u32]) -> Vec<u32> {
        let mut way = vec![end];
        let mut v = end;
        while v != tip {
            v = from[v as usize];
            way.push(v);
        }
        way
    }

    fn extent(&self) -> f64 {
        let first = self.flat[0];
        let (low, high) = self.flat.iter().fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
        (high - low).norm()
    }
}
