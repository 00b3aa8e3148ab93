//! Patterns through records, checks and lowering.
#![allow(clippy::unwrap_used, clippy::panic)]

use super::super::Point2;
use super::*;
use crate::artifact::stored::{decode, encode};
use crate::artifact::{EdgeRef, Point3, SeamKind, Vector3, polyline_length};
use proptest::prelude::*;

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

fn edge(name: &str, curve: EdgeCurve) -> PieceEdge {
    PieceEdge { name: name.into(), curve }
}

/// A rectangle with its lower left corner at the origin: edges `hem`, `right`, `top`, `left`.
fn rectangle(name: &str, width: f64, height: f64) -> Piece {
    Piece {
        name: name.into(),
        outer: PatternLoop {
            corners: vec![p(0.0, 0.0), p(width, 0.0), p(width, height), p(0.0, height)],
            edges: ["hem", "right", "top", "left"].map(|n| edge(n, EdgeCurve::Line)).into(),
        },
        ..Piece::default()
    }
}

fn side(uses: &[(&str, &str, bool)]) -> Vec<EdgeUse> {
    let one = |(panel, edge, reversed): &(&str, &str, bool)| EdgeUse {
        edge: EdgeRef { panel: (*panel).into(), edge: (*edge).into() },
        reversed: *reversed,
    };
    uses.iter().map(one).collect()
}

fn seam(name: &str, kind: SeamKind, sides: Vec<Vec<EdgeUse>>) -> PatternSeam {
    PatternSeam { name: name.into(), kind, sides }
}

/// A pattern with something of everything.
pub(in crate::artifact) fn tunic() -> Pattern {
    let mut front = rectangle("front", 0.5, 0.6);
    front.outer.edges[0].curve = EdgeCurve::Quadratic { control: p(0.25, -0.02) };
    front.outer.edges[1].curve = EdgeCurve::Cubic { controls: [p(0.52, 0.2), p(0.48, 0.4)] };
    front.outer.edges[2].curve = EdgeCurve::Arc { bulge: 0.2 };
    front.outer.edges[3].curve = EdgeCurve::Polyline { points: vec![p(0.01, 0.4), p(0.0, 0.2)] };
    front.holes = vec![PatternLoop {
        corners: vec![p(0.2, 0.3), p(0.2, 0.35), p(0.25, 0.35)],
        edges: ["hole_1", "hole_2", "hole_3"].map(|n| edge(n, EdgeCurve::Line)).into(),
    }];
    let line = |name: &str, purpose, points: &[Point2]| PieceLine {
        name: name.into(),
        purpose,
        points: points.to_vec(),
    };
    front.lines = vec![
        line("dart_a", LinePurpose::Dart, &[p(0.1, 0.0), p(0.12, 0.15)]),
        line("pocket", LinePurpose::Placement, &[p(0.3, 0.1), p(0.4, 0.1)]),
        line("slit", LinePurpose::Cut, &[p(0.3, 0.5), p(0.4, 0.5)]),
    ];
    front.notches = vec![Notch { edge: "left".into(), along: 0.1, depth: 0.004 }];
    front.drill_holes = vec![p(0.12, 0.15)];
    front.grain = Some([p(0.25, 0.1), p(0.25, 0.5)]);
    front.body_part = Some(BodyPart::Body);
    front.pose = Some(Pose { origin: Point3::new(0.0, 1.0, 0.2), across: Vector3::x(), along: Vector3::y() });
    front.layer = 1;
    let pocket = rectangle("pocket", 0.1, 0.12);
    Pattern {
        name: "tunic".into(),
        pieces: vec![front, rectangle("back", 0.5, 0.6), pocket],
        seams: vec![
            seam(
                "side",
                SeamKind::Matched,
                vec![side(&[("front", "right", false)]), side(&[("back", "left", true)])],
            ),
            seam(
                "pocket",
                SeamKind::Patch,
                vec![side(&[("pocket", "hem", false)]), side(&[("front", "pocket", false)])],
            ),
            seam(
                "waist",
                SeamKind::Elastic { ratio: 0.8, stiffness: 40.0 },
                vec![side(&[("front", "hem", false)]), side(&[("back", "hem", true)])],
            ),
        ],
    }
}

fn lengths(outline: &crate::artifact::Outline) -> Vec<(String, f64)> {
    outline.edges.iter().map(|e| (e.name.clone(), polyline_length(&outline.edge_points(e)))).collect()
}

