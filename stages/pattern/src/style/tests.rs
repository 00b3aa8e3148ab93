#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use toile_core::artifact::Outline;
use toile_core::prelude::*;
use toile_fixtures::mannequin;

/// A sample's true outline and its edges' names and lengths in mm.
fn truth(garment: &str, side: &str) -> (Outline, Vec<(String, f64)>) {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../pipelines/samples").join(garment);
    let text = std::fs::read_to_string(base.join(format!("{side}.outline.json"))).unwrap();
    let truth: serde_json::Value = serde_json::from_str(&text).unwrap();
    let point =
        |v: &serde_json::Value| Point2::new(v[0].as_f64().unwrap() / 1e3, v[1].as_f64().unwrap() / 1e3);
    let edges = truth["edges"].as_array().unwrap();
    let corners = edges.iter().map(|e| e["start"].as_u64().unwrap() as usize).collect();
    let lengths = edges
        .iter()
        .map(|e| (e["name"].as_str().unwrap().to_owned(), e["length_mm"].as_f64().unwrap()))
        .collect();
    (outline(truth["outline"].as_array().unwrap().iter().map(point).collect(), corners), lengths)
}

fn outline(points: Vec<Point2>, corners: Vec<usize>) -> Outline {
    Outline {
        outer: Loop { points, corners },
        holes: vec![],
        edges: vec![],
        inner: vec![],
        frame: None,
        lies: vec![],
    }
}

/// Front and back of a sample, each changed by `f`.
fn set(garment: &str, f: impl Fn(Outline) -> Outline) -> Set<Outline> {
    ["front", "back"].iter().map(|s| ((*s).to_owned(), f(truth(garment, s).0))).collect()
}

/// A body of which a style asks no more than where its neck is.
fn body() -> Body {
    Body {
        positions: vec![],
        triangles: vec![],
        landmarks: [("neck_left".to_owned(), Point3::new(0.06, 1.45, 0.0))].into(),
        measurements: BTreeMap::new(),
    }
}

fn style(garment: &str) -> super::Outline {
    let style = match garment {
        "vest" => "(style: Vest)",
        "tshirt" => "(style: TShirt)",
        _ => "()",
    };
    toile_core::param::ron_options().from_str(style).unwrap()
}

fn run(garment: &str, outlines: Set<Outline>) -> Result<(Set<Outline>, SewingPlan), StageError> {
    let (_, outlines, plan) = style(garment).run(outlines, &body(), None, &Context::quiet())?;
    Ok((outlines, plan))
}

/// Names and lengths as in the truth, within `tolerance` mm.
fn assert_named(garment: &str, named: &Set<Outline>, scale: f64, tolerance: f64) {
    for side in ["front", "back"] {
        let found = named.get(side).unwrap();
        let want = truth(garment, side).1;
        assert_eq!(found.edges.len(), want.len());
        for (e, (name, length)) in found.edges.iter().zip(&want) {
            assert_eq!(&e.name, name);
            let is = 1e3 * polyline_length(&found.edge_points(e)) / scale;
            assert!((is - length).abs() < tolerance, "{garment} {side} {name}: {is:.1} for {length:.1} mm");
        }
        // Together they cover the loop.
        let n = found.edges.len();
        assert!((0..n).all(|k| found.edges[k].end == found.edges[(k + 1) % n].start));
    }
}

#[test]
fn samples_get_their_names() {
    for garment in ["vest", "tshirt"] {
        let (named, plan) = run(garment, set(garment, |o| o)).unwrap();
        assert_named(garment, &named, 1.0, 0.1);
        assert_eq!(plan.seams.len(), if garment == "vest" { 4 } else { 6 });
    }
}

#[test]
fn the_style_is_found_and_told() {
    for (garment, word, style) in [("vest", "a vest", "Vest"), ("tshirt", "a T-shirt", "TShirt")] {
        let cx = Context::quiet();
        let (_, named, _) = super::Outline::default().run(set(garment, |o| o), &body(), None, &cx).unwrap();
        assert_named(garment, &named, 1.0, 0.1);
        let note =
            format!("the outlines are taken for {word}; to say what they are: --set 'style.style={style}'");
        assert_eq!(cx.take_remarks().notes[0], note);
    }
}

