//! Files are read back by other people's readers, or by small ones of our own.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::{Glb, Obj, Ply, Preview, Report};
use crate::file_names::{check_name, plain_names};
use crate::texture::PhotoTexturer;
use crate::write::reporting::data::number;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::Remarks;
use toile_core::cost::{Estimate, Predicted};
use toile_core::param::ron_options;
use toile_core::prelude::*;
use toile_core::{Inputs, PortValue};
use toile_fixtures::photographed;

pub(super) fn params<T: serde::de::DeserializeOwned>(text: &str) -> T {
    ron_options().from_str(text).unwrap()
}

pub(super) fn one(artifact: impl Artifact) -> PortValue {
    PortValue::One(Arc::new(artifact))
}

fn photos() -> PortValue {
    let erase = |(k, v): (String, Arc<Photo>)| (k, v as Arc<dyn Artifact>);
    PortValue::Set(Photo::KIND, photographed::photos().0.into_iter().map(erase).collect())
}

pub(super) fn model_with(texturer: &str) -> Model {
    let inputs = Inputs(vec![
        Some(one(photographed::garment(8))),
        Some(photos()),
        None,
        Some(one(photographed::body())),
    ]);
    let out = params::<PhotoTexturer>(&photographed::one_sheet(texturer))
        .run_ports(&inputs, &Context::quiet())
        .unwrap();
    let any: &dyn std::any::Any = out[0].entries()[0].1.as_ref();
    any.downcast_ref::<Model>().unwrap().clone()
}

pub(super) fn model() -> Model {
    model_with("()")
}

/// What a small OBJ reader finds.
#[derive(Default)]
struct ReadObj {
    vertices: Vec<[f64; 3]>,
    texts: Vec<[f64; 2]>,
    normals: usize,
    faces: Vec<Vec<[usize; 3]>>,
    groups: Vec<String>,
    materials: Vec<String>,
}

fn read_obj(text: &str) -> ReadObj {
    let mut read = ReadObj::default();
    for line in text.lines() {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let floats = || rest.split(' ').map(|t| t.parse::<f64>().unwrap()).collect::<Vec<_>>();
        let index = |t: &str| {
            t.split('/').map(|i| i.parse().unwrap_or(0)).collect::<Vec<usize>>().try_into().unwrap()
        };
        match word {
            "v" => read.vertices.push(floats().try_into().unwrap()),
            "vt" => read.texts.push(floats().try_into().unwrap()),
            "vn" => read.normals += usize::from(floats().len() == 3),
            "f" => read.faces.push(rest.split(' ').map(index).collect()),
            "g" => read.groups.push(rest.to_owned()),
            "usemtl" => read.materials.push(rest.to_owned()),
            "#" | "mtllib" => {}
            other => panic!("unknown line {other:?}"),
        }
    }
    read
}

fn obj_files(model: &Model, text: &str) -> BTreeMap<String, Vec<u8>> {
    let files = params::<Obj>(text).run(model, &Context::quiet()).unwrap();
    files.0.into_iter().map(|f| (f.path, f.bytes)).collect()
}

#[test]
fn obj_is_read_back_with_all_its_geometry() {
    let model = model();
    let files = obj_files(&model, "(weld: false)");
    let read = read_obj(std::str::from_utf8(&files["garment.obj"]).unwrap());
    let all: Vec<&Point3> = model.meshes.iter().flat_map(|m| &m.positions).collect();
    assert_eq!(read.vertices.len(), all.len());
    assert!(read.vertices.iter().zip(&all).all(|(a, b)| *a == [b.x, b.y, b.z]));
    assert_eq!(read.normals, all.len());
    assert_eq!(read.faces.len(), model.meshes.iter().map(|m| m.triangles.len()).sum::<usize>());
    assert_eq!(read.groups, ["front", "back", "body"]);
    for [v, t, n] in read.faces.iter().flatten() {
        assert!(
            (1..=read.vertices.len()).contains(v) && *t <= read.texts.len() && (1..=read.normals).contains(n)
        );
    }
    // OBJ counts texture rows from the bottom.
    let [u, v] = model.meshes[0].uv[0].map(f64::from);
    assert!((read.texts[0][0] - u).abs() < 1e-6 && (read.texts[0][1] - (1.0 - v)).abs() < 1e-6);
}

