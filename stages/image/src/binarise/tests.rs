#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::cut::{CutGrid, STEPS};
use super::mixture::Mixture;
use super::small::Lab;
use super::*;
use image::{GrayImage, Luma, Rgb, RgbImage};
use proptest::prelude::*;
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// A stand-in for a garment: a trunk with two sleeves, in shares of the frame.
fn on_garment(x: f64, y: f64) -> bool {
    let trunk = (0.35..0.65).contains(&x) && (0.2..0.85).contains(&y);
    let sleeves = (0.2..0.8).contains(&x) && (0.2..0.35).contains(&y);
    trunk || sleeves
}

fn truth(w: u32, h: u32) -> GrayImage {
    GrayImage::from_fn(w, h, |x, y| {
        let on = on_garment((f64::from(x) + 0.5) / f64::from(w), (f64::from(y) + 0.5) / f64::from(h));
        Luma([if on { 255 } else { 0 }])
    })
}

/// A whole number from 0 to 255 that looks random, the same for the same pixel.
fn hash(x: u32, y: u32) -> u32 {
    let mut v = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
    v = (v ^ (v >> 15)).wrapping_mul(0x2C1B_3C6D);
    (v ^ (v >> 12)) >> 24
}

/// Adds noise of +-6 levels.
fn noisy(tone: [u8; 3], x: u32, y: u32) -> Rgb<u8> {
    let d = (hash(x, y) % 13) as i32 - 6;
    Rgb(tone.map(|v| (i32::from(v) + d).clamp(0, 255) as u8))
}

fn photo(w: u32, h: u32, ground: impl Fn(u32, u32) -> [u8; 3], garment: [u8; 3]) -> Photo {
    let mask = truth(w, h);
    of(RgbImage::from_fn(w, h, |x, y| {
        noisy(if mask.get_pixel(x, y).0[0] != 0 { garment } else { ground(x, y) }, x, y)
    }))
}