#[test]
fn pieces_stand_upright_with_their_necks_at_the_bodys() {
    let turn = nalgebra::Rotation2::new(9f64.to_radians());
    let askew = |o: Outline| {
        let to = |p: &Point2| Point2::from(turn * p.coords) + Vector2::new(3.0, -2.0);
        outline(o.outer.points.iter().map(to).collect(), o.outer.corners)
    };
    for garment in ["vest", "tshirt"] {
        let (pattern, named, _) =
            style(garment).run(set(garment, askew), &body(), None, &Context::quiet()).unwrap();
        for (side, before) in [("front", true), ("back", false)] {
            let pose = pattern.piece(side).unwrap().pose.unwrap();
            assert_eq!(pose.outside().z > 0.99, before);
            let outline = named.get(side).unwrap();
            let neck = outline.edge("neck").unwrap();
            let [a, b] = [neck.start, neck.end].map(|i| pose.at(outline.outer.points[i]));
            let middle = nalgebra::center(&a, &b);
            assert!(middle.x.abs() < 3e-3 && (middle.y - 1.46).abs() < 6e-3, "{garment} {side}: {middle}");
            assert!((a.y - b.y).abs() < 3e-3, "{garment} {side}: {a} {b}");
        }
    }
}

#[test]
fn corners_may_be_missing() {
    let bare = |o: Outline| outline(o.outer.points, vec![]);
    for garment in ["vest", "tshirt"] {
        let (named, _) = run(garment, set(garment, bare)).unwrap();
        assert_named(garment, &named, 1.0, 8.0);
    }
}

#[test]
fn corners_may_be_too_many() {
    let many = |o: Outline| {
        let n = o.outer.points.len();
        let extra = (0..n).step_by(n / 23).filter(|i| o.outer.corners.iter().all(|c| c.abs_diff(*i) > 40));
        let mut corners: Vec<usize> = o.outer.corners.iter().copied().chain(extra).collect();
        corners.sort_unstable();
        outline(o.outer.points, corners)
    };
    for garment in ["vest", "tshirt"] {
        let (named, _) = run(garment, set(garment, many)).unwrap();
        assert_named(garment, &named, 1.0, 0.1);
    }
}

#[test]
fn garments_may_lie_askew_and_be_of_any_size() {
    for (degrees, scale) in [(-15.0f64, 1.0), (-6.0, 0.4), (9.0, 1.7), (15.0, 1.0)] {
        let turn = nalgebra::Rotation2::new(degrees.to_radians());
        let moved = |o: Outline| {
            let to = |p: &Point2| Point2::from(turn * p.coords * scale) + Vector2::new(3.0, -2.0);
            outline(o.outer.points.iter().map(to).collect(), o.outer.corners)
        };
        for garment in ["vest", "tshirt"] {
            let (named, _) = run(garment, set(garment, moved)).unwrap();
            assert_named(garment, &named, scale, 0.1);
        }
    }
}

#[test]
fn the_loops_start_does_not_matter() {
    let rolled = |o: Outline| {
        let (mut points, n) = (o.outer.points, 777);
        let count = points.len();
        points.rotate_left(n % count);
        let mut corners: Vec<usize> =
            o.outer.corners.iter().map(|c| (c + count - n % count) % count).collect();
        corners.sort_unstable();
        outline(points, corners)
    };
    for garment in ["vest", "tshirt"] {
        assert_named(garment, &run(garment, set(garment, rolled)).unwrap().0, 1.0, 0.1);
    }
}

#[test]
fn sewn_edges_are_divided_alike() {
    let (named, plan) = run("vest", set("vest", |o| o)).unwrap();
    let gauge = |e: &EdgeRef| named.get(&e.panel).unwrap().edge(&e.edge).unwrap().gauge;
    for seam in &plan.seams {
        assert_eq!(gauge(&seam.a), gauge(&seam.b), "{}", seam.name());
        assert_eq!(gauge(&seam.a).divisions(0.012), gauge(&seam.b).divisions(0.012));
    }
    let gauge = |edge: &str| named.get("front").unwrap().edge(edge).unwrap().gauge;
    let finer = |edge: &str| gauge(edge).divisions(0.016) as f64 / (gauge(edge).length / 0.016);
    assert!(finer("armhole_left") > 1.2, "the armhole bends: {}", finer("armhole_left"));
    assert!(finer("shoulder_left") < 1.2, "the shoulder is straight: {}", finer("shoulder_left"));
}

