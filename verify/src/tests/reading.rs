//! Files: what cannot be read is refused by name and remedy.

use super::*;
use crate::files::{AskedFiles, Up, certify, reader_words};
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::Digest;
use toile_pattern::pattern::{DrawingUnit, DxfPattern};

/// The skirt as an OBJ file, with texture points and groups.
pub(super) fn obj(skirt: &Skirt, unit: f64) -> String {
    let mut text = String::new();
    for p in &skirt.meshes.positions {
        text += &format!("v {} {} {}\n", p.x / unit, p.y / unit, p.z / unit);
    }
    for p in skirt.meshes.texture.iter().flatten().flatten() {
        text += &format!("vt {} {}\n", p.x / unit, p.y / unit);
    }
    for (k, t) in skirt.meshes.triangles.iter().enumerate() {
        let group = skirt.meshes.groups[k] as usize;
        if k == 0 || skirt.meshes.groups[k - 1] as usize != group {
            text += &format!("g {}\n", skirt.meshes.names[group]);
        }
        let corner = |c: usize| format!("{}/{}", t[c] + 1, 3 * k + c + 1);
        text += &format!("f {} {} {}\n", corner(0), corner(1), corner(2));
    }
    text
}

pub(super) fn asked(garment: &Path) -> AskedFiles {
    AskedFiles { garment: garment.to_owned(), ..AskedFiles::default() }
}

fn refused(garment: &Path) -> (String, String) {
    let e = certify(&asked(garment)).unwrap_err();
    (e.message, e.hint.unwrap_or_default())
}

#[test]
fn a_garment_of_any_program_is_judged_in_its_own_unit() {
    let dir = tempfile::tempdir().unwrap();
    let skirt = Skirt::new(24, 12);
    for unit in [1.0, 0.01, 0.001] {
        let path = dir.path().join("skirt.obj");
        let text = obj(&skirt, unit);
        std::fs::write(&path, &text).unwrap();
        let (certificate, folder) = certify(&asked(&path)).unwrap();
        assert!(certificate.holds(), "{:?}", certificate.checks);
        assert_eq!(folder, dir.path());
        let strain = certificate.checks.iter().find(|c| c.name == "strain_p99").unwrap();
        assert_eq!(strain.verdict, Verdict::Holds, "{strain:?}");
        let json = serde_json::to_value(&certificate).unwrap();
        assert_eq!(json["inputs"][0]["digest"], Digest::of(text.as_bytes()).hex());
        assert_eq!(json["triangles"], 1152);
    }
}

#[test]
fn what_cannot_be_read_is_refused_by_name_and_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let shown = |name: &str| at(name).display().to_string();
    let (what, hint) = refused(&at("none.obj"));
    assert_eq!(
        what,
        format!("\"{}\" cannot be read: No such file or directory (os error 2)", shown("none.obj"))
    );
    assert_eq!(hint, "look at the path and the file's rights");
    let (what, hint) = refused(dir.path());
    assert_eq!(what, format!("the folder \"{}\" holds no garment", dir.path().display()));
    assert_eq!(
        hint,
        "name the output folder of a run with a writer of models (`Glb()` or `GarmentObj()`), or a .glb or .obj file"
    );
    std::fs::write(at("broken.glb"), b"glTF").unwrap();
    assert!(
        refused(&at("broken.glb")).0.starts_with(&format!("\"{}\": it is no sound GLB", shown("broken.glb")))
    );
    std::fs::write(at("huge.obj"), "v 0 0 0\nv 1e6 0 0\nv 0 1e6 0\nf 1 2 3\n").unwrap();
    let (what, hint) = refused(&at("huge.obj"));
    assert_eq!(
        what,
        format!("\"{}\": no unit makes its 1414213.5624 from corner to corner a garment", shown("huge.obj"))
    );
    assert_eq!(hint, "garments are 5 cm to 6 m from corner to corner; state the unit with `--unit`");
    let e = reader_words(&at("pattern.txt"), None).unwrap_err();
    assert_eq!(e.message, format!("\"{}\" is not a pattern by its name", shown("pattern.txt")));
    assert_eq!(
        e.hint.as_deref(),
        Some("name a pattern of GarmentCode (.json), a .dxf, .svg, .sm2d or .val file")
    );
}

