//! What every mannequin must be.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::body::topology::Topology;
use toile_core::prelude::*;

pub(crate) fn mannequin(ron: &str) -> Result<Body, StageError> {
    let stage: Mannequin = toile_core::param::ron_options().from_str(ron).unwrap();
    stage.run(&Context::quiet())
}

#[test]
fn the_default_is_one_closed_piece() {
    let body = mannequin("()").unwrap();
    let topology = Topology::of(body.positions.len(), &body.triangles);
    assert!(topology.is_closed(), "{topology:?}");
    assert_eq!((topology.components, topology.euler()), (1, 2));
    let litres = body.volume() * 1e3;
    assert!((50.0..80.0).contains(&litres), "{litres} l");
    assert!((8_000..24_000).contains(&body.triangles.len()), "{}", body.triangles.len());
}

#[test]
fn dump() {
    if let Ok(path) = std::env::var("TOILE_DUMP") {
        let t = std::time::Instant::now();
        let body = mannequin(&std::env::var("TOILE_RON").unwrap_or("()".into())).unwrap();
        eprintln!(
            "{:?} {:#?} {:#?} vol {} tri {}",
            t.elapsed(),
            body.landmarks,
            body.measurements,
            body.volume(),
            body.triangles.len()
        );
        std::fs::write(path, &body.export()[0].1).unwrap();
    }
}

#[test]
fn bodies_of_other_programs_are_read() {
    let Ok(shared) = std::env::var("TOILE_SHARED") else {
        eprintln!("skipped: TOILE_SHARED is not set");
        return;
    };
    let names = [
        "makehuman/mh_female_young_m",
        "makehuman/mh_male_child_m",
        "makehuman/mh_female_child_m",
        "makehuman/mh_male_young_m",
        "garmentcode/mean_all",
    ];
    for name in names {
        let ron = format!("(file: \"{shared}/data/bodies/{name}.obj\")");
        let stage: BodyObj = toile_core::param::ron_options().from_str(&ron).unwrap();
        match stage.run(&Context::quiet()) {
            Ok(body) => eprintln!(
                "{name} {:#.3?} {:#.3?} {}",
                body.landmarks
                    .iter()
                    .map(|(n, p)| format!("{n} {:.3} {:.3} {:.3}", p.x, p.y, p.z))
                    .collect::<Vec<_>>(),
                body.measurements,
                body.volume()
            ),
            Err(e) => eprintln!("{name} {e:?}"),
        }
    }
}
