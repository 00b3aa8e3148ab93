//! Runs that follow edits, and what they show.

use crate::kit::{COARSE, MASKS, Served, folder, stage};
use serde_json::{Value, json};

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// A mesh as a page reads it: the head, and the numbers of its arrays.
struct Mesh {
    head: Value,
    bytes: Vec<u8>,
}

impl Mesh {
    fn of(bytes: Vec<u8>) -> Self {
        assert_eq!(&bytes[..8], b"TOILEG1\0");
        let length = u32_at(&bytes, 8);
        let head: Value = serde_json::from_slice(&bytes[12..12 + length]).unwrap();
        let arrays = head["arrays"].as_object().unwrap();
        let place =
            |a: &Value| (a["offset"].as_u64().unwrap() as usize, a["count"].as_u64().unwrap() as usize);
        let end = arrays.values().map(|a| place(a).0 + 4 * place(a).1).max().unwrap();
        let first = arrays.values().map(|a| place(a).0).min().unwrap();
        assert_eq!((end, first % 4), (bytes.len(), 0), "arrays fill the file");
        assert!(first >= 12 + length && first < 16 + length);
        Mesh { head, bytes }
    }

    fn words(&self, name: &str) -> Vec<[u8; 4]> {
        let array = &self.head["arrays"][name];
        let (from, count) =
            (array["offset"].as_u64().unwrap() as usize, array["count"].as_u64().unwrap() as usize);
        self.bytes[from..from + 4 * count].chunks(4).map(|c| c.try_into().unwrap()).collect()
    }

    fn floats(&self, name: &str) -> Vec<f32> {
        self.words(name).into_iter().map(f32::from_le_bytes).collect()
    }

    fn indices(&self, name: &str) -> Vec<u32> {
        self.words(name).into_iter().map(u32::from_le_bytes).collect()
    }
}

fn is_done(state: &Value, kind: &str) -> bool {
    assert_ne!(state["run"]["state"], "failed", "{state:#}");
    state["run"]["state"] == "done" && state["run"]["kind"] == kind
}

#[test]
fn pieces_are_shown_as_they_start_and_start_where_they_were_dragged() {
    let dir = folder(COARSE);
    let served = Served::new(dir.path(), true);
    let client = &served.client;
    let state = client.wait("the vest", |s| is_done(s, "full"));
    let view = client.get("/api/view").json();
    assert_eq!((&view["start"], &view["unplaced"]), (&json!(true), &json!([])));
    let places = |part: &str| {
        let mesh = Mesh::of(client.get(part).body);
        let front =
            mesh.head["panels"].as_array().unwrap().iter().find(|p| p["name"] == "front").unwrap().clone();
        let range = |name: &str| front[name].as_u64().unwrap() as usize;
        let all = mesh.floats("positions");
        all[3 * range("first_vertex")..3 * (range("first_vertex") + range("vertices"))].to_vec()
    };
    let (start, worn) = (places("/api/start"), places("/api/garment"));
    assert_eq!(start.len(), worn.len());
    // A flat piece before the body.
    let depths = |of: &[f32]| {
        of.iter()
            .skip(2)
            .step_by(3)
            .copied()
            .fold([9.0, -9.0], |[lo, hi]: [f32; 2], z| [lo.min(z), hi.max(z)])
    };
    let [near, far] = depths(&start);
    assert!(far - near < 1e-5 && depths(&worn)[1] - depths(&worn)[0] > 0.03);
    let place = "[(piece: \"front\", middle: (\"0 mm\", \"1200 mm\", \"400 mm\"))]";
    let set = json!({ "set": { "path": "stages.Arrange.hand_places", "value": place } });
    let edit = json!({ "edit": state["project"]["edit"], "words": "place front", "changes": [set] });
    assert_eq!(client.post("/api/edit", &edit).status, 200);
    client.wait("the run", |s| {
        s["project"]["can_undo"] == "place front"
            && s["run"]["edit"] == s["project"]["edit"]
            && is_done(s, "full")
    });
    let moved = places("/api/start");
    assert!((depths(&moved)[0] - 0.4).abs() < 1e-5 && (depths(&moved)[1] - 0.4).abs() < 1e-5);
}

