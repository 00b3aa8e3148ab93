#![allow(clippy::unwrap_used)]

use super::*;
use proptest::prelude::*;
use toile_core::param::ron_options;
use toile_core::testkit::{dress, shapes};

/// The pattern of the suite: front and back of 540 by 500 mm, sewn at shoulders and sides. Corners
/// 0 to 5 start hem, side_left, shoulder_left, neck, shoulder_right and side_right.
fn pattern() -> Pattern {
    dress::pattern()
}

fn alter(alterations: &str) -> Alter {
    ron_options().from_str(&format!("(alterations: [{alterations}])")).unwrap()
}

fn run(of: &Pattern, alterations: &str) -> Result<Pattern, StageError> {
    Ok(alter(alterations).run(of, None, None, &Context::quiet())?.0)
}

fn altered(alterations: &str) -> Pattern {
    run(&pattern(), alterations).unwrap()
}

/// The length of an edge, mm, to a hundredth.
fn length(pattern: &Pattern, edge: &str) -> f64 {
    let (piece, edge) = edge.split_once('.').unwrap();
    let mm = pattern.piece(piece).unwrap().path(edge).unwrap().length() * 1e3;
    (mm * 100.0).round() / 100.0
}

/// The area of a piece, square centimetres, to a hundredth.
fn area(pattern: &Pattern, piece: &str) -> f64 {
    (polygon_area(&pattern.piece(piece).unwrap().outer.points().0) * 1e6).round() / 100.0
}

fn refused(alterations: &str) -> (String, String) {
    let e = run(&pattern(), alterations).unwrap_err();
    assert_eq!(e.param, Some("alterations"));
    (e.message, e.hint.unwrap())
}

fn notes(of: &Pattern, alterations: &str) -> (Pattern, Vec<String>, Vec<String>) {
    let cx = Context::quiet();
    let made = alter(alterations).run(of, None, None, &cx).unwrap().0;
    let told = cx.take_remarks();
    (made, told.notes, told.warnings)
}

#[test]
fn an_edge_moves_with_both_its_corners_and_the_edges_beside_follow() {
    let raised = altered("MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"20 mm\")");
    assert_eq!(area(&raised, "front"), 54.0 * 48.0);
    assert_eq!([length(&raised, "front.hem"), length(&raised, "front.side_left")], [540.0, 480.0]);
    assert_eq!(raised.piece("back"), pattern().piece("back"));
}

#[test]
fn a_corner_moves_alone() {
    let moved = altered("MoveCorner(piece: \"front\", corner: 0, x: \"0 mm\", y: \"-20 mm\")");
    assert_eq!(area(&moved, "front"), 54.0 * 50.0 + 0.5 * 54.0 * 2.0);
    assert_eq!([length(&moved, "front.side_right"), length(&moved, "front.side_left")], [520.0, 500.0]);
    assert_eq!(length(&moved, "front.hem"), 540.37);
}

#[test]
fn curves_keep_their_shape() {
    let mut curved = pattern();
    let p = |x: f64, y: f64| Point2::new(x, y);
    let curves = [
        EdgeCurve::Arc { bulge: 0.2 },
        EdgeCurve::Cubic { controls: [p(0.3, 0.1), p(0.24, 0.4)] },
        EdgeCurve::Quadratic { control: p(0.29, 0.3) },
        EdgeCurve::Polyline { points: vec![p(0.28, 0.2), p(0.29, 0.3)] },
    ];
    for curve in curves {
        let edge = if matches!(curve, EdgeCurve::Arc { .. }) { 0 } else { 1 };
        curved.pieces[0].outer.edges[edge].curve = curve;
        let [a, b] = [0, 1].map(|k| curved.pieces[0].outer.corners[edge + k]);
        let was = curved.pieces[0].outer.path(edge);
        let moved =
            run(&curved, "MoveCorner(piece: \"front\", corner: 1, x: \"30 mm\", y: \"-40 mm\")").unwrap();
        let [c, d] = [0, 1].map(|k| moved.pieces[0].outer.corners[edge + k]);
        let is = moved.pieces[0].outer.path(edge);
        // As much longer as its chord, and as far to the side of it at every share.
        assert!((is.length() / was.length() - (d - c).norm() / (b - a).norm()).abs() < 1e-9);
        for share in [0.25, 0.5, 0.8] {
            let off = |path: &EdgePath, from: Point2, to: Point2| {
                (to - from).perp(&(path.at(share * path.length()) - from)) / (to - from).norm_squared()
            };
            assert!((off(&is, c, d) - off(&was, a, b)).abs() < 1e-6, "{edge} {share}");
        }
    }
}

