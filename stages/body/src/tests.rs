//! What every mannequin must be.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr)]

use super::*;
use crate::skin::topology::MeshTopology;
use proptest::prelude::*;
use toile_core::prelude::*;

pub(crate) fn mannequin(ron: &str) -> Result<Body, StageError> {
    let stage: Mannequin = toile_core::param::ron_options().from_str(ron).unwrap();
    stage.run(&Context::quiet())
}

#[test]
fn the_default_is_one_closed_piece() {
    let body = mannequin("()").unwrap();
    let topology = MeshTopology::of(body.positions.len(), &body.triangles);
    assert!(topology.is_closed(), "{topology:?}");
    assert_eq!((topology.components, topology.euler()), (1, 2));
    let litres = body.volume() * 1e3;
    assert!((50.0..80.0).contains(&litres), "{litres} l");
    assert!((8_000..25_000).contains(&body.triangles.len()), "{}", body.triangles.len());
}

/// Every landmark that placement relies on.
const LANDMARKS: [&str; 19] = [
    "neck_base_front",
    "neck_base_back",
    "neck_left",
    "neck_right",
    "shoulder_left",
    "shoulder_right",
    "armpit_left",
    "armpit_right",
    "elbow_left",
    "elbow_right",
    "wrist_left",
    "wrist_right",
    "bust_front",
    "bust_back",
    "waist_front",
    "waist_back",
    "hip_front",
    "hip_back",
    "crotch",
];

/// The distance to the nearest vertex.
fn nearest(body: &Body, p: &Point3) -> f64 {
    body.positions.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min)
}

#[test]
fn landmarks_lie_on_the_skin_and_joints_inside() {
    let body = mannequin("()").unwrap();
    for name in LANDMARKS {
        let p = body.landmarks[name];
        let joint = name.starts_with("elbow") || name.starts_with("wrist");
        let reach = if joint { 0.05 } else { 0.016 };
        assert!(nearest(&body, &p) < reach || name.starts_with("armpit"), "{name} {p}");
        if joint {
            let loops = crate::skin::slice::slice(&body.positions, &body.triangles, p.y);
            let holds = |l: &crate::skin::slice::SliceLoop| {
                l.bounds[0] < p.x && p.x < l.bounds[1] && l.bounds[2] < p.z && p.z < l.bounds[3]
            };
            assert!(loops.iter().any(holds), "{name} {p}");
        }
    }
    let y = |name: &str| body.landmarks[name].y;
    let upwards =
        ["crotch", "hip_front", "waist_front", "bust_front", "armpit_left", "shoulder_left", "neck_left"];
    assert!(upwards.windows(2).all(|w| y(w[0]) < y(w[1])), "{:?}", body.landmarks);
}

#[test]
fn shoulders_slope_like_a_persons() {
    let body = mannequin("()").unwrap();
    let (neck, shoulder) = (body.landmarks["neck_left"], body.landmarks["shoulder_left"]);
    let slope = ((neck.y - shoulder.y) / (shoulder.x - neck.x)).atan().to_degrees();
    assert!((21.0..25.0).contains(&slope), "{slope} degrees");
    assert!((shoulder.x - 0.193).abs() < 0.002);
}

#[test]
fn left_and_right_are_mirror_images_to_the_last_bit() {
    let body = mannequin("()").unwrap();
    let key = |p: Point3| [p.x + 0.0, p.y, p.z].map(f64::to_bits);
    let all: std::collections::BTreeSet<[u64; 3]> = body.positions.iter().map(|p| key(*p)).collect();
    assert!(body.positions.iter().all(|p| all.contains(&key(Point3::new(-p.x, p.y, p.z)))));
}

