//! From a 3D garment to its pattern, as whole pipelines.

use serde_json::Value;
use std::fs;
use std::path::Path;
use toile_tests::{pipeline, root, toile};

/// The table of a run into this folder.
fn table(out: &std::path::Path) -> Value {
    serde_json::from_slice(&fs::read(out.join("flat.json")).unwrap()).unwrap()
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap()
}

#[test]
fn a_garment_without_its_pattern_becomes_files_to_cut_and_sew() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("flat");
    let answer = toile(&["run", &pipeline("flatten.ron"), "--out", &out.display().to_string()]);
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    for name in [
        "pattern_specification.json",
        "pattern.svg",
        "pattern.dxf",
        "pattern.pdf",
        "report.html",
        "flat_strain.svg",
    ] {
        assert!(out.join(name).exists(), "{name}");
    }
    let table = table(&out);
    let names: Vec<&str> =
        table["pieces"].as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["back", "front"]);
    for piece in table["pieces"].as_array().unwrap() {
        assert!(number(&piece["area_error_3d_to_2d"]).abs() < 0.002, "{piece}");
        assert!(piece["true_piece"].is_null() && piece["flipped_triangles"] == 0);
    }
    assert_eq!(table["seams"].as_array().unwrap().len(), 4);
    assert!(table["seams"].as_array().unwrap().iter().all(|s| number(&s["mismatch"]) < 1e-4));
}

/// Runs a shipped pipeline with these stages in place of its writers, into this folder.
fn run_with(name: &str, stages: &str, dir: &Path) {
    let text = fs::read_to_string(pipeline(name)).unwrap();
    let (text, _) = text.split_once("    qualities: [").unwrap_or((&text, ""));
    let writes = |l: &str| {
        ["Glb(", "GarmentObj(", "PhotoTexturer(", "FabricTexturer("].iter().any(|w| l.trim().starts_with(w))
    };
    // A writer may have several lines, up to its closing bracket.
    let open = |l: &str| l.matches('(').count() as i32 - l.matches(')').count() as i32;
    let mut left_open = 0;
    let kept: Vec<&str> = text
        .lines()
        .filter(|l| {
            let is_written = left_open > 0 || writes(l);
            if is_written {
                left_open += open(l);
            }
            !is_written
        })
        .collect();
    let text = kept.join("\n");
    let (head, _) = text.rsplit_once("    ],").unwrap();
    let samples = format!("\"{}", root().join("pipelines/samples/").display());
    let head = head.replace("\"samples/", &samples);
    let file = dir.join(name);
    fs::write(&file, format!("{head}        {stages},\n    ],\n)\n")).unwrap();
    let answer = toile(&["run", &file.display().to_string(), "--out", &dir.display().to_string()]);
    assert!([0, 4].contains(&answer.code), "{name}: {}{}", answer.out, answer.err);
}

/// `metrics.json` of a run into this folder.
fn metrics(out: &Path) -> Value {
    serde_json::from_slice(&fs::read(out.join("metrics.json")).unwrap()).unwrap()
}

#[test]
fn a_flattener_changes_no_figure_of_the_worn_garment() {
    let dir = tempfile::tempdir().unwrap();
    let run = |stages: &str| {
        run_with("scene.ron", stages, dir.path());
        let fit: Value = serde_json::from_slice(&fs::read(dir.path().join("fit.json")).unwrap()).unwrap();
        (metrics(dir.path()), fit)
    };
    let figures = |m: &Value| {
        let mut garment = m["garment"].clone();
        let own = garment.as_object_mut().unwrap();
        own.remove("peak_memory_bytes");
        (m["panels"].clone(), garment, m["shortfalls"].clone())
    };
    let (plain, fit) = run("Fit(pictures: 0)");
    assert!(plain["flat"].is_null());
    for behind in [
        "Arap(), Fit(pictures: 0)",
        "Measure(), Arap(), Fit(pictures: 0)",
        "Arap(), Woven(), Fit(pictures: 0), Measure()",
    ] {
        let (flat, fit_behind) = run(behind);
        assert_eq!(figures(&flat), figures(&plain), "{behind}");
        assert_eq!(fit_behind, fit, "{behind}");
        if !behind.starts_with("Measure") {
            let names = |v: &Value| v.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
            assert_eq!(names(&flat["flat"]), names(&plain["panels"]), "{behind}");
            assert_ne!(flat["flat"], plain["panels"], "{behind}");
        }
    }
}

