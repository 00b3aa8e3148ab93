//! Drawings of our own making, as FreeSewing and drawing programs save them; every refusal word for
//! word.
#![allow(clippy::unwrap_used)]

use super::super::propose;
use super::*;
use proptest::prelude::{ProptestConfig, any, prop, proptest};
use std::f64::consts::PI;
use std::path::Path as FilePath;
use std::sync::Arc;
use toile_core::Cancel;

/// A page of 1 m by 1 m on which a unit is a millimetre.
fn page(inside: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1000mm\" height=\"1000mm\" viewBox=\"0 0 1000 1000\">\n{inside}\n</svg>"
    )
}

/// The pieces and the remarks on them, warnings first; of several faults the first. A unit is a
/// millimetre, whatever the page says.
fn read(svg: &str) -> Result<(Vec<Piece>, Vec<String>), SvgDamage> {
    let mut told = Remarks::default();
    let pieces = pieces_of(svg.as_bytes(), &in_unit(DrawingUnit::Millimetres), &mut told);
    let told = || [told.warnings, told.notes].concat().into_iter().filter(|t| !t.starts_with('`')).collect();
    pieces.map(|p| (p, told())).map_err(|mut all| all.remove(0))
}

fn in_unit(unit: DrawingUnit) -> SvgPattern {
    SvgPattern { unit, ..SvgPattern::default() }
}

fn of_bytes(bytes: &[u8]) -> Result<Vec<Piece>, Vec<SvgDamage>> {
    pieces_of(bytes, &in_unit(DrawingUnit::Millimetres), &mut Remarks::default())
}

/// The one piece of a page.
#[track_caller]
fn one(inside: &str) -> Piece {
    let (mut pieces, told) = read(&page(inside)).unwrap();
    assert_eq!(pieces.len(), 1, "{told:?}");
    pieces.remove(0)
}

fn length(p: &Piece, edge: &str) -> f64 {
    p.path(edge).unwrap().length()
}

fn perimeter(p: &Piece) -> f64 {
    (0..p.outer.edges.len()).map(|k| p.outer.path(k).length()).sum()
}

fn names(pieces: &[Piece]) -> Vec<&str> {
    pieces.iter().map(|p| p.name.as_str()).collect()
}

/// A T-shirt in FreeSewing's form: halves on the fold, a sleeve that is cut twice, notches as
/// clones, seam allowance.
fn tee() -> String {
    let part = |name: &str, inside: &str| {
        format!(
            "<g id=\"fs-stack-tee.{name}\" transform=\"translate(10, 20)\"><g id=\"fs-stack-tee.{name}-part-tee.{name}\">{inside}</g></g>"
        )
    };
    let fold = "<path class=\"note\" marker-start=\"url(#cutonfoldFrom)\" data-text=\"plugin-annotations:cutOnFoldAndGrainline\" \
                d=\"M 0,140 L 15,140 L 15,560 L 0,560\"/>";
    let body = |neck: &str, notch: &str| {
        format!(
            "<path class=\"fabric\" id=\"fs-1\" d=\"M 0,600 L 250,600 L 250,230 C 235,230 228,221 221,214 C 203,196 190,130 207,31 L 110,9 {neck} L 0,600 z\"/>\
             <path class=\"fabric sa\" d=\"M 0,630 L 260,630 L 260,220 L 217,20 L 100,0 L 0,100 z\"/>\
             <path class=\"contrast help\" d=\"M 0,300 L 250,300\"/>{fold}<use x=\"204\" y=\"146\" xlink:href=\"#{notch}\"/>\
             <text><tspan>plugin-annotations:cut,1,plugin-annotations:onFold</tspan></text>"
        )
    };
    let sleeve = "<path class=\"fabric\" d=\"M -160,49 L 160,49 L 160,0 C 160,0 144,-9 123,-28 C 91,-56 77,-98 53,-133 C 37,-156 -37,-154 -54,-132 C -68,-114 -114,-43 -128,-30 C -141,-17 -160,0 -160,0 z\"/>\
                  <path class=\"note\" marker-start=\"url(#grainlineFrom)\" data-text=\"plugin-annotations:grainline\" d=\"M 2,38 L 2,-139\"/>\
                  <use x=\"83\" y=\"-80\" xlink:href=\"#notch\"/>\
                  <text><tspan>plugin-annotations:cut,2,plugin-annotations:mirrored</tspan></text>";
    let parts = part("front", &body("C 100,60 50,100 0,100", "notch"))
        + &part("back", &body("C 104,36 56,36 0,36", "bnotch"))
        + &part("sleeve", sleeve);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" freesewing=\"4.10.2\" width=\"900mm\" \
         height=\"700mm\" viewBox=\"0 0 900 700\"><defs>button=\"<g id=\"notch\"><circle r=\"1\" class=\"note\"/></g></defs>{parts}</svg>"
    )
}

