//! `Fitting`: a mannequin that the photographed garment fits.
//!
//! Method: the block that is cut is fitted to the outline ([`crate::style::block::template::fit`])
//! and measured as a tailor measures a garment that lies flat. Of the sizes of a table, from a
//! child of 80 cm to an adult, the one is taken whose girths, with the usual ease, and whose
//! height, with the usual length of such a garment, lie nearest. The arms are spread as the sleeves
//! hang. Cost: a fit of the block, a tenth of a second a form, and a mannequin. Limits: lengths of
//! skirts, shorts and vests tell little, so that a short garment with few girths may fit several
//! sizes; the body is a woman's or a child's.

use super::elastic::is_drawn_in;
use super::likely::SeenPhoto;
use super::pieces;
use super::wearable::{KEPT, NARROWEST};
use super::{Block, BlockStyle, FRONT, Fitted, Front, Sides, Waist, refusal};
use crate::style::block::template::complete::Complete;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::flat::Side;
use crate::style::block::template::form::Form;
use crate::style::block::template::piece_role::Layer;
use crate::style::block::template::said;
use std::collections::BTreeMap;
use toile_body::Mannequin;
use toile_core::param::{ron_options, ron_text};
use toile_core::prelude::*;
use toile_core::{Node, StageMeta};

/// Height, bust, waist and hip, cm: children by EN 13402-3, adults in its steps of 4 to 6 cm of
/// bust.
pub(super) const SIZES: [[f64; 4]; 26] = [
    [80.0, 49.0, 47.0, 49.0],
    [86.0, 51.0, 48.5, 51.0],
    [92.0, 53.0, 50.0, 53.0],
    [98.0, 55.0, 51.5, 55.5],
    [104.0, 57.0, 53.0, 58.0],
    [110.0, 59.0, 54.0, 61.0],
    [116.0, 61.0, 55.5, 64.0],
    [122.0, 63.0, 57.0, 67.0],
    [128.0, 66.0, 58.5, 70.0],
    [134.0, 69.0, 60.0, 73.0],
    [140.0, 72.0, 61.5, 77.0],
    [146.0, 76.0, 63.5, 81.0],
    [152.0, 80.0, 65.5, 85.0],
    [158.0, 83.0, 67.5, 89.0],
    [164.0, 80.0, 64.0, 88.0],
    [166.0, 84.0, 68.0, 92.0],
    [168.0, 88.0, 72.0, 96.0],
    [168.0, 92.0, 76.0, 100.0],
    [168.0, 96.0, 80.0, 104.0],
    [168.0, 100.0, 84.0, 108.0],
    [168.0, 104.0, 88.0, 112.0],
    [168.0, 110.0, 94.0, 117.0],
    [168.0, 116.0, 100.0, 122.0],
    [168.0, 122.0, 106.0, 127.0],
    [168.0, 128.0, 112.0, 132.0],
    [170.0, 134.0, 118.0, 137.0],
];

