#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::binarise::Otsu;
use crate::denoise::NeighbourhoodMean;
use image::{GrayImage, Luma, Rgb, RgbImage};
use proptest::prelude::*;
use std::path::Path;
use toile_core::prelude::*;

/// A sample's photo, true mask, true outline and corners, in metres.
struct Sample {
    photo: Photo,
    mask: Mask,
    outline: Vec<Point2>,
    corners: Vec<(String, Point2)>,
}

const SAMPLES: [(&str, &str); 4] =
    [("vest", "front"), ("vest", "back"), ("tshirt", "front"), ("tshirt", "back")];

fn sample((garment, side): (&str, &str)) -> Sample {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../pipelines/samples").join(garment);
    let open = |name: String| image::open(base.join(name)).unwrap();
    let text = std::fs::read_to_string(base.join(format!("{side}.outline.json"))).unwrap();
    let truth: serde_json::Value = serde_json::from_str(&text).unwrap();
    let point =
        |v: &serde_json::Value| Point2::new(v[0].as_f64().unwrap() / 1e3, v[1].as_f64().unwrap() / 1e3);
    let outline: Vec<Point2> = truth["outline"].as_array().unwrap().iter().map(point).collect();
    // The samples are symmetric about x = 0.
    let width = 2.0 * outline.iter().map(|p| p.x).fold(0.0, f64::max);
    Sample {
        photo: photo(open(format!("{side}.jpg")).to_rgb8(), Some(width)),
        mask: mask(open(format!("{side}.mask.png")).to_luma8()),
        outline,
        corners: truth["corners"].as_object().unwrap().iter().map(|(k, v)| (k.clone(), point(v))).collect(),
    }
}

fn photo(pixels: RgbImage, garment_width: Option<f64>) -> Photo {
    Photo {
        pixels: Shared::new(pixels),
        alpha: None,
        px_per_metre: None,
        garment_width,
        mirrored: false,
        joined: 1,
        file: "test.png".into(),
    }
}

fn mask(pixels: GrayImage) -> Mask {
    Mask { pixels: Shared::new(pixels) }
}

fn to_polygon(p: Point2, polygon: &[Point2]) -> f64 {
    let n = polygon.len();
    (0..n)
        .map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % n]);
            let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
            (a + (b - a) * t - p).norm()
        })
        .fold(f64::INFINITY, f64::min)
}

fn nearest_corner(outline: &Outline, p: Point2) -> f64 {
    outline.outer.corners.iter().map(|&c| (outline.outer.points[c] - p).norm()).fold(f64::INFINITY, f64::min)
}

/// Checks an outline against the truth: 95 % of its points, and every corner; limits in mm.
fn assert_true(found: &Outline, truth: &Sample, points: f64, corners: f64, what: &str) {
    let mut d: Vec<f64> = found.outer.points.iter().map(|p| 1e3 * to_polygon(*p, &truth.outline)).collect();
    d.sort_by(f64::total_cmp);
    let p95 = d[d.len() * 95 / 100];
    assert!(p95 < points, "{what}: 95 % of the outline within {p95:.2} mm");
    for (name, p) in &truth.corners {
        let off = 1e3 * nearest_corner(found, *p);
        assert!(off < corners, "{what}: {name} is {off:.2} mm off");
    }
    assert_eq!(found.outer.corners.len(), truth.corners.len(), "{what}: corners that are none");
    assert!(found.holes.is_empty(), "{what}: holes");
}

#[test]
fn canny_finds_the_samples_outlines() {
    for s in SAMPLES {
        let truth = sample(s);
        let cx = Context::quiet();
        let by_truth = Canny::default().run(&truth.photo, &truth.mask, &cx).unwrap();
        assert_true(&by_truth, &truth, 0.3, 1.0, &format!("{s:?} by the true mask"));
        let otsu = Otsu::default().run(&truth.photo, &cx).unwrap();
        let by_otsu = Canny::default().run(&truth.photo, &otsu, &cx).unwrap();
        assert_true(&by_otsu, &truth, 0.3, 1.0, &format!("{s:?} by Otsu's mask"));
    }
}