#[test]
fn parts_of_freesewing_are_unfolded_named_and_cut_as_often_as_they_say() {
    let (pieces, told) = read(&tee()).unwrap();
    assert_eq!(names(&pieces), ["front", "back", "sleeve", "sleeve_mirrored"]);
    assert_eq!(
        told,
        [
            "piece \"front\" is unfolded at its fold",
            "piece \"back\" is unfolded at its fold",
            "piece \"sleeve\" is cut 1 times as drawn and 1 times mirrored",
        ]
    );
    let front = &pieces[0];
    // Hem and neck run through the middle; side, armhole and shoulder are two each: the armhole is
    // one edge of two curves.
    assert_eq!(front.outer.edges.len(), 8);
    assert!((front.grain.unwrap()[1].y - front.grain.unwrap()[0].y - 0.42).abs() < 1e-12);
    assert_eq!((front.notches.len(), front.lines.len()), (2, 2));
    let shoulder = front
        .outer
        .edges
        .iter()
        .find(|e| (length(front, &e.name) - 97.0_f64.hypot(22.0) * 1e-3).abs() < 1e-9);
    assert!(shoulder.is_some());
    assert!((polygon_area(&front.outer.points().0) - polygon_area(&pieces[1].outer.points().0)).abs() > 1e-3);
}

#[test]
fn sides_shoulders_and_sleeves_are_proposed_and_no_hem() {
    let (pieces, _) = read(&tee()).unwrap();
    let found = propose::proposed_seams(&pieces);
    let names: Vec<&str> = found.iter().map(|p| p.seam.name.as_str()).collect();
    assert_eq!(found.len(), 8, "{names:?}");
    for cap in ["sleeve.", "sleeve_mirrored."] {
        let into = |s: &&PatternSeam| {
            s.sides[0].len() == 1 && s.sides[0][0].edge.to_string().starts_with(cap) && s.sides[1].len() == 2
        };
        let seam = found.iter().map(|p| &p.seam).find(into).unwrap();
        // Seen from outside, the front of a right sleeve is at its right: its cap begins at the
        // front.
        let first = &seam.sides[1][0].edge.panel;
        assert_eq!(first == "front", cap == "sleeve.", "{}", seam.name);
    }
    let hem = |u: &EdgeUse| {
        let p = pieces.iter().find(|p| p.name == u.edge.panel).unwrap();
        let low = p.outer.points().0.iter().map(|q| q.y).fold(f64::INFINITY, f64::min);
        p.path(&u.edge.edge).unwrap().points().iter().all(|q| q.y - low < 0.01)
    };
    assert!(!found.iter().flat_map(|p| p.seam.sides.iter().flatten()).any(hem), "{names:?}");
}

#[test]
fn every_command_of_path_data_is_read_and_arcs_keep_their_length() {
    // A square with a half circle on its right, by absolute and by relative commands.
    let square = "M 100 100 H 200 A 50 50 0 0 1 200 200 H 100 Z";
    let relative = "m 100,100 h 100 a 50,50 0 0 1 0,100 h -100 z";
    for d in [square, relative] {
        let p = one(&format!("<path id=\"p\" d=\"{d}\"/>"));
        assert!((perimeter(&p) - (0.3 + 0.05 * PI)).abs() < 1e-7, "{d}: {}", perimeter(&p));
    }
    let smooth = one("<path id=\"p\" d=\"M100 100 v100 h100 V100 Q 175 50 150 100 T 100 100 z\"/>");
    let spelled =
        one("<path id=\"p\" d=\"M100 100 L100 200 L200 200 L200 100 Q175 50 150 100 Q125 150 100 100 z\"/>");
    assert!((perimeter(&smooth) - perimeter(&spelled)).abs() < 1e-12);
    let smooth =
        one("<path id=\"p\" d=\"M100 100 v100 h100 v-100 c 0 -50 -40 -50 -50 0 s -40 50 -50 0 z\"/>");
    let spelled = one(
        "<path id=\"p\" d=\"M100 100 V200 H200 V100 C200 50 160 50 150 100 C 140 150 110 150 100 100 z\"/>",
    );
    assert!((perimeter(&smooth) - perimeter(&spelled)).abs() < 1e-12);
}

