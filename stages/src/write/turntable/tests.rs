//! A turntable of the suite's model.
#![allow(clippy::unwrap_used)]

use super::*;
use toile_core::testkit::dress;

fn small() -> Turntable {
    Turntable { views: 4, tiers: 2, size: 96, ..Turntable::default() }
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
    for view in Scene::draft(&model).cut_outs(&orbit, 0.3, &[0.0]) {
        // The suite's mannequin runs out of the picture, its garment does not: nothing of it is at the sides.
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
        cx.take_notes().1,
        [format!(
            "the turntable's page has {kilobytes} kB and not 50, though the quality is lowered to 30: take fewer `views` or `tiers`, or a smaller `size`"
        )]
    );
}