/// The shipped vest, worn, from the files that this program wrote of it.
#[test]
#[ignore = "slow: .ci/wide"]
fn the_programs_own_garment_comes_back_as_the_pattern_that_it_was_sewn_from() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name).display().to_string();
    let run = |arguments: &[&str]| {
        let answer = toile(arguments);
        assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
        answer
    };
    run(&["run", &pipeline("vest.ron"), "--quality", "Draft", "--out", &path("vest")]);
    let panels = metrics(&dir.path().join("vest"))["panels"].clone();
    let flatten = pipeline("flatten.ron");
    run(&["run", &flatten, "--until", "FlatTable", "--out", &path("sample")]);
    let areas = |out: &str| {
        let pieces = table(&dir.path().join(out))["pieces"].as_array().unwrap().clone();
        let area = |p: Value| (p["name"].as_str().unwrap().to_owned(), number(&p["area_2d_m2"]));
        pieces.into_iter().map(area).collect::<std::collections::BTreeMap<_, _>>()
    };
    let sample = areas("sample");
    for file in ["garment.glb", "garment.obj"] {
        let file = format!("garment.file={:?}", path(&format!("vest/{file}")));
        let answer = run(&["run", &flatten, "--set", &file, "--out", &path("back")]);
        assert!(!answer.err.contains("warning"), "{}", answer.err);
        let back = areas("back");
        assert_eq!(back.keys().collect::<Vec<_>>(), panels.as_object().unwrap().keys().collect::<Vec<_>>());
        for (name, area) in &back {
            assert!((area / sample[name] - 1.0).abs() < 0.01, "{file}: {name} {area} {}", sample[name]);
        }
        assert_eq!(table(&dir.path().join("back"))["seams"].as_array().unwrap().len(), 4, "{file}");
    }
}

/// The greatest distance of an outline from where it was cut, mm, after a shipped pipeline and a
/// flattener.
fn round_trip(name: &str, flattener: &str) -> f64 {
    let dir = tempfile::tempdir().unwrap();
    run_with(name, &format!("{flattener}(), FlatTable()"), dir.path());
    let pieces = table(dir.path())["pieces"].as_array().unwrap().clone();
    let far = pieces.iter().map(|p| number(&p["true_piece"]["outline_distance_max_mm"]));
    far.fold(0.0, f64::max)
}

/// Outlines are at most so far from where they were cut, mm, by `Arap` and by `Woven`, which knows
/// the fabric.
fn within(limits: &[(&str, [f64; 2])]) {
    let mut beyond = Vec::new();
    for (name, limits) in limits {
        for (flattener, limit) in ["Arap", "Woven"].iter().zip(limits) {
            let far = round_trip(name, flattener);
            println!("{name}, {flattener}: {far:.2} mm");
            if far >= *limit {
                beyond.push(format!("{name}, {flattener}: {far:.2} mm, limit {limit} mm"));
            }
        }
    }
    assert!(beyond.is_empty(), "{}", beyond.join("\n"));
}

#[test]
fn a_draped_skirt_comes_back_as_it_was_cut() {
    within(&[("scene.ron", [1.5, 1.5]), ("skirt.ron", [1.5, 1.5])]);
}

/// All that sew a garment. What is farther than 2 mm is stretched by the body that it lies tight
/// on, and by its weight: docs/log/2026-11-30-round-trips.md.
#[test]
#[ignore = "slow: .ci/wide"]
fn every_shipped_style_comes_back_as_it_was_cut() {
    within(&[
        ("photo_skirt.ron", [2.0, 2.0]),
        ("vest.ron", [2.0, 2.0]),
        ("onepiece.ron", [3.5, 3.5]),
        ("photo_onepiece.ron", [4.0, 3.5]),
        ("dress.ron", [4.0, 4.5]),
        ("photo_shirt.ron", [4.0, 4.0]),
        ("photo_longsleeve.ron", [4.5, 5.0]),
        ("photo.ron", [5.0, 5.0]),
        ("photo_tee.ron", [5.0, 5.0]),
        ("photo_dress.ron", [5.5, 2.5]),
        ("photo_pleated.ron", [6.0, 5.0]),
        ("photo_vest.ron", [6.0, 5.0]),
        ("tshirt.ron", [6.5, 7.0]),
        ("trousers.ron", [10.0, 10.0]),
        ("photo_gathered.ron", [13.0, 13.5]),
        ("pleats.ron", [14.5, 13.0]),
        ("photo_shorts.ron", [15.5, 14.0]),
        ("pattern.ron", [15.5, 16.0]),
        ("photo_trousers.ron", [20.0, 17.5]),
    ]);
}

