//! One half of a garment that the frame cuts, that lies folded, or that hides its sleeve.

use super::*;

/// A photo of 1,000 pixels a metre whose garment is stated to be so wide.
fn photo(size: (u32, u32), width: Option<f64>) -> Set<Photo> {
    let pixels = Shared::new(image::RgbImage::new(size.0, size.1));
    let photo = Photo { pixels, garment_width: width, ..toile_core::testkit::shapes::photo() };
    [("front".to_owned(), photo)].into_iter().collect()
}

/// The points of a shirt of which the frame shows nothing to the right of 300 mm from its middle.
fn cut_shirt() -> Vec<Point2> {
    garment(TEE).into_iter().map(|p| Point2::new(p.x.min(0.3), p.y)).collect()
}

#[test]
fn a_sleeve_that_the_frame_cuts_is_the_other_ones_mirror_image() {
    let front: Set<Outline> = [("front".to_owned(), outline(cut_shirt()))].into_iter().collect();
    let stage = Block { complete: Complete::Mirror, ..of(BlockStyle::TShirt) };
    // The outline's origin lies at 500 px, so that the frame ends at 800.
    let photos = photo((800, 1000), None);
    let (pattern, ..) = stage.run(front, &body(), Some(photos), &Context::quiet()).unwrap();
    for side in ["left", "right"] {
        let cuff = length(&pattern, &format!("{side}_sleeve_front"), "cuff");
        assert!((cuff - between(TEE, 3)).abs() < 8.0, "{side}: {cuff:.1}");
    }
}

#[test]
fn a_stated_width_is_that_of_the_whole_garment() {
    let front: Set<Outline> = [("front".to_owned(), outline(cut_shirt()))].into_iter().collect();
    let stage = Block { complete: Complete::Mirror, ..of(BlockStyle::TShirt) };
    // What is shown is 740 mm wide by the scale of its outline, and stated to be the whole: the
    // shirt is smaller by 740 / 880.
    let photos = photo((800, 1000), Some(0.74));
    let (pattern, ..) = stage.run(front, &body(), Some(photos), &Context::quiet()).unwrap();
    let hem = length(&pattern, "front", "hem");
    assert!((hem - 520.0 * 740.0 / 880.0).abs() < 8.0, "{hem:.1}");
}

#[test]
fn an_outline_without_a_photo_is_cut_as_it_lies() {
    let cuffs = |complete| {
        let (pattern, ..) = cut(&Block { complete, ..of(BlockStyle::TShirt) }, garment(TEE)).unwrap();
        length(&pattern, "left_sleeve_front", "cuff")
    };
    assert_eq!(cuffs(Complete::Mirror).to_bits(), cuffs(Complete::Nothing).to_bits());
}

#[test]
fn both_sleeves_cut_are_refused() {
    let points = cut_shirt().into_iter().map(|p| Point2::new(p.x.max(-0.3), p.y)).collect();
    let mut outline = outline(points);
    outline.frame = outline.frame.map(|f| PhotoFrame { origin_px: Point2::new(300.0, 900.0), ..f });
    let front: Set<Outline> = [("front".to_owned(), outline)].into_iter().collect();
    let stage = Block { complete: Complete::Mirror, ..of(BlockStyle::TShirt) };
    let e = stage.run(front, &body(), Some(photo((600, 1000), None)), &Context::quiet()).unwrap_err();
    assert_eq!(e.to_string(), "the frame cuts both halves of \"front\" at the same place");
}

/// A shirt whose left cuff is folded to half its width.
fn folded() -> Vec<Point2> {
    let fold = |p: Point2| match p.x < -0.37 {
        true => Point2::new(p.x, 0.43 + 0.5 * (p.y - 0.43)),
        false => p,
    };
    garment(TEE).into_iter().map(fold).collect()
}

#[test]
fn a_folded_cuff_is_cut_as_the_other_one() {
    let cuffs = |sides| {
        let (pattern, ..) = cut(&Block { sides, ..of(BlockStyle::TShirt) }, folded()).unwrap();
        ["left", "right"].map(|side| length(&pattern, &format!("{side}_sleeve_front"), "cuff"))
    };
    let [left, right] = cuffs(Sides::AsTheyLie);
    assert!((left - right).abs() > 20.0, "{left:.1} {right:.1}");
    let alike = cuffs(Sides::Alike);
    assert!(alike.iter().all(|c| (c - between(TEE, 3)).abs() < 8.0), "{alike:?}");
    assert!((alike[0] - alike[1]).abs() < 1e-6);
}

/// A batwing top: its sides sweep out to the cuffs without an armpit.
const BATWING: &[[f64; 2]] = &[
    [0.0, 0.0],
    [230.0, 0.0],
    [235.0, 150.0],
    [290.0, 270.0],
    [400.0, 340.0],
    [440.0, 500.0],
    [110.0, 620.0],
    [0.0, 590.0],
];

#[test]
fn sleeves_without_an_armpit_are_cut_in_one_with_the_top() {
    let (pattern, ..) = cut(&Block::default(), garment(BATWING)).unwrap();
    let names: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front", "back"]);
    let cuff = length(&pattern, "front", "cuff_left");
    assert!((cuff - between(BATWING, 4)).abs() < 12.0, "{cuff:.1}");
}