/// Usual share of a girth of the body by which a garment is wider there, and its spread: at chest,
/// waist and hip. Skirts may be as wide at the hip as they like: there only what is narrower
/// counts. Legs may be wide there, but a wearer whom they fit is likelier: that is their spread.
const EASE: [[f64; 2]; 3] = [[0.09, 0.06], [0.04, 0.06], [0.03, 0.06]];
const HIP: usize = 2;
const WAIST: usize = 1;
const WIDE_HIP: f64 = 0.12;
/// Spreads of the hip of shorts, whose legs may flare, where it is wide, and of any legs where it
/// is narrow: what goes between the legs gives no way.
const WIDE_SHORTS: f64 = 0.2;
const NARROW_LEGS: f64 = 0.03;
/// Trousers sit at the waist or lower, down to the hip: there their waist is wider.
const LOW_WAIST: f64 = 0.15;
/// Hips of people of one size differ by this share: trousers are worn by one whose hips are so much
/// wider where they are cut for them.
const HIPS: f64 = 0.05;
/// A height that is likely, cm, and its spread: it decides where a garment fits a child and an
/// adult.
const LIKELY: [f64; 2] = [165.0, 60.0];
/// A bust that is likely of an adult, cm, and the spread of larger ones: it decides between sizes
/// where a garment tells little of its wearer.
const LIKELY_BUST: [f64; 2] = [92.0, 30.0];
/// Usual length of a garment from neck or waist to hem, of one-pieces from neck to fork, as a share
/// of the body's height, and its spread.
const TOP: [f64; 2] = [0.39, 0.05];
const TRUNK: [f64; 2] = [0.47, 0.02];
const DRESS: [f64; 2] = [0.56, 0.1];
const LEGS: [f64; 2] = [0.60, 0.04];
/// Legs whose inseam is shorter than this share of their outseam are shorts, whose length tells
/// little.
const SHORTS: f64 = 0.55;
/// A sleeve's length along its top from the neck, as a share of the height, where it reaches the
/// wrist.
const SLEEVE: [f64; 2] = [0.44, 0.04];
/// What a single figure adds at most; one that is too small counts more, since no one wears it.
const MOST: f64 = 9.0;
const MOST_NARROW: f64 = 36.0;
/// What a size adds that is too large to wear the garment at all.
const REFUSED: f64 = 100.0;
/// A mean square beyond this is told: no body of the table wears it as usual.
const ODD: f64 = 5.0;
/// No garment is wider around chest or waist, or longer, metres: half as much again as the largest
/// sizes that are sold.
const LARGEST: [f64; 2] = [3.0, 2.5];
/// Arms where nothing tells how they lie, degrees from the vertical.
const ARMS: f64 = 45.0;
/// The least angle that a mannequin's arms have, degrees from the vertical.
const LEAST_ARM_ANGLE: f64 = 30.0;
/// The greatest angle that a mannequin's arms have, degrees from the vertical.
const GREATEST_ARM_ANGLE: f64 = 75.0;
/// A trunk that lies flat is half its girth wide; worn, it is an ellipse about 0.7 times as deep as
/// wide, and its armpits lie nearer to the axis by this share.
const CLOSED: f64 = 0.26;
/// Arms that touch the trunk are spread by so much more, degrees.
const SPREAD: f64 = 4.0;

/// A mannequin that the photographed garment fits: child or adult, its arms spread as the sleeves
/// hang.
///
/// Takes the outline of the photo `front` and its scale. The size that is taken is told, with what
/// it was taken for. State a body of your own where you know the wearer.
#[stage(
    role = Body,
    version = 12,
    source = "sizes: EN 13402-3:2017; ease and lengths: Aldrich 2008",
    example = "Fitting()",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Fitting {
    /// What the garment is.
    #[param(default = BlockStyle::Auto)]
    pub(super) style: BlockStyle,
    /// Whether the half that the frame cuts is measured by the other one, as `Block` cuts it.
    #[param(default = Complete::Mirror)]
    pub(super) complete: Complete,
    /// Length of the mesh's edges; small bodies get shorter ones.
    #[param(default = Length::mm(16.0), min = 0.006, max = 0.022, trades, finer = "less")]
    pub(super) edge: Length,
    /// Whether a network looks at the photo, too, as in `Block`.
    #[param(default = true)]
    pub(super) network: bool,
    /// Where a person sees landmarks in the photo of the front, as in `Block`: the garment is
    /// measured between them.
    #[param(default = BTreeMap::new(), min = 0.0, max = 1.0)]
    pub(super) landmarks: BTreeMap<String, (f64, f64)>,
}

