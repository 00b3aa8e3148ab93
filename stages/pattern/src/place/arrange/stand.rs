//! Where pieces without a pose stand, once their regions are known.
//!
//! Method: fronts stand flat before the body and backs behind it, hung by the middle of their
//! shoulder seams on the line from neck to shoulder, or by their upper edges from the waist. Legs
//! in one piece are bent around the leg, open to the inside; a waistband is bent around the waist,
//! turned so that its seams lie nearest to what they are sewn to. Sleeves stand flat before their
//! arm, the middle of the cap where the arm begins, and are bent around it as those with a pose
//! are. Bent pieces keep every length along their cylinder. Cost: some milliseconds. Limits: the
//! levels are those of a standing body with landmarks.

use super::PiecePlaces;
use super::limb::Limb;
use super::region::{Decided, Joint, Region, Side, bounds, joints, middle};
use crate::place::sew::Offsets;
use crate::style::{TRUNK_BOTTOM, TRUNK_TOP};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use toile_core::prelude::*;

/// Flat pieces stand this far from the farthest point of the trunk, metres.
const AWAY: f64 = 0.04;
/// What hangs from the shoulders starts this far above them, metres.
const ABOVE: f64 = 0.01;

/// Sleeves stand this far before the axis of their arm until they are bent, metres.
const BEFORE: f64 = 0.1;

/// Radii around a leg are taken this far apart, metres.
const STEP: f64 = 0.02;
/// And change by no more than this share of the way along the leg.
const SLOPE: f64 = 0.35;
/// Feet reach up to this share of the body's height.
const FEET: f64 = 0.06;

/// What is asked of the body.
struct Figure {
    /// Height of the crown.
    top: f64,
    waist: f64,
    crotch: f64,
    /// Height and distance from the middle plane of neck and shoulder.
    neck: [f64; 2],
    shoulder: [f64; 2],
    /// Most forward and most backward z of the trunk.
    depth: (f64, f64),
    /// Middle of a leg: x and z.
    leg: [f64; 2],
}

impl Figure {
    fn of(body: &Body) -> Result<Self, StageError> {
        let at = |name: &str| {
            body.landmarks.get(name).copied().ok_or_else(|| {
                StageError::invalid(format!(
                    "the body has no landmark \"{name}\", by which pieces without a pose are placed"
                ))
                .hint("take a Mannequin, or give the pattern places around the body")
            })
        };
        let [neck, shoulder] = ["neck", "shoulder"].map(|name| at(&Hand::Left.name(name)));
        let (neck, shoulder) = (neck?, shoulder?);
        let crotch = at("crotch")?.y;
        let top = body.positions.iter().map(|p| p.y).fold(0.0, f64::max);
        let trunk = || {
            body.positions
                .iter()
                .filter(|p| p.x.abs() < shoulder.x.abs() && p.y > TRUNK_BOTTOM * top && p.y < TRUNK_TOP * top)
        };
        let depth = (
            trunk().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max),
            trunk().map(|p| p.z).fold(f64::INFINITY, f64::min),
        );
        let thigh: Vec<&Point3> = body
            .positions
            .iter()
            .filter(|p| p.x > 0.0 && p.x < shoulder.x.abs() * 1.2 && (p.y - 0.9 * crotch).abs() < 0.03)
            .collect();
        let range = |of: fn(&Point3) -> f64| {
            let values = || thigh.iter().map(|p| of(p));
            0.5 * (values().fold(f64::INFINITY, f64::min) + values().fold(f64::NEG_INFINITY, f64::max))
        };
        if thigh.is_empty() {
            return Err(StageError::invalid("the body has no thigh below its landmark \"crotch\""));
        }
        let leg = [range(|p| p.x), range(|p| p.z)];
        let waist = at("waist_front")?.y;
        let [neck, shoulder] = [neck, shoulder].map(|p| [p.x.abs(), p.y]);
        Ok(Figure { top, waist, crotch, neck, shoulder, depth, leg })
    }

    /// The height of the shoulders at that distance from the middle plane.
    fn shoulder_at(&self, x: f64) -> f64 {
        let share = (x - self.neck[0]) / (self.shoulder[0] - self.neck[0]).max(1e-6);
        self.neck[1] + share.clamp(0.0, 1.0) * (self.shoulder[1] - self.neck[1])
    }

    /// The greatest distance of the skin from a vertical axis between two heights; arms and head do
    /// not count.
    fn reach(&self, body: &Body, [x, z]: [f64; 2], (low, high): (f64, f64)) -> f64 {
        let counts = |p: &&Point3| {
            p.y > low && p.y < high && p.x.abs() < self.shoulder[0] && p.y < TRUNK_TOP * self.top
        };
        body.positions.iter().filter(counts).map(|p| (p.x - x).hypot(p.z - z)).fold(0.0, f64::max)
    }
}

