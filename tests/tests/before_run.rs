//! What `validate` finds beside the form of a file, and what a run refuses before its first stage.

use serde_json::Value;
use std::fs;
use std::path::Path;
use toile_tests::{Answer, pipeline, toile, without_rest};

/// The vest without its solver, its samples where they are, with `from` replaced by `to` each.
fn vest(dir: &Path, changes: &[(&str, &str)]) -> String {
    let text = without_rest(&fs::read_to_string(pipeline("vest.ron")).unwrap());
    let mut text = text.replace("samples/", &format!("{}samples/", pipeline("")));
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let file = dir.join("vest.ron");
    fs::write(&file, text).unwrap();
    file.display().to_string()
}

fn words(answer: &Answer) -> String {
    answer.err.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn everything_outside_the_file_is_looked_at_and_comes_out_at_once_each_at_its_element() {
    let dir = tempfile::tempdir().unwrap();
    let seams = "seams: [ Match(\"front.side_left\", \"back.side_lft\"), Match(\"frnt.hem\", \"back.hem\") ],\n    stages: [";
    let file = vest(
        dir.path(),
        &[
            ("vest/front.jpg", "vest/none.jpg"),
            ("width: \"52 cm\"", "width: \"0 cm\""),
            ("cotton poplin", "coton poplin"),
            ("smooth: 1", "low: 90, high: 60, smooth: 1"),
            ("Glb()", "Glb(name: \"a/b\")"),
            ("stages: [", seams),
        ],
    );
    let text = fs::read_to_string(&file).unwrap();
    let answer = toile(&["validate", "--json", &file]);
    assert_eq!(answer.code, 3);
    let said: Value = serde_json::from_str(&answer.out).unwrap();
    let faults: Vec<(String, String)> = said["faults"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| {
            let number = |key: &str| f[key].as_u64().unwrap() as usize;
            let line = text.lines().nth(number("line") - 1).unwrap();
            let rest: String = line.chars().skip(number("column") - 1).take(12).collect();
            let message = f["message"].as_str().unwrap().split(&pipeline("")).collect::<String>();
            (rest, format!("{message}; {}", f["hint"].as_str().unwrap_or("")))
        })
        .collect();
    let starts: Vec<(&str, &str)> =
        faults.iter().map(|(at, what)| (at.as_str(), what.split("; ").next().unwrap())).collect();
    let place: String = format!("\"{}", pipeline("")).chars().take(12).collect();
    assert_eq!(
        starts,
        [
            (place.as_str(), "Photos: cannot read \"samples/vest/none.jpg\": no such file"),
            ("\"0 cm\"),", "Photos: photo \"front\": the garment's width is 0 m, which is not positive"),
            ("\"coton popli", "Preset: there is no fabric preset \"coton poplin\""),
            ("\"back.side_l", "Seams: the panel \"back\" has no edge \"side_lft\""),
            ("\"frnt.hem\", ", "Seams: there is no panel \"frnt\""),
            ("90, high: 60", "Canny: `low` is 90, above `high`, which is 60"),
            (
                "\"a/b\"), Obj(",
                "Glb: the file name \"a/b\" has a character other than letters, digits, space, '-', '_' and '.'"
            ),
        ]
    );
    assert!(faults[3].1.ends_with("did you mean \"back.side_left\"?"), "{:?}", faults[3]);
    assert!(faults[4].1.ends_with("did you mean \"front.hem\"?"), "{:?}", faults[4]);

    // A run says the same before any stage runs, and writes nothing.
    let out = dir.path().join("out").display().to_string();
    let run = toile(&["run", &file, "--json", "--out", &out]);
    assert_eq!(run.code, 3);
    let run: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(run["faults"], said["faults"]);
    assert!(!Path::new(&out).exists());
}

#[test]
fn photos_that_the_style_does_not_take_are_told_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let said = |changes: &[(&str, &str)]| {
        let answer = toile(&["validate", &vest(dir.path(), changes)]);
        (answer.code, words(&answer))
    };
    let (code, text) = said(&[("\"front\":", "\"fornt\":")]);
    assert_eq!(code, 3, "{text}");
    assert!(text.contains("Photos: `Outline` takes no photo named \"fornt\""), "{text}");
    assert!(text.contains("help: did you mean \"front\"?"), "{text}");
    let (code, text) = said(&[("\"back\":", "\"lining\":")]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("Photos: `Outline` does not use the photo \"lining\""), "{text}");
    assert!(text.contains("the photo \"front\" has no other side, and its piece stays unsewn"), "{text}");
    assert!(text.contains("or write `\"back\": MirrorOf(\"front\")`"), "{text}");
    let (code, text) = said(&[]);
    assert!(code == 0 && !text.contains("Photos"), "{text}");

    // A block is cut from the front.
    let block = fs::read_to_string(pipeline("photo.ron")).unwrap();
    let block = block.replace("samples/", &format!("{}samples/", pipeline("")));
    let file = dir.path().join("block.ron");
    let said = |front: &str| {
        let text = block.replacen("\"front\":", &format!("{front:?}:"), 1);
        fs::write(&file, text.replace("MirrorOf(\"front\")", &format!("MirrorOf({front:?})"))).unwrap();
        let answer = toile(&["validate", file.to_str().unwrap()]);
        assert_eq!(answer.code, 3, "{}", answer.err);
        words(&answer)
    };
    assert!(said("Front").contains("`Block` takes no photo named \"Front\" "), "{}", said("Front"));
    let none = "`Block` cuts the garment from \"front\", and no photo has that name";
    assert!(said("vorne").contains(none), "{}", said("vorne"));
}

