//! Whether a body can wear the garment: known before anything is sewn.
//!
//! Cost: one pass over the body's vertices. Limits: a tape around the garment as it lies flat, at
//! its armpits, its waist and hip, and its cuffs; what a closure would open is not known.

use super::pieces;
use crate::style::block::template::bow::Bow;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use toile_body::convex_hull;
use toile_core::prelude::*;

/// Half the thickness of the slice in which an arm is measured, and how far from its axis its skin
/// may lie, metres.
const SLICE: f64 = 0.012;
const REACH: f64 = 0.08;
/// A leg is measured no lower than at this share of the fork's height.
const ANKLE: f64 = 0.14;
/// Around heel and instep a foot measures so many times as much as the ankle.
const HEEL: f64 = 1.4;
/// Up to so much farther down on one side a cuff counts as upright, metres: where a shoulder point
/// lies is not known better.
const SLANT: f64 = 0.05;
/// And a hand so many times as much as the wrist.
const HAND: f64 = 1.5;
/// An arm is measured no higher than at this share of the upper arm: above it the trunk is near.
const UPPERMOST: f64 = 0.5;
/// An armhole is longer than the upper arm is around by this share (Aldrich 2008).
const ARMHOLE: f64 = 0.4;

/// A garment may be narrower than the body by this share: a knit stretches so far (a quarter).
pub(super) const NARROWEST: f64 = 0.8;
/// Under these names a body that was chosen for a garment keeps what that measures.
pub(super) const KEPT: [&str; 3] = ["garment_chest", "garment_waist", "garment_hip"];

/// A girth of the garment beside that of the body, metres.
pub(super) struct Girth {
    what: &'static str,
    pub garment: f64,
    of_body: &'static str,
    pub body: f64,
}

/// Girths of one garment that differ by more than this share were not measured alike.
const ALIKE: f64 = 0.03;

/// Refuses a garment that is much too narrow for the body. `name` is its style's.
pub(in crate::style) fn check(
    name: &str,
    form: &Form,
    fit: &Fit,
    body: &Body,
    photo: Option<&Photo>,
) -> Result<(), StageError> {
    let small = girths(form, fit, body).into_iter().find(|g| g.garment < NARROWEST * g.body);
    small.map_or(Ok(()), |g| Err(too_small(&g, name, body, photo)))
}

fn too_small(g: &Girth, name: &str, body: &Body, photo: Option<&Photo>) -> StageError {
    let cm = |m: f64| (m * 100.0).round();
    // What the body was chosen for, where it was chosen for this garment.
    let chosen_for = body.measurements.get(&format!("garment_{}", g.what)).copied();
    let was_chosen = KEPT.iter().any(|kept| body.measurements.contains_key(*kept));
    let width = photo.and_then(|p| p.garment_width).map(|w| cm(w * g.body / g.garment));
    let scale = match width {
        Some(width) => {
            format!("is the stated width right? It gives the scale; from {width} cm on it would fit")
        }
        None => "is the scale right? The garment is measured by it".to_owned(),
    };
    let hint = match chosen_for {
        Some(other) if (other - g.garment).abs() > ALIKE * g.garment => format!(
            "the mannequin was chosen for {} cm there, as of another garment: --set 'body.style={name}'",
            cm(other)
        ),
        _ if was_chosen => {
            format!("{scale}. If it is, lay waistband and cuffs stretched out, without folds")
        }
        _ => format!("{scale}. If it is, take a mannequin that it fits: --set 'body=Fitting(style: {name})'"),
    };
    StageError::invalid(format!(
        "the garment is too small: its {} measures {} cm around, {} {} cm",
        g.what,
        cm(g.garment),
        g.of_body,
        cm(g.body)
    ))
    .hint(hint)
}

