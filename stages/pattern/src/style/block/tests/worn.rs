//! What lies narrower than its wearer needs it.

use super::*;
use crate::style::block::wearable::upper_arm;

/// A garment cut for the mannequin that it fits, whose upper arms measure so much, with that one
/// and what is noted.
fn worn(style: BlockStyle, half: &[[f64; 2]], biceps: f64) -> (Pattern, Body, Vec<String>) {
    let cx = Context::quiet();
    let front: Set<Outline> = [("front".to_owned(), outline(garment(half)))].into_iter().collect();
    let mut body =
        Fitting { style, ..Fitting::default() }.run(front.clone(), None, &Context::quiet()).unwrap();
    body.measurements.insert("biceps".to_owned(), biceps);
    let (pattern, ..) = of(style).run(front, &body, None, &cx).unwrap();
    (pattern, body, cx.take_remarks().notes)
}

#[test]
fn an_armhole_that_lies_folded_is_cut_as_deep_as_the_arm_needs_it() {
    let mut shallow = TEE.to_vec();
    (shallow[2], shallow[3]) = ([250.0, 520.0], [360.0, 400.0]);
    let (pattern, body, notes) = worn(BlockStyle::TShirt, &shallow, 0.31);
    let needed = 1e3 * 0.68 * upper_arm(&body).unwrap();
    let armhole = length(&pattern, "front", "armhole_left");
    // It is arched by a few per cent.
    assert!(armhole > needed - 1.0 && armhole < 1.1 * needed, "{armhole:.1} for {needed:.1}");
    assert!(notes.iter().any(|n| n.starts_with("the narrower armhole measures")), "{notes:?}");
    let (_, _, notes) = worn(BlockStyle::TShirt, TEE, 0.27);
    assert!(!notes.iter().any(|n| n.contains("armhole")), "{notes:?}");
}

#[test]
fn legs_with_narrow_hems_end_above_the_foot() {
    let legs = |hem: f64| {
        let mut half = TROUSERS.to_vec();
        for p in &mut half[1..3] {
            p[1] = -80.0;
        }
        half[2][0] = half[1][0] + hem;
        worn(BlockStyle::Trousers, &half, 0.27)
    };
    let told = |notes: &[String]| {
        let why = "are cut off the legs: no foot passes through their hems, which lie below the ankle";
        notes.iter().any(|n| n.ends_with(why))
    };
    let (narrow, _, notes) = legs(90.0);
    assert!(told(&notes), "{notes:?}");
    let (wide, _, notes) = legs(170.0);
    assert!(!told(&notes), "{notes:?}");
    let outseam = |pattern: &Pattern| length(pattern, "left_leg_front", "outseam");
    assert!(outseam(&narrow) < outseam(&wide) - 20.0);
}

#[test]
fn both_inseams_of_short_shorts_are_of_one_length() {
    let shorts: &[[f64; 2]] = &[[0.0, 130.0], [30.0, 0.0], [330.0, 60.0], [220.0, 350.0], [0.0, 350.0]];
    let (pattern, ..) = cut(&of(BlockStyle::Trousers), garment(shorts)).unwrap();
    let [front, back] = ["front", "back"].map(|layer| {
        let leg = format!("left_leg_{layer}");
        ["inseam", "hem"].map(|edge| length(&pattern, &leg, edge))
    });
    assert!((front[0] / back[0] - 1.0).abs() < 0.03, "{} and {}", front[0], back[0]);
    // What one hem is let out, the other is taken in.
    assert!(back[1] > front[1] + 20.0, "{} and {}", front[1], back[1]);
    assert!((front[1] + back[1] - 2.0 * between(shorts, 1)).abs() < 12.0, "{} and {}", front[1], back[1]);
}
