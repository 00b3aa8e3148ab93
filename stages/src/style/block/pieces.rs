//! From a fitted template to the pieces of a pattern, as they lie flat.
//!
//! Method: what the photo shows is kept edge by edge. A garment that is laid flat is two equal layers, so front and back are cut along the template's outline. Sleeves are
//! cut off along the armhole, which runs from armpit to shoulder point and is the sleeve's cap as well: both have one length. Each
//! layer of a sleeve is a piece, so that each shows its own photo. The shoulder point, which a flat shirt does not show, lies where the shoulder of a
//! block does: at 88 % of the chest's half (Aldrich 2008). So do the points of a fork, which lie folded (`leg`). Limits: a raglan sleeve is cut as a
//! set-in one.

use super::curve::Curve;
use super::fit::Fit;
use super::form::Form;
use nalgebra::Rotation2;
use toile_core::artifact::BodyPart;
use toile_core::prelude::*;

/// The shoulder point's distance from the axis, as a share of the armpit's.
const SHOULDER: f64 = 0.88;
/// And within these shares of the way from neck to cuff.
const ALONG: [f64; 2] = [0.25, 0.8];
/// Controls of an armhole, to the left of its chord, in chord lengths: it runs in below and up above.
const ARMHOLE: [f64; 2] = [0.18, 0.08];
/// The seat's height above the fork, as a share of the rise.
const SEAT: f64 = 0.35;
/// Both points of the fork, as a share of the seat's girth.
const FORK: f64 = 0.15;
/// Controls of the rise: how far down it is straight, as a share of it, and how far out it is there, of the point; and of the inseam below the
/// point.
const STRAIGHT: f64 = 0.7;
const HOLLOW: f64 = 0.15;
const INNER: f64 = 0.15;
/// Parts in which hem and neck are drawn.
const PARTS: usize = 24;

/// A piece in the frame of the garment's axis: u to the right as one looks at it, v up.
#[derive(Debug, Clone)]
pub(super) struct Flat {
    pub name: String,
    /// Its edges, counter-clockwise; each starts where the one before ends.
    pub edges: Vec<(String, Run)>,
    pub part: BodyPart,
    /// Where its own origin lies, and how far its own axes are turned, radians.
    pub origin: Point2,
    pub turn: f64,
}

/// How an edge runs.
#[derive(Debug, Clone)]
pub(super) enum Run {
    Cubic(Curve),
    /// Two curves that meet on the axis.
    Both([Curve; 2]),
}

impl Run {
    fn start(&self) -> Point2 {
        match self {
            Run::Cubic(c) | Run::Both([c, _]) => c.0[0],
        }
    }

    fn moved(&self, to: impl Fn(Point2) -> Point2) -> EdgeCurve {
        match self {
            Run::Cubic(Curve([_, b, c, _])) => EdgeCurve::Cubic { controls: [to(*b), to(*c)] },
            Run::Both([a, b]) => {
                let drawn = a.points(PARTS).into_iter().chain(b.points(PARTS).into_iter().skip(1));
                let inner: Vec<Point2> = drawn.map(to).collect();
                EdgeCurve::Polyline { points: inner[1..inner.len() - 1].to_vec() }
            }
        }
    }
}

impl Flat {
    /// The piece in its own coordinates; it stands nowhere yet.
    pub(super) fn piece(&self) -> Piece {
        let to = |p: Point2| Point2::from(Rotation2::new(-self.turn) * (p - self.origin));
        let edge = |(name, run): &(String, Run)| PieceEdge { name: name.clone(), curve: run.moved(to) };
        Piece {
            name: self.name.clone(),
            outer: PatternLoop {
                corners: self.edges.iter().map(|(_, run)| to(run.start())).collect(),
                edges: self.edges.iter().map(edge).collect(),
            },
            body_part: Some(self.part),
            ..Piece::default()
        }
    }
}

/// The layer of a garment: before the wearer or behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layer {
    Front,
    Back,
}

impl Layer {
    pub(super) fn word(self) -> &'static str {
        match self {
            Layer::Front => "front",
            Layer::Back => "back",
        }
    }

    /// The wearer's side that lies at positive u, or at negative.
    fn side(self, k: usize) -> &'static str {
        match (self, k) {
            (Layer::Front, 0) | (Layer::Back, 1) => "left",
            _ => "right",
        }
    }
}

