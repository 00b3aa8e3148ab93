//! Pleats of a skirt that a photo shows laid: strips of cloth let into the piece from waist to hem,
//! and the lines that are laid on each other.
//!
//! Waist and hem are parted at equal shares of their lengths; what lies beyond is moved out by the
//! cloth of a pleat, so that every pleat is as wide below as above. The photo is laid over the
//! piece as it lies: it is drawn apart over the pleats' cloth, as over gathers. Limit: a pattern in
//! the photo is drawn apart as well.

use crate::style::block::template::curve::Curve;
use crate::style::block::template::flat::{Flat, FlatEdge, PleatLine, Run, straight};
use toile_core::prelude::*;

/// A pleat's seam begins so far below the waist, metres: its layers hang free of the edge.
const BELOW: f64 = 5e-3;

/// How pleats are laid.
#[choice]
#[derive(Copy, Eq)]
pub enum Fold {
    /// All to one side.
    Knife,
    /// Both edges of a pleat away from its middle.
    Box,
}

impl From<Fold> for PleatFold {
    fn from(fold: Fold) -> Self {
        match fold {
            Fold::Knife => PleatFold::Knife,
            Fold::Box => PleatFold::Box,
        }
    }
}

/// The pleats of a layer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pleats {
    pub count: u32,
    /// What each takes up, metres.
    pub cloth: f64,
    pub fold: Fold,
    /// How far down each is sewn, metres.
    pub stitched: f64,
}

impl Pleats {
    /// The piece with its pleats; it has one waist, that runs towards negative u, and one hem, that
    /// runs back.
    pub(super) fn let_into(self, flat: Flat) -> Flat {
        let half = 0.5 * f64::from(self.count) * self.cloth;
        let (mut tops, mut feet) = (Vec::new(), Vec::new());
        let mut at = half;
        let mut edges = Vec::with_capacity(flat.edges.len());
        for FlatEdge { role, hand, run } in flat.edges {
            let run = match role {
                EdgeRole::Waist => {
                    let (run, found) = self.parted(&run, half, -self.cloth);
                    (tops, at) = (found, -half);
                    run
                }
                EdgeRole::Hem => {
                    let (run, found) = self.parted(&run, -half, self.cloth);
                    (feet, at) = (found, half);
                    run
                }
                _ => run.changed(false, |c| c.moved(|p| Point2::new(p.x + at, p.y))),
            };
            edges.push(FlatEdge { role, hand, run });
        }
        let strips = tops.into_iter().zip(feet.into_iter().rev()).enumerate();
        let lines = strips.flat_map(|(k, ([right, left], [foot_left, foot_right]))| {
            self.lines(k + 1, [left, right], [foot_left, foot_right])
        });
        Flat { lines: lines.collect(), edges, ..flat }
    }

    /// The lines of a pleat: those that are sewn, and the edges at which the cloth is folded, down
    /// to the hem.
    fn lines(self, number: usize, tops: [Point2; 2], feet: [Point2; 2]) -> Vec<(PleatLine, [Point2; 2])> {
        let at = |[a, b]: [Point2; 2], share: f64| a + (b - a) * share;
        let length = (feet[0] - tops[0]).norm().max(f64::MIN_POSITIVE);
        let sewn = (self.stitched / length).min(1.0);
        let top = (BELOW / length).min(0.5 * sewn);
        let along = |share: f64, from: f64, to: f64| {
            let [top, foot] = [at(tops, share), at(feet, share)];
            [at([top, foot], from), at([top, foot], to)]
        };
        let mut lines = vec![
            (PleatLine::A(number), along(0.0, top, sewn)),
            (PleatLine::B(number), along(1.0, top, sewn)),
        ];
        let folds: &[f64] = match self.fold {
            Fold::Knife => &[0.5],
            Fold::Box => &[0.25, 0.75],
        };
        lines.extend(
            folds
                .iter()
                .enumerate()
                .map(|(k, share)| (PleatLine::Fold(number, k + 1), along(*share, 0.0, 1.0))),
        );
        let below: &[f64] = match self.fold {
            Fold::Knife => &[0.0],
            Fold::Box => &[0.0, 1.0],
        };
        lines.extend(
            below
                .iter()
                .enumerate()
                .map(|(k, share)| (PleatLine::Edge(number, k + 1), along(*share, sewn, 1.0))),
        );
        lines
    }

    /// A run whose parts are moved by `first`, and by `more` beyond each pleat, with the ends of
    /// the strips between them.
    fn parted(self, run: &Run, first: f64, more: f64) -> (Run, Vec<[Point2; 2]>) {
        let curves = run.curves();
        let lengths: Vec<f64> = curves.iter().map(Curve::length).collect();
        let whole: f64 = lengths.iter().sum();
        let places = (0..self.count).map(|k| (f64::from(k) + 0.5) / f64::from(self.count) * whole);
        let mut places = places.peekable();
        let (mut offset, mut before) = (first, 0.0);
        let (mut made, mut strips) = (Vec::new(), Vec::new());
        for (curve, length) in curves.iter().zip(lengths) {
            let mut rest = *curve;
            let mut done = before;
            while let Some(place) = places.next_if(|p| *p <= before + length) {
                let [part, beyond] = rest.parted(rest.parameter(place - done));
                let moved = |p: Point2, by: f64| Point2::new(p.x + by, p.y);
                made.push(part.moved(|p| moved(p, offset)));
                let ends = [moved(part.0[3], offset), moved(part.0[3], offset + more)];
                made.push(straight(ends[0], ends[1]));
                strips.push(ends);
                (rest, done, offset) = (beyond, place, offset + more);
            }
            made.push(rest.moved(|p| Point2::new(p.x + offset, p.y)));
            before += length;
        }
        (Run::Chain(made), strips)
    }
}