#[test]
fn basic_shapes_are_pieces() {
    let around = |inside: &str| perimeter(&one(inside));
    assert!((around("<rect id=\"r\" x=\"1cm\" y=\"10\" width=\"100\" height=\"50\"/>") - 0.3).abs() < 1e-9);
    let rounded = around("<rect id=\"r\" width=\"100\" height=\"50\" rx=\"10\"/>");
    assert!((rounded - (0.3 - 0.08 + 0.02 * PI)).abs() < 1e-7, "{rounded}");
    let circle = around("<circle id=\"c\" cx=\"50\" cy=\"50\" r=\"40\"/>");
    assert!((circle - 0.08 * PI).abs() < 1e-6, "{circle}");
    assert!((around("<polygon id=\"t\" points=\"0,0 30,0 30,40\"/>") - 0.12).abs() < 1e-9);
    let lines = "<g id=\"t\"><line id=\"a\" x2=\"30\"/><line id=\"b\" x1=\"30\" x2=\"30\" y2=\"40\"/><polyline id=\"c\" points=\"30,40 0,0\"/></g>";
    let p = one(lines);
    assert_eq!(
        (p.name.as_str(), p.outer.edges.iter().map(|e| e.name.as_str()).collect::<Vec<_>>()),
        ("t", vec!["c", "b", "a"])
    );
    // An ellipse turned by 30 degrees is as long as before.
    let plain = around("<ellipse id=\"e\" rx=\"60\" ry=\"30\"/>");
    assert!(
        (around("<g transform=\"translate(3 4) rotate(30)\"><ellipse id=\"e\" rx=\"60\" ry=\"30\"/></g>")
            - plain)
            .abs()
            < 1e-9
    );
}

#[test]
fn transforms_nest_and_clones_are_followed() {
    let inside = "<defs><path id=\"half\" d=\"M0 0 H50 V40 H0 Z\"/></defs>\
                  <g transform=\"matrix(0 2 -2 0 300 0)\"><g transform=\"scale(1.5)\"><use id=\"cuff\" href=\"#half\" x=\"20\"/></g></g>";
    let p = one(inside);
    assert_eq!(p.name, "half");
    let (lo, hi) = p
        .outer
        .corners
        .iter()
        .fold((p.outer.corners[0], p.outer.corners[0]), |(a, b), q| (a.inf(q), b.sup(q)));
    assert!((hi - lo - Vector2::new(0.12, 0.15)).norm() < 1e-12, "{}", hi - lo);
    assert!((lo - Point2::new(0.18, -0.21)).norm() < 1e-12, "{lo}");
}

#[test]
fn units_are_those_of_the_page_and_told() {
    let square = "<path id=\"p\" d=\"M0 0 H960 V960 H0 Z\"/>";
    let sized = |attributes: &str, unit: DrawingUnit| {
        let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {attributes}>{square}</svg>");
        let mut told = Remarks::default();
        let pieces = pieces_of(svg.as_bytes(), &in_unit(unit), &mut told).map_err(|mut all| all.remove(0))?;
        Ok::<_, SvgDamage>((length(&pieces[0], "edge_0") / 960.0, told))
    };
    let near = |found: Result<(f64, Remarks), SvgDamage>, metres: f64| {
        let (found, told) = found.unwrap();
        assert!((found / metres - 1.0).abs() < 1e-9, "{found} {metres}");
        [told.warnings, told.notes]
            .concat()
            .into_iter()
            .find(|t| t.contains("a unit of the drawing"))
            .unwrap_or_default()
    };
    let auto = |attributes: &str, metres: f64| near(sized(attributes, DrawingUnit::Auto), metres);
    assert_eq!(
        auto("width=\"21cm\" height=\"29.7cm\" viewBox=\"0 0 210 297\"", 1e-3),
        "the page's width is 21cm, 210 units of its viewBox: a unit of the drawing is 1.0000 mm"
    );
    auto("width=\"10in\" height=\"10in\" viewBox=\"0 0 720 720\"", 0.0254 / 72.0);
    assert_eq!(
        auto("width=\"200mm\" height=\"200mm\"", 0.0254 / 96.0),
        "the page's width is 200mm, and without a viewBox a unit is a pixel: a unit of the drawing is 0.2646 mm"
    );
    // Lengths in pixels scale the viewBox, too.
    assert_eq!(
        auto("width=\"1000px\" height=\"1000\" viewBox=\"0 0 500 500\"", 2.0 * 0.0254 / 96.0),
        "the page's width is 1000 pixels, 96 an inch, and 500 units of its viewBox: a unit of the drawing is 0.5292 mm, \
         and the largest piece 51 cm long; say the drawing's unit where that is wrong, such as `--set pattern.unit=Millimetres`"
    );
    assert_eq!(
        auto("viewBox=\"0 0 500 500\"", 0.0254 / 96.0),
        "the page's size is given in no unit of length, and pixels are 96 an inch: a unit of the drawing is 0.2646 mm, \
         and the largest piece 25 cm long; say the drawing's unit where that is wrong, such as `--set pattern.unit=Millimetres`"
    );
    near(sized("width=\"1000px\" viewBox=\"0 0 500 500\"", DrawingUnit::Centimetres), 1e-2);
    let small =
        sized("width=\"250px\" height=\"250px\" viewBox=\"0 0 500 500\"", DrawingUnit::Auto).unwrap_err();
    assert_eq!(
        (small.to_string(), small.remedy()),
        (
            "no one wears a garment of that size: its largest piece, \"p\", would be 13 cm long, as the page's width is 250 pixels, 96 an inch, and \
             500 units of its viewBox: a unit of the drawing is 0.1323 mm".to_owned(),
            "`--set pattern.unit=Millimetres` makes it 96 cm long".to_owned()
        )
    );
    let illustrator = "<?xml version=\"1.0\"?><!-- Generator: Adobe Illustrator 28.0 -->".to_owned()
        + &format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"500\" height=\"500\">{square}</svg>");
    let pieces = pieces_of(illustrator.as_bytes(), &SvgPattern::default(), &mut Remarks::default()).unwrap();
    assert!((length(&pieces[0], "edge_0") / 960.0 / (0.0254 / 72.0) - 1.0).abs() < 1e-9);
}

