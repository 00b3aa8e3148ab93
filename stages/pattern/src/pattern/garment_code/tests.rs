//! Files of our own making: lengths from closed forms, repairs, and every refusal word for word.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::*;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path as FilePath;
use toile_core::Cancel;

fn straight(ends: &[[usize; 2]]) -> Value {
    ends.iter().map(|e| json!({ "endpoints": e })).collect()
}

/// A rectangle, counter-clockwise from its lower left corner: edges 0 below, 1 right, 2 above, 3
/// left.
fn rectangle(w: f64, h: f64, at: [f64; 3]) -> Value {
    json!({
        "translation": at, "rotation": [0, 0, 0], "label": "body",
        "vertices": [[0, 0], [w, 0], [w, h], [0, h]],
        "edges": straight(&[[0, 1], [1, 2], [2, 3], [3, 0]]),
    })
}

/// The same, clockwise as a panel behind the body: edges 0 left, 1 above, 2 right, 3 below, as seen
/// from the front.
fn back(w: f64, h: f64, at: [f64; 3]) -> Value {
    json!({
        "translation": at, "rotation": [0, 0, 0], "label": "body",
        "vertices": [[0, 0], [0, h], [w, h], [w, 0]],
        "edges": straight(&[[0, 1], [1, 2], [2, 3], [3, 0]]),
    })
}

fn side(panel: &str, edge: usize) -> Value {
    json!({ "panel": panel, "edge": edge })
}

fn stitch(a: (&str, usize), b: (&str, usize)) -> Value {
    json!([side(a.0, a.1), side(b.0, b.1)])
}

fn file(panels: Value, stitches: Value) -> Value {
    json!({
        "pattern": { "panels": panels, "stitches": stitches },
        "properties": { "units_in_meter": 100, "curvature_coords": "relative" },
    })
}

/// A front and a back, sewn at both sides.
fn tube() -> Value {
    let panels = json!({ "front": rectangle(50.0, 60.0, [-25.0, 80.0, 20.0]), "back": back(50.0, 60.0, [-25.0, 80.0, -20.0]) });
    file(panels, json!([stitch(("front", 1), ("back", 2)), stitch(("front", 3), ("back", 0))]))
}

/// The pattern and the remarks on it, warnings first; of several faults the first.
fn read(file: &Value) -> Result<(Pattern, Vec<String>), SpecificationDamage> {
    let read = pattern(file.to_string().as_bytes(), "test").map_err(|mut all| all.remove(0));
    read.map(|(pattern, told)| (pattern, [told.warnings, told.notes].concat()))
}

fn lengths(p: &Piece) -> Vec<f64> {
    (0..p.outer.edges.len()).map(|k| p.outer.path(k).length()).collect()
}

#[test]
fn every_kind_of_curve_has_the_length_of_its_closed_form_in_any_unit() {
    // A parabola over its chord: control half a chord below its middle, as y = x^2 over [-1/2,
    // 1/2].
    let parabola = 2.0_f64.sqrt() / 2.0 + 1.0_f64.asinh() / 2.0;
    let third = 1.0 / 3.0;
    for units in [100.0, 300.0] {
        // A side of 0.4 m, whichever the unit.
        let s = 0.4 * units;
        let edges = json!([
            { "endpoints": [0, 1], "curvature": [0.5, -0.5] },
            { "endpoints": [1, 2], "curvature": { "type": "quadratic", "params": [[0.5, -0.5]] } },
            { "endpoints": [2, 3], "curvature": { "type": "cubic", "params": [[third, -third], [2.0 * third, -third]] } },
            { "endpoints": [3, 4], "curvature": { "type": "circle", "params": [s / 2.0_f64.sqrt(), 0, 1] } },
            { "endpoints": [4, 5], "curvature": { "type": "circle", "params": [s * 0.5, false, true] } },
            { "endpoints": [5, 0], "curvature": null },
        ]);
        let panel = json!({
            "translation": [0, 0, 0], "rotation": [0, 0, 0], "edges": edges,
            "vertices": [[0, 0], [s, 0], [s, s], [0, s], [-s, s], [-s, 0]],
        });
        let mut f = file(json!({ "p": panel }), json!([]));
        f["properties"]["units_in_meter"] = json!(units);
        let (p, told) = read(&f).unwrap();
        assert_eq!(told, Vec::<String>::new());
        let exact =
            [0.4 * parabola, 0.4 * parabola, 0.4 * parabola, 0.4 * PI / 2.0_f64.sqrt() / 2.0, 0.2 * PI, 0.4];
        for (found, exact) in lengths(&p.pieces[0]).into_iter().zip(exact) {
            assert!((found - exact).abs() < 1e-9, "{found} for {exact} at {units}");
        }
        let kinds: Vec<&str> = p.pieces[0].outer.edges.iter().map(|e| e.curve.word()).collect();
        assert_eq!(kinds, ["quadratic", "quadratic", "cubic", "arc", "arc", "line"]);
    }
}

