//! Gathers, pleats, hoods, and fronts in two halves.

use super::*;
use crate::style::block::front::Front;
use crate::style::block::pleat::Fold;

fn gathered(fullness: f64, band: &str) -> Block {
    Block { waist: Waist::Gathered { fullness, band: band.parse().unwrap() }, ..of(BlockStyle::Skirt) }
}

#[test]
fn a_gathered_skirt_is_wider_than_its_band_and_looks_like_its_photo() {
    let (pattern, outlines, plan) = cut(&gathered(1.6, "3 cm"), garment(SKIRT)).unwrap();
    let names: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front", "band_front", "back", "band_back"]);
    let near = |piece: &str, edge: &str, want: f64| {
        let is = length(&pattern, piece, edge);
        assert!((is - want).abs() < 6.0, "{piece} {edge}: {is:.1} for {want:.1}");
    };
    near("band_front", "joint", 360.0);
    near("band_front", "end_left", 30.0);
    near("front", "waist", 1.6 * 360.0);
    near("front", "hem", 640.0);
    let gathers = plan.seams.iter().filter(|s| s.kind == SeamKind::Gathered).count();
    assert_eq!(gathers, 2);
    // The middle of its side shows what the photo shows at the middle of its side.
    let o = outlines.get("front").unwrap();
    let side = o.edge_points(o.edge("side_left").unwrap());
    let px = o.to_px(side[side.len() / 2]).unwrap();
    assert!((px.x - 500.0 - 253.0).abs() < 8.0, "{px}");
}

#[test]
fn what_cannot_be_gathered_is_refused() {
    let refused = |stage: &Block, points| cut(stage, points).unwrap_err().message;
    let tee = Block { style: BlockStyle::TShirt, ..gathered(1.6, "3 cm") };
    assert_eq!(refused(&tee, garment(TEE)), "only a skirt is gathered at the waist, and this is a T-shirt");
    assert_eq!(refused(&gathered(0.5, "3 cm"), garment(SKIRT)), "a fullness of 0.5 is not between 1 and 4");
    assert_eq!(
        refused(&gathered(2.0, "50 cm"), garment(SKIRT)),
        "a band of 50 cm is not between 5 mm and 20 cm"
    );
}

fn pleated(count: u32, cloth: &str, fold: Fold, stitched: &str) -> Block {
    let waist =
        Waist::Pleated { count, cloth: cloth.parse().unwrap(), fold, stitched: stitched.parse().unwrap() };
    Block { waist, ..of(BlockStyle::Skirt) }
}

#[test]
fn pleats_are_let_in_from_waist_to_hem_and_sewn_down() {
    let (pattern, outlines, plan) = cut(&pleated(4, "8 cm", Fold::Box, "14 cm"), garment(SKIRT)).unwrap();
    let near = |edge: &str, want: f64| {
        let is = length(&pattern, "front", edge);
        assert!((is - want).abs() < 6.0, "{edge}: {is:.1} for {want:.1}");
    };
    near("waist", 360.0 + 4.0 * 80.0);
    near("hem", 640.0 + 4.0 * 80.0);
    near("pleat_1_a", 140.0 - 5.0);
    near("pleat_1_b", 140.0 - 5.0);
    let pleats = plan.seams.iter().filter(|s| s.kind == SeamKind::Pleat(PleatFold::Box)).count();
    assert_eq!(pleats, 8);
    // Both lines of a pleat are the pleat's cloth apart, above and below, and end inside of the
    // piece.
    let front = pattern.piece("front").unwrap();
    for k in 1..=4 {
        let ends = |word: &str| {
            let path = front.path(&format!("pleat_{k}_{word}")).unwrap();
            [path.at(0.0), path.at(path.length())]
        };
        let ([a, c], [b, d]) = (ends("a"), ends("b"));
        assert!((b.x - a.x - 0.08).abs() < 1e-9 && (d.x - c.x - 0.08).abs() < 1e-9, "{k}");
    }
    // The photo is drawn apart over it: its corners stay where they lie.
    let o = outlines.get("front").unwrap();
    let waist = o.edge_points(o.edge("waist").unwrap());
    assert!((o.to_px(waist[0]).unwrap().x - 500.0 - 180.0).abs() < 6.0);
}

#[test]
fn pleats_that_cannot_be_laid_are_refused() {
    let refused = |stage: &Block, points| cut(stage, points).unwrap_err();
    let knife =
        |count, cloth, stitched| refused(&pleated(count, cloth, Fold::Knife, stitched), garment(SKIRT));
    let tee = Block { style: BlockStyle::TShirt, ..pleated(4, "8 cm", Fold::Box, "14 cm") };
    let e = refused(&tee, garment(TEE));
    assert_eq!(e.message, "only a skirt is pleated at the waist, and this is a T-shirt");
    assert_eq!(knife(0, "8 cm", "14 cm").message, "0 pleats are not between 1 and 24");
    let wide = knife(4, "40 cm", "14 cm").message;
    assert!(
        wide.starts_with("a pleat of 40 cm is not between 1 cm and 1")
            && wide.ends_with("twice the space between two of 4 pleats"),
        "{wide}"
    );
    let long = knife(4, "8 cm", "90 cm");
    assert!(long.message.starts_with("pleats cannot be sewn down for 90 cm; 1 cm to 4"), "{}", long.message);
    assert_eq!(long.hint.unwrap(), "12 cm is usual");
}

