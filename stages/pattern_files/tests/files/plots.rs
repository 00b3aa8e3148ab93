//! Plots, read back by a small reader of HP-GL.

use crate::common::*;
use proptest::prelude::*;
use toile_core::artifact::*;
use toile_pattern_files::allowance::{Allowances, cut_lines};
use toile_pattern_files::plt::{Along, Plot, PlotCode, to_plt};
use toile_pattern_files::{DrawingOptions, WriteError};

/// A line of a plot: its pen, and its points in units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PenLine {
    pub pen: u32,
    pub points: Vec<[i64; 2]>,
}

impl PenLine {
    fn is_closed(&self) -> bool {
        self.points.len() > 3 && self.points.first() == self.points.last()
    }

    fn bounds(&self) -> [[i64; 2]; 2] {
        let all =
            |k: usize, pick: fn(i64, i64) -> i64| self.points.iter().map(|p| p[k]).reduce(pick).unwrap();
        [[all(0, i64::min), all(1, i64::min)], [all(0, i64::max), all(1, i64::max)]]
    }

    /// Its points without the last, which is the first, metres.
    fn polygon(&self, units: f64) -> Vec<Point2> {
        let points = &self.points[..self.points.len() - 1];
        points.iter().map(|[x, y]| p(*x as f64, *y as f64) / units / 1e3).collect()
    }
}

/// The plot of the tests: one long one on a roll of 1.5 m.
pub(crate) fn plot() -> Plot {
    Plot {
        code: PlotCode::Hpgl,
        width: 1.5,
        page_length: None,
        along: Along::LongSide,
        units: 40.0,
        cut_pen: 1,
        draw_pen: 2,
    }
}

/// The pages of a plot, each with its lines.
pub(crate) fn read_plt(bytes: &[u8]) -> Vec<Vec<PenLine>> {
    let text = std::str::from_utf8(bytes).unwrap();
    let text = text.strip_prefix("\x1bE\x1b%-1B").unwrap_or(text);
    let text = text.strip_suffix("\x1b%0A\x1bE").unwrap_or(text);
    let (mut pages, mut lines) = (Vec::new(), Vec::<PenLine>::new());
    let (mut pen, mut at, mut is_down) = (0, [0, 0], false);
    for instruction in text.split(';').map(str::trim).filter(|i| !i.is_empty()) {
        let (name, values) = instruction.split_at(2);
        let numbers: Vec<f64> = values.split(',').filter_map(|v| v.parse().ok()).collect();
        let mut pairs = numbers.chunks_exact(2).map(|c| [c[0] as i64, c[1] as i64]);
        match name {
            "IN" | "PA" | "BP" | "PS" | "PW" => {}
            "SP" => pen = numbers[0] as u32,
            "PU" => {
                at = pairs.next_back().unwrap_or(at);
                is_down = false;
            }
            "PD" => {
                if !is_down {
                    lines.push(PenLine { pen, points: vec![at] });
                }
                is_down = true;
                lines.last_mut().unwrap().points.extend(pairs);
                at = *lines.last().unwrap().points.last().unwrap();
            }
            "PG" => pages.push(std::mem::take(&mut lines)),
            other => panic!("{other} is no instruction of a plot"),
        }
    }
    assert!(lines.is_empty(), "the last page has no end");
    pages
}

fn allowed() -> DrawingOptions {
    let allowances = Allowances { sewn: 0.01, free: 0.02, ..Allowances::default() };
    DrawingOptions { allowances, size: "M".into(), date: String::new() }
}

/// A polygon as it lies on the roll, at the origin, metres.
fn on_roll(polygon: &[Point2], along: Along) -> Vec<Point2> {
    let flat = at_origin(polygon);
    let size = flat.iter().fold(Point2::origin(), |a, b| a.sup(b));
    let turned: Vec<Point2> = flat.iter().map(|q| p(q.y, -q.x)).collect();
    if along == Along::Grain || size.y >= size.x { at_origin(&turned) } else { flat }
}

