//! Patterns drawn at random: nothing panics, names come back, files are well formed.

use crate::common::*;
use crate::plots::{plot, read_plt};
use proptest::prelude::*;
use std::collections::BTreeSet;
use toile_core::artifact::*;
use toile_pattern_files::allowance::Allowances;
use toile_pattern_files::dxf::{Standard, to_dxf};
use toile_pattern_files::garment_code::to_json;
use toile_pattern_files::pdf::{Paper, to_pdf};
use toile_pattern_files::plt::{Plot, PlotCode, to_plt};
use toile_pattern_files::svg::to_svg;
use toile_pattern_files::{DrawingOptions, WriteError};

/// Names as people and programs give them, and as nobody does.
fn name() -> impl Strategy<Value = String> {
    let odd = prop::sample::select(vec![
        "front",
        "fold",
        "hole",
        "Seam allowance",
        "grainline",
        "a.b",
        "-a",
        " a ",
        "<&>\"'",
        "a\nb",
        "%%d",
        "\\P",
        "^I",
        "é",
        "ä\u{308}",
        "袖",
        "\u{1f457}",
        "\u{202e}abc",
        "edge_0",
        "line_0",
        "cut 2",
        "Units: ENGLISH",
        "\u{fffe}",
        "]]>",
        "--",
    ]);
    prop_oneof![
        odd.prop_map(str::to_owned),
        ".{1,12}",
        "[a-z_]{1,8}",
        (200..400_usize).prop_map(|n| "long name ".repeat(n / 10)),
    ]
}

fn curve() -> impl Strategy<Value = EdgeCurve> {
    let q = || (-0.6..0.6_f64, -0.6..0.6_f64).prop_map(|(x, y)| p(x, y));
    prop_oneof![
        3 => Just(EdgeCurve::Line),
        1 => q().prop_map(|control| EdgeCurve::Quadratic { control }),
        1 => (q(), q()).prop_map(|(a, b)| EdgeCurve::Cubic { controls: [a, b] }),
        1 => prop_oneof![-1.5..1.5_f64, Just(1.0), Just(-1.0), Just(1e-13), Just(90.0)].prop_map(|bulge| EdgeCurve::Arc { bulge }),
        1 => prop::collection::vec(q(), 1..12).prop_map(|points| EdgeCurve::Polyline { points }),
    ]
}

/// A piece around the origin of some size, some of its corners almost or wholly on each other.
fn piece() -> impl Strategy<Value = Piece> {
    let corner = (
        prop_oneof![4 => 0.3..0.5_f64, 1 => Just(0.4)],
        prop_oneof![6 => 0.2..1.0_f64, 1 => 0.0..1e-6_f64],
        curve(),
        name(),
    );
    let size = prop_oneof![6 => Just(1.0_f64), 1 => 1e-6..1e-2_f64, 1 => 1.0..8.0_f64];
    let marks = (any::<bool>(), 0.0..1.0_f64, 0..5_usize);
    (prop::collection::vec(corner, 2..7), size, name(), marks).prop_map(
        |(rim, size, name, (marked, along, purpose))| {
            let whole: f64 = rim.iter().map(|(_, step, _, _)| step).sum();
            let mut angle = 0.0;
            let mut corners = Vec::new();
            for (r, step, _, _) in &rim {
                corners.push(p(angle_of(angle, whole).cos() * r, angle_of(angle, whole).sin() * r) * size);
                angle += step;
            }
            let n = rim.len();
            let mut taken = BTreeSet::new();
            let edges = (0..n).map(|k| {
                let middle = nalgebra::center(&corners[k], &corners[(k + 1) % n]);
                let curve = rim[k].2.moved(|q| middle + q.coords * 0.3 * size, false);
                let mut name = rim[k].3.clone();
                while !taken.insert(name.clone()) {
                    name.push('x');
                }
                edge(&name, curve)
            });
            let outer = PatternLoop { edges: edges.collect(), corners };
            let mut piece = Piece { name, outer, ..Piece::default() };
            if marked {
                let edge = piece.outer.edges[0].name.clone();
                let length = piece.outer.path(0).length();
                let purposes = [
                    LinePurpose::Dart,
                    LinePurpose::Fold,
                    LinePurpose::Placement,
                    LinePurpose::Cut,
                    LinePurpose::Mark,
                ];
                piece.notches = vec![Notch { edge, along: along * length, depth: 0.004 }];
                let points = vec![p(0.0, 0.0), p(0.1 * size, 0.2 * size)];
                piece.lines =
                    vec![PieceLine { name: "an inner line".into(), purpose: purposes[purpose], points }];
                piece.drill_holes = vec![p(0.05, 0.02) * size];
            }
            piece
        },
    )
}

