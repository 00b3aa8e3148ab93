#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::style::block::template::bow::{Bow, SampledBow};
use crate::style::block::template::curve::Curve;
use nalgebra::Rotation2;
use proptest::prelude::*;

mod halves;
mod made_up;
mod said;
mod worn;

/// A closed polygon, a point each 5 mm or so, from the corners of its right half in mm, from below
/// to above.
fn garment(half: &[[f64; 2]]) -> Vec<Point2> {
    let right = half.iter().map(|p| Point2::new(p[0] / 1e3, p[1] / 1e3));
    let left = half.iter().rev().filter(|p| p[0] > 0.0).map(|p| Point2::new(-p[0] / 1e3, p[1] / 1e3));
    let corners: Vec<Point2> = right.chain(left).collect();
    let n = corners.len();
    let side = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % n]);
        let parts = ((b - a).norm() / 5e-3).ceil() as usize;
        (0..parts).map(move |k| a + (b - a) * (k as f64 / parts as f64))
    };
    (0..n).flat_map(side).collect()
}

const TEE: &[[f64; 2]] = &[
    [0.0, 0.0],
    [260.0, 0.0],
    [250.0, 420.0],
    [360.0, 360.0],
    [440.0, 500.0],
    [230.0, 640.0],
    [90.0, 680.0],
    [0.0, 660.0],
];
const VEST: &[[f64; 2]] = &[
    [0.0, 0.0],
    [250.0, 0.0],
    [240.0, 400.0],
    [180.0, 460.0],
    [170.0, 640.0],
    [90.0, 660.0],
    [70.0, 590.0],
    [0.0, 570.0],
];
const SKIRT: &[[f64; 2]] = &[[0.0, 0.0], [320.0, 0.0], [180.0, 600.0], [0.0, 600.0]];
const TROUSERS: &[[f64; 2]] =
    &[[0.0, 700.0], [90.0, 0.0], [230.0, 0.0], [240.0, 720.0], [200.0, 950.0], [0.0, 950.0]];

fn outline(points: Vec<Point2>) -> Outline {
    let frame =
        PhotoFrame { origin_px: Point2::new(500.0, 900.0), px_per_metre: 1000.0, mirrored: false, turn: 0.0 };
    Outline {
        outer: Loop { points, corners: vec![] },
        holes: vec![],
        edges: vec![],
        inner: vec![],
        frame: Some(frame),
        lies: vec![],
    }
}

fn turned(points: Vec<Point2>, degrees: f64) -> Vec<Point2> {
    let turn = Rotation2::new(degrees.to_radians());
    points.into_iter().map(|p| turn * p + Vector2::new(0.03, -0.02)).collect()
}

/// A mannequin's landmarks on a body of a few points.
fn body() -> Body {
    let marks = [
        ("neck_left", [0.07, 1.4, 0.0]),
        ("shoulder_left", [0.18, 1.35, 0.0]),
        ("waist_front", [0.0, 1.0, 0.1]),
        ("neck_base_front", [0.0, 1.36, 0.08]),
    ];
    Body {
        positions: vec![
            Point3::new(0.0, 0.9, 0.12),
            Point3::new(0.0, 0.9, -0.12),
            Point3::new(0.0, 1.6, 0.0),
        ],
        landmarks: marks.map(|(n, [x, y, z])| (n.to_owned(), Point3::new(x, y, z))).into(),
        triangles: vec![],
        measurements: [].into(),
    }
}

fn cut(stage: &Block, points: Vec<Point2>) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
    let front = [("front".to_owned(), outline(points))].into_iter().collect();
    stage.run(front, &body(), None, &Context::quiet())
}

fn of(style: BlockStyle) -> Block {
    Block { style, ..Block::default() }
}

fn length(pattern: &Pattern, piece: &str, edge: &str) -> f64 {
    1e3 * pattern.piece(piece).unwrap().path(edge).unwrap().length()
}

