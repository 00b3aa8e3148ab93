//! From a pattern to a file and back: outlines, names, stitches, seams beside the file.

use crate::common::*;
use crate::plots::plot;
use toile_core::artifact::*;
use toile_pattern_files::allowance::Allowances;
use toile_pattern_files::dxf::{Standard, to_dxf};
use toile_pattern_files::garment_code::to_json;
use toile_pattern_files::pdf::{Paper, to_pdf};
use toile_pattern_files::plt::to_plt;
use toile_pattern_files::svg::to_svg;
use toile_pattern_files::{DrawingOptions, sidecar};

fn allowed() -> DrawingOptions {
    let allowances = Allowances { sewn: 0.01, free: 0.02, ..Allowances::default() };
    DrawingOptions { allowances, size: "M".into(), date: String::new() }
}

#[test]
fn curves_places_and_names_come_back_from_json_to_a_nanometre() {
    let mut pattern = blouse();
    // A polyline has no form there; it is tried by itself below.
    pattern.pieces[0].outer.edges[6].curve = EdgeCurve::Arc { bulge: 1.0 };
    let (pieces, _) = read_json(&to_json(&pattern).unwrap().bytes);
    let front = &pattern.pieces[0];
    let again = &pieces[0];
    let mut worst: f64 = 0.0;
    for (k, e) in front.outer.edges.iter().enumerate() {
        let other = &again.outer.edges[k];
        assert_eq!((&e.name, e.curve.word()), (&other.name, other.curve.word()));
        let (a, b) = (front.outer.path(k), again.outer.path(k));
        let (pose, other) = (front.pose.unwrap(), again.pose.unwrap());
        for i in 0..=16 {
            let share = f64::from(i) / 16.0;
            let (q, r) = (a.at(share * a.length()), b.at(share * b.length()));
            worst = worst.max((q - r).norm()).max((pose.at(q) - other.at(r)).norm());
        }
    }
    assert!(worst < 1e-9, "{worst}");
    assert_eq!(again.body_part, Some(BodyPart::Body));
    let names: Vec<&str> = pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front", "back", "band", "pocket"]);
}

#[test]
fn a_chain_is_cut_until_its_stitches_join_edge_to_edge() {
    let pattern = blouse();
    let written = to_json(&pattern).unwrap();
    let (pieces, stitches) = read_json(&written.bytes);
    let name = |(panel, k): &(String, usize)| {
        let piece = pieces.iter().find(|p| p.name == *panel).unwrap();
        format!("{panel}.{}", piece.outer.edges[*k].name)
    };
    let told: Vec<String> = stitches
        .iter()
        .map(|(sides, alike)| {
            format!("{} {}{}", name(&sides[0]), name(&sides[1]), if *alike { " alike" } else { "" })
        })
        .collect();
    assert_eq!(
        told,
        [
            "front.right back.left",
            "front.dart_left front.dart_right",
            "band.top_1 back.hem",
            "band.top_2 front.hem_right",
            "band.top_3 front.hem_left",
            "band.left pocket.left alike",
        ]
    );
    let length = |panel: usize, edge: &str| pieces[panel].path(edge).unwrap().length();
    let whole: f64 = ["top_1", "top_2", "top_3"].iter().map(|e| length(2, e)).sum();
    assert!((whole - 0.97).abs() < 1e-9);
    let share = length(2, "top_1") / 0.97;
    let side = 0.5 + length(0, "hem_right") + length(0, "hem_left");
    assert!((share - 0.5 / side).abs() < 1e-6, "cut by the share of the lengths: {share}");
    // The line inside the front is no edge, the pocket's seam stands in the file of seams alone.
    assert_eq!(
        [written.notes, written.warnings].concat(),
        [
            "1 holes are left out: the format has none",
            "2 lines inside pieces are left out: the format has none",
            "1 notches are left out: the format has none",
            "1 drill holes are left out: the format has none",
            "3 pieces have no place around the body: put side by side in the file",
            "the seam \"pocket\" is not among the stitches: front.pocket is a line inside its piece, a stitch joins outer edges",
            "the seam \"pocket\" is left out of the file of seams: the pattern's file does not have front.pocket",
        ]
    );
    assert!(written.seams.contains("[\"band.top_1\", \"band.top_2\", \"band.top_3\"]"), "{}", written.seams);
}

