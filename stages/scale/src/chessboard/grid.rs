//! Grids of corners.
//!
//! From a corner, its nearest neighbours along its two edges give the steps; then each neighbour is
//! looked for a step further, with the step of the last one, so that perspective is followed. Tones
//! must alternate: along an edge the next corner has dark and light exchanged.

use super::saddles::Saddle;
use nalgebra::{Point2, Vector2};
use std::collections::{BTreeMap, VecDeque};

/// A full rectangle of corners, row by row, clockwise where y grows downwards.
#[derive(Debug, Clone)]
pub(crate) struct BoardCorners {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) places: Vec<Point2<f64>>,
}

impl BoardCorners {
    /// Whether it has m x n corners, either way.
    pub(crate) fn is(&self, m: usize, n: usize) -> bool {
        (self.columns, self.rows) == (m, n) || (self.columns, self.rows) == (n, m)
    }

    /// The outermost corners.
    pub(crate) fn outer(&self) -> [Point2<f64>; 4] {
        let (c, r) = (self.columns, self.rows);
        [0, c - 1, c * r - 1, c * (r - 1)].map(|i| self.places[i])
    }

    /// The mean side of a square, pixels.
    pub(crate) fn square(&self) -> f64 {
        let [a, b, c, d] = self.outer();
        let across = ((b - a).norm() + (c - d).norm()) / (2.0 * (self.columns - 1) as f64);
        let down = ((d - a).norm() + (c - b).norm()) / (2.0 * (self.rows - 1) as f64);
        (across * down).sqrt()
    }
}

/// Seeds that are tried.
const SEEDS: usize = 400;
/// The least corners along a side of a board.
const LEAST: usize = 3;

/// Boards, the largest first; those of fewer than a quarter of its corners are left out.
pub(crate) fn boards(saddles: &[Saddle]) -> Vec<BoardCorners> {
    let mut taken = vec![false; saddles.len()];
    let mut found: Vec<BoardCorners> = Vec::new();
    for seed in 0..saddles.len().min(SEEDS) {
        if taken[seed] {
            continue;
        }
        let Some(cells) = grow(saddles, &taken, seed) else { continue };
        if let Some(board) = rectangle(saddles, &cells) {
            cells.values().for_each(|i| taken[*i] = true);
            found.push(board);
        }
    }
    found.sort_by_key(|b| std::cmp::Reverse(b.places.len()));
    let most = found.first().map_or(0, |b| b.places.len());
    found.retain(|b| 4 * b.places.len() > most);
    found
}

type CornerCells = BTreeMap<(i32, i32), usize>;

/// The grid around a seed.
fn grow(saddles: &[Saddle], taken: &[bool], seed: usize) -> Option<CornerCells> {
    let s = &saddles[seed];
    let first = next_along(saddles, taken, seed, s.edges[0])?;
    let second = next_along(saddles, taken, seed, s.edges[1])?;
    let mut steps = [saddles[first].at - s.at, saddles[second].at - s.at];
    if steps[0].norm().max(steps[1].norm()) > 2.2 * steps[0].norm().min(steps[1].norm()) {
        return None;
    }
    if steps[0].perp(&steps[1]) < 0.0 {
        steps.swap(0, 1);
    }
    let mut cells = CornerCells::from([((0, 0), seed)]);
    let mut used = taken.to_vec();
    used[seed] = true;
    let mut queue = VecDeque::from([((0, 0), steps)]);
    while let Some((cell, steps)) = queue.pop_front() {
        let from = cells[&cell];
        for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            let next = (cell.0 + dx, cell.1 + dy);
            let step = steps[0] * f64::from(dx) + steps[1] * f64::from(dy);
            if cells.contains_key(&next) || next.0.abs() > 64 || next.1.abs() > 64 {
                continue;
            }
            let Some(i) = near(saddles, &used, from, step) else { continue };
            used[i] = true;
            cells.insert(next, i);
            let went = (saddles[i].at - saddles[from].at) * f64::from(dx + dy);
            let own = if dx == 0 { [steps[0], went] } else { [went, steps[1]] };
            queue.push_back((next, own));
        }
    }
    Some(cells)
}

/// The nearest corner of exchanged tones along a direction, either way.
fn next_along(saddles: &[Saddle], taken: &[bool], from: usize, along: Vector2<f64>) -> Option<usize> {
    let mut best = (None, f64::INFINITY);
    for (i, s) in saddles.iter().enumerate() {
        let d = s.at - saddles[from].at;
        let far = d.norm();
        if i != from
            && !taken[i]
            && far < best.1
            && far > 4.0
            && d.perp(&along).abs() < 0.14 * far
            && exchanged(&saddles[from], s)
        {
            best = (Some(i), far);
        }
    }
    best.0
}

/// The corner of exchanged tones nearest to a step away.
fn near(saddles: &[Saddle], used: &[bool], from: usize, step: Vector2<f64>) -> Option<usize> {
    let target = saddles[from].at + step;
    let mut best = (None, 0.25 * step.norm());
    for (i, s) in saddles.iter().enumerate() {
        let far = (s.at - target).norm();
        if !used[i] && far < best.1 && exchanged(&saddles[from], s) {
            best = (Some(i), far);
        }
    }
    best.0
}

/// Whether the dark squares of one are where the light ones of the other are, with like contrast.
fn exchanged(a: &Saddle, b: &Saddle) -> bool {
    let like = |u: &Vector2<f64>, v: &Vector2<f64>| u.dot(v).abs() > 0.93;
    let close = a.contrast < 3.0 * b.contrast && b.contrast < 3.0 * a.contrast;
    close && like(&a.edges[0], &b.edges[1]) && like(&a.edges[1], &b.edges[0])
}

/// The largest full rectangle of cells.
fn rectangle(saddles: &[Saddle], cells: &CornerCells) -> Option<BoardCorners> {
    let (x0, x1) = (cells.keys().map(|c| c.0).min()?, cells.keys().map(|c| c.0).max()?);
    let (y0, y1) = (cells.keys().map(|c| c.1).min()?, cells.keys().map(|c| c.1).max()?);
    let mut best: Option<(i32, [i32; 4])> = None;
    for top in y0..=y1 {
        let mut full: Vec<bool> = (x0..=x1).map(|_| true).collect();
        for bottom in top..=y1 {
            (x0..=x1).enumerate().for_each(|(n, x)| full[n] &= cells.contains_key(&(x, bottom)));
            let (start, long) = longest(&full);
            let area = long * (bottom - top + 1);
            if best.is_none_or(|b| area > b.0) {
                best = Some((area, [x0 + start, top, long, bottom - top + 1]));
            }
        }
    }
    let [x, y, columns, rows] = best?.1;
    if columns < LEAST as i32 || rows < LEAST as i32 {
        return None;
    }
    let at = |c: i32, r: i32| cells.get(&(x + c, y + r)).map(|i| saddles[*i].at);
    let places: Option<Vec<_>> =
        (0..rows).flat_map(|r| (0..columns).map(move |c| (c, r))).map(|(c, r)| at(c, r)).collect();
    Some(BoardCorners { columns: columns as usize, rows: rows as usize, places: places? })
}

/// Start and length of the longest run.
fn longest(full: &[bool]) -> (i32, i32) {
    let (mut best, mut start) = ((0, 0), 0);
    for (n, on) in full.iter().enumerate() {
        if !on {
            start = n + 1;
        } else if (n + 1 - start) as i32 > best.1 {
            best = (start as i32, (n + 1 - start) as i32);
        }
    }
    best
}