#[stage]
impl Fitting {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        #[original] photos: Option<Set<Photo>>,
        cx: &Context,
    ) -> Result<Body, StageError> {
        let front = outlines.get(FRONT).ok_or_else(refusal::no_front)?;
        let photo = photos.as_ref().and_then(|all| all.get(FRONT));
        let photo = photo.map(|photo| SeenPhoto::of(photo, self.network)).transpose()?;
        let forms = said::with_all(self.style.forms(), &self.landmarks)?;
        let fitted = |stray, complete| {
            let block = Block {
                style: self.style,
                stray,
                complete,
                sides: Sides::Alike,
                waist: Waist::Plain,
                front: Front::Whole,
                network: self.network,
                landmarks: self.landmarks.clone(),
            };
            block.fitted(FRONT, front, photo.as_ref(), forms.clone(), &cx.for_entry(FRONT))
        };
        let other = match self.complete {
            Complete::Nothing => Complete::Mirror,
            Complete::Mirror => Complete::Nothing,
        };
        // What is measured is what is cut. Whether the garment is what it is said to be is the
        // style's affair: what it would refuse is measured all the same.
        let as_cut = fitted(Block::default().stray, self.complete);
        let (_, form, Fitted { fit, .. }) = match self.style {
            BlockStyle::Auto => as_cut.map_err(say)?,
            _ => as_cut
                .or_else(|_| fitted(Block::default().stray, other))
                .or_else(|_| fitted(f64::INFINITY, Complete::Mirror))
                .or_else(|_| fitted(f64::INFINITY, Complete::Nothing))?,
        };
        let tape = Tape::of(form, &fit);
        tape.tell(cx);
        tape.worn_by_someone(form.word)?;
        let cost = |s: &[f64; 4]| tape.cost(s);
        let best = SIZES.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(&SIZES[16]);
        let [height, bust, waist, usual] = *best;
        // The hips of shorts may flare, and tell less.
        let is_long = form.has_legs() && tape.length.is_some();
        let cut_for = tape.girths[HIP].filter(|_| is_long).map(|g| g * 100.0 / (1.0 + EASE[HIP][0]));
        let hip = cut_for.map_or(usual, |h| h.clamp(usual, (1.0 + HIPS) * usual));
        cx.note(format!(
            "worn by a mannequin of {height:.0} cm, bust {bust:.0}, waist {waist:.0}, hip {hip:.0} cm: {} fits it",
            tape.words()
        ));
        if cost(best) > ODD {
            cx.warn(
                "no size wears it as such a garment is worn: is the stated width right? It gives the scale",
            );
        }
        let girths = [bust, waist, hip].map(|g| g / 100.0);
        let arms = arms(form, &fit).clamp(LEAST_ARM_ANGLE, GREATEST_ARM_ANGLE);
        let mut body = mannequin(height / 100.0, girths, arms, self.edge.metres(), cx)?;
        body.measurements.extend(tape.kept());
        Ok(body)
    }

    /// A style that is cut as another kind than is measured.
    fn warnings(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let block = |n: &Node| {
            let params = (n.card.name == Block::NAME).then(|| n.stage.params())?;
            ron_options().from_str::<Block>(&params).ok()
        };
        let Some(block) = placed.nodes.iter().find_map(block) else { return Vec::new() };
        let set = |what: String, param: &'static str, value: &str| {
            StageError::invalid(what).hint(format!("say it to both: --set 'body.{param}={value}'")).at(param)
        };
        let mut all = Vec::new();
        if block.style != BlockStyle::Auto && block.style != self.style {
            let measured = match self.style {
                BlockStyle::Auto => "what it finds itself".to_owned(),
                named => format!("`{}`", named.name()),
            };
            let cut = block.style.name();
            all.push(set(format!("`style` cuts `{cut}`, and `body` measures {measured}"), "style", cut));
        }
        if block.complete != self.complete {
            let [cut, measured] = [block.complete, self.complete].map(Complete::name);
            let what = format!("`style` completes `{cut}`, and `body` measures with `complete: {measured}`");
            all.push(set(what, "complete", cut));
        }
        if block.landmarks != self.landmarks {
            let what = "`style` is cut by other `landmarks` than `body` measures by".to_owned();
            let said = ron_text(&block.landmarks);
            let hint = format!("say the same to both: --set 'body.landmarks={said}'");
            all.push(StageError::invalid(what).hint(hint).at("landmarks"));
        }
        all
    }

    /// Landmarks that no garment has.
    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        said::known(&self.landmarks).err().into_iter().collect()
    }
}

/// A mannequin of that height and girths, metres. Arms that hang near a wide trunk touch it: then
/// they are spread further than `arms`, degrees.
pub(super) fn mannequin(
    height: f64,
    girths: [f64; 3],
    arms: f64,
    edge: f64,
    cx: &Context,
) -> Result<Body, StageError> {
    let made = Mannequin::made(height, girths, arms, edge).run(cx);
    match made {
        Err(_) if arms < GREATEST_ARM_ANGLE => {
            cx.check()?;
            mannequin(height, girths, (arms + SPREAD).min(GREATEST_ARM_ANGLE), edge, cx)
        }
        done => done,
    }
}

/// The refusal, with how to say what the garment is.
fn say(e: StageError) -> StageError {
    let lay = e.hint.clone().unwrap_or_default();
    if lay.contains("say what it is") {
        return e;
    }
    e.hint(format!("{lay}; or say what it is: --set 'style.style=Vest' --set 'body.style=Vest'"))
}

