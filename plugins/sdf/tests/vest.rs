//! The collider in a pipeline: the shipped vest, sewn and draped with it in place of `BvhCollider`.
//! With `KEEP_PICTURES=DIR` its pictures are kept there.

use std::path::Path;

/// Runs the vest with a collider and gives its metrics.
fn drape(collider: &str, out: &Path) -> String {
    let mut registry = toile::registry();
    toile_sdf::register(&mut registry);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let vest = std::fs::read_to_string(root.join("pipelines/vest.ron")).unwrap();
    let text = vest
        .replace("BvhCollider()", collider)
        .replace("samples/", &format!("{}/pipelines/samples/", root.display()));
    assert!(text.contains(collider));
    let file = out.join("vest.ron");
    std::fs::write(&file, text).unwrap();
    let (mut said, mut told) = (Vec::new(), Vec::new());
    let arguments = [
        "toile",
        "run",
        file.to_str().unwrap(),
        "--json",
        "--quality",
        "Draft",
        "--out",
        out.to_str().unwrap(),
    ];
    let code = toile::command_with(&registry, arguments, &mut said, &mut told);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&told));
    String::from_utf8(said).unwrap()
}

#[test]
fn the_vest_drapes_on_a_field_as_on_a_hierarchy() {
    let kept = std::env::var_os("KEEP_PICTURES").map(std::path::PathBuf::from);
    let dir = tempfile::tempdir().unwrap();
    let out = kept.as_deref().unwrap_or(dir.path());
    std::fs::create_dir_all(out).unwrap();
    // The field is evaluated at vertices only: between them a triangle of 16 mm cuts a millimetre
    // into a rounded shoulder.
    let metrics = drape("SdfCollider(cell: \"8 mm\", thickness: \"2.5 mm\", friction: 0.3)", out);
    let metrics: String = metrics.split_whitespace().collect();
    assert!(metrics.contains("\"converged\":true"), "{metrics}");
    assert!(metrics.contains("\"body_penetration\":{\"vertices\":0,"), "{metrics}");
}
