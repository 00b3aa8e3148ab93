#![allow(clippy::unwrap_used)]

use super::evidence::overlap;
use super::symmetry::symmetry;
use super::*;
use image::{Rgb, RgbImage};
use proptest::prelude::*;

const W: u32 = 240;
const H: u32 = 320;

/// A tee in shares of the frame: a trunk with two sleeves.
fn tee(x: f64, y: f64) -> bool {
    let trunk = (0.3..0.7).contains(&x) && (0.2..0.8).contains(&y);
    trunk || (0.15..0.85).contains(&x) && (0.2..0.38).contains(&y)
}

/// A picture of tones by places in shares of the frame, with a grain of a few levels.
fn photo(tone: impl Fn(f64, f64) -> [u8; 3]) -> Photo {
    let pixels = RgbImage::from_fn(W, H, |x, y| {
        let grain =
            (x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77)).wrapping_mul(0x2C1B_3C6D) >> 24;
        let tone = tone((f64::from(x) + 0.5) / f64::from(W), (f64::from(y) + 0.5) / f64::from(H));
        Rgb(tone.map(|v| (i32::from(v) + (grain % 7) as i32 - 3).clamp(0, 255) as u8))
    });
    Photo {
        pixels: pixels.into(),
        alpha: None,
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: "front.jpg".into(),
    }
}

fn run(photo: &Photo) -> Result<Mask, StageError> {
    Auto::default().run(photo, None, &Context::quiet())
}

/// Intersection over union of the mask with a shape.
fn score(mask: &Mask, shape: impl Fn(f64, f64) -> bool) -> f64 {
    let on: Vec<bool> = mask.pixels.iter().map(|v| *v != 0).collect();
    let truth: Vec<bool> = mask
        .pixels
        .enumerate_pixels()
        .map(|(x, y, _)| shape((f64::from(x) + 0.5) / f64::from(W), (f64::from(y) + 0.5) / f64::from(H)))
        .collect();
    overlap(&on, &truth)
}

/// A print in the middle of the chest: bars.
fn print(x: f64, y: f64) -> bool {
    (0.38..0.62).contains(&x) && (0.4..0.6).contains(&y) && ((y * 25.0) as u32).is_multiple_of(2)
}

#[test]
fn a_white_print_on_a_black_shirt_on_white_belongs_to_the_shirt() {
    let photo = photo(|x, y| if tee(x, y) && !print(x, y) { [25; 3] } else { [235; 3] });
    assert!(score(&run(&photo).unwrap(), tee) > 0.98);
}

#[test]
fn a_white_shirt_that_stands_out_from_white_by_twelve_levels_is_found_or_refused() {
    for cloth in [240, 246] {
        let photo = photo(|x, y| match (print(x, y), tee(x, y)) {
            (true, _) => [30, 30, 120],
            (_, true) => [cloth; 3],
            _ => [228; 3],
        });
        match run(&photo) {
            Ok(mask) => assert!(score(&mask, tee) > 0.95, "{cloth}"),
            Err(e) => assert_eq!(e.code, ErrorCode::InvalidInput, "{cloth}: {e}"),
        }
    }
}

#[test]
fn a_print_that_all_methods_take_is_seen_by_the_outline_around_it() {
    let photo = photo(|x, y| match (print(x, y), tee(x, y)) {
        (true, _) => [30, 30, 120],
        (_, true) => [240; 3],
        _ => [214; 3],
    });
    let small = SmallPhoto::of(&photo, 200);
    let at = |f: fn(f64, f64) -> bool| -> Vec<bool> {
        let place = |i: usize| ((i % small.w) as f64 / small.w as f64, (i / small.w) as f64 / small.h as f64);
        (0..small.lab.len()).map(|i| f(place(i).0, place(i).1)).collect()
    };
    let bars = at(|x, y| (0.38..0.62).contains(&x) && (0.4..0.6).contains(&y));
    let cx = Context::quiet();
    let times = larger::larger(&small, &bars, 0.03, &cx).unwrap().unwrap();
    assert!((4.0..9.0).contains(&times), "{times}");
    assert_eq!(larger::larger(&small, &at(tee), 0.03, &cx).unwrap(), None);
}