#[test]
fn every_operator_finds_the_samples_outlines() {
    for s in SAMPLES {
        let (truth, cx) = (sample(s), Context::quiet());
        let runs = [
            ("Sobel", Sobel::default().run(&truth.photo, &truth.mask, &cx)),
            ("Prewitt", Prewitt::default().run(&truth.photo, &truth.mask, &cx)),
            ("Roberts", Roberts::default().run(&truth.photo, &truth.mask, &cx)),
            ("LaplacianOfGaussian", LaplacianOfGaussian::default().run(&truth.photo, &truth.mask, &cx)),
            ("Laplacian", Laplacian::default().run(&truth.photo, &truth.mask, &cx)),
        ];
        for (name, found) in runs {
            assert_true(&found.unwrap(), &truth, 0.5, 1.5, &format!("{s:?} by {name}"));
        }
    }
}

#[test]
fn an_operator_corrects_a_mask_that_is_a_pixel_off() {
    // A mask grown by one pixel all round, as a lazy binariser gives it.
    let truth = sample(SAMPLES[0]);
    let m = &truth.mask.pixels;
    let grown = GrayImage::from_fn(m.width(), m.height(), |x, y| {
        let near =
            |dx: u32, dy: u32| m.get_pixel((x + dx).min(m.width() - 1), (y + dy).min(m.height() - 1)).0[0];
        Luma([near(0, 0).max(near(1, 0)).max(near(0, 1)).max(near(1, 1))])
    });
    let found = Canny::default().run(&truth.photo, &mask(grown), &Context::quiet()).unwrap();
    assert_true(&found, &truth, 0.3, 1.0, "grown mask");
}

/// A dark shape on light ground; `depth` is the signed distance in pixels, positive inside.
fn drawn(size: u32, depth: impl Fn(Point2) -> f64) -> (Photo, Mask) {
    let at = |x: u32, y: u32| (0.5 + depth(Point2::new(f64::from(x), f64::from(y)))).clamp(0.0, 1.0);
    let level = |x: u32, y: u32| (200.0 - 140.0 * at(x, y)).round() as u8;
    let pixels = RgbImage::from_fn(size, size, |x, y| Rgb([level(x, y); 3]));
    let inside = GrayImage::from_fn(size, size, |x, y| Luma([255 * u8::from(at(x, y) >= 0.5)]));
    let mut photo = photo(pixels, None);
    // A thousand pixels a metre: a pixel is a millimetre.
    photo.px_per_metre = Some(1000.0);
    (photo, mask(inside))
}

/// Signed distance to a square with round corners, turned by some degrees.
fn square(p: Point2, centre: f64, half: f64, radius: f64, degrees: f64) -> f64 {
    let (s, c) = degrees.to_radians().sin_cos();
    let d = p - Point2::new(centre, centre);
    let q = [(d.x * c + d.y * s).abs() - half + radius, (d.y * c - d.x * s).abs() - half + radius];
    radius - q[0].max(0.0).hypot(q[1].max(0.0)) - q[0].max(q[1]).min(0.0)
}

fn found(photo: &Photo, mask: &Mask) -> Outline {
    Canny::default().run(photo, mask, &Context::quiet()).unwrap()
}

#[test]
fn a_circle_has_no_corners_and_keeps_its_radius() {
    let (photo, mask) = drawn(400, |p| 150.0 - (p - Point2::new(200.3, 199.6)).norm());
    let outline = found(&photo, &mask);
    assert_eq!(outline.outer.corners, Vec::<usize>::new());
    assert!((outline.area() / (std::f64::consts::PI * 0.15 * 0.15) - 1.0).abs() < 2e-3);
    assert!(polygon_area(&outline.outer.points) > 0.0, "counter-clockwise");
}

