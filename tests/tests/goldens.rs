//! Every shipped pipeline agrees with its golden, and every golden can fail.
#![allow(clippy::unwrap_used)]

use toile_core::golden::{compare, parse};
use toile_tests::{pipeline, root, toile};

#[test]
fn the_shipped_pipelines_agree_with_their_goldens() {
    for name in toile_tests::PIPELINES {
        let out = root().join("out/goldens").display().to_string();
        let answer = toile(&["golden", "check", &pipeline(name), "--out", &out]);
        assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
        assert!(!answer.out.contains("skipped"), "{}", answer.out);
    }
}

#[test]
fn every_measure_of_every_golden_can_fail() {
    for name in toile_tests::PIPELINES {
        let sheet = root().join("pipelines/goldens").join(name.replace(".ron", ".txt"));
        let golden = parse(&std::fs::read_to_string(sheet).unwrap()).unwrap();
        assert!(golden.0.len() > 5, "{name}");
        for s in 0..golden.0.len() {
            for m in 0..golden.0[s].measures.len() {
                let mut now = golden.clone();
                let measure = &mut now.0[s].measures[m];
                measure.value += 1.01 * measure.tolerance + 1e-5;
                assert_eq!(compare(&golden, &now).first_stage(), Some(golden.0[s].stage.as_str()));
            }
        }
    }
}
