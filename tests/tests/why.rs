//! `toile why`: causes before a run, origins after it.

use serde_json::Value;
use std::fs;
use toile_tests::{pipeline, toile, without_rest};

#[test]
fn the_cause_is_the_field_that_changed() {
    let dir = tempfile::tempdir().unwrap();
    let (cache, out) = (dir.path().join("cache").display().to_string(), dir.path().display().to_string());
    let vest = pipeline("vest.ron");
    let why = |more: &[&str]| toile(&[&["why", &vest, "--cache-dir", &cache], more].concat());
    assert_eq!(why(&["Otsu"]).out.lines().next(), Some("Otsu: would run: never run"));
    let until = ["--until", "PlaneSmoother", "--out", &out, "--cache-dir", &cache];
    assert_eq!(toile(&[&["run", &vest][..], &until].concat()).code, 0);
    assert_eq!(why(&["PlaneSmoother"]).out, "PlaneSmoother: from the cache\n");
    assert_eq!(
        why(&["PlaneSmoother", "--set", "stages.PlaneSmoother.lambda=0.6"]).out,
        "PlaneSmoother: would run: lambda 0.5 -> 0.6; upstream \"GridMesher\" unchanged\n"
    );
    assert_eq!(
        why(&["PlaneSmoother", "--set", "stages.GridMesher.edge=\"20 mm\""]).out,
        "PlaneSmoother: would run: upstream \"GridMesher\" would run again\n  \
         since GridMesher: would run: edge 16 mm -> 20 mm; upstream \"Outline\" unchanged\n"
    );
    let json: Value = serde_json::from_str(
        &why(&["GridMesher", "--set", "stages.GridMesher.edge=\"20 mm\"", "--json"]).out,
    )
    .unwrap();
    let entry = &json["stages"][0]["entries"][1];
    assert_eq!((&entry["entry"], &entry["causes"][0]), (&"front".into(), &"edge 16 mm -> 20 mm".into()));
    let unknown = why(&["StaticEqilibrium"]);
    assert_eq!(unknown.code, 3);
    let words = unknown.err.split_whitespace().collect::<Vec<_>>().join(" ");
    let head = "× there is no stage `StaticEqilibrium` in this pipeline help: did you mean `StaticEquilibrium`? its stages are Photos, Mannequin, ";
    assert!(words.starts_with(head), "{words}");
}

#[test]
fn a_triangle_of_a_refined_garment_is_followed_to_its_outline_edge() {
    let dir = tempfile::tempdir().unwrap();
    let ron = dir.path().join("vest.ron");
    let text = without_rest(&fs::read_to_string(pipeline("vest.ron")).unwrap());
    let text = text.replace("samples/", &format!("{}/samples/", pipeline("")));
    let text = text.replace("PhotoTexturer(", "Subdivide(parts: 3), PhotoTexturer(");
    assert!(text.contains("Subdivide("));
    fs::write(&ron, text.replace("Glb(), Obj(), Preview(), Report(),", "Obj(),")).unwrap();
    let out = dir.path().join("out").display().to_string();
    let run = toile(&["run", &ron.display().to_string(), "--out", &out]);
    assert_eq!(run.code, 4, "{}", run.err);
    let result = format!("{out}/garment.obj");
    let edge = |face: usize| {
        let why = toile(&["why", &result, "--face", &face.to_string(), "--json"]);
        let found: Value = serde_json::from_str(&why.out).unwrap();
        (found["edge"].as_str().unwrap().to_owned(), found["edge_distance_m"].as_f64().unwrap())
    };
    let found: Vec<(String, f64)> = (0..40).map(|i| edge(i * 100)).collect();
    assert!(found.iter().all(|(_, far)| (0.0..0.4).contains(far)), "{found:?}");
    assert!(found.iter().any(|(name, _)| name != &found[0].0), "{found:?}");
}