#[test]
fn arcs_bulge_to_the_side_that_the_flags_say() {
    // On the lower edge of a counter-clockwise loop, an arc to the `right` bulges out of the panel.
    for (large, right) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let mut panel = rectangle(40.0, 200.0, [0.0; 3]);
        // A large arc that bulges inwards is wider than its chord.
        panel["vertices"] = json!([[0, 0], [40, 0], [240, 200], [-200, 200]]);
        panel["edges"][0]["curvature"] = json!({ "type": "circle", "params": [25.0, large, right] });
        let (p, _) = read(&file(json!({ "p": panel }), json!([]))).unwrap();
        let path = p.pieces[0].outer.path(0);
        let half = 0.8_f64.asin();
        let angle = if large == 1 { 2.0 * PI - 2.0 * half } else { 2.0 * half };
        assert!((path.length() - 0.25 * angle).abs() < 1e-9);
        assert_eq!(path.at(path.length() / 2.0).y < 0.0, right == 1, "{large} {right}");
    }
}

#[test]
fn control_points_may_be_given_in_the_panels_coordinates() {
    let mut f = tube();
    f["pattern"]["panels"]["front"]["edges"][0]["curvature"] =
        json!({ "type": "quadratic", "params": [[25.0, -5.0]] });
    f["properties"]["curvature_coords"] = json!("absolute");
    let (p, _) = read(&f).unwrap();
    assert_eq!(
        p.piece("front").unwrap().outer.edges[0].curve,
        EdgeCurve::Quadratic { control: Point2::new(0.25, -0.05) }
    );
}

/// The points of a seam's side in space, from its start to its end.
fn in_space(p: &Pattern, side: &[EdgeUse]) -> [Point3; 2] {
    let piece = p.piece(&side[0].edge.panel).unwrap();
    let path = piece.path(&side[0].edge.edge).unwrap();
    let pose = piece.pose.unwrap();
    let mut ends = [pose.at(path.at(0.0)), pose.at(path.at(path.length()))];
    if side[0].reversed {
        ends.reverse();
    }
    ends
}

#[test]
fn a_clockwise_panel_is_turned_to_be_seen_from_outside_and_its_stitches_keep_their_ends() {
    let mut f = tube();
    f["pattern"]["panels"]["back"]["edges"][1]["curvature"] = json!([0.5, 0.1]);
    f["pattern"]["panels"]["back"]["edges"][1]["label"] = json!("neck");
    let (p, told) = read(&f).unwrap();
    assert_eq!(told, Vec::<String>::new());
    let back = p.piece("back").unwrap();
    assert_eq!(back.pose.unwrap().outside(), -Vector3::z());
    assert_eq!(p.piece("front").unwrap().pose.unwrap().outside(), Vector3::z());
    assert!(polygon_area(&back.outer.points().0) > 0.0);
    let names: Vec<&str> = back.outer.edges.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["edge_0", "neck", "edge_2", "edge_3"]);
    // The neck was drawn above the straight line, and is.
    let neck = back.path("neck").unwrap();
    assert!((back.pose.unwrap().at(neck.at(neck.length() / 2.0)).y - 1.425).abs() < 1e-9);
    for seam in &p.seams {
        let [a, b] = [0, 1].map(|k| in_space(&p, &seam.sides[k]));
        assert!((a[0].y - b[0].y).abs() < 1e-12 && (a[0].x - b[0].x).abs() < 1e-12, "{}", seam.name);
        assert!((a[1].y - b[1].y).abs() < 1e-12);
    }
    let lowered = p.lower().unwrap();
    assert_eq!(lowered.plan.seams[0].name(), "front.edge_1 + back.edge_2");
    assert!(!lowered.plan.seams[0].reversed);
}