/// The closed lines of the first pen, each the nearest to one of the polygons; how far they are
/// apart, metres, and what is left of the lines.
fn matched<'l>(
    lines: &'l [PenLine],
    polygons: &[Vec<Point2>],
    along: Along,
) -> (Vec<&'l PenLine>, f64, usize) {
    let mut left: Vec<&PenLine> = lines.iter().filter(|l| l.pen == 1 && l.is_closed()).collect();
    let (mut found, mut worst) = (Vec::new(), 0.0_f64);
    for polygon in polygons {
        let wanted = on_roll(polygon, along);
        let off = |l: &PenLine| polygons_apart(&wanted, &at_origin(&l.polygon(40.0)));
        let best = (0..left.len()).min_by(|a, b| off(left[*a]).total_cmp(&off(left[*b]))).unwrap();
        worst = worst.max(off(left[best]));
        found.push(left.remove(best));
    }
    (found, worst, left.len())
}

/// Whether the boxes of two lines have something in common.
fn overlap(a: &PenLine, b: &PenLine) -> bool {
    let ([lo, hi], [low, high]) = (a.bounds(), b.bounds());
    (0..2).all(|k| lo[k] <= high[k] && low[k] <= hi[k])
}

#[test]
fn outlines_come_back_from_plots_within_a_twentieth_of_a_millimetre() {
    let pattern = blouse();
    for code in [PlotCode::Hpgl, PlotCode::Hpgl2] {
        for along in [Along::LongSide, Along::Grain] {
            for options in [DrawingOptions::default(), allowed()] {
                let plot = Plot { code, along, ..plot() };
                let pages = read_plt(&to_plt(&pattern, &plot, &options).unwrap().bytes);
                assert_eq!(pages.len(), 1);
                let cut = cut_lines(&pattern, &options.allowances).unwrap().lines;
                let polygons: Vec<Vec<Point2>> = pattern
                    .pieces
                    .iter()
                    .zip(cut)
                    .map(|(piece, cut)| cut.unwrap_or_else(|| piece.outer.points().0))
                    .collect();
                let (found, worst, left) = matched(&pages[0], &polygons, along);
                assert!(worst < 5e-5, "{plot:?}: {worst}");
                assert_eq!(left, 1, "the cut-out of the front");
                for (k, a) in found.iter().enumerate() {
                    assert!(found[..k].iter().all(|b| !overlap(a, b)));
                    assert!(a.bounds()[0].iter().all(|x| *x >= 0) && a.bounds()[1][1] <= 60_000);
                }
            }
        }
    }
}

#[test]
fn what_is_sewn_along_is_dashed_inside_of_what_is_cut() {
    let pattern = Pattern { pieces: vec![rectangle("panel", 0.3, 0.5)], ..Pattern::default() };
    let page = read_plt(&to_plt(&pattern, &plot(), &allowed()).unwrap().bytes).remove(0);
    // 20 mm on all sides; no edge is sewn.
    let cut: Vec<&PenLine> = page.iter().filter(|l| l.pen == 1).collect();
    assert_eq!((cut.len(), cut[0].bounds()), (1, [[0, 0], [540 * 40, 340 * 40]]));
    let corners = [[800, 800], [20_800, 800], [20_800, 12_800], [800, 12_800]];
    let on_side = |l: &PenLine, k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 4]);
        let axis = usize::from(a[0] == b[0]);
        let within = |q: &[i64; 2]| q[axis] >= a[axis].min(b[axis]) && q[axis] <= a[axis].max(b[axis]);
        l.points.iter().all(|q| q[1 - axis] == a[1 - axis] && within(q))
    };
    for k in 0..4 {
        let dashes: Vec<&PenLine> = page.iter().filter(|l| l.pen == 2 && on_side(l, k)).collect();
        let length: i64 =
            dashes.iter().map(|l| (0..2).map(|d| l.bounds()[1][d] - l.bounds()[0][d]).sum::<i64>()).sum();
        let whole = if k % 2 == 0 { 20_000.0 } else { 12_000.0 };
        assert!((length as f64 / whole - 2.0 / 3.0).abs() < 0.02, "side {k}: {length} of {whole}");
    }
    let last = page.last().unwrap();
    assert!(last.pen == 1 && last.points.len() == 5, "what is drawn comes before what is cut");
}

