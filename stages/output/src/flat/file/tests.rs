//! Files of all kinds as garments: what they hold beside cloth, and what they are that hold none.
#![allow(clippy::unwrap_used)]

use crate::flat::tests::read_told;
use serde_json::{Value, json};
use toile_core::prelude::*;
use toile_core::testkit::dress;

fn names(garment: &Garment) -> Vec<&str> {
    garment.panels.iter().map(|p| p.name.as_str()).collect()
}

/// Message and remedy.
fn refused(file: &str, bytes: &[u8], rest: &str) -> [String; 2] {
    let e = read_told(file, bytes, rest).unwrap_err();
    [e.message, e.hint.unwrap_or_default()]
}

/// A tube of cloth, 30 cm across and 60 cm high, on an OBJ's vertices from `first` on; lying down
/// if `is_lying`.
fn tube(name: &str, first: usize, radius: f64, is_lying: bool) -> String {
    use std::fmt::Write;
    let around = 24;
    let mut text = format!("o {name}\n");
    for y in [0.0, 0.6] {
        for k in 0..around {
            let angle = f64::from(k) / f64::from(around) * std::f64::consts::TAU;
            let (x, z) = (1.5 * radius * angle.cos(), -0.5 * radius * angle.sin());
            let _ =
                if is_lying { writeln!(text, "v {x} {} {y}", -z) } else { writeln!(text, "v {x} {y} {z}") };
        }
    }
    for k in 0..around as usize {
        let at = |row: usize, k: usize| first + row * 24 + k % 24;
        let _ = writeln!(text, "f {} {} {} {}", at(0, k), at(0, k + 1), at(1, k + 1), at(1, k));
    }
    text
}

/// A closed box around the origin on an OBJ's vertices from `first` on.
fn cube(name: &str, first: usize, half: f64) -> String {
    use std::fmt::Write;
    let mut text = format!("o {name}\n");
    for k in 0..8 {
        let at = |bit: u32| if k >> bit & 1 == 1 { half } else { -half };
        let _ = writeln!(text, "v {} {} {}", at(0), at(1), at(2));
    }
    for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
        let [a, b, c, d] = face.map(|v| v + first);
        let _ = writeln!(text, "f {a} {b} {c} {d}");
    }
    text
}

#[test]
fn what_is_no_model_of_a_garment_is_told_with_what_to_do() {
    assert_eq!(
        refused("dress.obj", b"ply\nformat ascii 1.0\n", ""),
        [
            "\"dress.obj\": it is a PLY, which is not read",
            "export the garment as OBJ, or as one glTF file (.glb), and name that"
        ]
    );
    assert_eq!(
        refused("dress.zprj", b"\x01\x02", "")[0],
        "\"dress.zprj\": it is a project of CLO or Marvelous Designer, which is not read"
    );
    assert_eq!(refused("dress.obj", b"\n", "")[0], "\"dress.obj\": it is an empty file, which is not read");
    assert_eq!(
        refused("lines.obj", b"v 0 0 0\nv 1 0 0\nl 1 2\n", ""),
        [
            "\"lines.obj\": the OBJ holds 2 points, 1 line and no faces",
            "export the garment as a mesh with faces"
        ]
    );
}

#[test]
fn cloth_with_a_thickness_is_refused_as_such() {
    let wall = format!("{}{}", tube("Skirt", 1, 0.2, false), tube("Skirt", 49, 0.198, false));
    // The inner layer faces the other way; rims join both.
    let mut text = String::new();
    for (n, line) in wall.lines().enumerate() {
        let turned = n > 74 && line.starts_with("f ");
        let corners: Vec<&str> = line.split(' ').skip(1).collect();
        text += &if turned {
            format!("f {} {} {} {}\n", corners[3], corners[2], corners[1], corners[0])
        } else {
            format!("{line}\n")
        };
    }
    for k in 0..24 {
        let at = |layer: usize, row: usize, k: usize| 1 + 48 * layer + 24 * row + k % 24;
        text += &format!("f {} {} {} {}\n", at(0, 1, k), at(0, 1, k + 1), at(1, 1, k + 1), at(1, 1, k));
        text += &format!("f {} {} {} {}\n", at(1, 0, k), at(1, 0, k + 1), at(0, 0, k + 1), at(0, 0, k));
    }
    let [what, remedy] = refused("skirt.obj", text.as_bytes(), "");
    assert!(what.starts_with("\"skirt.obj\": the cloth (\"Skirt\") has a thickness: two layers, "), "{what}");
    assert!(
        remedy.starts_with(
            "export the cloth as one layer, without thickness: in CLO and Marvelous Designer choose \"Thin\""
        ),
        "{remedy}"
    );
}

#[test]
fn a_body_beside_the_cloth_is_left_out_and_told() {
    let scene = format!("{}{}", tube("Dress", 1, 0.2, false), cube("Body", 49, 0.1));
    let (garment, told) = read_told("scene.obj", scene.as_bytes(), "").unwrap();
    assert_eq!(names(&garment), ["Dress"]);
    assert_eq!(
        told.warnings,
        ["\"Body\" is closed all around, as bodies, buttons and shoes are, and left out of the garment"]
    );
    // The user may say so beforehand.
    let (garment, told) = read_told("scene.obj", scene.as_bytes(), ", leave_out: [\"Body\"]").unwrap();
    assert_eq!((names(&garment), told.warnings.len()), (vec!["Dress"], 0));
    assert_eq!(
        refused("scene.obj", scene.as_bytes(), ", leave_out: [\"Boddy\"]"),
        [
            "\"scene.obj\" has no object, group or material \"Boddy\" to leave out",
            "did you mean `Body`? it has `Body`, `Dress`"
        ]
    );
    // Alone it is no garment.
    assert_eq!(
        refused("body.obj", cube("Body", 1, 0.1).as_bytes(), "")[0],
        "\"Body\" is closed all around, as a body is: it has no edge from which it could be laid flat"
    );
}