/// Each of these once came out only after the others were mended.
#[test]
fn faults_of_the_file_do_not_hide_what_its_stages_find() {
    let dir = tempfile::tempdir().unwrap();
    let changes = [
        ("vest/front.jpg", "vest/none.jpg"),
        ("cotton poplin", "coton poplin"),
        ("smooth: 1", "low: 90, high: 60, smooth: 1"),
        ("Otsu()", "Otzu()"),
        ("NeighbourhoodMean()", "NeighbourhoodMean(raduis: 1)"),
        ("GridMesher(edge: \"16 mm\"),", "GridMesher(edge: 16)"),
    ];
    let answer = toile(&["validate", &vest(dir.path(), &changes)]);
    assert_eq!(answer.code, 3);
    for text in [
        "none.jpg\": no such file",
        "there is no fabric preset \"coton poplin\"",
        "`low` is 90, above `high`, which is 60",
        "unknown stage `Otzu`",
        "unknown parameter `raduis`",
        "the length 16 has no unit",
        "a comma is missing after `GridMesher(edge: 16)`",
    ] {
        assert!(words(&answer).contains(text), "{text}: {}", answer.err);
    }
}

#[test]
fn a_run_until_a_stage_asks_only_the_stages_that_it_runs() {
    let dir = tempfile::tempdir().unwrap();
    let file = vest(dir.path(), &[("cotton poplin", "coton poplin")]);
    let out = dir.path().join("out").display().to_string();
    assert_eq!(toile(&["validate", &file]).code, 3);
    let run = toile(&["run", &file, "--until", "Otsu", "--out", &out]);
    assert_eq!(run.code, 0, "{}", run.err);
}

#[test]
fn commands_that_run_a_pipeline_many_times_say_first_what_a_run_would_refuse() {
    let dir = tempfile::tempdir().unwrap();
    let file = vest(dir.path(), &[("vest/front.jpg", "vest/none.jpg"), ("cotton poplin", "coton poplin")]);
    let out = dir.path().join("out").display().to_string();
    let missing = ["no such file", "there is no fabric preset \"coton poplin\""];
    for command in [
        &["golden", "check", "--allow-missing", &file][..],
        &["golden", "accept", &file],
        &["trade", &file, "--out", &out, "--budget", "10s"],
        &["tune", &file, "--max-error", "5 mm"],
    ] {
        let answer = toile(command);
        assert_eq!(answer.code, 3, "{command:?}: {}", answer.err);
        // All of them, and not the first that a run meets.
        for text in missing {
            assert!(words(&answer).contains(text), "{command:?}: {}", answer.err);
        }
    }
    assert!(!Path::new(&out).exists());
}

#[test]
fn what_cannot_be_read_of_scenes_and_bodies_comes_out_with_all_other_faults() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(dir.path().join(name), text).unwrap();
    let scene = |body: &str| {
        let head = "{\"format\": \"garment-scene-1\", \"rest_uv\": [], \"positions\": [], \"triangles\": [], \"phases\": [],";
        let cloth = "\"material\": {\"area_density\": 0.1, \"stretch\": 500, \"shear\": 50, \"bend\": 1e-5, \"friction\": 0.4, \"thickness\": 1e-3}";
        format!("{head} {cloth}, \"body\": {{\"obj\": \"{body}\", \"friction\": 0.4}}}}")
    };
    write("cut.json", "{\"format\": \"garment-scene-1\", \"rest_uv\": [[0, 0],");
    write("slip.json", &scene("body.obj").replace("\"phases\"", "\"fases\""));
    write("bad_body.json", &scene("bad.obj"));
    write("no_body.json", &scene("none.obj"));
    write("bad.obj", "v 0 0 zero\n");
    let file = dir.path().join("p.ron").display().to_string();
    for (stages, what) in [
        ("scene: Scene(file: \"cut.json\")", "EOF while parsing"),
        ("scene: Scene(file: \"slip.json\")", "`fases`"),
        ("scene: Scene(file: \"bad_body.json\")", "line 1 of the OBJ: a vertex needs three numbers"),
        ("scene: Scene(file: \"no_body.json\")", "none.obj"),
    ] {
        write(
            "p.ron",
            &format!("(name: \"p\", {stages}, stages: [StaticEquilibrium(), GarmentObj(name: \"a/b\")])"),
        );
        let answer = toile(&["validate", &file]);
        assert_eq!(answer.code, 3, "{}", answer.err);
        for text in [what, "the file name \"a/b\" has a character"] {
            assert!(words(&answer).contains(text), "{text}: {}", answer.err);
        }
    }
    let body = dir.path().join("bad.obj").display().to_string();
    let vest = vest(
        dir.path(),
        &[
            (
                "Mannequin(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")",
                &format!("BodyObj(file: {body:?})"),
            ),
            ("cotton poplin", "coton poplin"),
        ],
    );
    let answer = toile(&["validate", &vest]);
    for text in ["line 1 of the OBJ: a vertex needs three numbers", "there is no fabric preset"] {
        assert!(words(&answer).contains(text), "{text}: {}", answer.err);
    }
}