#[test]
fn a_square_has_four_corners_at_any_angle() {
    for degrees in [0.0, 7.0, 22.5, 45.0, 80.0] {
        let (photo, mask) = drawn(500, |p| square(p, 250.0, 150.0, 0.0, degrees));
        let outline = found(&photo, &mask);
        assert_eq!(outline.outer.corners.len(), 4, "{degrees} degrees");
        let frame = outline.frame.unwrap();
        for k in 0..4 {
            let angle = (degrees + 45.0 + 90.0 * f64::from(k)).to_radians();
            let r = 150.0 * 2f64.sqrt();
            let corner = Point2::new(250.0 + r * angle.cos(), 250.0 + r * angle.sin());
            let off = 1e3 * nearest_corner(&outline, frame.to_metres(corner));
            assert!(off < 0.4, "{degrees} degrees: {off} px off");
        }
    }
}

#[test]
fn round_corners_are_none() {
    let (photo, mask) = drawn(500, |p| square(p, 250.0, 170.0, 60.0, 10.0));
    assert_eq!(found(&photo, &mask).outer.corners.len(), 0);
}

#[test]
fn moving_the_garment_moves_the_outline() {
    let at = |centre: f64| {
        let (photo, mask) = drawn(520, |p| square(p, centre, 150.0, 0.0, 12.0));
        found(&photo, &mask)
    };
    let (a, b) = (at(240.0), at(273.0));
    // In the pattern's frame nothing changes, to the last digits of the pixel frame.
    assert_eq!(a.outer.corners, b.outer.corners);
    for (p, q) in a.outer.points.iter().zip(&b.outer.points) {
        assert!((p - q).norm() < 1e-6, "{p} {q}");
    }
    let moved = b.frame.unwrap().origin_px - a.frame.unwrap().origin_px;
    assert!((moved.x - 33.0).abs() < 1e-3 && (moved.y - 33.0).abs() < 1e-3, "{moved}");
}

#[test]
fn a_larger_photo_gives_the_same_outline() {
    let at = |scale: f64| {
        let size = (500.0 * scale) as u32;
        let (mut photo, mask) = drawn(size, |p| square(p, 250.0 * scale, 150.0 * scale, 0.0, 20.0));
        photo.px_per_metre = None;
        photo.garment_width = Some(0.4);
        found(&photo, &mask)
    };
    let (a, b) = (at(1.0), at(2.0));
    assert_eq!((a.outer.corners.len(), b.outer.corners.len()), (4, 4));
    assert!((a.area() / b.area() - 1.0).abs() < 1e-3);
    for &c in &a.outer.corners {
        assert!(nearest_corner(&b, a.outer.points[c]) < 0.5e-3);
    }
}

#[test]
fn a_mirrored_photo_gives_the_mirror_image() {
    // A right triangle is no mirror image of itself.
    let (photo, mask) = drawn(400, |p| (p.x - 60.0).min(340.0 - p.y).min((p.y - p.x + 1.0) / 2f64.sqrt()));
    let plain = found(&photo, &mask);
    let mirrored = found(&Photo { mirrored: true, ..photo }, &mask);
    assert!(polygon_area(&mirrored.outer.points) > 0.0, "counter-clockwise");
    assert_eq!(mirrored.outer.corners.len(), 3);
    for &c in &plain.outer.corners {
        let p = plain.outer.points[c];
        assert!(nearest_corner(&mirrored, Point2::new(-p.x, p.y)) < 1e-9);
        let (a, b) = (plain.frame.unwrap().to_px(p), mirrored.frame.unwrap().to_px(Point2::new(-p.x, p.y)));
        assert!((a - b).norm() < 1e-6, "both lie over the same pixel");
    }
}

#[test]
fn holes_are_kept_and_specks_dropped() {
    let holes = |p: Point2| {
        let hole = (p - Point2::new(230.0, 260.0)).norm() - 30.0;
        let speck = (p - Point2::new(150.0, 180.0)).norm() - 2.2;
        square(p, 250.0, 150.0, 0.0, 3.0).min(hole).min(speck)
    };
    let (photo, mask) = drawn(500, holes);
    let outline = found(&photo, &mask);
    assert_eq!(outline.holes.len(), 1);
    assert!(polygon_area(&outline.holes[0].points) < 0.0, "clockwise");
    assert!((outline.area() - (0.09 - std::f64::consts::PI * 9e-4)).abs() < 1e-3 * 0.09);
}