#[test]
fn a_lowered_pattern_keeps_every_length_and_carries_every_kind() {
    let pattern = tunic();
    pattern.check().unwrap();
    let lowered = pattern.lower().unwrap();
    for piece in &pattern.pieces {
        let outline = &lowered.outlines[&piece.name];
        outline.check().unwrap();
        assert_eq!(outline.frame, None);
        for (k, (name, length)) in lengths(outline).into_iter().enumerate() {
            assert_eq!(name, piece.outer.edges[k].name);
            let exact = piece.outer.path(k).length();
            assert!((length - exact).abs() < 2e-5 * exact, "{name}: {length} for {exact}");
        }
    }
    let kinds: Vec<&str> = lowered.plan.seams.iter().map(|s| s.kind.word()).collect();
    assert_eq!(kinds, ["matched", "patch", "elastic"]);
    let inner: Vec<(&str, bool)> =
        lowered.outlines["front"].inner.iter().map(|l| (l.name.as_str(), l.gauge.is_some())).collect();
    assert_eq!(inner, [("dart_a", false), ("pocket", true)]);
    assert_eq!(lowered.warnings, ["the slit \"slit\" of piece \"front\" is not cut"]);
}

#[test]
fn sides_that_run_alike_meet_start_to_start() {
    let pattern = |reversed| Pattern {
        name: "two".into(),
        pieces: vec![rectangle("a", 0.2, 0.3), rectangle("b", 0.2, 0.3)],
        seams: vec![seam(
            "s",
            SeamKind::Matched,
            vec![side(&[("a", "right", false)]), side(&[("b", "left", reversed)])],
        )],
    };
    let reversed = |r| pattern(r).lower().unwrap().plan.seams[0].reversed;
    // A plan pairs the start of one edge with the end of the other, unless the seam is reversed.
    assert!(!reversed(true) && reversed(false));
}

#[test]
fn a_chain_cuts_the_edge_it_is_sewn_to_at_its_corner() {
    let mut band = rectangle("band", 0.5, 0.05);
    band.outer.edges[2].name = "upper".into();
    let pattern = Pattern {
        name: "skirt".into(),
        pieces: vec![rectangle("left", 0.2, 0.4), rectangle("right", 0.3, 0.4), band],
        seams: vec![
            seam(
                "waist",
                SeamKind::Matched,
                vec![side(&[("band", "hem", false)]), side(&[("left", "top", true), ("right", "top", true)])],
            ),
            seam(
                "middle",
                SeamKind::Matched,
                vec![side(&[("left", "right", false)]), side(&[("right", "left", true)])],
            ),
        ],
    };
    let lowered = pattern.lower().unwrap();
    let names: Vec<String> = lowered.plan.seams.iter().map(|s| s.name()).collect();
    assert_eq!(names, ["band.hem_1 + left.top", "band.hem_2 + right.top", "left.right + right.left"]);
    let parts = lengths(&lowered.outlines["band"]);
    assert!((parts[0].1 - 0.2).abs() < 1e-12 && (parts[1].1 - 0.3).abs() < 1e-12, "{parts:?}");
    assert!(lowered.notes.is_empty());
}

#[test]
fn three_pieces_in_one_seam_share_one_gauge() {
    let mut pieces: Vec<Piece> = ["a", "b", "c"].map(|n| rectangle(n, 0.2, 0.3)).into();
    pieces[2].outer.edges[1].curve = EdgeCurve::Arc { bulge: -0.5 };
    let sides = ["a", "b", "c"].map(|n| side(&[(n, "right", false)])).into();
    let pattern = Pattern { name: "t".into(), pieces, seams: vec![seam("s", SeamKind::Matched, sides)] };
    let lowered = pattern.lower().unwrap();
    assert_eq!(lowered.plan.seams.len(), 2);
    let gauge = |n: &str| lowered.outlines[n].edge("right").unwrap().gauge;
    assert!(gauge("a") == gauge("b") && gauge("b") == gauge("c"));
    assert!(gauge("a").length > 0.3);
    assert_eq!(lowered.plan.seams[0].kind, SeamKind::Gathered);
    assert_eq!(
        lowered.notes,
        ["the seam \"s\" joins 347.7 mm to 300.0 mm: the longer side is gathered in the ratio 1.159"]
    );
}

#[test]
fn many_gathers_are_told_in_one_sentence() {
    let heights = [("a", 0.3), ("b", 0.3), ("c", 0.36), ("d", 0.6)];
    let pieces: Vec<Piece> = heights.map(|(n, height)| rectangle(n, 0.2, height)).into();
    let sew = |name: &str, a: &str, b: &str| {
        seam(name, SeamKind::Matched, [a, b].map(|n| side(&[(n, "right", false)])).into())
    };
    let seams = vec![sew("ab", "a", "b"), sew("ac", "a", "c"), sew("bd", "b", "d")];
    let lowered = Pattern { name: "t".into(), pieces, seams }.lower().unwrap();
    let told = "2 seams join sides of unlike length, of which the longer is gathered: most of all \"bd\", 600.0 mm to 300.0 mm, in the \
                ratio 2.000";
    assert_eq!(lowered.notes, [told]);
}

