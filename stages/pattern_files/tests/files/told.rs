//! What is refused and what is told, word for word.

use crate::common::*;
use crate::plots::plot;
use toile_core::artifact::*;
use toile_pattern_files::allowance::Allowances;
use toile_pattern_files::dxf::{Standard, to_dxf};
use toile_pattern_files::garment_code::to_json;
use toile_pattern_files::pdf::{Paper, to_pdf};
use toile_pattern_files::plt::to_plt;
use toile_pattern_files::svg::to_svg;
use toile_pattern_files::{DrawingOptions, WriteError, sidecar};

fn two_sided(e: WriteError) -> (String, &'static str) {
    (e.to_string(), e.remedy())
}

#[test]
fn what_no_format_holds_is_refused_by_all() {
    let refused = |pattern: &Pattern| {
        let errors = [
            to_json(pattern).unwrap_err(),
            to_svg(pattern, &DrawingOptions::default()).unwrap_err(),
            to_dxf(pattern, Standard::Aama, &DrawingOptions::default()).unwrap_err(),
            to_pdf(pattern, Paper::A4, &DrawingOptions::default()).unwrap_err(),
            to_plt(pattern, &plot(), &DrawingOptions::default()).unwrap_err(),
        ];
        assert!(errors.iter().all(|e| *e == errors[0]));
        two_sided(errors[0].clone())
    };
    assert_eq!(
        refused(&Pattern::default()),
        ("the pattern has no pieces".into(), "give a pattern that has pieces")
    );
    let mut pattern = blouse();
    pattern.pieces[1].outer.corners[2].x = f64::NAN;
    assert_eq!(
        refused(&pattern),
        (
            "the pattern is not sound: piece \"back\": corner 2 is not a finite number below 1e9".into(),
            "correct the pattern before it is written"
        )
    );
    let mut pattern = blouse();
    pattern.pieces[1] = rectangle("back", 2e6, 1.0);
    assert_eq!(
        refused(&pattern),
        (
            "piece \"back\" reaches 2000000 m from its origin, 1000 m are the most".into(),
            "correct the unit of the pattern, which is the metre"
        )
    );
}

#[test]
fn more_paper_than_there_is_is_refused() {
    let large = Pattern { name: "tent".into(), pieces: vec![rectangle("roof", 9.0, 9.0)], seams: vec![] };
    let options = DrawingOptions::default();
    assert_eq!(
        two_sided(to_pdf(&large, Paper::A4, &options).unwrap_err()),
        (
            "the pieces need 1734 pages, 500 are the most".into(),
            "write fewer pieces at a time, on larger pages, or in one piece"
        )
    );
    assert_eq!(
        two_sided(to_pdf(&large, Paper::OnePiece, &options).unwrap_err()),
        (
            "the pieces need a sheet of 9.0 m by 9.2 m, 5.1 m are the most of a page".into(),
            "write it on A4 or Letter pages"
        )
    );
}

#[test]
fn allowances_that_cannot_be_cut_are_refused() {
    let options = DrawingOptions {
        allowances: Allowances { sewn: 0.5, ..Allowances::default() },
        ..DrawingOptions::default()
    };
    assert_eq!(
        two_sided(to_svg(&blouse(), &options).unwrap_err()),
        (
            "the allowance of edges that are sewn is 500 mm, it is at least 0 and at most 200 mm".into(),
            "give the allowance in metres, such as 0.01"
        )
    );
}

#[test]
fn names_that_a_format_cannot_hold_are_changed_and_told() {
    let mut pattern = blouse();
    pattern.seams.clear();
    for (piece, name) in pattern.pieces.iter_mut().zip(["Ärmel <1> \"a\" & b", "fold", "袖.v2", "-x"]) {
        piece.name = name.into();
    }
    let svg = to_svg(&pattern, &DrawingOptions::default()).unwrap();
    let names: Vec<String> = read_svg(&svg.bytes).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["Ärmel <1> \"a\" & b", "fold of the garment", "袖_v2", "_x"]);
    assert_eq!(
        svg.notes[..3],
        [
            "1 places around the body are left out: a drawing has none",
            "1 depths of notches are left out: a drawing has none",
            "2 purposes of lines inside pieces are left out: a drawing has none",
        ]
    );
    assert_eq!(svg.notes[3], "piece \"fold\" is called \"fold of the garment\" in the drawing");
    let dxf = to_dxf(&pattern, Standard::Aama, &DrawingOptions::default()).unwrap();
    let names: Vec<String> = read_dxf(&dxf.bytes).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["Ärmel <1> \"a\" & b", "fold", "\\U+8896_v2", "_x"]);
    let pdf = to_pdf(&pattern, Paper::A4, &DrawingOptions::default()).unwrap();
    assert_eq!(pdf.warnings, ["1 names have letters that the fonts do not: question marks stand for them"]);
    let (pieces, _) = read_json(&to_json(&pattern).unwrap().bytes);
    assert!(pieces.iter().zip(&pattern.pieces).all(|(a, b)| a.name == b.name));
}

#[test]
fn seams_that_cannot_be_named_are_told() {
    let mut pattern = blouse();
    pattern.pieces[3].name = "pocket.1".into();
    pattern.seams.retain(|s| s.name == "pocket");
    pattern.seams[0].sides[0][0].edge.panel = "pocket.1".into();
    let (text, told) = sidecar(&pattern);
    assert_eq!(text, "(\n    seams: [\n    ],\n)\n");
    assert_eq!(
        told,
        ["the seam \"pocket\" is left out of the file of seams: pocket.1.hem cannot be named there"]
    );
}