#[test]
fn a_hem_two_pixels_inside_the_frame_is_not_cut_by_it() {
    let long =
        |x: f64, y: f64| tee(x, y) || (0.3..0.7).contains(&x) && y > 0.5 && y < 1.0 - 2.0 / f64::from(H);
    let photo = photo(|x, y| if long(x, y) { [40, 60, 140] } else { [225; 3] });
    let mask = run(&photo).unwrap();
    assert!(score(&mask, long) > 0.98);
    assert_eq!((0..W).filter(|x| mask.pixels.get_pixel(*x, H - 1).0[0] != 0).count(), 0);
}

#[test]
fn a_garment_that_the_frame_cuts_is_refused_with_what_lets_it_pass() {
    let long = |x: f64, y: f64| tee(x, y) || (0.3..0.7).contains(&x) && y > 0.5;
    let photo = photo(|x, y| if long(x, y) { [40, 60, 140] } else { [225; 3] });
    let cx = Context::quiet();
    let e = Auto::default().run(&photo, None, &cx).unwrap_err();
    assert_eq!(e.to_string(), "the garment in \"front.jpg\" is cut by the frame: it touches it over 96 px");
    assert_eq!(
        e.hint.as_deref(),
        Some(
            "leave a margin of ground on all sides; if nothing of it is cut off, or one half is whole, let it \
         touch the frame: --set 'stages.test.touch=0.5'; if there is a margin, ground was taken for garment: try `GraphCut()`"
        )
    );
    assert!(cx.take_so_far().is_some());
    let taken = Auto { touch: 0.5, ..Auto::default() }.run(&photo, None, &Context::quiet()).unwrap();
    assert!(score(&taken, long) > 0.98);
}

/// A cable from under the side to the frame, in a loop.
fn cable(x: f64, y: f64) -> bool {
    let (u, v) = ((x - 0.7) * 0.75, y - 0.6);
    let ring = ((u * u + v * v).sqrt() - 0.08).abs() < 0.005;
    ring && u > 0.0 || (x - 0.8066).abs() < 0.006 && y > 0.6
}

#[test]
fn a_cable_beside_the_shirt_is_no_bump_of_it() {
    let photo = photo(|x, y| if tee(x, y) || cable(x, y) { [30, 40, 60] } else { [225; 3] });
    assert!(score(&run(&photo).unwrap(), tee) > 0.97);
}

#[test]
fn the_straps_of_a_top_are_kept() {
    let top = |x: f64, y: f64| {
        let strap = |at: f64| (x - at).abs() < 0.014 && (0.15..0.4).contains(&y);
        (0.3..0.7).contains(&x) && (0.38..0.8).contains(&y) || strap(0.38) || strap(0.62)
    };
    let photo = photo(|x, y| if top(x, y) { [160, 40, 60] } else { [225; 3] });
    let mask = run(&photo).unwrap();
    assert!(score(&mask, top) > 0.97);
    let row = |x: f64| mask.pixels.get_pixel((x * f64::from(W)) as u32, H / 4).0[0];
    assert_eq!((row(0.38), row(0.5), row(0.62)), (255, 0, 255));
}

/// Half of the shirt has the ground's colour and no edge: methods can only guess.
#[test]
fn half_a_shirt_is_refused_in_words_that_say_what_is_seen() {
    let photo = photo(|x, y| match tee(x, y) {
        true if x < 0.45 => [60, 80, 160],
        _ => [225; 3],
    });
    let cx = Context::quiet();
    let e = Auto::default().run(&photo, None, &cx).unwrap_err();
    assert_eq!(e.code, ErrorCode::InvalidInput);
    assert!(cx.take_so_far().is_some());
    assert_eq!(e.to_string(), "the two halves of what was found in \"front.jpg\" are alike to 68 % only");
}