#[test]
fn a_rotation_turns_about_x_then_y_then_z() {
    let mut f = tube();
    f["pattern"]["panels"]["front"]["rotation"] = json!([90.0, 90.0, 0.0]);
    f["pattern"]["stitches"] = json!([]);
    let (p, _) = read(&f).unwrap();
    let pose = p.piece("front").unwrap().pose.unwrap();
    // x to z, then against z; y to z, then to x.
    assert!((pose.across + Vector3::z()).norm() < 1e-12, "{}", pose.across);
    assert!((pose.along - Vector3::x()).norm() < 1e-12, "{}", pose.along);
    assert!((pose.origin - Point3::new(-0.25, 0.8, 0.2)).norm() < 1e-12);
}

/// A panel with a dart as a notch of its lower edge, between edges 1 and 2.
fn darted() -> Value {
    json!({
        "translation": [0, 0, 0], "rotation": [0, 0, 0],
        "vertices": [[0, 0], [20, 0], [22, 12], [24, 0], [44, 0], [44, 40], [0, 40]],
        "edges": straight(&[[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6], [6, 0]]),
    })
}

#[test]
fn the_legs_of_a_dart_are_a_dart_and_meet_at_its_tip() {
    for word in [None, Some("right_wrong")] {
        let mut dart = stitch(("p", 1), ("p", 2));
        dart.as_array_mut().unwrap().extend(word.map(|w| json!(w)));
        let (p, told) = read(&file(json!({ "p": darted() }), json!([dart]))).unwrap();
        assert_eq!(p.seams[0].kind, SeamKind::Dart);
        let tip = |side: &[EdgeUse]| {
            let path = p.pieces[0].path(&side[0].edge.edge).unwrap();
            if side[0].reversed { path.at(0.0) } else { path.at(path.length()) }
        };
        assert!((tip(&p.seams[0].sides[0]) - tip(&p.seams[0].sides[1])).norm() < 1e-12);
        let turned = "stitch 0 (edge 1 of \"p\" to edge 2 of \"p\") runs the wrong way: turned";
        assert_eq!(told, word.map(|_| turned).into_iter().collect::<Vec<_>>());
    }
}

#[test]
fn a_stitch_against_its_mirror_image_or_its_place_is_turned() {
    // Both sides of a tube are mirror images of each other.
    let mut f = tube();
    f["pattern"]["stitches"][1].as_array_mut().unwrap().push(json!("right_wrong"));
    let (p, told) = read(&f).unwrap();
    assert_eq!(told, ["stitch 1 (edge 3 of \"front\" to edge 0 of \"back\") runs the wrong way: turned"]);
    assert!(!p.lower().unwrap().plan.seams[1].reversed);
    // One side has none; its place decides.
    f["pattern"]["stitches"].as_array_mut().unwrap().remove(0);
    assert_eq!(
        read(&f).unwrap().1,
        ["stitch 0 (edge 3 of \"front\" to edge 0 of \"back\") runs the wrong way: turned"]
    );
    // Both turned alike: that is meant.
    let mut f = tube();
    for k in 0..2 {
        f["pattern"]["stitches"][k].as_array_mut().unwrap().push(json!("right_wrong"));
    }
    let (p, told) = read(&f).unwrap();
    assert_eq!(told, Vec::<String>::new());
    assert!(p.lower().unwrap().plan.seams.iter().all(|s| s.reversed));
}

