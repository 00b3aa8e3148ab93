//! Random sequences of what users do leave a file that the command line loads.

use crate::kit::{MASKS, Served, folder, registry};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use toile_core::Registry;
use toile_studio::{StudioChange, StudioProject};

/// What a user may do.
#[derive(Debug, Clone)]
enum Act {
    Edit(StudioChange, bool),
    Undo,
    Redo,
    Save,
    /// The program ends and starts again.
    Reopen,
}

fn change() -> impl Strategy<Value = StudioChange> {
    let ids = proptest::sample::select(vec!["NeighbourhoodMean", "Otsu", "Canny", "Glb", "Laplacian"]);
    let stages = proptest::sample::select(vec![
        "Otsu()",
        "Background()",
        "Canny(smooth: 2)",
        "Laplacian()",
        "NeighbourhoodMean(radius: 2)",
        "Report()",
        "Nonsense()",
        "Otsu(",
    ]);
    let paths = proptest::sample::select(vec![
        "name",
        "photos.back",
        "photos.front.width",
        "photos.front.file",
        "stages.Otsu.bias",
        "stages.Canny.smooth",
        "stages.NeighbourhoodMean.radius",
        "stages.Otsu",
        "body",
        "style",
        "nothing.there",
    ]);
    let values = proptest::sample::select(vec![
        "3",
        "-7",
        "\"54 cm\"",
        "\"front.jpg\"",
        "Mannequin()",
        "(",
        "\"\\\"\"",
        "Otsu(bias: 1)",
    ]);
    let texts = proptest::sample::select(vec![
        MASKS.to_owned(),
        MASKS.replace("Otsu(bias: 2)", "Background() /* other */"),
        MASKS.replace("stages", "stagez"),
        String::new(),
    ]);
    prop_oneof![
        4 => (paths.clone(), values).prop_map(|(path, value)| StudioChange::Set { path: path.into(), value: value.into() }),
        2 => paths.prop_map(|path| StudioChange::Remove(path.into())),
        2 => (ids.clone(), stages.clone()).prop_map(|(stage, with)| StudioChange::Swap { stage: stage.into(), with: with.into() }),
        2 => (stages, proptest::option::of(ids))
            .prop_map(|(stage, after)| StudioChange::Add { stage: stage.into(), after: after.map(str::to_owned) }),
        1 => texts.prop_map(StudioChange::Text),
    ]
}

fn act() -> impl Strategy<Value = Act> {
    prop_oneof![
        8 => (change(), proptest::bool::weighted(0.15)).prop_map(|(change, draft)| Act::Edit(change, draft)),
        2 => Just(Act::Undo),
        1 => Just(Act::Redo),
        1 => Just(Act::Save),
        1 => Just(Act::Reopen),
    ]
}

/// A pipeline as a load sees it: stages with all their parameters, and their feeds.
fn loaded(text: &str, folder: &Path, registry: &Registry) -> Result<Vec<String>, String> {
    let pipeline =
        toile_pipeline::load(text, "pipeline.ron", folder, registry, &[]).map_err(|f| f.to_string())?;
    let line = |n: &toile_core::Node| format!("{} {} {:?}", n.id, n.stage.params(), n.inputs);
    Ok(pipeline.nodes.iter().map(line).collect())
}

