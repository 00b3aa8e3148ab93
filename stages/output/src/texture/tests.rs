//! Photos on panels: the right pixels, in the right place, and none of the ground.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::bleed::{bleed, eroded, nearest};
use super::inside::{PixelBox, cover, keep_shown};
use super::{PhotoTexturer, crop};
use image::{GrayImage, Luma, Rgb, RgbImage};
use proptest::prelude::*;
use toile_core::param::ron_options;
use toile_core::prelude::*;
use toile_fixtures::photographed::{self, one_sheet};

fn texturer(params: &str) -> PhotoTexturer {
    ron_options().from_str(&one_sheet(params)).unwrap()
}

fn model(params: &str) -> Model {
    let body = photographed::body();
    texturer(params)
        .run(&photographed::garment(8), Some(photographed::photos()), None, Some(&body), &Context::quiet())
        .unwrap()
}

/// The texel under a texture coordinate.
fn texel(texture: &Texture, uv: [f32; 2]) -> [u8; 3] {
    let (w, h) = texture.pixels.dimensions();
    let at = |c: f32, n: u32| ((c * n as f32) as u32).min(n - 1);
    texture.pixels.get_pixel(at(uv[0], w), at(uv[1], h)).0
}

/// True for a colour with some of the fixture's green ground in it.
fn greenish([r, g, b]: [u8; 3]) -> bool {
    i32::from(g) > i32::from(r).max(i32::from(b)) + 10
}

#[test]
fn every_panel_gets_its_own_photo() {
    let model = model("()");
    let names: Vec<&str> = model.meshes.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["front", "back", "body"]);
    for (i, mesh) in model.meshes[..2].iter().enumerate() {
        assert_eq!(mesh.material, i);
        assert_eq!(model.materials[i].texture, Some(i));
        assert_eq!(mesh.uv.len(), mesh.positions.len());
        assert!(mesh.uv.iter().flatten().all(|c| (0.0..=1.0).contains(c)));
    }
    assert!(model.meshes[2].uv.is_empty());
}

#[test]
fn vertices_find_their_photo_pixels() {
    let (garment, photos, model) = (photographed::garment(8), photographed::photos(), model("(margin: 3)"));
    let inner = |p: &Point2| {
        let (w, h) = photos.get("front").unwrap().pixels.dimensions();
        p.x > 50.0 && p.y > 50.0 && p.x < f64::from(w) - 50.0 && p.y < f64::from(h) - 50.0
    };
    let mut seen = 0;
    for (panel, mesh) in garment.panels.iter().zip(&model.meshes) {
        let photo = photos.get(&panel.name).unwrap();
        for (px, uv) in panel.photo_px.iter().zip(&mesh.uv).filter(|(px, _)| inner(px)) {
            // The vertex lies between pixel centres; the texel must be one of its four neighbours.
            let around = [(0, 0), (1, 0), (0, 1), (1, 1)]
                .map(|(dx, dy)| photo.pixels.get_pixel(px.x as u32 + dx, px.y as u32 + dy).0);
            assert!(around.contains(&texel(&model.textures[mesh.material], *uv)), "at {px}");
            seen += 1;
        }
    }
    assert!(seen >= 2 * 7 * 7);
}

#[test]
fn a_mirrored_photo_is_read_from_right_to_left() {
    let (garment, model) = (photographed::garment(8), model("()"));
    let (first, last) = (garment.rest[0], garment.rest[8]);
    assert!(first.x < last.x);
    let [front, back] = [&model.meshes[0], &model.meshes[1]];
    assert!(front.uv[0][0] < front.uv[8][0]);
    assert!(back.uv[0][0] > back.uv[8][0]);
}

#[test]
fn no_ground_shows_anywhere_in_a_texture() {
    for params in ["()", "(size: 200)", "(inset: \"0 mm\")", "(size: 64, margin: 0)", "(margin: 200)"] {
        for texture in model(params).textures {
            let green = texture.pixels.pixels().filter(|p| greenish(p.0)).count();
            assert_eq!(green, 0, "{params}: {} of {:?}", texture.name, texture.pixels.dimensions());
        }
    }
}