#[test]
fn a_back_that_was_copied_from_its_front_is_turned_over_where_it_stands() {
    let mut f = tube();
    f["pattern"]["panels"]["back"] = rectangle(50.0, 60.0, [-25.0, 80.0, -20.0]);
    f["pattern"]["panels"]["back"]["edges"][2]["curvature"] = json!([0.3, 0.1]);
    f["pattern"]["stitches"] = json!([stitch(("front", 1), ("back", 1)), stitch(("front", 3), ("back", 3))]);
    let (p, told) = read(&f).unwrap();
    let over = "panel \"back\" stands inside out: it looks at the wearer, and its stitches run side by side with what they are sewn to; it is turned over where it stands";
    assert_eq!(told, [over]);
    let back = p.piece("back").unwrap();
    assert_eq!(back.pose.unwrap().outside(), -Vector3::z());
    assert!(polygon_area(&back.outer.points().0) > 0.0, "seen from outside it runs counter-clockwise");
    // Its upper edge is drawn downwards by the file where that stands, from right to left.
    let upper = back.path("edge_2").unwrap();
    let ends = [0.0, upper.length()].map(|at| back.pose.unwrap().at(upper.at(at)));
    assert!(
        ends.iter().all(|e| (e.y - 1.4).abs() < 1e-12) && (ends[0].x - ends[1].x).abs() > 0.49,
        "{ends:?}"
    );
    for seam in &p.seams {
        let [a, b] = [0, 1].map(|k| in_space(&p, &seam.sides[k]));
        assert!((a[0].y - b[0].y).abs() < 1e-12 && (a[0].x - b[0].x).abs() < 1e-12, "{}", seam.name);
        assert!((a[1].y - b[1].y).abs() < 1e-12);
    }
    // A panel behind the wearer that looks away from them keeps what its file says.
    let (p, told) = read(&tube()).unwrap();
    assert_eq!((told, p.pieces.len()), (vec![], 2));
}

#[test]
fn stitches_of_which_the_wrong_one_is_not_certain_are_refused() {
    // The front lies flat: its sides run across those of the back, and nothing says which of the
    // two is meant.
    refused(
        |f| {
            f["pattern"]["panels"]["front"]["rotation"] = json!([90, 0, 0]);
            f["pattern"]["stitches"][1].as_array_mut().unwrap().push(json!("right_wrong"));
        },
        "stitches 0 and 1 are mirror images of each other and run in opposite ways",
        "take \"right_wrong\" out of one of them, or give it to both",
    );
    // Three sides of one panel run against what they are sewn to.
    let around = json!({
        "front": rectangle(50.0, 60.0, [300.0, 0.0, 0.0]),
        "right": rectangle(50.0, 60.0, [360.0, 0.0, 0.0]),
        "top": rectangle(50.0, 60.0, [300.0, 70.0, 0.0]),
        "low": rectangle(50.0, 60.0, [300.0, -70.0, 0.0]),
    });
    let sewn = [("right", 1, 3), ("top", 2, 0), ("low", 0, 2)]
        .map(|(other, a, b)| json!([side("front", a), side(other, b), "right_wrong"]));
    refused(
        |f| *f = file(around.clone(), json!(sewn)),
        "3 stitches of panel \"front\" run against the way in which it is placed",
        "correct the panel's `rotation`, or the stitches",
    );
}

#[test]
fn a_vertex_far_from_its_panel_is_no_wrong_unit() {
    refused(
        |f| f["pattern"]["panels"]["front"]["vertices"][2] = json!([5000, 60]),
        "panel \"front\" is 50.00 m long, the others at most 0.60 m",
        "correct its vertices",
    );
}

