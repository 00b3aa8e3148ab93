//! Edits of the text, undo and redo, the journal, several pages.

use crate::kit::{MASKS, Served, folder, registry, stage};
use serde_json::{Value, json};
use std::path::Path;
use toile_studio::{StudioChange, StudioProject};

fn edit(number: u64, words: &str, changes: Value) -> Value {
    json!({ "edit": number, "words": words, "changes": changes })
}

#[test]
fn all_changes_of_an_edit_are_made_and_comments_stay() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    let changes = json!([
        { "set": { "path": "stages.Otsu.bias", "value": "5" } },
        { "remove": "photos.back" },
        { "add": { "stage": "Canny(smooth: 2)", "after": "Otsu" } },
        { "swap": { "stage": "Canny", "with": "Laplacian()" } },
        { "add": { "stage": "Canny()", "after": null } },
    ]);
    let reply = client.post("/api/edit", &edit(1, "try  it\nall", changes)).json();
    // Two edge detectors: nothing says which of them counts.
    assert_eq!(reply, json!({ "edit": 2 }), "{reply:#}");
    let state = client.state();
    let text = MASKS
        .replace("bias: 2", "bias: 5")
        .replace(
            "        \"back\":  (file: \"back.jpg\",  width: \"52 cm\"),  // its back",
            "        // its back",
        )
        .replace("5),\n    ]", "5),\n        Laplacian(),\n        Canny(),\n    ]");
    assert_eq!(state["text"], text);
    let project = &state["project"];
    assert_eq!(
        (&project["saved"], &project["can_undo"], &project["file"]),
        (&json!(false), &json!("try it all"), &json!("pipeline.ron"))
    );
    assert_eq!(std::fs::read_to_string(dir.path().join("pipeline.ron")).unwrap(), MASKS, "not saved yet");
    let otsu = stage(&state, "Otsu");
    assert_eq!((&otsu["path"], &otsu["params"]), (&json!("stages.Otsu"), &json!({ "bias": "5" })));
    assert_eq!(
        (&otsu["made_by"], &otsu["state"], &otsu["role"]),
        (&json!(["NeighbourhoodMean"]), &json!("waiting"), &json!("binariser"))
    );
    assert_eq!(client.post("/api/save", &json!({})).json(), json!({ "file": "pipeline.ron" }));
    assert_eq!(std::fs::read_to_string(dir.path().join("pipeline.ron")).unwrap(), text);
    assert_eq!(client.state()["project"]["saved"], true);
}

#[test]
fn an_edit_that_cannot_be_leaves_everything_as_it_was() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    let good = json!({ "set": { "path": "name", "value": "\"other\"" } });
    let refused = |bad: Value| {
        let reply = client.post("/api/edit", &edit(1, "bad", json!([good.clone(), bad])));
        let (status, code, message) = reply.refusal();
        format!("{status} {code}: {message}; {}", reply.json()["error"]["hint"].as_str().unwrap_or("-"))
    };
    assert_eq!(
        refused(json!({ "set": { "path": "stages.Otzu.bias", "value": "5" } })),
        "422 bad_edit: no stage in `stages` has the id `Otzu`; did you mean `stages.Otsu.bias`?"
    );
    assert_eq!(
        refused(json!({ "remove": "stages.NeighbourhoodMean.radius" })),
        "422 bad_edit: the file does not give `stages.NeighbourhoodMean.radius`; it has its default already"
    );
    assert_eq!(
        refused(json!({ "swap": { "stage": "Otsu", "with": "7" } })),
        "422 bad_edit: `7` is no stage; write `Name(field: value)`"
    );
    let reply = client.post(
        "/api/edit",
        &edit(1, "bad", json!([{ "set": { "path": "stages.Otsu.bias", "value": "500" } }])),
    );
    let error = &reply.json()["error"];
    assert_eq!(
        (reply.status, &error["code"], &error["message"]),
        (422, &json!("faults"), &json!("the edit would leave a file with faults"))
    );
    let fault = &error["faults"][0];
    assert_eq!(
        (&fault["code"], &fault["line"], &fault["column"]),
        (&json!("bad_value"), &json!(10), &json!(20)),
        "{error:#}"
    );
    let message = fault["message"].as_str().unwrap();
    assert!(message.contains("bias") && message.contains("500"), "{message}");
    // A file that is not there is a fault as well.
    let missing = json!([{ "set": { "path": "photos.front.file", "value": "\"missing.jpg\"" } }]);
    let reply = client.post("/api/edit", &edit(1, "bad", missing));
    assert_eq!(reply.status, 422);
    assert!(reply.json()["error"]["hint"].as_str().unwrap().contains("missing.jpg"), "{}", reply.text());
    let state = client.state();
    assert_eq!(
        (&state["text"], &state["project"]["edit"], &state["project"]["can_undo"]),
        (&json!(MASKS), &json!(1), &Value::Null)
    );
}