#[test]
fn the_draft_reads_a_drawing_whose_reader_gives_a_file_as_well() {
    let dir = tempfile::tempdir().unwrap();
    let drawing = "<svg xmlns='http://www.w3.org/2000/svg' width='30cm' height='40cm' viewBox='0 0 300 400'>\
        <path id='panel' d='M 10 10 H 290 V 390 H 10 Z'/></svg>";
    std::fs::write(dir.path().join("panel.svg"), drawing).unwrap();
    let text = "(name: \"drawing\", pattern: SvgPattern(file: \"panel.svg\"), stages: [GridMesher(edge: \"40 mm\")])";
    std::fs::write(dir.path().join("pipeline.ron"), text).unwrap();
    let served = Served::new(dir.path(), true);
    served.client.wait("the first run", |s| is_done(s, "full"));
    let view = served.client.get("/api/view").json();
    assert_eq!(view["pattern"]["pieces"][0]["name"], "panel");
}

#[test]
fn an_opened_file_is_run_and_its_photos_are_shown() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), true);
    let client = &served.client;
    let state = client.wait("the first run", |s| is_done(s, "full"));
    assert_eq!(state["run"]["number"], 2, "a draft, then the file as it says");
    let otsu = stage(&state, "Otsu");
    assert_eq!((&otsu["state"], &otsu["share"]), (&json!("done"), &json!(1.0)));
    assert!(otsu["figures"].as_array().unwrap().iter().any(|f| f["name"] == "front.threshold"), "{otsu:#}");
    let view = client.get("/api/view").json();
    assert_eq!(view["view"], state["view"]);
    let photos = view["photos"].as_array().unwrap();
    assert_eq!(photos.iter().map(|p| &p["name"]).collect::<Vec<_>>(), ["back", "front"]);
    assert_eq!(
        (&view["pattern"], &view["garment"], &view["figures"]),
        (&Value::Null, &json!(false), &Value::Null)
    );
    let photo = client.get("/api/photo/front");
    assert_eq!((photo.status, photo.header("content-type")), (200, Some("image/png")));
    let scale: f64 = photo.header("x-scale").unwrap().parse().unwrap();
    let (width, height) = (
        u32::from_be_bytes(photo.body[16..20].try_into().unwrap()),
        u32::from_be_bytes(photo.body[20..24].try_into().unwrap()),
    );
    assert!(width.max(height) <= 1600);
    assert!((f64::from(width) - scale * photos[1]["width"].as_f64().unwrap()).abs() < 1.0, "{scale}");
    let mask = client.get("/api/mask/front");
    assert_eq!(&mask.body[16..24], &photo.body[16..24], "of one size");
    assert_eq!(mask.body[25], 4, "grey with alpha");
    let missing = client.get("/api/photo/left").refusal();
    assert_eq!(missing, (404, "not_found".to_owned(), "there is no photo \"left\" yet".to_owned()));
}