#[test]
fn outlines_come_back_from_every_drawing_within_a_twentieth_of_a_millimetre() {
    let pattern = blouse();
    for options in [DrawingOptions::default(), allowed()] {
        let files = [
            read_svg(&to_svg(&pattern, &options).unwrap().bytes),
            read_dxf(&to_dxf(&pattern, Standard::Aama, &options).unwrap().bytes),
            read_dxf(&to_dxf(&pattern, Standard::Astm, &options).unwrap().bytes),
        ];
        for (file, drawn) in files.iter().enumerate() {
            for (piece, (name, edges)) in pattern.pieces.iter().zip(drawn) {
                assert_eq!(piece.name, *name);
                let off = apart(piece, edges);
                assert!(off < 5e-5, "file {file}, {name}: {off}");
            }
        }
    }
}

#[test]
fn polylines_become_curves_that_are_near_and_stay_one_loop() {
    let mut pattern = blouse();
    // A neck drawn by points, as a DXF has it.
    let neck = EdgePath::new(p(0.5, 0.6), p(0.0, 0.6), &EdgeCurve::Quadratic { control: p(0.2, 0.3) });
    let points: Vec<Point2> = (1..100).map(|k| neck.at(neck.length() * f64::from(k) / 100.0)).collect();
    pattern.pieces[0].outer.edges[5].curve = EdgeCurve::Polyline { points };
    let written = to_json(&pattern).unwrap();
    let (pieces, _) = read_json(&written.bytes);
    let front = &pieces[0].outer;
    let words: Vec<(&str, &str)> = front.edges.iter().map(|e| (e.name.as_str(), e.curve.word())).collect();
    assert_eq!(
        words[5..],
        [("top", "cubic"), ("left_1", "line"), ("left_2", "line"), ("left_3", "line")].map(|(a, b)| (a, b))
    );
    let drawn: Vec<(String, Vec<Point2>)> =
        front.edges.iter().enumerate().map(|(k, e)| (e.name.clone(), front.path(k).points())).collect();
    assert!(apart(&pattern.pieces[0], &drawn) < 5e-5);
}

#[test]
fn seams_stand_beside_each_file_by_the_names_of_that_file() {
    let pattern = blouse();
    let (own, told) = sidecar(&pattern);
    assert!(told.is_empty());
    assert_eq!(
        own,
        "(\n    seams: [\n        \
         (name: \"side\", kind: Matched, sides: [[\"front.right\"], [\"-back.left\"]]),\n        \
         (name: \"dart\", kind: Dart, sides: [[\"front.dart_left\"], [\"-front.dart_right\"]]),\n        \
         (name: \"waist\", kind: Gathered, sides: [[\"band.top\"], [\"-back.hem\", \"-front.hem_right\", \"-front.hem_left\"]]),\n        \
         (name: \"pocket\", kind: Patch, sides: [[\"pocket.hem\"], [\"front.pocket\"]]),\n        \
         (name: \"alike\", kind: Matched, sides: [[\"band.left\"], [\"pocket.left\"]]),\n    ],\n)\n"
    );
    // A name with the word `dart` would make a mark of the edge.
    let svg = to_svg(&pattern, &DrawingOptions::default()).unwrap().seams;
    assert!(svg.contains("[\"front.edge_1\"], [\"-front.edge_2\"]"), "{svg}");
    assert!(svg.contains("[\"pocket.hem\"], [\"front.line_1\"]"), "{svg}");
    let dxf = to_dxf(&pattern, Standard::Aama, &DrawingOptions::default()).unwrap().seams;
    assert!(
        dxf.contains("[\"band.edge_2\"], [\"-back.edge_0\", \"-front.edge_3\", \"-front.edge_0\"]"),
        "{dxf}"
    );
}

#[test]
fn edges_that_readers_cannot_hold_are_halved_or_joined_to_others() {
    let mut piece = rectangle("p", 0.3, 0.4);
    // A tab of 0.1 mm, and a loop whose ends meet.
    piece.outer.corners.splice(2..2, [p(0.3, 0.2), p(0.3001, 0.2)]);
    piece.outer.edges.splice(2..2, ["tab", "rest"].map(|n| edge(n, EdgeCurve::Line)));
    let drop = PatternLoop {
        corners: vec![p(0.0, 0.0), p(0.00005, 0.0)],
        edges: vec![
            edge("short", EdgeCurve::Line),
            edge("around", EdgeCurve::Cubic { controls: [p(0.4, 0.5), p(-0.4, 0.5)] }),
        ],
    };
    let loose = Piece { name: "drop".into(), outer: drop, ..Piece::default() };
    let seam = seam("s", SeamKind::Matched, &[&[("p", "left", false)], &[("drop", "around", true)]]);
    let pattern = Pattern { name: "t".into(), pieces: vec![piece, loose], seams: vec![seam] };
    let written = to_dxf(&pattern, Standard::Aama, &DrawingOptions::default()).unwrap();
    let drawn = read_dxf(&written.bytes);
    assert_eq!((drawn[0].1.len(), drawn[1].1.len()), (5, 2));
    for (piece, (_, edges)) in pattern.pieces.iter().zip(&drawn) {
        assert!(apart(piece, edges) < 5e-5);
    }
    assert!(
        written.seams.contains("[[\"p.edge_4\"], [\"-drop.edge_1\", \"-drop.edge_0\"]]"),
        "{}",
        written.seams
    );
    let (pieces, stitches) = read_json(&to_json(&pattern).unwrap().bytes);
    assert_eq!((pieces[1].outer.edges.len(), stitches.len()), (3, 2));
    let drawn = read_svg(&to_svg(&pattern, &DrawingOptions::default()).unwrap().bytes);
    assert_eq!(drawn[1].1.len(), 3);
}

