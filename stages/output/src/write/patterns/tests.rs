//! Patterns as files: what is written, and that it is read back.
#![allow(clippy::unwrap_used)]

use crate::write::{PatternDxf, PatternJson, PatternPdf, PatternPlt, PatternSvg};
use std::sync::Arc;
use toile_core::Cancel;
use toile_core::param::ron_options;
use toile_core::prelude::*;
use toile_pattern::pattern::{DxfPattern, GarmentCode, SvgPattern};

fn skirt() -> Pattern {
    let file = format!("{}/../../pipelines/samples/pattern/pleats.svg", env!("CARGO_MANIFEST_DIR"));
    let seams = format!("{}/../../pipelines/samples/pattern/pleats_seams.ron", env!("CARGO_MANIFEST_DIR"));
    let stage: SvgPattern = ron_options().from_str(&format!("(file: {file:?}, seams: {seams:?})")).unwrap();
    stage.run(&Context::quiet()).unwrap().0
}

fn written(files: OutputFiles) -> Vec<(String, Vec<u8>)> {
    files.0.into_iter().map(|f| (f.path, f.bytes)).collect()
}

/// Puts the files into a folder; a context that reads there.
fn folder(files: &[(String, Vec<u8>)]) -> (tempfile::TempDir, Context) {
    let dir = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| std::fs::write(dir.path().join(name), bytes).unwrap());
    let cx = Context::new("Reader", dir.path(), Cancel::new(), Arc::new(()));
    (dir, cx)
}

/// Lengths of the edges of a piece, ascending, mm.
fn lengths(p: &Pattern, piece: &str) -> Vec<i64> {
    let piece = p.piece(piece).unwrap();
    let mut all: Vec<i64> =
        (0..piece.outer.edges.len()).map(|k| (piece.outer.path(k).length() * 1e3).round() as i64).collect();
    all.sort_unstable();
    all
}

#[test]
fn drawings_are_read_back_with_all_kinds_of_seams() {
    let pattern = skirt();
    let cx = Context::quiet();
    let svg = written(ron_options().from_str::<PatternSvg>("()").unwrap().run(&pattern, &cx).unwrap());
    let dxf =
        written(ron_options().from_str::<PatternDxf>("(size: \"M\")").unwrap().run(&pattern, &cx).unwrap());
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|f| f.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(&svg), ["pattern.svg", "pattern.svg.seams.ron"]);
    assert_eq!(names(&dxf), ["pattern.dxf", "pattern.dxf.seams.ron"]);
    let (_dir, cx) = folder(&[svg, dxf].concat());
    let read_svg: SvgPattern =
        ron_options().from_str("(file: \"pattern.svg\", seams: \"pattern.svg.seams.ron\")").unwrap();
    let read_dxf: DxfPattern =
        ron_options().from_str("(file: \"pattern.dxf\", seams: \"pattern.dxf.seams.ron\")").unwrap();
    for back in [read_svg.run(&cx).unwrap().0, read_dxf.run(&cx).unwrap().0] {
        assert_eq!(back.seams.len(), pattern.seams.len());
        for (a, b) in back.seams.iter().zip(&pattern.seams) {
            assert_eq!((a.kind, a.sides.len()), (b.kind, b.sides.len()), "{}", b.name);
        }
        assert_eq!(lengths(&back, "POCKET"), lengths(&pattern, "POCKET"));
    }
}

#[test]
fn a_specification_is_read_back() {
    let file =
        format!("{}/../../pipelines/samples/pattern/dress_specification.json", env!("CARGO_MANIFEST_DIR"));
    let dress = GarmentCode { file }.run(&Context::quiet()).unwrap().0;
    let json =
        written(ron_options().from_str::<PatternJson>("()").unwrap().run(&dress, &Context::quiet()).unwrap());
    let (_dir, cx) = folder(&json);
    let back = GarmentCode { file: "pattern_specification.json".into() }.run(&cx).unwrap().0;
    assert_eq!((back.pieces.len(), back.seams.len()), (dress.pieces.len(), dress.seams.len()));
    for p in &dress.pieces {
        assert_eq!(lengths(&back, &p.name), lengths(&dress, &p.name), "{}", p.name);
        assert!((back.piece(&p.name).unwrap().pose.unwrap().origin - p.pose.unwrap().origin).norm() < 1e-9);
    }
}

#[test]
fn pages_are_a_pdf_and_a_wrong_name_is_refused() {
    let pdf: PatternPdf = ron_options().from_str("(paper: Letter)").unwrap();
    let files = written(pdf.run(&skirt(), &Context::quiet()).unwrap());
    assert_eq!(files.len(), 1);
    assert!(files[0].0 == "pattern.pdf" && files[0].1.starts_with(b"%PDF-"));
    let wrong: PatternPdf = ron_options().from_str("(name: \"a/b\")").unwrap();
    let e = wrong.run(&skirt(), &Context::quiet()).unwrap_err();
    assert_eq!(
        e.message,
        "the file name \"a/b\" has a character other than letters, digits, space, '-', '_' and '.'"
    );
    let none =
        ron_options().from_str::<PatternPdf>("()").unwrap().run(&Pattern::default(), &Context::quiet());
    assert_eq!(none.unwrap_err().message, "the pattern has no pieces");
}

#[test]
fn pages_of_any_size_are_asked_for_and_small_ones_refused() {
    let pdf = |arguments: &str| {
        let stage: PatternPdf = ron_options().from_str(arguments).unwrap();
        stage.run(&skirt(), &Context::quiet()).map(written)
    };
    for paper in ["A0", "Legal", "Tabloid", "Custom(\"60 cm\", \"90 cm\")"] {
        assert!(pdf(&format!("(paper: {paper})")).unwrap()[0].1.starts_with(b"%PDF-"));
    }
    let e = pdf("(paper: Custom(\"4 in\", \"6 in\"))").unwrap_err();
    assert_eq!(
        e.message,
        "a page of 102 mm by 152 mm is too small for its margins and the test square: 200 mm by 210 mm are the least"
    );
}

#[test]
fn a_plot_is_written_and_a_roll_that_is_too_narrow_refused() {
    let plt = |arguments: &str| {
        let stage: PatternPlt = ron_options().from_str(arguments).unwrap();
        stage.run(&skirt(), &Context::quiet()).map(written)
    };
    let files = plt("(name: \"roll\", cut_pen: 7, page_length: \"3 m\")").unwrap();
    assert!(files.len() == 1 && files[0].0 == "roll.plt" && files[0].1.starts_with(b"IN;"));
    assert!(files[0].1.windows(4).any(|w| w == b"SP7;"));
    assert_eq!(files, plt("(name: \"roll\", cut_pen: 7, page_length: \"3 m\")").unwrap());
    let e = plt("(width: \"10 cm\")").unwrap_err();
    assert!(e.message.ends_with("across the roll, which is 100 mm wide"), "{}", e.message);
    assert_eq!(e.param, Some("width"));
}
