//! The shipped shirt around the mannequin that it is drafted for.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::Arrange;
use crate::mesh::GridMesher;
use crate::pattern::GarmentCode;
use toile_core::prelude::*;

fn mannequin() -> Body {
    let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
    toile_fixtures::mannequin(lengths).unwrap()
}

/// What `Arrange` reads.
struct Made {
    pattern: Pattern,
    panels: Set<Panel>,
    plan: SewingPlan,
}

fn made(sample: &str) -> Made {
    let file =
        format!("{}/../../pipelines/samples/pattern/{sample}_specification.json", env!("CARGO_MANIFEST_DIR"));
    let (pattern, outlines, plan) = GarmentCode { file }.run(&Context::quiet()).unwrap();
    let mesher: GridMesher = toile_core::param::ron_options().from_str("(edge: \"20 mm\")").unwrap();
    let panel =
        |(name, o): (&str, &Outline)| (name.to_owned(), mesher.run(o, &Context::quiet()).unwrap().into());
    Made { panels: Set(outlines.iter().map(panel).collect()), pattern, plan }
}

fn arranged(made: &Made, bend: bool) -> Result<Garment, StageError> {
    let stage: Arrange = toile_core::param::ron_options().from_str(&format!("(bend: {bend})")).unwrap();
    let fabric = toile_core::testkit::dress::fabric();
    stage.run(&made.pattern, made.panels.clone(), &made.plan, &mannequin(), &fabric, &Context::quiet())
}

fn points<'a>(garment: &'a Garment, panel: &str) -> &'a [Point3] {
    let panel = garment.panels.iter().find(|p| p.name == panel).unwrap();
    &garment.positions[panel.vertices.clone()]
}

/// The mean gap of the seams between two panels.
fn gap(garment: &Garment, one: &str, other: &str) -> f64 {
    let own = |name: &str, v: u32| {
        garment.panels.iter().any(|p| p.name == name && p.vertices.contains(&(v as usize)))
    };
    let between = |[a, b]: &&[u32; 2]| own(one, *a) && own(other, *b) || own(one, *b) && own(other, *a);
    let pairs: Vec<&[u32; 2]> = garment.seams.iter().flat_map(|s| &s.pairs).filter(between).collect();
    let gap = |p: &&[u32; 2]| (garment.positions[p[0] as usize] - garment.positions[p[1] as usize]).norm();
    pairs.iter().map(gap).sum::<f64>() / pairs.len() as f64
}

/// The middle of two pieces.
fn middle(garment: &Garment, names: &[String; 2]) -> Point3 {
    let all: Vec<Point3> = names.iter().flat_map(|name| points(garment, name).to_vec()).collect();
    Point3::from(all.iter().map(|p| p.coords).sum::<Vector3>() / all.len() as f64)
}

#[test]
fn a_flounce_goes_round_the_arm_where_the_pattern_puts_it() {
    let mut shirt = made("shirt");
    // A cuff whose edge at the hand is three times as long: the seams between its halves run more
    // across the arm than along it.
    for (_, panel) in shirt.panels.0.iter_mut().filter(|(name, _)| name.contains("cuff")) {
        let panel = std::sync::Arc::make_mut(panel);
        let heights = || panel.positions.iter().map(|p| p.y);
        let (low, high) =
            (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        panel.positions.iter_mut().for_each(|p| p.x *= 1.0 + 2.0 * (high - p.y) / (high - low));
    }
    let (flat, bent) = (arranged(&shirt, false).unwrap(), arranged(&shirt, true).unwrap());
    for hand in ["left", "right"] {
        let halves = ["front", "back"].map(|half| format!("{hand}_cuff_{half}"));
        let moved = (middle(&flat, &halves) - middle(&bent, &halves)).norm();
        assert!(moved < 0.05, "the {hand} flounce moved by {moved} m");
        let (before, after) = (gap(&flat, &halves[0], &halves[1]), gap(&bent, &halves[0], &halves[1]));
        assert!(after < before, "{hand}: {before} {after}");
    }
}

#[test]
fn halves_of_a_sleeve_close_round_the_arm() {
    let shirt = made("shirt");
    let (flat, bent) = (arranged(&shirt, false).unwrap(), arranged(&shirt, true).unwrap());
    for part in ["left_sleeve", "right_sleeve", "left_cuff", "right_cuff"] {
        let [front, back] = ["front", "back"].map(|half| format!("{part}_{half}"));
        let (before, after) = (gap(&flat, &front, &back), gap(&bent, &front, &back));
        assert!(after < 0.6 * before, "{part}: {before} {after}");
    }
}

#[test]
fn bending_keeps_the_trunk_where_it_is_and_every_edge_about_as_long() {
    let shirt = made("shirt");
    let (flat, bent) = (arranged(&shirt, false).unwrap(), arranged(&shirt, true).unwrap());
    for panel in ["front", "back", "collar_front", "collar_back"] {
        assert_eq!(points(&flat, panel), points(&bent, panel), "{panel}");
    }
    // Chords of a cylinder are a little shorter than the cloth over them.
    let edges = bent.triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
    let strain = |[a, b]: [u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        let cut = (bent.rest[b] - bent.rest[a]).norm();
        ((bent.positions[b] - bent.positions[a]).norm() / cut - 1.0).abs()
    };
    let most = edges.map(strain).fold(0.0, f64::max);
    assert!(most < 0.015, "{most}");
}

#[test]
fn a_sleeve_goes_round_its_own_arm() {
    let bent = arranged(&made("shirt"), true).unwrap();
    let body = mannequin();
    for hand in Hand::BOTH {
        let wrist = body.landmark("wrist", hand).unwrap();
        let cuff: Vec<Point3> = ["front", "back"]
            .iter()
            .flat_map(|h| points(&bent, &format!("{hand}_cuff_{h}")))
            .copied()
            .collect();
        let middle = cuff.iter().map(|p| p.coords).sum::<Vector3>() / cuff.len() as f64;
        assert!((middle - wrist.coords).norm() < 0.08, "{hand}: {middle} {wrist}");
    }
}

#[test]
fn a_pattern_around_a_body_whose_origin_is_its_middle_is_raised_onto_the_floor() {
    let mut shirt = made("shirt");
    let stands = arranged(&shirt, false).unwrap();
    for piece in &mut shirt.pattern.pieces {
        piece.pose.as_mut().unwrap().origin.y -= 1.1;
    }
    let raised = arranged(&shirt, false).unwrap();
    let way = raised.positions[0].y - stands.positions[0].y;
    assert!((way - (0.65 * 1.72 - 1.1)).abs() < 0.02, "{way}");
}

#[test]
fn pieces_without_a_place_are_refused_by_name() {
    let mut shirt = made("shirt");
    let collar = shirt.pattern.pieces.iter_mut().find(|p| p.name == "collar_back").unwrap();
    collar.pose = None;
    let e = arranged(&shirt, true).unwrap_err();
    assert_eq!(e.message, "nothing says where the piece \"collar_back\" stands");
    let hint = "place it by `hand_places` or `key_points` of `Arrange`, or give its pattern places around the body, as GarmentCode files have";
    assert_eq!(e.hint.as_deref(), Some(hint));
    shirt.pattern.pieces.retain(|p| p.name != "collar_back");
    let e = arranged(&shirt, true).unwrap_err();
    assert_eq!(e.message, "the pattern has no piece \"collar_back\"");
}
