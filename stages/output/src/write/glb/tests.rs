//! GLB files are read back by another library, and their JSON by hand.

#![allow(clippy::unwrap_used, clippy::panic)]

use super::super::tests::{model, model_with, params};
use super::Glb;
use serde_json::{Value, json};
use toile_core::prelude::*;
use toile_fixtures::photographed;

fn glb_file(model: &Model, text: &str) -> Vec<u8> {
    params::<Glb>(text).run(model, &Context::quiet()).unwrap().0.remove(0).bytes
}

/// The JSON chunk of a GLB file.
fn json_chunk(file: &[u8]) -> Value {
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&file[20..20 + length]).unwrap()
}

#[test]
fn glb_is_read_back_with_all_its_geometry() {
    let model = model();
    let file = glb_file(&model, "()");
    let read = gltf::Gltf::from_slice(&file).unwrap();
    let blob = read.blob.clone().unwrap();
    assert_eq!(read.meshes().len(), 3);
    for (mesh, ours) in read.meshes().zip(&model.meshes) {
        assert_eq!(mesh.name(), Some(ours.name.as_str()));
        let primitive = mesh.primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&blob));
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let want: Vec<[f32; 3]> =
            ours.positions.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
        assert_eq!(positions, want);
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        assert_eq!(indices, ours.triangles.concat());
        let uv: Vec<[f32; 2]> = reader.read_tex_coords(0).map(|t| t.into_f32().collect()).unwrap_or_default();
        assert_eq!(uv, ours.uv);
        for n in reader.read_normals().unwrap() {
            assert!((n.iter().map(|c| c * c).sum::<f32>() - 1.0).abs() < 1e-5);
        }
        let bounds = primitive.bounding_box();
        let least = want.iter().fold([f32::MAX; 3], |a, p| [0, 1, 2].map(|k| a[k].min(p[k])));
        let most = want.iter().fold([f32::MIN; 3], |a, p| [0, 1, 2].map(|k| a[k].max(p[k])));
        assert_eq!((bounds.min, bounds.max), (least, most));
    }
}

#[test]
fn glb_holds_its_textures() {
    let model = model();
    let kept =
        [("(power_of_two: false)", "image/jpeg"), ("(textures: Png, power_of_two: false)", "image/png")];
    for (text, mime) in kept {
        let read = gltf::Gltf::from_slice(&glb_file(&model, text)).unwrap();
        let blob = read.blob.clone().unwrap();
        assert_eq!(read.images().len(), 2);
        for (image, ours) in read.images().zip(&model.textures) {
            let gltf::image::Source::View { view, mime_type } = image.source() else {
                panic!("not in the file")
            };
            assert_eq!(mime_type, mime);
            let bytes = &blob[view.offset()..view.offset() + view.length()];
            let decoded = image::load_from_memory(bytes).unwrap().to_rgb8();
            assert_eq!(decoded.dimensions(), ours.pixels.dimensions());
            assert!(mime != "image/png" || decoded == *ours.pixels);
        }
    }
}

#[test]
fn glb_marks_replaced_colours_as_unlit() {
    let unlit = json_chunk(&glb_file(&model_with("(light: Replace)"), "()"));
    assert_eq!(unlit["extensionsUsed"], json!(["KHR_materials_unlit"]));
    assert_eq!(unlit["materials"][0]["extensions"], json!({ "KHR_materials_unlit": {} }));
    assert_eq!(unlit["materials"][0]["doubleSided"], true);
    assert!(unlit["materials"][2]["extensions"].is_null(), "the body stays lit");
}

#[test]
fn glb_gives_cloth_its_sheen_and_the_name_of_its_fabric() {
    let shiny = json_chunk(&glb_file(&model_with("(sheen: 0.25)"), "()"));
    assert_eq!(shiny["extensionsUsed"], json!(["KHR_materials_sheen"]));
    let sheen = json!({ "sheenColorFactor": [0.25, 0.25, 0.25], "sheenRoughnessFactor": 0.5 });
    assert_eq!(shiny["materials"][0]["extensions"], json!({ "KHR_materials_sheen": sheen }));
    assert_eq!(shiny["materials"][0]["extras"], json!({ "fabric": "test cloth" }));
    let matt = json_chunk(&glb_file(&model_with("(sheen: 0.0)"), "()"));
    assert!(matt["extensionsUsed"].is_null() && matt["materials"][0]["extensions"].is_null());
}