/// The length of a straight edge between two corners of a half, mm.
fn between(half: &[[f64; 2]], i: usize) -> f64 {
    (half[i + 1][0] - half[i][0]).hypot(half[i + 1][1] - half[i][1])
}

#[test]
fn a_shirt_gets_pieces_of_its_own_lengths() {
    let (pattern, ..) = cut(&of(BlockStyle::TShirt), turned(garment(TEE), 7.0)).unwrap();
    let names: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    let sleeves = ["left_sleeve_front", "right_sleeve_front"];
    assert_eq!(names[..3], ["front", sleeves[0], sleeves[1]]);
    assert_eq!(names.len(), 6);
    let near = |piece: &str, edge: &str, want: f64| {
        let is = length(&pattern, piece, edge);
        assert!((is - want).abs() < 4.0, "{piece} {edge}: {is:.1} for {want:.1} mm");
    };
    for piece in ["front", "back"] {
        near(piece, "hem", 520.0);
        near(piece, "side_left", between(TEE, 1));
        near(piece, "side_right", between(TEE, 1));
    }
    for sleeve in sleeves {
        near(sleeve, "underarm", between(TEE, 2));
        near(sleeve, "cuff", between(TEE, 3));
    }
    // The upper border as a whole; where shoulder and neck meet at a blunt corner, one may be
    // longer and the other shorter by a centimetre.
    let parts = [("left_sleeve_front", "top", 1.0), ("front", "shoulder_left", 1.0), ("front", "neck", 0.5)];
    let border: f64 = parts.iter().map(|(piece, edge, share)| share * length(&pattern, piece, edge)).sum();
    let want = between(TEE, 4) + between(TEE, 5) + between(TEE, 6);
    assert!((border - want).abs() < 5.0, "{border:.1} for {want:.1} mm");
}

#[test]
fn every_cap_is_as_long_as_its_armhole() {
    let (pattern, _, plan) = cut(&of(BlockStyle::TShirt), garment(TEE)).unwrap();
    for layer in ["front", "back"] {
        for side in ["left", "right"] {
            let cap = length(&pattern, &format!("{side}_sleeve_{layer}"), "cap");
            let armhole = length(&pattern, layer, &format!("armhole_{side}"));
            assert!((cap - armhole).abs() < 0.1 && cap > 150.0, "{cap} {armhole}");
        }
    }
    assert_eq!(plan.seams.len(), 12);
    assert!(plan.seams.iter().all(|s| !s.reversed && s.kind == SeamKind::Matched), "{:?}", plan.seams);
}

#[test]
fn pieces_know_their_place_in_the_photo() {
    let points = turned(garment(TEE), 7.0);
    let (pattern, outlines, _) = cut(&of(BlockStyle::TShirt), points.clone()).unwrap();
    let photo = outline(vec![]).frame.unwrap();
    let off = |p: Point2| points.iter().map(|q| (photo.to_px(*q) - p).norm()).fold(f64::INFINITY, f64::min);
    for (name, edge) in [
        ("front", "side_left"),
        ("front", "hem"),
        ("left_sleeve_front", "cuff"),
        ("right_sleeve_front", "underarm"),
    ] {
        let frame = outlines.get(name).unwrap().frame.unwrap();
        let path = pattern.piece(name).unwrap().path(edge).unwrap();
        for share in [0.2, 0.5, 0.8] {
            let miss = off(frame.to_px(path.at(share * path.length())));
            assert!(miss < 5.0, "{name} {edge}: {miss:.1} px of a millimetre each");
        }
    }
    // What no photo shows is the front seen in a mirror: the wearer's left sleeve lies where the
    // photo has it.
    let middle = |name: &str| {
        let o = outlines.get(name).unwrap();
        let (lo, hi) = o.bounds();
        o.frame.unwrap().to_px(nalgebra::center(&lo, &hi))
    };
    assert!((middle("left_sleeve_front") - middle("left_sleeve_back")).norm() < 5.0);
    assert!(middle("left_sleeve_front").x > middle("right_sleeve_front").x + 300.0);
}