#[test]
fn outlines_without_groups_may_touch_and_overlap() {
    let pieces = |inside: &str| {
        let (pieces, told) = read(&page(inside)).unwrap();
        (pieces.len(), told.into_iter().filter(|t| t.contains("left out")).collect::<Vec<_>>())
    };
    let none = Vec::<String>::new();
    // Two halves that share an edge; a triangle that lies partly in the notch of a skirt and partly
    // on it; one that fills a notch.
    let halves = "<path d=\"M100 0 H300 V300 H100 Z\"/><path d=\"M300 0 H500 V300 H300 Z\"/>";
    assert_eq!(pieces(halves), (2, none.clone()));
    let skirt = "<path d=\"M0 0 H400 V300 H300 L250 150 L200 300 H0 Z\"/>";
    assert_eq!(pieces(&format!("{skirt}<path d=\"M170 300 L210 200 L270 300 Z\"/>")), (2, none.clone()));
    assert_eq!(pieces(&format!("{skirt}<path d=\"M300 300 L250 150 L200 300 Z\"/>")), (2, none.clone()));
    // What lies wholly on another and is filled like it is a piece; else it is left out, with its
    // place.
    let filled = "<path fill=\"#eee\" d=\"M0 0 H400 V300 H0 Z\"/><path fill=\"#eee\" d=\"M100 100 H200 V200 H100 Z\"/>";
    assert_eq!(pieces(filled), (2, none.clone()));
    assert_eq!(
        pieces("<path id=\"a\" d=\"M0 0 H400 V300 H0 Z\"/><path id=\"b\" d=\"M100 100 H200 V200 H100 Z\"/>"),
        (1, vec![
            "1 closed lines lie on a piece of their group and are not called anything: left out (path \"b\" (line 2 column 39))".to_owned()
        ])
    );
    // A frame around all, and one path that draws two pieces.
    let (count, told) = pieces(&format!(
        "<rect width=\"900\" height=\"900\"/><g transform=\"translate(50 50)\"/>{}",
        halves.replace("M100 0", "M100 50").replace("M300 0", "M300 50").replace("V300", "V400")
    ));
    assert_eq!((count, told.len()), (2, 1), "{told:?}");
    assert_eq!(pieces("<path id=\"both\" d=\"M0 0 H200 V200 H0 Z M300 0 H500 V200 H300 Z\"/>"), (2, none));
}

#[test]
fn dimensions_are_no_lines_of_pieces() {
    let front = "<g id=\"front\"><path d=\"M0 0 H300 V300 H0 Z\"/><path class=\"mark\" d=\"M0 150 H300\"/>\
                 <path class=\"mark dotted\" d=\"M0 300 V350\"/><path class=\"mark dotted\" d=\"M300 300 V350\"/>\
                 <path class=\"mark\" marker-start=\"url(#dimensionFrom)\" marker-end=\"url(#dimensionTo)\" d=\"M0 350 H300\"/></g>";
    let (pieces, told) = read(&page(front)).unwrap();
    assert_eq!(pieces[0].lines.len(), 1);
    assert!(told.contains(&"3 dimension lines are left out".to_owned()), "{told:?}");
}