#[test]
fn where_two_pieces_of_one_photo_meet_its_colours_stay() {
    let mut garment = photographed::garment(8);
    let mut photo = photographed::photos().get("front").unwrap().clone();
    let middle = 0.5 * f64::from(photo.pixels.width() - 1);
    for (panel, (name, first)) in
        garment.panels.iter_mut().zip([("left_front", middle), ("right_front", 40.5)])
    {
        name.clone_into(&mut panel.name);
        for px in &mut panel.photo_px {
            px.x = first + 0.5 * (px.x - 40.5);
        }
    }
    let near = |panel: &GarmentPanel| {
        let off = |p: &Point2| (p.x - middle).abs();
        (0..panel.photo_px.len()).min_by(|a, b| off(&panel.photo_px[*a]).total_cmp(&off(&panel.photo_px[*b])))
    };
    let line = photo.pixels.width() / 2 - 60..photo.pixels.width() / 2 + 60;
    let buttons = RgbImage::from_fn(photo.pixels.width(), photo.pixels.height(), |x, y| {
        if line.contains(&x) { Rgb([10, 20, 250]) } else { *photo.pixels.get_pixel(x, y) }
    });
    photo.pixels = Shared::new(buttons);
    let photos: Set<Photo> = [("front".to_owned(), photo)].into_iter().collect();
    let texturer = texturer("(inset: \"90 mm\")");
    let model = texturer.run(&garment, Some(photos), None, None, &Context::quiet()).unwrap();
    for (panel, mesh) in garment.panels.iter().zip(&model.meshes) {
        let k = near(panel).unwrap();
        assert_eq!(texel(&model.textures[mesh.material], mesh.uv[k]), [10, 20, 250], "{}", panel.name);
    }
}

#[test]
fn textures_are_scaled_down_to_size() {
    for texture in model("(size: 200)").textures {
        assert_eq!(texture.pixels.width().max(texture.pixels.height()), 200);
    }
}

#[test]
fn replace_is_unlit_and_modulate_is_lit() {
    assert!(model("(light: Replace)").materials[0].unlit);
    assert!(!model("(light: Modulate)").materials[0].unlit);
    assert!(!model("(light: Replace)").materials[2].unlit, "the body is always lit");
}

#[test]
fn the_body_can_be_hidden() {
    assert_eq!(model("(body: Hide)").meshes.len(), 2);
}

#[test]
fn joined_vertices_share_their_normal() {
    let (garment, model) = (photographed::garment(8), model("()"));
    for [a, b] in garment.seams.iter().flat_map(|s| &s.pairs) {
        let back = *b as usize - garment.panels[1].vertices.start;
        assert_eq!(model.meshes[0].normals[*a as usize], model.meshes[1].normals[back]);
    }
}

#[test]
fn a_panel_without_a_photo_is_plain_and_says_so() {
    let cx = Context::quiet();
    let model = texturer("()").run(&photographed::garment(4), None, None, None, &cx).unwrap();
    assert!(model.textures.is_empty() && model.meshes.iter().all(|m| m.uv.is_empty()));
    assert_eq!(cx.take_remarks().warnings[0], "panel \"front\" has no photo and gets a plain cloth");
}

#[test]
fn a_vertex_that_is_not_finite_is_refused() {
    let mut garment = photographed::garment(4);
    garment.positions[3].y = f64::NAN;
    let error = texturer("()").run(&garment, None, None, None, &Context::quiet()).unwrap_err();
    assert_eq!(error.to_string(), "the garment has a vertex that is not finite");
    assert!(error.hint.is_some());
}

#[test]
fn a_panel_beside_its_photo_is_refused() {
    let mut garment = photographed::garment(4);
    garment.panels[0].photo_px.iter_mut().for_each(|p| p.x += 1e9);
    let error = texturer("()")
        .run(&garment, Some(photographed::photos()), None, None, &Context::quiet())
        .unwrap_err();
    assert_eq!(error.to_string(), "panel \"front\" covers no pixel of its photo \"photo.png\"");
}