fn of(pixels: RgbImage) -> Photo {
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

fn iou(a: &GrayImage, b: &GrayImage) -> f64 {
    let count =
        |f: fn(bool, bool) -> bool| a.iter().zip(b.iter()).filter(|(a, b)| f(**a != 0, **b != 0)).count();
    count(|a, b| a && b) as f64 / count(|a, b| a || b) as f64
}

fn score(stage: impl Fn(&Photo, &Context) -> Result<Mask, StageError>, photo: &Photo) -> f64 {
    let (w, h) = photo.pixels.dimensions();
    stage(photo, &Context::quiet()).map_or(0.0, |m| iou(&m.pixels, &truth(w, h)))
}

/// A rug of ochre, sand and black patches, some darker and most lighter than a red tee.
fn rug(x: u32, y: u32) -> [u8; 3] {
    match hash(x / 9, y / 7) % 3 {
        0 => [110, 100, 60],
        1 => [150, 120, 80],
        _ => [25, 20, 25],
    }
}

#[test]
fn otsu_finds_a_garment_that_is_darker_or_lighter_than_its_ground() {
    for (ground, garment) in [([220; 3], [40, 60, 120]), ([40; 3], [230, 220, 210])] {
        let photo = photo(160, 200, |_, _| ground, garment);
        let mask = Otsu::default().run(&photo, &Context::quiet()).unwrap();
        assert_eq!(*mask.pixels, truth(160, 200));
    }
}

#[test]
fn otsus_threshold_lies_in_the_middle_of_an_empty_valley() {
    let mut bins = [0; 256];
    (bins[50], bins[150]) = (700, 300);
    let split = otsu(&bins).unwrap();
    assert_eq!((split.threshold, split.contrast), (99, 100.0));
    assert!((split.separability - 1.0).abs() < 1e-12);
    bins[150] = 0;
    assert_eq!(otsu(&bins), None);
}

#[test]
fn a_fixed_threshold_and_a_set_side_are_obeyed() {
    let photo = photo(80, 80, |_, _| [200; 3], [100; 3]);
    let stage = Global { threshold: 150, garment: Polarity::Dark, ..Global::default() };
    assert_eq!(*stage.run(&photo, &Context::quiet()).unwrap().pixels, truth(80, 80));
    let stage = Global { threshold: 60, ..Global::default() };
    let error = stage.run(&photo, &Context::quiet()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "no garment found in \"front.jpg\": nothing stands out from the ground along the frame"
    );
}

/// The light falls off from left to right by more than garment and ground differ.
#[test]
fn a_local_threshold_follows_the_light_where_a_global_one_cannot() {
    let mask = truth(200, 200);
    let lit = of(RgbImage::from_fn(200, 200, |x, y| {
        let tone = if mask.get_pixel(x, y).0[0] != 0 { 60 } else { 115 };
        noisy([(tone + x * 7 / 10) as u8; 3], x, y)
    }));
    assert!(score(|p, cx| Otsu::default().run(p, cx), &lit) < 0.9);
    let local = Local { radius: 0.25, ..Local::default() };
    assert!(score(|p, cx| local.run(p, cx), &lit) > 0.97);
    let sauvola = Local { method: LocalMethod::Sauvola { k: 0.12 }, radius: 0.25, ..Local::default() };
    assert!(score(|p, cx| sauvola.run(p, cx), &lit) > 0.97);
}

#[test]
fn colour_parts_a_red_tee_from_a_rug_where_grey_levels_fail() {
    let photo = photo(300, 360, rug, [190, 45, 45]);
    assert!(score(|p, cx| Otsu::default().run(p, cx), &photo) < 0.7);
    assert!(score(|p, cx| Background::default().run(p, cx), &photo) > 0.95);
    assert!(score(|p, cx| GraphCut::default().run(p, cx), &photo) > 0.98);
}

#[test]
fn a_shadow_counts_as_its_ground_and_another_hue_does_not() {
    let ground = Mixture::fit(&[Lab::new(80.0, 4.0, 12.0); 50], 3, 0.0).unwrap();
    // L + 16, a and b are three quarters of the ground's.
    let shadow = Lab::new(56.0, 3.0, 9.0);
    assert!(ground.shaded_distance(&shadow, 0.4) < 1e-9);
    assert!(ground.shaded_distance(&shadow, 0.0) > 10.0);
    assert!(ground.shaded_distance(&Lab::new(40.0, 2.3, 7.0), 0.4) > 10.0, "too deep for a shadow");
    assert!(ground.shaded_distance(&Lab::new(56.0, -20.0, 9.0), 0.4) > 5.0, "green");
}

/// The mask is found at 200 or 400 px; its boundary must be right at the photo's own size.
#[test]
fn the_boundary_of_a_large_photo_is_set_to_the_pixel() {
    let photo = photo(1200, 1500, rug, [60, 110, 200]);
    let truth = truth(1200, 1500);
    for mask in [
        Background::default().run(&photo, &Context::quiet()).unwrap(),
        GraphCut::default().run(&photo, &Context::quiet()).unwrap(),
    ] {
        assert!(iou(&mask.pixels, &truth) > 0.993, "{}", iou(&mask.pixels, &truth));
        let (area, true_area) =
            (mask.area_px() as f64, Mask { pixels: truth.clone().into() }.area_px() as f64);
        assert!((area / true_area - 1.0).abs() < 0.004, "{area} of {true_area}");
    }
}

#[test]
fn a_blank_photo_holds_no_garment() {
    let blank = of(RgbImage::from_fn(90, 90, |x, y| noisy([180; 3], x, y)));
    let error = Otsu::default().run(&blank, &Context::quiet()).unwrap_err();
    assert_eq!(error.code, ErrorCode::InvalidInput);
    assert_eq!(
        error.to_string(),
        "no garment found in \"front.jpg\": its two tones differ by 6 grey levels only"
    );
    assert_eq!(error.hint.unwrap(), "lay the garment on a ground of another colour, or try `GraphCut()`");
    let plain = of(RgbImage::from_pixel(90, 90, Rgb([180; 3])));
    for result in [
        Global::default().run(&plain, &Context::quiet()),
        Otsu::default().run(&plain, &Context::quiet()),
        Local::default().run(&plain, &Context::quiet()),
        Background::default().run(&plain, &Context::quiet()),
        GraphCut::default().run(&plain, &Context::quiet()),
    ] {
        assert!(result.unwrap_err().to_string().starts_with("no garment found in \"front.jpg\": "));
    }
    // No binariser proposes itself.
    let error = GraphCut::default().run(&plain, &Context::quiet()).unwrap_err();
    assert_eq!(error.hint.unwrap(), "lay the garment on a ground of another colour, or try `Background()`");
}

#[test]
fn of_two_garments_the_larger_is_kept_and_told_and_a_stain_is_not() {
    let pieces = |second: u32| {
        of(RgbImage::from_fn(200, 100, |x, y| {
            let first = (20..80).contains(&x) && (20..80).contains(&y);
            let other = (120..120 + second).contains(&x) && (20..80).contains(&y);
            Rgb(if first || other { [30; 3] } else { [220; 3] })
        }))
    };
    for (second, told) in [(50, vec![told_beside()]), (10, vec![])] {
        let cx = Context::quiet();
        let mask = Otsu::default().run(&pieces(second), &cx).unwrap();
        assert_eq!((mask.area_px(), mask.bounds()), (3600, Some([20, 20, 79, 79])));
        assert_eq!(cx.take_remarks().warnings, told);
    }
}

fn told_beside() -> String {
    let marks = format!("{{\"{}\": [(0.72, 0.49)]}}", Context::quiet().entry());
    format!(
        "a second thing lies in \"front.jpg\" to the right of the garment, 83 % as large; it is left out, and the stated width is the garment's own. \
         To take it instead: --set 'stages.{}=Auto(garment: {marks})'",
        Context::quiet().stage()
    )
}

#[test]
fn parts_of_a_garment_with_a_stripe_between_are_joined_and_told() {
    // A vest whose stripe has the ground's tone; its corners stay as they are.
    let striped = of(RgbImage::from_fn(200, 200, |x, y| {
        let on = (60..140).contains(&x) && (40..160).contains(&y) && !(98..104).contains(&y);
        Rgb(if on { [30; 3] } else { [220; 3] })
    }));
    let cx = Context::quiet();
    let mask = Otsu { close: 0, ..Otsu::default() }.run(&striped, &cx).unwrap();
    // The ends of the stripe are rounded where it is joined.
    assert_eq!((mask.area_px(), mask.bounds()), (80 * 120 - 20, Some([60, 40, 139, 159])));
    let told = format!(
        "the garment in \"front.jpg\" was found in several parts, which are joined: look at the outline; if it is not right, take --set 'stages.{}=GraphCut()'",
        cx.stage()
    );
    assert_eq!(cx.take_remarks().warnings, [told]);
}

#[test]
fn a_garment_cut_by_the_frame_is_refused_unless_allowed() {
    let cut = of(RgbImage::from_fn(100, 100, |x, y| {
        Rgb(if (30..70).contains(&x) && y >= 20 { [30; 3] } else { [220; 3] })
    }));
    let error = Otsu::default().run(&cut, &Context::quiet()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the garment in \"front.jpg\" is cut by the frame: it touches it over 40 px"
    );
    let hint = "leave a margin of ground on all sides; if nothing of it is cut off, or one half is whole, let it \
         touch the frame: --set 'stages.test.touch=0.5'; if there is a margin, ground was taken for garment: try `GraphCut()`";
    assert_eq!(error.hint.unwrap(), hint);
    let allowed = Otsu { touch: 0.5, ..Otsu::default() };
    assert_eq!(allowed.run(&cut, &Context::quiet()).unwrap().area_px(), 3200);
}

#[test]
fn small_holes_are_filled_and_large_ones_kept() {
    let holed = of(RgbImage::from_fn(100, 100, |x, y| {
        let inside = (20..80).contains(&x) && (20..80).contains(&y);
        let large = (25..50).contains(&x) && (25..60).contains(&y);
        let small = (60..65).contains(&x) && (60..65).contains(&y);
        Rgb(if inside && !large && !small { [30; 3] } else { [220; 3] })
    }));
    assert_eq!(Otsu::default().run(&holed, &Context::quiet()).unwrap().area_px(), 3600 - 25 * 35);
    let all = Otsu { holes: 1.0, ..Otsu::default() };
    assert_eq!(all.run(&holed, &Context::quiet()).unwrap().area_px(), 3600);
}

/// A picture whose ground has been cut away needs no threshold; a transparent corner is ground.
#[test]
fn transparent_pixels_are_ground() {
    let mask = truth(60, 60);
    let mut photo = of(RgbImage::from_fn(60, 60, |x, y| noisy([128; 3], x, y)));
    photo.alpha = Some(mask.clone().into());
    for result in [
        Otsu::default().run(&photo, &Context::quiet()),
        Background::default().run(&photo, &Context::quiet()),
        GraphCut::default().run(&photo, &Context::quiet()),
    ] {
        assert_eq!(*result.unwrap().pixels, mask);
    }
    let mut corner = super::tests::photo(60, 60, |_, _| [220; 3], [40; 3]);
    let mut pixels = corner.pixels.as_ref().clone();
    let mut alpha = GrayImage::from_pixel(60, 60, Luma([255]));
    for (x, y) in (0..8).flat_map(|x| (0..8).map(move |y| (x, y))) {
        pixels.put_pixel(x, y, Rgb([0; 3]));
        alpha.put_pixel(x, y, Luma([0]));
    }
    (corner.pixels, corner.alpha) = (pixels.into(), Some(alpha.into()));
    assert_eq!(*Otsu::default().run(&corner, &Context::quiet()).unwrap().pixels, truth(60, 60));
}

/// Programs that remove the ground crop what is left: the garment touches the frame and is not cut.
#[test]
fn a_garment_that_was_cut_out_may_fill_its_frame() {
    let tee = |x: u32, y: u32| (18..42).contains(&x) || y < 20;
    let skirt = |x: u32, y: u32| 15 + y / 4 >= 30_u32.abs_diff(x);
    for is_garment in [&tee as &dyn Fn(u32, u32) -> bool, &skirt] {
        let mask = GrayImage::from_fn(60, 60, |x, y| Luma([if is_garment(x, y) { 255 } else { 0 }]));
        let cloth =
            RgbImage::from_fn(
                60,
                60,
                |x, y| if is_garment(x, y) { noisy([128; 3], x, y) } else { Rgb([255; 3]) },
            );
        let mut photo = of(cloth);
        photo.alpha = Some(mask.clone().into());
        let cx = Context::quiet();
        for result in [
            Otsu::default().run(&photo, &cx),
            Background::default().run(&photo, &cx),
            GraphCut::default().run(&photo, &cx),
        ] {
            assert_eq!(*result.unwrap().pixels, mask);
        }
        // The same picture without its opacity is a photo, in which the garment is cut.
        photo.alpha = None;
        let error = Otsu::default().run(&photo, &cx).unwrap_err().to_string();
        assert!(error.starts_with("the garment in \"front.jpg\" is cut by the frame"), "{error}");
    }
}

#[test]
fn a_photo_of_no_pixels_is_refused() {
    let error = GraphCut::default().run(&of(RgbImage::new(0, 7)), &Context::quiet()).unwrap_err();
    assert_eq!(error.to_string(), "photo \"front.jpg\" has no pixels");
}

#[test]
fn any_number_of_threads_gives_the_same_mask() {
    let photo = photo(300, 360, rug, [190, 45, 45]);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let cx = Context::quiet();
            let permissive = Otsu { touch: 4.0, ..Otsu::default() };
            [
                permissive.run(&photo, &cx).map(|m| m.pixels),
                Background::default().run(&photo, &cx).map(|m| m.pixels),
                GraphCut::default().run(&photo, &cx).map(|m| m.pixels),
            ]
        })
    };
    assert!(run(1) == run(3));
}