#[test]
fn a_piece_on_two_folds_is_unfolded_at_both() {
    let quarter = |inside: &str, folds: [&str; 2]| {
        let folds = folds.map(|d| format!("<path class=\"fold\" d=\"{d}\"/>")).concat();
        read(&page(&format!("<g id=\"skirt\"><path d=\"{inside}\"/>{folds}</g>"))).unwrap()
    };
    let (pieces, told) = quarter("M0 0 H300 V200 H0 Z", ["M0 20 V180", "M20 0 H280"]);
    assert!((perimeter(&pieces[0]) - 2.0).abs() < 1e-9);
    assert!(told.contains(&"piece \"skirt\" is unfolded at its 2 folds".to_owned()), "{told:?}");
    // A quarter of a ring: the whole is cut open at one fold, and a seam there is proposed.
    let (pieces, told) = quarter(
        "M0 100 V500 C276 500 500 276 500 0 H100 C100 55 55 100 0 100 Z",
        ["M0 120 V480", "M120 0 H480"],
    );
    let area = polygon_area(&pieces[0].outer.points().0);
    assert!((area / (0.24 * PI) - 1.0).abs() < 5e-3, "{area}");
    assert!(told[0].starts_with("piece \"skirt\" is a ring when both its folds are unfolded: "), "{told:?}");
    let seams = propose::proposed_seams(&pieces);
    assert!(seams.iter().any(|s| s.seam.sides.len() == 2 && s.confidence == 0.99), "{seams:?}");
}

#[test]
fn edges_run_counter_clockwise_whichever_way_they_are_drawn() {
    let ends = |d: &str| {
        let (pieces, told) = read(&page(&format!("<path id=\"p\" d=\"{d}\"/>"))).unwrap();
        let path = pieces[0].path("edge_0").unwrap();
        ([path.at(0.0), path.at(path.length())], told)
    };
    let (right, left) = (Point2::new(0.3, 0.0), Point2::new(0.0, 0.0));
    // The upper edge, drawn first, to the right and to the left.
    let (clockwise, told) = ends("M0 0 H300 V200 H0 Z");
    assert_eq!(clockwise, [right, left]);
    assert_eq!(
        told,
        [
            "1 pieces are drawn clockwise: their edges run counter-clockwise all the same, as the arrows in their pictures show"
        ]
    );
    assert_eq!(ends("M300 0 H0 V200 H300 Z"), ([right, left], Vec::new()));
}

#[test]
fn all_faults_of_a_drawing_are_told_at_once() {
    let bow = |id: &str, x: u32| {
        format!("<g id=\"{id}\" transform=\"translate({x} 0)\"><path d=\"M0 0 L100 80 V0 L0 100 Z\"/></g>")
    };
    let all = of_bytes(page(&(bow("front", 0) + &bow("back", 200))).as_bytes()).unwrap_err();
    assert_eq!(all.len(), 2, "{all:?}");
}

#[test]
fn names_come_from_label_title_and_id() {
    let inkscape = "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"500mm\" height=\"500mm\" viewBox=\"0 0 500 500\">\
        <g inkscape:groupmode=\"layer\" id=\"layer1\" inkscape:label=\"Pieces\">\
        <path id=\"path1\" inkscape:label=\"front\" d=\"M0 0 H100 V100 H0 Z\"/>\
        <path id=\"path2\" d=\"M200 0 H300 V100 H200 Z\"><title>back</title></path>\
        <g id=\"g3\" inkscape:label=\"collar 1.5\"><rect id=\"rect4\" y=\"200\" width=\"100\" height=\"40\"/></g></g>\
        <g inkscape:groupmode=\"layer\" id=\"layer2\" inkscape:label=\"Notches\"><circle cx=\"50\" cy=\"1\" r=\"2\"/></g>\
        <g inkscape:groupmode=\"layer\" id=\"layer3\" inkscape:label=\"Hidden\" style=\"display:none\"><rect width=\"90\" height=\"90\" y=\"300\"/></g></svg>";
    let (pieces, _) = read(inkscape).unwrap();
    assert_eq!(names(&pieces), ["front", "back", "collar 1_5"]);
    assert_eq!(pieces[0].notches.len(), 1);
    let illustrator = page(
        "<g id=\"sleeve_x20_left\"><rect width=\"50\" height=\"60\"/></g><g id=\"_2_\" data-name=\"yoke\"><rect x=\"100\" width=\"50\" height=\"60\"/></g>",
    );
    assert_eq!(names(&read(&illustrator).unwrap().0), ["sleeve left", "yoke"]);
    let lone = page("<path d=\"M0 0 H100 V100 H0 Z\"/><path d=\"M200 0 H300 V100 H200 Z\"/>");
    assert_eq!(names(&read(&lone).unwrap().0), ["piece_1", "piece_2"]);
}