#[test]
fn a_photo_is_looked_at_by_its_header() {
    let dir = tempfile::tempdir().unwrap();
    let whole = fs::read(pipeline("samples/vest/front.jpg")).unwrap();
    for (name, bytes, what) in [
        ("cut.jpg", &whole[..5000], "ends before its picture does"),
        ("text.jpg", b"hello", "is not a JPEG, PNG, WebP or TIFF picture"),
        ("empty.jpg", b"", "is empty"),
    ] {
        let path = dir.path().join(name);
        fs::write(&path, bytes).unwrap();
        let set = format!("photos.front.file={:?}", path.display().to_string());
        let answer = toile(&["validate", &pipeline("vest.ron"), "--set", &set]);
        assert_eq!(answer.code, 3);
        assert!(words(&answer).contains(what), "{}", answer.err);
        // The option is shown, and no line of the file.
        assert!(
            answer.err.contains("[command line:1:") && !answer.err.contains("vest.ron:"),
            "{}",
            answer.err
        );
    }
}

#[test]
fn near_names_of_stages_on_the_command_line() {
    let vest = pipeline("vest.ron");
    for (command, meant) in [
        (&["run", &vest, "--until", "Otzu"][..], "Otsu"),
        (&["run", &vest, "--also", "Preveiw"], "Preview"),
        (&["why", &vest, "Setle"], "Settle"),
        (&["explain", &vest, "--until", "GridMehser"], "GridMesher"),
    ] {
        let answer = toile(command);
        assert_eq!(answer.code, 3, "{command:?}");
        let asked = command[command.len() - 1];
        let head = format!(
            "× there is no stage `{asked}` in this pipeline help: did you mean `{meant}`? its stages are Photos, "
        );
        assert!(words(&answer).starts_with(&head), "{}", answer.err);
    }
}

#[test]
fn what_is_not_used_is_a_warning() {
    let dir = tempfile::tempdir().unwrap();
    let warned = |file: &str| {
        let answer = toile(&["validate", file]);
        assert_eq!(answer.code, 0, "{}", answer.err);
        answer.err.replace(file, "vest.ron")
    };
    for name in toile_tests::PIPELINES {
        assert_eq!(warned(&pipeline(name)), "");
    }
    let file = vest(dir.path(), &[("Report(),", "Report(), Subdivide(),")]);
    let line = fs::read_to_string(&file).unwrap().lines().position(|l| l.contains("Subdivide(")).unwrap() + 1;
    let expected = format!(
        "warning: vest.ron:{line}:44: nothing uses what `Subdivide` makes; it is left out of a run; \
         put a stage that takes a garment behind it, or take it away\n"
    );
    assert_eq!(warned(&file), expected);
    let json: Value = serde_json::from_str(&toile(&["validate", "--json", &file]).out).unwrap();
    assert_eq!((&json["valid"], &json["warnings"][0]["code"]), (&true.into(), &"unused".into()));

    let file = vest(dir.path(), &[("Glb(), Obj(), Preview(), Report(),", "Report(),")]);
    let text = fs::read_to_string(&file).unwrap();
    let line = text.lines().position(|l| l.trim() == "stages: [").unwrap() + 1;
    let said = warned(&file);
    let last = said.lines().next().unwrap();
    let head = format!("warning: vest.ron:{line}:5: the pipeline writes no garment; ");
    assert!(last.starts_with(&head) && last.ends_with(" write a model; put one of them last"), "{said}");
}