/// A long-sleeved top whose right cuff touches the hem: the ground between sleeve and side is
/// closed in.
#[test]
fn a_wedge_of_ground_between_sleeve_and_side_is_opened() {
    let trunk = |x: f64, y: f64| (0.32..0.68).contains(&x) && (0.2..0.8).contains(&y);
    let sleeve = |x: f64, y: f64| {
        let along = (y - 0.2) / 0.55;
        (0.0..1.0).contains(&along) && (0.64 + 0.12 * along..0.8 + 0.1 * along).contains(&x)
    };
    let cuff = |x: f64, y: f64| (0.68..0.76).contains(&x) && (0.735..0.75).contains(&y);
    let top = |x: f64, y: f64| trunk(x, y) || sleeve(x, y) || sleeve(1.0 - x, y) || cuff(x, y);
    let photo = photo(|x, y| if top(x, y) { [160, 40, 60] } else { [225; 3] });
    let mask = run(&photo).unwrap();
    assert!(score(&mask, top) > 0.97);
    let ground = |x: f64| mask.pixels.get_pixel((x * f64::from(W)) as u32, H * 6 / 10).0[0] == 0;
    assert!(ground(0.3) && ground(0.7));
}

/// Legs that lie a finger apart: a clean-up closes the ground between them from the fork on.
#[test]
fn ground_between_legs_is_open_up_to_the_fork() {
    let between = |x: f64, y: f64| (x - 0.5).abs() < 0.07 * (y - 0.3);
    let trousers = |x: f64, y: f64| (0.25..0.75).contains(&x) && (0.1..0.9).contains(&y) && !between(x, y);
    let photo = photo(|x, y| if trousers(x, y) { [40, 50, 70] } else { [210, 180, 140] });
    let mask = run(&photo).unwrap();
    let ground = |y: f64| mask.pixels.get_pixel(W / 2, (y * f64::from(H)) as u32).0[0] == 0;
    assert!(ground(0.45) && !ground(0.28));
    assert!(score(&mask, trousers) > 0.985);
}

/// A tie of the ground's colour hangs from the neck and is as wide below.
#[test]
fn a_stripe_that_ends_at_the_outline_is_no_inlet() {
    let tie = |x: f64, y: f64| (x - 0.5).abs() < 0.01 && y < 0.6;
    let photo = photo(|x, y| if tee(x, y) && !tie(x, y) { [25; 3] } else { [235; 3] });
    assert!(score(&run(&photo).unwrap(), tee) > 0.98);
}

/// White bars on the chest of a red shirt on white are holes of what is found by colour.
#[test]
fn a_print_of_the_grounds_colour_is_no_wedge() {
    let photo = photo(|x, y| if tee(x, y) && !print(x, y) { [160, 40, 60] } else { [225; 3] });
    assert!(score(&run(&photo).unwrap(), tee) > 0.98);
}

#[test]
fn a_mask_of_another_size_is_refused() {
    let photo = photo(|x, y| if tee(x, y) { [160, 40, 60] } else { [225; 3] });
    let given = Mask { pixels: image::GrayImage::new(0, 0).into() };
    let e = Auto::default().run(&photo, Some(&given), &Context::quiet()).unwrap_err();
    assert_eq!(e.to_string(), "the mask has 0 x 0 pixels, its photo 240 x 320");
}

#[test]
fn the_mask_of_an_earlier_stage_is_one_more_voice() {
    // Half of the shirt has the ground's colour: alone the methods leave doubt, and the mask given
    // decides.
    let photo = photo(|x, y| match tee(x, y) {
        true if x < 0.45 => [60, 80, 160],
        true => [205; 3],
        _ => [225; 3],
    });
    let given = Mask {
        pixels: image::GrayImage::from_fn(W, H, |x, y| {
            let (x, y) = ((f64::from(x) + 0.5) / f64::from(W), (f64::from(y) + 0.5) / f64::from(H));
            image::Luma([if tee(x, y) { 255 } else { 0 }])
        })
        .into(),
    };
    let with = Auto::default().run(&photo, Some(&given), &Context::quiet());
    assert!(score(&with.unwrap(), tee) > 0.95);
}

#[test]
fn any_mask_is_taken_where_no_confidence_is_asked_for() {
    let photo = photo(|x, y| match tee(x, y) {
        true if x < 0.45 => [60, 80, 160],
        _ => [225; 3],
    });
    let any = Auto { confidence: 0.0, ..Auto::default() };
    assert!(score(&any.run(&photo, None, &Context::quiet()).unwrap(), |x, y| tee(x, y) && x < 0.45) > 0.95);
}

