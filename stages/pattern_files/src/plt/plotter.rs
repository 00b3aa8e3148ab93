//! The lines that a pen or a knife runs along, millimetres.
//!
//! Line types of a plotter differ in what their lengths are measured by, and cutters have none: the
//! dashes of a line are drawn one by one. A plot has no filled polygons, these are outlines.

use super::letters;
use crate::drawing::{DrawingSurface, Style, TextAnchor, Type};
use crate::font;

/// Sides of a circle: chords of one of 3 mm leave it by 0.03 mm.
const SIDES: usize = 24;

/// A line, and whether the cloth is cut along it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Track {
    pub cut: bool,
    pub points: Vec<[f64; 2]>,
}

/// Lines in the order in which they were drawn.
#[derive(Debug, Default)]
pub(super) struct Plotter(pub Vec<Track>);

impl Plotter {
    fn drawn(&mut self, points: Vec<[f64; 2]>) {
        self.0.push(Track { cut: false, points });
    }
}

impl DrawingSurface for Plotter {
    fn line(&mut self, points: &[[f64; 2]], style: Style) {
        match style.dash.is_empty() {
            true => self.0.push(Track { cut: style.cut, points: points.to_vec() }),
            false => dashes(points, style.dash).into_iter().for_each(|dash| self.drawn(dash)),
        }
    }

    fn closed(&mut self, points: &[[f64; 2]], style: Style) {
        let points: Vec<[f64; 2]> = points.iter().chain(points.first()).copied().collect();
        self.line(&points, style);
    }

    fn filled(&mut self, points: &[[f64; 2]], _grey: f64) {
        self.drawn(points.iter().chain(points.first()).copied().collect());
    }

    fn circle(&mut self, [x, y]: [f64; 2], r: f64, _style: Style) {
        let at = |k: usize| {
            let (sine, cosine) = (std::f64::consts::TAU * (k % SIDES) as f64 / SIDES as f64).sin_cos();
            [x + r * cosine, y + r * sine]
        };
        self.drawn((0..=SIDES).map(at).collect());
    }

    fn text(&mut self, [x, y]: [f64; 2], kind: Type, text: &str) {
        let back = match kind.hold {
            TextAnchor::Start => 0.0,
            TextAnchor::Middle => font::width(text, kind.size, kind.bold) / 2.0,
        };
        let to = |[along, up]: [f64; 2]| match kind.upright {
            false => [x - back + along, y + up],
            true => [x - up, y - back + along],
        };
        for line in letters::strokes(text, kind.size, kind.bold) {
            self.drawn(line.into_iter().map(to).collect());
        }
    }
}

/// The dashes of a line: lengths of dashes and of gaps in turns.
fn dashes(points: &[[f64; 2]], lengths: &[f32]) -> Vec<Vec<[f64; 2]>> {
    let mut out = Vec::new();
    let (mut k, mut left) = (0, f64::from(lengths[0]));
    let mut dash: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let whole = (b[0] - a[0]).hypot(b[1] - a[1]);
        let mut done = 0.0;
        while whole - done > left {
            done += left;
            let share = done / whole;
            let at = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
            if k % 2 == 0 {
                dash.push(at);
                out.push(std::mem::take(&mut dash));
            } else {
                dash = vec![at];
            }
            k = (k + 1) % lengths.len();
            left = f64::from(lengths[k]);
        }
        left -= whole - done;
        if k % 2 == 0 {
            dash.push(b);
        }
    }
    if k % 2 == 0 && dash.len() > 1 {
        out.push(dash);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_run_around_corners_and_end_with_the_line() {
        let line = [[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]];
        assert_eq!(dashes(&line, &[4.0, 2.0]), [vec![[0.0, 0.0], [4.0, 0.0]], vec![[5.0, 1.0], [5.0, 5.0]]]);
        assert_eq!(dashes(&line, &[6.0, 9.0]), [vec![[0.0, 0.0], [5.0, 0.0], [5.0, 1.0]]]);
        assert!(dashes(&[], &[4.0, 2.0]).is_empty());
    }
}
