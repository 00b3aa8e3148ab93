//! Real artifacts of every kind, from a small run of the vest.

use proptest::test_runner::{RngAlgorithm, TestRng};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::{Artifact, Kind, Phase, Phases, Vector3};
use toile_core::testkit::dress;
use toile_core::{Cancel, Listener};
use toile_pipeline::{Override, Pipeline, RunOptions, add_implicit, load, run};

/// Height of the photos, px: small, so that many runs are cheap.
const PHOTO_HEIGHT: u32 = 240;

/// An artifact with its entry's name.
type Named = (String, Arc<dyn Artifact>);

/// Artifacts by kind.
pub(crate) struct Pool(BTreeMap<Kind, Vec<Named>>);

impl Pool {
    pub(crate) fn new() -> Self {
        let dir = tempfile::tempdir().unwrap();
        let pipeline = small_vest(dir.path());
        let listener: Arc<dyn Listener> = Arc::new(());
        let result = run(&pipeline, &RunOptions::default(), &Cancel::new(), &listener).unwrap();
        let mut pool: BTreeMap<Kind, BTreeMap<String, Arc<dyn Artifact>>> = BTreeMap::new();
        let made = result.log.stages.iter().flat_map(|r| &r.outputs);
        for value in made {
            for (name, artifact) in value.entries() {
                pool.entry(value.kind()).or_default().insert(name.to_owned(), artifact.clone());
            }
        }
        let pattern: Arc<dyn Artifact> = Arc::new(dress::pattern());
        pool.entry(pattern.kind()).or_default().insert(String::new(), pattern);
        let phases: Arc<dyn Artifact> = Arc::new(phases());
        pool.entry(phases.kind()).or_default().insert(String::new(), phases);
        let log: Arc<dyn Artifact> = Arc::new(result.log);
        pool.entry(log.kind()).or_default().insert(String::new(), log);
        Pool(pool.into_iter().map(|(kind, set)| (kind, set.into_iter().collect())).collect())
    }

    /// The artifacts of a kind, the last made of each name.
    pub(crate) fn of(&self, kind: Kind) -> &[Named] {
        self.0.get(&kind).map_or(&[], Vec::as_slice)
    }
}

/// What acts in a prepared scene, which the vest is not.
fn phases() -> Phases {
    let phase = |name: &str, g: f64| Phase {
        name: name.into(),
        seconds: 0.02,
        gravity: Vector3::new(0.0, -g, 0.0),
        air: None,
    };
    Phases(vec![phase("sew", 0.0), phase("drape", 9.81)])
}

fn small_vest(dir: &Path) -> Pipeline {
    let mut sets = vec!["stages.GridMesher.edge=\"60 mm\"".to_owned()];
    for side in ["front", "back"] {
        let file = toile_tests::root().join(format!("pipelines/samples/vest/{side}.jpg"));
        let photo = image::open(file).unwrap();
        let path = dir.join(format!("{side}.png"));
        photo.thumbnail(PHOTO_HEIGHT, PHOTO_HEIGHT).to_rgb8().save(&path).unwrap();
        sets.push(format!("photos.{side}.file={:?}", path.display().to_string()));
    }
    let overrides: Vec<Override> = sets.iter().map(|s| s.parse().unwrap()).collect();
    let (file, registry) = (toile_tests::pipeline("vest.ron"), toile::registry());
    let text = std::fs::read_to_string(&file).unwrap();
    let mut pipeline =
        load(&text, &file, &toile_tests::root().join("pipelines"), &registry, &overrides).unwrap();
    add_implicit(&mut pipeline, &registry);
    pipeline
}

/// The same random numbers in every run, others for every stage.
pub(crate) fn rng(name: &str) -> TestRng {
    let mut seed = [7; 32];
    seed.iter_mut().zip(name.bytes()).for_each(|(s, b)| *s = b);
    TestRng::from_seed(RngAlgorithm::ChaCha, &seed)
}
