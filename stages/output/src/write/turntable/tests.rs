//! A turntable of the suite's model.
#![allow(clippy::unwrap_used)]

use super::*;
use toile_core::testkit::dress;

fn small() -> Turntable {
    Turntable { views: Some(4), tiers: 2, size: 96, ..Turntable::default() }
}

fn html(t: &Turntable, cx: &Context) -> String {
    String::from_utf8(t.run(&dress::model(), cx).unwrap().0.remove(0).bytes).unwrap()
}

fn data(html: &str) -> Value {
    serde_json::from_str(data_of(html).unwrap()).unwrap()
}

#[test]
fn the_page_holds_every_view_and_asks_for_nothing_else() {
    let html = html(&small(), &Context::quiet());
    let data = data(&html);
    assert_eq!((data["views"].as_u64(), data["tiers"].as_array().unwrap().len()), (Some(4), 2));
    assert_eq!(data["sheets"].as_array().unwrap().len(), 1, "8 views in one sheet");
    let rows = 96 / 8;
    assert_eq!(STANDARD.decode(data["spans"].as_str().unwrap()).unwrap().len(), 8 * rows * 2);
    assert!(!html.contains("http://") && !html.contains("https://"), "a link");
    assert!(!html.contains("/*CSS*/") && !html.contains("/*JS*/") && !html.contains("/*DATA*/"));
}

#[test]
fn all_of_the_garment_is_in_every_view() {
    let model = dress::model();
    let orbit = Orbit::around(&model, 72, 96, TIERS[2]);
    for view in ModelScene::draft(&model).cut_outs(&orbit, 0.3, &[0.0]) {
        // The suite's mannequin runs out of the picture, its garment does not: nothing of it is at
        // the sides.
        assert!((0..96).all(|y| view.get_pixel(0, y).0[3] == 0 && view.get_pixel(71, y).0[3] == 0));
        assert!(view.pixels().any(|p| p.0[3] == 255));
    }
}

#[test]
fn names_of_parts_cannot_end_the_script() {
    let mut model = dress::model();
    model.meshes[0].name = "</script><b>/*JS*/".into();
    let text = String::from_utf8(small().run(&model, &Context::quiet()).unwrap().0.remove(0).bytes).unwrap();
    assert!(!text.contains("</script><b>"));
    assert_eq!(data(&text)["mesh"]["parts"][0]["name"], "</script><b>/*JS*/");
}

#[test]
fn a_page_that_cannot_be_as_small_as_asked_says_what_to_do() {
    let cx = Context::quiet();
    let t = Turntable { page: 50, size: 480, ..small() };
    let kilobytes = html(&t, &cx).len() / 1000;
    assert_eq!(
        cx.take_remarks().warnings,
        [format!(
            "the turntable's page has {kilobytes} kB and not 50, though the quality is lowered to 30: take fewer `views` or `tiers`, or a smaller `size`"
        )]
    );
}

/// How many numbers these bytes hold: each ends in a byte below 128.
fn numbers(base64: &Value) -> usize {
    STANDARD.decode(base64.as_str().unwrap()).unwrap().iter().filter(|b| **b < 128).count()
}

#[test]
fn flow_brings_vectors_for_all_neighbours_and_the_script_that_reads_them() {
    let (depth, cx) = (html(&small(), &Context::quiet()), Context::quiet());
    assert!(data(&depth).get("flow").is_none() && data(&depth).get("covers").is_none());
    assert!(!depth.contains("turntable.alongFlow ="));
    let flow = html(&Turntable { interpolate: Interpolation::Flow, ..small() }, &cx);
    assert!(flow.contains("turntable.alongFlow =") && !flow.contains("/*JS*/"));
    let found = data(&flow);
    assert_eq!(found["covers"].as_array().unwrap().len(), 1);
    assert_eq!((found["flow"]["block"].as_u64(), found["flow"]["parts"].as_u64()), (Some(16), Some(4)));
    // Right, left and one more: each of 8 views has three fields, of all blocks that the spans
    // touch.
    let spans = STANDARD.decode(found["spans"].as_str().unwrap()).unwrap();
    let blocks = |view: &[u8]| -> usize {
        let rows = view.as_chunks::<4>().0;
        let in_row = |c: u8, r: &[u8; 4]| {
            [[r[0], r[1]], [r[2], r[3]]].iter().any(|[a, n]| *a < 2 * c + 2 && a + n > 2 * c)
        };
        rows.iter().map(|r| (0..5).filter(|c| in_row(*c, r)).count()).sum()
    };
    let kept: usize = spans.chunks(24).map(blocks).sum();
    assert!(kept > 8);
    assert_eq!(numbers(&found["flow"]["vectors"]), 3 * 2 * kept);
}

#[test]
fn flow_is_the_same_for_any_number_of_threads() {
    let t = Turntable { interpolate: Interpolation::Flow, ..small() };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| html(&t, &Context::quiet()))
    };
    assert!(with(1) == with(3));
}

/// A context whose folder holds a panorama of this size, dark but for a lamp to the wearer's left.
fn with_panorama(folder: &tempfile::TempDir, width: u32, height: u32) -> Context {
    let lamp = |x: u32, y: u32| x > width * 11 / 16 && x < width * 13 / 16 && y < height / 2;
    let room =
        RgbImage::from_fn(width, height, |x, y| image::Rgb(if lamp(x, y) { [255; 3] } else { [40; 3] }));
    room.save(folder.path().join("room.png")).unwrap();
    Context::new("Turntable", folder.path(), toile_core::Cancel::new(), std::sync::Arc::new(()))
}

#[test]
fn a_panorama_stands_in_the_page_and_lights_the_model_from_its_own_side() {
    let folder = tempfile::tempdir().unwrap();
    let cx = with_panorama(&folder, 256, 128);
    let t = Turntable { panorama: Some("room.png".into()), ..small() };
    let page = data(&html(&t, &cx));
    assert!(page["panorama"].as_str().unwrap().starts_with("data:image/jpeg;base64,"));
    assert!(data(&html(&small(), &cx)).get("panorama").is_none());
    let (model, orbit) = (dress::model(), Orbit::around(&dress::model(), 72, 96, TIERS[0]));
    let room = read_panorama("room.png", &cx).unwrap();
    let scene = ModelScene::draft_within(&model, Some(Surroundings::new(&room)), &cx).unwrap();
    let brightness = |turn: f64| {
        let view = scene.cut_outs(&orbit, turn, &[0.0]).remove(0);
        let seen: Vec<u64> = view
            .pixels()
            .filter(|p| p.0[3] == 255)
            .map(|p| p.0[..3].iter().map(|v| u64::from(*v)).sum())
            .collect();
        seen.iter().sum::<u64>() / seen.len() as u64
    };
    let (left, right) = (brightness(std::f64::consts::FRAC_PI_2), brightness(-std::f64::consts::FRAC_PI_2));
    assert!(left > right + 60, "{left} {right}");
}

#[test]
fn a_picture_that_is_no_panorama_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let cx = with_panorama(&folder, 200, 150);
    let t = Turntable { panorama: Some("room.png".into()), ..small() };
    let e = t.run(&dress::model(), &cx).unwrap_err();
    assert_eq!(e.message, "the panorama \"room.png\" is 200 x 150 px, and not twice as wide as high");
    assert_eq!(
        e.hint.unwrap(),
        "a panorama shows 360 degrees across and 180 down (equirectangular projection)"
    );
    let none = Turntable { panorama: Some("none.png".into()), ..small() };
    assert!(none.run(&dress::model(), &cx).unwrap_err().message.starts_with("cannot read \"none.png\""));
}
