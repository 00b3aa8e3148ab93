//! Landmarks that a person sets in the photo.

use super::*;
use crate::mesh::predicates::distance_to_segment;
use toile_core::testkit::shapes;

/// The photo of the sample's T-shirt: 1800 by 1600 pixels, 2.1 a millimetre.
const SIZE: [f64; 2] = [1800.0, 1600.0];
/// Where the armpit on the right of the picture lies in it, which is the wearer's left.
const ARMPIT: [f64; 2] = [1428.3, 715.1];

/// The sample's outline where it lies in its photo.
fn shirt() -> Outline {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../pipelines/samples/tshirt/front.outline.json");
    let truth: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let metres = |v: &serde_json::Value| v.as_f64().unwrap() / 1e3;
    let points = truth["outline"].as_array().unwrap();
    let origin = &truth["frame"]["origin_px"];
    Outline {
        frame: Some(PhotoFrame {
            origin_px: Point2::new(origin[0].as_f64().unwrap(), origin[1].as_f64().unwrap()),
            px_per_metre: 2100.0,
            mirrored: false,
            turn: 0.0,
        }),
        ..outline(points.iter().map(|p| Point2::new(metres(&p[0]), metres(&p[1]))).collect())
    }
}

type CutShirt = (Pattern, Set<Outline>, SewingPlan);

/// The shirt cut with landmarks at those pixels.
fn said(block: Block, marks: &[(&str, [f64; 2])]) -> Result<CutShirt, StageError> {
    let share = |[x, y]: [f64; 2]| ((x + 0.5) / SIZE[0], (y + 0.5) / SIZE[1]);
    let landmarks = marks.iter().map(|(name, px)| ((*name).to_owned(), share(*px))).collect();
    let block = Block { style: BlockStyle::TShirt, network: false, landmarks, ..block };
    let photo = shapes::photo_from(image::RgbImage::new(SIZE[0] as u32, SIZE[1] as u32));
    let outlines: Set<Outline> = [("front".to_owned(), shirt())].into_iter().collect();
    let photos: Set<Photo> = [("front".to_owned(), photo)].into_iter().collect();
    block.run(outlines, &body(), Some(photos), &Context::quiet())
}

/// Where a landmark of the front lies, pixels.
fn at(cut: &CutShirt, name: &str) -> Point2 {
    let all = landmarks(cut.1.iter());
    all.into_iter().find(|l| l.photo == "front" && l.name == name).unwrap().place
}

/// The nearest place of the outline, pixels.
fn on_outline([x, y]: [f64; 2]) -> Point2 {
    let o = shirt();
    let points: Vec<Point2> = o.outer.points.iter().map(|p| o.to_px(*p).unwrap()).collect();
    let p = Point2::new(x, y);
    let n = points.len();
    let places = (0..n).map(|i| {
        let (a, b) = (points[i], points[(i + 1) % n]);
        let (off, t) = distance_to_segment(p, a, b);
        (off, a + (b - a) * t)
    });
    places.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1
}

#[test]
fn an_armpit_that_is_said_to_lie_lower_comes_out_lower() {
    let plain = said(Block::default(), &[]).unwrap();
    let was = at(&plain, "armpit_left");
    assert!((was - Point2::new(ARMPIT[0], ARMPIT[1])).norm() < 12.0, "{was}");
    // 3 % of the photo lower, a few pixels beside the outline.
    let place = [ARMPIT[0] + 6.0, ARMPIT[1] + 48.0];
    let lower = said(Block::default(), &[("armpit_left", place)]).unwrap();
    let is = at(&lower, "armpit_left");
    assert!((is - on_outline(place)).norm() < 2.0, "{is} for {}", on_outline(place));
    // Both sides are cut alike, and the other corners stay.
    let side = |cut: &CutShirt, edge: &str| length(&cut.0, "front", edge);
    let by = (is.y - was.y) / 2.1;
    for edge in ["side_left", "side_right"] {
        assert!((side(&plain, edge) - side(&lower, edge) - by).abs() < 5.0, "{edge}");
    }
    assert!((side(&plain, "hem") - side(&lower, "hem")).abs() < 4.0);
    let neck = |cut: &CutShirt| at(cut, "neck_left");
    assert!((neck(&plain) - neck(&lower)).norm() < 12.0);
}

#[test]
fn sides_that_are_cut_as_they_lie_keep_their_own_corners() {
    let lie = || Block { sides: Sides::AsTheyLie, ..Block::default() };
    let plain = said(lie(), &[]).unwrap();
    let lower = said(lie(), &[("armpit_left", [ARMPIT[0], ARMPIT[1] + 48.0])]).unwrap();
    let side = |cut: &CutShirt, edge: &str| length(&cut.0, "front", edge);
    let [left, right] = ["side_left", "side_right"].map(|e| side(&plain, e) - side(&lower, e));
    assert!(left > 15.0 && right.abs() < 8.0, "{left} {right}");
}