fn angle_of(at: f64, whole: f64) -> f64 {
    std::f64::consts::TAU * at / whole.max(1e-9)
}

/// A piece and an edge by numbers, and whether a side runs along it from its end.
type Link = (usize, usize, bool);

fn pattern() -> impl Strategy<Value = Pattern> {
    let links = || prop::collection::vec((0..4_usize, 0..8_usize, any::<bool>()), 1..3);
    let kind = prop::sample::select(vec![
        SeamKind::Matched,
        SeamKind::Gathered,
        SeamKind::Dart,
        SeamKind::Patch,
        SeamKind::Folded { angle: 1.0 },
        SeamKind::Elastic { ratio: 0.8, stiffness: 30.0 },
    ]);
    let seams = prop::collection::vec((name(), kind, prop::collection::vec(links(), 2..4)), 0..5);
    (prop::collection::vec(piece(), 0..4), seams, name()).prop_map(|(mut pieces, seams, name)| {
        let mut taken = BTreeSet::new();
        for p in &mut pieces {
            while !taken.insert(p.name.clone()) {
                p.name.push('y');
            }
        }
        let one = |(i, k, reversed): &Link| {
            let piece = &pieces[i % pieces.len()];
            let edge = piece.outer.edges[k % piece.outer.edges.len()].name.clone();
            EdgeUse { edge: EdgeRef { panel: piece.name.clone(), edge }, reversed: *reversed }
        };
        let seam = |(name, kind, sides): (String, SeamKind, Vec<Vec<Link>>)| PatternSeam {
            name,
            kind,
            sides: sides.iter().map(|s| s.iter().map(one).collect()).collect(),
        };
        let seams = if pieces.is_empty() { Vec::new() } else { seams.into_iter().map(seam).collect() };
        Pattern { name, pieces, seams }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn whatever_is_drawn_is_written_or_refused(pattern in pattern(), sewn in 0.0..0.05_f64, free in 0.0..0.05_f64) {
        let options = DrawingOptions {
            allowances: Allowances { sewn, free, ..Allowances::default() },
            size: pattern.name.clone(),
            date: pattern.name.clone(),
        };
        let sound = pattern.check().is_ok() && !pattern.pieces.is_empty();
        let json = to_json(&pattern);
        let json = match json {
            Ok(json) => json,
            Err(WriteError::Far { .. }) => return Ok(()),
            Err(_) => {
                prop_assert!(!sound);
                return Ok(());
            }
        };
        prop_assert!(sound);
        let (pieces, _) = read_json(&json.bytes);
        prop_assert!(pieces.iter().zip(&pattern.pieces).all(|(a, b)| a.name == b.name));
        for options in [&options, &DrawingOptions::default()] {
            let svg = to_svg(&pattern, options).unwrap();
            let drawn = read_svg(&svg.bytes);
            prop_assert_eq!(drawn.len(), pattern.pieces.len());
            let distinct: BTreeSet<&String> = drawn.iter().map(|(name, _)| name).collect();
            prop_assert_eq!(distinct.len(), drawn.len());
            prop_assert!(drawn.iter().all(|(name, _)| !name.contains('.') && !name.starts_with('-') && name.trim() == name));
            for standard in [Standard::Aama, Standard::Astm] {
                let dxf = to_dxf(&pattern, standard, options).unwrap();
                let texts = tags(&dxf.bytes);
                let named = texts.iter().filter(|(code, text)| *code == 1 && text.starts_with("Piece Name: ")).count();
                prop_assert_eq!(named, pattern.pieces.len());
            }
            for code in [PlotCode::Hpgl, PlotCode::Hpgl2] {
                let plot = Plot { code, width: 2.0, ..plot() };
                match to_plt(&pattern, &plot, options) {
                    Ok(plt) => {
                        let pages = read_plt(&plt.bytes);
                        let mut points = pages.iter().flatten().flat_map(|t| &t.points);
                        prop_assert!(points.all(|q| q[0] >= 0 && (0..=80_000).contains(&q[1])));
                    }
                    Err(e) => prop_assert!(matches!(e, WriteError::Roll { .. }), "{e}"),
                }
            }
            for paper in [Paper::A4, Paper::OnePiece] {
                if let Ok(pdf) = to_pdf(&pattern, paper, options) {
                    prop_assert!(pdf.bytes.starts_with(b"%PDF-") && pdf.bytes.ends_with(b"%%EOF"));
                }
            }
        }
    }
}