/// The vertices of every panel, and what was decided of each.
///
/// Errors: a piece that nothing places; a body without the landmarks.
pub(super) fn stand(
    pattern: &Pattern,
    decided: &[Decided],
    offsets: &Offsets,
    body: &Body,
    clearance: f64,
) -> Result<(PiecePlaces, Vec<String>), StageError> {
    let joints = joints(pattern);
    let figure = Figure::of(body)?;
    let (mut places, mut told) = (PiecePlaces::new(), Vec::new());
    let mut hung: BTreeMap<usize, Hung> = BTreeMap::new();
    // Bands go where that is which they are sewn to.
    let order = || (0..decided.len()).filter(|i| decided[*i].region != Region::Waist);
    let bands = (0..decided.len()).filter(|i| decided[*i].region == Region::Waist);
    for i in order().chain(bands) {
        let (piece, d) = (&pattern.pieces[i], &decided[i]);
        let Some((_, panel)) = offsets.get(piece.name.as_str()) else { continue };
        let (placed, words) = match d.region {
            Region::Trunk => flat(piece, d, trunk_level(i, pattern, &joints, &figure, d), &figure),
            Region::Skirt => flat(piece, d, figure.waist - top_of(i, pattern, &joints), &figure),
            Region::Leg(hand) => leg(i, pattern, hand, &joints, &figure, body, clearance),
            Region::Arm(hand) => sleeve(i, pattern, hand, &joints, body)?,
            Region::Waist => band(i, pattern, &joints, &hung, &figure, body, clearance),
            Region::ByHand => continue,
        };
        places.insert(piece.name.clone(), panel.positions.iter().map(|p| placed.at(*p)).collect());
        told.push(format!("\"{}\" {words}: {}", piece.name, d.why));
        hung.insert(i, placed);
    }
    Ok((places, told))
}

/// A piece in space: flat, or around a vertical axis.
enum Hung {
    Flat(Pose),
    /// Around a vertical axis: see [`Round`].
    Round(Round),
}

/// A bent piece. Its direction `across` goes around, to the right as seen from outside; what lies
/// at `middle` along it looks in the direction `facing`, an angle from straight ahead to the
/// wearer's left. `axis` is x and z, `rise` the height of its origin.
struct Round {
    across: Vector2,
    middle: f64,
    facing: f64,
    axis: [f64; 2],
    rise: f64,
    /// Radii at even steps of height.
    radii: Vec<f64>,
    /// The height of the first one, and the step.
    from: f64,
    step: f64,
}

impl Round {
    /// The radius at a height; that of the nearest end beyond them.
    fn radius(&self, y: f64) -> f64 {
        let last = self.radii.len().saturating_sub(1);
        let at = ((y - self.from) / self.step).clamp(0.0, last as f64);
        let k = (at as usize).min(last.saturating_sub(1));
        let (a, b) = (self.radii[k], self.radii[(k + 1).min(last)]);
        a + (b - a) * (at - k as f64).clamp(0.0, 1.0)
    }
}

impl Hung {
    fn at(&self, p: Point2) -> Point3 {
        match self {
            Hung::Flat(pose) => pose.at(p),
            Hung::Round(r) => {
                let (u, y) = (r.across.dot(&p.coords), r.across.perp(&p.coords) + r.rise);
                let radius = r.radius(y);
                let angle = (u - r.middle) / radius + r.facing;
                Point3::new(r.axis[0] + radius * angle.sin(), y, r.axis[1] + radius * angle.cos())
            }
        }
    }
}

/// Where the middle of the body lies in a piece's own x.
fn middle_line(d: &Decided, piece: &Piece) -> f64 {
    let (lo, hi) = bounds(piece);
    match (d.hand, d.side) {
        (None, _) => (lo.x + hi.x) / 2.0,
        (Some(Hand::Left), Side::Front | Side::Around) | (Some(Hand::Right), Side::Back) => lo.x,
        _ => hi.x,
    }
}

