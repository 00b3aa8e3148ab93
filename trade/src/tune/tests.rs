//! Picks and refusals of made-up fronts.
#![allow(clippy::unwrap_used)]

use super::written::commented;
use super::*;
use crate::errors::{Errors, Millimetres};
use crate::record::*;
use std::collections::BTreeMap;

fn point(name: &str, seconds: f64, p95: f64, sound: bool) -> Point {
    let distance_mm = Millimetres { mean: p95 / 3.0, p95, max: p95 * 4.0 };
    let measured = Measured {
        wall_s: vec![seconds],
        cpu_s: vec![seconds * 2.0],
        peak_memory_bytes: None,
        stages_s: BTreeMap::new(),
        triangles: 1000,
        errors: Errors { distance_mm, ..Errors::default() },
        ease_mm: BTreeMap::new(),
        shortfalls: Vec::new(),
        sound,
        repeatable: true,
    };
    let setting = BTreeMap::from([("mesher.edge".to_owned(), format!("\"{name}\""))]);
    Point {
        key: name.into(),
        setting,
        overrides: Vec::new(),
        outcome: SettingOutcome::Measured(Box::new(measured)),
    }
}

fn trade(floor: Option<f64>) -> Trade {
    let points = vec![
        point("16 mm", 4.0, 1.5, true),
        point("30 mm", 1.0, 6.0, true),
        point("40 mm", 0.5, 1.0, false),
        point("8 mm", 20.0, 0.5, true),
    ];
    let order = floor.map(|missing_mm| Order { order: Some(1.0), missing_mm });
    let reference = Reference { p95: order, ..Reference::default() };
    Trade {
        scheme: SCHEME,
        toile: "0.1.0".into(),
        pipeline: "vest".into(),
        file: "vest.ron".into(),
        date: "2026-11-22".into(),
        machine: Machine::here(),
        clock: Clock::Wall,
        until: None,
        apart: true,
        reads: BTreeMap::new(),
        knobs: Vec::new(),
        reference,
        front: front_of(&points, Clock::Wall),
        points,
    }
}

fn wish(max_error_mm: Option<f64>, max_time_s: Option<f64>) -> Wish {
    Wish { max_error_mm, max_time_s }
}

#[test]
fn a_measurement_of_another_state_is_refused() {
    let registry = {
        let mut registry = toile_core::Registry::new();
        toile_stages::register(&mut registry);
        registry
    };
    let text = "(scene: Scene(file: \"a.json\"), stages: [StaticEquilibrium(), GarmentObj()])";
    let pipeline = toile_pipeline::load(text, "a.ron", std::path::Path::new("."), &registry, &[]).unwrap();
    let refused = |trade: &Trade| check(trade, &pipeline).unwrap_err().message;
    let mut now = trade(None);
    (now.file, now.toile) = ("a.ron".into(), env!("CARGO_PKG_VERSION").into());
    assert_eq!(refused(&now), "the measurement is of another state of \"a.ron\"");
    now.points[0].key = digest(&pipeline, &[]);
    assert_eq!(check(&now, &pipeline), Ok(()));
    let dir = tempfile::tempdir().unwrap();
    let read = dir.path().join("a.json").display().to_string();
    now.reads = BTreeMap::from([(read.clone(), Some("digest".into()))]);
    assert_eq!(refused(&now), format!("\"{read}\" has changed since it was measured"));
    let old = Trade { toile: "0.0.1".into(), ..now.clone() };
    assert_eq!(refused(&old), "the measurement is of another state of \"a.ron\"");
    now.points.clear();
    assert_eq!(refused(&now), "the measurement of \"a.ron\" holds no setting");
}