/// Does it to a project; what must hold after every step.
fn lived(acts: &[Act], registry: &Arc<Registry>) {
    let dir = folder(MASKS);
    let open = || StudioProject::open(dir.path(), registry.clone()).unwrap();
    let mut project = open();
    let mut texts: Vec<String> = Vec::new();
    for act in acts {
        let (before, number) = (project.text().to_owned(), project.number());
        let done = match act {
            Act::Edit(change, draft) => {
                project.edit(number, "edit", std::slice::from_ref(change), *draft).is_ok()
            }
            Act::Undo => project.undo(number).is_ok(),
            Act::Redo => project.redo(number).is_ok(),
            Act::Save => {
                project.save().unwrap();
                let file = std::fs::read_to_string(dir.path().join("pipeline.ron")).unwrap();
                assert_eq!(file, project.text());
                assert_eq!(loaded(&file, dir.path(), registry), loaded(project.text(), dir.path(), registry));
                false
            }
            Act::Reopen => {
                drop(project);
                project = open();
                assert_eq!(project.text(), before, "nothing is lost");
                continue;
            }
        };
        assert_eq!(project.number(), number + u64::from(done));
        if !done {
            assert_eq!(project.text(), before, "{act:?}");
        }
        // What is not a draft, nor a step back to one, can be loaded.
        if let Act::Edit(_, false) = act
            && done
        {
            loaded(project.text(), dir.path(), registry)
                .unwrap_or_else(|f| panic!("{act:?}: {f}\n{}", project.text()));
        }
        texts.push(project.text().to_owned());
    }
    // Back to the first text that the history still knows, and forth again.
    let last = project.text().to_owned();
    let mut back = 0;
    while project.can_undo().is_some() {
        project.undo(project.number()).unwrap();
        back += 1;
    }
    for _ in 0..back {
        project.redo(project.number()).unwrap();
    }
    assert_eq!(project.text(), last);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_acts_leave_a_text_that_loads_the_same_from_the_file(acts in proptest::collection::vec(act(), 1..30)) {
        lived(&acts, &registry());
    }
}

/// A change as it is sent.
fn sent(change: &StudioChange) -> Value {
    match change {
        StudioChange::Set { path, value } => json!({ "set": { "path": path, "value": value } }),
        StudioChange::Remove(path) => json!({ "remove": path }),
        StudioChange::Swap { stage, with } => json!({ "swap": { "stage": stage, "with": with } }),
        StudioChange::Add { stage, after } => json!({ "add": { "stage": stage, "after": after } }),
        StudioChange::Text(text) => json!({ "text": text }),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    #[ignore = "slow: .ci/wide"]
    fn two_hundred_sequences_of_fifty_acts_through_the_server(acts in proptest::collection::vec(act(), 50)) {
        let dir = folder(MASKS);
        let registry = registry();
        let mut served = Some(Served::new(dir.path(), true));
        for act in &acts {
            let client = served.as_ref().unwrap().client.clone();
            let before = client.state();
            let number = before["project"]["edit"].as_u64().unwrap();
            let reply = match act {
                Act::Edit(change, draft) => {
                    client.post("/api/edit", &json!({ "edit": number, "words": "act", "changes": [sent(change)], "draft": draft }))
                }
                Act::Undo => client.post("/api/undo", &json!({ "edit": number })),
                Act::Redo => client.post("/api/redo", &json!({ "edit": number })),
                Act::Save => client.post("/api/save", &json!({})),
                Act::Reopen => {
                    drop(served.take());
                    served = Some(Served::new(dir.path(), true));
                    let after = served.as_ref().unwrap().client.state();
                    prop_assert_eq!(&after["text"], &before["text"], "nothing is lost");
                    continue;
                }
            };
            prop_assert!(reply.status == 200 || reply.status == 422, "{}: {}", reply.status, reply.text());
            if reply.status == 422 {
                prop_assert_eq!(&client.state()["text"], &before["text"]);
            }
        }
        let client = served.as_ref().unwrap().client.clone();
        // Back to a text without faults, as a user would go: a text that was saved with them and
        // opened again has nothing before it, and is written anew.
        while client.state()["faults"] != json!([]) {
            let number = client.edit_number();
            if client.post("/api/undo", &json!({ "edit": number })).status != 200 {
                let anew = json!({ "edit": number, "changes": [{ "text": MASKS }] });
                prop_assert_eq!(client.post("/api/edit", &anew).status, 200);
            }
        }
        prop_assert_eq!(client.post("/api/save", &json!({})).status, 200);
        let file = std::fs::read_to_string(dir.path().join("pipeline.ron")).unwrap();
        let state = client.state();
        prop_assert_eq!(state["text"].as_str(), Some(file.as_str()));
        prop_assert!(loaded(&file, dir.path(), &registry).is_ok());
    }
}