#[test]
fn a_panel_alone_is_named_and_told() {
    let cx = Context::quiet();
    let only: Set<Outline> = [("front".to_owned(), truth("vest", "front").0)].into_iter().collect();
    let (_, named, plan) = style("vest").run(only, &body(), None, &cx).unwrap();
    assert_eq!(named.get("front").unwrap().edges.len(), 8);
    assert!(plan.seams.is_empty());
    assert_eq!(
        cx.take_remarks().warnings,
        ["the panel \"front\" has no partner and stays unsewn; give a photo of the other side, or \
          `MirrorOf(\"front\")` in its place"]
    );
}

fn polygon(points: &[[f64; 2]]) -> Outline {
    let n = points.len();
    let side = |i: usize| {
        let (a, b) = (points[i], points[(i + 1) % n]);
        (0..40).map(move |k| {
            let t = f64::from(k) / 40.0;
            Point2::new((a[0] + (b[0] - a[0]) * t) / 1e3, (a[1] + (b[1] - a[1]) * t) / 1e3)
        })
    };
    outline((0..n).flat_map(side).collect(), (0..n).map(|i| 40 * i).collect())
}

fn refusal(garment: &str, front: Outline) -> String {
    let found = run(garment, [("front".to_owned(), front)].into_iter().collect());
    found.err().map_or_else(|| "it is taken".to_owned(), |e| e.message)
}

#[test]
fn a_style_says_why_it_does_not_fit() {
    let trousers = [
        [250.0, 0.0],
        [210.0, 1000.0],
        [-210.0, 1000.0],
        [-250.0, 0.0],
        [-90.0, 0.0],
        [0.0, 700.0],
        [90.0, 0.0],
    ];
    let skirt = [[300.0, 0.0], [180.0, 600.0], [-180.0, 600.0], [-300.0, 0.0]];
    let lopsided =
        [[300.0, 0.0], [300.0, 120.0], [-150.0, 120.0], [-150.0, 900.0], [-300.0, 900.0], [-300.0, 0.0]];
    let flat = outline(vec![Point2::origin(); 30], vec![]);
    let said = [
        refusal("vest", polygon(&trousers)),
        refusal("tshirt", polygon(&trousers)),
        refusal("either", polygon(&trousers)),
        refusal("vest", truth("tshirt", "front").0),
        refusal("tshirt", truth("vest", "front").0),
        refusal("vest", polygon(&skirt)),
        refusal("vest", polygon(&lopsided)),
        refusal("vest", flat),
    ];
    let neither = "the outlines are neither those of a vest nor those of a T-shirt";
    let no_vest = "\"front\" does not look like a vest: its sides run up to the shoulders without an armhole";
    let no_shirt = "\"front\" does not look like a T-shirt: its sides run up without an armpit";
    let sleeves =
        "\"front\" does not look like a vest: its shoulders reach far beyond its armpits, as sleeves do";
    let no_half = "the garment in \"front\" has no left and right half";
    assert_eq!(said, [no_vest, no_shirt, neither, sleeves, no_shirt, no_vest, no_vest, no_half]);
    let e = run("vest", [("front".to_owned(), polygon(&trousers))].into_iter().collect()).unwrap_err();
    let lay = "lay the garment flat and smooth, neck or waist up, sleeves and legs away from the body, all of it in the picture";
    let named = format!("{lay}; or let it be named: --set 'style.style=Auto'");
    assert_eq!(e.hint, Some(named));
    let e = run("either", [("front".to_owned(), polygon(&trousers))].into_iter().collect()).unwrap_err();
    let other = format!("{lay}; other garments are cut by a template: --set 'style=Block(style: Auto)'");
    assert_eq!(e.hint, Some(other));
}