/// A shirt whose left sleeve lies under it: the outline runs up there without one.
fn one_sleeve() -> Vec<Point2> {
    let tucked = |p: Point2| Point2::new(p.x.max(-0.25), p.y);
    garment(TEE).into_iter().map(tucked).collect()
}

#[test]
fn a_half_that_hides_its_sleeve_is_cut_as_the_other_ones_mirror_image() {
    let front: Set<Outline> = [("front".to_owned(), outline(one_sleeve()))].into_iter().collect();
    let cx = Context::quiet();
    let (pattern, outlines, _) = of(BlockStyle::TShirt).run(front, &body(), None, &cx).unwrap();
    for side in ["left", "right"] {
        let cuff = length(&pattern, &format!("{side}_sleeve_front"), "cuff");
        assert!((cuff - between(TEE, 3)).abs() < 8.0, "{side}: {cuff:.1}");
    }
    let told = cx.take_remarks().warnings;
    let want = "only the right half of \"front\" in the photo looks like a T-shirt: the left one is cut as its mirror image";
    assert!(told.contains(&want.to_owned()), "{told:?}");
    // The hidden sleeve gets the colours of the one that is seen: its cuff lies at that one's.
    let cuff = |name: &str| {
        let o = outlines.get(name).unwrap();
        let points = o.edge_points(o.edge("cuff").unwrap());
        o.to_px(points[points.len() / 2]).unwrap()
    };
    let (seen, hidden) = (cuff("left_sleeve_front"), cuff("right_sleeve_front"));
    assert!((seen - hidden).norm() < 8.0, "{seen} {hidden}");
}

#[test]
fn sides_that_are_kept_apart_are_not_mirrored() {
    let stage = Block { sides: Sides::AsTheyLie, ..of(BlockStyle::TShirt) };
    let e = cut(&stage, one_sleeve()).unwrap_err();
    assert_eq!(e.message, "\"front\" does not look like a T-shirt: its sides run up without an armpit");
}

#[test]
fn a_back_that_is_the_fronts_mirror_image_is_cut_from_the_same_fit() {
    let stage = Block { sides: Sides::AsTheyLie, ..of(BlockStyle::TShirt) };
    let given = |back: bool| {
        let front = outline(folded());
        let behind = back.then(|| ("back".to_owned(), mirrored(&front)));
        let sides: Set<Outline> = [("front".to_owned(), front)].into_iter().chain(behind).collect();
        stage.run(sides, &body(), None, &Context::quiet()).unwrap()
    };
    let (pattern, outlines, _) = given(true);
    assert_eq!(pattern, given(false).0);
    for (front, back) in
        [("left_sleeve_front", "left_sleeve_back"), ("right_sleeve_front", "right_sleeve_back")]
    {
        let [a, b] = [front, back].map(|piece| length(&pattern, piece, "cuff"));
        assert!((a - b).abs() < 1e-6, "{front}: {a:.2} {b:.2}");
    }
    assert!(outlines.get("back").unwrap().frame.unwrap().mirrored);
}

/// Shorts whose waist is drawn in to less than half of their hip.
const DRAWN_IN: &[[f64; 2]] =
    &[[0.0, 200.0], [50.0, 0.0], [290.0, 0.0], [280.0, 300.0], [130.0, 450.0], [0.0, 450.0]];

#[test]
fn a_waist_that_an_elastic_draws_in_is_cut_as_wide_as_its_wearer_needs_it() {
    let waist = |girth: f64| {
        let body = Body { measurements: [("waist".to_owned(), girth)].into(), ..body() };
        let front = [("front".to_owned(), outline(garment(DRAWN_IN)))].into_iter().collect();
        let (pattern, ..) = of(BlockStyle::Trousers).run(front, &body, None, &Context::quiet()).unwrap();
        let legs = ["left_leg_front", "right_leg_front", "right_leg_back", "left_leg_back"];
        legs.map(|piece| length(&pattern, piece, "waist")).iter().sum::<f64>()
    };
    // It lies 520 mm around, and one of 540 mm wears it so; for one of 700 mm it is cut 6 %
    // narrower than that, so that it holds; for one of 450 mm it is drawn in, as by a belt.
    assert!((waist(0.54) - 520.0).abs() < 20.0, "{:.1}", waist(0.54));
    assert!((waist(0.7) - 658.0).abs() < 20.0, "{:.1}", waist(0.7));
    assert!((waist(0.45) - 436.5).abs() < 20.0, "{:.1}", waist(0.45));
}

#[test]
fn a_skirt_that_flares_from_its_waist_is_not_drawn_in() {
    let flared = [[0.0, 0.0], [420.0, 0.0], [130.0, 450.0], [0.0, 450.0]];
    let waist = |girth: f64| {
        let body = Body { measurements: [("waist".to_owned(), girth)].into(), ..body() };
        let front = [("front".to_owned(), outline(garment(&flared)))].into_iter().collect();
        of(BlockStyle::Skirt).run(front, &body, None, &Context::quiet()).map(|_| ())
    };
    let e = waist(0.7).unwrap_err().to_string();
    assert!(e.contains("the garment is too small: its waist measures 52 cm around"), "{e}");
}