#[test]
fn a_panel_thinner_than_the_inset_keeps_its_colours() {
    let model = model("(inset: \"5 cm\", size: 16)");
    assert!(model.textures.iter().all(|t| t.pixels.pixels().all(|p| p.0 != [0, 0, 0] && !greenish(p.0))));
}

#[test]
fn a_stopped_run_stops() {
    let cx = Context::quiet();
    cx.cancel().cancel();
    let error = texturer("()").run(&photographed::garment(4), None, None, None, &cx).unwrap_err();
    assert_eq!(error.code, ErrorCode::Cancelled);
}

#[test]
fn texture_coordinates_run_to_the_boxes_outer_corners() {
    let area = PixelBox { left: 10, top: -2, width: 4, height: 8 };
    assert_eq!(area.uv(&Point2::new(9.5, -2.5)), [0.0, 0.0]);
    assert_eq!(area.uv(&Point2::new(13.5, 5.5)), [1.0, 1.0]);
}

#[test]
fn averaging_leaves_the_outside_out() {
    let photo = RgbImage::from_fn(4, 4, |x, _| if x < 2 { Rgb([200, 100, 50]) } else { Rgb([0, 255, 0]) });
    let inside = GrayImage::from_fn(4, 4, |x, y| Luma([if x < 2 && y != 3 { 255 } else { 0 }]));
    let area = PixelBox { left: 0, top: 0, width: 4, height: 4 };
    let crop = crop::crop(&photo, area, &inside, [2, 2]);
    assert_eq!(crop.inside.as_raw(), &[255, 0, 255, 0]);
    let [r, g, b] = crop.pixels.get_pixel(0, 1).0;
    assert!(r.abs_diff(200) <= 1 && g.abs_diff(100) <= 1 && b.abs_diff(50) <= 1);
}

#[test]
fn erosion_takes_the_rim_off() {
    let inside = GrayImage::from_fn(9, 9, |x, y| {
        Luma([if (2..7).contains(&x) && (2..7).contains(&y) { 255 } else { 0 }])
    });
    let count = |depth: f64| eroded(&inside, depth).as_raw().iter().filter(|&&v| v != 0).count();
    assert_eq!([count(0.0), count(1.0), count(2.0), count(3.0)], [25, 9, 1, 0]);
}

#[test]
fn bleeding_nothing_says_so() {
    assert!(!bleed(&mut RgbImage::new(3, 3), &GrayImage::new(3, 3), 2.0));
}