/// Where darts of a GarmentCode pattern end: the panel and the place on it, metres.
fn dart_tips(file: &Path) -> Vec<(String, [f64; 2])> {
    let spec: Value = serde_json::from_slice(&fs::read(file).unwrap()).unwrap();
    let (unit, pattern) = (number(&spec["properties"]["units_in_meter"]), &spec["pattern"]);
    let mut tips = Vec::new();
    let stitches = pattern["stitches"].as_array().unwrap().iter();
    for stitch in stitches.filter(|s| s[0]["panel"] == s[1]["panel"]) {
        let panel = stitch[0]["panel"].as_str().unwrap();
        let drawn = &pattern["panels"][panel];
        let ends = [0, 1].map(|side| {
            let edge = stitch[side]["edge"].as_u64().unwrap() as usize;
            [0, 1].map(|k| drawn["edges"][edge]["endpoints"][k].as_u64().unwrap() as usize)
        });
        // The two legs of a dart meet at its tip.
        let tip = ends[0].iter().find(|v| ends[1].contains(v));
        if let Some(&tip) = tip {
            tips.push((panel.to_owned(), [0, 1].map(|k| number(&drawn["vertices"][tip][k]) / unit)));
        }
    }
    tips
}

/// The place in space of the vertex whose flat place on a panel is nearest; of a
/// `GarmentObj(flat: true, groups: true)`.
fn in_space(obj: &str, panel: &str, flat: [f64; 2]) -> [f64; 3] {
    let numbers = |kind: &str| -> Vec<Vec<f64>> {
        let lines = obj.lines().filter_map(|l| l.strip_prefix(kind));
        lines.map(|l| l.split_whitespace().map(|x| x.parse().unwrap()).collect()).collect()
    };
    let (places, texture) = (numbers("v "), numbers("vt "));
    let group = obj.split("\ng ").find_map(|g| g.strip_prefix(panel)?.strip_prefix('\n')).unwrap();
    let faces = group.lines().filter_map(|l| l.strip_prefix("f "));
    let corners = faces.flat_map(str::split_whitespace).map(|c| c.split('/').next().unwrap());
    let vertices = corners.map(|v| v.parse::<usize>().unwrap() - 1);
    let off = |v: &usize| (texture[*v][0] - flat[0]).hypot(texture[*v][1] - flat[1]);
    let nearest = vertices.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    assert!(off(&nearest) < 1e-3, "a tip of \"{panel}\" is {} m from the nearest vertex", off(&nearest));
    [0, 1, 2].map(|k| places[nearest][k])
}

/// The draped dress as a mesh without its pattern: its bodice, sewn shut at six darts, is cut open
/// at six again.
#[test]
#[ignore = "slow: .ci/wide"]
fn darts_of_a_fitted_bodice_are_found_again() {
    let dir = tempfile::tempdir().unwrap();
    run_with("dress.ron", "GarmentObj(name: \"sewn\", flat: true, groups: true)", dir.path());
    let text = "(name: \"again\", garment: Garment3d(file: \"sewn.obj\", pieces: Groups), stages: [\n\
        Arap(darts: Auto(max_strain: 1.5)), PatternJson(), GarmentObj(name: \"flat\", flat: true, groups: true)])";
    let file = dir.path().join("again.ron");
    fs::write(&file, text).unwrap();
    let out = dir.path().join("again");
    let answer = toile(&["run", &file.display().to_string(), "--out", &out.display().to_string()]);
    assert!([0, 4].contains(&answer.code), "{}{}", answer.out, answer.err);
    let tips = |spec: &Path, obj: &Path| -> Vec<(String, [f64; 3])> {
        let obj = fs::read_to_string(obj).unwrap();
        dart_tips(spec).into_iter().map(|(p, at)| (p.clone(), in_space(&obj, &p, at))).collect()
    };
    let cut = root().join("pipelines/samples/pattern/dress_specification.json");
    let cut = tips(&cut, &dir.path().join("sewn.obj"));
    let found = tips(&out.join("pattern_specification.json"), &out.join("flat.obj"));
    for panel in ["front", "back"] {
        let of = |tips: &[(String, [f64; 3])]| -> Vec<[f64; 3]> {
            tips.iter().filter(|t| t.0 == panel).map(|t| t.1).collect()
        };
        let (cut, found) = (of(&cut), of(&found));
        assert_eq!(found.len(), cut.len(), "darts of the {panel}");
        for tip in cut {
            let off = |f: &[f64; 3]| (0..3).map(|k| (f[k] - tip[k]).powi(2)).sum::<f64>().sqrt();
            let nearest = found.iter().map(off).fold(f64::INFINITY, f64::min);
            println!("{panel}: {:.1} mm", nearest * 1e3);
            assert!(nearest < 0.015, "a tip of the {panel} is {nearest} m from the next that was found");
        }
    }
}