#[test]
fn glb_says_its_unit_its_fabrics_and_whose_it_is() {
    let model = model();
    let asset = json_chunk(&glb_file(&model, "(copyright: Some(\"2026 A. Tailor\"))"))["asset"].clone();
    let extras = json!({ "units": "m", "fabrics": ["test cloth"], "digest": super::digest(&model) });
    assert_eq!((&asset["extras"], &asset["copyright"]), (&extras, &json!("2026 A. Tailor")));
    assert_eq!(extras["digest"].as_str().map(str::len), Some(64));
    let fault = |note: &str| {
        let text = format!("(copyright: Some({note:?}))");
        params::<Glb>(&text).run(&model, &Context::quiet()).unwrap_err()
    };
    let hint = "give one line such as \"2026 A. Tailor, all rights reserved\", or leave it out";
    assert_eq!(fault(" ").to_string(), "the `copyright` is empty");
    assert_eq!(fault("a\nb").to_string(), "the `copyright` has a line break or another control character");
    assert_eq!((fault("").param, fault("").hint.as_deref()), (Some("copyright"), Some(hint)));
}

#[test]
fn glb_without_the_body_has_nothing_of_it() {
    let json = json_chunk(&glb_file(&model(), "(body: false)"));
    let names =
        |list: &str| json[list].as_array().unwrap().iter().map(|m| m["name"].clone()).collect::<Vec<_>>();
    assert_eq!(
        (names("meshes"), names("materials")),
        (vec![json!("front"), json!("back")], vec![json!("front"), json!("back")])
    );
    let mut only_body = model();
    only_body.meshes.drain(..2);
    let error = params::<Glb>("(body: false)").run(&only_body, &Context::quiet()).unwrap_err();
    assert_eq!(error.to_string(), "`body: false` leaves nothing to write");
    assert_eq!(error.hint.as_deref(), Some("the model holds only the body: leave out `body: false`"));
}

#[test]
fn glb_brings_textures_to_powers_of_two() {
    let model = model();
    let read = gltf::Gltf::from_slice(&glb_file(&model, "(textures: Png)")).unwrap();
    let blob = read.blob.clone().unwrap();
    for image in read.images() {
        let gltf::image::Source::View { view, .. } = image.source() else { panic!("not in the file") };
        let bytes = &blob[view.offset()..view.offset() + view.length()];
        let (w, h) = image::load_from_memory(bytes).unwrap().to_rgb8().dimensions();
        assert!(w.is_power_of_two() && h.is_power_of_two(), "{w} x {h}");
    }
    let ours = model.textures[0].pixels.dimensions();
    assert!(!ours.0.is_power_of_two() || !ours.1.is_power_of_two(), "{ours:?}");
}

#[test]
fn glb_writes_tangents_across_the_normals_beside_a_normal_map() {
    let file = glb_file(&model_with("(detail: Photo)"), "()");
    let json = json_chunk(&file);
    assert_eq!(json["materials"][1]["normalTexture"], json!({ "index": 3 }));
    let read = gltf::Gltf::from_slice(&file).unwrap();
    let blob = read.blob.clone().unwrap();
    let mut signs = Vec::new();
    for mesh in read.meshes().take(2) {
        let primitive = mesh.primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&blob));
        for (n, t) in reader.read_normals().unwrap().zip(reader.read_tangents().unwrap()) {
            let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
            assert!(dot(&n, &t[..3]).abs() < 1e-5 && (dot(&t[..3], &t[..3]) - 1.0).abs() < 1e-5);
            signs.push(t[3]);
        }
    }
    // The back's photo is mirrored.
    let half = signs.len() / 2;
    assert!(signs[..half].iter().all(|s| *s == 1.0) && signs[half..].iter().all(|s| *s == -1.0));
    assert!(json["meshes"][2]["primitives"][0]["attributes"]["TANGENT"].is_null(), "the body has none");
    let plain = json_chunk(&glb_file(&model(), "()"));
    assert!(plain["meshes"][0]["primitives"][0]["attributes"]["TANGENT"].is_null(), "no map, no tangents");
}

#[test]
fn glb_names_variants_and_what_each_mesh_wears() {
    let mut two = model();
    let mut other = two.clone();
    other.materials[0].colour = [1.0, 0.0, 0.0];
    two.add_variant("plain", "red front", &other).unwrap();
    let file = glb_file(&two, "()");
    let json = json_chunk(&file);
    assert_eq!(json["extensionsUsed"], json!(["KHR_materials_sheen", "KHR_materials_variants"]));
    let names = json!([{ "name": "plain" }, { "name": "red front" }]);
    assert_eq!(json["extensions"]["KHR_materials_variants"]["variants"], names);
    let mappings = json!([{ "material": 0, "variants": [0] }, { "material": 3, "variants": [1] }]);
    let front = &json["meshes"][0]["primitives"][0];
    assert_eq!(front["extensions"]["KHR_materials_variants"]["mappings"], mappings);
    assert!(json["meshes"][1]["primitives"][0]["extensions"].is_null(), "the back is the same in both");
    assert_eq!(json["materials"].as_array().unwrap().len(), 4);
    let fault = |model: &Model| params::<Glb>("()").run(model, &Context::quiet()).unwrap_err().to_string();
    two.variants[1].materials[2] = 0;
    assert_eq!(fault(&two), "variant \"red front\" has a texture but no texture coordinates", "on the body");
    two.variants[1].materials.pop();
    assert_eq!(fault(&two), "variant \"red front\" has not one material for each mesh");
}