#[test]
fn a_corner_within_an_edge_stays_a_corner_and_is_no_curve() {
    let mut piece = rectangle("a", 0.4, 0.3);
    piece.outer.edges[0].curve = EdgeCurve::Polyline { points: vec![p(0.2, 0.1)] };
    let pattern = Pattern { name: "t".into(), pieces: vec![piece], seams: vec![] };
    let outline = pattern.lower().unwrap().outlines.remove("a").unwrap();
    assert_eq!(outline.outer.corners, [0, 1, 2, 3, 4]);
    assert_eq!(outline.edge("hem").unwrap().gauge.divisions(0.05), 9);
}

#[test]
fn what_cannot_be_lowered_is_named() {
    let mut pattern = tunic();
    pattern.seams[0].sides[1] = pattern.seams[0].sides[0].clone();
    let e = pattern.lower().unwrap_err();
    assert_eq!(e.to_string(), "the seam \"side\" sews front.right to itself");
    assert_eq!(e.remedy(), "cut the edge in two and sew its halves");
    pattern.seams[0].sides[1][0].edge.edge = "nowhere".into();
    let e = pattern.lower().unwrap_err();
    assert_eq!(
        e.to_string(),
        "the pattern is not sound: seam \"side\": piece \"front\" has no outer edge or line \"nowhere\""
    );
    // Each of two chains begins within the other: every cut makes another.
    let pattern = Pattern {
        name: "turning".into(),
        pieces: vec![rectangle("a", 0.3, 0.5), rectangle("b", 0.4, 0.5)],
        seams: vec![
            seam(
                "s",
                SeamKind::Matched,
                vec![side(&[("a", "hem", false), ("b", "hem", false)]), side(&[("a", "top", true)])],
            ),
            seam("t", SeamKind::Matched, vec![side(&[("a", "hem", false)]), side(&[("a", "top", true)])]),
        ],
    };
    let e = pattern.lower().unwrap_err();
    assert_eq!(e.to_string(), "the seam \"s\" and others divide each other without end");
}

#[test]
fn unsound_patterns_say_what_is_wrong() {
    let wrong = |change: fn(&mut Pattern)| {
        let mut pattern = tunic();
        change(&mut pattern);
        pattern.check().unwrap_err()
    };
    assert_eq!(wrong(|q| q.pieces[1].name = "front".into()), "two pieces are called \"front\"");
    assert_eq!(
        wrong(|q| q.pieces[1].outer.corners[2].x = f64::NAN),
        "piece \"back\": corner 2 is not a finite number below 1e9"
    );
    assert_eq!(
        wrong(|q| q.pieces[1].outer.corners.reverse()),
        "piece \"back\": its outer loop does not run counter-clockwise"
    );
    assert_eq!(
        wrong(|q| q.pieces[0].outer.edges[1].name = "hem".into()),
        "piece \"front\": two of its edges and lines are called \"hem\""
    );
    assert_eq!(
        wrong(|q| drop(q.pieces[1].outer.edges.pop())),
        "piece \"back\": a loop has 4 corners and 3 edges"
    );
    assert_eq!(
        wrong(|q| q.pieces[1].outer.corners[1] = p(0.0, 0.0)),
        "piece \"back\": edge \"hem\": it has no length"
    );
    assert_eq!(
        wrong(|q| q.pieces[0].notches[0].edge = "x".into()),
        "piece \"front\": a notch stands on \"x\", which is no edge"
    );
    assert_eq!(
        wrong(|q| q.pieces[0].pose.as_mut().unwrap().across = Vector3::y()),
        "piece \"front\": the axes of its pose are not of length 1 and at right angles"
    );
    assert_eq!(
        wrong(|q| q.pieces[0].grain = Some([p(0.0, 0.0), p(1.0, 1.0)])),
        "piece \"front\": its grain line does not run up along y"
    );
    assert_eq!(wrong(|q| drop(q.seams[0].sides.pop())), "seam \"side\": it has 1 sides, 2 are the least");
    assert_eq!(
        wrong(|q| q.seams[0].sides[0][0].edge.panel = "x".into()),
        "seam \"side\": there is no piece \"x\""
    );
}

