//! USDZ files are taken apart by a small reader of our own.

#![allow(clippy::unwrap_used)]

use super::super::tests::{model, model_with, params};
use super::{Usdz, zip};
use toile_core::prelude::*;

/// Paths, contents and the places where these begin, by the directory at the archive's end.
fn unpacked(archive: &[u8]) -> Vec<(String, Vec<u8>, usize)> {
    let short = |at: usize| usize::from(u16::from_le_bytes(archive[at..at + 2].try_into().unwrap()));
    let long = |at: usize| u32::from_le_bytes(archive[at..at + 4].try_into().unwrap());
    let end = archive.len() - 22;
    assert_eq!(&archive[end..end + 4], b"PK\x05\x06");
    let mut at = long(end + 16) as usize;
    assert_eq!(at + long(end + 12) as usize, end);
    let mut files = Vec::new();
    for _ in 0..short(end + 10) {
        assert_eq!(&archive[at..at + 4], b"PK\x01\x02");
        let (size, name, start) = (long(at + 24) as usize, short(at + 28), long(at + 42) as usize);
        let path = String::from_utf8(archive[at + 46..at + 46 + name].to_vec()).unwrap();
        assert_eq!(&archive[start..start + 4], b"PK\x03\x04");
        assert_eq!(&archive[start + 30..start + 30 + name], path.as_bytes());
        assert_eq!((short(start + 8), long(start + 14)), (0, long(at + 16)), "stored, with one check sum");
        let from = start + 30 + name + short(start + 28);
        let data = archive[from..from + size].to_vec();
        assert_eq!(crc32fast::hash(&data), long(at + 16));
        files.push((path, data, from));
        at += 46 + name;
    }
    files
}

fn usdz(model: &Model, text: &str) -> Vec<(String, Vec<u8>, usize)> {
    let file = params::<Usdz>(text).run(model, &Context::quiet()).unwrap().0.remove(0);
    assert_eq!(file.path, "garment.usdz");
    unpacked(&file.bytes)
}

fn text(files: &[(String, Vec<u8>, usize)]) -> String {
    String::from_utf8(files[0].1.clone()).unwrap()
}

#[test]
fn every_file_of_an_archive_is_aligned_whatever_the_length_of_its_path() {
    let file = |k: usize| ("p".repeat(1 + k), vec![7; 3 * k]);
    let files: Vec<(String, Vec<u8>)> = (0..70).map(file).collect();
    let back = unpacked(&zip::stored(&files).unwrap());
    assert!(back.iter().all(|(_, _, at)| at % 64 == 0));
    let back: Vec<(String, Vec<u8>)> = back.into_iter().map(|(path, data, _)| (path, data)).collect();
    assert_eq!(back, files);
}

#[test]
fn usdz_holds_the_scene_first_and_then_its_textures() {
    for (params, end) in [("()", "jpg"), ("(textures: Png)", "png")] {
        let files = usdz(&model(), params);
        let names: Vec<&str> = files.iter().map(|f| f.0.as_str()).collect();
        assert_eq!(
            names,
            ["scene.usda".to_owned(), format!("textures/front.{end}"), format!("textures/back.{end}")]
        );
        assert!(files.iter().all(|f| f.2 % 64 == 0));
        assert!(files[1..].iter().all(|f| image::load_from_memory(&f.1).is_ok()));
        assert!(text(&files).contains(&format!("asset inputs:file = @textures/front.{end}@")));
    }
}

#[test]
fn usdz_has_all_geometry() {
    let model = model();
    let scene = text(&usdz(&model, "()"));
    assert!(scene.starts_with("#usda 1.0\n(\n"));
    for line in ["    defaultPrim = \"Garment\"", "    metersPerUnit = 1", "    upAxis = \"Y\""] {
        assert!(scene.contains(&format!("\n{line}\n")), "{line}");
    }
    let lists = |name: &str| -> Vec<String> {
        let begin = format!("            {name} = [");
        scene.lines().filter_map(|l| l.strip_prefix(&begin).map(str::to_owned)).collect()
    };
    for (mesh, points) in model.meshes.iter().zip(lists("point3f[] points")) {
        let numbers: Vec<f64> = points
            .split(['(', ')', ',', ' ', ']'])
            .filter(|t| !t.is_empty())
            .map(|t| t.parse().unwrap())
            .collect();
        let want: Vec<f64> = mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        assert_eq!(numbers.len(), want.len());
        assert!(numbers.iter().zip(&want).all(|(a, b)| (a - b).abs() < 0.51e-6));
    }
    let indices = lists("int[] faceVertexIndices");
    assert_eq!(indices.len(), 3);
    assert!(indices[0].starts_with("0, 1, 10, 0, 10, 9, "), "{}", &indices[0][..30]);
    assert_eq!(lists("texCoord2f[] primvars:st").len(), 2, "the body has none");
    assert!(scene.contains("rel material:binding = </Garment/Materials/body>"));
    assert!(!scene.contains("NaN") && !scene.contains("inf,") && !scene.contains("(-0,"));
}

#[test]
fn usdz_tells_of_normal_maps_and_of_colours_on_which_light_does_not_act() {
    let lit = text(&usdz(&model_with("(detail: Photo)"), "(body: false)"));
    assert!(lit.contains("normal3f inputs:normal.connect = </Garment/Materials/front/Normals.outputs:rgb>"));
    assert!(lit.contains("asset inputs:file = @textures/back_normals.jpg@"));
    assert!(
        lit.contains("color3f inputs:diffuseColor.connect = </Garment/Materials/front/Colour.outputs:rgb>")
    );
    assert!(!lit.contains("body"));
    let unlit = text(&usdz(&model_with("(light: Replace)"), "()"));
    assert!(
        unlit
            .contains("color3f inputs:emissiveColor.connect = </Garment/Materials/front/Colour.outputs:rgb>")
    );
}

#[test]
fn usdz_keeps_variants_as_a_set_of_bindings() {
    let mut two = model();
    let mut other = two.clone();
    other.materials[0].colour = [1.0, 0.0, 0.0];
    two.add_variant("plain", "red front", &other).unwrap();
    let scene = text(&usdz(&two, "()"));
    assert!(scene.contains("string look = \"plain\"") && scene.contains("        \"red_front\" {"));
    assert_eq!(scene.matches("rel material:binding = </Garment/Materials/front_2>").count(), 1);
    // Three meshes a variant, and none outside of them.
    assert_eq!(scene.matches("rel material:binding").count(), 6);
}

#[test]
fn usdz_says_whose_it_is() {
    let scene = text(&usdz(&model(), "(copyright: Some(\"2026 \\\"A\\\"\"))"));
    assert!(scene.contains("string copyright = \"2026 \\\"A\\\"\""));
    assert!(scene.contains("string[] fabrics = [\"test cloth\"]"));
    let error = params::<Usdz>("(copyright: Some(\"\"))").run(&model(), &Context::quiet()).unwrap_err();
    assert_eq!(error.to_string(), "the `copyright` is empty");
}