#[test]
fn a_vest_is_shown_with_its_pattern_and_its_garment_and_what_an_edit_moved() {
    let dir = folder(COARSE);
    let served = Served::new(dir.path(), true);
    let client = &served.client;
    let state = client.wait("the vest", |s| is_done(s, "full"));
    assert_eq!(state["run"]["changed"]["mm"], Value::Null, "there was nothing before");
    let view = client.get("/api/view").json();
    assert_eq!((&view["garment"], &view["body"]), (&json!(true), &json!(true)));
    let pieces = view["pattern"]["pieces"].as_array().unwrap();
    assert_eq!(pieces.iter().map(|p| &p["name"]).collect::<Vec<_>>(), ["back", "front"]);
    assert!(pieces.iter().all(|p| p["photo"] == p["name"]));
    let edges: Vec<&str> =
        pieces[1]["edges"].as_array().unwrap().iter().map(|e| e["name"].as_str().unwrap()).collect();
    assert!(edges.contains(&"hem") && edges.contains(&"neck"), "{edges:?}");
    let seams = view["pattern"]["seams"].as_array().unwrap();
    assert!(
        seams.len() >= 4
            && seams.iter().all(|s| s["state"] == "closed" && s["gap_m"].as_f64().unwrap() < 2e-3),
        "{seams:#?}"
    );
    assert!(
        seams.iter().all(|s| s["sides"][0][0]["reverse"] == false && s["sides"][1][0]["reverse"] == true)
    );
    let outline = view["outlines"].as_array().unwrap().iter().find(|o| o["panel"] == "front").unwrap();
    let photo = view["photos"].as_array().unwrap().iter().find(|p| p["name"] == "front").unwrap();
    let inside = |p: &Value| {
        let within = |x: &Value, size: &Value| (0.0..=size.as_f64().unwrap()).contains(&x.as_f64().unwrap());
        within(&p[0], &photo["width"]) && within(&p[1], &photo["height"])
    };
    assert!(outline["points"].as_array().unwrap().iter().all(inside), "pixels of the photo");
    let landmarks = photo["landmarks"].as_array().unwrap();
    let names: Vec<&str> = landmarks.iter().map(|l| l["name"].as_str().unwrap()).collect();
    let corners = ["armpit", "hem", "neck", "shoulder"];
    let both: Vec<String> =
        corners.iter().flat_map(|c| [format!("{c}_left"), format!("{c}_right")]).collect();
    assert_eq!(names, both);
    assert!(
        view["figures"]["triangles"].as_u64().unwrap() > 100 && view["figures"]["strain_p99"].is_number()
    );
    assert!(!view["girths"].as_array().unwrap().is_empty());

    let mesh = Mesh::of(client.get("/api/garment").body);
    let (n, m) =
        (mesh.head["vertices"].as_u64().unwrap() as usize, mesh.head["triangles"].as_u64().unwrap() as usize);
    assert_eq!(
        (mesh.floats("positions").len(), mesh.indices("triangles").len(), mesh.floats("flat").len()),
        (3 * n, 3 * m, 2 * n)
    );
    assert_eq!(
        (mesh.floats("photo_px").len(), mesh.floats("uv").len(), mesh.floats("strain").len()),
        (2 * n, 2 * n, n)
    );
    assert!(mesh.indices("triangles").iter().all(|&i| (i as usize) < n));
    assert!(mesh.floats("uv").iter().all(|&x| (-0.5..1.5).contains(&x)), "textured all over");
    assert_eq!(mesh.head["open_seams"], json!([]));
    let panels = mesh.head["panels"].as_array().unwrap();
    let texture = panels[0]["texture"].as_u64().unwrap();
    let picture = client.get(&format!("/api/texture/{texture}"));
    assert_eq!((picture.status, &picture.body[..2]), (200, &[0xff, 0xd8][..]));
    let body = Mesh::of(client.get("/api/body").body);
    assert_eq!(body.head["arrays"].as_object().unwrap().len(), 2);

    let files = client.get("/api/out").json();
    let names: Vec<&str> =
        files["files"].as_array().unwrap().iter().map(|f| f["path"].as_str().unwrap()).collect();
    assert!(names.contains(&"metrics.json") && names.iter().any(|n| n.ends_with(".obj")), "{names:?}");
    let measures = client.get("/api/measures").json();
    assert_eq!(measures["stage"], "Mannequin");
    let bust = measures["measures"].as_array().unwrap().iter().find(|m| m["name"] == "bust").unwrap();
    assert_eq!(bust["value_m"], 0.88);
    assert_eq!((&bust["path"], &bust["iso"]), (&json!("body.bust"), &json!("bust girth")));
    assert!(measures["sizes"].as_array().unwrap().contains(&json!("EU 38")));

    let raise = json!({ "edit": 1, "words": "raise the bust", "changes": [{ "set": { "path": "body.bust", "value": "\"94 cm\"" } }] });
    assert_eq!(client.post("/api/edit", &raise).status, 200);
    let draft = client.wait("the draft", |s| {
        s["run"]["number"].as_u64() >= Some(3) && (is_done(s, "draft") || s["run"]["kind"] == "full")
    });
    assert!(draft["view"].as_u64() > state["view"].as_u64());
    let state = client.wait("the vest again", |s| is_done(s, "full") && s["run"]["number"] == 4);
    let moved = state["run"]["changed"]["mm"].as_f64().unwrap();
    assert!((1.0..300.0).contains(&moved), "{moved} mm");
    let before = Mesh::of(client.get("/api/before").body);
    assert_eq!(before.floats("positions"), mesh.floats("positions"));
    assert_ne!(Mesh::of(client.get("/api/garment").body).floats("positions"), mesh.floats("positions"));

    let trade = client.get("/api/trade").json();
    let draft = json!({ "name": "Draft", "max_error": "20 mm", "measured": null, "seconds": null, "stands": false, "chosen": false });
    assert_eq!(trade, json!({ "qualities": [draft] }));
    let unknown = client.post("/api/run", &json!({ "quality": "Best", "full": true })).refusal();
    assert_eq!(unknown, (422, "faults".to_owned(), "the pipeline has no quality `Best`".to_owned()));
    assert_eq!(client.post("/api/run", &json!({ "quality": "Draft", "full": true })).status, 200);
    client.wait("the run that was asked for", |s| is_done(s, "full") && s["run"]["number"] == 5);
    assert_eq!(client.get("/api/trade").json()["qualities"][0]["chosen"], true);
}

