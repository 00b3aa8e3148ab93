#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::*;
use crate::contact::body::Body;
use proptest::prelude::*;

const SMALL: &str = r#"{"format": "garment-scene-1", "name": "small", "rest_uv": [[0,0],[1,0],[0,1]],
    "positions": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]],
    "panels": [{"name": "one", "vertices": [0,3], "triangles": [0,1]}], "seams": [], "pinned": [0], "body": null,
    "material": {"area_density": 0.1, "stretch": 10, "shear": 1, "bend": 1e-5, "damping": null, "friction": 0.3, "thickness": 0.001},
    "phases": [{"name": "drape", "seconds": 1, "gravity": [0,-9.81,0]}], "seconds": 1, "self_collision": false}"#;

fn fault(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "{from}");
    parse(&SMALL.replace(from, to), &|_| Ok(String::new())).unwrap_err().to_string()
}

#[test]
fn a_small_scene_is_read() {
    let scene = parse(SMALL, &|_| Ok(String::new())).unwrap();
    assert_eq!((scene.name.as_str(), scene.rest.len(), scene.pinned.as_slice()), ("small", 3, &[0][..]));
    assert_eq!(scene.panels[0].vertices, 0..3);
}

#[test]
fn faults_are_named() {
    assert_eq!(
        fault("garment-scene-1", "garment-scene-9"),
        "the format is 'garment-scene-9', not 'garment-scene-1'"
    );
    assert_eq!(fault("[0,1,2]]", "[0,1,7]]"), "triangle 0 refers to vertex 7, but there are 3");
    assert_eq!(fault("[[0,0,0],[1", "[[1"), "positions has 2 entries, but there are 3 vertices");
    assert_eq!(fault("[[0,1,2]]", "[]"), "the scene has no triangles");
    assert_eq!(fault("[0,1]}", "[0,2]}"), "panel 'one': triangles 0..2 lie outside 0..1");
    assert_eq!(fault("\"stretch\": 10", "\"stretch\": -1"), "stretch = -1 is out of range: above 0 N/m");
    assert_eq!(fault("\"pinned\": [0]", "\"pinned\": [3]"), "pin 0 refers to vertex 3, but there are 3");
    let seam = |pairs: &str| {
        fault("\"seams\": []", &format!("\"seams\": [{{\"name\": \"s\", \"pairs\": {pairs}}}]"))
    };
    assert_eq!(seam("[[1,1]]"), "seam 's': pair 0 sews a vertex to itself");
    assert_eq!(seam("[[0,1],[1,0]]"), "seam 's': pair 1 is sewn already");
    assert!(fault("\"shear\": 1,", "").starts_with("not a garment-scene-1: missing field `shear` at line"));
    assert_eq!(
        fault("\"stretch\": 10,", "\"warp\": 10,"),
        "the material of the scene has neither 'stretch' nor both 'warp' and 'weft'"
    );
    assert_eq!(
        fault("\"bend\": 1e-5,", "\"bend_warp\": 1e-5, \"bend_weft\": -1,"),
        "bend_weft = -1 is out of range: 0 N m or more"
    );
    assert_eq!(
        fault("\"bend\": 1e-5,", "\"bend\": 1e-5, \"bend_friction\": -1,"),
        "bend_friction = -1 is out of range: 0 N m/m or more"
    );
    assert_eq!(
        fault("\"stretch\": 10,", "\"stretch\": [[0.1, 5], [0.2, 4]],"),
        "curve force = 4 is out of range: forces that never fall"
    );
    assert_eq!(fault("\"thickness\": 0.001", "\"thickness\": 0"), "thickness = 0 is out of range: above 0 m");
    assert_eq!(
        fault("\"name\": \"one\",", "\"name\": \"one\", \"body_friction\": -1,"),
        "body_friction = -1 is out of range: 0 or more"
    );
}