#[test]
fn a_stage_after_the_report_is_no_panic_and_what_is_written_is_judged() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out").display().to_string();
    let triangles = |end: &str| {
        let file = vest(dir.path(), &[("Glb(), Obj(), Preview(), Report(),", end)]);
        let run = toile(&["run", &file, "--json", "--out", &out]);
        assert_eq!(run.code, 4, "{end}: {}{}", run.out, run.err);
        let json: Value = serde_json::from_str(&run.out).unwrap();
        json["garment"]["triangles"].as_u64().unwrap() as usize
    };
    let was = triangles("GarmentObj(), Report(),");
    for late in ["Subdivide(parts: 2)", "PlaneSmoother()", "BvhCollider()"] {
        assert_eq!(triangles(&format!("GarmentObj(), Report(), {late},")), was, "{late}");
    }
    // What is written after the report is what is judged.
    let judged = triangles("Report(), Subdivide(parts: 2), GarmentObj(),");
    let written = fs::read_to_string(format!("{out}/result.obj")).unwrap();
    assert_eq!(judged, written.lines().filter(|l| l.starts_with("f ")).count());
    assert!(judged > 3 * was);
}

#[test]
fn values_out_of_range_come_out_with_all_other_faults_in_the_order_of_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let file = vest(
        dir.path(),
        &[
            ("vest/front.jpg", "vest/none.jpg"),
            ("height: \"172 cm\", bust: \"88 cm\"", "height: \"105 m\", bust: \"8 m\""),
            ("cotton poplin", "coton poplin"),
            ("edge: \"16 mm\"", "edge: \"16 m\""),
            ("Glb()", "Glb(name: \"a/b\")"),
        ],
    );
    let answer = toile(&["validate", "--json", &file]);
    assert_eq!(answer.code, 3);
    let said: Value = serde_json::from_str(&answer.out).unwrap();
    let faults = said["faults"].as_array().unwrap();
    let text = fs::read_to_string(&file).unwrap();
    let places: Vec<String> = faults
        .iter()
        .map(|f| {
            let number = |key: &str| f[key].as_u64().unwrap() as usize;
            let line = text.lines().nth(number("line") - 1).unwrap();
            line.chars().skip(number("column") - 1).take_while(|c| !",)".contains(*c)).collect()
        })
        .collect();
    let photo = format!("\"{}samples/vest/none.jpg\"", pipeline(""));
    let expected = [photo.as_str(), "\"105 m\"", "\"8 m\"", "\"coton poplin\"", "\"16 m\"", "\"a/b\""];
    assert_eq!(places, expected, "{faults:#?}");
    let message = |k: usize| faults[k]["message"].as_str().unwrap();
    assert!(message(1).starts_with("`height` is 105 m, above its greatest value "), "{}", message(1));
    assert!(message(4).starts_with("`edge` is 16 m, above its greatest value "), "{}", message(4));

    // Of a stage with such a value nothing else is said: what it takes by default in its place is
    // not the user's.
    let file = vest(dir.path(), &[("smooth: 1", "low: 90, high: 6000, smooth: 1")]);
    let answer = toile(&["validate", &file]);
    let told = answer.err.lines().filter(|line| line.trim_start().starts_with('×')).count();
    assert_eq!((answer.code, told), (3, 1), "{}", answer.err);
    assert!(words(&answer).contains("`high` is 6000, above its greatest value"), "{}", answer.err);
}

#[test]
fn a_garment_is_brought_along_from_the_body_that_it_is_draped_on() {
    let dir = tempfile::tempdir().unwrap();
    let told = |before: &str, after: &str| {
        let text = fs::read_to_string(pipeline("photo_tee.ron")).unwrap();
        let text = text.replace("samples/", &format!("{}samples/", pipeline("")));
        let text = text.replace("Arrange(),", &format!("{before}Arrange(),"));
        let text = text.replace("PoseBody(), PoseGarment(), ", after);
        let text = text.replace("id: \"Settle\"", "id: \"Settle\", from: \"Hanging\"");
        let file = dir.path().join("tee.ron");
        fs::write(&file, text).unwrap();
        let answer = toile(&["validate", file.to_str().unwrap()]);
        (answer.code, words(&answer))
    };
    assert_eq!(told("", "PoseBody(), PoseGarment(), ").0, 0);
    let (code, said) = told("PoseBody(id: \"Lower\", arm_angle: 40), ", "PoseBody(), PoseGarment(), ");
    assert_eq!(code, 3);
    assert!(
        said.contains("the garment is draped on the body of `Lower`, and not on the first one"),
        "{said}"
    );
    assert!(said.contains("let `PoseBody` stand between the drape and `PoseGarment`"), "{said}");
    let (code, said) = told("", "PoseGarment(), ");
    assert_eq!(code, 3);
    assert!(said.contains("the body has one pose alone"), "{said}");
}
