#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::*;
use crate::contact::body::Body;
use proptest::prelude::*;

const SMALL: &str = r#"{"format": "garment-scene-1", "name": "small", "rest_uv": [[0,0],[1,0],[0,1]],
    "positions": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]],
    "panels": [{"name": "one", "vertices": [0,3], "triangles": [0,1]}], "seams": [], "pinned": [0], "body": null,
    "material": {"area_density": 0.1, "stretch": 10, "shear": 1, "bend": 1e-5, "damping": null, "friction": 0.3, "thickness": 0.001},
    "phases": [{"name": "drape", "seconds": 1, "gravity": [0,-9.81,0]}], "seconds": 1, "self_collision": false}"#;

/// Reads a scene that names no body.
fn load(text: &str) -> Result<Loaded, SceneError> {
    super::parse(text.as_bytes(), &|_| Ok(Vec::new()), &Options::default())
}

fn parse(text: &str) -> Result<Scene, SceneError> {
    load(text).map(|l| l.scene)
}

fn fault(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "{from}");
    parse(&SMALL.replace(from, to)).unwrap_err().to_string()
}

#[test]
fn a_small_scene_is_read() {
    let scene = parse(SMALL).unwrap();
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
        "curve force = 4 is out of range: forces that rise from above 0"
    );
    assert_eq!(fault("\"shear\": 1,", "\"shear\": 0,"), "shear = 0 is out of range: above 0 N/m");
    assert_eq!(
        fault("\"shear\": 1,", "\"shear\": [[0.1, 0]],"),
        "curve force = 0 is out of range: forces that rise from above 0"
    );
    assert_eq!(fault("\"shear\": 1,", "\"shear\": [],"), "shear = 0 is out of range: a slope above 0 N/m");
    let wrong = fault("\"shear\": 1,", "\"shear\": \"soft\",");
    let words = "not a garment-scene-1: invalid type: string \"soft\", expected a stiffness in N/m or a curve [[strain, N/m], ...] at line ";
    assert!(wrong.starts_with(words), "{wrong}");
    assert_eq!(fault("\"thickness\": 0.001", "\"thickness\": 0"), "thickness = 0 is out of range: above 0 m");
    assert_eq!(
        fault("\"name\": \"one\",", "\"name\": \"one\", \"body_friction\": -1,"),
        "body_friction = -1 is out of range: 0 or more"
    );
}

