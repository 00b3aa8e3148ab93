//! From a fitted template to the pieces of a pattern, as they lie flat.
//!
//! Method: what the photo shows is kept edge by edge. A garment that is laid flat is two equal
//! layers, so front and back are cut along the template's outline. Sleeves are cut off along the
//! armhole, which runs from armpit to shoulder point and is the sleeve's cap as well: both have one
//! length. Each layer of a sleeve is a piece, so that each shows its own photo. The shoulder point,
//! which a flat shirt does not show, lies where the shoulder of a block does: at 88 % of the
//! chest's half (Aldrich 2008). So do the points of a fork, which lie folded (`leg`). Limits: a
//! raglan sleeve is cut as a set-in one.

use super::front::{self, Front};
use super::hood;
use super::leg;
use super::sleeve::SleeveShape;
use super::waist::{self, Waist};
use crate::style::block::template::curve::Curve;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::flat::{Flat, FlatEdge, Run, Side};
use crate::style::block::template::form::Form;
use crate::style::block::template::piece_role::{Layer, PieceRole};
use toile_core::prelude::*;

/// The shoulder point's distance from the axis, as a share of the armpit's.
const SHOULDER: f64 = 0.88;
/// And at least so far from the armpit, as a share of that one's distance from the axis: an armhole
/// is about 0.9 times as deep (Aldrich 2008).
const LEAST_ARMHOLE: f64 = 0.7;
/// And within these shares of the way from cuff to neck.
const ALONG: [f64; 2] = [0.2, 0.88];
/// The template's own corner is the shoulder point where it lies so near to that distance, as a
/// share of it.
const CORNER: f64 = 0.1;
/// Controls of an armhole, to the left of its chord, in chord lengths: it runs in below and up
/// above.
const ARMHOLE: [f64; 2] = [0.18, 0.08];

/// How a garment is made up, beyond its outline.
#[derive(Debug, Clone, Copy)]
pub(super) struct Making {
    pub waist: Waist,
    pub front: Front,
    /// How high the top of the wearer's head lies above the throat, metres.
    pub head: f64,
    /// How high the wearer's waist lies above the fork, metres.
    pub rise: f64,
}

/// The pieces of one layer, as they are cut or as they lie in the photo.
pub(super) fn layer(fit: &Fit, form: &Form, making: Making, layer: Layer, is_cut: bool) -> Vec<Flat> {
    let sides = [0, 1].map(|k| Side::of(fit, form, layer, k));
    if let Waist::Gathered { fullness, band } = making.waist {
        return waist::gathered(&sides, layer, fullness, band.metres(), is_cut);
    }
    if form.has_legs() {
        return sides.iter().filter_map(|s| leg::leg(s, layer, making.rise)).collect();
    }
    let cut: Vec<Cutting> = sides.iter().map(|s| Cutting::of(s, form, layer, is_cut)).collect();
    let sleeves = sides.iter().zip(&cut).filter_map(|(s, c)| sleeve(s, c.sleeve.as_ref()?, layer));
    let trunk = match (layer, making.front) {
        (Layer::Front, Front::Halves) => {
            sides.iter().zip(&cut).map(|(s, c)| front::half(s, &c.trunk, form)).collect()
        }
        _ => {
            let whole = trunk(&sides, &cut, form, layer);
            vec![match making.waist.pleats() {
                Some(pleats) if is_cut => pleats.let_into(whole),
                _ => whole,
            }]
        }
    };
    let has_hood = form.ends_at(EdgeRole::Crown) && layer == Layer::Front;
    let hood = sides.iter().filter(|_| has_hood).map(|s| hood::half(s, making.head, is_cut));
    trunk.into_iter().chain(sleeves).chain(hood).collect()
}

/// Front or back from side to side.
fn trunk(sides: &[Side; 2], cut: &[Cutting], form: &Form, layer: Layer) -> Flat {
    let (first, last) = (0, form.edges.len() - 1);
    let both = |k: usize| [0, 1].map(|s: usize| sides[s].laid(sides[s].edges[k].1));
    let [right_top, left_top] = both(last);
    let mut edges = sides[0].own(&cut[0].trunk);
    if !form.ends_at(EdgeRole::Crown) {
        edges.push(FlatEdge::only(form.edges[last].role, Run::Chain(vec![right_top, left_top])));
    }
    edges.extend(sides[1].own(&cut[1].trunk));
    if !form.begins_at_fork() {
        let [right_hem, left_hem] = both(first);
        edges.push(FlatEdge::only(EdgeRole::Hem, Run::Chain(vec![left_hem, right_hem])));
    }
    Flat::of_trunk(PieceRole::Whole(layer), edges)
}

/// A side's edges between hem and neck, and its sleeve's.
struct Cutting {
    trunk: Vec<(EdgeRole, Run)>,
    sleeve: Option<Vec<(EdgeRole, Run)>>,
}