/// A garment's measures, metres.
#[derive(Debug, Default)]
struct Tape {
    /// Around chest, waist and hip.
    girths: [Option<f64>; 3],
    /// Its length, and what is usual of it.
    length: Option<(f64, [f64; 2])>,
    /// From the neck to the wrist.
    sleeve: Option<f64>,
    /// Whether it has two legs.
    has_legs: bool,
    /// Around the hem of what hangs from the neck: it goes around the hip, or above it.
    hem: Option<f64>,
}

impl Tape {
    fn of(form: &Form, fit: &Fit) -> Self {
        let at = |role| form.at(role);
        let across = |k: usize| 2.0 * fit.sides.iter().map(|s| s[k].a.x).sum::<f64>();
        let mean = |of: &dyn Fn(&[crate::style::block::template::bow::Bow]) -> f64| {
            0.5 * fit.sides.iter().map(|s| of(s)).sum::<f64>()
        };
        let high = mean(&|s| s[s.len() - 1].a.y);
        let low = mean(&|s| s[0].a.y);
        let chest = fit.chest(form);
        // Skirts and legs begin at the waist; of a dress it is where the skirt ends.
        let waist = at(EdgeRole::Waist).map(across).or_else(|| at(EdgeRole::Skirt).map(|k| across(k + 1)));
        let hip = fit.hip(form);
        // What an elastic draws in tells nothing of who wears it.
        let waist = waist.filter(|w| !hip.is_some_and(|hip| is_drawn_in(form, *w, hip)));
        let hangs = form.hangs_from_neck();
        let length = match [EdgeRole::Skirt, EdgeRole::Inseam, EdgeRole::Outseam].map(at) {
            [Some(_), ..] if hangs => Some((high - low, DRESS)),
            [None, Some(_), _] if hangs => Some((high - low, TRUNK)),
            [None, None, _] if hangs => Some((high - low, TOP)),
            [_, Some(inseam), Some(outseam)] => {
                let upper = at(EdgeRole::Hip).map_or(0.0, |k| mean(&|s| s[k].length()));
                let [inner, outer] = [inseam, outseam].map(|k| mean(&|s| s[k].length()));
                let outer = outer + upper;
                (inner > SHORTS * outer).then_some((outer, LEGS))
            }
            _ => None,
        };
        let is_long = form.underarm().is_some_and(|k| form.edges[k].chord[0] > 0.4);
        let along = |s: &[crate::style::block::template::bow::Bow], k: usize| {
            s[k].length() + s[k + 1].length() + s[k + 1].b.x
        };
        let sleeve = at(EdgeRole::Top).filter(|_| is_long).map(|k| mean(&|s| along(s, k)));
        let is_top = hangs && at(EdgeRole::Skirt).is_none();
        let hem = at(EdgeRole::Hem).filter(|k| is_top && *k == 0).map(|k| across(k + 1));
        Tape { girths: [chest, waist, hip], length, sleeve, has_legs: form.has_legs(), hem }
    }

    /// How far a size is from wearing it as usual: the mean square of what is measured, in spreads.
    fn cost(&self, [height, bust, waist, hip]: &[f64; 4]) -> f64 {
        let body = [bust, waist, hip];
        let girth = |k: usize| {
            let off = self.girths[k]? * 100.0 / body[k] - 1.0 - EASE[k][0];
            Some(match (k, off > 0.0, self.has_legs) {
                (HIP, true, true) if self.length.is_none() => off / WIDE_SHORTS,
                (HIP, true, true) => off / WIDE_HIP,
                (HIP, true, false) => 0.0,
                (HIP, false, true) => off / NARROW_LEGS,
                (WAIST, true, true) => off / LOW_WAIST,
                _ => off / EASE[k][1],
            })
        };
        let long = self.length.map(|(l, [usual, spread])| (l * 100.0 / height - usual) / spread);
        let sleeve = self.sleeve.map(|l| (l * 100.0 / height - SLEEVE[0]) / SLEEVE[1]);
        let tight = |x: f64| (x * x).min(if x < 0.0 { MOST_NARROW } else { MOST });
        let girths = (0..3).filter_map(girth).map(tight);
        // Legs that are longer than the wearer's lie on the floor.
        let length = |x: f64| (x * x).min(if x > 0.0 && self.has_legs { MOST_NARROW } else { MOST });
        let lengths = long.map(length).into_iter().chain(sleeve.map(|x| (x * x).min(MOST)));
        let all: Vec<f64> = girths.chain(lengths).collect();
        // A hem above the hip may be as wide as it likes: it counts where it is narrower.
        let hem = self.hem.map_or(0.0, |hem| tight((hem * 100.0 / hip - 1.0).min(0.0) / EASE[HIP][1]));
        let is_too_small = |k: usize| self.girths[k].is_some_and(|g| g * 100.0 < NARROWEST * body[k]);
        let refused = if (0..3).any(is_too_small) { REFUSED } else { 0.0 };
        let height = (height - LIKELY[0]) / LIKELY[1];
        let large = ((bust - LIKELY_BUST[0]) / LIKELY_BUST[1]).max(0.0);
        let prior = height * height + large * large;
        (all.iter().sum::<f64>() + hem) / all.len().max(1) as f64 + prior + refused
    }