#[test]
fn obj_joins_sewn_vertices_and_keeps_their_textures_apart() {
    let model = model();
    let files = obj_files(&model, "()");
    let read = read_obj(std::str::from_utf8(&files["garment.obj"]).unwrap());
    let all: usize = model.meshes.iter().map(|m| m.positions.len()).sum();
    let pairs: usize = photographed::garment(8).seams.iter().map(|s| s.pairs.len()).sum();
    assert_eq!(read.vertices.len(), all - pairs);
    assert_eq!(read.texts.len(), model.meshes.iter().map(|m| m.uv.len()).sum::<usize>());
}

#[test]
fn obj_names_its_material_and_texture_files() {
    let files = obj_files(&model(), "(name: \"my vest\", textures: Png)");
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    assert_eq!(names, ["my_vest.mtl", "my_vest.obj", "my_vest_back.png", "my_vest_front.png"]);
    let obj = std::str::from_utf8(&files["my_vest.obj"]).unwrap();
    assert!(obj.contains("\nmtllib my_vest.mtl\n"));
    let mtl = std::str::from_utf8(&files["my_vest.mtl"]).unwrap();
    for name in ["front", "back"] {
        assert!(
            mtl.contains(&format!("newmtl {name}\n"))
                && mtl.contains(&format!("map_Kd my_vest_{name}.png\n"))
        );
        assert!(image::load_from_memory(&files[&format!("my_vest_{name}.png")]).is_ok());
    }
    for material in read_obj(obj).materials {
        assert!(mtl.contains(&format!("newmtl {material}\n")));
    }
}

#[test]
fn obj_names_cannot_break_the_format() {
    let mut model = model();
    for name in [&mut model.meshes[0].name, &mut model.materials[0].name, &mut model.textures[0].name] {
        *name = "../front\nv 1 2 3".to_owned();
    }
    let files = obj_files(&model, "()");
    assert!(files.keys().all(|path| !path.contains(['/', '\n']) && !path.contains("..")));
    let read = read_obj(std::str::from_utf8(&files["garment.obj"]).unwrap());
    assert_eq!(read.groups[0], "___front_v_1_2_3");
}

#[test]
fn ply_has_the_length_that_its_header_says() {
    let model = model();
    let file = params::<Ply>("()").run(&model, &Context::quiet()).unwrap().0.remove(0);
    assert_eq!(file.path, "garment.ply");
    let end = file.bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let header = std::str::from_utf8(&file.bytes[..end]).unwrap();
    let count = |word: &str| {
        let line = header.lines().find_map(|l| l.strip_prefix(&format!("element {word} "))).unwrap();
        line.parse::<usize>().unwrap()
    };
    let (vertices, faces) = (count("vertex"), count("face"));
    assert_eq!(vertices, model.meshes.iter().map(|m| m.positions.len()).sum::<usize>());
    assert_eq!(file.bytes.len() - end, vertices * (6 * 4 + 3) + faces * (1 + 3 * 4));
    // The last face's indices belong to the body, the last mesh.
    let last = &file.bytes[file.bytes.len() - 4..];
    assert!((u32::from_le_bytes(last.try_into().unwrap()) as usize) < vertices);
    // A vertex in the middle of the front has a colour of the front's photo: more red than blue.
    let middle = end + (4 * 9 + 4) * 27 + 24;
    assert!(file.bytes[middle] > file.bytes[middle + 2]);
}

#[test]
fn preview_draws_three_pictures() {
    let files = params::<Preview>("(size: 100)").run(&model(), None, &Context::quiet()).unwrap().0;
    let names: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    assert_eq!(names, ["front.png", "back.png", "side.png"]);
    let [front, back, _] = [0, 1, 2].map(|i| image::load_from_memory(&files[i].bytes).unwrap().to_rgb8());
    assert_eq!(front.dimensions(), (80, 100));
    let redness = |p: &image::Rgb<u8>| i32::from(p.0[0]) - i32::from(p.0[2]);
    assert!(front.pixels().map(redness).max() > Some(60), "the front is red");
    assert!(back.pixels().map(redness).min() < Some(-60), "the back is blue");
}

#[test]
fn what_is_not_finite_is_never_written() {
    let cx = Context::quiet();
    let mut broken = model();
    broken.meshes[1].positions[5].z = f64::NAN;
    let errors = [
        params::<Glb>("()").run(&broken, &cx).unwrap_err(),
        params::<Obj>("()").run(&broken, &cx).unwrap_err(),
        params::<Ply>("()").run(&broken, &cx).unwrap_err(),
        params::<Preview>("()").run(&broken, None, &cx).unwrap_err(),
    ];
    for error in errors {
        assert_eq!(error.to_string(), "mesh \"back\" has a vertex that is not finite");
    }
}