#[test]
fn an_outline_that_is_too_small_for_the_body_is_refused() {
    let mut wide = body();
    wide.measurements.insert("bust".to_owned(), 1.3);
    let e = style("vest").run(set("vest", |o| o), &wide, None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "the garment is too small: its chest measures 99 cm around, the body's 130 cm");
    assert_eq!(
        e.hint.as_deref(),
        Some(
            "is the scale right? The garment is measured by it. If it is, take a mannequin that it fits: --set 'body=Fitting(style: Vest)'"
        )
    );
}

fn edge(text: &str) -> EdgeRef {
    EdgeRef::try_from(text.to_owned()).unwrap()
}

fn sewn(entries: Vec<SeamEntry>) -> Result<(Set<Outline>, SewingPlan), StageError> {
    let (named, plan) = run("vest", set("vest", |o| o)).unwrap();
    Seams::of(entries).run(named, &plan, &Context::quiet())
}

fn fault(entry: fn(EdgeRef, EdgeRef) -> SeamEntry, a: &str, b: &str) -> (String, String) {
    let e = sewn(vec![entry(edge(a), edge(b))]).unwrap_err();
    assert_eq!(e.code, ErrorCode::InvalidInput);
    (e.message, e.hint.unwrap_or_default())
}

#[test]
fn listed_seams_replace_the_styles() {
    let (_, plan) = sewn(vec![SeamEntry::Match(edge("front.side_left"), edge("back.side_left"))]).unwrap();
    assert_eq!(plan.seams.iter().map(Seam::name).collect::<Vec<_>>(), ["front.side_left + back.side_left"]);
    let text = r#"(seams: [Match("front.side_left", "back.side_left"), Gather("front.hem", "back.hem")])"#;
    let read: Seams = toile_core::param::ron_options().from_str(text).unwrap();
    assert_eq!(
        read,
        Seams::of(vec![
            SeamEntry::Match(edge("front.side_left"), edge("back.side_left")),
            SeamEntry::Gather(edge("front.hem"), edge("back.hem")),
        ])
    );
}

#[test]
fn unknown_names_are_told_with_the_nearest() {
    let (text, hint) = fault(SeamEntry::Match, "front.side_lft", "back.side_left");
    assert_eq!(text, "the panel \"front\" has no edge \"side_lft\"");
    assert_eq!(hint, "did you mean \"front.side_left\"?");
    let (text, hint) = fault(SeamEntry::Match, "front.side_left", "bak.side_left");
    assert_eq!(text, "there is no panel \"bak\"");
    assert_eq!(hint, "did you mean \"back.side_left\"?");
    let (_, hint) = fault(SeamEntry::Match, "front.zzzzzz", "back.side_left");
    assert!(hint.starts_with("known are side_left, armhole_left, "), "{hint}");
}

#[test]
fn very_different_lengths_are_refused_unless_gathered() {
    let (text, hint) = fault(SeamEntry::Match, "front.shoulder_left", "back.side_left");
    assert_eq!(
        text,
        "front.shoulder_left is 100.0 mm long, back.side_left 346.1 mm: they differ by 71.1 %, too much to be sewn flat"
    );
    assert_eq!(
        hint,
        "if the longer one is meant to be gathered, write Gather(\"front.shoulder_left\", \"back.side_left\")"
    );
    let gathered = SeamEntry::Gather(edge("front.armhole_left"), edge("back.armhole_left"));
    assert!(sewn(vec![gathered]).is_ok());
}

#[test]
fn reversed_seams_are_refused() {
    let (text, hint) = fault(SeamEntry::Match, "front.side_left", "back.side_right");
    assert_eq!(
        text,
        "the seam front.side_left + back.side_right is reversed: its threads would cross between the panels"
    );
    assert!(hint.ends_with("write Reversed(\"front.side_left\", \"back.side_right\")"), "{hint}");
    let (text, _) = fault(SeamEntry::Reversed, "front.side_left", "back.side_left");
    assert_eq!(
        text,
        "the seam front.side_left + back.side_left is reversed: its threads would cross between the panels"
    );
}

