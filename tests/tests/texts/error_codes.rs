//! The error codes that scripts match, each with its exact words where a pipeline meets it.

use serde_json::Value;
use std::sync::Arc;
use toile_core::artifact::{Artifact, Body, Collider, Figures, Garment, Outline, Point3};
use toile_core::{Context, ErrorCode, Inputs, PortValue, StageError, testkit};
use toile_tests::{pipeline, toile};

/// Runs a stage by its example on single values.
fn run(
    name: &str,
    arguments: &str,
    inputs: Vec<Option<Arc<dyn Artifact>>>,
) -> Result<Vec<PortValue>, StageError> {
    let registry = toile::registry();
    let stage = registry.make(registry.card(name).unwrap(), arguments).unwrap();
    let ports = inputs.into_iter().map(|a| a.map(PortValue::One)).collect();
    stage.run_ports(&Inputs(ports), &Context::quiet())
}

/// The limits that a garment misses: code and words.
fn shortfalls(garment: Garment, collider: Option<Collider>) -> Vec<(ErrorCode, String)> {
    judged("()", garment, collider, None)
}

/// The same with a body and other limits.
fn judged(
    limits: &str,
    garment: Garment,
    collider: Option<Collider>,
    body: Option<Body>,
) -> Vec<(ErrorCode, String)> {
    let collider = collider.map(|c| Arc::new(c) as Arc<dyn Artifact>);
    let body = body.map(|b| Arc::new(b) as Arc<dyn Artifact>);
    let made = run("Measure", limits, vec![Some(Arc::new(garment)), collider, body]).unwrap();
    let any: Arc<dyn std::any::Any + Send + Sync> = made[0].entries()[0].1.clone();
    let figures = any.downcast::<Figures>().unwrap();
    figures.shortfalls.iter().map(|s| (s.code, s.message.clone())).collect()
}

/// A garment as it hangs when all is well.
fn good() -> Garment {
    let mut garment = testkit::dress::sewn_garment();
    garment.status.steps = 10;
    garment.status.converged = true;
    garment
}

#[test]
fn a_good_garment_misses_nothing() {
    assert_eq!(shortfalls(good(), None), []);
}

#[test]
fn static_equilibrium() {
    let mut garment = good();
    garment.status.converged = false;
    let words =
        "the cloth was still moving when the solver stopped; give it more steps, or make the mesh coarser"
            .to_owned();
    assert_eq!(shortfalls(garment, None), [(ErrorCode::StaticEquilibrium, words)]);
}

#[test]
fn fast_finish() {
    let mut garment = good();
    garment.status.steps = 0;
    let words = "the garment was not draped: the solver found it at rest before its first step; see that the cloth has weight and starts \
                 off the body"
        .to_owned();
    assert_eq!(shortfalls(garment, None), [(ErrorCode::FastFinish, words)]);
}

#[test]
fn stitching_error() {
    let mut garment = good();
    let [a, _] = garment.seams[0].pairs[0];
    garment.positions[a as usize].y += 3e-3;
    let found = shortfalls(garment, None);
    let words = "the seam \"front.side_left\" stands open by 3 mm (at most 1 mm is good); see that both sides are equally \
                 long, run the same way and start near each other";
    assert_eq!(found[0], (ErrorCode::StitchingError, words.to_owned()));
}

/// A collider on the suite's body.
fn collider() -> Collider {
    let made = run("BvhCollider", "()", vec![Some(Arc::new(testkit::dress::body()))]).unwrap();
    let any: Arc<dyn std::any::Any + Send + Sync> = made[0].entries()[0].1.clone();
    any.downcast::<Collider>().unwrap().as_ref().clone()
}

