//! The work-precision picture: time against distance, both logarithmic, with the front.

use super::axis::Axis;
use super::mark::{Anchor, GRID, INK, PALE, PlotMark, line, plain, text};
use crate::front::Cost;
use crate::record::{Measured, Trade};
use std::collections::BTreeSet;

/// The frame of the axes: left, top, right, bottom.
const FRAME: [f64; 4] = [84.0, 56.0, 936.0, 574.0];
/// Settings beyond which only those of the front are numbered: more numbers hide each other.
const MOST_NUMBERS: usize = 12;

/// Errors below it are drawn there, mm: a setting that is the reference's own has none but
/// rounding.
const LEAST: f64 = 1e-3;

fn drawn(m: &Measured, trade: &Trade) -> Cost {
    let cost = m.cost(trade.clock);
    Cost { error: cost.error.max(LEAST), ..cost }
}

/// The picture of a measurement.
pub(crate) fn marks(trade: &Trade) -> Vec<PlotMark> {
    let shown: Vec<(usize, &Measured)> =
        trade.points.iter().enumerate().filter_map(|(i, p)| Some((i, p.measured()?))).collect();
    let floor = trade.reference.floor_mm().map(|f| f.max(LEAST));
    let cost = |m: &Measured| drawn(m, trade);
    let times: Vec<f64> = shown.iter().map(|(_, m)| cost(m).time).collect();
    let errors: Vec<f64> = shown.iter().map(|(_, m)| cost(m).error).chain(floor).collect();
    let (x, y) = (Axis::over(&times, FRAME[0], FRAME[2]), Axis::over(&errors, FRAME[3], FRAME[1]));
    let mut marks = axes(&x, &y, trade);
    marks.extend(floor.into_iter().flat_map(|f| known_to(y.at(f))));
    marks.extend(steps(trade, &x, &y));
    let kinds = kinds(trade);
    for (i, m) in &shown {
        let at = [x.at(cost(m).time), y.at(cost(m).error)];
        let colour = kinds.iter().position(|k| *k == kind(trade, *i)).map_or(INK, colour);
        let on_front = trade.front.contains(i);
        marks.push(PlotMark::Dot { at, radius: if on_front { 6.5 } else { 4.5 }, colour, hollow: !m.sound });
        if on_front || shown.len() <= MOST_NUMBERS {
            marks.push(text([at[0] + 9.0, at[1] - 7.0], Anchor::Start, &(i + 1).to_string(), INK));
        }
    }
    marks.extend(legend(&kinds, shown.iter().any(|(_, m)| !m.sound)));
    marks
}

/// The line below which errors mean nothing.
fn known_to(y: f64) -> [PlotMark; 2] {
    let words = text([FRAME[0] + 8.0, y - 6.0], Anchor::Start, "the reference is known to this", PALE);
    [line([FRAME[0], y], [FRAME[2], y], 1.5, PALE, true), words]
}

fn axes(x: &Axis, y: &Axis, trade: &Trade) -> Vec<PlotMark> {
    let mut marks = Vec::new();
    for t in x.ticks() {
        marks.push(line([x.at(t), FRAME[1]], [x.at(t), FRAME[3]], 1.0, GRID, false));
        marks.push(text([x.at(t), FRAME[3] + 20.0], Anchor::Middle, &plain(t), INK));
    }
    for t in y.ticks() {
        marks.push(line([FRAME[0], y.at(t)], [FRAME[2], y.at(t)], 1.0, GRID, false));
        marks.push(text([FRAME[0] - 8.0, y.at(t) + 5.0], Anchor::End, &plain(t), INK));
    }
    marks.push(line([FRAME[0], FRAME[3]], [FRAME[2], FRAME[3]], 1.5, INK, false));
    marks.push(line([FRAME[0], FRAME[1]], [FRAME[0], FRAME[3]], 1.5, INK, false));
    let clock = if trade.clock == crate::record::Clock::Wall { "wall time" } else { "processor time" };
    let across = (FRAME[0] + FRAME[2]) / 2.0;
    marks.push(text([across, FRAME[3] + 46.0], Anchor::Middle, &format!("{clock} of a run, seconds"), INK));
    marks.push(text(
        [12.0, FRAME[1] - 16.0],
        Anchor::Start,
        "mm from the reference, 95 % of the surface",
        INK,
    ));
    marks.push(PlotMark::Text {
        at: [FRAME[2], 26.0],
        anchor: Anchor::End,
        text: trade.pipeline.clone(),
        colour: INK,
        large: true,
    });
    marks
}

/// The front as a stair: what can be had for a time.
fn steps(trade: &Trade, x: &Axis, y: &Axis) -> Vec<PlotMark> {
    let at = |i: &usize| {
        let cost = drawn(trade.points[*i].measured()?, trade);
        Some([x.at(cost.time), y.at(cost.error)])
    };
    let places: Vec<[f64; 2]> = trade.front.iter().filter_map(at).collect();
    let mut marks = Vec::new();
    for w in places.windows(2) {
        let corner = [w[1][0], w[0][1]];
        marks.push(line(w[0], corner, 2.0, PALE, false));
        marks.push(line(corner, w[1], 2.0, PALE, false));
    }
    if let Some(last) = places.last() {
        marks.push(line(*last, [FRAME[2], last[1]], 2.0, PALE, false));
    }
    marks
}

/// The stages that a point chose: `GridMesher, Rest`.
fn kind(trade: &Trade, i: usize) -> String {
    let choices = trade.knobs.iter().filter(|k| !k.key.contains('.'));
    choices.filter_map(|k| trade.points[i].setting.get(&k.key).cloned()).collect::<Vec<_>>().join(", ")
}

/// All of them that gave a garment, in a fixed order.
fn kinds(trade: &Trade) -> Vec<String> {
    let ran = (0..trade.points.len()).filter(|i| trade.points[*i].measured().is_some());
    ran.map(|i| kind(trade, i)).collect::<BTreeSet<_>>().into_iter().collect()
}

fn colour(i: usize) -> [u8; 3] {
    toile_stages::render::PANEL_COLOURS[i % toile_stages::render::PANEL_COLOURS.len()]
}

fn legend(kinds: &[String], some_miss: bool) -> Vec<PlotMark> {
    let named = kinds.iter().enumerate().filter(|(_, k)| !k.is_empty());
    let mut marks: Vec<PlotMark> = named
        .flat_map(|(i, k)| {
            let y = FRAME[1] + 18.0 + 20.0 * i as f64;
            let dot = PlotMark::Dot {
                at: [FRAME[2] - 14.0, y - 5.0],
                radius: 5.0,
                colour: colour(i),
                hollow: false,
            };
            [dot, text([FRAME[2] - 28.0, y], Anchor::End, k, INK)]
        })
        .collect();
    if !some_miss {
        return marks;
    }
    let y = FRAME[1] + 18.0 + 20.0 * kinds.iter().filter(|k| !k.is_empty()).count() as f64;
    marks.push(PlotMark::Dot { at: [FRAME[2] - 14.0, y - 5.0], radius: 5.0, colour: PALE, hollow: true });
    marks.push(text([FRAME[2] - 28.0, y], Anchor::End, "misses a quality limit", PALE));
    marks
}