#[test]
fn pieces_stand_as_they_lie_front_before_and_back_behind() {
    let (pattern, ..) = cut(&of(BlockStyle::TShirt), garment(TEE)).unwrap();
    let at = |name: &str, edge: &str, share: f64| {
        let piece = pattern.piece(name).unwrap();
        let path = piece.path(edge).unwrap();
        piece.pose.unwrap().at(path.at(share * path.length()))
    };
    let (front, back) = (at("front", "side_left", 0.5), at("back", "side_left", 0.5));
    assert!(front.z > 0.15 && back.z < -0.15 && front.x > 0.2);
    assert!((front.x - back.x).abs() < 2e-3 && (front.y - back.y).abs() < 2e-3);
    // Cap and armhole lie on each other.
    let (cap, armhole) = (at("right_sleeve_back", "cap", 0.3), at("back", "armhole_right", 0.7));
    assert!((cap - armhole).norm() < 1e-3, "{cap} {armhole}");
    // The neck hangs at the body's.
    assert!((at("front", "shoulder_left", 1.0).y - 1.41).abs() < 1e-9);
    let outside = pattern.piece("right_sleeve_back").unwrap().pose.unwrap().outside();
    assert!(outside.z < -0.99);
}

/// A tongue of 30 mm stands out of the side, as a label or a fold would.
#[test]
fn a_rag_moves_no_edge() {
    let (clean, ..) = cut(&of(BlockStyle::Vest), garment(VEST)).unwrap();
    assert!((length(&clean, "front", "hem") - 500.0).abs() < 4.0);
    let mut vest = garment(VEST);
    for p in &mut vest {
        if p.x > 0.2 && (0.12..0.17).contains(&p.y) {
            p.x += 0.03;
        }
    }
    let (rag, ..) = cut(&of(BlockStyle::Vest), vest).unwrap();
    for edge in ["hem", "side_left", "side_right", "armhole_left", "shoulder_left"] {
        let (a, b) = (length(&clean, "front", edge), length(&rag, "front", edge));
        assert!((a - b).abs() < 2.0, "{edge}: {a:.1} without, {b:.1} with the rag");
    }
}

#[test]
fn auto_names_what_it_sees() {
    for (half, word) in [(TEE, "TShirt"), (VEST, "Vest"), (SKIRT, "Skirt"), (TROUSERS, "Trousers")] {
        let cx = Context::quiet();
        let front = [("front".to_owned(), outline(garment(half)))].into_iter().collect();
        Block::default().run(front, &body(), None, &cx).unwrap();
        let told = cx.take_remarks();
        assert!(
            told.notes[0].ends_with(&format!("to say what it is: --set 'style.style={word}'")),
            "{told:?}"
        );
        assert!(told.warnings.is_empty(), "{told:?}");
    }
}

/// A T-shirt with a hood behind its neck, so many millimetres high.
fn hooded(height: f64) -> Vec<Point2> {
    let top = garment(TEE).iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    let raised = |p: Point2| {
        let inside = (1.0 - (p.x / 0.075).powi(2)).max(0.0).sqrt();
        Point2::new(p.x, if p.y > top - 0.06 { p.y + 1e-3 * height * inside } else { p.y })
    };
    garment(TEE).into_iter().map(raised).collect()
}

#[test]
fn a_hood_is_refused_and_a_collar_that_stands_is_told() {
    let run = |height: f64| {
        let cx = Context::quiet();
        let front = [("front".to_owned(), outline(hooded(height)))].into_iter().collect();
        let done = of(BlockStyle::TShirt).run(front, &body(), None, &cx).map(|_| ());
        (done, cx.take_remarks().warnings)
    };
    let (done, told) = run(0.0);
    assert!(done.is_ok() && told.is_empty(), "{told:?}");
    let e = run(220.0).0.unwrap_err();
    assert!(
        e.message.contains("above the shoulders of \"front\" is no neckline of a T-shirt: a hood"),
        "{e}"
    );
    assert_eq!(
        e.hint.as_deref(),
        Some(
            "say that it has a hood: --set 'style.style=Hooded' --set 'body.style=Hooded'; or fold what stands there back behind the garment, and take the photo again"
        )
    );
}