#[test]
fn a_front_in_halves_is_closed_along_the_middle() {
    let whole = cut(&of(BlockStyle::TShirt), garment(TEE)).unwrap();
    let halves = cut(&Block { front: Front::Halves, ..of(BlockStyle::TShirt) }, garment(TEE)).unwrap();
    let names: Vec<&str> = halves.0.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names[..3], ["left_front", "right_front", "left_sleeve_front"]);
    let both = |edge: &str| {
        length(&halves.0, "left_front", &format!("{edge}_left"))
            + length(&halves.0, "right_front", &format!("{edge}_right"))
    };
    for edge in ["neck", "hem"] {
        assert!((both(edge) - length(&whole.0, "front", edge)).abs() < 0.5, "{edge}");
    }
    assert!((both("middle") - 2.0 * 660.0).abs() < 12.0, "{}", both("middle"));
    // One seam more than with a whole front.
    assert_eq!(halves.2.seams.len(), whole.2.seams.len() + 1);
}

#[test]
fn what_has_no_front_is_not_cut_in_halves() {
    let skirt = Block { front: Front::Halves, ..of(BlockStyle::Skirt) };
    let e = cut(&skirt, garment(SKIRT)).unwrap_err();
    assert_eq!(e.message, "only a top or a dress is cut in halves in front, and this is a skirt");
    assert_eq!(e.hint.unwrap(), "take `front` out");
}

const HOODY: &[[f64; 2]] = &[
    [0.0, 0.0],
    [265.0, 0.0],
    [250.0, 420.0],
    [455.0, 20.0],
    [545.0, 65.0],
    [235.0, 640.0],
    [105.0, 680.0],
    [135.0, 800.0],
    [125.0, 900.0],
    [85.0, 960.0],
    [0.0, 985.0],
];

#[test]
fn a_hood_is_two_halves_sewn_along_the_crown_and_to_the_neck() {
    let (pattern, outlines, _) = cut(&of(BlockStyle::Hooded), garment(HOODY)).unwrap();
    let names: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names.len(), 8);
    for hood in ["left_hood_front", "right_hood_front"] {
        let high = length(&pattern, hood, "face");
        // 24 cm from the throat to the top of the head, and 22 % of ease: it lies higher.
        assert!((high - 240.0 * 1.22).abs() < 3.0, "{high}");
        let side = hood.split('_').next().unwrap();
        let neck = |layer: &str| length(&pattern, layer, &format!("neck_{side}"));
        let around = neck("front") + neck("back");
        assert!((length(&pattern, hood, "joint") - around).abs() < 1.0, "{around}");
        assert!(length(&pattern, hood, "crown") > 1.4 * high);
    }
    let named = |name: &str| pattern.seams.iter().filter(|s| s.name == name).count();
    assert_eq!(
        [named("crown"), named("neck of left_hood_front"), named("neck of right_hood_front")],
        [1, 1, 1]
    );
    // Its opening lies in the middle of the photo, and stands before the throat.
    let o = outlines.get("left_hood_front").unwrap();
    // Its neck edge, in two parts since it is sewn to front and back, shows the neckline, and the
    // middle of its crown that of the border.
    assert!(o.edge("joint").is_none());
    let seen = |k: usize| o.frame.unwrap().to_px(o.lies[k]);
    let [front, crown, opening] = ["joint_1", "crown", "face"].map(|name| seen(o.edge(name).unwrap().start));
    assert!((front.x - 500.0).abs() < 5.0 && (crown.x - opening.x).abs() > 50.0, "{front} {crown}");
    assert!((opening.x - 500.0).abs() < 5.0 && front.y - opening.y > 240.0, "{front} {opening}");
    let left = pattern.piece("left_hood_front").unwrap();
    let face = left.path("face").unwrap();
    let middle = left.pose.unwrap().at(face.at(0.5 * face.length()));
    assert!(middle.z > 0.08 && middle.x > 0.0 && middle.y > 1.4, "{middle}");
    assert!(left.pose.unwrap().outside().x > 0.99);
    assert!(pattern.piece("right_hood_front").unwrap().pose.unwrap().outside().x < -0.99);
}

#[test]
fn a_hood_is_as_high_as_the_head_needs_it() {
    let mut low = HOODY.to_vec();
    for p in low.iter_mut().filter(|p| p[1] > 700.0) {
        p[1] = 700.0 + 0.45 * (p[1] - 700.0);
    }
    let (pattern, ..) = cut(&of(BlockStyle::Hooded), garment(&low)).unwrap();
    // 24 cm from the throat to the top of the head, and 10 % of ease.
    let high = length(&pattern, "left_hood_front", "face");
    assert!((high - 240.0 * 1.1).abs() < 3.0, "{high}");
}

#[test]
fn a_throat_above_the_head_leaves_no_height() {
    let mut body = body();
    assert!((crate::style::block::hood::head(&body) - 0.24).abs() < 1e-12);
    body.landmarks.insert("neck_base_front".to_owned(), Point3::new(0.0, 2.0, 0.08));
    assert_eq!(crate::style::block::hood::head(&body), 0.0);
}

#[test]
fn a_hood_needs_a_throat() {
    let front = [("front".to_owned(), outline(garment(HOODY)))].into_iter().collect();
    let mut body = body();
    body.landmarks.remove("neck_base_front");
    let e = of(BlockStyle::Hooded).run(front, &body, None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "the body has no landmark \"neck_base_front\", at which a hood begins");
    assert_eq!(e.hint.as_deref(), Some("take a Mannequin"));
}
