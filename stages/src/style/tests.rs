#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use std::path::Path;
use toile_core::prelude::*;

fn truth(garment: &str, side: &str) -> (Outline, Vec<(String, f64)>) {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/samples").join(garment);
    let text = std::fs::read_to_string(base.join(format!("{side}.outline.json"))).unwrap();
    let truth: serde_json::Value = serde_json::from_str(&text).unwrap();
    let point =
        |v: &serde_json::Value| Point2::new(v[0].as_f64().unwrap() / 1e3, v[1].as_f64().unwrap() / 1e3);
    let points = truth["outline"].as_array().unwrap().iter().map(point).collect();
    let edges = truth["edges"].as_array().unwrap();
    let corners = edges.iter().map(|e| e["start"].as_u64().unwrap() as usize).collect();
    let lengths = edges
        .iter()
        .map(|e| (e["name"].as_str().unwrap().to_owned(), e["length_mm"].as_f64().unwrap()))
        .collect();
    let outer = Loop { points, corners };
    (Outline { outer, holes: vec![], edges: vec![], inner: vec![], frame: None }, lengths)
}

fn set(garment: &str) -> Set<Outline> {
    ["front", "back"].iter().map(|s| ((*s).to_owned(), truth(garment, s).0)).collect()
}

fn lengths(outline: &Outline) -> Vec<(String, f64)> {
    outline.edges.iter().map(|e| (e.name.clone(), 1e3 * polyline_length(&outline.edge_points(e)))).collect()
}

#[test]
fn samples_get_their_names() {
    for garment in ["vest", "tshirt"] {
        let cx = Context::quiet();
        let (named, plan) = match garment {
            "vest" => Vest {}.run(set(garment), &cx),
            _ => TShirt {}.run(set(garment), &cx),
        }
        .unwrap();
        for side in ["front", "back"] {
            let want = truth(garment, side).1;
            let found = lengths(named.get(side).unwrap());
            for ((name, want), (found_name, found)) in want.iter().zip(&found) {
                assert_eq!(name, found_name);
                assert!((want - found).abs() < 0.1, "{garment} {side} {name}: {found} for {want} mm");
            }
        }
        assert_eq!(plan.seams.len(), if garment == "vest" { 4 } else { 6 });
    }
}