#[test]
fn body_intersection() {
    let mut garment = good();
    let middle = testkit::dress::body();
    let centre =
        middle.positions.iter().fold(Point3::origin(), |c, p| c + p.coords / middle.positions.len() as f64);
    garment.positions.iter_mut().for_each(|p| *p = centre + (*p - centre) * 1e-3);
    let found = shortfalls(garment, Some(collider()));
    let body = found.iter().find(|(code, _)| *code == ErrorCode::BodyIntersection).unwrap();
    assert!(body.1.starts_with("the cloth lies in the body at "), "{}", body.1);
}

/// A needle of a triangular section that stands in a triangle of the garment, no longer than its
/// side.
fn needle_through(garment: &Garment, triangle: usize) -> Body {
    let [a, b, c] = garment.triangles[triangle].map(|i| garment.positions[i as usize]);
    let middle = Point3::from((a.coords + b.coords + c.coords) / 3.0);
    let normal = (b - a).cross(&(c - a)).normalize() * (b - a).norm();
    let base = [a, b, c].map(|p| middle + (p - middle) * 0.1 - normal);
    Body {
        positions: vec![base[0], base[1], base[2], middle + normal],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        landmarks: Default::default(),
        measurements: Default::default(),
    }
}

#[test]
fn body_intersection_between_the_vertices() {
    let garment = good();
    let needle = needle_through(&garment, 0);
    let words = "the body comes through the cloth at 3 places (at most 0 is good); make the mesh finer, or take a body that fits better".to_owned();
    let found = judged("()", garment.clone(), None, Some(needle.clone()));
    assert_eq!(found, [(ErrorCode::BodyIntersection, words)]);
    assert_eq!(judged("(max_body_crossings: 3)", garment, None, Some(needle)), []);
}

#[test]
fn self_intersection() {
    let mut garment = good();
    // A vertex of the front goes out through the back.
    let front = garment.panels[0].vertices.clone();
    let inner = front.clone().find(|i| !garment.panels[0].boundary.contains(&(*i as u32))).unwrap();
    garment.positions[inner].z -= 2.0;
    let found = shortfalls(garment, Some(collider()));
    let own = found.iter().find(|(code, _)| *code == ErrorCode::SelfIntersection).unwrap();
    let (before, words) = own.1.split_once(" places").unwrap();
    assert!(before.strip_prefix("cloth goes through cloth at ").unwrap().parse::<usize>().unwrap() > 0);
    assert_eq!(words, "; make the mesh finer, or place the pieces farther apart");
}

#[test]
fn degenerate_triangles() {
    let mut outline: Outline = testkit::outline();
    outline.outer.points.swap(2, 40);
    let e = run("GridMesher", "()", vec![Some(Arc::new(outline))]).unwrap_err();
    assert_eq!(
        (e.code, e.message.as_str()),
        (ErrorCode::DegenerateTriangles, "the outline crosses or touches itself near (250.0, 0.0) mm")
    );
}

/// What `toile run --json` says of a vest with one change.
fn vest(change: &str) -> (u8, Value) {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out").display().to_string();
    let answer = toile(&["run", &pipeline("vest.ron"), "--json", "--out", &out, "--set", change]);
    assert!(toile_tests::wrote_no_result(&dir.path().join("out")), "no result is written");
    (answer.code, serde_json::from_str(&answer.out).unwrap())
}

#[test]
fn pattern_loading() {
    let (code, said) = vest("photos.front.file=\"gone.jpg\"");
    assert_eq!(
        (code, &said["faults"][0]["code"], &said["faults"][0]["message"]),
        (3, &"pattern_loading".into(), &"Photos: cannot read \"gone.jpg\": no such file".into())
    );
}

#[test]
fn timeout() {
    let (code, said) = vest("stages.StaticEquilibrium.time_limit=0.001");
    assert_eq!((code, &said["error"]), (5, &"timeout".into()));
    // The seconds are those of the machine.
    let message = said["message"].as_str().unwrap();
    assert!(
        message.starts_with("out of time after 0.") && message.ends_with(" s, on mesh 1 of 3"),
        "{message}"
    );
}