#[test]
fn a_stopped_run_leaves_what_it_made_and_a_new_edit_stops_the_old_run() {
    let dir = folder(&COARSE.replace("40 mm", "9 mm").replace("50 mm", "8 mm"));
    let served = Served::new(dir.path(), true);
    let client = &served.client;
    client.wait("a garment", |_| client.get("/api/view").json()["garment"] == true);
    assert_eq!(client.post("/api/stop", &json!({})).status, 200);
    let state = client.wait("the stop", |s| s["run"]["state"] == "stopped");
    assert_eq!(
        (&state["run"]["error"], client.get("/api/view").json()["garment"].clone()),
        (&Value::Null, json!(true))
    );
    let coarser = json!({ "edit": 1, "words": "coarser", "changes": [
        { "set": { "path": "stages.GridMesher.edge", "value": "\"40 mm\"" } }, { "remove": "qualities" } ] });
    client.post("/api/run", &json!({ "full": true }));
    client.wait("a run", |s| s["run"]["state"] == "running");
    assert_eq!(client.post("/api/edit", &coarser).status, 200);
    client.wait("the coarse vest", |s| is_done(s, "full"));
}

#[test]
fn a_run_that_fails_says_where() {
    let dir = folder(&MASKS.replace("Otsu(bias: 2)", "Otsu(bias: -128)"));
    let served = Served::new(dir.path(), true);
    let client = &served.client;
    let state = client.wait("the failure", |s| s["run"]["state"] == "failed");
    let error = &state["run"]["error"];
    assert_eq!(error["stage"], "Otsu", "{error:#}");
    let (start, end) = (error["start"].as_u64().unwrap() as usize, error["end"].as_u64().unwrap() as usize);
    let place = &state["text"].as_str().unwrap()[start..end];
    assert!(place.contains("Otsu") || place.contains("-128"), "{place}");
    assert_eq!(stage(&state, "Otsu")["state"], "failed");
}

#[test]
fn what_a_failed_run_did_not_make_anew_tells_the_text_that_it_comes_from() {
    let dir = folder(COARSE);
    let served = Served::new(dir.path(), true);
    let client = &served.client;
    let first = client.wait("the vest", |s| is_done(s, "full"))["project"]["edit"].clone();
    let edits = || {
        let view = client.get("/api/view").json();
        ["pattern_edit", "start_edit", "garment_edit"].map(|name| view[name].clone())
    };
    assert_eq!(edits(), [first.clone(), first.clone(), first.clone()]);
    // The pieces are cut before the stage that does not find one of them.
    let place = "[(piece: \"sleeve\", middle: (\"0 mm\", \"1200 mm\", \"400 mm\"))]";
    let set = json!({ "set": { "path": "stages.Arrange.hand_places", "value": place } });
    let edit = json!({ "edit": first, "words": "place sleeve", "changes": [set] });
    assert_eq!(client.post("/api/edit", &edit).status, 200);
    let state = client.wait("the failure", |s| s["run"]["state"] == "failed");
    assert_eq!(state["run"]["error"]["stage"], "Arrange");
    let now = state["project"]["edit"].clone();
    assert_ne!(now, first);
    assert_eq!(edits(), [now, first.clone(), first]);
}