#[test]
fn what_is_hidden_small_or_a_frame_is_no_piece() {
    let inside = "<style>.gone, #off { display: none }</style><rect width=\"900\" height=\"900\"/>\
                  <g id=\"front\"><rect x=\"10\" y=\"10\" width=\"100\" height=\"100\"/></g>\
                  <g id=\"back\"><rect x=\"210\" y=\"10\" width=\"100\" height=\"100\"/><rect x=\"220\" y=\"20\" width=\"5\" height=\"5\"/></g>\
                  <rect class=\"gone\" x=\"10\" y=\"300\" width=\"100\" height=\"100\"/><rect id=\"off\" x=\"10\" y=\"500\" width=\"100\" height=\"100\"/>\
                  <image width=\"10\" height=\"10\"/><g display=\"none\"><rect x=\"400\" width=\"99\" height=\"99\"/></g>";
    let (pieces, told) = read(&page(inside)).unwrap();
    assert_eq!(names(&pieces), ["front", "back"]);
    assert_eq!(
        told[..3],
        [
            "1 closed lines are too small for pieces: left out (rect (line 2 column 201))",
            "1 closed lines around other pieces are taken for frames: left out (rect (line 2 column 45))",
            "1 pictures of pixels are left out"
        ]
    );
}

#[test]
fn a_closed_line_without_length_is_no_piece() {
    let p = one("<g id=\"front\"><path d=\"M 20,80 V 80 Z\"/><rect width=\"120\" height=\"120\"/></g>");
    assert!((perimeter(&p) - 0.48).abs() < 1e-12);
    let alone = read(&page("<g id=\"front\"><path d=\"M 20,80 V 80 Z\"/></g>"));
    assert!(matches!(alone, Err(SvgDamage::NoPieces)), "{alone:?}");
}

#[test]
fn the_seam_is_read_and_not_the_allowance_around_it() {
    let p = one(
        "<g id=\"front\"><path class=\"seam allowance\" d=\"M0 0 H120 V120 H0 Z\"/><path id=\"seam\" d=\"M10 10 H110 V110 H10 Z\"/></g>",
    );
    assert!((perimeter(&p) - 0.4).abs() < 1e-12);
    let p = one(
        "<g id=\"front\"><rect width=\"120\" height=\"120\"/><rect id=\"dart\" x=\"10\" y=\"10\" width=\"99\" height=\"99\"/></g>",
    );
    assert!((perimeter(&p) - 0.48).abs() < 1e-12);
}

#[test]
fn a_half_piece_may_be_drawn_without_its_middle() {
    let closed =
        one("<g id=\"front\"><path d=\"M0 0 H100 L90 200 H0 Z\"/><path id=\"fold\" d=\"M0 20 V180\"/></g>");
    let open =
        one("<g id=\"front\"><path d=\"M0 0 H100 L90 200 H0\"/><path id=\"fold\" d=\"M0 20 V180\"/></g>");
    assert_eq!(closed.outer.edges.len(), 4);
    assert!((perimeter(&closed) - perimeter(&open)).abs() < 1e-12);
    assert!((length(&closed, "edge_0") - 0.2).abs() < 1e-12);
    // The grain lies across the page: the end at its head is up.
    let turned =
        one("<g id=\"band\"><rect width=\"300\" height=\"40\"/><path id=\"grain\" d=\"M20 20 H200\"/></g>");
    let [a, b] = turned.grain.unwrap();
    assert!((b.y - a.y - 0.18).abs() < 1e-12);
}

/// Two sizes, a layer each, with a title that is the same in both.
fn two_sizes() -> String {
    let layer = |name: &str, side: u32| {
        format!(
            "<g inkscape:groupmode=\"layer\" inkscape:label=\"{name}\"><path id=\"p{side}\" inkscape:label=\"front\" d=\"M0 0 H{side} V{side} H0 Z\"/></g>"
        )
    };
    page(&format!("{}{}", layer("S", 300), layer("M", 400))).replacen(
        "<svg",
        "<svg xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"",
        1,
    )
}

#[test]
fn one_size_is_read_of_a_drawing_that_has_a_layer_for_each() {
    let of_size = |size: &str| {
        let mut told = Remarks::default();
        let asked = SvgPattern { size: size.into(), ..in_unit(DrawingUnit::Millimetres) };
        let pieces = pieces_of(two_sizes().as_bytes(), &asked, &mut told).map_err(|mut all| all.remove(0))?;
        Ok((pieces.iter().map(perimeter).collect::<Vec<f64>>(), told.notes))
    };
    let (perimeters, notes) = of_size("m").unwrap();
    assert!(perimeters.len() == 1 && (perimeters[0] - 1.6).abs() < 1e-9, "{perimeters:?}");
    assert!(notes.contains(&"\"m\" is read, without S".to_owned()), "{notes:?}");
    assert_eq!(of_size("").unwrap().0.len(), 2);
    let refused: SvgDamage = of_size("XL").unwrap_err();
    assert_eq!(
        (refused.to_string().as_str(), refused.remedy().as_str(), refused.fault().param),
        ("no layer and no group is called \"XL\"", "there are S, M", "size")
    );
    let bare = SvgDamage::NoSize { size: "XL".into(), known: Vec::new() };
    assert_eq!(
        bare.remedy(),
        "it has no layers or groups with names: draw each size in a layer that is called like it, or leave `size` out"
    );
}