#[test]
fn a_quantised_glb_is_read_back_to_a_step_of_its_grid() {
    let model = model_with("(detail: Photo)");
    let file = glb_file(&model, "(quantise: true)");
    assert!(file.len() < glb_file(&model, "()").len());
    let json = json_chunk(&file);
    assert_eq!(json["extensionsRequired"], json!(["KHR_mesh_quantization"]));
    let start = 20 + u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize + 8;
    let accessor = |mesh: usize, name: &str| {
        let a = &json["accessors"]
            [json["meshes"][mesh]["primitives"][0]["attributes"][name].as_u64().unwrap() as usize];
        let view = &json["bufferViews"][a["bufferView"].as_u64().unwrap() as usize];
        let number = |v: &Value| v.as_u64().unwrap() as usize;
        let from = start + number(&view["byteOffset"]);
        (a.clone(), number(&view["byteStride"]), file[from..from + number(&view["byteLength"])].to_vec())
    };
    for (i, mesh) in model.meshes.iter().enumerate() {
        let half = json["nodes"][i]["scale"][0].as_f64().unwrap();
        let (a, stride, bytes) = accessor(i, "POSITION");
        assert_eq!((&a["componentType"], &a["normalized"], stride), (&json!(5122), &json!(true), 8));
        for (p, row) in mesh.positions.iter().zip(bytes.chunks_exact(stride)) {
            for k in 0..3 {
                let step = i16::from_le_bytes([row[2 * k], row[2 * k + 1]]);
                let centre = json["nodes"][i]["translation"][k].as_f64().unwrap();
                let back = centre + half * f64::from(step) / 32767.0;
                assert!((back - p[k]).abs() <= 0.51 * half / 32767.0, "{back} {}", p[k]);
                assert!(
                    a["min"][k].as_i64() <= Some(step.into()) && a["max"][k].as_i64() >= Some(step.into())
                );
            }
        }
        let (_, stride, bytes) = accessor(i, "NORMAL");
        for (n, row) in mesh.normals.iter().zip(bytes.chunks_exact(stride)) {
            assert!((0..3).all(|k| (f64::from(row[k] as i8) / 127.0 - n[k]).abs() < 0.005));
        }
    }
}

#[test]
fn glb_keeps_the_formats_alignment() {
    let file = glb_file(&model(), "()");
    assert_eq!(&file[..8], b"glTF\x02\0\0\0");
    assert_eq!(u32::from_le_bytes(file[8..12].try_into().unwrap()) as usize, file.len());
    assert_eq!(file.len() % 4, 0);
    let json = json_chunk(&file);
    assert!(
        json["bufferViews"].as_array().unwrap().iter().all(|v| v["byteOffset"].as_u64().unwrap() % 4 == 0)
    );
}

#[test]
fn glb_without_textures_has_no_empty_list() {
    let model = crate::render::garment_model(&photographed::garment(4), None);
    let file = glb_file(&model, "()");
    let json = json_chunk(&file);
    assert!(json["images"].is_null() && json["samplers"].is_null());
    assert_eq!(gltf::Gltf::from_slice(&file).unwrap().meshes().len(), 2);
}

#[test]
fn glb_counts_beyond_16_bits() {
    let model = crate::render::garment_model(&photographed::garment(260), None);
    assert!(model.meshes[0].positions.len() > 65_535);
    let read = gltf::Gltf::from_slice(&glb_file(&model, "()")).unwrap();
    let blob = read.blob.clone().unwrap();
    let primitive = read.meshes().next().unwrap().primitives().next().unwrap();
    let indices: Vec<u32> = primitive.reader(|_| Some(&blob)).read_indices().unwrap().into_u32().collect();
    assert_eq!(indices, model.meshes[0].triangles.concat());
}

#[test]
fn glb_gives_the_wrong_side_a_mesh_of_its_own() {
    let mut model = model();
    model.materials[0].wrong_side = Some([0.2, 0.1, 0.1]);
    let json = json_chunk(&glb_file(&model, "(body: false)"));
    let names: Vec<&str> =
        json["meshes"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["front", "back", "front wrong side"]);
    let material = |mesh: usize| {
        &json["materials"][json["meshes"][mesh]["primitives"][0]["material"].as_u64().unwrap() as usize]
    };
    assert_eq!((&material(0)["doubleSided"], &material(2)["doubleSided"]), (&json!(false), &json!(false)));
    let colour: Vec<f64> = material(2)["pbrMetallicRoughness"]["baseColorFactor"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect();
    assert!((colour[0] - 0.2).abs() < 1e-6 && (colour[1] - 0.1).abs() < 1e-6);
}
