//! Garments from files, and their patterns.
#![allow(clippy::unwrap_used)]

use super::{Arap, FlatTable, Garment3d, Lscm, SpringFlatten, SymmetricDirichlet, Woven};
use proptest::prelude::*;
use std::sync::{Arc, LazyLock};
use toile_core::param::ron_options;
use toile_core::prelude::*;
use toile_core::testkit::dress;
use toile_core::{Cancel, Remarks};

/// Reads a file of these bytes with these parameters; gives its warnings.
fn read_as(file: &str, bytes: &[u8], rest: &str) -> Result<(Garment, Vec<String>), StageError> {
    let (garment, remarks) = read_told(file, bytes, rest)?;
    Ok((garment, remarks.warnings))
}

/// Reads a file of these bytes with these parameters.
pub(super) fn read_told(file: &str, bytes: &[u8], rest: &str) -> Result<(Garment, Remarks), StageError> {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join(file), bytes).unwrap();
    let cx = Context::new("Garment3d", dir.path(), Cancel::new(), Arc::new(()));
    let stage: Garment3d = ron_options().from_str(&format!("(file: {file:?}{rest})")).unwrap();
    let garment = stage.run(None, &cx)?;
    garment.check().unwrap();
    Ok((garment, cx.take_remarks()))
}

fn read(text: &str, rest: &str) -> Result<(Garment, Vec<String>), StageError> {
    read_as("garment.obj", text.as_bytes(), rest)
}

fn refused(text: &str, rest: &str) -> (String, String) {
    let e = read(text, rest).unwrap_err();
    (e.message, e.hint.unwrap_or_default())
}

fn names(garment: &Garment) -> Vec<&str> {
    garment.panels.iter().map(|p| p.name.as_str()).collect()
}

/// Two squares of 1 m that meet at an edge, folded along it.
const BOOK: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\n";

#[test]
fn pieces_are_told_by_groups_materials_lines_texture_or_parts() {
    let faces = |a: &str, b: &str| format!("{BOOK}{a}f 1 2 3\nf 1 3 4\n{b}f 2 5 6\nf 2 6 3\n");
    let (garment, _) = read(&faces("g front\n", "g back\n"), "").unwrap();
    assert_eq!((names(&garment), garment.seams.len()), (vec!["front", "back"], 1));
    assert_eq!(garment.seams[0].name, "front + back");
    assert_eq!((garment.seams[0].pairs.len(), garment.seam_gap_max()), (2, 0.0));
    let (garment, _) = read(&faces("usemtl red\n", "usemtl blue\n"), "").unwrap();
    assert_eq!(names(&garment), ["red", "blue"]);
    let (garment, _) = read(&(faces("", "") + "l 2 3\n"), "").unwrap();
    assert_eq!((names(&garment), garment.seams.len()), (vec!["piece_1", "piece_2"], 1));
    let (garment, _) = read(&faces("", ""), "").unwrap();
    assert_eq!((names(&garment), garment.seams.len()), (vec!["piece_1"], 0));
    let uv = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 3 0\nvt 3 1\nvt 2 1\n";
    let faces = "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 2/5 5/6 6/7\nf 2/5 6/7 3/8\n";
    let (garment, _) = read(&format!("{BOOK}{uv}{faces}"), ", flat: Uv").unwrap();
    assert_eq!((names(&garment), garment.seams.len()), (vec!["piece_1", "piece_2"], 1));
    assert!((garment.panel_areas(&garment.panels[1]).0 - 1.0).abs() < 1e-12);
}

#[test]
fn damage_is_mended_and_counted() {
    // The second square has vertices of its own, one triangle stands twice, one has no area, one
    // faces the other way.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 1 0 1\nv 1 1 1\nv 1 1 0.000001\n\
        f 1 2 3\nf 1 4 3\nf 3 1 2\nf 1 2 2\nf 5 6 7\nf 5 7 8\n";
    let (garment, told) = read(text, ", pieces: Parts").unwrap();
    assert_eq!((garment.triangles.len(), garment.panels.len(), garment.seams.len()), (4, 2, 1));
    assert_eq!(
        told,
        [
            "\"garment.obj\" was repaired: 1 triangle without area is removed, 1 triangle that is listed twice is removed, \
             1 triangle is turned to face as its neighbours"
        ]
    );
    // Three squares at one edge.
    let text = format!("{BOOK}v 2 0 0\nv 2 1 0\nf 1 2 3\nf 1 3 4\nf 2 5 6\nf 2 6 3\nf 2 7 8\nf 2 8 3\n");
    let (garment, told) = read(&text, "").unwrap();
    assert_eq!(garment.panels.len(), 3);
    assert_eq!(told, ["\"garment.obj\" was repaired: 1 edge of three triangles or more is cut"]);
}