#[test]
fn the_air_of_a_phase_is_read_and_its_faults_are_named() {
    let with = |air: &str| SMALL.replace("[0,-9.81,0]}", &format!("[0,-9.81,0], \"air\": {air}}}"));
    let read = |air: &str| parse(&with(air));
    assert_eq!(read("null").unwrap().phases[0].air, None);
    assert_eq!(read(r#"{"density": 1.2}"#).unwrap().phases[0].air, Some(Air::still(1.2)));
    let full = Air { density: 1.1, normal: 1.3, tangential: 0.02, wind: Vector3::new(3.0, 0.5, -1.0) };
    let text = r#"{"density": 1.1, "normal": 1.3, "tangential": 0.02, "wind": [3, 0.5, -1]}"#;
    let scene = read(text).unwrap();
    assert_eq!(scene.phases[0].air, Some(full));
    assert_eq!(parse(&to_json(&scene, "body.obj")).unwrap().phases, scene.phases);
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
    let scene = parse(&text).unwrap();
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
    let read = parse(SMALL).unwrap();
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
fn what_sewing_needs_is_written_and_read_back() {
    let mut made = generate::gathered(8, 4, 1.5);
    made.bands = generate::banded(8, 4, 0.7).bands;
    made.strain_limit = Some(StrainLimit { warp: 0.02, weft: 0.03 });
    made.panels[1].layer = 2;
    let read = parse(&to_json(&made, "body.obj")).unwrap();
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
    fn the_reader_never_panics(cut in 0..SMALL.len(), with in "[\\[\\]{}0-9,\"a-z-]{0,6}", weld: bool, raw: Vec<u8>) {
        let text = format!("{}{}{}", &SMALL[..cut], with, &SMALL[(cut + with.len()).min(SMALL.len())..]);
        let options = Options { weld, body_unit: None };
        let _ = super::parse(text.as_bytes(), &|_| Ok(raw.clone()), &options);
        let mut bytes = SMALL.as_bytes().to_vec();
        bytes.splice(cut..(cut + raw.len()).min(SMALL.len()), raw.iter().copied());
        let _ = super::parse(&bytes, &|_| Ok(raw.clone()), &options);
    }
}

/// The text with `field` put in front of the first field of the object that begins with `start`.
fn with_field(start: &str, field: &str) -> String {
    assert!(SMALL.contains(start), "{start}");
    let first = start.trim_start_matches('{');
    SMALL.replacen(start, &format!("{{{field}, {first}"), 1)
}

#[test]
fn a_field_that_nothing_reads_is_refused_wherever_it_stands() {
    let said = |text: &str| parse(text).unwrap_err().to_string();
    assert_eq!(
        said(&SMALL.replace("\"seams\"", "\"seam\"")),
        "unknown field `seam` of the scene at line 3 column 73"
    );
    assert_eq!(
        said(&SMALL.replace("\"self_collision\"", "\"self_colision\"").replace("\"layer\"", "\"layr\"")),
        "unknown field `self_colision` of the scene at line 5 column 88"
    );
    for (start, of) in [
        ("{\"name\": \"one\"", "a panel"),
        ("{\"area_density\"", "a material"),
        ("{\"name\": \"drape\"", "a phase"),
    ] {
        let words = said(&with_field(start, "\"x\": {\"seams\": [1]}"));
        assert!(words.starts_with(&format!("unknown field `x` of {of} at line ")), "{words}");
    }
    let deeper = [
        (
            "\"seams\": []",
            "\"seams\": [{\"name\": \"s\", \"pairs\": [[0, 1]], \"gathr\": 1}]",
            "`gathr` of a seam",
        ),
        ("\"seams\": []", "\"bands\": [{\"x\": 1}]", "`x` of a band"),
        ("\"body\": null", "\"body\": {\"obj\": \"b\", \"frction\": 1}", "`frction` of the body"),
        ("\"body\": null", "\"strain_limit\": {\"wrap\": 1}", "`wrap` of the strain limit"),
        ("[0,-9.81,0]}", "[0,-9.81,0], \"air\": {\"density\": 1, \"winds\": [0,0,0]}}", "`winds` of the air"),
        ("\"name\": \"one\",", "\"name\": \"one\", \"material\": {\"bnd\": 1},", "`bnd` of a material"),
    ];
    for (from, to, what) in deeper {
        let words = fault(from, to);
        assert!(words.starts_with(&format!("unknown field {what} at line ")), "{words}");
    }
}

#[test]
fn a_field_that_stands_twice_is_refused_and_all_faults_come_at_once() {
    let doubled = SMALL.replace("\"seams\": []", "\"seams\": [], \"pins\": [],\n\"seams\": []");
    assert_eq!(
        parse(&doubled).unwrap_err().to_string(),
        "unknown field `pins` of the scene at line 3 column 86; the field `seams` of the scene is given twice, again at line 4 column 1"
    );
    let panel = fault("\"name\": \"one\",", "\"name\": \"one\", \"name\": \"two\",");
    assert!(
        panel.starts_with("the field `name` of a panel is given twice, again at line 3 column "),
        "{panel}"
    );
    // Escapes hide no name.
    let hidden = fault("\"seams\": []", "\"seams\": [], \"se\\u0061ms\": []");
    assert!(hidden.starts_with("the field `seams` of the scene is given twice"), "{hidden}");
}

#[test]
fn the_fields_of_the_book_are_those_that_are_read() {
    let book = include_str!("../../../../docs/reference/scene.md");
    let rows = |from: &str| -> Vec<String> {
        let table =
            book.split(from).nth(1).unwrap().split("\n\n").find(|p| p.starts_with("| field")).unwrap();
        let names = table.lines().skip(2).filter_map(|l| l.split('|').nth(1));
        names.flat_map(|n| n.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()).collect()
    };
    let sorted = |mut names: Vec<String>| {
        names.sort_unstable();
        names
    };
    let known = |path: &str| -> Vec<String> {
        strict::fields(path).unwrap().1.iter().map(|f| (*f).to_owned()).collect()
    };
    assert_eq!(sorted(rows("All lengths in metres")), sorted(known("")));
    assert_eq!(sorted(rows("A phase's `air`")), sorted(known("phases.air")));
    assert_eq!(sorted(rows("The material's values")), sorted(known("material")));
}

#[test]
fn marks_of_an_encoding_are_skipped_and_up_is_y() {
    let read = |text: &[u8]| super::parse(text, &|_| Ok(Vec::new()), &Options::default()).unwrap().scene;
    let clean = parse(SMALL).unwrap();
    assert_eq!(read(&[b"\xEF\xBB\xBF", SMALL.as_bytes()].concat()), clean);
    let wide: Vec<u8> =
        std::iter::once(0xFEFF).chain(SMALL.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert_eq!(read(&wide), clean);
    assert_eq!(parse(&SMALL.replace("\"seams\"", "\"up\": \"Y\", \"seams\"")).unwrap(), clean);
    assert_eq!(
        fault("\"seams\"", "\"up\": \"z\", \"seams\""),
        "up is 'z', but in a scene y is up; turn the scene and its body"
    );
    let told = load(&SMALL.replace("\"seconds\": 1, \"self", "\"seconds\": 3, \"self")).unwrap().warnings;
    assert_eq!(told, ["`seconds` is 3, but the phases last 1 s together; the phases count"]);
}

/// The scene as a file, and read again.
fn again(scene: &Scene, options: &Options) -> Result<Loaded, SceneError> {
    let obj = body_to_obj(scene);
    super::parse(to_json(scene, "body.obj").as_bytes(), &|_| Ok(obj.clone().into()), options)
}

/// The scene with three vertices of its own for every triangle.
fn unmerged(scene: &Scene) -> Scene {
    let corners: Vec<usize> = scene.triangles.iter().flatten().map(|&v| v as usize).collect();
    let n = corners.len();
    let mut made = scene.clone();
    made.rest = corners.iter().map(|&v| scene.rest[v]).collect();
    made.positions = corners.iter().map(|&v| scene.positions[v]).collect();
    made.triangles = (0..n as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    made.panels = vec![Panel::new("square", 0..n, 0..n / 3)];
    made
}

#[test]
fn the_standard_scenes_are_read_without_a_word() {
    for scene in [generate::hang(5), generate::drape(6), generate::tube(4, 5), generate::stack(3, 4)] {
        let read = again(&scene, &Options::default()).unwrap();
        assert_eq!(read.warnings, Vec::<String>::new(), "{}", scene.name);
        assert_eq!(read.scene.triangles, scene.triangles);
    }
}

#[test]
fn a_mesh_of_faces_by_themselves_is_refused_or_welded() {
    let scene = unmerged(&generate::drape(4));
    assert_eq!(
        again(&scene, &Options::default()).unwrap_err().to_string(),
        "panel 'square' is 32 faces that hang together nowhere: of its 96 vertices 71 lie on others that they are not joined to; \
         merge them in the program that wrote the mesh"
    );
    let welded = again(&scene, &Options { weld: true, ..Options::default() }).unwrap();
    assert_eq!(welded.warnings, ["71 vertices are joined to others that they lie on"]);
    assert_eq!((welded.scene.seams[0].name.as_str(), welded.scene.seams[0].pairs.len()), ("weld", 71));
    let nothing = again(&generate::drape(4), &Options { weld: true, ..Options::default() }).unwrap();
    assert_eq!(nothing.warnings, ["`weld` has nothing to join: no vertices of a panel lie on each other"]);
}

#[test]
fn a_cut_through_a_panel_is_told_with_its_vertices_and_pieces() {
    // The first column of cells has its own vertices where it meets the next.
    let mut scene = generate::hang(4);
    let (rest, positions) = (scene.rest.clone(), scene.positions.clone());
    for j in 0..5usize {
        let (old, new) = ((5 * j + 1) as u32, scene.rest.len() as u32);
        scene.rest.push(rest[old as usize]);
        scene.positions.push(positions[old as usize]);
        for t in &mut scene.triangles {
            if t.iter().any(|v| v % 5 == 0 && *v < 25) {
                t.iter_mut().filter(|v| **v == old).for_each(|v| *v = new);
            }
        }
    }
    scene.panels[0].vertices = 0..30;
    let told = again(&scene, &Options::default()).unwrap().warnings;
    assert_eq!(
        told,
        [
            "5 vertices lie on others of their panels, flat and at the start, without being joined to them (the first: 25 on 1); \
             `weld: true` joins them",
            "panel 'square' is 2 pieces that neither triangles nor seams hold together"
        ]
    );
    // What is sewn is joined.
    scene.seams.push(Seam::new("cut", (0..5).map(|j| [5 * j + 1, 25 + j]).collect()));
    assert_eq!(again(&scene, &Options::default()).unwrap().warnings, Vec::<String>::new());
}

#[test]
fn a_triangle_that_is_listed_twice_is_left_out_with_its_number() {
    let clean = generate::tube(4, 5);
    for again_as in [[0, 1, 2], [1, 2, 0], [2, 1, 0]] {
        let mut scene = clean.clone();
        let t = scene.triangles[3];
        scene.triangles.insert(7, again_as.map(|k| t[k]));
        scene.panels[0].triangles.end += 1;
        scene.panels[1].triangles = scene.panels[0].triangles.end..scene.triangles.len();
        let read = again(&scene, &Options::default()).unwrap();
        assert_eq!((&read.scene.triangles, &read.scene.panels), (&clean.triangles, &clean.panels));
        assert_eq!(
            read.warnings,
            [format!(
                "1 triangle that is listed twice is left out: triangle 7 of vertices {}, {} and {}",
                scene.triangles[7][0], scene.triangles[7][1], scene.triangles[7][2]
            )]
        );
    }
}

#[test]
fn a_vertex_of_no_triangle_stays_where_it_starts_is_an_anchor_or_is_refused() {
    let mut scene = generate::hang(3);
    scene.rest.push(Vector2::new(3.0, 0.0));
    scene.positions.push(Vector3::new(3.0, 0.0, 0.0));
    scene.panels[0].vertices.end = 17;
    let read = again(&scene, &Options::default()).unwrap();
    assert_eq!(read.warnings, ["1 vertex belongs to no triangle and stays where it starts: 16"]);
    assert!(read.scene.pinned.contains(&16));
    assert_eq!(
        scene.check().unwrap_err().to_string(),
        "vertex 16 belongs to no triangle, is not pinned and would fall; leave it out or pin it"
    );
    scene.seams.push(Seam::new("rail", vec![[3, 16]]));
    assert_eq!(
        again(&scene, &Options::default()).unwrap_err().to_string(),
        "seam 'rail': pair 0 sews vertex 16, which belongs to no triangle; pin it where the seam is to hang, or leave it out"
    );
    scene.pinned.push(16);
    assert_eq!(again(&scene, &Options::default()).unwrap().warnings, Vec::<String>::new());
}

#[test]
fn two_panels_of_one_name_are_refused() {
    let mut scene = generate::tube(4, 5);
    scene.panels[1].name = "front".into();
    assert_eq!(
        again(&scene, &Options::default()).unwrap_err().to_string(),
        "panels 0 and 1 are both called 'front'; give each panel a name of its own"
    );
}

/// The scene with its body so many times as large.
fn with_body(times: f64) -> Scene {
    let mut scene = generate::tube(4, 5);
    scene.body.as_mut().unwrap().vertices.iter_mut().for_each(|p| *p *= times);
    scene
}

#[test]
fn a_body_in_another_unit_is_brought_to_metres() {
    let clean = with_body(1.0).body.unwrap();
    for (times, name, unit) in [(100.0, "centimetres", 0.01), (1000.0, "millimetres", 0.001)] {
        let read = again(&with_body(times), &Options::default()).unwrap();
        let far = read
            .scene
            .body
            .unwrap()
            .vertices
            .iter()
            .zip(&clean.vertices)
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max);
        assert!(far < 1e-9, "{name}: {far}");
        let long = 1.05 * times;
        assert_eq!(
            read.warnings,
            [format!(
                "the body's OBJ is read in {name}, as it would be {long:.1} m long in metres: it is 1.050 m long"
            )]
        );
        let said = Options { body_unit: Some(unit), ..Options::default() };
        assert_eq!(again(&with_body(times), &said).unwrap().warnings, Vec::<String>::new());
    }
    assert_eq!(
        again(&with_body(1e6), &Options::default()).unwrap_err().to_string(),
        "the body would be 1050000.0 m long; scale its OBJ to metres, or name its unit with `units`"
    );
    assert_eq!(
        again(&with_body(0.1), &Options::default()).unwrap().warnings,
        [
            "the body is 0.105 m long and the cloth 0.620 m: if the body's OBJ is in another unit, name it with `units`"
        ]
    );
}

#[test]
fn lengths_of_the_cloth_in_another_unit_are_refused_or_told() {
    let mut scene = with_body(100.0);
    scene.positions.iter_mut().for_each(|p| *p *= 100.0);
    scene.rest.iter_mut().for_each(|p| *p *= 100.0);
    assert_eq!(
        again(&scene, &Options::default()).unwrap_err().to_string(),
        "the cloth would be 62.0 m long and its body longer than 10 m; lengths of a scene are in metres: divide them by 100 where \
         they are centimetres"
    );
    let mut scene = generate::hang(3);
    scene.rest.iter_mut().for_each(|p| *p *= 100.0);
    assert_eq!(
        again(&scene, &Options::default()).unwrap_err().to_string(),
        "edges are 100 times longer in rest_uv than in positions; write both in metres"
    );
    scene.positions.iter_mut().for_each(|p| *p *= 100.0);
    assert_eq!(
        again(&scene, &Options::default()).unwrap().warnings,
        ["the cloth is 100.0 m long: lengths of a scene are in metres"]
    );
}