#[test]
fn trousers_are_closed_in_their_middle() {
    let (pattern, _, plan) = cut(&of(BlockStyle::Trousers), garment(TROUSERS)).unwrap();
    let names: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["left_leg_front", "right_leg_front", "right_leg_back", "left_leg_back"]);
    assert_eq!(plan.seams.len(), 8);
    // The points of the fork, which lie folded: 15 % of 4 x 228 mm around the seat, less what the
    // fork is wider than the seat, twice 11 mm.
    for (name, point) in names.into_iter().zip([38.0, 38.0, 76.0, 76.0]) {
        let corners = &pattern.piece(name).unwrap().outer.corners;
        let xs = corners.iter().map(|p| 1e3 * p.x);
        let (least, most) = xs.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        assert!((most - least - 240.0 - point).abs() < 6.0, "{name}: {least} to {most}");
        let rise = length(&pattern, name, "rise");
        assert!(rise > 252.0 && rise < 250.0 + point, "{name}: {rise}");
        assert!((length(&pattern, name, "inseam") - between(TROUSERS, 0)).abs() < 20.0);
    }
}

fn refusal(stage: &Block, points: Vec<Point2>) -> String {
    cut(stage, points).unwrap_err().message
}

#[test]
fn a_block_says_why_it_does_not_fit() {
    assert_eq!(
        refusal(&of(BlockStyle::TShirt), garment(VEST)),
        "\"front\" does not look like a T-shirt: its sides run up without an armpit"
    );
    assert_eq!(
        refusal(&of(BlockStyle::Trousers), garment(SKIRT)),
        "\"front\" does not look like a pair of trousers: it has no legs"
    );
    let empty = Block::default().run(Set([].into()), &body(), None, &Context::quiet()).unwrap_err();
    assert_eq!(empty.message, "there is no photo \"front\" to cut the garment from");
    assert_eq!(
        refusal(&Block::default(), vec![Point2::origin(); 30]),
        "the garment in \"front\" has no left and right half"
    );
    let strict = Block { stray: 0.001, ..of(BlockStyle::TShirt) };
    let ragged = garment(TEE).into_iter().enumerate();
    let ragged = ragged.map(|(i, p)| p + Vector2::new(0.0, if i % 8 < 4 { 0.004 } else { -0.004 })).collect();
    let e = refusal(&strict, ragged);
    assert!(e.starts_with("\"front\" was to be a T-shirt, but strays from one by "), "{e}");
}

#[test]
fn a_garment_that_the_body_cannot_wear_is_refused_before_it_is_sewn() {
    let front: Set<Outline> = [("front".to_owned(), outline(garment(TEE)))].into_iter().collect();
    let wearer = |bust: f64| Body { measurements: [("bust".to_owned(), bust)].into(), ..body() };
    let stage = of(BlockStyle::TShirt);
    assert!(stage.run(front.clone(), &wearer(1.1), None, &Context::quiet()).is_ok());
    let e = stage.run(front, &wearer(1.4), None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "the garment is too small: its chest measures 100 cm around, the body's 140 cm");
    assert_eq!(
        e.hint.unwrap(),
        "is the scale right? The garment is measured by it. If it is, take a mannequin that it fits: --set 'body=Fitting(style: TShirt)'"
    );
}