#[test]
fn the_same_pattern_gives_the_same_bytes() {
    let (pattern, options) = (blouse(), allowed());
    let all = || {
        [
            to_json(&pattern).unwrap(),
            to_svg(&pattern, &options).unwrap(),
            to_dxf(&pattern, Standard::Astm, &options).unwrap(),
            to_pdf(&pattern, Paper::A4, &options).unwrap(),
            to_pdf(&pattern, Paper::OnePiece, &options).unwrap(),
            to_plt(&pattern, &plot(), &options).unwrap(),
        ]
    };
    assert_eq!(all(), all());
}

#[test]
fn a_dxf_has_the_layers_of_the_format() {
    let written = to_dxf(&blouse(), Standard::Aama, &allowed()).unwrap();
    let tags = tags(&written.bytes);
    let mut layers: Vec<i32> =
        tags.iter().filter(|(code, _)| *code == 8).map(|(_, layer)| layer.parse().unwrap()).collect();
    layers.sort_unstable();
    layers.dedup();
    assert_eq!(layers, [0, 1, 2, 3, 4, 7, 8, 11, 13, 14, 15]);
    let texts: Vec<&str> =
        tags.iter().filter(|(code, _)| *code == 1).map(|(_, text)| text.as_str()).collect();
    for text in [
        "Piece Name: front",
        "Size: M",
        "Quantity: 1",
        "Style Name: blouse",
        "Sample Size: M",
        "Units: METRIC",
    ] {
        assert!(texts.contains(&text), "{text}");
    }
    assert!(tags.contains(&(2, "FRONT_M".to_owned())));
    // The depth of the notch, and its place on the line that is cut.
    let notch = tags.windows(6).find(|w| w[0].1 == "POINT" && w[1] == (8, "4".into())).unwrap();
    assert_eq!(notch[4], (39, "4.000000".to_owned()));
}

#[test]
fn pieces_without_places_are_turned_so_that_their_stitches_are_believed() {
    let matched = SeamKind::Matched;
    let pieces = vec![rectangle("front", 0.5, 0.6), rectangle("back", 0.5, 0.6)];
    // Shoulders and sides: the tops would run alike if both pieces were seen from before.
    let sew =
        |name: &str, a: &str, b: &str| seam(name, matched, &[&[("front", a, false)], &[("back", b, true)]]);
    let seams =
        vec![sew("shoulder", "top", "top"), sew("right", "right", "left"), sew("left", "left", "right")];
    let pattern = Pattern { name: "tee".into(), pieces, seams };
    let (pieces, stitches) = read_json(&to_json(&pattern).unwrap().bytes);
    let way = |(panel, k): &(String, usize)| {
        let piece = pieces.iter().find(|p| p.name == *panel).unwrap();
        let (pose, n) = (piece.pose.unwrap(), piece.outer.corners.len());
        pose.at(piece.outer.corners[(k + 1) % n]) - pose.at(piece.outer.corners[*k])
    };
    assert_eq!(stitches.len(), 3);
    for ([a, b], alike) in &stitches {
        let cosine = way(a).normalize().dot(&way(b).normalize());
        assert!(!alike && cosine < -0.9, "{a:?} {b:?}: {cosine}");
    }
    // And they stand beside each other.
    let span = |piece: &Piece| {
        let xs: Vec<f64> = piece.outer.corners.iter().map(|c| piece.pose.unwrap().at(*c).x).collect();
        (
            xs.iter().copied().fold(f64::INFINITY, f64::min),
            xs.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        )
    };
    assert!(span(&pieces[1]).0 > span(&pieces[0]).1);
}