#[test]
fn what_cannot_be_a_garment_is_refused_with_a_remedy() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let told = |text: &str, rest: &str| {
        let (message, hint) = refused(text, rest);
        format!("{message} / {hint}")
    };
    assert_eq!(
        told(square, ", unit: Millimetres"),
        "the garment would measure 0.0014 m from corner to corner / state the unit of the file's numbers, such as `unit: Metres` \
         (`--set garment.unit=Metres`)"
    );
    assert_eq!(
        told(square, ", pieces: Groups"),
        "the file has no second group to separate the pieces by / give each piece a group, or write another word for `pieces`, such as `Auto`"
    );
    assert_eq!(
        told(square, ", pieces: Uv"),
        "the file has no texture points on all triangles to separate the pieces by / unwrap it, or write another word for `pieces`, such as `Auto`"
    );
    let bag = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    assert_eq!(
        told(bag, ""),
        "the mesh is closed all around, as a body is: it has no edge from which it could be laid flat / export the garment without the body; what \
         is closed and is to be cut, such as a cushion, needs seams: mark them as edges (lines), or unwrap it along them"
    );
    assert_eq!(
        told("v 0 0 0\n", ""),
        "\"garment.obj\": the OBJ holds 1 point and no faces / export the garment as a mesh with faces"
    );
    let e = read_as("garment.glb", b"glTF\x02\0\0\0", "").unwrap_err();
    assert!(e.message.starts_with("\"garment.glb\": it is no sound GLB ("), "{}", e.message);
    assert_eq!(e.hint.unwrap(), "write it again as one .glb file with its buffers in it, or as OBJ");
    let e = Garment3d::default().run(None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "no file is named to read the garment from");
}

/// A tube of two panels, flat before.
fn tube() -> Garment {
    dress::sewn_garment()
}

type Flat = (Pattern, Garment);

fn flatteners() -> Vec<(&'static str, Flat)> {
    let (g, cx) = (tube(), Context::quiet());
    vec![
        ("Arap", Arap::default().run(&g, None, &cx).unwrap()),
        ("Lscm", Lscm::default().run(&g, None, &cx).unwrap()),
        ("SpringFlatten", SpringFlatten::default().run(&g, None, &cx).unwrap()),
        ("SymmetricDirichlet", SymmetricDirichlet::default().run(&g, None, &cx).unwrap()),
        ("Woven", Woven::default().run(&g, None, &cx).unwrap()),
    ]
}

#[test]
fn a_tube_comes_back_as_the_panels_that_it_was_sewn_from() {
    let sewn = tube();
    for (name, (pattern, flat)) in flatteners() {
        pattern.check().unwrap();
        flat.check().unwrap();
        assert_eq!((pattern.pieces.len(), pattern.seams.len()), (2, 2), "{name}");
        for (panel, before) in flat.panels.iter().zip(&sewn.panels) {
            assert_eq!(panel.name, before.name);
            let (area, was) = (flat.panel_areas(panel).0, sewn.panel_areas(before).0);
            // The mesh's chords cut a little off the round tube.
            assert!((area / was - 1.0).abs() < 0.01, "{name}: {area} {was}");
        }
        let kinds: Vec<SeamKind> = pattern.seams.iter().map(|s| s.kind).collect();
        assert_eq!(kinds, [SeamKind::Matched; 2], "{name}");
        for seam in &pattern.seams {
            let lengths: Vec<f64> = seam.sides.iter().map(|s| pattern.side_length(s)).collect();
            // No care makes them equal where angles are kept.
            let near = if name == "Lscm" { 1e-3 } else { 1e-6 };
            assert!(
                (lengths[0] - lengths[1]).abs() < near && (lengths[0] - 0.5).abs() < 1e-3,
                "{name}: {lengths:?}"
            );
        }
        let lowered = pattern.lower().unwrap();
        assert_eq!(lowered.plan.seams.len(), 2, "{name}");
    }
}

#[test]
fn edges_are_called_by_the_garments_seams_and_pieces_know_their_place() {
    let (pattern, _) = Arap::default().run(&tube(), Some(&dress::pattern()), &Context::quiet()).unwrap();
    let front = pattern.piece("front").unwrap();
    assert!(front.edge_number("side_left").is_some() && front.edge_number("side_right").is_some());
    assert_eq!(front.body_part, Some(BodyPart::Body));
    let pose = front.pose.unwrap();
    assert!(pose.outside().z > 0.9 && pose.along.y > 0.99, "{pose:?}");
    let back = pattern.piece("back").unwrap().pose.unwrap();
    assert!(back.outside().z < -0.9, "{back:?}");
    let [foot, head] = front.grain.unwrap();
    assert!(head.y > foot.y && head.x == foot.x);
}

