//! Stability maps: time step against stiffness, a panel an edge length, with the theoretical limit
//! drawn over it.

use super::{Cell, Map, Outcome, Scheme};
use toile_trade::digits::to_digits;
use toile_trade::plot::axis::Axis;
use toile_trade::plot::mark::{Anchor, INK, PALE, PlotMark, SIZE, line, text};
use toile_trade::plot::{png, svg};

/// The area of all panels: left, top, right, bottom.
const AREA: [f64; 4] = [84.0, 104.0, 944.0, 500.0];
/// Between two panels, px.
const GAP: f64 = 22.0;
/// Cells narrower than this carry no sign, px.
const LEGIBLE: f64 = 16.0;
/// Colours of answers of two digits and of seven.
const GOOD: [[u8; 3]; 2] = [[206, 233, 221], [10, 78, 92]];
/// Digits of the palest and of the darkest.
const DIGITS: [f64; 2] = [2.0, 7.0];
/// At rest in a wrong place.
const OFF: [u8; 3] = [246, 196, 110];
/// Not at rest.
const DRIFTS: [u8; 3] = [209, 74, 60];
/// Refused.
const REFUSED: [u8; 3] = [226, 229, 233];
/// Too long to run.
const UNKNOWN: [u8; 3] = [249, 250, 251];
/// The limit.
const LIMIT: [u8; 3] = [20, 20, 24];

/// An SVG and a PNG for every solver of a map, by file name.
#[must_use]
pub fn pictures(map: &Map) -> Vec<(String, Vec<u8>)> {
    let both = |scheme: Scheme| {
        let marks = marks(map, scheme);
        let name = |kind: &str| format!("{}.{kind}", scheme.key());
        [(name("svg"), svg(&marks).into_bytes()), (name("png"), png(&marks))]
    };
    map.schemes().into_iter().flat_map(both).collect()
}

/// One panel: its cells, and where it lies.
struct Panel<'a> {
    cells: Vec<&'a Cell>,
    title: String,
    x: Axis,
    y: Axis,
    /// Factors from a value to the border of its cell.
    half: [f64; 2],
    /// Left, top, right, bottom.
    frame: [f64; 4],
}

fn marks(map: &Map, scheme: Scheme) -> Vec<PlotMark> {
    let mut marks = vec![
        PlotMark::Text {
            at: [AREA[0], 34.0],
            anchor: Anchor::Start,
            text: scheme.name().into(),
            colour: INK,
            large: true,
        },
        text([AREA[0], 58.0], Anchor::Start, scheme.theory(), INK),
    ];
    let panels = panels(map, scheme);
    for (k, panel) in panels.iter().enumerate() {
        marks.extend(panel.cells.iter().flat_map(|c| panel.cell(c)));
        if scheme.steps_in_time() {
            marks.extend(panel.limit());
        }
        marks.extend(panel.axes(k == 0));
    }
    let across = (AREA[0] + AREA[2]) / 2.0;
    let below = if scheme.steps_in_time() { "time step, s" } else { "edge length, mm" };
    marks.push(text([across, AREA[3] + 46.0], Anchor::Middle, below, INK));
    marks.push(text([12.0, AREA[1] - 14.0], Anchor::Start, "N/m", INK));
    marks.extend(legend());
    marks
}

fn panels(map: &Map, scheme: Scheme) -> Vec<Panel<'_>> {
    let of = |along: Option<usize>| -> Vec<&Cell> {
        let is_here = |c: &&Cell| c.scheme == scheme && along.is_none_or(|a| c.along == a);
        map.cells.iter().filter(is_here).collect()
    };
    if !scheme.steps_in_time() {
        let mut edges: Vec<f64> = of(None).iter().map(|c| Panel::across(c)).collect();
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        return vec![Panel::new(of(None), String::new(), &edges, &map.stiffnesses, AREA)];
    }
    let count = map.along.len() as f64;
    let width = (AREA[2] - AREA[0] - GAP * (count - 1.0)) / count;
    let place = |(k, &along): (usize, &usize)| {
        let left = AREA[0] + k as f64 * (width + GAP);
        let cells = of(Some(along));
        let title = cells.first().map_or(String::new(), |c| format!("edge {:.1} mm", 1e3 * c.edge));
        Panel::new(cells, title, &map.steps, &map.stiffnesses, [left, AREA[1], left + width, AREA[3]])
    };
    map.along.iter().enumerate().map(place).collect()
}