#[test]
fn news_come_by_themselves() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), true);
    let (mut states, mut progress) = (0, 0);
    let mut edited = false;
    served.client.events(|event, data| {
        match event {
            "state" => {
                states += 1;
                assert!(data.get("text").is_none(), "without the text");
                if !edited && is_done(data, "full") {
                    edited = true;
                    let set = json!({ "edit": 1, "changes": [{ "set": { "path": "stages.Otsu.bias", "value": "4" } }] });
                    assert_eq!(served.client.post("/api/edit", &set).status, 200);
                }
                data["project"]["edit"] == 1 || !is_done(data, "full")
            }
            "progress" => {
                progress += 1;
                assert!(data["stage"].is_string() && data["share"].is_number(), "{data}");
                true
            }
            other => panic!("{other}"),
        }
    });
    assert!(states >= 3 && progress >= 1, "{states} states, {progress} notes of progress");
}

#[test]
fn a_pattern_is_printed_and_the_file_stays() {
    let dir = tempfile::tempdir().unwrap();
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    client.post("/api/begin", &json!({ "sample": "shirt_pattern" }));
    let before = client.state()["text"].clone();
    for (writer, files) in [
        ("PatternSvg()", vec!["pattern.svg", "pattern.svg.seams.ron"]),
        ("PatternHpgl()", vec!["pattern.plt"]),
        ("PatternPdf(paper: A4)", vec!["pattern.pdf"]),
    ] {
        let reply = client.post("/api/print", &json!({ "writer": writer }));
        assert_eq!(reply.json(), json!({ "files": files }), "{writer}");
        assert!(!client.get(&format!("/api/out/{}", files[0])).body.is_empty());
    }
    let reply = client.post("/api/print", &json!({ "writer": "PatternPdf(papier: A4)" }));
    assert_eq!(
        (reply.status, reply.json()["error"]["message"].clone()),
        (422, json!("unknown parameter `papier`"))
    );
    assert_eq!(client.state()["text"], before);
}

#[test]
fn a_garment_at_rest_has_its_pressure_and_its_distance_from_the_body() {
    let dir = folder(COARSE);
    let served = Served::new(dir.path(), true);
    served.client.wait("the full run", |s| is_done(s, "full"));
    let mesh = Mesh::of(served.client.get("/api/garment").body);
    let (pressure, distance) = (mesh.floats("pressure"), mesh.floats("distance"));
    let vertices = mesh.head["vertices"].as_u64().unwrap() as usize;
    assert_eq!((pressure.len(), distance.len()), (vertices, vertices));
    assert!(distance.iter().all(|d| (0.0..=0.25).contains(d)), "no cloth is in the body");
    // The straps lie on the shoulders and carry the vest; the hem is off the body.
    let most = |of: &[f32]| of.iter().copied().fold(0.0, f32::max);
    assert!((50.0..20_000.0).contains(&most(&pressure)), "{}", most(&pressure));
    assert!(most(&distance) > 0.02, "{}", most(&distance));
    for (p, d) in pressure.iter().zip(&distance) {
        assert!(*p == 0.0 || *d < 0.01, "{p} Pa at {d} m");
    }
}

#[test]
fn a_garment_is_seen_while_it_is_draped_by_those_who_listen() {
    let dir = folder(&COARSE.replace("edge: \"40 mm\"", "edge: \"12 mm\""));
    let served = Served::new(dir.path(), false);
    assert_eq!(Mesh::of(served.client.get("/api/moving").body).head["vertices"], 0);
    let client = served.client.clone();
    served.client.post("/api/run", &json!({ "full": true }));
    let mut seen = Vec::new();
    served.client.events(|event, data| {
        if event == "state" && data["moving"].is_number() {
            let mesh = Mesh::of(client.get("/api/moving").body);
            let (count, positions) = (&mesh.head["vertices"], mesh.floats("positions"));
            assert_eq!(positions.len() as u64, 3 * count.as_u64().unwrap());
            // The garment may be at rest by now.
            seen.extend((!positions.is_empty()).then_some(positions));
        }
        event != "state" || !is_done(data, "full")
    });
    assert!(!seen.is_empty(), "the garment is shown while it moves");
    assert_eq!(served.client.state()["moving"], Value::Null);
}