#[test]
fn every_corner_can_be_said() {
    let plain = said(Block::default(), &[]).unwrap();
    for name in ["neck_left", "cuff_left_inner", "cuff_right_outer", "hem_right"] {
        let p = at(&plain, name);
        let place = [p.x + 10.0, p.y + 14.0];
        let moved = said(Block { sides: Sides::AsTheyLie, ..Block::default() }, &[(name, place)]).unwrap();
        let off = (at(&moved, name) - on_outline(place)).norm();
        assert!(off < 4.0, "{name}: {off}");
    }
}

#[test]
fn a_landmark_far_off_the_outline_is_refused_with_the_nearest_place() {
    let refused = |name: &str, place| {
        let e = said(Block::default(), &[(name, place)]).unwrap_err();
        assert_eq!((e.param, &e.path[..]), (Some("landmarks"), &[name.to_owned()][..]));
        (e.message, e.hint.unwrap())
    };
    let (message, hint) = refused("armpit_left", [1760.0, 60.0]);
    assert_eq!(message, "\"armpit_left\" is said to lie 160 mm outside of the garment");
    assert_eq!(
        hint,
        "the nearest place of its outline is (0.872, 0.210): shares of the photo's width and height, from its top left corner"
    );
    let (message, _) = refused("armpit_left", [900.0, 800.0]);
    assert_eq!(
        message,
        "\"armpit_left\" is said to lie 232 mm within the garment, and landmarks lie on its outline"
    );
    let (message, hint) = refused("armpit_right", ARMPIT);
    assert_eq!(message, "\"armpit_right\" is said to lie on the other side of the garment");
    assert_eq!(hint, "left and right are the wearer's: call it \"armpit_left\"");
}

#[test]
fn landmarks_need_their_photo() {
    let e = said(Block::default(), &[("back.armpit_left", ARMPIT)]).unwrap_err();
    assert_eq!(e.message, "\"back.armpit_left\" is said of the back, which has no photo of its own");
    assert_eq!(e.hint.as_deref(), Some("it is cut as the front is: say \"armpit_left\""));
    let landmarks: BTreeMap<String, (f64, f64)> = [("armpit_left".to_owned(), (0.8, 0.45))].into();
    let block = Block { landmarks, ..of(BlockStyle::TShirt) };
    let front = [("front".to_owned(), shirt())].into_iter().collect();
    let e = block.run(front, &body(), None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "there is no photo of the front in which \"armpit_left\" lies");
}

#[test]
fn a_fork_that_is_said_to_lie_lower_leaves_shorter_legs() {
    let photo = shapes::photo_from(image::RgbImage::new(1000, 1000));
    let cut = |landmarks: &[(&str, (f64, f64))]| {
        let landmarks = landmarks.iter().map(|(name, at)| ((*name).to_owned(), *at)).collect();
        let block = Block { landmarks, network: false, ..of(BlockStyle::Trousers) };
        let frame = PhotoFrame {
            origin_px: Point2::new(500.0, 980.0),
            px_per_metre: 1000.0,
            mirrored: false,
            turn: 0.0,
        };
        let trousers = Outline { frame: Some(frame), ..outline(garment(TROUSERS)) };
        let front: Set<Outline> = [("front".to_owned(), trousers)].into_iter().collect();
        let photos: Set<Photo> = [("front".to_owned(), photo.clone())].into_iter().collect();
        block.run(front, &body(), Some(photos), &Context::quiet()).unwrap()
    };
    let plain = cut(&[]);
    // The fork lies at 700 mm of 950, 280 px from the top; the legs' inner sides lie near the axis.
    let low = cut(&[("fork", (0.5, 0.31))]);
    let inseam = |cut: &CutShirt| length(&cut.0, "left_leg_front", "inseam");
    assert!(inseam(&plain) - inseam(&low) > 15.0, "{} {}", inseam(&plain), inseam(&low));
}

#[test]
fn the_wearer_is_measured_between_the_landmarks_that_are_said() {
    let photo = shapes::photo_from(image::RgbImage::new(SIZE[0] as u32, SIZE[1] as u32));
    let plain = said(Block::default(), &[]).unwrap();
    // 60 px are 29 mm: the neck lies so much lower.
    let lower = ["neck_left", "neck_right"].map(|name| {
        let p = at(&plain, name);
        (name.to_owned(), ((p.x + 0.5) / SIZE[0], (p.y + 60.5) / SIZE[1]))
    });
    let told = |landmarks: BTreeMap<String, (f64, f64)>| {
        let cx = Context::quiet();
        let front: Set<Outline> = [("front".to_owned(), shirt())].into_iter().collect();
        let photos: Set<Photo> = [("front".to_owned(), photo.clone())].into_iter().collect();
        let style = BlockStyle::TShirt;
        let fitting = Fitting { style, network: false, landmarks, ..Fitting::default() };
        fitting.run(front, Some(photos), &cx).unwrap();
        cx.take_remarks().notes.concat()
    };
    let long =
        |told: &str| told.split(", ").find_map(|part| part.strip_suffix(" cm long fits it")?.parse().ok());
    let [found, said]: [Option<f64>; 2] = [told(BTreeMap::new()), told(lower.into())].map(|t| long(&t));
    assert_eq!([found, said], [Some(68.0), Some(65.0)]);
}