impl<'a> Panel<'a> {
    fn new(cells: Vec<&'a Cell>, title: String, across: &[f64], up: &[f64], frame: [f64; 4]) -> Self {
        let half = [half(across), half(up)];
        let ends = |values: &[f64], half: f64| {
            let (lo, hi) = values.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(*v), h.max(*v)));
            (lo / half, hi * half)
        };
        let ((x0, x1), (y0, y1)) = (ends(across, half[0]), ends(up, half[1]));
        let x = Axis::between(x0, x1, frame[0], frame[2]);
        Self { cells, title, x, y: Axis::between(y0, y1, frame[3], frame[1]), half, frame }
    }

    fn across(c: &Cell) -> f64 {
        c.dt.unwrap_or(1e3 * c.edge)
    }

    fn cell(&self, c: &Cell) -> Vec<PlotMark> {
        let v = [Self::across(c), c.stiffness];
        let low = [self.x.at(v[0] / self.half[0]) + 0.5, self.y.at(v[1] / self.half[1]) - 0.5];
        let high = [self.x.at(v[0] * self.half[0]) - 0.5, self.y.at(v[1] * self.half[1]) + 0.5];
        let (colour, sign, ink) = look(c);
        let mut marks = vec![PlotMark::Rect { corners: [low, high], colour }];
        if high[0] - low[0] > LEGIBLE && low[1] - high[1] > LEGIBLE {
            let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0 + 5.0];
            marks.push(text(middle, Anchor::Middle, &sign, ink));
        }
        marks
    }

    /// The explicit limit of each stiffness, as a dashed line cut at the frame.
    fn limit(&self) -> Vec<PlotMark> {
        let mut places: Vec<[f64; 2]> =
            self.cells.iter().map(|c| [self.x.at(c.limit), self.y.at(c.stiffness)]).collect();
        places.dedup_by(|a, b| a[1].to_bits() == b[1].to_bits());
        let inside = |p: &[f64; 2]| (self.frame[0]..=self.frame[2]).contains(&p[0]);
        let pairs = places.windows(2).filter(|w| w.iter().all(inside));
        pairs.map(|w| line(w[0], w[1], 2.5, LIMIT, true)).collect()
    }

    fn axes(&self, first: bool) -> Vec<PlotMark> {
        let [left, top, right, bottom] = self.frame;
        let mut marks = vec![
            line([left, bottom], [right, bottom], 1.5, INK, false),
            line([left, top], [left, bottom], 1.5, INK, false),
            text(
                [left, top - 14.0],
                Anchor::Start,
                &format!("{}{}", if first && !self.title.is_empty() { "    " } else { "" }, self.title),
                INK,
            ),
        ];
        let ticks =
            if self.cells.iter().any(|c| c.dt.is_some()) { decades(&self.x.ticks()) } else { self.edges() };
        for t in ticks {
            marks.push(text([self.x.at(t), bottom + 20.0], Anchor::Middle, &short(t), INK));
        }
        for t in decades(&self.y.ticks()).into_iter().filter(|_| first) {
            marks.push(text([left - 8.0, self.y.at(t) + 5.0], Anchor::End, &short(t), INK));
        }
        marks
    }

    fn edges(&self) -> Vec<f64> {
        let mut edges: Vec<f64> = self.cells.iter().map(|c| Self::across(c)).collect();
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        edges
    }
}

/// The factor from a value of an even row to the border of its cell.
fn half(values: &[f64]) -> f64 {
    let ratio = values.windows(2).map(|w| (w[1] / w[0]).ln().abs().exp()).fold(f64::INFINITY, f64::min);
    if ratio.is_finite() { ratio.sqrt() } else { 2.0_f64.sqrt() }
}