/// What can be compared.
fn girths(form: &Form, fit: &Fit, body: &Body) -> Vec<Girth> {
    let across = |k: usize| 2.0 * fit.sides.iter().map(|s| s[k].a.x).sum::<f64>();
    let tape = |what, of_body, level: &str, garment: Option<f64>| {
        Some(Girth { what, garment: garment?, of_body, body: *body.measurements.get(level)? })
    };
    let found = [
        tape("chest", "the body's", "bust", fit.chest(form)),
        tape("waist", "the body's", "waist", form.at(EdgeRole::Waist).map(across)),
        tape("hip", "the body's", "hip", fit.hip(form)),
    ];
    found.into_iter().flatten().chain(narrower_cuff(form, fit, body)).collect()
}

/// The narrower cuff beside the arm where it ends: as far below the armpit as the underarm seam is
/// long.
pub(super) fn narrower_cuff(form: &Form, fit: &Fit, body: &Body) -> Option<Girth> {
    let cuff = form.underarm()? + 1;
    let mark = |name: &str| body.landmark(name, Hand::Left);
    let (shoulder, elbow, wrist) = (mark("shoulder")?, mark("elbow")?, mark("wrist")?);
    let (upper, fore) = ((elbow - shoulder).norm(), (wrist - elbow).norm());
    let armpit = mark("armpit").map_or(0.0, |p| (p - shoulder).dot(&(elbow - shoulder)) / upper.max(1e-6));
    let narrower = fit.sides.iter().min_by(|a, b| a[cuff].length().total_cmp(&b[cuff].length()))?;
    let along = armpit.max(0.0) + narrower[cuff - 1].length();
    let (of_body, from, to, share) = match along - upper {
        below if below < 0.0 => ("the upper arm", shoulder, elbow, (along / upper).max(UPPERMOST)),
        below if below < 0.8 * fore => ("the forearm", elbow, wrist, below / fore),
        _ => ("the wrist", elbow, wrist, 1.0),
    };
    // In the slice of a child's arm lies its trunk, too.
    let stated = body.measurements.get("biceps").copied().unwrap_or(f64::INFINITY);
    let around = arm_girth(body, from, to, share)?.min(stated);
    // A short sleeve may end farther down on one side of the arm.
    let shape = pieces::lying_sleeve_of(fit, form, usize::from(std::ptr::eq(narrower, &fit.sides[1])))?;
    let around = match shape.is_short() {
        true => {
            let rooted = around * (1.0 + ARMHOLE * (1.0 - along / upper / UPPERMOST).max(0.0));
            oblique(rooted, ((along - shape.top_length()).abs() - SLANT).max(0.0))
        }
        false => around,
    };
    Some(Girth { what: "narrower cuff", garment: 2.0 * narrower[cuff].length(), of_body, body: around })
}

/// Around a limb of that girth that is cut aslant, farther down on one side by so much.
fn oblique(girth: f64, by: f64) -> f64 {
    let radius = girth / std::f64::consts::TAU;
    ellipse(radius, radius.hypot(0.5 * by))
}

/// The length of an ellipse of these half axes (Ramanujan 1914).
pub(in crate::style) fn ellipse(a: f64, b: f64) -> f64 {
    std::f64::consts::PI * (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt())
}

/// How far the cuffs of sleeves lie below the wrists, where they are too narrow for the hand,
/// metres.
pub(super) fn narrow_wrist(form: &Form, fit: &Fit, body: &Body) -> Option<f64> {
    let k = form.underarm()?;
    let mark = |name: &str| body.landmark(name, Hand::Left);
    let (shoulder, elbow, wrist) = (mark("shoulder")?, mark("elbow")?, mark("wrist")?);
    let arm = (elbow - shoulder).norm() + (wrist - elbow).norm();
    let armpit = mark("armpit").map_or(0.0, |p| (p - shoulder).dot(&(elbow - shoulder).normalize()));
    let narrower = fit.sides.iter().min_by(|a, b| a[k + 1].length().total_cmp(&b[k + 1].length()))?;
    let below = armpit.max(0.0) + narrower[k].length() - arm;
    let passes = 2.0 * narrower[k + 1].length() > HAND * arm_girth(body, elbow, wrist, 1.0)?;
    (below > 0.0 && !passes).then_some(below)
}