#[test]
fn a_triangle_is_followed_to_its_panel_edge_and_pixel() {
    let dir = tempfile::tempdir().unwrap();
    let ron = dir.path().join("vest.ron");
    let text = fs::read_to_string(pipeline("vest.ron")).unwrap();
    // Placed is enough: sewing moves no triangle in its panel.
    let lines = without_rest(&text).replace("samples/", &format!("{}/samples/", pipeline("")));
    fs::write(&ron, lines.replace("Preview(), Report(),", "")).unwrap();
    let out = dir.path().join("out");
    let path = |name: &str| out.join(name).display().to_string();
    let run = toile(&["run", &ron.display().to_string(), "--out", &out.display().to_string()]);
    assert_eq!(run.code, 4, "{}", run.err);

    let why = |file: &str, face: &str, more: &[&str]| {
        toile(&[&["why", &path(file), "--face", face], more].concat())
    };
    let glb: Value = serde_json::from_str(&why("garment.glb", "100", &["--json"]).out).unwrap();
    let obj: Value = serde_json::from_str(&why("garment.obj", "100", &["--json"]).out).unwrap();
    assert_eq!(glb, obj);
    assert_eq!(glb["panel"], "back");
    assert!(glb["photo"].as_str().unwrap().ends_with("samples/vest/back.jpg"), "{glb}");

    // The pixel is that place: metres from the panel's middle, seen at the photo's scale.
    let figure = |v: &Value| v.as_f64().unwrap();
    let other: Value = serde_json::from_str(&why("garment.glb", "300", &["--json"]).out).unwrap();
    let (dx, dpx) = (
        figure(&other["place_m"][0]) - figure(&glb["place_m"][0]),
        figure(&other["pixel"][0]) - figure(&glb["pixel"][0]),
    );
    let (dy, dpy) = (
        figure(&other["place_m"][1]) - figure(&glb["place_m"][1]),
        figure(&other["pixel"][1]) - figure(&glb["pixel"][1]),
    );
    let scale = dpx.hypot(dpy) / dx.hypot(dy);
    assert!((dpx - scale * dx).abs() < 3.0 && (dpy + scale * dy).abs() < 3.0, "{glb} {other}");

    let text = why("garment.glb", "100", &[]).out;
    assert!(text.starts_with("face 100: triangle 100 of panel \"back\"\nin the panel: x "), "{text}");
    assert!(text.contains("\nnearest edge: ") && text.contains(" mm away\nphoto: "), "{text}");

    let far = why("garment.glb", "9999999", &[]);
    let count = far.err.split(" has ").nth(1).and_then(|t| t.split(' ').next()).unwrap().to_owned();
    let name = path("garment.glb");
    assert_eq!(
        (far.code, far.err),
        (
            3,
            format!(
                "error: {name}: face 9999999 is out of range: the file has {count} triangles, counted from 0\n"
            )
        )
    );
    // The last triangles of the GLB file are those of the wrong side of the last panel; its right
    // side has the same place.
    let end = count.parse::<usize>().unwrap() - 1;
    let wrong = why("garment.glb", &end.to_string(), &[]).out;
    assert!(wrong.contains(" of panel \"front\"\n"), "{wrong}");
    let all = why("garment.obj", "9999999", &[]).err;
    let all = all.split(" has ").nth(1).and_then(|t| t.split(' ').next()).unwrap();
    let last = (all.parse::<usize>().unwrap() - 1).to_string();
    assert_eq!(
        why("garment.obj", &last, &[]).err,
        format!(
            "error: {}: face {last} belongs to \"body\", which is no panel of the garment\n",
            path("garment.obj")
        )
    );
    let png = why("metrics.json", "0", &[]);
    assert_eq!(
        png.err,
        format!(
            "error: {}: only the triangles of .glb and .obj files can be followed\n",
            path("metrics.json")
        )
    );
    let json = why("garment.glb", "9999999", &["--json"]);
    let refused: Value = serde_json::from_str(&json.out).unwrap();
    assert_eq!((json.code, &refused["error"]), (3, &"invalid_input".into()));
    assert!(refused["message"].as_str().unwrap().contains(": face 9999999 is out of range: "), "{refused}");
    fs::remove_file(out.join("origin.json")).unwrap();
    let lost = why("garment.glb", "0", &[]);
    assert_eq!(lost.code, 3);
    assert!(
        lost.err.starts_with(&format!("error: {name}: there is no \"origin.json\" beside it (")),
        "{}",
        lost.err
    );
}