impl Cutting {
    fn of(side: &Side, form: &Form, layer: Layer, is_cut: bool) -> Self {
        let last = form.edges.len() - 1;
        // A hem from side to side belongs to both halves.
        let first = usize::from(!form.begins_at_fork());
        let run = |k: usize| (side.edges[k].0, Run::Cubic(side.edges[k].1));
        let Some(k) = form.underarm() else {
            return Cutting { trunk: (first..last).map(run).collect(), sleeve: None };
        };
        let (shape, shoulder) = lying_sleeve(side, form, k);
        let armpit = shape.underarm.0[0];
        let armhole = arched(armpit, shoulder[0].0[0]);
        let mut trunk: Vec<_> = (first..k).map(run).collect();
        trunk.extend([(EdgeRole::Armhole, Run::Cubic(armhole)), (EdgeRole::Shoulder, Run::of(shoulder))]);
        if form.ends_at(EdgeRole::Crown) {
            trunk.push((EdgeRole::Neck, Run::Cubic(hood::neckline(side, layer))));
        }
        let shape = if is_cut { shape.straightened() } else { Some(shape) };
        let sleeve = shape.and_then(|shape| {
            let [armpit, point] = shape.ends()?;
            Some(vec![
                (EdgeRole::Underarm, Run::Cubic(shape.underarm)),
                (EdgeRole::Cuff, Run::Cubic(shape.cuff)),
                (EdgeRole::Top, Run::of(shape.top)),
                (EdgeRole::Cap, Run::Cubic(arched(armpit, point).turned())),
            ])
        });
        Cutting { trunk, sleeve }
    }
}

/// The sleeve of a side as it lies, whose underarm is the edge of that number, and the shoulder
/// beside it.
fn lying_sleeve(side: &Side, form: &Form, k: usize) -> (SleeveShape, Vec<Curve>) {
    let [underarm, cuff] = [k, k + 1].map(|k| side.edges[k].1);
    let upper: Vec<Curve> = side.edges[k + 2..form.edges.len() - 1].iter().map(|e| e.1).collect();
    let [top, shoulder] = parted(&upper, underarm.0[0]);
    (SleeveShape { underarm, cuff, top }, shoulder)
}

/// The sleeve of a side as it is cut; none of a form without set-in sleeves.
pub(super) fn cut_sleeve(side: &Side, form: &Form) -> Option<SleeveShape> {
    lying_sleeve(side, form, form.underarm()?).0.straightened()
}

/// The sleeve as it lies, of that side; none of a form without set-in sleeves.
pub(super) fn lying_sleeve_of(fit: &Fit, form: &Form, side: usize) -> Option<SleeveShape> {
    Some(lying_sleeve(&Side::of(fit, form, Layer::Front, side), form, form.underarm()?).0)
}

/// From the armpit straight to the shoulder point, metres; none of a form without set-in sleeves.
pub(super) fn armhole(side: &Side, form: &Form) -> Option<f64> {
    let [armpit, shoulder] = lying_sleeve(side, form, form.underarm()?).0.ends()?;
    Some((shoulder - armpit).norm())
}

/// The upper border from cuff to neck, parted at the shoulder point.
fn parted(upper: &[Curve], armpit: Point2) -> [Vec<Curve>; 2] {
    let at = |s: f64| {
        let k = (s as usize).min(upper.len() - 1);
        upper[k].at(s - k as f64)
    };
    let out = SHOULDER * armpit.x;
    // Of a sleeve that hangs beside the body the border runs near the armpit.
    let is_far = |p: Point2| (p - armpit).norm() >= LEAST_ARMHOLE * armpit.x;
    // The template's own corner, where it lies near enough.
    let is_corner = |p: Point2| (p.x / out - 1.0).abs() < CORNER && is_far(p);
    if let Some(k) = (1..upper.len()).find(|k| is_corner(at(*k as f64))) {
        return [upper[..k].to_vec(), upper[k..].to_vec()];
    }
    let steps = 200 * upper.len();
    let along: Vec<f64> = (0..=steps).map(|k| k as f64 / 200.0).collect();
    let mut way = vec![0.0];
    for w in along.windows(2) {
        way.push(way[way.len() - 1] + (at(w[1]) - at(w[0])).norm());
    }
    let place = |share: f64| way.partition_point(|l| *l < share * way[steps]).min(steps);
    let is_beyond = |p: Point2| p.x <= out && is_far(p);
    let beyond = along.iter().position(|s| is_beyond(at(*s))).unwrap_or(steps);
    let s = along[beyond.clamp(place(ALONG[0]), place(ALONG[1]))];
    let k = (s as usize).min(upper.len() - 1);
    let [before, behind] = upper[k].parted(s - k as f64);
    let first = upper[..k].iter().copied().chain([before]).collect();
    [first, [behind].into_iter().chain(upper[k + 1..].iter().copied()).collect()]
}

fn arched(a: Point2, b: Point2) -> Curve {
    crate::style::block::template::bow::Bow { a, b, bow: ARMHOLE }.into()
}

/// The layer of a sleeve: underarm, cuff, top, cap. Its grain runs along it.
fn sleeve(side: &Side, edges: &[(EdgeRole, Run)], layer: Layer) -> Option<Flat> {
    let edges = side.alone(edges);
    let middle = |role: EdgeRole| {
        let Run::Cubic(c) = &edges.iter().find(|e| e.role == role)?.run else { return None };
        Some(nalgebra::center(&c.0[0], &c.0[3]))
    };
    let (cuff, cap) = (middle(EdgeRole::Cuff)?, middle(EdgeRole::Cap)?);
    let way = (cap - cuff).try_normalize(1e-9)?;
    Some(Flat {
        role: PieceRole::Sleeve(layer, side.hand),
        edges,
        lines: Vec::new(),
        origin: cap,
        turn: way.y.atan2(way.x) - std::f64::consts::FRAC_PI_2,
    })
}