fn flat(piece: &Piece, d: &Decided, rise: f64, f: &Figure) -> (Hung, String) {
    let (sign, z, word) = match d.side {
        Side::Back => (-1.0, f.depth.1 - AWAY, "behind the body"),
        Side::Front | Side::Around => (1.0, f.depth.0 + AWAY, "before the body"),
    };
    let x = middle_line(d, piece);
    let pose = Pose {
        origin: Point3::new(-sign * x, rise, z),
        across: Vector3::new(sign, 0.0, 0.0),
        along: Vector3::y(),
    };
    let region = if d.region == Region::Trunk { "hangs from the shoulders" } else { "hangs from the waist" };
    (Hung::Flat(pose), format!("{region} {word}"))
}

/// The height of the origin of a piece that hangs from the shoulders.
fn trunk_level(i: usize, pattern: &Pattern, joints: &[Joint], f: &Figure, d: &Decided) -> f64 {
    let piece = &pattern.pieces[i];
    let x = middle_line(d, piece);
    let ends = ends(i, joints).filter(|e| {
        let path = piece.outer.path(e[0]);
        let way = path.at(path.length()) - path.at(0.0);
        way.x.abs() > way.y.abs()
    });
    let highest = ends.map(|e| middle(piece, e).0).max_by(|a, b| a.y.total_cmp(&b.y));
    let at = highest.unwrap_or_else(|| bounds(piece).1);
    f.shoulder_at((at.x - x).abs()) + ABOVE - at.y
}

/// The sewn edges of a piece, seam by seam.
fn ends(i: usize, joints: &[Joint]) -> impl Iterator<Item = &Vec<usize>> {
    joints.iter().flat_map(move |j| (0..2).filter(move |k| j.pieces[*k] == i).map(move |k| &j.edges[k]))
}

/// The height in the piece of what lies at the waist: of its seam with a band, else its highest
/// point.
fn top_of(i: usize, pattern: &Pattern, joints: &[Joint]) -> f64 {
    let piece = &pattern.pieces[i];
    let (lo, hi) = bounds(piece);
    let high = ends(i, joints).map(|e| middle(piece, e)).filter(|(at, _)| at.y > hi.y - 0.15 * (hi.y - lo.y));
    let top = high.max_by(|a, b| a.0.y.total_cmp(&b.0.y)).map(|(at, _)| at.y);
    top.unwrap_or(hi.y)
}

fn leg(
    i: usize,
    pattern: &Pattern,
    hand: Hand,
    joints: &[Joint],
    f: &Figure,
    body: &Body,
    clearance: f64,
) -> (Hung, String) {
    let piece = &pattern.pieces[i];
    let (lo, hi) = bounds(piece);
    // The fork is where the piece is widest: it may not start above that of the body.
    let fork = piece.outer.corners.iter().filter(|c| c.x - lo.x < 1e-3 || hi.x - c.x < 1e-3);
    let fork = fork.map(|c| c.y).fold(f64::NEG_INFINITY, f64::max);
    let rise = (f.waist - top_of(i, pattern, joints)).min(f.crotch - fork);
    let axis = [hand.sign() * f.leg[0], f.leg[1]];
    let (low, high) = (lo.y + rise, hi.y + rise);
    let radii = leg_radii(body, f, axis, hand, (low, high), clearance);
    let words = format!(
        "goes around the {hand} leg, radius {:.0} mm at the fork, its upper edge {:+.0} mm from the waist",
        radii[((fork + rise - low) / STEP).clamp(0.0, (radii.len() - 1) as f64) as usize] * 1e3,
        (top_of(i, pattern, joints) + rise - f.waist) * 1e3
    );
    // The middle of its width lies outside of the leg.
    let (middle, facing) = ((lo.x + hi.x) / 2.0, hand.sign() * TAU / 4.0);
    let round = Round { across: Vector2::x(), middle, facing, axis, rise, radii, from: low, step: STEP };
    (Hung::Round(round), words)
}

/// A sleeve before its arm, ready to be bent around it: what is sewn into the armhole at the arm's
/// root, its front to the front.
fn sleeve(
    i: usize,
    pattern: &Pattern,
    hand: Hand,
    joints: &[Joint],
    body: &Body,
) -> Result<(Hung, String), StageError> {
    let piece = &pattern.pieces[i];
    let limb = Limb::arms(body).into_iter().find(|l| l.hand == hand).ok_or_else(|| {
        StageError::invalid(format!("the body has no arm for the sleeve \"{}\"", piece.name))
            .hint("take a Mannequin, or give the pattern places around the body")
    })?;
    let (lo, hi) = bounds(piece);
    let of_others = joints.iter().filter(|j| j.pieces[0] != j.pieces[1]);
    let caps = of_others.flat_map(|j| (0..2).filter(|k| j.pieces[*k] == i).map(|k| &j.edges[k]));
    let cap = caps.map(|edges| middle(piece, edges).0.y).fold(f64::NEG_INFINITY, f64::max);
    let (across, along) = (limb.up * hand.sign(), -limb.axis);
    let origin = limb.root + limb.front * BEFORE - across * ((lo.x + hi.x) / 2.0) - along * cap;
    Ok((Hung::Flat(Pose { origin, across, along }), format!("goes around the {hand} arm")))
}