#[test]
fn a_shape_is_its_mirror_image_about_its_own_axis_at_any_tilt() {
    let (w, h) = (120, 120);
    for tilt in [0.0f64, 0.4, 1.1, 2.0] {
        let (sin, cos) = tilt.sin_cos();
        let on = |i: usize| {
            let (x, y) = ((i % w) as f64 / w as f64 - 0.5, (i / w) as f64 / h as f64 - 0.5);
            tee(0.5 + 0.8 * (cos * x + sin * y), 0.5 + 0.8 * (cos * y - sin * x))
        };
        let mask: Vec<bool> = (0..w * h).map(on).collect();
        assert!(symmetry(&mask, w).unwrap().share > 0.95, "{tilt}");
    }
    assert_eq!(symmetry(&[false; 9], 3), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_small_picture_gives_a_mask_or_an_error_that_says_why(
        (w, h, bytes) in (1u32..40, 1u32..40).prop_flat_map(|(w, h)| {
            (Just(w), Just(h), prop::collection::vec(prop_oneof![Just(0u8), Just(255), any::<u8>()], (w * h * 3) as usize))
        }),
        confidence in 0.0..1.0,
    ) {
        let photo = Photo { pixels: RgbImage::from_raw(w, h, bytes).unwrap().into(), ..photo(|_, _| [0; 3]) };
        match (Auto { confidence, ..Auto::default() }).run(&photo, None, &Context::quiet()) {
            Ok(mask) => {
                prop_assert_eq!(mask.pixels.dimensions(), (w, h));
                prop_assert!(mask.pixels.iter().all(|v| *v == 0 || *v == 255));
            }
            Err(e) => prop_assert!(e.code == ErrorCode::InvalidInput && e.hint.is_some(), "{e}"),
        }
    }
}

/// A tee at the left and a smaller thing of another colour at the right.
fn beside(x: f64, y: f64) -> bool {
    (0.66..0.94).contains(&x) && (0.3..0.7).contains(&y)
}

fn left(x: f64, y: f64) -> bool {
    tee(x / 0.6, y)
}

fn two_things() -> Photo {
    photo(|x, y| match (left(x, y), beside(x, y)) {
        (true, _) => [40, 60, 160],
        (_, true) => [170, 40, 40],
        _ => [225; 3],
    })
}

fn at<T>(value: T) -> BTreeMap<String, T> {
    [(Context::quiet().entry().to_owned(), value)].into()
}

#[test]
fn of_two_things_the_larger_is_taken_and_the_other_is_told() {
    let cx = Context::quiet();
    let mask = Auto::default().run(&two_things(), None, &cx).unwrap();
    assert!(score(&mask, left) > 0.97, "{}", score(&mask, left));
    let told = cx.take_remarks().warnings;
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].starts_with("a second thing lies in \"front.jpg\" to the right of the garment, "),
        "{told:?}"
    );
    let marks = format!("(garment: {{\"{}\": [(0.80, 0.50)]}})'", cx.entry());
    assert!(told[0].ends_with(&marks), "{told:?}");
    // A mirror image gives no warning: its photo gave it.
    let mirrored = Photo { mirrored: true, ..two_things() };
    Auto::default().run(&mirrored, None, &cx).unwrap();
    assert!(cx.take_remarks().warnings.is_empty());
}

#[test]
fn the_thing_that_is_marked_is_taken() {
    let place = Auto { garment: at(vec![(0.8, 0.5)]), ..Auto::default() };
    let rect = Auto { rect: at(((0.97, 0.75), (0.62, 0.25))), ..Auto::default() };
    for stage in [place, rect] {
        let mask = stage.run(&two_things(), None, &Context::quiet()).unwrap();
        assert!(score(&mask, beside) > 0.97, "{}", score(&mask, beside));
    }
}

#[test]
fn a_mark_on_the_ground_is_refused() {
    let stage = Auto { garment: at(vec![(0.58, 0.9)]), ..Auto::default() };
    let cx = Context::quiet();
    let e = stage.run(&two_things(), None, &cx).unwrap_err();
    assert_eq!(
        e.to_string(),
        "what was found in \"front.jpg\" does not contain the marked place (0.58, 0.9)"
    );
    let set = format!("--set 'stages.{}.rect={{\"{}\": ((0.1, 0.1), (0.5, 0.9))}}'", cx.stage(), cx.entry());
    assert!(e.hint.unwrap().ends_with(&set));
}