#[test]
fn a_cancelled_run_stops() {
    let cx = Context::quiet();
    cx.cancel().cancel();
    let error = GraphCut::default().run(&photo(60, 60, rug, [190, 45, 45]), &cx).unwrap_err();
    assert_eq!(error.code, ErrorCode::Cancelled);
}

/// Pieces by flood fill, as sets of pixels.
fn flood(mask: &GrayImage) -> BTreeSet<(bool, BTreeSet<(u32, u32)>)> {
    let (w, h) = mask.dimensions();
    let on = |x: u32, y: u32| mask.get_pixel(x, y).0[0] != 0;
    let mut left: BTreeSet<(u32, u32)> = (0..w).flat_map(|x| (0..h).map(move |y| (x, y))).collect();
    let mut pieces = BTreeSet::new();
    while let Some(first) = left.pop_first() {
        let kind = on(first.0, first.1);
        let (mut piece, mut open) = (BTreeSet::from([first]), vec![first]);
        while let Some((x, y)) = open.pop() {
            for (dx, dy) in STEPS.iter().filter(|(dx, dy)| !kind || dx * dy == 0) {
                let next = (x.wrapping_add_signed(*dx as i32), y.wrapping_add_signed(*dy as i32));
                if left.contains(&next) && on(next.0, next.1) == kind {
                    left.remove(&next);
                    piece.insert(next);
                    open.push(next);
                }
            }
        }
        pieces.insert((kind, piece));
    }
    pieces
}