#[test]
fn the_drawing_names_every_edge() {
    let svg = String::from_utf8(tunic().export().swap_remove(0).1).unwrap();
    for name in ["hem", "right", "top", "left", "hole_2"] {
        assert!(svg.contains(&format!(">{name}</text>")), "{name}");
    }
    // Both sides of a seam have one colour.
    assert_eq!(svg.matches("stroke=\"#8b1818\"").count(), 2);
}

/// A curve that strays from its chord by less than it is long.
fn curve() -> impl Strategy<Value = EdgeCurve> {
    let q = || (-0.3..0.3_f64, -0.3..0.3_f64).prop_map(|(x, y)| p(x, y));
    prop_oneof![
        Just(EdgeCurve::Line),
        q().prop_map(|control| EdgeCurve::Quadratic { control }),
        (q(), q()).prop_map(|(a, b)| EdgeCurve::Cubic { controls: [a, b] }),
        (-0.5..0.5_f64).prop_map(|bulge| EdgeCurve::Arc { bulge }),
        q().prop_map(|x| EdgeCurve::Polyline { points: vec![x] }),
    ]
}

/// A piece around the origin, whose edges bulge as they like.
fn piece(name: &'static str) -> impl Strategy<Value = Piece> {
    prop::collection::vec((0.3..0.5_f64, curve()), 3..8).prop_map(move |rim| {
        let n = rim.len();
        let at = |k: usize| {
            let a = std::f64::consts::TAU * k as f64 / n as f64;
            p(rim[k % n].0 * a.cos(), rim[k % n].0 * a.sin())
        };
        let edges = (0..n).map(|k| {
            // Control points are drawn about the middle of the chord.
            let (a, b) = (at(k), at((k + 1) % n));
            let middle = nalgebra::center(&a, &b);
            edge(&format!("e{k}"), rim[k].1.moved(|q| middle + q.coords * 0.3, false))
        });
        let outer = PatternLoop { edges: edges.collect(), corners: (0..n).map(at).collect() };
        Piece { name: name.into(), outer, ..Piece::default() }
    })
}

fn pattern() -> impl Strategy<Value = Pattern> {
    let links = || prop::collection::vec((0..2_usize, 0..8_usize, any::<bool>()), 1..3);
    let seams = prop::collection::vec((links(), links()), 0..4);
    (piece("a"), piece("b"), seams).prop_map(|(a, b, seams)| {
        let pieces = vec![a, b];
        let uses = |list: Vec<(usize, usize, bool)>| {
            let one = |(i, k, reversed): (usize, usize, bool)| {
                let piece: &Piece = &pieces[i];
                let edge = piece.outer.edges[k % piece.outer.edges.len()].name.clone();
                EdgeUse { edge: EdgeRef { panel: piece.name.clone(), edge }, reversed }
            };
            list.into_iter().map(one).collect::<Vec<_>>()
        };
        let seams = seams
            .into_iter()
            .enumerate()
            .map(|(i, (x, y))| seam(&format!("s{i}"), SeamKind::Matched, vec![uses(x), uses(y)]));
        let seams = seams.collect();
        Pattern { name: "any".into(), pieces, seams }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_pattern_comes_back_from_its_bytes(pattern in pattern()) {
        let bytes = encode(&pattern).unwrap();
        let again = decode(Pattern::KIND, &bytes);
        match pattern.check() {
            Ok(()) => prop_assert_eq!(format!("{:?}", again.unwrap()), format!("{pattern:?}")),
            Err(fault) => prop_assert_eq!(again.unwrap_err(), fault),
        }
    }

    /// Whatever is sewn to whatever: lengths are kept, and the two sides of every seam are divided
    /// alike.
    #[test]
    fn lowering_keeps_lengths_and_divides_seams_alike(pattern in pattern()) {
        let Ok(lowered) = pattern.lower() else { return Ok(()) };
        for piece in &pattern.pieces {
            let outline = &lowered.outlines[&piece.name];
            prop_assert!(outline.check().is_ok());
            let whole: f64 = (0..piece.outer.edges.len()).map(|k| piece.outer.path(k).length()).sum();
            prop_assert!((outline.perimeter() - whole).abs() < 1e-4 * whole);
            let named: f64 = lengths(outline).iter().map(|(_, l)| l).sum();
            prop_assert!((named - outline.perimeter()).abs() < 1e-9);
        }
        for s in &lowered.plan.seams {
            let gauge = |e: &EdgeRef| lowered.outlines[&e.panel].edge(&e.edge).unwrap().gauge;
            for h in [0.005, 0.01, 0.03] {
                prop_assert_eq!(gauge(&s.a).divisions(h), gauge(&s.b).divisions(h));
            }
        }
    }
}
