//! Patterns of GarmentCode from a folder that the variable `TOILE_PATTERNS` names; without it this
//! is skipped.

use crate::common::*;
use std::path::PathBuf;
use toile_core::artifact::*;
use toile_pattern_files::DrawingOptions;
use toile_pattern_files::dxf::{Standard, to_dxf};
use toile_pattern_files::garment_code::to_json;
use toile_pattern_files::svg::to_svg;

fn files() -> Option<Vec<PathBuf>> {
    let folder = std::env::var_os("TOILE_PATTERNS")?;
    let all = std::fs::read_dir(folder).unwrap().map(|f| f.unwrap().path());
    let mut files: Vec<PathBuf> =
        all.filter(|f| f.to_string_lossy().ends_with("_specification.json")).collect();
    files.sort();
    Some(files)
}

/// The pieces of a file that run counter-clockwise, under names of edges that differ.
fn pattern(file: &PathBuf) -> Pattern {
    let (mut pieces, _) = read_json(&std::fs::read(file).unwrap());
    for piece in &mut pieces {
        for (k, e) in piece.outer.edges.iter_mut().enumerate() {
            e.name = format!("edge_{k}");
        }
        if polygon_area(&piece.outer.points().0) < 0.0 {
            let to = |q: Point2| p(-q.x, q.y);
            for (c, e) in piece.outer.corners.iter_mut().zip(&mut piece.outer.edges) {
                *c = to(*c);
                e.curve = e.curve.moved(to, true);
            }
        }
    }
    Pattern { name: "real".into(), pieces, seams: Vec::new() }
}

#[test]
fn outlines_of_real_patterns_come_back() {
    let Some(files) = files() else {
        eprintln!("skipped: TOILE_PATTERNS names no folder");
        return;
    };
    for file in files {
        let pattern = pattern(&file);
        let options = DrawingOptions::default();
        let drawn = [
            read_svg(&to_svg(&pattern, &options).unwrap().bytes),
            read_dxf(&to_dxf(&pattern, Standard::Aama, &options).unwrap().bytes),
        ];
        let (pieces, _) = read_json(&to_json(&pattern).unwrap().bytes);
        for (k, piece) in pattern.pieces.iter().enumerate() {
            for drawn in &drawn {
                let off = apart(piece, &drawn[k].1);
                assert!(off < 5e-5, "{}, {}: {off}", file.display(), piece.name);
            }
            for (a, b) in piece.outer.corners.iter().zip(&pieces[k].outer.corners) {
                assert!((a - b).norm() < 1e-9);
            }
            for edge in 0..piece.outer.edges.len() {
                let (a, b) = (piece.outer.path(edge), pieces[k].outer.path(edge));
                assert!((a.at(a.length() / 3.0) - b.at(b.length() / 3.0)).norm() < 1e-9);
            }
        }
    }
}