#[test]
fn letters_are_in_the_encoding_that_is_asked_for_or_that_the_file_says() {
    let drawing = page("<g id=\"Rücken\"><path d=\"M0 0 H300 V300 H0 Z\"/></g>");
    let latin = |head: &str| {
        let (bytes, _, _) = encoding_rs::WINDOWS_1252.encode(&drawing);
        [head.as_bytes(), &bytes].concat()
    };
    let of = |bytes: &[u8], encoding: &str| {
        let asked = SvgPattern { encoding: encoding.into(), ..in_unit(DrawingUnit::Millimetres) };
        let pieces = pieces_of(bytes, &asked, &mut Remarks::default()).map_err(|mut all| all.remove(0))?;
        Ok::<_, SvgDamage>(pieces[0].name.clone())
    };
    let declared = "<?xml version=\"1.0\" encoding=\"iso-8859-1\"?>\n";
    assert_eq!(of(&latin(declared), "").unwrap(), "Rücken");
    assert_eq!(of(&latin(""), "windows-1252").unwrap(), "Rücken");
    // A declaration that was left as it was.
    assert_eq!(of(format!("{declared}{drawing}").as_bytes(), "").unwrap(), "Rücken");
    let wide: Vec<u8> =
        [0xfeff_u16].into_iter().chain(drawing.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert_eq!(of(&wide, "").unwrap(), "Rücken");
    let refused = |bytes: &[u8], encoding: &str| {
        let damage = of(bytes, encoding).unwrap_err();
        (damage.to_string(), damage.remedy(), damage.fault().param)
    };
    let remedy = "save it as UTF-8, or say its encoding, such as `--set 'pattern.encoding=\"windows-1252\"'`";
    assert_eq!(refused(&latin(""), ""), ("it is not UTF-8 text".to_owned(), remedy.to_owned(), "file"));
    let other = "<?xml version=\"1.0\" encoding=\"shift_jis\"?>\n";
    assert_eq!(
        refused(&[other.as_bytes(), b"\xa0\xff"].concat(), ""),
        ("it says that it is in \"shift_jis\", which is not so".to_owned(), remedy.to_owned(), "file")
    );
    assert_eq!(refused(drawing.as_bytes(), "latin 9000").0, "there is no encoding \"latin 9000\"");
    assert_eq!(refused(drawing.as_bytes(), "latin 9000").2, "encoding");
}

#[test]
fn damage_is_refused_with_element_and_place() {
    #[track_caller]
    fn is(svg: &str, sentence: &str, remedy: &str) {
        let d = read(svg).unwrap_err();
        assert_eq!((d.to_string().as_str(), d.remedy().as_str()), (sentence, remedy));
    }
    let again = "save the file again as plain SVG";
    is("<svg", "it is no XML at line 1 column 1: the document does not have a root node", again);
    is("<html/>", "its first element is \"html\", not \"svg\"", "give a file that was saved as SVG");
    is("\u{1f}\u{8b}", "it is no XML at line 1 column 1: unknown token", again);
    assert_eq!(of_bytes(&[0x1f, 0x8b, 8]).unwrap_err(), [SvgDamage::Compressed]);
    assert_eq!(of_bytes(&[0xc3, 0x28]).unwrap_err(), [SvgDamage::Encoding]);
    let redraw = "draw the element again, or take it out";
    is(
        &page("<g>\n <path id=\"hem\" d=\"M 0 0 L x\"/></g>"),
        "path \"hem\" (line 3 column 2): \"M 0 0 L x\" is no d",
        redraw,
    );
    is(&page("<rect width=\"-3\" height=\"4\"/>"), "rect (line 2 column 1): \"-3\" is no width", redraw);
    is(&page("<g transform=\"turn(3)\"/>"), "g (line 2 column 1): \"turn(3)\" is no transform", redraw);
    is(
        &page("<g id=\"a\"><use href=\"#a\"/></g>"),
        "use (line 2 column 11): it uses itself",
        "unlink the clone, or take it out",
    );
    let group = "draw every piece as a closed line, or as lines that meet end to end, in a group of its own";
    is(&page(""), "there are no pieces: it holds no closed line of a garment's size", group);
    is(
        &page("<path d=\"M0 0 H900\"/>"),
        "there are no pieces: it holds no closed line of a garment's size",
        group,
    );
    is(
        &page("<text>front</text>"),
        "there are no pieces: it holds text alone",
        "turn no outlines into text: export the pieces as paths",
    );
    is(
        &page("<image/>"),
        "there are no pieces: it holds a picture of pixels alone",
        "trace the picture: pieces are read from paths",
    );
    let closed = "draw the outline as one closed line that meets itself nowhere";
    is(
        &page(
            "<g id=\"front\"><path id=\"a\" d=\"M0 0 H100 V100\"/><path id=\"b\" d=\"M100 120 H0 V0\"/></g>",
        ),
        "piece \"front\", path \"a\" (line 2 column 15): its outline is open by 20.0 mm near (100.0, 100.0) mm on the page",
        closed,
    );
    is(
        &page("<path id=\"bow\" d=\"M0 0 L100 80 V0 L0 100 Z\"/>"),
        "piece \"bow\", path \"bow\" (line 2 column 1): its outline crosses itself near (100.0, 80.0) mm on the page",
        closed,
    );
    is(
        &page("<g id=\"front\"><rect width=\"90\" height=\"90\"/><path id=\"fold\" d=\"M40 0 V90\"/></g>"),
        "piece \"front\", path \"fold\" (line 2 column 45): the fold does not lie along an edge of its outline",
        "let the line called fold run along a straight edge of the outline",
    );
}

#[test]
fn entities_and_clones_are_bounded() {
    let declared = "<!DOCTYPE svg [<!ENTITY d \"M0 0 H100 V100 H0 Z\">]>";
    let illustrator = declared.to_owned() + &page("<path id=\"front\" d=\"&d;\"/>");
    assert_eq!(names(&read(&illustrator).unwrap().0), ["front"]);
    let lol = |k: u32| format!("<!ENTITY a{} \"{}\">", k + 1, format!("&a{k};").repeat(10));
    let entities: String = (0..9).map(lol).collect();
    let laughs = format!("<!DOCTYPE svg [<!ENTITY a0 \"ha\">{entities}]>") + &page("<text>&a9;</text>");
    assert!(read(&laughs).unwrap_err().to_string().starts_with("it is no XML at line "));
    let doubled =
        |k: u32| format!("<g id=\"u{}\">{}</g>", k + 1, format!("<use href=\"#u{k}\"/>").repeat(10));
    let clones = page(&format!(
        "<defs><g id=\"u0\"/>{}</defs><use href=\"#u9\"/>",
        (0..9).map(doubled).collect::<String>()
    ));
    assert_eq!(read(&clones).unwrap_err().to_string(), "it has more than 100000 elements");
    let deep = page(&("<g>".repeat(150) + &"</g>".repeat(150)));
    assert_eq!(read(&deep).unwrap_err().to_string(), "it has more than 100 groups within each other");
}

fn run(folder: &FilePath, stage: &SvgPattern) -> Result<(Pattern, OutputFiles, Vec<String>), StageError> {
    let cx = Context::new("SvgPattern", folder, Cancel::new(), Arc::new(()));
    let (pattern, _, _, files) = stage.run(&cx)?;
    Ok((pattern, files, cx.take_remarks().warnings))
}

#[test]
fn nothing_is_sewn_until_the_proposals_are_given_back() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("tee.svg"), tee()).unwrap();
    let stage = SvgPattern { file: "tee.svg".into(), ..SvgPattern::default() };
    let (pattern, files, told) = run(dir.path(), &stage).unwrap();
    assert!(pattern.seams.is_empty());
    assert_eq!(
        told.last().unwrap(),
        "no seams are given, and nothing is sewn: 8 are proposed in seams.ron; look through it and give it as `seams`"
    );
    std::fs::write(dir.path().join("seams.ron"), &files.0[0].bytes).unwrap();
    let (pattern, files, _) = run(dir.path(), &SvgPattern { seams: "seams.ron".into(), ..stage }).unwrap();
    assert_eq!((pattern.seams.len(), files.0.len()), (8, 0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = of_bytes(&bytes);
    }

    #[test]
    fn no_spoilt_drawing_panics_and_what_is_read_is_sound(
        at in prop::collection::vec((0..3000_usize, any::<u8>()), 1..6),
        cut in 0..3000_usize,
    ) {
        let mut bytes = tee().into_bytes();
        let n = bytes.len();
        at.iter().for_each(|(k, b)| bytes[k % n] = *b);
        if cut % 7 == 0 {
            bytes.truncate(cut % n);
        }
        if let Ok(pieces) = of_bytes(&bytes) {
            let _ = propose::proposed_seams(&pieces);
            let pattern = Pattern { name: "spoilt".into(), pieces, seams: Vec::new() };
            proptest::prop_assert_eq!(toile_core::artifact::Artifact::check(&pattern), Ok(()));
        }
    }

    #[test]
    fn no_path_data_panics(d in "[MmLlHhVvCcSsQqTtAaZz0-9 ,.eE+-]{0,60}") {
        let _ = read(&page(&format!("<path d=\"M0 0 {d}\"/>")));
    }
}