#[test]
fn who_edits_an_older_text_is_told_so() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let (one, other) = (served.client.clone(), served.client.clone());
    let set = |name: &str| json!([{ "set": { "path": "name", "value": format!("{name:?}") } }]);
    assert_eq!(one.post("/api/edit", &edit(1, "first", set("a"))).json(), json!({ "edit": 2 }));
    let reply = other.post("/api/edit", &edit(1, "second", set("b")));
    assert_eq!(reply.refusal(), (409, "stale".to_owned(), "the text is at edit 2, not at 1".to_owned()));
    assert_eq!(reply.json()["error"]["hint"], "take the new state, and edit that");
    assert_eq!(one.state(), other.state(), "both see the same");
    assert_eq!(other.post("/api/undo", &json!({ "edit": 1 })).status, 409);
    assert_eq!(other.post("/api/edit", &edit(2, "second", set("b"))).json(), json!({ "edit": 3 }));
    assert_eq!(one.state()["project"]["can_undo"], "second");
}

#[test]
fn undo_and_redo_walk_through_the_texts() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    let set = |name: &str| json!([{ "set": { "path": "name", "value": format!("{name:?}") } }]);
    let nothing = |what: &str, words: &str| {
        let refusal =
            client.post(&format!("/api/{what}"), &json!({ "edit": client.edit_number() })).refusal();
        assert_eq!(refusal, (422, "nothing".to_owned(), words.to_owned()));
    };
    nothing("undo", "there is nothing to undo");
    nothing("redo", "there is nothing to redo");
    client.post("/api/edit", &edit(1, "one", set("a")));
    client.post("/api/edit", &edit(2, "two", set("b")));
    let walk = |what: &str, number: u64| {
        assert_eq!(
            client.post(&format!("/api/{what}"), &json!({ "edit": number })).json(),
            json!({ "edit": number + 1 })
        );
        let state = client.state();
        let text = state["text"].as_str().unwrap();
        let name = text.split("name: \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        (name, state["project"]["can_undo"].clone(), state["project"]["can_redo"].clone())
    };
    assert_eq!(walk("undo", 3), ("a".into(), json!("one"), json!("two")));
    assert_eq!(walk("undo", 4), ("masks".into(), Value::Null, json!("one")));
    assert_eq!(client.state()["project"]["saved"], true);
    assert_eq!(walk("redo", 5), ("a".into(), json!("one"), json!("two")));
    client.post("/api/edit", &edit(6, "three", set("c")));
    nothing("redo", "there is nothing to redo");
}

#[test]
fn a_text_on_its_way_may_have_faults_and_is_one_step() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    let mut number = 1;
    let mut typed = |text: &str, draft: bool| {
        let asked = json!({ "edit": number, "words": "type", "changes": [{ "text": text }], "draft": draft });
        let reply = client.post("/api/edit", &asked);
        number += u64::from(reply.status == 200);
        reply
    };
    assert_eq!(typed(&MASKS.replace("Otsu(bias: 2)", "Otsu(bia"), true).status, 200);
    let state = client.state();
    let fault = &state["faults"][0];
    let (start, end) = (fault["start"].as_u64().unwrap() as usize, fault["end"].as_u64().unwrap() as usize);
    let text = state["text"].as_str().unwrap();
    assert!(text.get(start..end).is_some() && fault["line"].as_u64().unwrap() >= 10, "{fault}");
    assert_eq!(
        stage(&state, "Otsu")["params"],
        json!({ "bias": "2" }),
        "the stages of the last text that could be read"
    );
    assert_eq!(
        client.post("/api/run", &json!({})).refusal(),
        (422, "faults".to_owned(), "the text has faults".to_owned())
    );
    assert_eq!(typed(&MASKS.replace("Otsu(bias: 2)", "Otsu(bias: 3"), true).status, 200);
    assert_eq!(typed(&MASKS.replace("Otsu(bias: 2)", "Otsu(bias: 3"), false).status, 422);
    assert_eq!(typed(&MASKS.replace("bias: 2", "bias: 3"), false).status, 200);
    assert_eq!(client.state()["faults"], json!([]));
    client.post("/api/undo", &json!({ "edit": 4 }));
    assert_eq!(client.state()["text"], MASKS);
}