#[test]
fn flat_pieces_of_another_garment_are_a_fault() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("result.obj"), obj(&Skirt::new(12, 8), 1.0)).unwrap();
    let panel = r#"{"name":"front","photo":null,"positions":[[0,0],[1,0],[0,1]],"pixels":[],"triangles":[[0,1,2]],"edges":[]}"#;
    let origin =
        |panel: &str| std::fs::write(dir.path().join("origin.json"), format!("{{\"panels\":[{panel}]}}"));
    origin(panel).unwrap();
    let (certificate, _) = certify(&asked(dir.path())).unwrap();
    assert!(!certificate.holds());
    assert_eq!(certificate.checks[0].words, "panel \"front\" has 192 triangles, \"origin.json\" has 1");
    origin(&panel.replace("[0,1,2]", "[0,1,3]")).unwrap();
    let (what, hint) = refused(dir.path());
    let path = dir.path().join("origin.json");
    assert_eq!(
        what,
        format!(
            "\"{}\": \"origin.json\" is damaged: a triangle of panel \"front\" has no corners",
            path.display()
        )
    );
    assert_eq!(hint, "run the pipeline again, or take the file away");
}

#[test]
fn a_pattern_is_read_by_the_stage_of_its_name_with_the_seams_beside_it() {
    let words = |file: &str| reader_words(Path::new(file), Some(Path::new("seams.ron"))).unwrap();
    assert_eq!(words("a/tank.DXF"), "DxfPattern(file: \"a/tank.DXF\", seams: \"seams.ron\")");
    assert_eq!(words("skirt.val"), "SeamlyPattern(file: \"skirt.val\", seams: \"seams.ron\")");
    assert_eq!(words("shirt_specification.json"), "GarmentCode(file: \"shirt_specification.json\")");
}

/// The skirt's panels as a DXF in two sizes, in inches that it does not say.
fn graded() -> String {
    let mut text = String::from("0\nSECTION\n2\nBLOCKS\n");
    for (size, scale) in [("S", 0.9), ("M", 1.0)] {
        for name in ["front", "back"] {
            text += &format!("0\nBLOCK\n8\n0\n2\n{name}_{size}\n");
            for told in [format!("Piece Name: {name}"), format!("Size: {size}")] {
                text += &format!("0\nTEXT\n8\n1\n10\n0\n20\n0\n1\n{told}\n");
            }
            text += "0\nPOLYLINE\n8\n1\n66\n1\n70\n1\n";
            let (w, h) = (scale * width(24) / 0.0254, scale * HEIGHT / 0.0254);
            for [x, y] in [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]] {
                text += &format!("0\nVERTEX\n8\n1\n10\n{x}\n20\n{y}\n");
            }
            text += "0\nSEQEND\n8\n1\n0\nENDBLK\n";
        }
    }
    text + "0\nENDSEC\n0\nEOF\n"
}

#[test]
fn a_size_of_a_graded_pattern_is_held_against_the_garment() {
    let dir = tempfile::tempdir().unwrap();
    let (garment, file) = (dir.path().join("skirt.obj"), dir.path().join("skirt.dxf"));
    std::fs::write(&garment, obj(&Skirt::new(24, 12), 1.0)).unwrap();
    std::fs::write(&file, graded()).unwrap();
    let judged = |size: &str| {
        let (file, unit) = (file.display().to_string(), DrawingUnit::Inches);
        let reader = DxfPattern { file, size: size.into(), unit, ..DxfPattern::default() };
        certify(&AskedFiles { reader: Some(Arc::new(reader)), ..asked(&garment) })
    };
    let (certificate, _) = judged("M").unwrap();
    assert!(certificate.holds(), "{:?}", certificate.checks);
    let on = certificate.checks.iter().find(|c| c.name == "outline_deviation").unwrap();
    assert!(on.value.unwrap() < 1e-6, "{on:?}");
    assert!(!judged("S").unwrap().0.holds());
    let refused = judged("XL").unwrap_err();
    assert_eq!(refused.message, format!("\"{}\": there is no size \"XL\"", file.display()));
    assert_eq!(refused.hint.as_deref(), Some("the sizes are S, M"));
}