#[test]
fn for_an_error_the_quickest_for_a_time_the_most_accurate() {
    let trade = trade(None);
    assert_eq!(trade.front, [1, 0, 3], "what misses a quality limit is not on the front");
    assert_eq!(picks(&trade, &wish(Some(2.0), None)), [0, 3]);
    assert_eq!(picks(&trade, &wish(None, Some(5.0))), [0, 1]);
    assert_eq!(picks(&trade, &wish(Some(2.0), Some(5.0))), [0]);
    assert_eq!(picks(&trade, &wish(Some(0.1), Some(5.0))), [0; 0]);
}

#[test]
fn what_something_quicker_and_nearer_beats_is_tried_after_it() {
    let mut trade = trade(None);
    trade.points.push(point("15 mm", 5.0, 1.8, true));
    trade.points.push(point("14 mm", 5.0, 1.7, true));
    trade.front = front_of(&trade.points, Clock::Wall);
    assert_eq!(trade.front, [1, 0, 3]);
    assert_eq!(picks(&trade, &wish(Some(2.0), None)), [0, 5, 4, 3]);
    assert_eq!(picks(&trade, &wish(None, Some(6.0))), [0, 1]);
}

#[test]
fn refusals_word_for_word() {
    let refused = |floor, error, time| refusal(&trade(floor), &wish(error, time));
    let e = refused(None, Some(0.1), Some(5.0)).unwrap();
    assert_eq!(
        e.message,
        "no setting of the measured front keeps an error of at most 0.1 mm and a time of at most 5 s"
    );
    assert_eq!(
        e.hint.unwrap(),
        "the most accurate keeps 0.50 mm in 20.00 s, the quickest takes 1.00 s at 6.00 mm"
    );
    assert_eq!(refused(None, Some(2.0), None), None);
}

#[test]
fn an_error_below_what_the_reference_is_known_to_is_refused_though_settings_keep_it() {
    let refused = |error, time| refusal(&trade(Some(1.701)), &wish(error, time));
    assert_eq!(picks(&trade(Some(1.701)), &wish(Some(1.6), None)), [0, 3]);
    let e = refused(Some(1.6), None).unwrap();
    assert_eq!(
        e.message,
        "an error of at most 1.6 mm cannot be proved: the reference is known to 1.70 mm only: so much is missing from \
         its finest level to the limit of its order"
    );
    assert_eq!(
        e.hint.unwrap(),
        "ask for 1.71 mm or more; measure into another --out with a longer --budget, so that it is refined further"
    );
    assert_eq!(refused(Some(1.71), None), None);
    assert_eq!(refused(None, Some(5.0)), None, "a time alone is judged by the clock");
}

#[test]
fn a_proof_needs_every_start() {
    let near = Millimetres { mean: 0.3, p95: 1.0, max: 3.0 };
    let far = Millimetres { p95: 2.5, ..near };
    let fresh = trade(None).points[0].measured().unwrap().clone();
    let proof = |starts: Vec<Millimetres>| SettingProof {
        point: 0,
        fresh: fresh.clone(),
        starts,
        failed: Vec::new(),
    };
    let two = wish(Some(2.0), None);
    assert!(proof(vec![near; 10]).is_good(&two, Clock::Wall));
    assert!(!proof(vec![near, far]).is_good(&two, Clock::Wall));
    assert!(!proof(Vec::new()).is_good(&wish(Some(2.0), Some(3.0)), Clock::Wall));
    assert!(proof(Vec::new()).is_good(&wish(None, Some(8.0)), Clock::Cpu));
    let failed = SettingProof { failed: vec!["it fell".into()], ..proof(vec![near]) };
    assert!(!failed.is_good(&two, Clock::Wall));
}

#[test]
fn comments_of_an_earlier_tuning_are_replaced_and_all_others_kept() {
    let text = "// My vest.\n(\n    name: \"vest\",  // mine\n)\n";
    let once = commented(text, &["one.".into(), "two.".into()]);
    assert_eq!(once, format!("// toile tune: one.\n// toile tune: two.\n{text}"));
    assert_eq!(commented(&once, &["three.".into()]), format!("// toile tune: three.\n{text}"));
}