#[test]
fn every_seam_has_its_number_at_all_its_edges() {
    let pattern = blouse();
    let circles = |pattern: &Pattern| {
        let page = read_plt(&to_plt(pattern, &plot(), &DrawingOptions::default()).unwrap().bytes).remove(0);
        page.iter().filter(|l| l.pen == 2 && l.is_closed() && l.points.len() == 25).count()
    };
    let uses: usize = pattern.seams.iter().flat_map(|s| &s.sides).map(Vec::len).sum();
    let drill_holes = 1;
    assert_eq!(circles(&pattern), uses + drill_holes);
    assert_eq!(circles(&Pattern { seams: vec![], ..pattern }), drill_holes);
}

#[test]
fn rows_go_to_pages_and_the_language_says_how_large_they_are() {
    let pieces = ["a", "b", "c"].map(|name| rectangle(name, 0.6, 0.8)).into();
    let pattern = Pattern { pieces, ..Pattern::default() };
    let plot =
        Plot { code: PlotCode::Hpgl2, width: 1.3, page_length: Some(1.0), cut_pen: 3, draw_pen: 4, ..plot() };
    let written = to_plt(&pattern, &plot, &DrawingOptions::default()).unwrap();
    let text = String::from_utf8(written.bytes.clone()).unwrap();
    assert!(text.starts_with("\x1bE\x1b%-1BBP;IN;PA;PS32000,52000;PW0.5,3;PW0.3,4;\nSP4;\nPU"));
    assert!(text.ends_with("PU;PG;\nSP0;\x1b%0A\x1bE"));
    assert_eq!(written.notes, ["the plot needs 1.60 m of a roll of 1.30 m, 2 pages"]);
    let pages = read_plt(&written.bytes);
    let cuts = |page: &[PenLine]| page.iter().filter(|l| l.pen == 3).map(PenLine::bounds).collect::<Vec<_>>();
    assert_eq!(cuts(&pages[0]), [[[0, 0], [32_000, 24_000]], [[0, 24_400], [32_000, 48_400]]]);
    assert_eq!(cuts(&pages[1]), [[[0, 0], [32_000, 24_000]]]);
    let plain = to_plt(&pattern, &Plot { code: PlotCode::Hpgl, ..plot }, &DrawingOptions::default()).unwrap();
    assert_eq!(
        plain.notes[1..],
        [
            "coordinates go to 48400: a plotter that counts to 32767 needs `page_length: \"819 mm\"` and `width: \"819 mm\"`"
        ]
    );
    let text = String::from_utf8(plain.bytes).unwrap();
    assert!(text.starts_with("IN;PA;\nSP4;\nPU") && text.ends_with("PU;PG;\nSP0;\n"));
}

#[test]
fn a_piece_as_wide_as_the_roll_fits() {
    let pattern = Pattern { pieces: vec![rectangle("panel", 0.9, 0.9)], ..Pattern::default() };
    let plot = Plot { width: 0.91, page_length: Some(0.91), ..plot() };
    let allowances = Allowances { free: 0.005, ..Allowances::default() };
    let written =
        to_plt(&pattern, &plot, &DrawingOptions { allowances, ..DrawingOptions::default() }).unwrap();
    let page = read_plt(&written.bytes).remove(0);
    assert_eq!(page.last().unwrap().bounds(), [[0, 0], [36_400, 36_400]]);
}