#[test]
fn triangles_of_trunk_arms_and_legs_are_even() {
    let mut body = mannequin("()").unwrap();
    // Hands, head and feet have finer ones.
    let (top, reach) = (body.landmarks["neck_left"].y, body.landmarks["elbow_left"].x);
    let plain = |p: &Point3| p.y > 0.15 && p.y < top && p.x.abs() < reach;
    let positions = body.positions.clone();
    body.triangles.retain(|t| t.iter().all(|&v| plain(&positions[v as usize])));
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| body.positions[i as usize]);
        (b - a).cross(&(c - a)).norm() / 2.0
    };
    let mut areas: Vec<f64> = body.triangles.iter().map(area).collect();
    areas.sort_by(f64::total_cmp);
    let at = |share: f64| areas[(share * (areas.len() - 1) as f64) as usize];
    assert!(at(0.02) > 0.3 * at(0.5) && at(0.98) < 2.0 * at(0.5), "{} {} {}", at(0.02), at(0.5), at(0.98));
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let digest = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let body = pool.install(|| mannequin("()").unwrap());
        let mut d = Digester::new();
        body.digest(&mut d);
        d.finish()
    };
    assert_eq!(digest(1), digest(2));
}

#[test]
fn measures_that_nobody_has_are_refused() {
    let refused = |ron: &str| {
        let e = mannequin(ron).expect_err("no such person");
        assert_eq!((e.code, e.param.is_some()), (ErrorCode::InvalidParameter, true));
        (e.message, e.hint.unwrap())
    };
    assert_eq!(
        refused("(waist: \"3 m\")"),
        (
            "nobody has a waist of 300 cm beside a height of 172 cm".into(),
            "a waist of 51.6 cm to 134.2 cm would fit; check the units as well".into()
        )
    );
    assert_eq!(refused("(height: \"17 m\")").0, "nobody has a height of 1700 cm");
    assert_eq!(
        refused("(hip: \"75 cm\", waist: \"89 cm\")").0,
        "nobody has a hip of 75 cm beside a waist of 89 cm"
    );
    assert_eq!(refused("(arm_angle: 5)").0, "nobody has an arm angle of 5 degrees");
    assert_eq!(
        refused("(arm: \"80 cm\")"),
        (
            "nobody has an arm of 80 cm beside a height of 172 cm".into(),
            "an arm of 43 cm to 68.8 cm would fit; check the units as well".into()
        )
    );
    assert_eq!(
        refused("(inseam: \"50 cm\")"),
        (
            "nobody has an inseam of 50 cm beside a height of 172 cm".into(),
            "an inseam of 61.9 cm to 89.4 cm would fit; check the units as well".into()
        )
    );
    assert_eq!(
        refused("(size: \"EU 37\", figure: Man)"),
        (
            "no man has a size of \"EU 37\"".into(),
            "the sizes are XS, S, M, L, XL, XXL, or EU 44 to EU 64".into()
        )
    );
    assert_eq!(
        refused("(size: \"M\", figure: Child)"),
        (
            "no child has a size of \"M\"".into(),
            "the sizes are EU 86 to EU 152, which is the height in centimetres".into()
        )
    );
    assert_eq!(refused("(size: \"huge\")").0, "no mannequin has a size of \"huge\"");
}

#[test]
fn measures_follow_the_size_where_they_are_not_given() {
    let of = |ron: &str| {
        let body = mannequin(ron).unwrap();
        ["height", "bust", "waist", "hip"].map(|m| (body.measurements[m] * 100.0).round())
    };
    assert_eq!(of("(size: \"M\")"), [168.0, 88.0, 72.0, 96.0]);
    assert_eq!(of("(size: \"L\", figure: Man, waist: \"99 cm\")"), [178.0, 108.0, 99.0, 111.0]);
    assert_eq!(of("(size: \"EU 110\", height: \"112 cm\")"), [112.0, 57.0, 53.0, 60.0]);
    assert_eq!(of("(figure: Man)"), [180.0, 100.0, 86.0, 100.0]);
    // A child's girths follow from its height; those of the grown do not.
    assert_eq!(of("(figure: Child, height: \"134 cm\")"), [134.0, 67.0, 60.0, 72.0]);
    assert_eq!(of("(height: \"134 cm\")"), [134.0, 67.0, 60.0, 72.0]);
    assert_eq!(of("(figure: Child, height: \"134 cm\", bust: \"70 cm\")"), [134.0, 70.0, 60.0, 72.0]);
    assert_eq!(of("(figure: Woman, height: \"158 cm\")"), [158.0, 88.0, 70.0, 96.0]);
}