/// Small pictures with some pixels marked.
fn marked() -> impl Strategy<Value = (usize, usize, Vec<bool>)> {
    (1usize..24, 1usize..24).prop_flat_map(|(w, h)| {
        (Just(w), Just(h), proptest::collection::vec(proptest::bool::weighted(0.1), w * h))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_nearest_mark_is_the_nearest((w, h, marks) in marked()) {
        let found = nearest(|x, y| marks[y * w + x], w, h);
        prop_assert_eq!(found.is_some(), marks.contains(&true));
        let d2 = |a: usize, b: usize| ((a % w).abs_diff(b % w)).pow(2) + ((a / w).abs_diff(b / w)).pow(2);
        for (i, n) in found.into_iter().flatten().enumerate() {
            let best = (0..w * h).filter(|&k| marks[k]).map(|k| d2(i, k)).min();
            prop_assert!(marks[n as usize]);
            prop_assert_eq!(Some(d2(i, n as usize)), best);
        }
    }

    #[test]
    fn covered_pixels_lie_in_the_triangle(c in proptest::collection::vec((-3.0..13.0, -3.0..13.0), 3)) {
        let p: Vec<Point2> = c.iter().map(|&(x, y)| Point2::new(x, y)).collect();
        let area = PixelBox { left: 0, top: 0, width: 10, height: 10 };
        let mut picture = image::GrayImage::new(area.width, area.height);
        cover(&mut picture, &p, &[[0, 1, 2]], area);
        let side = |a: Point2, b: Point2, q: Point2| (b - a).perp(&(q - a));
        for (x, y, v) in picture.enumerate_pixels() {
            let q = Point2::new(f64::from(x), f64::from(y));
            let s = [side(p[0], p[1], q), side(p[1], p[2], q), side(p[2], p[0], q)];
            let (least, most) = (s.iter().copied().fold(f64::MAX, f64::min), s.iter().copied().fold(f64::MIN, f64::max));
            // Clear cases only: pixels within rounding of an edge may fall either way.
            let inside = least > 1e-6 || most < -1e-6;
            let outside = least < -1e-6 && most > 1e-6;
            prop_assert!(!inside || v.0[0] == 255);
            prop_assert!(!outside || v.0[0] == 0);
        }
    }

    #[test]
    fn any_finite_photo_coordinates_are_survived(
        moves in proptest::collection::vec((0usize..50, -1e12..1e12, -2e3..2e3), 0..6),
    ) {
        let mut garment = photographed::garment(4);
        for (i, dx, dy) in moves {
            let px = &mut garment.panels[0].photo_px;
            let k = i % px.len();
            px[k] += Vector2::new(dx, dy);
        }
        let result = texturer("(size: 64)").run(&garment, Some(photographed::photos()), None, None, &Context::quiet());
        if let Ok(model) = result {
            prop_assert!(model.meshes[0].uv.iter().flatten().all(|c| c.is_finite()));
        }
    }
}

#[test]
fn one_and_two_threads_give_the_same_bits() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let model = pool.install(|| model("(size: 300)"));
        model.textures.iter().map(|t| t.pixels.clone()).collect::<Vec<_>>()
    };
    assert_eq!(with(1), with(2));
}

#[test]
fn what_the_mask_does_not_show_has_no_colour_of_its_own() {
    // A box of 8 by 4 pixels that begins one pixel left of the photo; the mask has pixels of two,
    // of which the middle column is ground.
    let area = PixelBox { left: -1, top: 0, width: 8, height: 4 };
    let mask = |ground: u32| GrayImage::from_fn(3, 2, |x, _| Luma([if x == ground { 0 } else { 255 }]));
    let mut inside = GrayImage::from_pixel(8, 4, Luma([255]));
    keep_shown(&mut inside, &mask(1), 6, area);
    let row: Vec<bool> = (0..8).map(|x| inside.get_pixel(x, 0).0[0] != 0).collect();
    assert_eq!(row, [false, true, true, false, false, true, true, false]);
    // A mask that shows less than half of the panel is that of another garment.
    let mut inside = GrayImage::from_pixel(8, 4, Luma([255]));
    keep_shown(&mut inside, &GrayImage::new(3, 2), 6, area);
    assert!(inside.pixels().all(|p| p.0[0] == 255));
}

#[test]
fn cloth_shines_as_far_as_it_is_told_and_names_its_fabric() {
    let sheen = |params: &str| model(params).materials[0].sheen.map(|s| s.colour);
    assert_eq!(sheen("()"), Some([0.1; 3]));
    assert_eq!(sheen("(sheen: 0.4)"), Some([0.4; 3]));
    assert_eq!(sheen("(sheen: 0.0)"), None);
    assert_eq!(sheen("(light: Replace)"), None);
    let made = model("()");
    let fabrics: Vec<&str> = made.materials.iter().map(|m| m.fabric.as_str()).collect();
    assert_eq!(fabrics, ["test cloth", "test cloth", ""]);
}