fn bow() -> impl Strategy<Value = Bow> {
    let q = || (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| Point2::new(x, y));
    (q(), q(), -0.4..0.4_f64, -0.4..0.4_f64).prop_map(|(a, b, c, d)| Bow { a, b, bow: [c, d] })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_bow_is_its_bezier_curve_whichever_way_it_is_seen(bow in bow(), t in 0.0..1.0_f64) {
        let at = bow.at(t);
        prop_assert!((Curve::from(bow).at(t) - at).norm() < 1e-12);
        prop_assert!((Curve::from(bow).turned().at(1.0 - t) - at).norm() < 1e-12);
        prop_assert!((flip(Curve::from(bow).moved(flip).at(t)) - at).norm() < 1e-12);
        let slope = (bow.at(t + 1e-6) - bow.at(t - 1e-6)) / 2e-6;
        prop_assert!((slope - bow.direction(t)).norm() < 1e-6);
    }

    #[test]
    fn parts_of_a_curve_follow_it(bow in bow(), t in 0.0..1.0_f64, s in 0.0..1.0_f64) {
        let whole = Curve::from(bow);
        let [a, b] = whole.parted(t);
        prop_assert!((a.at(s) - whole.at(s * t)).norm() < 1e-12);
        prop_assert!((b.at(s) - whole.at(t + s * (1.0 - t))).norm() < 1e-12);
    }

    /// The nearest place is no farther than any other.
    #[test]
    fn the_nearest_place_of_a_bow_is_nearest(bow in bow(), x in -2.0..2.0_f64, y in -2.0..2.0_f64) {
        let p = Point2::new(x, y);
        let sampled = SampledBow::from(bow);
        let found = sampled.nearest(p, f64::INFINITY).unwrap_or_default().1.norm();
        let least = (0..=400).map(|k| (bow.at(f64::from(k) / 400.0) - p).norm()).fold(f64::INFINITY, f64::min);
        prop_assert!(found <= least + 2e-2 * (bow.b - bow.a).norm(), "{found} {least}");
        // What lies within reach is found.
        let again = sampled.nearest(p, found).unwrap_or_default();
        prop_assert_eq!(again.1.norm(), found);
    }
}

fn flip(p: Point2) -> Point2 {
    Point2::new(-p.x, p.y)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// Star-shaped outlines of any kind become a sound pattern, or an error.
    #[test]
    fn no_outline_makes_a_block_panic(radii in prop::collection::vec(0.001..1.0f64, 3..60)) {
        let n = radii.len();
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let points = (0..n).map(|i| Point2::new(radii[i] * angle(i).cos(), radii[i] * angle(i).sin())).collect();
        if let Ok((pattern, outlines, _)) = cut(&Block { stray: 0.5, ..Block::default() }, points) {
            prop_assert!(pattern.pieces.iter().all(|p| outlines.get(&p.name).is_some()));
        }
    }

    /// A shirt keeps its lengths wherever and however askew it lies, and in any size.
    #[test]
    fn lengths_do_not_depend_on_the_lie(degrees in -12.0..12.0f64, scale in 0.4..1.6f64) {
        let points = turned(garment(TEE), degrees).into_iter().map(|p| p * scale).collect();
        let (pattern, ..) = cut(&of(BlockStyle::TShirt), points).unwrap();
        for (edge, want) in [("hem", 520.0), ("side_left", between(TEE, 1))] {
            let is = length(&pattern, "front", edge) / scale;
            prop_assert!((is - want).abs() < 4.0, "{edge}: {is:.1} for {want:.1}");
        }
    }
}

/// The mannequin that a garment is fitted to: its height and bust in cm, and what is told, notes
/// first.
fn fitted_to(points: Vec<Point2>, style: BlockStyle) -> ([f64; 2], Vec<String>) {
    let cx = Context::quiet();
    let front = [("front".to_owned(), outline(points))].into_iter().collect();
    let body = Fitting { style, ..Fitting::default() }.run(front, None, &cx).unwrap();
    let of = |name: &str| (body.measurements[name] * 100.0).round();
    let told = cx.take_remarks();
    ([of("height"), of("bust")], [told.notes, told.warnings].concat())
}

fn scaled(points: Vec<Point2>, by: f64) -> Vec<Point2> {
    points.into_iter().map(|p| Point2::from(p.coords * by)).collect()
}