#[test]
fn arm_inseam_neck_and_shoulders_are_those_asked_for() {
    let body = mannequin(
        "(arm: \"62 cm\", inseam: \"76 cm\", neck: \"37 cm\", shoulder_width: \"41 cm\", figure: Man)",
    )
    .unwrap();
    let wanted = [("arm_length", 0.62), ("inseam", 0.76), ("neck", 0.37), ("shoulder_width", 0.41)];
    for (name, length) in wanted {
        assert!((body.measurements[name] - length).abs() < 5e-3, "{name}: {}", body.measurements[name]);
    }
    assert!((body.landmarks["crotch"].y - 0.76).abs() < 5e-3);
    assert!((0.2..0.4).contains(&body.measurements["biceps"]));
    assert!((0.4..0.7).contains(&body.measurements["thigh"]));
}

/// The k-th of forty: figure, height, bust, waist and hip, metres, and the arms' angle.
fn combination(k: usize) -> (Wearer, [f64; 4], f64) {
    let i = k as f64;
    let (figure, height, shares) = match k % 4 {
        0 => (Wearer::Woman, 1.50 + 0.008 * i, [0.50, 0.80, 1.08]),
        1 => (Wearer::Man, 1.60 + 0.009 * i, [0.54, 0.86, 1.00]),
        2 => (Wearer::Child, 0.88 + 0.015 * i, [0.53, 0.92, 1.04]),
        _ => (Wearer::Woman, 1.55 + 0.007 * i, [0.62, 0.88, 1.05]),
    };
    let spread = |step: usize, of: usize| (k * step % of) as f64 / of as f64 - 0.5;
    let bust = height * (shares[0] + 0.08 * spread(7, 11));
    let waist = bust * (shares[1] + 0.10 * spread(5, 7));
    let hip = bust * (shares[2] + 0.10 * (spread(3, 5) + 0.1));
    (figure, [height, bust, waist, hip], [60.0, 54.0, 75.0, 52.0, 66.0][k % 5])
}

#[test]
fn forty_figures_have_their_measures_and_do_not_cross_themselves() {
    for k in 0..40 {
        let (figure, [height, bust, waist, hip], arm_angle) = combination(k);
        let ron = format!(
            "(figure: {figure:?}, height: \"{height} m\", bust: \"{bust} m\", waist: \"{waist} m\", \
             hip: \"{hip} m\", arm_angle: {arm_angle:?})"
        );
        let body = mannequin(&ron).map_err(|e| format!("{k}: {}", e.message)).unwrap();
        for (name, wanted) in [("height", height), ("bust", bust), ("waist", waist), ("hip", hip)] {
            let found = body.measurements[name];
            assert!((found - wanted).abs() < 5e-3, "{k} {figure:?} {name}: {found} for {wanted}");
        }
        let topology = MeshTopology::of(body.positions.len(), &body.triangles);
        assert!(topology.is_closed() && topology.components == 1 && topology.euler() == 2, "{k}");
        assert!(body.triangles.len() < 28_000, "{k}: {}", body.triangles.len());
        assert_eq!(crate::skin::untangle::crossing(&body.positions, &body.triangles).len(), 0, "{k}");
    }
}