    /// Errors: the garment is larger than any that is worn, and so is the stated width.
    fn worn_by_someone(&self, word: &str) -> Result<(), StageError> {
        let girth = self.girths[..HIP].iter().flatten().copied().fold(0.0, f64::max);
        let length = self.length.map_or(0.0, |(l, _)| l);
        if girth <= LARGEST[0] && length <= LARGEST[1] {
            return Ok(());
        }
        let measured = self.words();
        let measured = measured.trim_start_matches("a garment of ");
        Err(StageError::invalid(format!("no one wears {word} of {measured}"))
            .hint("the photo's `width` gives the scale: it is the garment's own, from its leftmost to its rightmost point, such as \"76 cm\""))
    }

    /// The garment's measures as figures, cm: around chest, waist and hip, its length, and from the
    /// neck to the wrist.
    fn tell(&self, cx: &Context) {
        let girths = ["chest", "waist", "hip"].into_iter().zip(self.girths);
        let lengths = [("length", self.length.map(|(l, _)| l)), ("sleeve", self.sleeve)];
        for (name, metres) in girths.chain(lengths).filter_map(|(name, m)| Some((name, m?))) {
            cx.figure(name, metres * 100.0, "cm");
        }
    }

    /// The girths under their names in a body.
    fn kept(&self) -> impl Iterator<Item = (String, f64)> + '_ {
        KEPT.iter().zip(self.girths).filter_map(|(name, girth)| Some(((*name).to_owned(), girth?)))
    }

    /// What was measured.
    fn words(&self) -> String {
        let cm = |m: f64| format!("{:.0} cm", m * 100.0);
        let girth = |(k, what): (usize, &str)| self.girths[k].map(|g| format!("{} around the {what}", cm(g)));
        let girths = ["chest", "waist", "hip"].into_iter().enumerate().filter_map(girth);
        let length = self.length.map(|(l, _)| format!("{} long", cm(l)));
        let all: Vec<String> = girths.chain(length).collect();
        format!("a garment of {}", all.join(", "))
    }
}

/// The angle from the vertical at which arms leave cuffs of grown-on sleeves: square to them;
/// degrees.
fn out(fit: &Fit, cuff: usize) -> f64 {
    let angle = |s: &Vec<crate::style::block::template::bow::Bow>| {
        let along = s[cuff].b - s[cuff].a;
        along.y.atan2(along.x).to_degrees()
    };
    0.5 * fit.sides.iter().map(angle).sum::<f64>()
}

/// The angle of the arms from the vertical at which the sleeves hang: the mean of both, from cap to
/// cuff; degrees. As the trunk takes its depth, its armpits come inwards and the points of its
/// shoulders do not: caps turn, and sleeves hang lower than they lie.
fn arms(form: &Form, fit: &Fit) -> f64 {
    if form.underarm().is_none() {
        return form.at(EdgeRole::Cuff).map_or(ARMS, |k| out(fit, k));
    }
    let from_vertical = |way: Vector2| way.x.atan2(-way.y).to_degrees();
    let angle = |side: usize| {
        let cut = pieces::cut_sleeve(&Side::of(fit, form, Layer::Front, side), form)?;
        let [armpit, shoulder] = cut.ends()?;
        let worn = Point2::new(armpit.x * (1.0 - CLOSED), armpit.y);
        let turn = from_vertical(armpit - shoulder) - from_vertical(worn - shoulder);
        Some(from_vertical(cut.way()?) - turn)
    };
    let both: Vec<f64> = (0..2).filter_map(angle).collect();
    both.iter().sum::<f64>() / both.len().max(1) as f64
}
