//! What GarmentCode's own program (pygarment 2.0) asks of a file: what it takes by name without
//! looking whether it is there, and what it refuses. `tests/pygarment/check.py` asks the program
//! itself.

use crate::common::*;
use serde_json::Value;
use std::collections::BTreeSet;
use toile_pattern_files::garment_code::to_json;

fn numbers(value: &Value, count: usize) -> Vec<f64> {
    let all: Vec<f64> = value.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
    assert_eq!(all.len(), count, "{value}");
    all
}

/// Panics where pygarment would end with an error.
fn reads(file: &Value) {
    assert!(file["parameters"].is_object() && file["parameter_order"].as_array().unwrap().is_empty());
    let properties = &file["properties"];
    assert_eq!(properties["curvature_coords"], "relative");
    assert_eq!(properties["units_in_meter"].as_f64(), Some(100.0));
    // Else it turns panels, and with them only curves of an older form.
    assert_eq!(properties["normalized_edge_loops"], true);
    assert_eq!(properties["normalize_panel_translation"], false);
    let panels = file["pattern"]["panels"].as_object().unwrap();
    let order: BTreeSet<&str> =
        file["pattern"]["panel_order"].as_array().unwrap().iter().map(|n| n.as_str().unwrap()).collect();
    assert_eq!(order, panels.keys().map(String::as_str).collect());
    for panel in panels.values() {
        numbers(&panel["translation"], 3);
        numbers(&panel["rotation"], 3);
        let vertices = panel["vertices"].as_array().unwrap();
        vertices.iter().for_each(|v| drop(numbers(v, 2)));
        for edge in panel["edges"].as_array().unwrap() {
            assert!(numbers(&edge["endpoints"], 2).iter().all(|v| (*v as usize) < vertices.len()));
            let Some(curvature) = edge.get("curvature") else { continue };
            let params = &curvature["params"];
            match curvature["type"].as_str().unwrap() {
                "quadratic" => drop(numbers(&params[0], 2)),
                "cubic" => params.as_array().unwrap().iter().for_each(|c| drop(numbers(c, 2))),
                "circle" => drop(numbers(params, 3)),
                other => panic!("{other}"),
            }
        }
    }
    let mut sewn = BTreeSet::new();
    for stitch in file["pattern"]["stitches"].as_array().unwrap() {
        let edge = |side: &Value| {
            let (panel, edge) = (side["panel"].as_str().unwrap(), side["edge"].as_u64().unwrap());
            assert!(sewn.insert((panel.to_owned(), edge)), "stitched twice: {side}");
            panels[panel]["edges"][edge as usize]["label"].as_str()
        };
        let labels: Vec<&str> = stitch.as_array().unwrap()[..2]
            .iter()
            .map(edge)
            .collect::<Vec<_>>()
            .into_iter()
            .flatten()
            .collect();
        assert!(labels.windows(2).all(|w| w[0] == w[1]), "labels of one stitch: {labels:?}");
        assert!(stitch.get(2).is_none_or(|word| word == "right_wrong"));
    }
}

#[test]
fn what_is_written_has_all_that_garment_code_asks_for() {
    let file: Value = serde_json::from_slice(&to_json(&blouse()).unwrap().bytes).unwrap();
    reads(&file);
    // An edge that is stitched to one of another name keeps its own, where no label may stand.
    let edges = file["pattern"]["panels"]["front"]["edges"].as_array().unwrap();
    let right = edges.iter().find(|e| e["name"] == "right").unwrap();
    assert_eq!(right.get("label"), None);
    assert!(edges.iter().any(|e| e["label"] == "hem_left" || e["name"] == "hem_left"));
}