#[test]
fn small_damage_is_repaired_and_told() {
    let told = |change: &dyn Fn(&mut Value)| {
        let mut f = tube();
        change(&mut f);
        read(&f).unwrap()
    };
    // A loop that is open by half a millimetre.
    let (p, said) = told(&|f| {
        let front = &mut f["pattern"]["panels"]["front"];
        front["vertices"].as_array_mut().unwrap().push(json!([50.05, 0]));
        front["edges"][1]["endpoints"][0] = json!(4);
    });
    assert_eq!(said, ["the loop of panel \"front\" was open by 0.500 mm between edges 0 and 1: closed"]);
    assert_eq!(p.pieces.iter().find(|p| p.name == "front").unwrap().outer.corners.len(), 4);
    // A stitch that stands twice.
    let (p, said) =
        told(&|f| f["pattern"]["stitches"].as_array_mut().unwrap().push(stitch(("back", 2), ("front", 1))));
    assert_eq!(said, ["stitch 2 (edge 2 of \"back\" to edge 1 of \"front\") is stitch 0 again: left out"]);
    assert_eq!(p.seams.len(), 2);
    // Units that cannot be.
    let (p, said) = told(&|f| f["properties"]["units_in_meter"] = json!(1));
    assert_eq!(
        said,
        [
            "with 1 units in a metre the largest panel is 60.000 m long: read with 100.0000 units in a metre, 0.600 m"
        ]
    );
    assert!((lengths(p.piece("front").unwrap())[0] - 0.5).abs() < 1e-12);
    // Half a circle of a skirt is wider than most garments, and the unit is stated.
    let (p, said) = told(&|f| {
        for panel in ["front", "back"] {
            for v in f["pattern"]["panels"][panel]["vertices"].as_array_mut().unwrap() {
                let (x, y) = (v[0].as_f64().unwrap(), v[1].as_f64().unwrap());
                *v = json!([9.57 * x, 9.57 * y]);
            }
        }
    });
    assert_eq!(said, Vec::<String>::new());
    assert!((lengths(p.piece("front").unwrap())[1] - 5.742).abs() < 1e-9);
    // Places that were never set are none.
    let (p, said) = told(&|f| {
        for panel in ["front", "back"] {
            f["pattern"]["panels"][panel]["translation"] = json!([0, 0, 0]);
            f["pattern"]["panels"][panel]["rotation"] = json!([0, 0, 0]);
        }
    });
    assert_eq!(said, [super::ONE_PLACE]);
    assert!(p.pieces.iter().all(|piece| piece.pose.is_none()));
    let (_, said) = told(&|f| drop(f.as_object_mut().unwrap().remove("properties")));
    assert_eq!(said, ["the file does not say its units: read as centimetres"]);
    // An edge that runs against the loop, and one without length.
    let (p, said) = told(&|f| {
        let front = &mut f["pattern"]["panels"]["front"];
        front["edges"][1] = json!({ "endpoints": [2, 1], "curvature": [0.5, 0.1] });
        front["edges"].as_array_mut().unwrap().push(json!({ "endpoints": [0, 0] }));
        f["pattern"]["stitches"] = json!([]);
    });
    assert_eq!(said, ["edge 4 of panel \"front\" has no length: left out"]);
    // Drawn upside down, it bulges to the left of its own way: out of the panel.
    let edge = p.piece("front").unwrap().path("edge_1").unwrap();
    assert!((edge.at(edge.length() / 2.0).x - 0.53).abs() < 1e-9, "{}", edge.at(edge.length() / 2.0));
    let (_, said) = told(&|f| f["pattern"]["panels"]["front"]["label"] = json!("tail"));
    assert_eq!(said, ["panel \"front\" has the label \"tail\", which is no part of the body"]);
    let (p, said) = told(&|f| {
        f["pattern"]["panels"]["front"]["edges"][0]["curvature"] =
            json!({ "type": "circle", "params": [10, 0, 1] });
    });
    assert_eq!(
        said,
        ["edge 0 of panel \"front\" is an arc of radius 100.00 mm over 500.00 mm: taken as a half circle"]
    );
    assert!((p.piece("front").unwrap().path("edge_0").unwrap().length() - 0.25 * PI).abs() < 1e-12);
}

#[test]
fn edges_are_called_by_their_labels() {
    let mut f = tube();
    for (k, label) in [(0, "hem"), (1, "seam"), (3, "seam")] {
        f["pattern"]["panels"]["front"]["edges"][k]["label"] = json!(label);
    }
    let (p, _) = read(&f).unwrap();
    let names: Vec<&str> = p.piece("front").unwrap().outer.edges.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["hem", "seam_1", "edge_2", "seam_2"]);
    assert_eq!(p.pieces[0].name, "back", "pieces stand in the order of the file, which json! sorts");
}

/// What a damaged file is refused with: the sentence, then the remedy.
#[track_caller]
fn refused(change: impl Fn(&mut Value), sentence: &str, remedy: &str) {
    let mut f = tube();
    change(&mut f);
    let d = read(&f).unwrap_err();
    assert_eq!((d.to_string().as_str(), d.remedy().as_str()), (sentence, remedy));
}