#[test]
fn a_stretched_knit_comes_out_smaller_by_its_tension() {
    let stage: Arap = ron_options().from_str("(tension: (0.1, 0.2))").unwrap();
    let (_, flat) = stage.run(&tube(), None, &Context::quiet()).unwrap();
    let (area, was) = (flat.panel_areas(&flat.panels[0]).0, tube().panel_areas(&tube().panels[0]).0);
    assert!((area * 1.1 * 1.2 / was - 1.0).abs() < 0.01, "{area} {was}");
}

/// A shallow cone of 60 cm across, with its rim open: too round to lie flat.
fn cone() -> String {
    use std::fmt::Write;
    let (rings, around) = (8_usize, 24_usize);
    let mut text = String::from("v 0 0.15 0\n");
    for r in 1..=rings {
        for k in 0..around {
            let (radius, angle) =
                (0.3 * r as f64 / rings as f64, k as f64 / around as f64 * std::f64::consts::TAU);
            let _ = writeln!(
                text,
                "v {} {} {}",
                radius * angle.cos(),
                0.15 - 0.5 * radius,
                -radius * angle.sin()
            );
        }
    }
    let at = |r: usize, k: usize| 2 + (r - 1) * around + k % around;
    for k in 0..around {
        let _ = writeln!(text, "f 1 {} {}", at(1, k), at(1, k + 1));
        for r in 1..rings {
            let _ = writeln!(text, "f {} {} {} {}", at(r, k), at(r + 1, k), at(r + 1, k + 1), at(r, k + 1));
        }
    }
    text
}

#[test]
fn a_dart_takes_out_of_a_cone_what_cannot_lie_flat() {
    let (garment, _) = read(&cone(), "").unwrap();
    let cx = Context::quiet();
    let run = |darts: &str| {
        let stage: Arap = ron_options().from_str(&format!("(darts: {darts})")).unwrap();
        stage.run(&garment, None, &cx).unwrap()
    };
    let (plain, _) = run("None");
    assert!(plain.seams.is_empty() && plain.pieces[0].lines.is_empty());
    let (proposed, _) = run("Propose");
    assert!(proposed.seams.is_empty() && !proposed.pieces[0].lines.is_empty());
    assert!(
        cx.take_remarks()
            .warnings
            .iter()
            .any(|w| w.starts_with("darts would help, and none is cut: on \"piece_1\" dart 1"))
    );
    let (cut, flat) = run("Auto(max_strain: 1.5)");
    assert_eq!(cut.seams[0].kind, SeamKind::Dart);
    let lengths: Vec<f64> = cut.seams[0].sides.iter().map(|s| cut.side_length(s)).collect();
    assert!((lengths[0] / lengths[1] - 1.0).abs() < 1e-6, "{lengths:?}");
    let strain = |g: &Garment| quantile(&g.edge_strains(), 0.99);
    let (_, uncut) = run("None");
    assert!(strain(&flat) < 0.2 * strain(&uncut), "{} {}", strain(&flat), strain(&uncut));
    assert_eq!(run("Auto(max_strain: 99)").0.seams.len(), 0, "cloth that bears all needs none");
    let stage: Arap = ron_options().from_str("(darts: Auto(max_strain: 0))").unwrap();
    let e = stage.run(&garment, None, &cx).unwrap_err();
    assert_eq!(e.message, "a strain of 0 per cent is not between 0.01 and 100");
}

#[test]
fn the_table_tells_errors_strain_seams_and_the_distance_from_the_true_pieces() {
    let (sewn, cx) = (tube(), Context::quiet());
    let (pattern, flat) = Arap::default().run(&sewn, None, &cx).unwrap();
    let files = FlatTable::default().run(&flat, Some(&sewn), Some(&pattern), &cx).unwrap();
    assert_eq!(files.0.iter().map(|f| f.path.as_str()).collect::<Vec<_>>(), ["flat.json", "flat_strain.svg"]);
    let table: serde_json::Value = serde_json::from_slice(&files.0[0].bytes).unwrap();
    let front = &table["pieces"][0];
    assert_eq!(front["name"], "front");
    let number = |v: &serde_json::Value| v.as_f64().unwrap();
    assert!(number(&front["area_error_3d_to_2d"]).abs() < 1e-3, "{front}");
    assert!(number(&front["true_piece"]["outline_distance_max_mm"]) < 4.0, "{front}");
    assert!(number(&front["true_piece"]["area_error"]).abs() < 0.01);
    assert_eq!(front["corners"].as_array().unwrap().len(), 4);
    assert!(number(&front["corners"][0]["angle_2d_deg"]) > 85.0);
    assert!(number(&table["seams"][0]["mismatch"]) < 1e-6);
    let picture = std::str::from_utf8(&files.0[1].bytes).unwrap();
    roxmltree::Document::parse(picture).unwrap();
    assert_eq!(picture.matches("<image").count(), 2);
    // Without a known pattern there is nothing to hold it against.
    let (garment, _) = read(&cone(), "").unwrap();
    let e = FlatTable::default().run(&garment, None, None, &cx).unwrap_err();
    assert_eq!(e.message, "the flat shape of piece \"piece_1\" is not known");
    let (pattern, flat) = Arap::default().run(&garment, None, &cx).unwrap();
    let files = FlatTable::default().run(&flat, Some(&garment), Some(&pattern), &cx).unwrap();
    let table: serde_json::Value = serde_json::from_slice(&files.0[0].bytes).unwrap();
    assert!(table["pieces"][0]["true_piece"].is_null());
}

