//! Words of qualities; whole measurements are in the tests of the command line.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::errors::{Errors, Millimetres};
use crate::record::Measured;

#[test]
fn a_quality_is_a_name_and_a_length() {
    let asked: AskedQuality = " Very-fine 2 = 1.5 mm".parse().unwrap();
    assert_eq!((asked.name.as_str(), asked.wish().max_error_mm), ("Very-fine 2", Some(1.5)));
    let refused = |text: &str| text.parse::<AskedQuality>().unwrap_err();
    let form = |text: &str| format!("`{text}` is no quality; write NAME=LENGTH, like `Draft=10 mm`");
    for text in ["Draft", "=3 mm", "a.b=3 mm", ""] {
        assert_eq!(refused(text), form(text));
    }
    assert_eq!(refused("Draft=0 mm"), "`0 mm` is not above zero");
    assert_eq!(
        refused("Draft=10"),
        "\"10\" is not a length; write a number and a unit, like \"12 mm\" (mm, cm, m, in)"
    );
}

#[test]
fn what_is_kept_is_the_worst_of_the_fresh_run_and_the_starts() {
    let far = |p95: f64| Millimetres { p95, ..Millimetres::default() };
    let fresh = Measured {
        wall_s: vec![9.0],
        cpu_s: vec![3.856],
        peak_memory_bytes: None,
        stages_s: Default::default(),
        triangles: 1000,
        errors: Errors { distance_mm: far(3.1), ..Errors::default() },
        ease_mm: Default::default(),
        shortfalls: Vec::new(),
        sound: true,
        repeatable: true,
    };
    let machine = Machine { system: "linux x86_64".into(), cores: 2, threads: 2, load: None };
    let mut proof = SettingProof { point: 0, fresh, starts: vec![far(2.0), far(3.917)], failed: Vec::new() };
    assert_eq!(
        words(&proof, Some(1.204), "0.1.0", &machine, "2026-11-22"),
        "2026-11-22: 95 % of the surface within 3.92 mm of the reference (itself known to 1.20 mm), the worst of a fresh run and 2 moved \
         starts; 3.86 s of processor time (toile 0.1.0, linux x86_64, 2 cores)"
    );
    proof.starts.clear();
    assert!(
        words(&proof, None, "0.1.0", &machine, "2026-11-22")
            .contains("within 3.10 mm of the reference, a fresh run; ")
    );
}
