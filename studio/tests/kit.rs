//! Studios for tests.

use crate::client::Client;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use tempfile::TempDir;
use toile_core::Registry;
use toile_studio::{StudioOptions, StudioServer};

/// A pipeline that ends with the masks, with comments.
pub(crate) const MASKS: &str = r#"// Two photos.
(
    name: "masks",
    photos: {
        "front": (file: "front.jpg", width: "52 cm"),
        "back":  (file: "back.jpg",  width: "52 cm"),  // its back
    },
    stages: [
        NeighbourhoodMean(),    // takes the grain off
        Otsu(bias: 2),
    ],
)
"#;

/// A vest on a coarse mesh: the whole way in seconds.
pub(crate) const COARSE: &str = r#"(
    name: "coarse",
    photos: {
        "front": (file: "front.jpg", width: "52 cm"),
        "back":  (file: "back.jpg",  width: "52 cm"),
    },
    style: Outline(style: Vest),
    body: Mannequin(height: "172 cm", bust: "88 cm", waist: "70 cm", hip: "96 cm"),
    fabric: Preset(name: "cotton poplin"),
    stages: [
        NeighbourhoodMean(), Otsu(), Canny(smooth: 1),
        GridMesher(edge: "40 mm"), // the mesh
        PlaneSmoother(), Arrange(), BvhCollider(), StaticEquilibrium(),
        PhotoTexturer(),
        Obj(),
    ],
    qualities: [Quality(name: "Draft", max_error: "20 mm", set: ["stages.GridMesher.edge=\"50 mm\""])],
)
"#;

pub(crate) fn registry() -> Arc<Registry> {
    let mut registry = Registry::new();
    toile_stages::register(&mut registry);
    Arc::new(registry)
}

fn sample(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/samples/vest").join(file)
}

/// A folder with a pipeline and the photos of the sample vest.
pub(crate) fn folder(pipeline: &str) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    for photo in ["front.jpg", "back.jpg"] {
        std::fs::copy(sample(photo), dir.path().join(photo)).unwrap();
    }
    std::fs::write(dir.path().join("pipeline.ron"), pipeline).unwrap();
    dir
}

pub(crate) fn options(target: &Path, runs: bool) -> StudioOptions {
    let cards = "{\"stages\": []}".to_owned();
    StudioOptions { target: target.to_owned(), registry: registry(), cards, cache: None, threads: None, runs }
}

/// A server that answers until it is dropped.
#[derive(Debug)]
pub(crate) struct Served {
    pub(crate) client: Client,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Served {
    pub(crate) fn new(target: &Path, runs: bool) -> Self {
        let server = StudioServer::open(options(target, runs), None).unwrap();
        let client = Client::of(&server.address());
        let stop = Arc::new(AtomicBool::new(false));
        let flag = stop.clone();
        let thread = std::thread::spawn(move || server.serve(|| flag.load(Ordering::SeqCst)).unwrap());
        Served { client, stop, thread: Some(thread) }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }
}

/// The state of a stage of that id.
pub(crate) fn stage<'a>(state: &'a Value, id: &str) -> &'a Value {
    let stages = state["stages"].as_array().unwrap();
    stages.iter().find(|s| s["id"] == id).unwrap_or_else(|| panic!("{id}: {state:#}"))
}