#[test]
fn the_detail_of_a_photo_is_a_normal_map_of_its_size() {
    let made = model("(detail: Photo, size: 200)");
    let names: Vec<&str> = made.textures.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["front", "back", "front normals", "back normals"]);
    let maps: Vec<Option<usize>> = made.materials.iter().map(|m| m.normal_texture).collect();
    assert_eq!(maps, [Some(2), Some(3), None]);
    assert_eq!(made.textures[2].pixels.dimensions(), made.textures[0].pixels.dimensions());
    // Stripes and dots are relief here: some normals lean, and more so where it is stronger.
    let lean = |params: &str| {
        let made = model(params);
        made.textures[2].pixels.pixels().map(|p| u64::from(255 - p.0[2])).sum::<u64>()
    };
    assert!(lean("(detail: Photo, strength: 2.0)") > lean("(detail: Photo)"));
}

#[test]
fn what_no_light_brings_out_is_refused() {
    let fault = |params: &str| {
        let e = texturer(params)
            .run(&photographed::garment(2), Some(photographed::photos()), None, None, &Context::quiet())
            .unwrap_err();
        (e.message, e.hint.unwrap_or_default(), e.param)
    };
    let hint = "light does not act on such a photo: leave it out, or give `light: Modulate`";
    let told = |text: &str, hint: &str, name| (text.to_owned(), hint.to_owned(), Some(name));
    let detail = told("`detail` does nothing with `light: Replace`", hint, "detail");
    assert_eq!(fault("(light: Replace, detail: Photo)"), detail);
    let sheen = told("`sheen` does nothing with `light: Replace`", hint, "sheen");
    assert_eq!(fault("(light: Replace, sheen: 0.2)"), sheen);
    let hint = "leave it out, or give `detail: Photo`";
    let strength = told("`strength` does nothing with `detail: None`", hint, "strength");
    assert_eq!(fault("(strength: 2.0)"), strength);
}

#[test]
fn the_wrong_side_is_plain_cloth_and_open_edges_are_thick() {
    let run = |params: &str| {
        let texturer: PhotoTexturer = ron_options().from_str(params).unwrap();
        let photos = Some(photographed::photos());
        texturer.run(&photographed::garment(8), photos, None, None, &Context::quiet()).unwrap()
    };
    let model = run("()");
    let names: Vec<&str> = model.meshes.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["front", "back", "front edge", "back edge"]);
    // The front is red and the back blue: each photo's own cloth.
    let backs: Vec<[f32; 3]> = model.materials[..2].iter().map(|m| m.wrong_side.unwrap()).collect();
    assert!(backs[0][0] > 2.0 * backs[0][2] && backs[1][2] > 2.0 * backs[1][0], "{backs:?}");
    let edge = &model.materials[model.meshes[2].material];
    assert_eq!((edge.texture, edge.wrong_side, edge.double_sided), (Some(0), None, false));
    assert_eq!(run("(edge: \"0 mm\", wrong_side: Same)").meshes.len(), 2);
}

#[test]
fn uneven_light_goes_only_where_it_is_asked_to() {
    let light = |x: u32| 60 + (x / 4).min(120) as u8;
    let photos = || {
        let shaded = |p: &Photo| {
            let (w, h) = p.pixels.dimensions();
            let pixels = RgbImage::from_fn(w, h, |x, _| Rgb([light(x), light(x) / 2, light(x) / 2]));
            p.with_pixels(pixels)
        };
        photographed::photos().0.iter().map(|(name, p)| (name.clone(), shaded(p))).collect()
    };
    let spread = |params: &str| {
        let model = texturer(params)
            .run(&photographed::garment(8), Some(photos()), None, None, &Context::quiet())
            .unwrap();
        let (w, h) = model.textures[0].pixels.dimensions();
        let red = |x: u32| i32::from(model.textures[0].pixels.get_pixel(x, h / 2).0[0]);
        (red(w * 3 / 4) - red(w / 4)).abs()
    };
    assert!(spread("()") > 30 && spread("(shading: Remove)") < 8, "{}", spread("(shading: Remove)"));
}