/// Colour, sign and colour of the sign of a cell.
fn look(c: &Cell) -> ([u8; 3], String, [u8; 3]) {
    let white = [255; 3];
    match (&c.outcome, c.error) {
        (Outcome::Converges, Some(e)) => {
            let digits = -e.max(1e-12).log10();
            (shade(digits), format!("{digits:.0}"), if digits > 4.0 { white } else { INK })
        }
        (Outcome::Off, _) => (OFF, "o".into(), INK),
        (Outcome::Refused { .. }, _) => (REFUSED, "x".into(), PALE),
        (Outcome::TooLong, _) => (UNKNOWN, ".".into(), PALE),
        _ => (DRIFTS, "~".into(), white),
    }
}

fn shade(digits: f64) -> [u8; 3] {
    let share = ((digits - DIGITS[0]) / (DIGITS[1] - DIGITS[0])).clamp(0.0, 1.0);
    let mix = |k: usize| f64::from(GOOD[0][k]) * (1.0 - share) + f64::from(GOOD[1][k]) * share;
    [0, 1, 2].map(|k| mix(k).round() as u8)
}

fn legend() -> Vec<PlotMark> {
    let entries = [
        (shade(2.0), "2"),
        (shade(7.0), "to 7 digits right"),
        (OFF, "o at rest, wrong"),
        (DRIFTS, "~ not at rest, blown up"),
        (REFUSED, "x refused"),
        (UNKNOWN, ". too long to run"),
    ];
    let (mut x, y) = (14.0, f64::from(SIZE[1]) - 36.0);
    let mut marks = Vec::new();
    for (colour, words) in entries {
        marks.push(PlotMark::Rect { corners: [[x, y - 12.0], [x + 16.0, y + 4.0]], colour });
        marks.push(text([x + 22.0, y], Anchor::Start, words, INK));
        x += 22.0 + 8.2 * words.len() as f64 + 14.0;
    }
    marks
}

/// Those of the ticks that are powers of ten.
fn decades(ticks: &[f64]) -> Vec<f64> {
    ticks.iter().copied().filter(|t| (t.log10() - t.log10().round()).abs() < 1e-9).collect()
}

/// `1e-5`, `0.1`, `10000`, `12.5`.
fn short(t: f64) -> String {
    let rounded = to_digits(t, 3);
    if (1e-2..1e5).contains(&rounded) { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::map::{Options, map};
    use std::ops::ControlFlow;

    #[test]
    fn every_solver_has_a_picture_of_all_its_cells_with_the_limit_over_it() {
        let schemes = vec![Scheme::Explicit, Scheme::Rest];
        let options = Options { schemes, cells: 5, along: vec![4, 6], longest: 0.01, ..Options::default() };
        let map = map(&options, &mut |_, _| ControlFlow::Continue(())).unwrap();
        let files = pictures(&map);
        let names: Vec<&str> = files.iter().map(|f| f.0.as_str()).collect();
        assert_eq!(names, ["explicit.svg", "explicit.png", "rest.svg", "rest.png"]);
        let explicit = String::from_utf8(files[0].1.clone()).unwrap();
        // Background, legend, and a cell each: 5 steps, 5 stiffnesses, 2 edges.
        assert_eq!(explicit.matches("<rect").count(), 1 + 6 + 50);
        assert!(explicit.matches("stroke-dasharray").count() >= 6);
        assert!(explicit.contains("edge ") && explicit.contains("2/omega_max"));
        let rest = String::from_utf8(files[2].1.clone()).unwrap();
        assert_eq!(rest.matches("<rect").count(), 1 + 6 + 10);
        assert!(!rest.contains("stroke-dasharray") && rest.contains("no time step"));
        let png = image::load_from_memory(&files[1].1).unwrap().to_rgb8();
        assert_eq!((png.width(), png.height()), (SIZE[0], SIZE[1]));
        assert!(png.pixels().any(|p| p.0 == REFUSED));
    }

    #[test]
    fn ticks_are_short() {
        assert_eq!([1e-5, 0.1, 1e4, 12.5, 1e6].map(short), ["1e-5", "0.1", "10000", "12.5", "1e6"]);
        assert_eq!(decades(&[1.0, 2.0, 5.0, 10.0, 1e-3]), [1.0, 10.0, 1e-3]);
    }
}
