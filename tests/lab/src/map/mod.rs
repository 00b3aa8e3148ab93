//! Where each solver is stable: time step against the cloth's stiffness and the mesh's edge length,
//! for a hung sheet that is released.
//!
//! A sheet of [`SIDE`] hangs by its upper edge, is held out at an angle and released; drag damps
//! its slowest swing about critically, and [`DECAY`] times that swing's time later it must be at
//! rest where [`Static`](toile_cloth::solver::Static) finds the equilibrium of the same mesh and
//! models ([`Cell`] says what came of it). Explicit steps have a limit, `2 / omega_max` of the
//! assembled stiffness and masses (Courant, Friedrichs, Lewy, 1928); it stands beside every cell,
//! for the other solvers to be compared with.
//!
//! A cell's cost is bounded before it runs, by its steps, its triangles and what a step of the
//! solver costs about ([`Scheme::price`]), and again by a clock while it runs. The grids are even
//! in the logarithm.

mod cell;
mod csv;
mod hung;
mod pictures;
mod quickest;
mod scheme;
mod show;

#[cfg(test)]
mod tests;

pub use cell::{Cell, OFF, Outcome};
pub use hung::{DECAY, SIDE};
pub use pictures::pictures;
pub use quickest::{Quickest, quickest};
pub(super) use scheme::Cloth;
pub use scheme::Scheme;

use super::Progress;
use hung::Hung;
use serde::Serialize;
use std::ops::ControlFlow;
use toile_cloth::error::ClothError;

/// Least and greatest time step, s.
pub const STEPS: [f64; 2] = [1e-5, 1e-1];
/// Least and greatest stretch stiffness, N/m: a rubber band and a stiff canvas.
pub const STIFFNESSES: [f64; 2] = [1.0, 1e4];

/// What to run.
#[derive(Debug, Clone)]
pub struct Options {
    /// Which solvers.
    pub schemes: Vec<Scheme>,
    /// Values of the time step and of the stiffness, 2 or more.
    pub cells: usize,
    /// Edges along the side of the sheet, about: one map each. Rows of nearly equilateral triangles
    /// may take some more.
    pub along: Vec<usize>,
    /// The error that the quickest cell must keep, in lengths of the sheet.
    pub keep: f64,
    /// Longest nominal time of a cell, s; see [`Scheme::price`].
    pub longest: f64,
    /// Seconds of processor time so far; wall time will do on an idle machine.
    pub clock: fn() -> f64,
    /// Asked at every step; a cell that is stopped is left out.
    pub stop: fn() -> bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            schemes: Scheme::ALL.to_vec(),
            cells: 9,
            along: vec![2, 6, 14],
            keep: 1e-3,
            longest: 2.0,
            clock: wall,
            stop: || false,
        }
    }
}

/// Seconds since the first call.
#[must_use]
pub fn wall() -> f64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed().as_secs_f64()
}

/// What came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Map {
    /// Time steps, s, ascending.
    pub steps: Vec<f64>,
    /// Stiffnesses, N/m, ascending.
    pub stiffnesses: Vec<f64>,
    /// Edges along the side.
    pub along: Vec<usize>,
    /// By solver, then edge length, stiffness and time step.
    pub cells: Vec<Cell>,
    /// The error that the quickest cell keeps, in lengths.
    pub keep: f64,
    /// The quickest cell of each solver for each edge length and stiffness.
    pub quickest: Vec<Quickest>,
    /// Whether the caller stopped it.
    pub stopped: bool,
}

/// Runs what `options` ask for; `progress` hears of each cell before it begins and may stop there.
///
/// # Errors
/// When a sheet has no equilibrium to compare with.
pub fn map(options: &Options, progress: &mut Progress<'_>) -> Result<Map, ClothError> {
    let (steps, stiffnesses) = (spaced(STEPS, options.cells), spaced(STIFFNESSES, options.cells));
    let mut map = Map {
        steps,
        stiffnesses,
        along: options.along.clone(),
        cells: vec![],
        keep: options.keep,
        quickest: vec![],
        stopped: false,
    };
    let sheets = options.along.len() * map.stiffnesses.len();
    let sheet = |k: usize| (options.along[k / options.cells], map.stiffnesses[k % options.cells]);
    for (k, (along, stiffness)) in (0..sheets).map(|k| (k, sheet(k))).collect::<Vec<_>>() {
        let shares = [k as f64 / sheets as f64, 1.0 / sheets as f64];
        if row(options, &Hung::new(along, stiffness)?, shares, &mut map, progress).is_break() {
            map.stopped = true;
            break;
        }
    }
    let place = |c: &Cell| options.schemes.iter().position(|s| *s == c.scheme);
    map.cells.sort_by_key(place);
    map.quickest = quickest(&map.cells, options.keep);
    Ok(map)
}

/// All solvers and steps on one sheet; `shares` are how much of the whole is done, and how much
/// this is.
fn row(
    options: &Options,
    hung: &Hung,
    [done, part]: [f64; 2],
    map: &mut Map,
    progress: &mut Progress<'_>,
) -> ControlFlow<()> {
    for (s, &scheme) in options.schemes.iter().enumerate() {
        let dts: Vec<Option<f64>> = match scheme.steps_in_time() {
            true => map.steps.iter().copied().map(Some).collect(),
            false => vec![None],
        };
        for (d, &dt) in dts.iter().enumerate() {
            let within = (s as f64 + d as f64 / dts.len() as f64) / options.schemes.len() as f64;
            progress(done + part * within, &hung.name(scheme, dt))?;
            match cell::run(scheme, hung, dt, options) {
                Some(cell) => map.cells.push(cell),
                None => return ControlFlow::Break(()),
            }
        }
    }
    ControlFlow::Continue(())
}

/// `count` values from the first to the last, even in the logarithm.
fn spaced([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    let at = |k: usize| low * (high / low).powf(k as f64 / (count.max(2) - 1) as f64);
    (0..count.max(2)).map(at).collect()
}
