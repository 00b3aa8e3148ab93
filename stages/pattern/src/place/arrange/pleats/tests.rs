#![allow(clippy::unwrap_used)]
use super::*;
use crate::mesh::GridMesher;
use crate::place::whole::offsets;

/// A piece of 0.6 m by 0.4 m with upright lines at these places, and the pleats between them.
fn pattern(lines: &[f64], pleats: &[(PleatFold, usize, usize)]) -> Pattern {
    let corners = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.4], [0.0, 0.4]].map(|[x, y]| Point2::new(x, y));
    let edge = |name: &str| PieceEdge { name: name.into(), curve: EdgeCurve::Line };
    let line = |(k, x): (usize, &f64)| PieceLine {
        name: format!("line_{k}"),
        purpose: LinePurpose::Pleat,
        points: vec![Point2::new(*x, 0.4), Point2::new(*x, 0.2)],
    };
    let side = |k: usize| {
        vec![EdgeUse { edge: EdgeRef { panel: "skirt".into(), edge: format!("line_{k}") }, reversed: false }]
    };
    let seam = |(fold, a, b): &(PleatFold, usize, usize)| PatternSeam {
        name: format!("pleat {a} {b}"),
        kind: SeamKind::Pleat(*fold),
        sides: vec![side(*a), side(*b)],
    };
    Pattern {
        name: "skirt".into(),
        pieces: vec![Piece {
            name: "skirt".into(),
            outer: PatternLoop {
                corners: corners.into(),
                edges: ["hem", "right", "waist", "left"].map(edge).into(),
            },
            lines: lines.iter().enumerate().map(line).collect(),
            ..Piece::default()
        }],
        seams: pleats.iter().map(seam).collect(),
    }
}

/// The flat panel and the folded one.
fn made(pattern: &Pattern) -> (Panel, Folded) {
    let lowered = pattern.lower().unwrap();
    let mesher: GridMesher = toile_core::param::ron_options().from_str("(edge: \"10 mm\")").unwrap();
    let panel = mesher.run(&lowered.outlines["skirt"], &Context::quiet()).unwrap();
    let panels = Set(vec![("skirt".to_owned(), panel.clone().into())].into_iter().collect());
    let folded = fold(pattern, &offsets(&panels).unwrap()).unwrap().remove("skirt").unwrap();
    (panel, folded)
}

/// Where a flat point comes to lie, x and depth: those of the vertex nearest to it.
fn at((panel, folded): &(Panel, Folded), x: f64) -> (f64, f64) {
    let far = |p: &Point2| (p - Point2::new(x, 0.2)).norm();
    let nearest = (0..panel.positions.len())
        .min_by(|a, b| far(&panel.positions[*a]).total_cmp(&far(&panel.positions[*b])));
    let v = nearest.unwrap();
    (folded.panel.positions[v].x, folded.depth[v])
}

#[test]
fn a_knife_pleat_lays_its_first_line_over_its_second() {
    let made = made(&pattern(&[0.2, 0.3], &[(PleatFold::Knife, 0, 1)]));
    let ((fold, top), (under, deep)) = (at(&made, 0.2), at(&made, 0.3));
    assert!((fold - under).abs() < 1e-9 && top == 0.0 && (deep - 2.0 * DEEP).abs() < 1e-9);
    // In between it goes back and forth again, behind the piece before the fold.
    let (turn, depth) = at(&made, 0.25);
    assert!((fold - turn - 0.05).abs() < 2e-3 && (depth - DEEP).abs() < 1e-9, "{fold} {turn} {depth}");
    // The piece is narrower by twice the depth of the pleat, and its middle stays.
    let (left, right) = (at(&made, 0.0).0, at(&made, 0.6).0);
    assert!((right - left - 0.5).abs() < 1e-9 && (right + left - 0.6).abs() < 1e-9);
    assert_eq!((at(&made, 0.0).1, at(&made, 0.6).1), (0.0, 0.0));
    assert_eq!(made.1.told, "folded at 1 pleats, 100 mm narrower");
}

#[test]
fn a_knife_pleat_may_look_the_other_way() {
    let made = made(&pattern(&[0.4, 0.3], &[(PleatFold::Knife, 0, 1)]));
    let ((fold, top), (under, deep)) = (at(&made, 0.4), at(&made, 0.3));
    assert!((fold - under).abs() < 1e-9 && top == 0.0 && (deep - 2.0 * DEEP).abs() < 1e-9);
    assert!((at(&made, 0.35).0 - fold - 0.05).abs() < 2e-3);
    assert!((at(&made, 0.6).0 - at(&made, 0.0).0 - 0.5).abs() < 1e-9);
}

#[test]
fn the_two_folds_of_a_box_pleat_meet() {
    let made = made(&pattern(&[0.2, 0.36], &[(PleatFold::Box, 0, 1)]));
    let ((one, a), (other, b)) = (at(&made, 0.2), at(&made, 0.36));
    assert!((one - other).abs() < 1e-9 && a == 0.0 && b.abs() < 1e-9, "{one} {other} {a} {b}");
    // Its bottom lies two layers behind them, with its middle at their place.
    let (middle, deep) = at(&made, 0.28);
    assert!((middle - one).abs() < 2e-3 && (deep - 2.0 * DEEP).abs() < 1e-9, "{middle} {one} {deep}");
    assert!((at(&made, 0.6).0 - at(&made, 0.0).0 - 0.44).abs() < 1e-9);
}

#[test]
fn pleats_follow_each_other_and_keep_the_cloth_as_it_is() {
    let lines = [0.1, 0.16, 0.26, 0.32, 0.5, 0.42];
    let made = made(&pattern(
        &lines,
        &[(PleatFold::Knife, 0, 1), (PleatFold::Knife, 2, 3), (PleatFold::Knife, 4, 5)],
    ));
    let (panel, folded) = &made;
    assert!((at(&made, 0.6).0 - at(&made, 0.0).0 - 0.4).abs() < 1e-9);
    for pair in lines.chunks(2) {
        assert!((at(&made, pair[0]).0 - at(&made, pair[1]).0).abs() < 1e-9);
    }
    // Folding neither stretches nor shears: triangles that no fold crosses keep their edges.
    let length = |p: &Panel, a: u32, b: u32| (p.positions[a as usize] - p.positions[b as usize]).norm();
    let kept = panel.triangles.iter().filter(|t| {
        (0..3).all(|k| {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            (length(panel, a, b) - length(&folded.panel, a, b)).abs() < 1e-9
        })
    });
    assert!(kept.count() * 10 > panel.triangles.len() * 9);
}

#[test]
fn a_pleat_between_two_pieces_is_refused() {
    let mut wrong = pattern(&[0.2, 0.3], &[(PleatFold::Knife, 0, 1)]);
    let lowered = pattern(&[0.2, 0.3], &[]).lower().unwrap();
    let panel = GridMesher::default().run(&lowered.outlines["skirt"], &Context::quiet()).unwrap();
    let panels = Set(vec![("skirt".to_owned(), panel.into())].into_iter().collect());
    wrong.seams[0].sides[1][0].edge.panel = "band".into();
    let e = fold(&wrong, &offsets(&panels).unwrap()).err().unwrap();
    assert_eq!(e.message, "the pleat pleat 0 1 does not have two lines of one piece for its sides");
    assert_eq!(
        e.hint.unwrap(),
        "give it the line of the fold and the line that this is laid on, each as one side of one line"
    );
}