/// Radii around a leg, a step of height each. Above the fork only the outside of the hip counts:
/// the inside stays open. Changes with height are held to [`SLOPE`], so that the bent piece is
/// stretched little.
fn leg_radii(
    body: &Body,
    f: &Figure,
    axis: [f64; 2],
    hand: Hand,
    (low, high): (f64, f64),
    clearance: f64,
) -> Vec<f64> {
    let n = ((high - low) / STEP).ceil().max(1.0) as usize + 1;
    let mut radii = vec![0.0_f64; n];
    for p in &body.positions {
        let out = p.x * hand.sign();
        let inside = if p.y > f.crotch { axis[0].abs() } else { 0.0 };
        // Feet stick out forward, hands are no part of a leg.
        if out < inside || out > f.shoulder[0] || p.y < FEET * f.top || p.y > f.waist + STEP {
            continue;
        }
        let k = ((p.y - low) / STEP).round();
        if k >= 0.0 && (k as usize) < n {
            radii[k as usize] = radii[k as usize].max((p.x - axis[0]).hypot(p.z - axis[1]));
        }
    }
    radii.iter_mut().for_each(|r| *r += clearance);
    for k in 1..n {
        radii[k] = radii[k].max(radii[k - 1] - SLOPE * STEP);
    }
    for k in (0..n - 1).rev() {
        radii[k] = radii[k].max(radii[k + 1] - SLOPE * STEP);
    }
    radii
}

/// A band around the waist, its seams as near as a turn brings them to what they are sewn to.
fn band(
    i: usize,
    pattern: &Pattern,
    joints: &[Joint],
    hung: &BTreeMap<usize, Hung>,
    f: &Figure,
    body: &Body,
    clearance: f64,
) -> (Hung, String) {
    let piece = &pattern.pieces[i];
    // Its seams with placed pieces run to the right at its lower edge.
    let mut met: Vec<(Point2, Point3, f64)> = Vec::new();
    let mut way = Vector2::zeros();
    for j in joints {
        for k in 0..2 {
            let other = j.pieces[1 - k];
            if j.pieces[k] == i
                && other != i
                && let Some(placed) = hung.get(&other)
            {
                for &e in &j.edges[k] {
                    let path = piece.outer.path(e);
                    way += path.at(path.length()) - path.at(0.0);
                }
                met.push((j.middle[k], placed.at(j.middle[1 - k]), j.share * middle(piece, &j.edges[k]).1));
            }
        }
    }
    let across = way.try_normalize(1e-9).unwrap_or_else(Vector2::x);
    let u = |p: &Point2| across.dot(&p.coords);
    let v = |p: &Point2| across.perp(&p.coords);
    let points = piece.outer.points().0;
    let span = |of: &dyn Fn(&Point2) -> f64| {
        let (lo, hi) =
            points.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        (lo, hi)
    };
    let (along, up) = (span(&u), span(&v));
    let level = match met.is_empty() {
        true => f.waist,
        false => met.iter().map(|m| m.1.y).sum::<f64>() / met.len() as f64,
    };
    let rise = level - up.0;
    let axis = [0.0, (f.depth.0 + f.depth.1) / 2.0];
    let reach = f.reach(body, axis, (level - 0.01, level + up.1 - up.0 + 0.01));
    let radius = ((along.1 - along.0) / TAU).max(reach + clearance);
    // The mean turn that brings the middle of each seam to the direction of the other side.
    let (mut sin, mut cos) = (0.0, 0.0);
    for (own, to, length) in &met {
        let turn = (to.x - axis[0]).atan2(to.z - axis[1]) - u(own) / radius;
        sin += length * turn.sin();
        cos += length * turn.cos();
    }
    let (middle, facing) = match met.is_empty() {
        true => ((along.0 + along.1) / 2.0, 0.0),
        false => (0.0, sin.atan2(cos)),
    };
    let round = Round { across, middle, facing, axis, rise, radii: vec![radius], from: level, step: STEP };
    (Hung::Round(round), format!("goes around the waist, radius {:.0} mm", radius * 1e3))
}