/// A folder with the fixture's front in other colours: in its place, from farther away, and cut
/// off.
fn other_fronts() -> (tempfile::TempDir, Context) {
    let folder = tempfile::tempdir().unwrap();
    let first = photographed::photos();
    let front = &first.get("front").unwrap().pixels;
    let (w, h) = front.dimensions();
    let swapped = |p: Rgb<u8>| if p.0 == photographed::GROUND { p } else { Rgb([p.0[2], p.0[1], p.0[0]]) };
    let blue = RgbImage::from_fn(w, h, |x, y| swapped(*front.get_pixel(x, y)));
    blue.save(folder.path().join("blue.png")).unwrap();
    let mut far = RgbImage::from_pixel(w, h, Rgb(photographed::GROUND));
    let small = image::imageops::thumbnail(&blue, w * 7 / 10, h * 7 / 10);
    image::imageops::replace(&mut far, &small, i64::from(w) / 7, i64::from(h) / 7);
    far.save(folder.path().join("far.png")).unwrap();
    image::imageops::crop_imm(&blue, 0, 0, w - 9, h).to_image().save(folder.path().join("cut.png")).unwrap();
    let cx = Context::new("PhotoTexturer", folder.path(), toile_core::Cancel::new(), std::sync::Arc::new(()));
    (folder, cx)
}

fn varied(variants: &str, cx: &Context) -> Result<Model, StageError> {
    let stage = texturer(&format!("(body: Hide, variants: {variants})"));
    stage.run(&photographed::garment(8), Some(photographed::photos()), None, None, cx)
}

#[test]
fn a_variant_takes_its_own_photos_and_leaves_the_others() {
    let (_folder, cx) = other_fronts();
    let model = varied("{\"blue\": {\"front\": \"blue.png\"}}", &cx).unwrap();
    let names: Vec<&str> = model.textures.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["front", "back", "front blue"], "the back is the same in both");
    assert_eq!(model.variants.iter().map(|v| v.name.as_str()).collect::<Vec<_>>(), ["original", "blue"]);
    let front = |variant: usize| {
        let material = model.variants[variant].materials[0];
        texel(&model.textures[model.materials[material].texture.unwrap()], [0.3, 0.5])
    };
    let [[r, g, b], other] = [front(0), front(1)];
    assert_eq!(other, [b, g, r]);
    assert_eq!(model.check(), Ok(()));
    // The back is the front's mirror image: then it is so in the variant.
    let mut photos = photographed::photos();
    let front = photos.get("front").unwrap().clone();
    photos.0.insert("back".into(), std::sync::Arc::new(Photo { mirrored: true, ..front }));
    let stage = texturer("(body: Hide, variants: {\"blue\": {\"front\": \"blue.png\"}})");
    let model = stage.run(&photographed::garment(8), Some(photos), None, None, &cx).unwrap();
    let names: Vec<&str> = model.textures.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["front", "back", "front blue", "back blue"]);
}

#[test]
fn variants_that_show_the_garment_elsewhere_or_are_not_there_are_refused() {
    let (_folder, cx) = other_fronts();
    let told = |variants: &str| {
        let e = varied(variants, &cx).unwrap_err();
        (e.message, e.hint.unwrap_or_default())
    };
    let alike = "photos of variants show the garment where the first one does: take them from the same place, and crop them alike";
    assert_eq!(
        told("{\"blue\": {\"front\": \"cut.png\"}}"),
        ("\"cut.png\" is 360 x 441 px, and not 369 x 441 px as \"photo.png\"".into(), alike.into())
    );
    let (message, hint) = told("{\"blue\": {\"front\": \"far.png\"}}");
    assert!(message.starts_with("the garment lies elsewhere in \"far.png\": "), "{message}");
    assert!(message.ends_with(" % of panel \"front\" is on it") && hint == alike, "{message}");
    assert_eq!(
        told("{\"blue\": {\"side\": \"blue.png\"}}"),
        ("no photo is called \"side\"".into(), "the photos are back, front".into())
    );
    assert_eq!(told("{\"blue\": {}}").0, "the variant \"blue\" has no photo");
    assert_eq!(
        told("{\"original\": {\"front\": \"blue.png\"}}").0,
        "the variant \"original\" has the name of the model's own look, or none"
    );
}