/// The garment as GarmentCode's simulator writes it: centimetres, vertices of both panels sewn into
/// one, the texture within one square, no groups.
fn simulated(skirt: &Skirt) -> (String, String) {
    let mut number: Vec<usize> = Vec::new();
    let mut places: Vec<Point3> = Vec::new();
    for p in &skirt.meshes.positions {
        let known = places.iter().position(|q| q == p);
        number.push(known.unwrap_or(places.len()));
        if known.is_none() {
            places.push(*p);
        }
    }
    let shared = |v: usize| number.iter().filter(|n| **n == v).count() > 1;
    let of_front = skirt.meshes.positions.len() / 2;
    let label = |v: usize| match (shared(v), number[..of_front].contains(&v)) {
        (true, _) => "stitch_0".to_owned(),
        (false, true) => "front".to_owned(),
        (false, false) => "back".to_owned(),
    };
    let labels: Vec<String> = (0..places.len()).map(label).collect();
    let mut text = String::from("mtllib skirt.mtl\n");
    for p in &places {
        text += &format!("v {} {} {}\n", p.x * 100.0, p.y * 100.0, p.z * 100.0);
    }
    for p in skirt.meshes.texture.iter().flatten().flatten() {
        text += &format!("vt {} {}\n", p.x / 3.0, p.y / 3.0);
    }
    text += "s 1\nusemtl islands_texture\n";
    for (k, t) in skirt.meshes.triangles.iter().enumerate() {
        let corner = |c: usize| format!("{}/{}", number[t[c] as usize] + 1, 3 * k + c + 1);
        text += &format!("f {} {} {}\n", corner(0), corner(1), corner(2));
    }
    (text, labels.join("\n") + "\n")
}

#[test]
fn a_simulation_of_garment_code_is_judged_by_its_segmentation() {
    let dir = tempfile::tempdir().unwrap();
    let garment = dir.path().join("skirt_sim.obj");
    let (text, labels) = simulated(&Skirt::new(24, 12));
    std::fs::write(&garment, &text).unwrap();
    let beside = dir.path().join("skirt_sim_segmentation.txt");
    std::fs::write(&beside, &labels).unwrap();
    let file = dir.path().join("skirt.dxf");
    std::fs::write(&file, graded()).unwrap();
    let (file, unit) = (file.display().to_string(), DrawingUnit::Inches);
    let reader = DxfPattern { file, size: "M".into(), unit, ..DxfPattern::default() };
    let asked = AskedFiles { reader: Some(Arc::new(reader)), ..asked(&garment) };
    let (certificate, _) = certify(&asked).unwrap();
    assert!(certificate.holds(), "{:?}", certificate.checks);
    let json = serde_json::to_value(&certificate).unwrap();
    assert_eq!(json["inputs"][2]["role"], "segmentation");
    let names: Vec<&String> = json["panels"].as_object().unwrap().keys().collect();
    assert_eq!(names, ["back", "front"]);
    // Without texture points the panels are those of the file.
    let bare: String =
        text.lines().filter(|l| !l.starts_with("vt")).map(|l| without_texture(l) + "\n").collect();
    std::fs::write(&garment, bare).unwrap();
    let (certificate, _) = certify(&AskedFiles { reader: None, ..asked.clone() }).unwrap();
    assert!(certificate.holds());
    let json = serde_json::to_value(&certificate).unwrap();
    // Each panel has the vertices of both its sides.
    assert_eq!(json["vertices"], 2 * 25 * 13);
    std::fs::write(&beside, "front\nback\n").unwrap();
    let (certificate, _) = certify(&AskedFiles { reader: None, ..asked }).unwrap();
    assert_eq!(certificate.checks[0].words, "\"skirt_sim_segmentation.txt\" has 2 lines for 624 vertices");
}

