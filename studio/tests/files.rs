//! Uploads, beginnings, folders.

use crate::kit::{MASKS, Served, folder, options, registry};
use serde_json::{Value, json};
use toile_studio::{StudioProject, StudioServer};

#[test]
fn an_upload_keeps_its_name_unless_other_bytes_have_it() {
    let dir = tempfile::tempdir().unwrap();
    let served = Served::new(dir.path(), false);
    let up = |name: &str, bytes: &[u8]| {
        let reply = served.client.request("POST", &format!("/api/upload?name={name}"), "", bytes);
        assert_eq!(reply.status, 200, "{}", reply.text());
        reply.json()["file"].as_str().unwrap().to_owned()
    };
    assert_eq!(up("tee.jpg", b"one"), "tee.jpg");
    assert_eq!(up("tee.jpg", b"one"), "tee.jpg", "the same once more");
    assert_eq!(up("tee.jpg", b"two"), "tee-2.jpg");
    assert_eq!(up("tee.jpg", b"three"), "tee-3.jpg");
    assert_eq!(up("tee.jpg", b"two"), "tee-2.jpg");
    assert_eq!(up("my%20tee%20%E2%82%AC".replace("%E2%82%AC", "%C3%A4").as_str(), b"x"), "my tee ä");
    assert_eq!(up("pipeline.ron", b"()"), "pipeline-2.ron", "that name is the project's");
    assert_eq!(std::fs::read(dir.path().join("tee-3.jpg")).unwrap(), b"three");
    let mut names: Vec<String> = std::fs::read_dir(dir.path())
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, [".toile-studio", "my tee ä", "pipeline-2.ron", "tee-2.jpg", "tee-3.jpg", "tee.jpg"]);
}

#[test]
fn names_that_are_none_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let served = Served::new(dir.path(), false);
    for (sent, name) in [
        ("..%2ftee.jpg", "../tee.jpg"),
        ("a%5cb.jpg", "a\\b.jpg"),
        ("%2fetc%2fpasswd", "/etc/passwd"),
        (".hidden", ".hidden"),
        ("..", ".."),
        ("", ""),
        ("a%00.jpg", "a\0.jpg"),
        ("tee.jpg%20", "tee.jpg "),
        ("a:b", "a:b"),
        ("tee.", "tee."),
    ] {
        let reply = served.client.request("POST", &format!("/api/upload?name={sent}"), "", b"x");
        let message = format!("\"{name}\" is no plain file name");
        assert_eq!(reply.refusal(), (400, "bad_name".to_owned(), message));
        assert_eq!(
            reply.json()["error"]["hint"],
            "letters, digits, `-`, `_`, `.` and spaces, no dot in front"
        );
    }
    let reply = served.client.request("POST", "/api/upload", "", b"x");
    assert_eq!(reply.refusal(), (400, "malformed".to_owned(), "an upload needs a name".to_owned()));
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
}

#[test]
fn a_project_begins_with_a_sample_a_photo_or_a_pattern() {
    for (with, stage, lacks) in [
        (json!({ "sample": "vest" }), "Subdivide", None),
        (json!({ "sample": "tshirt" }), "Subdivide", None),
        (json!({ "sample": "skirt" }), "Block", None),
        (json!({ "sample": "trousers" }), "Block", None),
        (json!({ "sample": "shirt_pattern" }), "GarmentCode", None),
        (json!({ "photo": "tee.jpg", "width": "80 cm" }), "Neckline", Some("tee.jpg")),
        (json!({ "photo": "tee.jpg" }), "Neckline", Some("tee.jpg")),
        (json!({ "pattern": "mine.json" }), "GarmentCode", Some("mine.json")),
        (
            json!({ "pattern": "skirt.sm2d", "measurements": "body.smis" }),
            "SeamlyPattern",
            Some("skirt.sm2d"),
        ),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let served = Served::new(dir.path(), false);
        let state = served.client.state();
        assert_eq!((&state["project"]["file"], &state["text"]), (&Value::Null, &json!("")));
        if let Some(file) = lacks {
            let refusal = served.client.post("/api/begin", &with).refusal();
            assert_eq!(refusal, (404, "not_found".to_owned(), format!("the project has no file \"{file}\"")));
            let lay = |shipped: &str, name: &str| {
                let samples = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/samples");
                std::fs::copy(samples.join(shipped), dir.path().join(name)).unwrap();
            };
            match file {
                "tee.jpg" => lay("tshirt/front.jpg", file),
                "skirt.sm2d" => lay("pattern/skirt.sm2d", file),
                _ => lay("pattern/shirt_specification.json", file),
            }
            if let Some(measurements) = with["measurements"].as_str() {
                let refusal = served.client.post("/api/begin", &with).refusal();
                assert_eq!(refusal.2, format!("the project has no file \"{measurements}\""));
                lay("pattern/body.smis", measurements);
            }
        }
        let begun = served.client.post("/api/begin", &with);
        assert_eq!((begun.status, begun.json()), (200, json!({ "edit": 1 })), "{with}");
        let state = served.client.state();
        assert_eq!((&state["faults"], &state["project"]["saved"]), (&json!([]), &json!(true)), "{with}");
        assert!(state["stages"].as_array().unwrap().iter().any(|s| s["name"] == stage), "{with}: {state:#}");
        let text = state["text"].as_str().unwrap();
        assert!(text.contains("// "), "comments stay");
        let by_card = text.contains("\"front\": (scale: BankCard, file: \"tee.jpg\")");
        assert_eq!(by_card, with == json!({ "photo": "tee.jpg" }), "{text}");
        let again = served.client.post("/api/begin", &with).refusal();
        assert_eq!(again, (409, "exists".to_owned(), "the project has a pipeline already".to_owned()));
    }
}