#[test]
fn a_length_that_is_no_number_is_refused() {
    let stage = Mannequin::of(f64::NAN, [0.88, 0.7, 0.96], 0.016);
    assert!(stage.run(&Context::quiet()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn girths_are_those_asked_for(
        height in 0.85..2.05f64, bust in 0.46..0.66f64, waist in 0.76..0.98f64, hip in 0.94..1.16f64,
    ) {
        let (bust, edge) = (bust * height, 0.022);
        let wanted = [("bust", bust), ("waist", waist * bust), ("hip", hip * bust)];
        let stage = Mannequin::of(height, wanted.map(|w| w.1), edge);
        // Short and very stout figures may be refused, by name.
        let body = match stage.run(&Context::quiet()) {
            Ok(body) => body,
            Err(e) => {
                prop_assert_eq!(e.code, ErrorCode::InvalidParameter);
                prop_assert!(bust > 0.58 * height, "{}", e.message);
                return Ok(());
            }
        };
        for (name, girth) in wanted {
            let y = body.landmarks[&format!("{name}_front")].y;
            let loops = crate::skin::slice::slice(&body.positions, &body.triangles, y);
            let tape = crate::skin::slice::trunk(&loops, 0.0).unwrap().girth;
            prop_assert!((tape / girth - 1.0).abs() < 0.005, "{name}: {tape} for {girth}");
            prop_assert!((body.measurements[name] / girth - 1.0).abs() < 0.005);
        }
        let top = body.positions.iter().map(|p| p.y).fold(0.0, f64::max);
        prop_assert!((top - height).abs() < 1e-9);
    }
}

/// The body as the text of a file in millimetres with Z up.
fn z_up_millimetres(body: &Body) -> String {
    let vertex = |p: &Point3| format!("v {} {} {}\n", p.x * 1e3, -p.z * 1e3, p.y * 1e3);
    let face = |t: &[u32; 3]| format!("f {}/1 {}/1 {}/1\n", t[0] + 1, t[1] + 1, t[2] + 1);
    body.positions.iter().map(vertex).chain(body.triangles.iter().map(face)).collect()
}

/// Reads a body from a text by way of a file.
fn read(name: &str, text: impl AsRef<[u8]>, rest: &str) -> Result<Body, StageError> {
    read_in(&Context::quiet(), name, text, rest)
}

fn read_in(cx: &Context, name: &str, text: impl AsRef<[u8]>, rest: &str) -> Result<Body, StageError> {
    let path = std::env::temp_dir().join(format!("toile-body-{}-{name}.obj", std::process::id()));
    std::fs::write(&path, text.as_ref()).unwrap();
    let ron = format!("(file: {:?}{rest})", path.to_str().unwrap());
    let stage: BodyObj = toile_core::param::ron_options().from_str(&ron).unwrap();
    let result = stage.run(cx);
    std::fs::remove_file(path).unwrap();
    result
}

#[test]
fn a_mannequin_written_and_read_has_its_landmarks_again() {
    let made = mannequin("()").unwrap();
    let found = read("again", z_up_millimetres(&made), ", up: Z").unwrap();
    assert_eq!(found.triangles.len(), made.triangles.len());
    assert!((found.volume() / made.volume() - 1.0).abs() < 1e-6);
    for (name, tolerance) in [("bust", 0.03), ("waist", 0.03), ("hip", 0.03), ("shoulder_width", 0.15)] {
        let (a, b) = (found.measurements[name], made.measurements[name]);
        assert!((a / b - 1.0).abs() < tolerance, "{name}: {a} for {b}");
    }
    // The file's middle in depth is another, so heights and widths are compared.
    let away = |a: &Point3, b: &Point3| (a.x - b.x).hypot(a.y - b.y);
    for name in LANDMARKS {
        let (a, b) = (found.landmarks[name], made.landmarks[name]);
        assert!(away(&a, &b) < 0.05, "{name}: {a} for {b}");
    }
}

#[test]
fn a_body_as_exporters_leave_it_is_the_clean_one_and_what_was_mended_is_told() {
    let made = mannequin("(edge: \"20 mm\")").unwrap();
    let clean = read("clean", z_up_millimetres(&made), ", up: Z").unwrap();
    let mut text = b"\xEF\xBB\xBF# K\xF6rper\n".to_vec();
    text.extend(z_up_millimetres(&made).replace("/1 ", "/1 \\\n").bytes());
    // One corner of the last face has a vertex of its own, the first face stands there twice, one
    // has no area.
    let text = String::from_utf8_lossy(&text).into_owned();
    let (head, last) = text.trim_end().rsplit_once("f ").unwrap();
    let corner: usize = last.split('/').next().unwrap().parse().unwrap();
    let vertex = z_up_millimetres(&made).lines().nth(corner - 1).unwrap().to_owned();
    let rest = last.split_once('\n').unwrap().1;
    let first = made.triangles[0].map(|v| v + 1);
    let text = format!("{head}{vertex}\nf -1 {rest}\nf {} {} {}\nf 1 1 2\n", first[1], first[2], first[0]);
    let cx = Context::quiet();
    let found = read_in(&cx, "mended", text, ", up: Z").unwrap();
    assert_eq!(
        (found.positions.len(), found.triangles.len()),
        (clean.positions.len(), clean.triangles.len())
    );
    assert_eq!(found.measurements, clean.measurements);
    let warnings = cx.take_remarks().warnings;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(
        warnings[0].ends_with(
            "was repaired: 1 vertex is joined to one at its place, 1 triangle without area is removed, \
             1 triangle that is listed twice is removed"
        ),
        "{warnings:?}"
    );
}

#[test]
fn a_body_file_that_is_none_is_refused_with_its_line() {
    let e = read("broken", "v 0 0\n", "").unwrap_err();
    assert_eq!((e.code, e.param), (ErrorCode::PatternLoading, Some("file")));
    assert!(
        e.message.ends_with("broken.obj\": line 1 of the OBJ: a vertex needs three numbers"),
        "{}",
        e.message
    );
    assert_eq!(
        e.hint.unwrap(),
        "it must be a Wavefront OBJ with `v` and `f` lines; write it again from the program that made it"
    );
    assert!(read("empty", "hello", "").unwrap_err().message.ends_with("the OBJ holds no faces"));
}

#[test]
fn bodies_with_holes_or_of_odd_shape_are_refused() {
    let made = mannequin("(edge: \"20 mm\")").unwrap();
    let mut holed = made.clone();
    holed.triangles.truncate(made.triangles.len() - 1);
    let message = |name: &str, text: &str, rest: &str| read(name, text, rest).expect_err("refused").message;
    let hole = message("hole", &z_up_millimetres(&holed), ", up: Z");
    assert!(hole.starts_with("the body is not closed: 3 edges are open, the first from ("), "{hole}");
    // The place is that of the file, where the user looks for it.
    let [a, b, c] = made.triangles[made.triangles.len() - 1].map(|v| made.positions[v as usize]);
    let corners = [a, b, c];
    let named =
        corners.iter().filter(|p| hole.contains(&format!("({}, {}, {})", p.x * 1e3, -p.z * 1e3, p.y * 1e3)));
    assert_eq!(named.count(), 2, "{hole}");
    assert_eq!(
        message("units", &z_up_millimetres(&made), ", up: Z, units: Metres"),
        "the body would be 1720.000 m tall"
    );
    let mut turned = made.clone();
    turned.triangles[0].swap(0, 1);
    let words = message("turned", &z_up_millimetres(&turned), ", up: Z");
    assert!(
        words.starts_with(
            "the body's triangles are not turned alike or meet wrongly at 3 edges, the first from ("
        ),
        "{words}"
    );
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    assert_eq!(message("shape", tetrahedron, ""), "the body's crotch cannot be found from its shape");
    let empty: BodyObj = BodyObj::default();
    assert_eq!(empty.run(&Context::quiet()).unwrap_err().message, "no file is named to read the body from");
}

#[test]
fn bodies_of_other_programs_are_read() {
    let Ok(shared) = std::env::var("TOILE_SHARED") else {
        eprintln!("skipped: TOILE_SHARED is not set");
        return;
    };
    // Bust, waist and hip, from the tables that come with the bodies or taken by hand.
    let known = [
        ("makehuman/mh_female_young_m", [0.85, 0.66, 0.96]),
        ("garmentcode/mean_all", [0.998, 0.843, 1.035]),
    ];
    for (name, girths) in known {
        let ron = format!("(file: \"{shared}/data/bodies/{name}.obj\")");
        let stage: BodyObj = toile_core::param::ron_options().from_str(&ron).unwrap();
        let body = stage.run(&Context::quiet()).unwrap();
        for (part, girth) in ["bust", "waist", "hip"].into_iter().zip(girths) {
            let found = body.measurements[part];
            assert!((found / girth - 1.0).abs() < 0.02, "{name} {part}: {found}");
        }
        assert!(LANDMARKS.iter().all(|l| body.landmarks.contains_key(*l)));
    }
}