#[test]
fn faults_of_a_model_are_named() {
    let check = |change: &dyn Fn(&mut Model)| {
        let mut model = model();
        change(&mut model);
        params::<Glb>("()").run(&model, &Context::quiet()).unwrap_err().to_string()
    };
    assert_eq!(check(&|m| m.meshes.clear()), "the model has no triangle");
    assert_eq!(
        check(&|m| m.meshes[0].triangles[0][0] = 9999),
        "mesh \"front\" has a triangle with a vertex that does not exist"
    );
    assert_eq!(check(&|m| m.meshes[0].uv.clear()), "mesh \"front\" has a texture but no texture coordinates");
    assert_eq!(check(&|m| m.textures.clear()), "mesh \"front\" has a texture that does not exist");
    assert_eq!(check(&|m| m.materials.clear()), "mesh \"front\" has no material");
    assert_eq!(
        check(&|m| m.meshes[0].uv[3][0] = f32::INFINITY),
        "mesh \"front\" has not one finite texture coordinate for each vertex"
    );
    assert_eq!(
        check(&|m| m.meshes[0].normals.clear()),
        "mesh \"front\" has not one finite normal for each vertex"
    );
}

#[test]
fn file_names_stay_in_their_folder() {
    for good in ["garment", "my vest", "vest-2.1", "Größe_38"] {
        assert!(check_name(good).is_ok(), "{good}");
    }
    for bad in ["", "..", ".hidden", "a/b", "a\\b", "C:", "a\nb", "end.", "x\0", "<b>"] {
        assert!(check_name(bad).is_err(), "{bad:?}");
    }
    let error = params::<Glb>("(name: \"../x\")").run(&model(), &Context::quiet()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the file name \"../x\" has a character other than letters, digits, space, '-', '_' and '.'"
    );
    assert_eq!(error.param, Some("name"));
}

#[test]
fn preview_draws_further_sides_on_request() {
    let preview = params::<Preview>("(size: 100, turns: [0, 60])");
    let files = preview.run(&model(), None, &Context::quiet()).unwrap().0;
    let bytes = |name: &str| &files.iter().find(|f| f.path == name).unwrap().bytes;
    assert_eq!(bytes("turn_000.png"), bytes("front.png"));
    assert_ne!(bytes("turn_060.png"), bytes("front.png"));
    let twice = params::<Preview>("(turns: [60, 60])").run(&model(), None, &Context::quiet()).unwrap_err();
    assert_eq!(twice.message, "`turns` has 60 twice");
}

#[test]
fn preview_shows_the_whole_body_on_request() {
    let redness = |text: &str| {
        let files = params::<Preview>(text).run(&model(), None, &Context::quiet()).unwrap().0;
        let picture = image::load_from_memory(&files[0].bytes).unwrap().to_rgb8();
        picture.pixels().filter(|p| i32::from(p.0[0]) > i32::from(p.0[2]) + 40).count()
    };
    assert!(
        redness("(size: 100, frame: Whole)") * 3 < redness("(size: 100)"),
        "the garment is small in the whole"
    );
}

/// A run with every kind of picture, some of it hostile.
fn run_log() -> RunLog {
    let record = |id: &str, role: Role, outputs: Vec<PortValue>| StageRecord {
        id: id.to_owned(),
        name: id.to_owned(),
        role,
        params: "(bias: 3.0)".to_owned(),
        wall_s: 0.25,
        outputs,
        figures: vec![Measure {
            name: "threshold".into(),
            value: 131.0,
            unit: "grey levels",
            tolerance: 0.0,
        }],
        remarks: Remarks {
            warnings: vec!["<script>alert(1)</script> & \"more\"".to_owned()],
            ..Remarks::default()
        },
        used: None,
        predicted: (id == "Glb").then(|| Predicted {
            wall_s: Some(Estimate { value: 0.2, low: 0.1, high: 0.4 }),
            ..Predicted::default()
        }),
    };
    let mut figures = Figures::default();
    figures.garment.body_penetration =
        Some(toile_core::artifact::PenetrationFigures { vertices: 3, max_m: 0.0025 });
    figures.shortfalls = vec![toile_core::artifact::Shortfall {
        code: ErrorCode::BodyIntersection,
        message: "3 vertices are <inside> the body".to_owned(),
    }];
    RunLog {
        pipeline: "vest <script>".to_owned(),
        failure: None,
        quality: None,
        stages: vec![
            record("Photos", Role::Reader, vec![photos()]),
            record("Mannequin", Role::Body, vec![one(photographed::body())]),
            record("Drape#2", Role::Draper, vec![one(photographed::garment(6))]),
            record("PhotoTexturer", Role::Texturer, vec![one(model())]),
            record("Glb", Role::Writer, vec![one(OutputFiles::one("garment.glb", vec![0; 2048]))]),
            record("Measure", Role::Writer, vec![one(figures)]),
            record("Empty", Role::Style, Vec::new()),
        ],
        skipped: vec![("Flatten".to_owned(), "nothing asked for <needs> it".to_owned())],
    }
}