#[test]
fn an_upright_edge_is_longer_at_its_lower_end_and_a_level_one_at_both() {
    for (edge, corner) in [("side_left", 1), ("side_right", 0)] {
        let longer = altered(&format!("Lengthen(edge: \"front.{edge}\", by: \"20 mm\")"));
        assert_eq!(length(&longer, &format!("front.{edge}")), 520.0);
        assert!((longer.pieces[0].outer.corners[corner].y + 0.02).abs() < 1e-12);
    }
    let shorter = altered("Lengthen(edge: \"front.hem\", by: \"-40 mm\")");
    assert_eq!(length(&shorter, "front.hem"), 500.0);
    let [a, b] = [0, 1].map(|k| shorter.pieces[0].outer.corners[k].x);
    assert!((a + 0.25).abs() < 1e-12 && (b - 0.25).abs() < 1e-12);
}

#[test]
fn a_seam_whose_sides_differ_is_told_with_both_lengths() {
    let (_, told, _) = notes(&pattern(), "Lengthen(edge: \"front.side_left\", by: \"10 mm\")");
    assert_eq!(
        told,
        [
            "front.side_left is 510.0 mm long now, back.side_left 500.0 mm: the longer one is eased in by 2.0 %"
        ]
    );
    let (_, told, _) = notes(&pattern(), "Lengthen(edge: \"front.side_left\", by: \"-50 mm\")");
    assert_eq!(
        told,
        [
            "back.side_left is 500.0 mm long now, front.side_left 450.0 mm: the longer one is gathered by 10.0 %"
        ]
    );
    let (_, told, _) = notes(&pattern(), "MoveEdge(edge: \"front.hem\", x: \"5 mm\", y: \"0 mm\")");
    assert_eq!(told, Vec::<String>::new());
}

#[test]
fn a_dart_parts_its_edge_and_its_legs_are_sewn() {
    let cut = altered("Dart(edge: \"front.hem\", at: 0.25, width: \"20 mm\", length: \"90 mm\")");
    let front = cut.piece("front").unwrap();
    let names: Vec<&str> = front.outer.edges[..4].iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["hem_1", "hem_dart_1", "hem_dart_2", "hem_2"]);
    assert_eq!(area(&cut, "front"), 54.0 * 50.0 - 0.5 * 2.0 * 9.0);
    assert_eq!([length(&cut, "front.hem_1"), length(&cut, "front.hem_2")], [125.0, 395.0]);
    let leg = (90f64.hypot(10.0) * 100.0).round() / 100.0;
    assert_eq!([length(&cut, "front.hem_dart_1"), length(&cut, "front.hem_dart_2")], [leg; 2]);
    let dart = cut.seams.last().unwrap();
    assert_eq!((dart.name.as_str(), dart.kind), ("dart of front.hem", SeamKind::Dart));
    // Both legs from the mouth to the tip.
    assert!(!dart.sides[0][0].reversed && dart.sides[1][0].reversed);
    let lowered = cut.lower().unwrap();
    let sewn = lowered.plan.seams.last().unwrap();
    assert_eq!(sewn.name(), "front.hem_dart_1 + front.hem_dart_2");
    assert!(!sewn.reversed);
}