/// The garment's front as a GLB, with its texture points; its texture takes long to write.
fn glb() -> Vec<u8> {
    static GLB: LazyLock<Vec<u8>> = LazyLock::new(written_glb);
    GLB.clone()
}

fn written_glb() -> Vec<u8> {
    let model = Model { meshes: dress::model().meshes.into_iter().take(1).collect(), ..dress::model() };
    let files = crate::write::Glb::default().run(&model, &Context::quiet()).unwrap();
    files.0.into_iter().next().unwrap().bytes
}

#[test]
fn a_glb_is_read_where_its_nodes_put_it() {
    let (garment, _) = read_as("front.glb", &glb(), "").unwrap();
    let front = &dress::garment().panels[0];
    assert_eq!((names(&garment), garment.triangles.len()), (vec!["front"], front.triangles.len()));
    let (area, was) = (garment.panel_areas(&garment.panels[0]).1, 0.54 * 0.5);
    assert!((area - was).abs() < 1e-6, "{area}");
}

#[test]
fn a_glb_that_is_not_what_it_says_is_refused() {
    let told = |json: &str| {
        let json = format!("{{\"asset\":{{\"version\":\"2.0\"}},{json}}}");
        let json = format!("{json:<0$}", json.len().next_multiple_of(4)).into_bytes();
        let length = |n: usize| (n as u32).to_le_bytes();
        let parts = [
            b"glTF",
            &2_u32.to_le_bytes(),
            &length(20 + json.len()),
            &length(json.len()),
            b"JSON",
            &json[..],
        ];
        read_as("garment.glb", &parts.concat(), "").unwrap_err().message
    };
    assert_eq!(
        told(r#""meshes":[{"primitives":[{"attributes":{"POSITION":3}}]}]"#),
        "\"garment.glb\": a mesh names accessor 3, the file has 0"
    );
    let scene = |indices: &str| {
        told(&format!(
            r#""scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "buffers":[{{"byteLength":36}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],
            "accessors":[{{"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1],"bufferView":0}},{{{indices}}}]"#
        ))
    };
    assert_eq!(
        scene(r#""componentType":5126,"count":3,"type":"SCALAR","bufferView":0"#),
        "\"garment.glb\": accessor 1 holds numbers of another kind than its mesh needs"
    );
    assert_eq!(
        scene(r#""componentType":5125,"count":3,"type":"SCALAR","bufferView":0,"byteOffset":40"#),
        "\"garment.glb\": accessor 1 lies outside its part of the file"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_glb_is_read_or_refused(at in 0_usize..4000, byte in any::<u8>(), cut in 0_usize..4000) {
        let mut bytes = glb();
        let n = bytes.len();
        bytes[at % n] = byte;
        bytes.truncate(n - cut % (n / 2));
        let _ = read_as("front.glb", &bytes, "");
    }

    #[test]
    fn any_mesh_becomes_a_pattern_or_is_refused(
        places in prop::collection::vec((-9_i32..9, -9_i32..9, -9_i32..9), 3..14),
        faces in prop::collection::vec((0_usize..14, 0_usize..14, 0_usize..14), 1..24),
    ) {
        use std::fmt::Write;
        let mut text = String::new();
        places.iter().for_each(|(x, y, z)| { let _ = writeln!(text, "v {x} {y} {z}"); });
        let n = places.len();
        faces.iter().for_each(|(a, b, c)| { let _ = writeln!(text, "f {} {} {}", a % n + 1, b % n + 1, c % n + 1); });
        if let Ok((garment, _)) = read(&text, ", unit: Decimetres") {
            let stage: Arap = ron_options().from_str("(iterations: 20, darts: Auto(max_strain: 5))").unwrap();
            if let Ok((pattern, flat)) = stage.run(&garment, None, &Context::quiet()) {
                pattern.check().unwrap();
                flat.check().unwrap();
            }
        }
    }
}