#[test]
fn a_project_begins_anew_and_undo_brings_the_pipeline_before_it_back() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    std::fs::write(dir.path().join("mine.jpg"), "no picture").unwrap();
    let with = json!({ "photo": "mine.jpg", "width": "80 cm", "anew": true });
    assert_eq!(client.post("/api/begin", &with).json(), json!({ "edit": 2 }));
    let state = client.state();
    assert!(state["text"].as_str().unwrap().contains("\"mine.jpg\""), "{state:#}");
    assert_eq!(state["project"]["can_undo"], "begin with mine.jpg");
    // The sample's photo is not the one that lies here.
    std::fs::write(dir.path().join("front.jpg"), "mine").unwrap();
    let refusal = client.post("/api/begin", &json!({ "sample": "vest", "anew": true })).refusal();
    assert_eq!(refusal.2, "the folder holds another file \"front.jpg\"");
    client.post("/api/undo", &json!({ "edit": 2 }));
    assert_eq!(client.state()["text"], MASKS);
}

#[test]
fn a_beginning_that_is_none_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let served = Served::new(dir.path(), false);
    let begin = |with: Value| {
        let (status, _, message) = served.client.post("/api/begin", &with).refusal();
        format!("{status} {message}")
    };
    assert_eq!(begin(json!({})), "400 a project begins with a photo, a pattern or a sample");
    assert_eq!(begin(json!({ "sample": "shoe" })), "404 there is no sample \"shoe\"");
    assert_eq!(begin(json!({ "photo": "../tee.jpg" })), "400 \"../tee.jpg\" is no plain file name");
    assert_eq!(
        begin(json!({ "photo": "tee.jpg", "width": "76" })),
        "400 \"76\" is not a length; write a number and a unit, like \"12 mm\" (mm, cm, m, in)"
    );
    assert_eq!(
        begin(json!({ "pattern": "mine.doc" })),
        "400 \"mine.doc\" is no pattern file that is known by its ending"
    );
    assert_eq!(
        begin(json!({ "pattern": "mine.dxf", "measurements": "body.smis" })),
        "400 \"mine.dxf\" is not drafted to measure: it takes no measurements"
    );
    let edit = json!({ "edit": 0, "changes": [{ "text": "()" }] });
    let (status, code, message) = served.client.post("/api/edit", &edit).refusal();
    assert_eq!(
        (status, code.as_str(), message.as_str()),
        (422, "no_pipeline", "the project has no pipeline yet")
    );
}

#[test]
fn a_second_studio_of_a_folder_is_refused() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let refused = StudioServer::open(options(&dir.path().join("pipeline.ron"), false), None).unwrap_err();
    let real = dir.path().canonicalize().unwrap();
    assert_eq!(refused.message, format!("the folder \"{}\" is open in another studio", real.display()));
    assert_eq!(refused.hint.as_deref(), Some("close that one first, or open another folder"));
    drop(served);
    StudioProject::open(dir.path(), registry()).unwrap();
}

#[test]
fn what_is_no_file_and_no_folder_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let missing = dir.path().join("missing.ron");
    let refused = StudioProject::open(&missing, registry()).unwrap_err();
    let words = format!("cannot open \"{}\": No such file or directory (os error 2)", missing.display());
    assert_eq!(refused.message, words);
}