#[test]
fn a_seam_of_an_edge_with_a_dart_runs_on_along_both_parts() {
    let cut = altered(
        "Dart(edge: \"front.side_left\", at: 0.5, width: \"20 mm\", length: \"90 mm\"),
         Dart(edge: \"back.side_left\", at: 0.5, width: \"20 mm\", length: \"90 mm\")",
    );
    let seam = cut.seams.iter().find(|s| s.name == "front.side_left + back.side_left").unwrap();
    let edges = |side: usize| seam.sides[side].iter().map(|u| u.edge.edge.as_str()).collect::<Vec<_>>();
    assert_eq!(edges(0), ["side_left_1", "side_left_2"]);
    // The other side runs the other way.
    assert_eq!(edges(1), ["side_left_2", "side_left_1"]);
    assert_eq!(cut.side_length(&seam.sides[0]), cut.side_length(&seam.sides[1]));
}

#[test]
fn parts_of_curved_edges_keep_their_curves() {
    let mut curved = pattern();
    let p = |x: f64, y: f64| Point2::new(x, y);
    let curves = [
        EdgeCurve::Arc { bulge: 0.2 },
        EdgeCurve::Cubic { controls: [p(-0.1, -0.05), p(0.1, 0.04)] },
        EdgeCurve::Quadratic { control: p(0.05, -0.06) },
        EdgeCurve::Polyline { points: vec![p(-0.2, -0.02), p(0.1, -0.03)] },
    ];
    for curve in curves {
        curved.pieces[0].outer.edges[0].curve = curve.clone();
        let was = curved.pieces[0].outer.path(0);
        let cut =
            run(&curved, "Dart(edge: \"front.hem\", at: 0.4, width: \"20 mm\", length: \"90 mm\")").unwrap();
        let front = cut.piece("front").unwrap();
        let parts = [front.path("hem_1").unwrap(), front.path("hem_2").unwrap()];
        let sum: f64 = parts.iter().map(EdgePath::length).sum();
        assert!((sum + 0.02 - was.length()).abs() < 1e-6, "{curve:?}");
        let (middle, whole) = (parts[1].length() / 2.0, was.length());
        assert!((parts[1].at(middle) - was.at(whole - middle)).norm() < 1e-6, "{curve:?}");
    }
}

#[test]
fn notches_stay_at_their_places() {
    let mut notched = pattern();
    let notch = |along| Notch { edge: "hem".into(), along, depth: 0.0 };
    notched.pieces[0].notches = [0.1, 0.265, 0.4].map(notch).into();
    let dart = "Dart(edge: \"front.hem\", at: 0.5, width: \"20 mm\", length: \"90 mm\")";
    let (cut, told, _) = notes(&notched, dart);
    let left: Vec<(&str, f64)> =
        cut.pieces[0].notches.iter().map(|n| (n.edge.as_str(), (n.along * 1e3).round())).collect();
    assert_eq!(left, [("hem_1", 100.0), ("hem_2", 120.0)]);
    assert_eq!(told, ["1 notches of \"front.hem\" lie in the mouth of the dart and are left out"]);
    let longer = run(&notched, "Lengthen(edge: \"front.hem\", by: \"54 mm\")").unwrap();
    assert!((longer.pieces[0].notches[0].along - 0.11).abs() < 1e-12);
}

#[test]
fn a_line_that_ends_on_an_edge_goes_with_it() {
    let mut lined = pattern();
    let line = |name: &str, points: [[f64; 2]; 2]| PieceLine {
        name: name.into(),
        purpose: LinePurpose::Fold,
        points: points.map(|[x, y]| Point2::new(x, y)).into(),
    };
    lined.pieces[0].lines =
        vec![line("fold", [[0.1, 0.0], [0.1, 0.3]]), line("pocket", [[-0.1, 0.2], [0.0, 0.2]])];
    let raised = run(&lined, "MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"20 mm\")").unwrap();
    let points = |k: usize| &raised.pieces[0].lines[k].points;
    assert!((points(0)[0] - Point2::new(0.1, 0.02)).norm() < 1e-9);
    assert_eq!(
        (points(0)[1], points(1)),
        (lined.pieces[0].lines[0].points[1], &lined.pieces[0].lines[1].points)
    );
}

#[test]
fn a_mirror_image_stands_on_the_other_side_of_the_body() {
    let uneven = altered("MoveCorner(piece: \"front\", corner: 0, x: \"0 mm\", y: \"-20 mm\")");
    let (made, told, _) = notes(&uneven, "Mirror(piece: \"front\", name: \"lining\")");
    let (front, lining) = (made.piece("front").unwrap(), made.piece("lining").unwrap());
    assert_eq!(area(&made, "lining"), area(&made, "front"));
    assert_eq!(length(&made, "lining.side_left"), length(&made, "front.side_right"));
    for (own, other) in [("side_left", "side_right"), ("neck", "neck"), ("hem", "hem")] {
        let [a, b] = [(lining, own), (front, other)].map(|(p, e)| (p.pose.unwrap(), p.path(e).unwrap()));
        let [p, q] = [a.0.at(a.1.at(0.1)), b.0.at(b.1.at(b.1.length() - 0.1))];
        assert!((p - Point3::new(-q.x, q.y, q.z)).norm() < 1e-12, "{own}");
    }
    assert!((lining.pose.unwrap().outside() - front.pose.unwrap().outside()).norm() < 1e-12);
    assert_eq!(told, ["\"lining\" is the mirror image of \"front\"; `Sew` sews it to other pieces"]);
    assert_eq!(made.pieces[1].name, "lining");
}

#[test]
fn a_piece_that_is_there_becomes_the_mirror_image_and_stays_sewn() {
    let made = altered(
        "MoveCorner(piece: \"front\", corner: 0, x: \"0 mm\", y: \"-20 mm\"),
         Mirror(piece: \"front\", name: \"back\")",
    );
    assert_eq!(length(&made, "back.side_left"), length(&made, "front.side_right"));
    assert_eq!(area(&made, "back"), area(&made, "front"));
    assert_eq!(made.piece("back").unwrap().pose, pattern().piece("back").unwrap().pose);
    assert_eq!(made.seams, pattern().seams);
    assert_eq!(made.piece("back").unwrap().outer.edges[0].name, "hem");
}

#[test]
fn darts_are_sewn_in_the_mirror_image_too() {
    let made = altered(
        "Dart(edge: \"front.side_left\", at: 0.4, width: \"20 mm\", length: \"90 mm\"),
         Mirror(piece: \"front\", name: \"lining\")",
    );
    let dart = made.seams.last().unwrap();
    assert_eq!((dart.name.as_str(), dart.kind), ("dart of front.side_left of lining", SeamKind::Dart));
    let lining = made.piece("lining").unwrap();
    // All sides run from the mouth to the tip.
    let start = |u: &EdgeUse| {
        let path = lining.path(&u.edge.edge).unwrap();
        path.at(if u.reversed { 0.0 } else { path.length() })
    };
    assert_eq!(start(&dart.sides[0][0]), start(&dart.sides[1][0]));
}

/// The pattern with a pocket of 100 by 120 mm whose origin lies elsewhere.
fn pocketed() -> Pattern {
    let mut made = pattern();
    let corners = [[1.0, 2.0], [1.1, 2.0], [1.1, 2.12], [1.0, 2.12]];
    let names = ["low", "right", "top", "left"];
    made.pieces.push(Piece {
        name: "pocket".into(),
        outer: PatternLoop {
            corners: corners.iter().map(|[x, y]| Point2::new(*x, *y)).collect(),
            edges: names.iter().map(|n| PieceEdge { name: (*n).into(), curve: EdgeCurve::Line }).collect(),
        },
        ..Piece::default()
    });
    made
}

#[test]
fn a_pocket_is_sewn_on_along_all_its_edges_but_the_highest() {
    let made =
        run(&pocketed(), "SewOn(piece: \"pocket\", onto: \"front\", x: \"60 mm\", y: \"-40 mm\")").unwrap();
    let seam = made.seams.last().unwrap();
    assert_eq!((seam.name.as_str(), seam.kind), ("pocket on front", SeamKind::Patch));
    let uses = |side: &[EdgeUse]| side.iter().map(|u| (u.edge.to_string(), u.reversed)).collect::<Vec<_>>();
    let own = ["left", "low", "right"].map(|e| (format!("pocket.{e}"), false));
    assert_eq!(uses(&seam.sides[0]), own);
    assert_eq!(uses(&seam.sides[1]), [("front.pocket_place".to_owned(), false)]);
    let front = made.piece("front").unwrap();
    let outline = front.outer.points().0;
    let (lo, hi) = outline.iter().fold((outline[0], outline[0]), |(l, h), p| (l.inf(p), h.sup(p)));
    let middle = nalgebra::center(&lo, &hi) + Vector2::new(0.06, -0.04);
    let line = front.line("pocket_place").unwrap();
    let expected = [[-0.05, 0.06], [-0.05, -0.06], [0.05, -0.06], [0.05, 0.06]];
    assert_eq!(line.points.len(), 4);
    for (point, [x, y]) in line.points.iter().zip(expected) {
        assert!((point - middle - Vector2::new(x, y)).norm() < 1e-12, "{point}");
    }
    // And it is open again.
    let opened = run(&made, "Unsew(edge: \"pocket.low\")").unwrap();
    assert_eq!(opened.seams, pattern().seams);
}

#[test]
fn a_pocket_that_cannot_be_sewn_on_is_refused() {
    let refused = |alterations: &str| {
        let e = run(&pocketed(), alterations).unwrap_err();
        (e.message, e.hint.unwrap())
    };
    let (message, hint) = refused("SewOn(piece: \"pocket\", onto: \"front\", x: \"250 mm\", y: \"0 mm\")");
    assert_eq!(message, "\"front\" could not be cut so: its line pocket_place would lie outside");
    assert_eq!(hint, "\"pocket\" must lie within \"front\": x: \"0 mm\", y: \"0 mm\" is its middle");
    let (message, hint) = refused("SewOn(piece: \"pocket\", onto: \"pocket\", x: \"0 mm\", y: \"0 mm\")");
    assert_eq!(message, "\"pocket\" cannot be sewn onto itself");
    assert_eq!(hint, "name another piece as `onto`");
    let (message, hint) = refused(
        "Sew(a: \"pocket.low\", b: \"front.hem\"), SewOn(piece: \"pocket\", onto: \"front\", x: \"0 mm\", y: \"0 mm\")",
    );
    assert_eq!(message, "the edge \"pocket.low\" is sewn already, in the seam \"pocket.low + front.hem\"");
    assert_eq!(hint, "open it before: Unsew(edge: \"pocket.low\")");
}

#[test]
fn a_piece_is_taken_out_and_its_seams_are_open() {
    let with_lining = "Mirror(piece: \"front\", name: \"lining\"), Sew(a: \"lining.hem\", b: \"front.hem\")";
    let (made, told, _) = notes(&pattern(), &format!("{with_lining}, Remove(piece: \"lining\")"));
    assert_eq!(made, pattern());
    assert_eq!(told.last().unwrap(), "the seam \"lining.hem + front.hem\" is open");
    let (message, hint) = refused("Remove(piece: \"pocket\")");
    assert_eq!(message, "there is no piece \"pocket\"");
    assert_eq!(hint, "the pieces are front, back");
    let (message, hint) = refused("Remove(piece: \"front\"), Remove(piece: \"back\")");
    assert_eq!(message, "\"back\" is the only piece");
    assert_eq!(hint, "take the garment out of the pipeline's input instead");
}

#[test]
fn edges_are_sewn_and_seams_opened() {
    let (made, told, warned) = notes(
        &pattern(),
        "Unsew(edge: \"back.side_left\"), Unsew(edge: \"front.side_right\"),
         Sew(a: \"front.side_left\", b: \"back.side_right\", reversed: false),
         Sew(a: \"front.hem\", b: \"back.hem\")",
    );
    let open = ["left", "right"].map(|s| format!("the seam \"front.side_{s} + back.side_{s}\" is open"));
    assert_eq!(told, open);
    let plan = made.lower().unwrap().plan;
    assert_eq!(plan.seams.len(), 4);
    let hems = plan.seams.last().unwrap();
    assert_eq!((hems.name().as_str(), hems.reversed), ("front.hem + back.hem", false));
    assert_eq!(warned, Vec::<String>::new());
    let (made, _, warned) = notes(&pattern(), "Sew(a: \"front.hem\", b: \"back.hem\", reversed: true)");
    assert!(made.lower().unwrap().plan.seams.last().unwrap().reversed);
    assert_eq!(
        warned,
        [
            "as the pieces stand, the threads of the seam \"front.hem + back.hem\" cross: is `reversed: false` meant?"
        ]
    );
}

#[test]
fn names_that_are_not_there_are_refused_with_those_that_are() {
    let cases = [
        (
            "MoveCorner(piece: \"fornt\", corner: 0, x: \"0 mm\", y: \"0 mm\")",
            "there is no piece \"fornt\"",
            "did you mean \"front\"?",
        ),
        (
            "Mirror(piece: \"sleeve\", name: \"a\")",
            "there is no piece \"sleeve\"",
            "the pieces are front, back",
        ),
        (
            "Lengthen(edge: \"front.hmm\", by: \"1 mm\")",
            "the piece \"front\" has no edge \"hmm\"",
            "did you mean \"front.hem\"?",
        ),
        (
            "Lengthen(edge: \"front.waistline\", by: \"1 mm\")",
            "the piece \"front\" has no edge \"waistline\"",
            "its edges are hem, side_left, shoulder_left, neck, shoulder_right, side_right",
        ),
        (
            "MoveCorner(piece: \"back\", corner: 6, x: \"0 mm\", y: \"0 mm\")",
            "the piece \"back\" has no corner 6",
            "its corners, each with the edge that starts there, are 0 (hem), 1 (side_left), 2 (shoulder_left), 3 (neck), 4 (shoulder_right), 5 (side_right)",
        ),
        (
            "Unsew(edge: \"front.neck\")",
            "no seam has the edge \"front.neck\"",
            "the edges of \"front\" that are sewn are front.shoulder_left, front.shoulder_right, front.side_left, front.side_right",
        ),
        (
            "Sew(a: \"front.hem\", b: \"back.side_left\", reversed: false)",
            "the edge \"back.side_left\" is sewn already, in the seam \"front.side_left + back.side_left\"",
            "open it before: Unsew(edge: \"back.side_left\")",
        ),
        (
            "Sew(a: \"front.hem\", b: \"front.hem\", reversed: false)",
            "the edge \"front.hem\" cannot be sewn to itself",
            "name two edges; a dart parts an edge",
        ),
        (
            "Mirror(piece: \"front\", name: \"a.b\")",
            "\"a.b\" is no name for a piece",
            "take one without a full stop, such as \"front_mirrored\"",
        ),
    ];
    for (alterations, message, hint) in cases {
        assert_eq!(refused(alterations), (message.to_owned(), hint.to_owned()));
    }
}

#[test]
fn what_no_cloth_can_be_cut_to_is_refused_with_how_far_it_goes() {
    let cases = [
        (
            "MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"600 mm\")",
            "\"front\" could not be cut so: it would be turned inside out",
            "so far it goes: MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"499 mm\")",
        ),
        (
            "MoveCorner(piece: \"front\", corner: 3, x: \"-400 mm\", y: \"0 mm\")",
            "\"front\" could not be cut so: its shoulder_left would cross its neck",
            "so far it goes: MoveCorner(piece: \"front\", corner: 3, x: \"-179 mm\", y: \"0 mm\")",
        ),
        (
            "Lengthen(edge: \"front.hem\", by: \"-600 mm\")",
            "\"front.hem\" is only 540.0 mm long",
            "it can be made shorter by 539 mm at most: by: \"-539 mm\"",
        ),
        (
            "MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"20 m\")",
            "20 m is longer than any piece",
            "lengths carry their unit, such as \"20 mm\"",
        ),
        (
            "Dart(edge: \"front.hem\", at: 0.5, width: \"20 mm\", length: \"700 mm\")",
            "a dart of 70 cm from \"front.hem\" is longer than the piece has room for: its hem_dart_1 would cross its neck",
            "so long it goes: length: \"499 mm\"",
        ),
        (
            "Dart(edge: \"front.hem\", at: 0.5, width: \"60 cm\", length: \"90 mm\")",
            "a dart of 60 cm is wider than \"front.hem\", which is 540 mm long",
            "take a smaller `width`",
        ),
        (
            "Dart(edge: \"front.hem\", at: 0.01, width: \"20 mm\", length: \"90 mm\")",
            "a dart of 20 mm at 0.01 of \"front.hem\" reaches beyond its end",
            "it has room from at: 0.03 to at: 0.97",
        ),
        (
            "Dart(edge: \"front.hem\", at: 0.5, width: \"0 mm\", length: \"90 mm\")",
            "a dart of 0 m is too small",
            "20 mm wide and 90 mm long is usual",
        ),
    ];
    for (alterations, message, hint) in cases {
        assert_eq!(refused(alterations), (message.to_owned(), hint.to_owned()));
    }
}

#[test]
fn a_piece_with_other_edges_cannot_become_the_mirror_image() {
    let (message, hint) = refused(
        "Dart(edge: \"front.hem\", at: 0.5, width: \"20 mm\", length: \"90 mm\"),
         Mirror(piece: \"front\", name: \"back\")",
    );
    assert_eq!(message, "\"back\" cannot become the mirror image of \"front\": they have other edges");
    assert_eq!(
        hint,
        "its edges are hem, neck, shoulder_left, shoulder_right, side_left, side_right, those of the mirror image hem_1, hem_2, hem_dart_1, hem_dart_2, neck, shoulder_left, shoulder_right, side_left, side_right; under a new name it is a new piece"
    );
}

#[test]
fn an_error_stands_at_its_alteration() {
    let e =
        run(&pattern(), "Unsew(edge: \"front.side_left\"), Unsew(edge: \"front.side_left\")").unwrap_err();
    assert_eq!((e.param, e.path), (Some("alterations"), vec!["1".to_owned()]));
}

/// Front and back of a vest in photos, as a style names them.
fn vest() -> (Pattern, Set<Outline>) {
    let outline = shapes::vest(0.5);
    let framed = Outline { frame: Some(shapes::frame(&outline)), ..outline };
    let outlines: Set<Outline> =
        [("front", framed.clone()), ("back", framed)].map(|(n, o)| (n.to_owned(), o)).into_iter().collect();
    (Pattern::of_outlines("vest", outlines.iter(), &dress::plan().seams), outlines)
}

#[test]
fn a_vest_whose_hem_is_raised_is_shorter_and_its_photo_goes_along() {
    let (pattern, outlines) = vest();
    let stage = alter("MoveEdge(edge: \"front.hem\", x: \"0 mm\", y: \"20 mm\")");
    let (changed, made, plan) =
        stage.run(&pattern, Some(outlines.clone()), Some(&dress::plan()), &Context::quiet()).unwrap();
    let high = |o: &Outline| o.bounds().1.y - o.bounds().0.y;
    let (was, is) = (outlines.get("front").unwrap(), made.get("front").unwrap());
    assert!((high(was) - high(is) - 0.02).abs() < 1e-9);
    assert!((pattern.pieces[0].outer.points().0.len() as i64) > 10 && changed.check().is_ok());
    // Every corner shows the pixel that it showed, and points between two corners those between.
    for edge in &is.edges {
        let before = was.edge(&edge.name).unwrap();
        let [p, q] = [(is, edge), (was, before)].map(|(o, e)| {
            let points = o.edge_points(e);
            [points[0], points[points.len() / 2]].map(|p| o.to_px(p).unwrap())
        });
        assert!((p[0] - q[0]).norm() < 0.01 && (p[1] - q[1]).norm() < 1.0, "{}: {p:?} {q:?}", edge.name);
    }
    // The back is what it was, as it lies.
    assert_eq!(made.get("back").unwrap().lies, Vec::<Point2>::new());
    let sewn = |plan: &SewingPlan| plan.seams.iter().map(Seam::name).collect::<Vec<_>>();
    assert_eq!(sewn(&plan), sewn(&dress::plan()));
    assert!(made.iter().all(|(_, o)| o.check().is_ok()));
}

#[test]
fn a_dart_shows_what_was_there_and_a_mirror_image_the_same_photo() {
    let (pattern, outlines) = vest();
    let stage = alter(
        "Dart(edge: \"front.hem\", at: 0.5, width: \"20 mm\", length: \"90 mm\"),
         Mirror(piece: \"front\", name: \"lining\")",
    );
    let (_, made, _) = stage.run(&pattern, Some(outlines.clone()), None, &Context::quiet()).unwrap();
    let (was, front, lining) =
        (outlines.get("front").unwrap(), made.get("front").unwrap(), made.get("lining").unwrap());
    assert_eq!(front.lies, Vec::<Point2>::new());
    for p in &front.outer.points {
        let flipped = Point2::new(-p.x, p.y);
        assert!((lining.to_px(flipped).unwrap() - was.to_px(*p).unwrap()).norm() < 0.1);
    }
}

#[test]
fn outlines_and_plans_of_another_pattern_are_refused() {
    let (_, outlines) = vest();
    let stage = alter("Unsew(edge: \"front.side_left\")");
    let refused = |outlines, plan: &SewingPlan| {
        let e = stage.run(&pattern(), outlines, Some(plan), &Context::quiet()).unwrap_err();
        (e.message, e.hint.unwrap())
    };
    let (message, hint) = refused(Some(outlines), &dress::plan());
    assert_eq!(message, "the outline \"back\" is not as the pattern draws it");
    assert_eq!(hint, "put `Alter` right behind the stage that makes the pattern, or behind `Neckline`");
    let own: Set<Outline> = pattern().lower().unwrap().outlines.into_iter().collect();
    let (message, hint) = refused(Some(own), &SewingPlan::default());
    assert_eq!(message, "the seams are no longer those of the pattern");
    assert_eq!(hint, "put `Alter` before `Seams` and `Unpick`; `Unsew` and `Sew` change seams here");
}

#[test]
fn without_alterations_the_pattern_stays() {
    let (made, told, _) = notes(&pattern(), "");
    assert_eq!(made, pattern());
    assert_eq!(told, ["`alterations` names none: the pattern stays as it is"]);
}

/// Any alteration of the suite's pattern.
fn alteration() -> impl Strategy<Value = Alteration> {
    let metres = prop_oneof![-0.3..0.3f64, any::<f64>().prop_filter("finite", |x| x.is_finite())];
    let length = move || metres.clone().prop_map(Length::m);
    let names = ["hem", "side_left", "shoulder_left", "neck", "hem_1", "hem_dart_1", "x"];
    let edge = move || {
        (0..2usize, prop::sample::select(names.to_vec()))
            .prop_map(|(p, edge)| EdgeRef { panel: ["front", "back"][p].to_owned(), edge: edge.to_owned() })
    };
    let share = prop_oneof![0.0..1.0f64, any::<f64>()];
    let piece = || prop::sample::select(vec!["front", "back", "third"]).prop_map(str::to_owned);
    prop_oneof![
        (piece(), 0..8usize, length(), length()).prop_map(|(piece, corner, x, y)| Alteration::MoveCorner {
            piece,
            corner,
            x,
            y
        }),
        (edge(), length(), length()).prop_map(|(edge, x, y)| Alteration::MoveEdge { edge, x, y }),
        (edge(), length()).prop_map(|(edge, by)| Alteration::Lengthen { edge, by }),
        (edge(), share, length(), length()).prop_map(|(edge, at, width, length)| Alteration::Dart {
            edge,
            at,
            width,
            length
        }),
        (piece(), piece()).prop_map(|(piece, name)| Alteration::Mirror { piece, name }),
        (edge(), edge(), any::<bool>()).prop_map(|(a, b, reversed)| Alteration::Sew { a, b, reversed }),
        edge().prop_map(|edge| Alteration::Unsew { edge }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    #[test]
    fn what_comes_out_is_sound_whatever_is_asked(all in prop::collection::vec(alteration(), 1..4)) {
        let (pattern, outlines) = (pattern(), pattern().lower().unwrap().outlines);
        let framed = outlines.into_iter().map(|(name, o)| {
            let frame = Some(shapes::frame(&o));
            (name, Outline { frame, ..o })
        });
        let stage = Alter { alterations: all };
        let done = stage.run(&pattern, Some(framed.collect()), None, &Context::quiet());
        match done {
            Ok((changed, outlines, plan)) => {
                prop_assert_eq!(changed.check(), Ok(()));
                prop_assert_eq!(plan.check(), Ok(()));
                for (name, o) in outlines.iter() {
                    prop_assert_eq!(o.check(), Ok(()), "{}", name);
                }
            }
            Err(e) => {
                prop_assert!(e.hint.is_some() && e.code != ErrorCode::Internal, "{:?}", e);
            }
        }
    }
}