#[test]
fn two_large_things_that_nothing_joins_are_asked_about() {
    let scene = format!("{}{}", tube("Dress", 1, 0.2, false), tube("Body", 49, 0.15, false));
    let (_, told) = read_told("scene.obj", scene.as_bytes(), "").unwrap();
    assert_eq!(
        told.warnings,
        [
            "2 things of \"scene.obj\" are joined to nothing: \"Dress\" and \"Body\"; what is not of the garment is left out by its name (`--set \
             'garment.leave_out=[\"Body\"]'`), and edges that nearly meet are sewn with a larger `weld` (`--set 'garment.weld=\"1 mm\"'`)"
        ]
    );
    let (garment, told) = read_told("scene.obj", scene.as_bytes(), ", leave_out: [\"Body\"]").unwrap();
    assert_eq!((names(&garment), told.warnings.len()), (vec!["Dress"], 0));
}

#[test]
fn a_garment_that_lies_is_asked_about_and_stands_with_the_other_axis_up() {
    let lying = tube("Dress", 1, 0.2, true);
    let (_, told) = read_told("dress.obj", lying.as_bytes(), "").unwrap();
    assert_eq!(told.warnings.len(), 1, "{:?}", told.warnings);
    assert!(told.warnings[0].contains("add `--set garment.up=Z`"), "{:?}", told.warnings);
    let (_, told) = read_told("dress.obj", lying.as_bytes(), ", up: Z").unwrap();
    assert_eq!(told.warnings.len(), 0, "{:?}", told.warnings);
}

/// A GLB of the suite's dress as this program writes it, with its body.
fn written(stage: &str) -> Vec<u8> {
    let stage: crate::write::Glb = toile_core::param::ron_options().from_str(stage).unwrap();
    let (mut model, garment) = (dress::model(), dress::sewn_garment());
    let normals = garment.vertex_normals();
    let cloth = |p: &GarmentPanel| Mesh {
        name: p.name.clone(),
        positions: garment.positions[p.vertices.clone()].to_vec(),
        normals: normals[p.vertices.clone()].to_vec(),
        uv: Vec::new(),
        triangles: garment.triangles[p.triangles.clone()]
            .iter()
            .map(|t| t.map(|v| v - p.vertices.start as u32))
            .collect(),
        material: 0,
    };
    let body = model.meshes.pop();
    model.meshes = garment.panels.iter().map(cloth).chain(body).collect();
    model.materials[0].texture = None;
    model.textures.clear();
    stage.run(&model, &Context::quiet()).unwrap().0.remove(0).bytes
}

#[test]
fn of_a_file_of_this_program_the_cloth_is_taken() {
    let sewn = dress::sewn_garment();
    for stage in ["()", "(quantise: true)"] {
        let (garment, told) = read_told("garment.glb", &written(stage), ", weld: \"0.1 mm\"").unwrap();
        assert_eq!(names(&garment), ["front", "back"], "{stage}");
        assert_eq!((garment.triangles.len(), garment.seams.len()), (sewn.triangles.len(), 2), "{stage}");
        assert_eq!(told.warnings.len(), 0, "{:?}", told.warnings);
        assert_eq!(
            told.notes[0],
            "\"garment.glb\" was written by this program: the cloth is taken, without the body"
        );
    }
}

/// The bytes of a GLB with this JSON and no binary part.
fn glb(json: &Value) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = |n: usize| (n as u32).to_le_bytes();
    [b"glTF", &2_u32.to_le_bytes(), &length(20 + json.len()), &length(json.len()), b"JSON", &json[..]]
        .concat()
}

#[test]
fn a_glb_that_is_compressed_or_lies_in_several_files_is_refused_by_name() {
    let file = |more: Value| {
        let mut root = json!({
            "asset": { "version": "2.0" },
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "accessors": [{ "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1], "bufferView": 0 }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "buffers": [{ "byteLength": 36 }],
        });
        for (key, value) in more.as_object().unwrap() {
            root[key] = value.clone();
        }
        refused("dress.glb", &glb(&root), "")
    };
    assert_eq!(
        file(json!({ "extensionsRequired": ["KHR_draco_mesh_compression"] })),
        [
            "\"dress.glb\": its mesh is compressed (KHR_draco_mesh_compression), which is not read",
            "export it without compression (in Blender's glTF export, leave \"Compression\" off), or as OBJ"
        ]
    );
    assert_eq!(
        file(json!({ "buffers": [{ "byteLength": 36, "uri": "dress.bin" }] })),
        [
            "\"dress.glb\": its buffer \"dress.bin\" is not in the .glb file itself",
            "write it again as one .glb file with its buffers in it, or as OBJ"
        ]
    );
    assert_eq!(file(json!({}))[0], "\"dress.glb\": the file has no binary part, which holds the mesh");
    // A picture that its library does not know is no matter.
    let basis = json!({ "extensionsRequired": ["KHR_texture_basisu"], "textures": [{ "extensions": { "KHR_texture_basisu": { "source": 0 } } }] });
    assert_eq!(file(basis)[0], "\"dress.glb\": the file has no binary part, which holds the mesh");
}