#[test]
fn a_garment_is_worn_by_whom_it_fits() {
    // 100 cm around the chest, 66 cm long: an adult's.
    let ([height, bust], told) = fitted_to(garment(TEE), BlockStyle::TShirt);
    assert_eq!([height, bust], [168.0, 92.0]);
    assert_eq!(
        told,
        [
            "worn by a mannequin of 168 cm, bust 92, waist 76, hip 100 cm: a garment of 100 cm around the chest, 68 cm long fits it"
        ]
    );
    // The same at two thirds: a child's.
    let ([height, bust], _) = fitted_to(scaled(garment(TEE), 0.66), BlockStyle::TShirt);
    assert!((104.0..=122.0).contains(&height) && bust < 66.0, "{height} {bust}");
    let ([height, _], _) = fitted_to(garment(TROUSERS), BlockStyle::Trousers);
    assert!(height > 150.0, "{height}");
    // As wide as a tent.
    let (_, told) = fitted_to(scaled(garment(TEE), 2.5), BlockStyle::TShirt);
    assert_eq!(
        told[1],
        "no size wears it as such a garment is worn: is the stated width right? It gives the scale"
    );
}

#[test]
fn arms_are_spread_as_the_sleeves_hang() {
    let at = |points: Vec<Point2>| {
        let front = [("front".to_owned(), outline(points))].into_iter().collect();
        let body = Fitting { style: BlockStyle::TShirt, ..Fitting::default() }
            .run(front, None, &Context::quiet())
            .unwrap();
        let arm = body.landmarks["wrist_left"] - body.landmarks["shoulder_left"];
        arm.x.atan2(-arm.y).to_degrees()
    };
    let mut level: Vec<[f64; 2]> = TEE.to_vec();
    (level[3], level[4]) = ([400.0, 420.0], [420.0, 580.0]);
    assert!(at(garment(&level)) > at(garment(TEE)) + 10.0, "{} {}", at(garment(&level)), at(garment(TEE)));
    // The sleeves lie 58 degrees from the vertical; around a trunk with depth they hang 17 degrees
    // lower.
    assert!((at(garment(TEE)) - 41.0).abs() < 6.0, "{}", at(garment(TEE)));
}

#[test]
fn trousers_are_worn_by_hips_that_they_are_cut_for() {
    // A waist of 80 cm, which may sit low, and hips of 98 cm.
    let told = |seat: f64| {
        let mut points = TROUSERS.to_vec();
        points[3] = [seat, 780.0];
        fitted_to(garment(&points), BlockStyle::Trousers).1.remove(0)
    };
    assert!(told(245.0).contains("waist 72, hip 96 cm"), "{}", told(245.0));
    // Of hips that are much wider a larger size is likelier, too.
    assert!(told(290.0).contains("waist 80, hip 109 cm"), "{}", told(290.0));
}

const SLEEVED: &[[f64; 2]] = &[
    [0.0, 0.0],
    [330.0, 20.0],
    [190.0, 560.0],
    [225.0, 760.0],
    [330.0, 700.0],
    [410.0, 830.0],
    [215.0, 960.0],
    [85.0, 990.0],
    [0.0, 960.0],
];

#[test]
fn a_dress_with_sleeves_is_cut_to_a_trunk_and_sleeves() {
    let (p, _, plan) = cut(&of(BlockStyle::Auto), garment(SLEEVED)).unwrap();
    let names: Vec<&str> = p.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names.len(), 6, "{names:?}");
    let trunk = p.piece("front").unwrap();
    for edge in ["skirt_left", "side_right", "armhole_left", "shoulder_right", "neck", "hem"] {
        assert!(trunk.path(edge).is_some(), "{edge}");
    }
    assert!(plan.seams.len() >= 14, "{}", plan.seams.len());
    let named = fitted_to(garment(SLEEVED), BlockStyle::Auto).1;
    assert!(named[0].contains("around the waist"), "{named:?}");
}

