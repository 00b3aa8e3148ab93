//! Seams that are proposed for a drawing, and what a user takes of them.

use crate::kit::Served;
use serde_json::{Value, json};

fn sample(file: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/samples/pattern").join(file)
}

const DRAWN: &str = "(name: \"drawn\", pattern: SvgPattern(file: \"mine.svg\"), stages: [PatternSvg()])";

fn is_done(state: &Value) -> bool {
    assert_ne!(state["run"]["state"], "failed", "{state:#}");
    let run = &state["run"];
    run["edit"] == state["project"]["edit"] && run["state"] == "done" && run["kind"] == "full"
}

fn names(view: &Value, of: &str) -> Vec<String> {
    let list = view.pointer(of).and_then(Value::as_array).unwrap_or_else(|| panic!("{of}: {view:#}"));
    list.iter().map(|seam| seam["name"].as_str().unwrap().to_owned()).collect()
}

/// A studio on the drawing whose first run is done, with the folder.
fn drawn() -> (tempfile::TempDir, Served) {
    let dir = tempfile::tempdir().unwrap();
    std::fs::copy(sample("pleats.svg"), dir.path().join("mine.svg")).unwrap();
    std::fs::write(dir.path().join("pipeline.ron"), DRAWN).unwrap();
    let served = Served::new(dir.path(), true);
    served.client.wait("the first run", is_done);
    (dir, served)
}

#[test]
fn a_drawing_is_proposed_seams_and_those_that_are_taken_are_sewn() {
    let (_dir, served) = drawn();
    let client = &served.client;
    let view = client.get("/api/view").json();
    let proposed = names(&view, "/proposals");
    assert!(proposed.len() >= 2 && names(&view, "/pattern/seams").is_empty(), "{proposed:?}");
    let first = &view["proposals"][0];
    let confidence = first["confidence"].as_f64().unwrap();
    assert!((0.5..=0.99).contains(&confidence), "{first:#}");
    assert!(first["reason"].as_str().unwrap().contains(" mm to "), "{first:#}");
    assert_eq!(first["sides"].as_array().unwrap().len(), 2);

    let edit = client.state()["project"]["edit"].clone();
    let sew = |edit: &Value, seams: &[&str]| {
        client.post("/api/sew", &json!({ "edit": edit, "words": "sew", "seams": seams }))
    };
    let unknown = sew(&edit, &["front.nowhere + back.nowhere"]).refusal();
    let message = "there is no proposed seam \"front.nowhere + back.nowhere\"";
    assert_eq!(unknown, (404, "not_found".to_owned(), message.to_owned()));
    assert_eq!(sew(&edit, &[]).refusal(), (400, "malformed".to_owned(), "no seam is named".to_owned()));
    assert_eq!(sew(&json!(7), &[&proposed[0]]).refusal().1, "stale");

    let taken = sew(&edit, &[&proposed[0]]);
    assert_eq!(taken.status, 200, "{}", taken.text());
    let state = client.wait("the run with the seam", |s| s["project"]["edit"] != edit && is_done(s));
    let text = client.state()["text"].as_str().unwrap().to_owned();
    assert_eq!(text, DRAWN.replace("file: ", "seams: \"seams.ron\", file: "));
    let view = client.get("/api/view").json();
    assert_eq!(
        (names(&view, "/pattern/seams"), names(&view, "/proposals")),
        (vec![proposed[0].clone()], vec![])
    );
    let again = sew(&state["project"]["edit"], &[&proposed[1]]).refusal();
    assert_eq!(again.2, "the pattern's file has its seams, or takes none");

    client.post("/api/undo", &json!({ "edit": state["project"]["edit"] }));
    client.wait("the run without it", |s| s["project"]["can_redo"] == "sew" && is_done(s));
    assert_eq!(names(&client.get("/api/view").json(), "/proposals"), proposed);
}

#[test]
fn edges_that_were_sewn_by_hand_are_not_proposed_any_more() {
    let (_dir, served) = drawn();
    let client = &served.client;
    let view = client.get("/api/view").json();
    let all = names(&view, "/proposals");
    let edge = |side: usize| {
        let used = &view["proposals"][0]["sides"][side][0];
        format!("{}.{}", used["piece"].as_str().unwrap(), used["edge"].as_str().unwrap())
    };
    let alter = format!("Alter(alterations: [Sew(a: {:?}, b: {:?})])", edge(0), edge(1));
    let change = json!({ "add": { "stage": alter, "after": "SvgPattern" } });
    let edit = json!({ "edit": client.state()["project"]["edit"], "changes": [change] });
    assert_eq!(client.post("/api/edit", &edit).status, 200);
    client.wait("the run with the seam", |s| s["project"]["edit"] == 2 && is_done(s));
    let view = client.get("/api/view").json();
    assert_eq!((names(&view, "/pattern/seams").len(), names(&view, "/proposals")), (1, all[1..].to_vec()));
}