#[test]
fn an_edge_is_sewn_once() {
    let twice = |b: &str| SeamEntry::Match(edge("front.side_left"), edge(b));
    let e = sewn(vec![twice("back.side_left"), twice("back.side_left")]).unwrap_err();
    assert_eq!(e.message, "the edge front.side_left stands in more than one seam");
    let e = sewn(vec![twice("front.side_left")]).unwrap_err();
    assert_eq!(e.message, "the edge front.side_left stands in more than one seam");
}

#[test]
fn small_differences_are_eased_with_a_word() {
    let cx = Context::quiet();
    let mut outlines: BTreeMap<String, Outline> =
        set("vest", |o| o).iter().map(|(k, o)| (k.to_owned(), o.clone())).collect();
    // A back that is 2 % larger.
    let back = outlines.get_mut("back").unwrap();
    back.outer.points.iter_mut().for_each(|p| *p *= 1.02);
    style("vest").run(outlines.into_iter().collect(), &body(), None, &cx).unwrap();
    assert_eq!(
        cx.take_remarks().notes[0],
        "front.shoulder_left is 100.0 mm long, back.shoulder_left 102.0 mm; the longer one is eased in by 2.0 %"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Star-shaped outlines of any kind get names that cover them, or an error.
    #[test]
    fn no_outline_makes_a_style_panic(
        radii in prop::collection::vec(0.001..1.0f64, 3..60),
        corners in prop::collection::vec(0usize..60, 0..9),
        vest in any::<bool>(),
    ) {
        let n = radii.len();
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let points = (0..n).map(|i| Point2::new(radii[i] * angle(i).cos(), radii[i] * angle(i).sin())).collect();
        let mut corners: Vec<usize> = corners.into_iter().filter(|c| *c < n).collect();
        corners.sort_unstable();
        corners.dedup();
        let both: Set<Outline> =
            ["front", "back"].iter().map(|s| ((*s).to_owned(), outline(Vec::clone(&points), corners.clone()))).collect();
        if let Ok((named, _)) = run(if vest { "vest" } else { "tshirt" }, both) {
            for (_, o) in named.iter() {
                let count = o.edges.len();
                prop_assert!((0..count).all(|k| o.edges[k].end == o.edges[(k + 1) % count].start));
            }
        }
    }
}

/// The warnings about a T-shirt on a mannequin.
fn warnings(body: &str) -> Vec<String> {
    let cx = Context::quiet();
    style("tshirt").run(set("tshirt", |o| o), &mannequin(body).unwrap(), None, &cx).unwrap();
    cx.take_remarks().warnings
}

#[test]
fn sleeves_take_the_arms_between_them() {
    assert_eq!(warnings("()"), Vec::<String>::new());
    let hanging = warnings("(arm_angle: 30)");
    let start = "the seam front.underarm_left + back.underarm_left starts with the body between ";
    let end = " % of it; arms spread like the sleeves would free it (the mannequin's `arm_angle`)";
    assert!(hanging[0].starts_with(start) && hanging[0].ends_with(end), "{hanging:?}");
}

#[test]
fn an_outline_that_the_frame_cuts_is_refused() {
    // The outline lies 400 px wide, and its hem on the lower side of the photo.
    let low = |o: &Outline| o.outer.points.iter().fold(0.0, |low: f64, p| low.min(p.y));
    let framed = |o: Outline| {
        let origin_px = Point2::new(400.0, 600.0 + 500.0 * low(&o));
        let frame = PhotoFrame { origin_px, px_per_metre: 500.0, mirrored: false, turn: 0.0 };
        Outline { frame: Some(frame), ..o }
    };
    let photo = |high: u32| {
        let pixels = Shared::new(image::RgbImage::new(800, high));
        let photo = Photo { pixels, ..toile_core::testkit::shapes::photo() };
        [("front".to_owned(), photo)].into_iter().collect::<Set<Photo>>()
    };
    let run =
        |high: u32| style("vest").run(set("vest", framed), &body(), Some(photo(high)), &Context::quiet());
    run(700).unwrap();
    let e = run(600).unwrap_err();
    assert_eq!(e.to_string(), "the frame cuts \"front\", and its outline would be cut as it ends there");
    assert_eq!(
        e.hint.unwrap(),
        "photograph the garment with ground on all four sides; or let one half complete the other: --set 'style=Block()'"
    );
}