/// One side of a template: its edges by name, as they lie (the second side's are mirrored back), each from below to above.
struct Side {
    edges: Vec<(&'static str, Curve)>,
    mirrored: bool,
    word: &'static str,
}

fn flip(p: Point2) -> Point2 {
    Point2::new(-p.x, p.y)
}

impl Side {
    fn of(fit: &Fit, form: &Form, layer: Layer, k: usize) -> Side {
        let names = form.edges.iter().map(|e| e.name);
        let edges = names.zip(fit.sides[k].iter().map(|b| Curve::from(*b))).collect();
        Side { edges, mirrored: k == 1, word: layer.side(k) }
    }

    /// A curve as it lies, so that loops run counter-clockwise.
    fn laid(&self, c: Curve) -> Curve {
        if self.mirrored { c.moved(flip).turned() } else { c }
    }

    /// Named edges as they lie and in counter-clockwise order, with the side's word.
    fn named(&self, edges: &[(&str, Curve)]) -> Vec<(String, Run)> {
        let one = |(name, c): &(&str, Curve)| (format!("{name}_{}", self.word), Run::Cubic(self.laid(*c)));
        let mut all: Vec<(String, Run)> = edges.iter().map(one).collect();
        if self.mirrored {
            all.reverse();
        }
        all
    }
}

/// The pieces of one layer.
pub(super) fn layer(fit: &Fit, form: &Form, layer: Layer) -> Vec<Flat> {
    let sides = [0, 1].map(|k| Side::of(fit, form, layer, k));
    if form.has_legs() {
        return sides.iter().map(|s| leg(s, layer)).collect();
    }
    let cut: Vec<Cutting> = sides.iter().map(|s| Cutting::of(s, form)).collect();
    let (first, last) = (0, form.edges.len() - 1);
    let both = |k: usize| [0, 1].map(|s: usize| sides[s].laid(sides[s].edges[k].1));
    let [right_hem, left_hem] = both(first);
    let [right_top, left_top] = both(last);
    let mut edges = sides[0].named(&cut[0].trunk);
    edges.push((form.edges[last].name.to_owned(), Run::Both([right_top, left_top])));
    edges.extend(sides[1].named(&cut[1].trunk));
    edges.push(("hem".to_owned(), Run::Both([left_hem, right_hem])));
    let trunk =
        Flat { name: layer.word().into(), edges, part: BodyPart::Body, origin: Point2::origin(), turn: 0.0 };
    let sleeves = sides.iter().zip(&cut).filter_map(|(s, c)| sleeve(s, c.sleeve.as_ref()?, layer));
    std::iter::once(trunk).chain(sleeves).collect()
}

/// A side's edges between hem and neck, and its sleeve's.
struct Cutting {
    trunk: Vec<(&'static str, Curve)>,
    sleeve: Option<[Curve; 4]>,
}

impl Cutting {
    fn of(side: &Side, form: &Form) -> Self {
        let last = form.edges.len() - 1;
        let Some(k) = form.underarm() else {
            return Cutting { trunk: side.edges[1..last].to_vec(), sleeve: None };
        };
        let (underarm, cuff, top) = (side.edges[k].1, side.edges[k + 1].1, side.edges[k + 2].1);
        let armpit = underarm.0[0];
        let [above, shoulder] = top.parted(shoulder_at(&top, armpit));
        let armhole = arched(armpit, above.0[3]);
        let mut trunk = side.edges[1..k].to_vec();
        trunk.extend([("armhole", armhole), ("shoulder", shoulder)]);
        Cutting { trunk, sleeve: Some([underarm, cuff, above, armhole.turned()]) }
    }
}

/// Where the shoulder point lies on the upper edge, which runs from cuff to neck.
fn shoulder_at(top: &Curve, armpit: Point2) -> f64 {
    let steps = 200;
    let at = |k: usize| k as f64 / f64::from(steps);
    let beyond = (0..=steps as usize).map(at).find(|t| top.at(*t).x <= SHOULDER * armpit.x);
    beyond.unwrap_or(1.0).clamp(1.0 - ALONG[1], 1.0 - ALONG[0])
}

fn arched(a: Point2, b: Point2) -> Curve {
    super::bow::Bow { a, b, bow: ARMHOLE }.into()
}

/// The layer of a sleeve: underarm, cuff, top, cap. Its grain runs along it.
fn sleeve(side: &Side, curves: &[Curve; 4], layer: Layer) -> Option<Flat> {
    let middle = |c: &Curve| nalgebra::center(&c.0[0], &c.0[3]);
    let (cuff, cap) = (side.laid(curves[1]), side.laid(curves[3]));
    let way = (middle(&cap) - middle(&cuff)).try_normalize(1e-9)?;
    let named: Vec<(&str, Curve)> = ["underarm", "cuff", "top", "cap"].into_iter().zip(*curves).collect();
    let mut edges: Vec<(String, Run)> =
        named.iter().map(|(name, c)| ((*name).to_owned(), Run::Cubic(side.laid(*c)))).collect();
    if side.mirrored {
        edges.reverse();
    }
    Some(Flat {
        name: format!("{}_sleeve_{}", side.word, layer.word()),
        edges,
        part: BodyPart::Arm,
        origin: middle(&cap),
        turn: way.y.atan2(way.x) - std::f64::consts::FRAC_PI_2,
    })
}

/// The layer of a leg: inseam, hem, outseam, waist, and the rise along the middle of the garment.
///
/// Trousers that lie flat hide what goes between the legs: the points of the fork lie folded under the other leg. A block gives them 15 % of the
/// seat's girth, a third of it before and two behind (Aldrich 2008); what the fork shows beyond the seat's width is part of it.
fn leg(side: &Side, layer: Layer) -> Flat {
    let edge = |name: &str| side.edges.iter().find(|e| e.0 == name).map(|e| e.1);
    let (low, high) = (side.edges[0].1.0[0], side.edges[side.edges.len() - 1].1.0[3]);
    let width = |share: f64| {
        let y = low.y + share * (high.y - low.y);
        let sides = ["outseam", "hip"].into_iter().filter_map(edge);
        // The one that passes there; at the corner between them both do.
        let passes = |c: &Curve| (c.0[0].y - y) * (c.0[3].y - y) <= 0.0;
        let mut all: Vec<Curve> = sides.collect();
        all.sort_by_key(|c| !passes(c));
        all.first().map_or(0.0, |c| at_height(c, y))
    };
    let (seat, fork) = (width(SEAT) - low.x, width(0.0) - low.x);
    let hidden = (FORK * 4.0 * seat - 2.0 * (fork - seat).max(0.0)).max(0.0);
    let point = match layer {
        Layer::Front => hidden / 3.0,
        Layer::Back => hidden * (2.0 / 3.0),
    };
    let out = |share: f64| Vector2::new(-share * point, 0.0);
    let tip = low + out(1.0);
    // Straight down, then out to the point.
    let rise = Curve([high, high + (low - high) * STRAIGHT, low + out(HOLLOW), tip]);
    let all = side.edges.iter().copied().chain([("rise", rise)]);
    let all = all.map(|(name, c)| match name {
        "inseam" => (name, Curve([tip, c.0[1] + out(INNER), c.0[2], c.0[3]])),
        _ => (name, c),
    });
    let mut edges: Vec<(String, Run)> =
        all.map(|(name, c)| (name.to_owned(), Run::Cubic(side.laid(c)))).collect();
    if side.mirrored {
        edges.reverse();
    }
    Flat {
        name: format!("{}_leg_{}", side.word, layer.word()),
        edges,
        part: BodyPart::Leg,
        origin: Point2::origin(),
        turn: 0.0,
    }
}

/// How far out a curve lies at a height: where it passes it, or its end that is nearer.
fn at_height(c: &Curve, y: f64) -> f64 {
    let points = c.points(PARTS);
    let passes = points.windows(2).find(|w| (w[0].y - y) * (w[1].y - y) <= 0.0 && w[0].y != w[1].y);
    let nearer =
        || points.iter().min_by(|a, b| (a.y - y).abs().total_cmp(&(b.y - y).abs())).map_or(0.0, |p| p.x);
    passes.map_or_else(nearer, |w| w[0].x + (w[1].x - w[0].x) * (y - w[0].y) / (w[1].y - w[0].y))
}