#[test]
fn what_was_answered_comes_back_though_nothing_was_saved() {
    let dir = folder(MASKS);
    let set = |path: &str, value: &str| vec![StudioChange::Set { path: path.into(), value: value.into() }];
    let text = {
        let mut project = StudioProject::open(dir.path(), registry()).unwrap();
        project.edit(1, "one", &set("name", "\"a\""), false).unwrap();
        project.edit(2, "two", &set("name", "\"b\""), false).unwrap();
        project.edit(3, "three", &set("name", "\"c\""), false).unwrap();
        project.undo(4).unwrap();
        project.text().to_owned()
    };
    // The last line of a program that was killed.
    let journal = dir.path().join(".toile-studio/journal");
    let whole = std::fs::read(&journal).unwrap();
    std::fs::write(&journal, [whole.as_slice(), b"{\"step\":\"edit\",\"words\":\"cut o"].concat()).unwrap();
    let mut project = StudioProject::open(dir.path(), registry()).unwrap();
    assert_eq!((project.text(), project.is_saved()), (text.as_str(), false));
    assert_eq!((project.can_undo(), project.can_redo()), (Some("two"), Some("three")));
    project.redo(project.number()).unwrap();
    assert!(project.text().contains("\"c\""));
    project.save().unwrap();
    drop(project);
    let project = StudioProject::open(dir.path(), registry()).unwrap();
    assert!(project.is_saved() && project.text().contains("\"c\"") && project.can_undo().is_none());
}

#[test]
fn a_journal_of_another_file_is_put_aside() {
    let dir = folder(MASKS);
    let set = [StudioChange::Set { path: "name".into(), value: "\"a\"".into() }];
    StudioProject::open(dir.path(), registry()).unwrap().edit(1, "one", &set, false).unwrap();
    let changed = MASKS.replace("masks", "elsewhere");
    std::fs::write(dir.path().join("pipeline.ron"), &changed).unwrap();
    let project = StudioProject::open(dir.path(), registry()).unwrap();
    assert_eq!((project.text(), project.is_saved()), (changed.as_str(), true));
    let aside = std::fs::read_to_string(dir.path().join(".toile-studio/journal.old")).unwrap();
    assert!(aside.contains("\"words\":\"one\""), "{aside}");
}

#[test]
fn a_file_that_another_program_changed_is_not_written_over_at_once() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    client.post("/api/edit", &edit(1, "one", json!([{ "set": { "path": "name", "value": "\"a\"" } }])));
    std::fs::write(dir.path().join("pipeline.ron"), "(stages: [Otsu()])").unwrap();
    let reply = client.post("/api/save", &json!({}));
    let words = "\"pipeline.ron\" was changed by another program";
    assert_eq!(reply.refusal(), (409, "changed".to_owned(), words.to_owned()));
    assert_eq!(reply.json()["error"]["hint"], "save once more to write over it");
    assert_eq!(client.post("/api/save", &json!({})).status, 200);
    assert!(std::fs::read_to_string(dir.path().join("pipeline.ron")).unwrap().contains("name: \"a\""));
}

#[test]
fn a_file_of_any_name_is_opened_beside_others() {
    let dir = folder(MASKS);
    std::fs::rename(dir.path().join("pipeline.ron"), dir.path().join("mine.ron")).unwrap();
    let served = Served::new(&dir.path().join("mine.ron"), false);
    let client = &served.client;
    assert_eq!(client.state()["project"]["file"], "mine.ron");
    client.post("/api/edit", &edit(1, "one", json!([{ "set": { "path": "name", "value": "\"a\"" } }])));
    assert!(dir.path().join(".toile-studio/mine.ron.journal").is_file());
    assert_eq!(client.post("/api/save", &json!({})).json()["file"], "mine.ron");
    assert!(!Path::new(dir.path()).join("pipeline.ron").exists());
}