#[test]
fn where_no_edge_is_seen_the_masks_rim_stays() {
    // A photo of one even grey: nothing to see.
    let (mut photo, mask) = drawn(400, |p| square(p, 200.0, 120.0, 0.0, 30.0));
    photo.pixels = Shared::new(RgbImage::from_pixel(400, 400, Rgb([90; 3])));
    let outline = found(&photo, &mask);
    assert_eq!(outline.outer.corners.len(), 4);
    assert!((outline.area() / 0.0576 - 1.0).abs() < 5e-3);
}

fn failure(photo: &Photo, mask: &Mask) -> (String, String) {
    let e = Canny::default().run(photo, mask, &Context::quiet()).unwrap_err();
    (e.message, e.hint.unwrap_or_default())
}

/// A garment whose ground was cut away may fill its frame; a photo that the garment fills gives a
/// warning.
#[test]
fn a_garment_that_was_cut_out_is_not_cut_by_the_frame() {
    let at = |x: u32, y: u32| Luma([255 * u8::from(x >= 70 && y < 150 || y < 60)]);
    let whole = mask(GrayImage::from_fn(200, 200, at));
    let mut cut_out = photo(RgbImage::from_fn(200, 200, |x, y| Rgb([255 - at(x, y).0[0] / 2; 3])), None);
    cut_out.px_per_metre = Some(1000.0);
    let told = |photo: &Photo, mask: &Mask| {
        let cx = Context::quiet();
        Canny::default().run(photo, mask, &cx).unwrap();
        cx.take_remarks().warnings
    };
    let file = &cut_out.file;
    let warning = format!("the garment in \"{file}\" touches the photo's left border, and ends there");
    assert_eq!(told(&cut_out, &whole)[0], warning);
    cut_out.alpha = Some(whole.pixels.clone());
    let outline = Canny::default().run(&cut_out, &whole, &Context::quiet()).unwrap();
    let area = toile_core::artifact::polygon_area(&outline.outer.points) * 1e6;
    assert!((area / f64::from(whole.area_px() as u32) - 1.0).abs() < 0.02, "{area}");
    // A mask that is not what is opaque is cut as before.
    let other = mask(GrayImage::from_fn(200, 200, |x, y| Luma([255 * u8::from(x < 90 && y < 60)])));
    assert_eq!(told(&cut_out, &other)[0], warning);
}

#[test]
fn errors_say_what_is_wrong_and_what_to_do() {
    let (photo, whole) = drawn(200, |p| square(p, 100.0, 60.0, 0.0, 0.0));
    let of = |m: GrayImage| failure(&photo, &mask(m));
    let empty = of(GrayImage::new(200, 200));
    assert_eq!(empty.0, "the mask is empty: no garment was found in the photo");
    assert_eq!(empty.1, "try another binariser, such as `Background()`");

    let other = of(GrayImage::new(100, 200));
    assert_eq!(other.0, "the mask has 100 x 200 pixels, its photo 200 x 200");

    let small = of(GrayImage::from_fn(200, 200, |x, y| Luma([255 * u8::from(x / 10 == 9 && y / 10 == 9)])));
    assert_eq!(small.0, "the garment covers 100 pixels only, too few for an outline");

    let two = of(GrayImage::from_fn(200, 200, |x, y| {
        Luma([255 * u8::from(y > 20 && y < 120 && (x > 20 && x < 100 || x > 110 && x < 160))])
    }));
    assert_eq!(two.0, "the mask holds two pieces; the second is 62 % as large as the first");
    assert_eq!(two.1, "photograph one garment at a time");

    let unknown = failure(&Photo { px_per_metre: None, ..photo.clone() }, &whole);
    assert_eq!(unknown.0, "the photo's scale is not known");
    assert_eq!(unknown.1, "give the garment's real width beside its file, like `width: \"52 cm\"`");

    let nan = failure(&Photo { px_per_metre: Some(f64::NAN), ..photo.clone() }, &whole);
    assert_eq!(nan.0, "the photo's scale is NaN pixels per metre");
    let tiny = failure(&Photo { px_per_metre: Some(1e-300), ..photo.clone() }, &whole);
    assert_eq!(tiny.0, "the photo's scale is 1e-300 pixels per metre");
}

