#![allow(clippy::unwrap_used)]
use super::super::{LinePurpose, PatternLoop, PieceLine};
use super::*;
use crate::artifact::Artifact;

/// A skirt of 0.6 m with upright lines from its waist, and a waistband that is sewn to the waist.
fn skirt(lines: &[f64], pleats: &[(PleatFold, usize, usize)]) -> Pattern {
    let piece = |name: &str, width: f64, height: f64, edges: [&str; 4], lines: Vec<PieceLine>| Piece {
        name: name.into(),
        outer: PatternLoop {
            corners: [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]
                .map(|[x, y]| Point2::new(x, y))
                .into(),
            edges: edges.map(|n| PieceEdge { name: n.into(), curve: EdgeCurve::Line }).into(),
        },
        lines,
        ..Piece::default()
    };
    let line = |(k, x): (usize, &f64)| PieceLine {
        name: format!("line_{k}"),
        purpose: LinePurpose::Pleat,
        points: vec![Point2::new(*x, 0.3), Point2::new(*x, 0.4)],
    };
    let one = |panel: &str, edge: &str, reversed| {
        vec![EdgeUse { edge: EdgeRef { panel: panel.into(), edge: edge.into() }, reversed }]
    };
    let pleat = |(fold, a, b): &(PleatFold, usize, usize)| PatternSeam {
        name: format!("pleat {a}"),
        kind: SeamKind::Pleat(*fold),
        sides: vec![one("skirt", &format!("line_{a}"), false), one("skirt", &format!("line_{b}"), false)],
    };
    let waist = PatternSeam {
        name: "waist".into(),
        kind: SeamKind::Matched,
        sides: vec![one("band", "low", false), one("skirt", "waist", true)],
    };
    Pattern {
        name: "skirt".into(),
        pieces: vec![
            piece(
                "skirt",
                0.6,
                0.4,
                ["hem", "right", "waist", "left"],
                lines.iter().enumerate().map(line).collect(),
            ),
            piece("band", 0.5, 0.04, ["low", "end_a", "top", "end_b"], vec![]),
        ],
        seams: std::iter::once(waist).chain(pleats.iter().map(pleat)).collect(),
    }
}

fn sides(pattern: &Pattern, name: &str) -> Vec<Vec<String>> {
    let seam = pattern.seams.iter().find(|s| s.name == name).unwrap();
    let word = |u: &EdgeUse| format!("{}{}", if u.reversed { "-" } else { "" }, u.edge.edge);
    seam.sides.iter().map(|side| side.iter().map(word).collect()).collect()
}

#[test]
fn the_three_layers_of_a_knife_pleat_are_sewn_into_the_waist() {
    // The waist runs from right to left, so that the lines end on it at 0.3 and 0.2 m from its
    // start.
    let made = skirt(&[0.3, 0.4], &[(PleatFold::Knife, 0, 1)]).pleated().unwrap();
    let lengths: Vec<f64> =
        (1..=5).map(|k| made.pieces[0].path(&format!("waist_{k}")).unwrap().length()).collect();
    for (found, wanted) in lengths.iter().zip([0.2, 0.05, 0.05, 0.05, 0.25]) {
        assert!((found - wanted).abs() < 1e-12, "{lengths:?}");
    }
    assert_eq!(sides(&made, "pleat 0 at waist"), [["-waist_3"], ["waist_2"], ["waist_4"]]);
    // The band is sewn to what is seen.
    assert_eq!(sides(&made, "waist"), [vec!["low"], vec!["-waist_5", "-waist_4", "-waist_1"]]);
    let seen = made.side_length(&made.seams[0].sides[1]);
    assert!((seen - 0.5).abs() < 1e-12 && made.check().is_ok());
    let lowered = skirt(&[0.3, 0.4], &[(PleatFold::Knife, 0, 1)]).lower().unwrap();
    assert_eq!(lowered.notes, Vec::<String>::new());
}

#[test]
fn both_halves_of_a_box_pleat_are_sewn_into_the_waist() {
    let made = skirt(&[0.2, 0.4], &[(PleatFold::Box, 0, 1)]).pleated().unwrap();
    let seams: Vec<&str> = made.seams.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(seams, ["waist", "pleat 0", "pleat 0 at waist", "pleat 0 at waist"]);
    assert_eq!(made.seams[2].sides.len(), 3);
    for s in &made.seams[2..] {
        assert!(s.sides.iter().all(|side| (made.side_length(side) - 0.05).abs() < 1e-12));
    }
    assert!((made.side_length(&made.seams[0].sides[1]) - 0.4).abs() < 1e-12);
}

#[test]
fn a_pleat_that_covers_another_is_sewn_to_itself_alone() {
    let made = skirt(&[0.3, 0.4, 0.29, 0.19], &[(PleatFold::Knife, 0, 1), (PleatFold::Knife, 2, 3)])
        .pleated()
        .unwrap();
    assert_eq!(sides(&made, "pleat 0 at waist").len(), 2);
    assert_eq!(sides(&made, "pleat 2 at waist").len(), 2);
    assert!(made.check().is_ok());
}

#[test]
fn a_pleat_inside_a_piece_leaves_the_edges_alone() {
    let mut inside = skirt(&[0.3, 0.4], &[(PleatFold::Knife, 0, 1)]);
    inside.pieces[0].lines.iter_mut().for_each(|l| l.points.iter_mut().for_each(|p| p.y -= 0.1));
    assert!(inside.pleated().is_none());
    assert!(skirt(&[], &[]).pleated().is_none());
}