#[test]
fn what_no_roll_holds_is_refused_and_what_is_lost_is_told() {
    let panel = |w: f64, h: f64| Pattern { pieces: vec![rectangle("panel", w, h)], ..Pattern::default() };
    let refused = |pattern: &Pattern, plot: &Plot| {
        let e = to_plt(pattern, plot, &DrawingOptions::default()).unwrap_err();
        (e.to_string(), e.remedy())
    };
    let whole = plot();
    assert_eq!(
        refused(&panel(1.6, 1.7), &whole),
        (
            "piece \"panel\" needs 1600 mm across the roll, which is 1500 mm wide".into(),
            "take a wider roll, or lay the long side of pieces along it"
        )
    );
    let paged = Plot { page_length: Some(1.0), ..plot() };
    assert_eq!(
        refused(&panel(0.5, 1.7), &paged),
        (
            "piece \"panel\" needs 1700 mm along the roll, pages are 1000 mm long".into(),
            "take longer pages, or none: the plot is one piece then"
        )
    );
    assert_eq!(
        refused(&panel(0.5, 300.0), &whole),
        (
            "the plot needs 300.0 m of the roll, 209.7 m are the most that plotters count".into(),
            "plot fewer pieces at a time, on a wider roll, or on pages"
        )
    );
    assert_eq!(
        refused(&panel(0.5, 0.5), &Plot { units: f64::NAN, ..plot() }),
        (
            "a plotter has NaN units a millimetre, 1 to 1000 are taken".into(),
            "take 40, which is 1016 an inch, unless the plotter's manual has another number"
        )
    );
    assert!(matches!(
        to_plt(&panel(0.5, 0.5), &Plot { width: f64::NAN, ..plot() }, &DrawingOptions::default()),
        Err(WriteError::Roll { .. })
    ));
    let mut odd = panel(1e-6, 1e-6);
    odd.pieces[0].name = "袖".into();
    let written = to_plt(&odd, &whole, &DrawingOptions::default()).unwrap();
    assert_eq!(
        written.warnings,
        [
            "1 names have letters that the fonts do not: question marks stand for them",
            "piece \"袖\" is smaller than a unit of the plotter: it is not cut"
        ]
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn rectangles_lie_on_every_roll_without_overlap(
        sizes in prop::collection::vec((0.002..1.6_f64, 0.002..1.6_f64), 1..12),
        width in 0.3..2.0_f64,
        page_length in prop::option::of(0.5..3.0_f64),
        units in prop_oneof![Just(40.0), 1.0..400.0_f64],
        along in prop_oneof![Just(Along::LongSide), Just(Along::Grain)],
    ) {
        let pieces = sizes.iter().enumerate().map(|(k, (w, h))| rectangle(&k.to_string(), *w, *h)).collect();
        let pattern = Pattern { pieces, ..Pattern::default() };
        let plot = Plot { width, page_length, units, along, ..plot() };
        let short = |(w, h): &(f64, f64)| if along == Along::LongSide { w.min(*h) } else { *w };
        let long = |(w, h): &(f64, f64)| if along == Along::LongSide { w.max(*h) } else { *h };
        // Words may need more room than a small piece.
        let words = 0.05;
        match to_plt(&pattern, &plot, &DrawingOptions::default()) {
            Ok(written) => {
                let pages = read_plt(&written.bytes);
                let reach = |metres: f64| (metres * 1e3 * units).ceil() as i64;
                for page in &pages {
                    let cut: Vec<&PenLine> = page.iter().filter(|l| l.pen == 1).collect();
                    for (k, a) in cut.iter().enumerate() {
                        prop_assert!(cut[..k].iter().all(|b| !overlap(a, b)));
                    }
                    for [x, y] in page.iter().flat_map(|l| &l.points) {
                        prop_assert!(*x >= 0 && *y >= 0 && *y <= reach(width));
                        prop_assert!(page_length.is_none_or(|l| *x <= reach(l)));
                    }
                }
                let cut = pages.iter().flatten().filter(|l| l.pen == 1).count();
                prop_assert_eq!(cut, sizes.len());
            }
            Err(WriteError::Roll { .. }) => {
                prop_assert!(sizes.iter().any(|s| short(s) > width || short(s) < words && width < words));
            }
            Err(WriteError::PlotPage { .. }) => {
                prop_assert!(sizes.iter().any(|s| page_length.is_some_and(|l| long(s) > l)));
            }
            Err(e) => prop_assert!(false, "{}", e),
        }
    }
}