#[test]
fn damage_of_the_files_form_is_refused_with_its_place() {
    let text = |bytes: &[u8]| {
        let d = pattern(bytes, "test").unwrap_err().remove(0);
        (d.to_string(), d.remedy())
    };
    let again = "write the file again with the program that made it".to_owned();
    assert_eq!(
        text(b"{\n \"pattern\": [1,\n}"),
        ("it is no JSON: expected value at line 3 column 1".into(), again)
    );
    assert_eq!(
        text(b" \n"),
        ("it is empty".into(), "give the file that GarmentCode wrote, a `_specification.json`".into())
    );
    let wide: Vec<u8> = "{\"pattern\": {}}".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let wide = (text(&wide), text(&[&[0xff, 0xfe], &wide[..]].concat()));
    let saved = ("it is text of 16 bits a letter (UTF-16)".to_owned(), "save it as UTF-8".to_owned());
    assert_eq!(wide, (saved.clone(), saved));
    assert_eq!(
        text(b"{\n // front and back\n \"pattern\": {}}"),
        ("a comment stands at line 2 column 2".into(), "JSON has no comments: take it out".into())
    );
    assert_eq!(
        text(b"{\"pattern\": {\n\"x\": NaN}}"),
        (
            "NaN at line 2 column 6 is no number".into(),
            "give the number that is meant; JSON knows no such word".into()
        )
    );
    let form = "GarmentCode writes `pattern` with `panels` and `stitches`, and `properties`; is it a `_specification.json`?";
    assert_eq!(text(b"{}"), ("the file has no `pattern`".into(), form.to_owned()));
    let write = |what: &str| format!("write {what} there, as GarmentCode does");
    assert_eq!(text(b"[]"), ("the file is a list, an object is wanted".into(), write("an object")));
    refused(
        |f| f["pattern"]["panels"] = json!({}),
        "there are no panels",
        "draft the garment again; an empty pattern cannot be sewn",
    );
    refused(
        |f| f["pattern"]["panels"] = json!([]),
        "`panels` of `pattern` is a list, an object is wanted",
        &write("an object"),
    );
    refused(
        |f| drop(f["pattern"]["panels"]["back"].as_object_mut().unwrap().remove("rotation")),
        "panel \"back\" has no `rotation`",
        form,
    );
    refused(
        |f| f["pattern"]["panels"]["back"]["vertices"][2] = json!([1, "2"]),
        "vertex 2 of panel \"back\" is a text, a number is wanted",
        &write("a number"),
    );
    refused(
        |f| f["pattern"]["panels"]["back"]["vertices"][2] = json!([1, 2, 3]),
        "vertex 2 of panel \"back\" has 3 numbers, 2 are wanted",
        "points in the plane have 2 numbers, in space 3",
    );
    refused(
        |f| f["pattern"]["panels"]["back"]["vertices"][2] = json!([1e9, 2]),
        "vertex 2 of panel \"back\" is 1000000000, beyond what cloth reaches",
        "correct the number, or `units_in_meter`",
    );
    refused(
        |f| f["properties"]["units_in_meter"] = json!(-3),
        "`units_in_meter` is -3, it must be above 0 and at most 1e6",
        "write 100 for centimetres",
    );
    refused(
        |f| f["properties"]["curvature_coords"] = json!("polar"),
        "`curvature_coords` is \"polar\", it is \"relative\" or \"absolute\"",
        "GarmentCode writes \"relative\"",
    );
    refused(
        |f| f["pattern"]["panel_order"] = json!(["front", "back", "collar"]),
        "`panel_order` names the panel \"collar\", which is missing",
        "add the panel, or take its name out of `panel_order`",
    );
    let many = "no garment needs so many: is it the file that is meant?";
    refused(
        |f| f["pattern"]["panels"]["back"]["vertices"] = vec![json!([0, 0]); 6000].into(),
        "panel \"back\" has 6000 vertices, 5000 are the most",
        many,
    );
    let twice = br#"{"pattern": {"panels": {"a": {"translation": [0,0,0], "rotation": [0,0,0], "vertices": [[0,0],[9,0],[9,9]],
        "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,0]}]}, "a": {}}, "stitches": []}}"#;
    assert_eq!(
        text(twice),
        ("two panels are called \"a\"".into(), "give each panel a name of its own".into())
    );
    let commas = [b"[".as_slice(), &b"1,".repeat(3_000_000), b"1]"].concat();
    assert_eq!(text(&commas), ("the file has 3000001 values, 2000000 are the most".into(), many.to_owned()));
    let long = vec![b' '; (16 << 20) + 1];
    assert_eq!(text(&long), ("it has 16777217 bytes, 16777216 are the most".into(), many.to_owned()));
    refused(
        |f| f["pattern"]["panels"] = json!({ "p": rectangle(1e5, 1e-3, [0.0; 3]) }),
        "stitch 0 sews panel \"front\", which the file does not have",
        "add the panel, or take the stitch out",
    );
    refused(
        |f| {
            *f = file(json!({ "p": rectangle(1e6, 1e6, [0.0; 3]) }), json!([]));
        },
        "the largest panel is 1000000 units long, which is no garment in any usual unit",
        "write 100 as `units_in_meter` for centimetres",
    );
}