/// The narrower hem of two legs beside the leg where it ends: as far below the waist as the outseam
/// is long.
pub(super) fn narrower_hem(form: &Form, fit: &Fit, body: &Body) -> Option<Girth> {
    let hem = form.at(EdgeRole::Hem).filter(|k| form.has_legs() && *k > 0)?;
    let narrower = fit.sides.iter().min_by(|a, b| a[hem].length().total_cmp(&b[hem].length()))?;
    let around = leg_girth(body, end_of_leg(form, narrower, body)?)?;
    Some(Girth {
        what: "narrower leg",
        garment: 2.0 * narrower[hem].length(),
        of_body: "the leg",
        body: around,
    })
}

/// The height at which a leg ends whose waist is at the body's.
fn end_of_leg(form: &Form, side: &[Bow], body: &Body) -> Option<f64> {
    let outer = |role| form.at(role).map_or(0.0, |k: usize| side[k].length());
    Some(body.landmarks.get("waist_front")?.y - outer(EdgeRole::Outseam) - outer(EdgeRole::Hip))
}

/// How far the hems of two legs lie below the ankles, where they are too narrow for the foot,
/// metres.
pub(super) fn narrow_ankle(form: &Form, fit: &Fit, body: &Body) -> Option<f64> {
    let hem = form.at(EdgeRole::Hem)?;
    let narrower = fit.sides.iter().min_by(|a, b| a[hem].length().total_cmp(&b[hem].length()))?;
    let ankle = ANKLE * body.landmarks.get("crotch")?.y;
    let below = ankle - end_of_leg(form, narrower, body)?;
    let passes = 2.0 * narrower[hem].length() > HEEL * leg_girth(body, ankle)?;
    (below > 0.0 && !passes).then_some(below)
}

/// How high the waist lies above the fork, metres; 0 of a body that does not say where they are.
pub(super) fn rise(body: &Body) -> f64 {
    let height = |name: &str| body.landmarks.get(name).map(|p| p.y);
    height("waist_front").zip(height("crotch")).map_or(0.0, |(waist, fork)| (waist - fork).max(0.0))
}

/// The girth of the left leg at a height below the fork and above the foot.
fn leg_girth(body: &Body, y: f64) -> Option<f64> {
    let crotch = body.landmarks.get("crotch")?;
    let y = y.clamp(ANKLE * crotch.y, crotch.y - 2.0 * SLICE);
    let outermost = 0.55 * body.measurements.get("thigh").copied().unwrap_or(f64::INFINITY);
    let is_of_leg = |p: &&Point3| (p.y - y).abs() < SLICE && p.x > 0.0 && p.x < outermost;
    hull_girth(body.positions.iter().filter(is_of_leg).map(|p| Point2::new(p.x, p.z)).collect())
}

/// The girth of the upper arm, as the body states it, or half way down.
pub(super) fn upper_arm(body: &Body) -> Option<f64> {
    if let Some(biceps) = body.measurements.get("biceps") {
        return Some(*biceps);
    }
    let mark = |name: &str| body.landmark(name, Hand::Left);
    arm_girth(body, mark("shoulder")?, mark("elbow")?, UPPERMOST)
}

/// The girth of an arm at a share of the way between two of its landmarks.
fn arm_girth(body: &Body, from: Point3, to: Point3, share: f64) -> Option<f64> {
    let axis = (to - from).try_normalize(1e-6)?;
    let middle = from + (to - from) * share;
    let across = axis.cross(&Vector3::z()).try_normalize(1e-6)?;
    let front = across.cross(&axis);
    let near = |p: &Point3| {
        let d = p - middle;
        let flat = Point2::new(d.dot(&across), d.dot(&front));
        (d.dot(&axis).abs() < SLICE && flat.coords.norm() < REACH).then_some(flat)
    };
    hull_girth(body.positions.iter().filter_map(near).collect())
}

/// Around places of a slice.
fn hull_girth(slice: Vec<Point2>) -> Option<f64> {
    let hull = convex_hull(slice);
    let n = hull.len();
    (n > 2).then(|| (0..n).map(|i| (hull[(i + 1) % n] - hull[i]).norm()).sum())
}