#[test]
fn canny_wants_low_below_high() {
    let (photo, mask) = drawn(200, |p| square(p, 100.0, 60.0, 0.0, 0.0));
    let canny: Canny = toile_core::param::ron_options().from_str("(low: 90, high: 60)").unwrap();
    let e = canny.run(&photo, &mask, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "`low` is 90, above `high`, which is 60");
    assert_eq!(e.param, Some("low"));
}

#[test]
fn an_outline_that_crosses_itself_is_seen() {
    let at = |p: [[f64; 2]; 4]| Loop { points: p.map(|[x, y]| Point2::new(x, y)).to_vec(), corners: vec![] };
    let bow = at([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    let kite = at([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    assert!(crossing::first(std::iter::once(&bow)).is_some());
    assert!(crossing::first(std::iter::once(&kite)).is_none());
    let far = at([[5.0, 0.0], [6.0, 0.0], [6.0, 1.0], [5.0, 1.0]]);
    let over = at([[0.5, 0.5], [2.0, 0.5], [2.0, 0.7], [0.5, 0.7]]);
    assert!(crossing::first([&kite, &far].into_iter()).is_none());
    assert!(crossing::first([&kite, &over].into_iter()).is_some());
}

#[test]
fn threads_do_not_change_a_bit() {
    let truth = sample(SAMPLES[3]);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| found(&truth.photo, &truth.mask))
    };
    assert_eq!(with(1), with(3));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Blobs and specks of any kind give an outline of finite points or an error.
    #[test]
    fn no_mask_makes_it_panic(
        blobs in prop::collection::vec((0.0..96.0f64, 0.0..96.0f64, 0.5..30.0f64, any::<bool>()), 0..14),
        noise in 0u64..u64::MAX,
        share in 0u64..40,
    ) {
        let on = |x: u32, y: u32| {
            let p = Point2::new(f64::from(x), f64::from(y));
            let hash = noise.wrapping_mul(u64::from(x * 131 + y + 1)).rotate_left(17) % 1000;
            let inside = blobs.iter().fold(false, |on, b| {
                if (p - Point2::new(b.0, b.1)).norm() < b.2 { b.3 } else { on }
            });
            inside ^ (hash < share)
        };
        let m = mask(GrayImage::from_fn(96, 96, |x, y| Luma([255 * u8::from(on(x, y))])));
        let pixels = RgbImage::from_fn(96, 96, |x, y| Rgb([if on(x, y) { 40 } else { 190 }; 3]));
        if let Ok(o) = Canny::default().run(&photo(pixels, Some(0.5)), &m, &Context::quiet()) {
            let loops = std::iter::once(&o.outer).chain(&o.holes);
            prop_assert!(loops.flat_map(|l| &l.points).all(|p| p.x.is_finite() && p.y.is_finite()));
            prop_assert!(o.outer.corners.windows(2).all(|w| w[0] < w[1]));
            prop_assert!(polygon_area(&o.outer.points) > 0.0);
        }
    }
}

#[test]
fn a_photo_of_joined_pixels_gives_the_outline_of_the_small_one() {
    let truth = sample(SAMPLES[0]);
    let (w, h) = truth.photo.pixels.dimensions();
    let large = image::imageops::resize(truth.photo.pixels.as_ref(), 2 * w, 2 * h, image::imageops::Nearest);
    let large = photo(large, truth.photo.garment_width);
    let cx = Context::quiet();
    let found = |from: &Photo, least: f64| {
        let quiet = NeighbourhoodMean { pixel: Length::mm(least), ..NeighbourhoodMean::default() };
        let quiet = quiet.run(from, &cx).unwrap();
        let mask = Otsu::default().run(&quiet, &cx).unwrap();
        (Canny::default().run(&quiet, &mask, &cx).unwrap(), quiet.joined)
    };
    let (joined, n) = found(&large, 0.5);
    let (small, one) = found(&truth.photo, 0.5);
    assert_eq!((n, one), (2, 1));
    // Joining undoes the enlargement to the bit. The runner parts the frame.
    assert_eq!(joined, small);
    assert_true(&joined, &truth, 0.3, 1.0, "joined");
}