#[test]
fn every_size_of_the_table_can_be_made() {
    for [height, bust, waist, hip] in fitting::SIZES {
        let girths = [bust, waist, hip].map(|g| g / 100.0);
        let body = fitting::mannequin(height / 100.0, girths, 45.0, 0.022, &Context::quiet());
        let body = body.map_err(|e| format!("{height} {bust}: {}", e.message)).unwrap();
        assert!((body.measurements["bust"] - girths[0]).abs() < 0.005 * girths[0], "{height} {bust}");
    }
}

#[test]
fn spread_legs_are_stood_under_the_hips_and_keep_their_lengths() {
    // Each leg leans out by a tenth of the way down from the hip, 720 mm above the hem.
    let spread: Vec<[f64; 2]> = TROUSERS
        .iter()
        .map(|p| [p[0] + if p[1] < 700.0 { 0.1 * (720.0 - p[1]) } else { 0.0 }, p[1]])
        .collect();
    let (pattern, outlines, _) = cut(&of(BlockStyle::Trousers), garment(&spread)).unwrap();
    let leg = pattern.piece("left_leg_front").unwrap();
    let outseam = leg.path("outseam").unwrap();
    let (foot, hip) = (outseam.at(0.0), outseam.at(outseam.length()));
    assert!((foot.x - hip.x).abs() < 0.015, "{foot} {hip}");
    assert!((1e3 * outseam.length() - 720.0).abs() < 12.0, "{}", outseam.length());
    // Its colours are those of the leg as it lies.
    let o = outlines.get("left_leg_front").unwrap();
    let hem = o.edge_points(o.edge("hem").unwrap());
    let middle = o.to_px(hem[hem.len() / 2]).unwrap();
    assert!((middle - Point2::new(500.0 + 160.0 + 72.0, 900.0)).norm() < 8.0, "{middle}");
}

/// A child's one-piece with short legs.
const ONEPIECE: &[[f64; 2]] = &[
    [0.0, 95.0],
    [30.0, 0.0],
    [170.0, 5.0],
    [155.0, 370.0],
    [205.0, 330.0],
    [250.0, 440.0],
    [150.0, 505.0],
    [60.0, 530.0],
    [0.0, 500.0],
];

#[test]
fn a_one_piece_is_front_and_back_with_sleeves_and_two_legs() {
    let (pattern, _, plan) = cut(&Block::default(), garment(ONEPIECE)).unwrap();
    let names: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names[..3], ["front", "left_sleeve_front", "right_sleeve_front"]);
    for (edge, corner) in [("inseam_left", 0), ("hem_right", 1), ("side_left", 2)] {
        let is = length(&pattern, "front", edge);
        assert!((is - between(ONEPIECE, corner)).abs() < 8.0, "{edge}: {is:.1}");
    }
    // Inseams, sides and shoulders; four caps; underarms and tops of the sleeves.
    assert_eq!(plan.seams.len(), 14);
}

#[test]
fn a_sleeve_that_hangs_folded_at_the_armpit_is_opened_there() {
    // Sleeves hang beside the body; at the armpit 70 mm of them show, 100 mm below.
    const HUNG: &[[f64; 2]] = &[
        [0.0, 0.0],
        [260.0, 0.0],
        [235.0, 400.0],
        [280.0, 120.0],
        [370.0, 140.0],
        [300.0, 520.0],
        [230.0, 630.0],
        [80.0, 670.0],
        [0.0, 640.0],
    ];
    let (pattern, _, plan) = cut(&of(BlockStyle::LongSleeve), garment(HUNG)).unwrap();
    let cap = length(&pattern, "left_sleeve_front", "cap");
    let armhole = length(&pattern, "front", "armhole_left");
    assert!(cap >= armhole - 0.1, "{cap} {armhole}");
    let kinds = plan.seams.iter().filter(|s| s.kind == SeamKind::Gathered).count();
    assert_eq!(kinds > 0, cap > 1.02 * armhole, "{cap} {armhole}");
}