#[test]
fn the_air_of_a_phase_is_read_and_its_faults_are_named() {
    let with = |air: &str| SMALL.replace("[0,-9.81,0]}", &format!("[0,-9.81,0], \"air\": {air}}}"));
    let read = |air: &str| parse(&with(air), &|_| Ok(String::new()));
    assert_eq!(read("null").unwrap().phases[0].air, None);
    assert_eq!(read(r#"{"density": 1.2}"#).unwrap().phases[0].air, Some(Air::still(1.2)));
    let full = Air { density: 1.1, normal: 1.3, tangential: 0.02, wind: Vector3::new(3.0, 0.5, -1.0) };
    let text = r#"{"density": 1.1, "normal": 1.3, "tangential": 0.02, "wind": [3, 0.5, -1]}"#;
    let scene = read(text).unwrap();
    assert_eq!(scene.phases[0].air, Some(full));
    assert_eq!(parse(&to_json(&scene, "body.obj"), &|_| Ok(String::new())).unwrap().phases, scene.phases);
    let said = |air: &str| read(air).unwrap_err().to_string();
    assert!(
        said(r#"{"wind": [1,0,0]}"#).starts_with("not a garment-scene-1: missing field `density` at line ")
    );
    assert_eq!(said(r#"{"density": -1}"#), "air density = -1 is out of range: from 0 to 2000 kg/m^3");
    assert_eq!(
        said(r#"{"density": 1, "tangential": 1e9}"#),
        "tangential drag coefficient = 1000000000 is out of range: from 0 to 100"
    );
    assert_eq!(
        said(r#"{"density": 1, "wind": [0, 0, -4000]}"#),
        "wind speed = 4000 is out of range: at most 1000 m/s"
    );
    let mut made = scene;
    made.phases[0].air = Some(Air { wind: Vector3::new(0.0, f64::NAN, 0.0), ..full });
    assert_eq!(made.check().unwrap_err().to_string(), "wind[1] is not a finite number");
}

#[test]
fn warp_and_weft_curves_and_panel_materials_are_read() {
    let own = r#""name": "one", "body_friction": 0.1, "material": {"area_density": 0.3, "warp": [[0.02, 1], [0.04, 9]], "weft": 20,
        "poisson": 0.1, "shear": [[0.1, 2]], "bend_warp": 2e-5, "bend_weft": 1e-5, "bend_friction": 3e-4, "bend_friction_weft": 2e-4, "damping": 0.01, "friction": 0.2,
        "thickness": 0.0005},"#;
    let text = SMALL.replace("\"name\": \"one\",", own);
    let scene = parse(&text, &|_| Ok(String::new())).unwrap();
    assert_eq!((scene.material.density, scene.material.warp.slope(0.0)), (0.1, 10.0));
    let panel = scene.fabric_of(0);
    assert_eq!((panel.density, panel.warp.force(0.03), panel.weft.force(0.03)), (0.3, 5.0, 0.6));
    assert_eq!((panel.bending_warp, panel.bending_weft, panel.shear.slope(0.0)), (2e-5, 1e-5, 20.0));
    assert_eq!((panel.bending_friction_warp, panel.bending_friction_weft), (3e-4, 2e-4));
    assert_eq!(scene.material.bending_friction_warp, 0.0);
    assert_eq!(scene.panels[0].body_friction, Some(0.1));
}

#[test]
fn a_program_builds_what_a_file_says() {
    let read = parse(SMALL, &|_| Ok(String::new())).unwrap();
    let mut made = Scene::new("small", read.material.clone());
    let added = made.add_panel("one", &read.rest, &read.positions, &read.triangles);
    made.pinned.push(added.start);
    (made.phases, made.self_collision) = (read.phases.clone(), false);
    made.check().unwrap();
    assert_eq!(made, read);
    let second = made.add_panel("two", &read.rest, &read.positions[..2], &[[0, 1, 2]]);
    assert_eq!((second, made.triangles[1]), (3..6, [3, 4, 5]));
    assert_eq!(made.check().unwrap_err().to_string(), "positions has 5 entries, but there are 6 vertices");
}

#[test]
fn an_obj_is_read_and_its_faults_have_lines() {
    let (v, f) = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/2 3/3 -1\n").unwrap();
    assert_eq!((v.len(), f), (4, vec![[0, 1, 2], [0, 2, 3]]));
    assert_eq!(
        parse_obj("v 0 0\n").unwrap_err().to_string(),
        "line 1 of the OBJ: a vertex needs three numbers"
    );
    let error = parse_obj("v 0 0 0\nf 1 2 3\n").unwrap_err().to_string();
    assert_eq!(error, "line 2 of the OBJ: a corner is no index of a vertex above it");
}

#[test]
fn what_sewing_needs_is_written_and_read_back() {
    let mut made = generate::gathered(8, 4, 1.5);
    made.bands = generate::banded(8, 4, 0.7).bands;
    made.strain_limit = Some(StrainLimit { warp: 0.02, weft: 0.03 });
    made.panels[1].layer = 2;
    let read = parse(&to_json(&made, "body.obj"), &|_| Ok(String::new())).unwrap();
    assert_eq!((&read.bands, &read.strain_limit), (&made.bands, &made.strain_limit));
    assert_eq!((&read.seams, read.panels[1].layer), (&made.seams, 2));
    // The parser may miss the last bit.
    assert!(read.rest.iter().zip(&made.rest).all(|(a, b)| (a - b).norm() < 1e-15));
}

#[test]
fn the_standard_scenes_are_good() {
    for scene in [generate::hang(5), generate::drape(6), generate::tube(4, 5)] {
        check::check(&scene).unwrap();
    }
    let tube = generate::tube(22, 25);
    assert_eq!((tube.triangles.len(), tube.rest.len()), (2200, 1196));
    let form = tube.body.unwrap();
    let body = Body::new(form.vertices, &form.triangles);
    assert!(body.nearest(&Vector3::new(0.0, 0.9, 0.0), 1.0).unwrap().distance < -0.1);
    assert!(tube.positions.iter().all(|p| body.nearest(p, 1.0).unwrap().distance > 0.03));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever is in the file, the reader answers.
    #[test]
    fn the_reader_never_panics(cut in 0..SMALL.len(), with in "[\\[\\]{}0-9,\"a-z-]{0,6}") {
        let text = format!("{}{}{}", &SMALL[..cut], with, &SMALL[(cut + with.len()).min(SMALL.len())..]);
        let _ = parse(&text, &|_| Ok(String::new()));
        let _ = parse_obj(&text);
    }
}
