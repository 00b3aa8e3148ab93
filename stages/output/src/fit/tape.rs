//! Ease: the tape around the cloth less the tape around the body, at the places where a tailor
//! holds it.
//!
//! Bust, waist and hip as for `Measure`. Biceps: across the upper arm, halfway from armpit to
//! elbow. Thigh: 5 cm below the crotch. Neck: the garment's opening around the neck beside the
//! girth of the neck.

use super::openings::Opening;
use nalgebra::Rotation3;
use std::collections::BTreeMap;
use toile_body::{slice, trunk};
use toile_core::artifact::{Body, Garment, GirthFigures, Hand, Point2, Point3, Vector3};
use toile_drape::measure::girth;

/// Below the crotch, metres: where the legs are apart.
const BELOW_CROTCH: f64 = 0.05;
/// A sleeve is no wider than so many times the arm.
const AROUND_ARM: f64 = 3.0;
/// Above the neck's base, metres: where a tape around the neck lies, if the body brings no measure.
const ABOVE_BASE: f64 = 0.03;
/// An opening around the neck is no longer than so many times the neck: beyond it is a boat or a
/// strapless top.
const AROUND_NECK: f64 = 3.0;

/// The girths of a garment where it closes around its body.
pub(super) fn girths(garment: &Garment, body: &Body, openings: &[Opening]) -> BTreeMap<String, GirthFigures> {
    let mut all = girth::girths(garment, body);
    let mut add = |name: &str, figures: Option<GirthFigures>| {
        all.extend(figures.map(|f| (name.to_owned(), f)));
    };
    for hand in Hand::BOTH {
        add(&hand.name("biceps"), biceps(garment, body, hand));
        add(&hand.name("thigh"), thigh(garment, body, hand));
    }
    add("neck", neck(body, openings));
    all
}

fn mark(body: &Body, name: &str) -> Option<Point3> {
    body.landmarks.get(name).copied()
}

/// Around the upper arm, on garment and body turned so that the arm points down through the origin.
fn biceps(garment: &Garment, body: &Body, hand: Hand) -> Option<GirthFigures> {
    let at = |name: &str| body.landmark(name, hand);
    let (shoulder, elbow, armpit) = (at("shoulder")?, at("elbow")?, at("armpit")?);
    let along = (shoulder - elbow).try_normalize(1e-9)?;
    let middle = elbow + along * ((armpit - elbow).dot(&along) / 2.0);
    let turn = Rotation3::rotation_between(&along, &Vector3::y())?;
    let turned = |ps: &[Point3]| ps.iter().map(|p| Point3::from(turn * (p - middle))).collect::<Vec<_>>();
    let loops = slice(&turned(&body.positions), &body.triangles, 0.0);
    let arm = loops.iter().find(|l| l.holds(Point2::origin()))?;
    let sleeve = Garment { positions: turned(&garment.positions), ..garment.clone() };
    let cloth_m = girth::around(&sleeve, 0.0, arm.centre(), &[])?;
    // What goes around trunk and arm together is no sleeve.
    (cloth_m < AROUND_ARM * arm.girth).then_some(GirthFigures { cloth_m, body_m: arm.girth })
}

/// Around one leg alone.
fn thigh(garment: &Garment, body: &Body, hand: Hand) -> Option<GirthFigures> {
    let y = mark(body, "crotch")?.y - BELOW_CROTCH;
    let loops = slice(&body.positions, &body.triangles, y);
    let hip = mark(body, "hip_front")?.x;
    let of = |hand: Hand| {
        let near = loops.iter().filter(|l| hand.sign() * (l.centre().x - hip) > 0.0);
        near.max_by(|a, b| a.girth.total_cmp(&b.girth))
    };
    let (leg, other) = (of(hand)?, of(hand.other())?);
    let cloth_m = girth::around(garment, y, leg.centre(), &[other.centre()])?;
    Some(GirthFigures { cloth_m, body_m: leg.girth })
}

fn neck(body: &Body, openings: &[Opening]) -> Option<GirthFigures> {
    let front = mark(body, "neck_base_front")?;
    let back = mark(body, "neck_base_back")?;
    let middle = nalgebra::center(&front, &back);
    let above =
        || trunk(&slice(&body.positions, &body.triangles, middle.y + ABOVE_BASE), middle.x).map(|l| l.girth);
    let body_m = body.measurements.get("neck").copied().or_else(above)?;
    let around = openings.iter().filter(|o| o.goes_around(Point2::new(middle.x, middle.z)));
    let top = around.max_by(|a, b| a.height.total_cmp(&b.height))?;
    let is_neckline = top.length < AROUND_NECK * body_m && top.height > mark(body, "bust_front")?.y;
    is_neckline.then_some(GirthFigures { cloth_m: top.length, body_m })
}