#[test]
fn what_stands_twice_is_refused() {
    refused(
        |f| f["pattern"]["stitches"].as_array_mut().unwrap().push(stitch(("back", 1), ("front", 1))),
        "edge 1 of panel \"front\" is sewn by stitch 0 and by stitch 2",
        "keep the stitch that is meant",
    );
    let once = serde_json::to_string(&tube()).unwrap();
    let twice = once.replacen("\"stitches\":", "\"stitches\":[],\"stitches\":", 1);
    let refusal = pattern(twice.as_bytes(), "test").unwrap_err().remove(0);
    assert_eq!(
        (refusal.to_string(), refusal.remedy()),
        ("`stitches` stands twice in `pattern`".into(), "keep the one that is meant".into())
    );
}

#[test]
fn damage_of_panels_is_refused_with_panel_and_edge() {
    refused(
        |f| f["pattern"]["panels"]["front"]["edges"][2]["endpoints"] = json!([2, 7]),
        "edge 2 of panel \"front\" names vertex 7, the panel has 4",
        "vertices are counted from 0",
    );
    let params = "`quadratic` has 1 control point, `cubic` 2, `circle` a radius and two flags";
    refused(
        |f| {
            f["pattern"]["panels"]["front"]["edges"][2]["curvature"] =
                json!({ "type": "spline", "params": [1, 2] })
        },
        "edge 2 of panel \"front\" has the curvature \"spline\" with 2 parameters, which is none",
        params,
    );
    refused(
        |f| {
            f["pattern"]["panels"]["front"]["edges"][2]["curvature"] =
                json!({ "type": "cubic", "params": [[0, 1]] })
        },
        "edge 2 of panel \"front\" has the curvature \"cubic\" with 1 parameters, which is none",
        params,
    );
    refused(
        |f| f["pattern"]["panels"]["front"]["edges"] = straight(&[[0, 1]]),
        "panel \"front\" has 1 edges, 2 are the least",
        "draw the panel as a closed loop of edges",
    );
    refused(
        |f| f["pattern"]["panels"]["front"]["vertices"][1] = json!([50, 60]),
        "edge 1 of panel \"front\" has no length and is stitched",
        "draw the edge, or take its stitch out",
    );
    refused(
        |f| {
            f["pattern"]["panels"]["front"]["edges"].as_array_mut().unwrap().remove(0);
            f["pattern"]["stitches"] = json!([]);
        },
        "the loop of panel \"front\" is open: edge 2 ends 500.0 mm from where edge 0 starts",
        "close the loop: gaps of up to 5 mm are closed by themselves",
    );
    let corners = "draw the panel so that its edges meet at corners alone";
    refused(
        |f| f["pattern"]["panels"]["front"]["vertices"] = json!([[0, 0], [50, 0], [0, 60], [50, 60]]),
        "panel \"front\" crosses itself: edge 1 meets edge 3 near (50.0, 60.0) in the file's units",
        corners,
    );
    let away = "correct the control point; where it is meant in the panel's coordinates, write \"absolute\" as `curvature_coords`";
    refused(
        |f| f["pattern"]["panels"]["front"]["edges"][0]["curvature"] = json!([0.5, 30.0]),
        "a control point of edge 0 of panel \"front\" lies 30 times the edge's length away from it",
        away,
    );
    refused(
        |f| {
            f["pattern"]["panels"]["front"]["edges"][0]["curvature"] =
                json!({ "type": "circle", "params": [-40, 0, 1] })
        },
        "the radius of edge 0 of panel \"front\" is -40",
        "give a radius above 0; the flags say to which side the arc turns",
    );
    let mut f = tube();
    f["pattern"]["panels"]["front"]["edges"][0]["curvature"] = json!([0.5, 3.0]);
    let e = faults::refused("a.json", vec![read(&f).unwrap_err().fault()]);
    assert_eq!((e.code, e.param), (ErrorCode::DegenerateTriangles, Some("file")));
    assert!(
        e.message.starts_with("\"a.json\": panel \"front\" crosses itself: edge 0 meets edge 2 near ("),
        "{e}"
    );
}