fn any_mask() -> impl Strategy<Value = GrayImage> {
    (1u32..12, 1u32..12, any::<u64>()).prop_map(|(w, h, seed)| {
        GrayImage::from_fn(w, h, |x, y| Luma([if hash(x ^ seed as u32, y) < 140 { 255 } else { 0 }]))
    })
}

fn within(mask: &GrayImage, x: u32, y: u32, radius: u32, value: u8) -> bool {
    let reach = f64::from(radius * radius + radius).sqrt();
    mask.enumerate_pixels().any(|(u, v, p)| {
        let (dx, dy) = (f64::from(u.abs_diff(x)), f64::from(v.abs_diff(y)));
        p.0[0] == value && dy <= f64::from(radius) && dx * dx + dy * dy <= reach * reach
    })
}

/// The cost of a labelling: terminals and parted links.
fn labelling_cost(terminals: &[i32], links: &[[i32; 4]], w: usize, labels: u32) -> i64 {
    let on = |i: usize| labels >> i & 1 == 1;
    let own =
        terminals.iter().enumerate().map(|(i, &t)| i64::from(if on(i) { (-t).max(0) } else { t.max(0) }));
    let parted = (0..terminals.len()).flat_map(|i| (4..8).map(move |d| (i, d))).filter_map(|(i, d)| {
        let (x, y) = ((i % w) as isize + STEPS[d].0, (i / w) as isize + STEPS[d].1);
        let inside = x >= 0 && (x as usize) < w && ((y as usize) * w) < terminals.len();
        let j = inside.then(|| y as usize * w + x as usize)?;
        Some(if on(i) != on(j) { i64::from(links[i][d - 4]) } else { 0 })
    });
    own.sum::<i64>() + parted.sum::<i64>()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_pieces_are_those_of_a_flood_fill(mask in any_mask()) {
        let regions = Regions::of(&mask);
        let painted: BTreeSet<_> = (0..regions.pieces.len()).map(|i| {
            let only = regions.paint(|k, _| k == i);
            let pixels: BTreeSet<_> =
                only.enumerate_pixels().filter(|(_, _, p)| p.0[0] != 0).map(|(x, y, _)| (x, y)).collect();
            assert_eq!(pixels.len() as u64, regions.pieces[i].area);
            let (w, h) = mask.dimensions();
            let frame = pixels.iter().filter(|(x, y)| *x == 0 || *y == 0 || x + 1 == w || y + 1 == h).count();
            assert_eq!(frame as u64, regions.pieces[i].frame);
            (regions.pieces[i].on, pixels)
        }).collect();
        prop_assert_eq!(painted, flood(&mask));
    }

    #[test]
    fn dilation_and_erosion_are_their_definitions(mask in any_mask(), radius in 1u32..5) {
        let (grown, shrunk) = (dilate(&mask, radius), erode(&mask, radius));
        for (x, y, _) in mask.enumerate_pixels() {
            prop_assert_eq!(grown.get_pixel(x, y).0[0] == 255, within(&mask, x, y, radius, 255));
            prop_assert_eq!(shrunk.get_pixel(x, y).0[0] == 0, within(&mask, x, y, radius, 0));
        }
    }

    #[test]
    fn no_labelling_is_cheaper_than_the_cut(
        w in 1usize..5,
        h in 1usize..4,
        numbers in prop::collection::vec(-20i32..20, 12),
        links in prop::collection::vec(prop::array::uniform4(0i32..12), 12),
    ) {
        let terminals = &numbers[..w * h];
        let mut grid = CutGrid::new(w, h);
        for (i, &t) in terminals.iter().enumerate() {
            grid.set_terminal(i, t);
            for d in 4..8 {
                let (x, y) = ((i % w) as isize + STEPS[d].0, (i / w) as isize + STEPS[d].1);
                if x >= 0 && (x as usize) < w && (y as usize) < h {
                    grid.set_link(i, d, links[i][d - 4]);
                }
            }
        }
        let cut = grid.solve(|| Ok::<(), ()>(())).unwrap();
        let found = cut.iter().enumerate().fold(0, |l, (i, on)| l | u32::from(*on) << i);
        let cost = |l| labelling_cost(terminals, &links, w, l);
        let least = (0..1u32 << (w * h)).map(cost).min().unwrap();
        prop_assert_eq!(cost(found), least);
    }

    #[test]
    fn otsus_threshold_has_the_largest_variance_between_classes(bins in prop::collection::vec(0u64..50, 256)) {
        let bins: [u64; 256] = bins.try_into().unwrap();
        let between = |t: usize| {
            let class = |r: std::ops::Range<usize>| {
                let n = bins[r.clone()].iter().sum::<u64>() as f64;
                (n, r.map(|v| (bins[v] * v as u64) as f64).sum::<f64>() / n)
            };
            let ((n0, m0), (n1, m1)) = (class(0..t + 1), class(t + 1..256));
            if n0 == 0.0 || n1 == 0.0 { 0.0 } else { n0 * n1 * (m1 - m0).powi(2) }
        };
        if let Some(split) = otsu(&bins) {
            let best = (0..255).map(between).fold(0.0, f64::max);
            prop_assert!(between(usize::from(split.threshold)) >= best * (1.0 - 1e-9));
        }
    }

    #[test]
    fn no_photo_makes_a_binariser_panic(
        w in 1u32..9,
        h in 1u32..9,
        seed in any::<u32>(),
        contrast in 0u8..=255,
        transparent in any::<bool>(),
        size in 64u32..200,
        radius in 0u32..5,
        share in 0.005f64..0.2,
    ) {
        let mut photo = of(RgbImage::from_fn(w, h, |x, y| {
            Rgb([0, 1, 2].map(|c| (hash(x ^ seed, y + c) * u32::from(contrast) / 255) as u8))
        }));
        if transparent {
            photo.alpha = Some(GrayImage::from_fn(w, h, |x, y| Luma([hash(y, x ^ seed) as u8])).into());
        }
        let cx = Context::quiet();
        let results = [
            Global { threshold: contrast.min(254), open: radius, close: radius, ..Global::default() }.run(&photo, &cx),
            Otsu { open: radius, touch: 4.0, ..Otsu::default() }.run(&photo, &cx),
            Local { radius: share, touch: 4.0, ..Local::default() }.run(&photo, &cx),
            Local { method: LocalMethod::Sauvola { k: share }, ..Local::default() }.run(&photo, &cx),
            Background { rim: share, size, touch: 4.0, ..Background::default() }.run(&photo, &cx),
            GraphCut { rim: share, size, touch: 4.0, ..GraphCut::default() }.run(&photo, &cx),
        ];
        for mask in results.into_iter().flatten() {
            prop_assert_eq!(mask.pixels.dimensions(), (w, h));
            prop_assert!(mask.area_px() > 0 && mask.pixels.iter().all(|v| *v == 0 || *v == 255));
        }
    }
}