fn report(run: &RunLog, text: &str) -> String {
    let file = params::<Report>(text).run(run, &Context::quiet()).unwrap().0.remove(0);
    assert_eq!(file.path, "report.html");
    String::from_utf8(file.bytes).unwrap()
}

/// Every tag closed in order; the tags without content left out.
fn assert_balanced(html: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in html.split('<').skip(1) {
        let tag = &tag[..tag.find('>').expect("a tag ends")];
        let name = tag.trim_start_matches('/').split([' ', '\n']).next().unwrap();
        match name {
            "!DOCTYPE" | "meta" | "img" => {}
            _ if tag.starts_with('/') => assert_eq!(open.pop(), Some(name)),
            _ => open.push(name),
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn the_report_names_the_quality_of_the_run_where_there_is_one() {
    let plain = report(&run_log(), "(pictures: 80)");
    assert!(plain.contains(" s</p>\n</header>"), "a report without one is as it was");
    let draft = RunLog { quality: Some("Draft, <changed>".into()), ..run_log() };
    let named = report(&draft, "(pictures: 80)");
    let line = "<p class=\"soft\">quality Draft, &lt;changed&gt;</p>\n";
    assert!(named.replacen(line, "", 1) == plain && named != plain, "one line more and nothing else");
}

#[test]
fn the_report_tells_of_every_stage() {
    let run = run_log();
    let html = report(&run, "(pictures: 80)");
    assert_balanced(&html);
    for stage in &run.stages {
        assert!(html.contains(&format!("<h3>{}</h3>", stage.id)), "{}", stage.id);
    }
    for text in [
        "(bias: 3.0)",
        "131 grey levels",
        "garment.glb (2 kB)",
        "Flatten",
        "250 ms",
        "widest seam gap",
        "2.500 mm",
    ] {
        assert!(html.contains(text), "{text}");
    }
    // Three views, the pieces, two photos, two pictures each of body, garment and model.
    assert_eq!(html.matches("<img ").count(), 3 + 1 + 2 + 2 + 2 + 2);
    assert!(html.len() < 3_000_000);
}

#[test]
fn the_reports_views_are_those_of_a_preview_that_has_drawn_the_model() {
    let mut run = run_log();
    let drawn = report(&run, "(pictures: 32)");
    let preview = params::<Preview>("(size: 700)");
    let mut record = run.stages[4].clone();
    (record.id, record.name, record.params) = ("Preview".into(), "Preview".into(), "(size: 700)".into());
    record.outputs = vec![one(preview.run(&model(), None, &Context::quiet()).unwrap())];
    run.stages.insert(5, record);
    let heads = |html: &str| {
        let sources = html.split("src=\"").skip(1).take(3);
        sources.filter_map(|s| s.split('"').next().map(str::to_owned)).collect::<Vec<_>>()
    };
    let (taken, own) = (report(&run, "(pictures: 32)"), report(&run, "(pictures: 32, views: Drawn)"));
    assert_eq!(heads(&own), heads(&drawn), "drawn for the page");
    assert_ne!(heads(&taken), heads(&drawn), "the preview's, reduced");
    let count = |html: &str| html.matches("<img ").count();
    assert_eq!(count(&taken), count(&own));
    // A smaller preview will not do.
    run.stages[5].params = "(size: 600)".into();
    assert_eq!(heads(&report(&run, "(pictures: 32)")), heads(&drawn));
}

#[test]
fn the_report_of_a_run_that_failed_shows_what_it_left_at_the_head() {
    let mut run = run_log();
    run.stages.truncate(3);
    run.failure = Some(toile_core::Failure {
        stage: "Drape#2".into(),
        message: "a seam stays open".into(),
        hint: None,
        detail: None,
    });
    let html = report(&run, "(pictures: 32)");
    assert_balanced(&html);
    let told = ["front", "back"].map(|side| {
        format!("{side} of what the run left; threads of seams that are not closed are red</figcaption>")
    });
    assert!(told.iter().all(|text| html.contains(text)));
    assert!(!report(&run_log(), "(pictures: 32)").contains("of what the run left"));
}

#[test]
fn the_report_escapes_what_others_wrote() {
    let html = report(&run_log(), "(pictures: 32)");
    assert!(!html.contains("<script>") && !html.contains("<inside>"));
    assert!(html.contains("Misses a limit: 3 vertices are &lt;inside&gt; the body"));
    assert!(html.contains("vest &lt;script&gt;") && html.contains("nothing asked for &lt;needs&gt; it"));
}

#[test]
fn the_report_says_what_was_expected_beside_what_a_stage_took() {
    let html = report(&run_log(), "(pictures: 32)");
    assert_eq!(html.matches("250 ms · 200 ms expected (100 ms to 400 ms)<").count(), 1);
}

#[test]
fn the_report_stands_alone() {
    let html = report(&run_log(), "(pictures: 32)");
    for source in html.split("src=\"").skip(1) {
        assert!(source.starts_with("data:image/"));
    }
    assert!(!html.contains("http") && !html.contains("<link"));
}

#[test]
fn an_empty_run_has_a_report() {
    let html = report(&RunLog::default(), "()");
    assert_balanced(&html);
    assert!(html.contains("A garment") && html.contains("0 stages in 0 ms"));
}

#[test]
fn numbers_are_written_for_people() {
    let written = [
        (0.0, "0"),
        (4021.0, "4\u{202f}021"),
        (-1234567.0, "-1\u{202f}234\u{202f}567"),
        (0.012345, "0.01235"),
        (2.71549, "2.715"),
        (-27.5, "-27.50"),
        (1234.56, "1235"),
        (1e-9, "1.00e-9"),
        (f64::NAN, "not finite"),
    ];
    for (value, text) in written {
        assert_eq!(number(value, ""), text);
    }
    assert_eq!(number(2.0, "mm"), "2 mm");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn plain_names_are_plain_and_differ(names in proptest::collection::vec(".{0,6}", 0..12)) {
        let plain = plain_names(names.iter().map(String::as_str));
        let unique: std::collections::BTreeSet<&String> = plain.iter().collect();
        prop_assert_eq!(unique.len(), names.len());
        let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        prop_assert!(plain.iter().all(|n| !n.is_empty() && n.chars().all(allowed)));
    }

    #[test]
    fn any_text_in_a_run_keeps_the_page_balanced(text in "\\PC{0,40}", seconds in 0.0..100.0) {
        let record = StageRecord {
            id: text.clone(),
            name: text.clone(),
            role: Role::Writer,
            params: text.clone(),
            wall_s: seconds,
            outputs: Vec::new(),
            figures: Vec::new(),
            remarks: Remarks { warnings: vec![text.clone()], ..Remarks::default() },
            used: None,
            predicted: None,
        };
        let (pipeline, quality) = (text.clone(), Some(text.clone()));
        let run = RunLog { pipeline, quality, stages: vec![record], skipped: vec![(text.clone(), text)], failure: None };
        assert_balanced(&report(&run, "()"));
    }
}

#[test]
fn a_sheet_shows_the_photo_and_four_views_in_one_row() {
    let sheet = |photos| {
        let files =
            params::<Preview>("(size: 40, sheet: 100)").run(&model(), photos, &Context::quiet()).unwrap().0;
        assert_eq!(files.last().unwrap().path, "sheet.jpg");
        image::load_from_memory(&files.last().unwrap().bytes).unwrap().into_rgb8()
    };
    let photos = photographed::photos();
    let (w, h) = photos.get("front").unwrap().pixels.dimensions();
    let wide = (f64::from(w) * 100.0 / f64::from(h)).round() as u32;
    assert_eq!(sheet(Some(photos)).dimensions(), (wide + 4 * 80, 100));
    assert_eq!(sheet(None).dimensions(), (4 * 80, 100));
}