fn without_texture(line: &str) -> String {
    let words = line.split(' ').map(|w| w.split('/').next().unwrap_or(w));
    words.collect::<Vec<_>>().join(" ")
}

#[test]
fn a_garment_and_a_body_with_z_up_are_turned() {
    let dir = tempfile::tempdir().unwrap();
    let (garment, body) = (dir.path().join("skirt.obj"), dir.path().join("body.obj"));
    let mut skirt = Skirt::new(24, 12);
    let z_up = |p: &Point3| Point3::new(p.x, -p.z, p.y);
    skirt.meshes.positions.iter_mut().for_each(|p| *p = z_up(p));
    // As Blender writes it: objects, no groups.
    std::fs::write(&garment, obj(&skirt, 1.0).replace("g ", "o ")).unwrap();
    let post = post().body;
    let mut text: String =
        post.positions.iter().map(z_up).map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
    text.extend(post.triangles.iter().map(|t| format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1)));
    std::fs::write(&body, text).unwrap();
    let worn = AskedFiles { body: Some(body), ..asked(&garment) };
    let (certificate, _) = certify(&worn).unwrap();
    assert!(certificate.holds(), "{:?}", certificate.checks);
    let (said, _) = certify(&AskedFiles { up: Some(Up::Z), ..worn.clone() }).unwrap();
    assert_eq!(said.checks, certificate.checks);
    let lying = certify(&AskedFiles { up: Some(Up::Y), ..worn }).unwrap_err();
    assert!(
        lying.message.ends_with("no unit makes its height of 0.300 that of a person"),
        "{}",
        lying.message
    );
    // Without a body its openings say how it stands: of a file whose seams are closed.
    skirt.meshes.positions.iter_mut().for_each(|p| p.z *= 2.0);
    std::fs::write(&garment, simulated(&skirt).0).unwrap();
    let (alone, _) = certify(&asked(&garment)).unwrap();
    let json = serde_json::to_value(&alone).unwrap();
    let note = format!("\"{}\": its z axis is taken as up; `--up y` says otherwise", garment.display());
    assert_eq!(json["notes"][1], note);
}

#[test]
fn panels_of_several_groups_in_millimetres_are_those_of_the_texture() {
    // As CLO writes it: a group and a material for each pattern, the texture in one square.
    let dir = tempfile::tempdir().unwrap();
    let garment = dir.path().join("skirt.obj");
    let mut skirt = Skirt::new(24, 12);
    skirt.meshes.names = vec!["Pattern2D_17".into(), "Pattern2D_23".into()];
    for p in skirt.meshes.texture.iter_mut().flatten().flatten() {
        *p = Point2::new(p.x / 2.0, p.y / 2.0);
    }
    let text = obj(&skirt, 0.001).replace("g Pattern", "usemtl FABRIC_1\ng Pattern");
    let text: String = text
        .lines()
        .map(|l| match l.strip_prefix("vt ") {
            Some(p) => format!(
                "vt {}\n",
                p.split(' ')
                    .map(|x| (x.parse::<f64>().unwrap() * 1e-3).to_string())
                    .collect::<Vec<_>>()
                    .join(" ")
            ),
            None => format!("{l}\n"),
        })
        .collect();
    std::fs::write(&garment, text).unwrap();
    let (bare, _) = certify(&asked(&garment)).unwrap();
    let json = serde_json::to_value(&bare).unwrap();
    assert_eq!(json["vertices"], 2 * 25 * 13);
    let file = dir.path().join("skirt.dxf");
    std::fs::write(&file, graded()).unwrap();
    let (file, unit) = (file.display().to_string(), DrawingUnit::Inches);
    let reader = DxfPattern { file, size: "M".into(), unit, ..DxfPattern::default() };
    let (certificate, _) =
        certify(&AskedFiles { reader: Some(Arc::new(reader)), ..asked(&garment) }).unwrap();
    assert!(certificate.holds(), "{:?}", certificate.checks);
    let json = serde_json::to_value(&certificate).unwrap();
    let names: Vec<&String> = json["panels"].as_object().unwrap().keys().collect();
    assert_eq!(names, ["Pattern2D_17", "Pattern2D_23"]);
}
