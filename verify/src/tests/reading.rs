//! Files: what cannot be read is refused by name and remedy.

use super::*;
use crate::files::{AskedFiles, certify};
use std::path::Path;
use toile_core::artifact::Digest;

/// The skirt as an OBJ file, with texture points and groups.
fn obj(skirt: &Skirt, unit: f64) -> String {
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

fn asked(garment: &Path) -> AskedFiles {
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
    std::fs::write(at("skirt.obj"), obj(&Skirt::new(12, 8), 1.0)).unwrap();
    std::fs::write(at("pattern.txt"), "none").unwrap();
    let asked = AskedFiles { pattern: Some(at("pattern.txt")), ..asked(&at("skirt.obj")) };
    let e = certify(&asked).unwrap_err();
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