#[test]
fn damage_of_stitches_is_refused_with_its_number() {
    let sides = "a stitch names two edges";
    let push = |f: &mut Value, s: Value| f["pattern"]["stitches"].as_array_mut().unwrap().push(s);
    refused(|f| push(f, json!([side("front", 0)])), "stitch 2 has 1 sides, 2 are wanted", sides);
    refused(
        |f| push(f, json!([side("front", 0), side("back", 1), side("back", 3)])),
        "stitch 2 has 3 sides, 2 are wanted",
        sides,
    );
    refused(
        |f| push(f, json!([side("front", 0), side("back", 3), "wrong_right"])),
        "stitch 2 ends with \"wrong_right\", which is no word of the format",
        "the only word is \"right_wrong\"",
    );
    refused(
        |f| push(f, stitch(("front", 0), ("bakc", 1))),
        "stitch 2 sews panel \"bakc\", which the file does not have",
        "add the panel, or take the stitch out; or did you mean \"back\"?",
    );
    refused(
        |f| push(f, stitch(("front", 9), ("back", 1))),
        "stitch 2 sews edge 9 of panel \"front\", which has 4 edges",
        "edges are counted from 0",
    );
    refused(
        |f| push(f, stitch(("front", 0), ("front", 0))),
        "stitch 2 sews edge 0 of panel \"front\" to itself",
        "cut the edge in two and sew its halves",
    );
    refused(
        |f| push(f, json!([side("front", 1), side("back", 2), "right_wrong"])),
        "stitches 0 and 2 sew the same edges in opposite directions",
        "keep the stitch that is meant",
    );
}

#[test]
fn all_faults_of_a_file_are_told_at_once() {
    let mut f = tube();
    f["pattern"]["panels"]["front"]["vertices"].as_array_mut().unwrap().push(json!([55, 0]));
    f["pattern"]["panels"]["front"]["edges"][1]["endpoints"][0] = json!(4);
    f["pattern"]["panels"]["back"]["edges"][2]["curvature"] = json!({ "type": "cubic", "params": [[0, 1]] });
    f["pattern"]["stitches"].as_array_mut().unwrap().push(stitch(("front", 0), ("sleeve", 1)));
    let all = pattern(f.to_string().as_bytes(), "test").unwrap_err();
    let sentences: Vec<String> = all.iter().map(ToString::to_string).collect();
    assert_eq!(
        sentences,
        [
            "edge 2 of panel \"back\" has the curvature \"cubic\" with 1 parameters, which is none",
            "stitch 2 sews panel \"sleeve\", which the file does not have",
            "the loop of panel \"front\" is open: edge 0 ends 50.0 mm from where edge 1 starts",
        ]
    );
}

#[test]
fn an_edge_without_a_label_may_have_a_name() {
    let mut f = tube();
    f["pattern"]["panels"]["front"]["edges"][0]["name"] = json!("hem");
    assert!(read(&f).unwrap().0.piece("front").unwrap().path("hem").is_some());
}

fn run(folder: &FilePath, name: &str) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
    let cx = Context::new("GarmentCode", folder, Cancel::new(), Arc::new(()));
    GarmentCode { file: name.into() }.run(&cx)
}

#[test]
fn the_stage_gives_pattern_outlines_and_plan_and_names_a_missing_file() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("tube_specification.json"), tube().to_string()).unwrap();
    let (pattern, outlines, plan) = run(dir.path(), "tube_specification.json").unwrap();
    assert_eq!((pattern.name.as_str(), outlines.0.len(), plan.seams.len()), ("tube", 2, 2));
    assert!(pattern.check().is_ok());
    assert!(outlines.iter().all(|(_, o)| o.check().is_ok() && o.frame.is_none() && o.edges.len() == 4));
    let e = run(dir.path(), "nowhere.json").unwrap_err();
    assert_eq!((e.message.as_str(), e.param), ("cannot read \"nowhere.json\": no such file", Some("file")));
    let e = run(dir.path(), "").unwrap_err();
    assert_eq!(e.message, "no file is named to read the pattern from");
    assert_eq!(e.hint.as_deref(), Some("write `file: \"shirt_specification.json\"`"));
}
