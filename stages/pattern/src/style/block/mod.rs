//! `Block`: a garment template fitted to the outline of a flat garment, cut into the pieces of a
//! sewing pattern.
//!
//! [`apart`] opens the outline between limbs that touch, [`form`] says which edges a garment has,
//! [`segment`] finds them on each half of the outline, [`fit`] lays the whole template over the
//! whole outline, [`stance`] stands spread legs under the hips, [`pieces`] cuts it, [`sleeve`]
//! straightens long sleeves, [`waist`] gathers a skirt to a band or lays it in pleats
//! ([`pleat`]), [`front`] cuts a front in halves, [`hood`] cuts a hood, [`seams`] sews it,
//! [`stand`] puts it around the body, if one can wear it ([`wearable`]); [`fitting`] finds a body
//! that can. Cost: a tenth of a second a form.

mod apart;
mod elastic;
mod fitting;
mod front;
mod hood;
mod lay;
mod leftover;
mod leg;
mod likely;
mod pieces;
mod pleat;
mod refusal;
mod seams;
mod sleeve;
mod stand;
mod tell;
pub(super) mod template;
#[cfg(test)]
mod tests;
mod waist;
mod wearable;

pub use fitting::Fitting;
use front::Front;
pub(super) use lay::Fitted;
use lay::{mirrored, pattern};
use leftover::Leftover;
pub use likely::seen_styles;
use likely::{Likely, SeenPhoto};
use pieces::Making;
use rayon::prelude::*;
pub(super) use refusal::{LAY, no_front};
pub(super) use stand::Stand;
pub(crate) use stand::{TRUNK_BOTTOM, TRUNK_TOP};
use std::collections::BTreeMap;
use tell::at_95;
pub use template::alike::Sides;
pub use template::complete::Complete;
use template::fit::{Fit, Halves, fits};
use template::form::{Form, Mark};
use template::halves::Upright;
use template::marks::missing;
pub(super) use template::piece_role::Layer;
pub use template::places::{PhotoLandmark, landmarks};
use template::said::SaidCorners;
use template::seen::{CornerPull, SeenCorners};
use toile_core::prelude::*;
pub use waist::Waist;
pub(super) use wearable::{check as check_wearable, ellipse};

/// The photos that a block is cut from.
const FRONT: &str = Layer::Front.word();
const BACK: &str = Layer::Back.word();

/// The share of the limit for a garment of which nobody has said what it is: a top whose sleeves
/// lie against it looks a little like a skirt.
const UNSAID: f64 = 0.5;

/// What corners that lie elsewhere than the network sees them add to the score of a fit, for each
/// squared spread.
const LANDMARKS: f64 = 0.3;

/// What opening an outline adds to the score of a fit: a slit is no fork.
const OPENED: f64 = 0.4;
/// What ground within an outline adds, for each whole of its area.
const GROUND: f64 = 10.0;

/// What a template without sleeves of their own adds for each sleeve that the network sees lie
/// against the body.
const SLEEVE_SEEN: f64 = 0.4;

/// And for a template that is judged by one half: there is less to tell it by.
const HALF: f64 = 0.7;

/// The share of the points of a half that must lie at the mirror image of the other, where the
/// template is judged by that one.
const OTHER: f64 = 0.5;

/// What the garment is.
#[choice]
#[derive(Copy, Eq)]
pub enum BlockStyle {
    /// Found by the outline.
    Auto,
    /// No sleeves: vest, tank, strap top.
    Vest,
    /// Short sleeves.
    TShirt,
    /// Sleeves beyond the elbow.
    LongSleeve,
    /// Sleeves beyond the elbow, and a hood that lies above the shoulders.
    Hooded,
    /// No sleeves, and a skirt from the waist.
    Dress,
    /// A dress with sleeves.
    SleevedDress,
    /// Sleeves cut in one with front and back: batwing, cap sleeves.
    GrownSleeve,
    /// From waist to hem.
    Skirt,
    /// Two legs, long or short.
    Trousers,
    /// Legs and a top with sleeves in one.
    Onepiece,
    /// Legs and a top without sleeves in one.
    SleevelessOnepiece,
}

impl BlockStyle {
    /// All that can be named, with their forms.
    const NAMED: [(BlockStyle, &'static str, &'static Form); 11] = [
        (BlockStyle::Vest, "Vest", &template::form::VEST),
        (BlockStyle::TShirt, "TShirt", &template::form::TEE),
        (BlockStyle::LongSleeve, "LongSleeve", &template::form::LONG),
        (BlockStyle::Hooded, "Hooded", &template::form::HOODED),
        (BlockStyle::Dress, "Dress", &template::form::DRESS),
        (BlockStyle::SleevedDress, "SleevedDress", &template::form::SLEEVED),
        (BlockStyle::GrownSleeve, "GrownSleeve", &template::form::GROWN),
        (BlockStyle::Skirt, "Skirt", &template::form::SKIRT),
        (BlockStyle::Trousers, "Trousers", &template::form::TROUSERS),
        (BlockStyle::Onepiece, "Onepiece", &template::form::ONEPIECE),
        (BlockStyle::SleevelessOnepiece, "SleevelessOnepiece", &template::form::ROMPER),
    ];

    /// As it is written.
    fn name(self) -> &'static str {
        Self::NAMED.iter().find(|(style, ..)| *style == self).map_or("Auto", |(_, name, _)| name)
    }

    /// The forms that come into question, with their names.
    fn forms(self) -> Vec<(&'static str, &'static Form)> {
        let asked = |s: &BlockStyle| self == BlockStyle::Auto || *s == self;
        Self::NAMED.into_iter().filter(|(s, ..)| asked(s)).map(|(_, name, form)| (name, form)).collect()
    }
}

/// Cuts a sewing pattern to the outline of a garment that lies flat.
///
/// A template with a garment's landmarks (a block) is fitted to the whole outline by least squares,
/// as symmetric about its own axis as the outline lets it be, so that rags and small folds do
/// little and a garment that lies askew is straightened. The pieces are front and back, and sleeves
/// that are set into armholes of their caps' length. How far the outline strays from the template
/// is told by edges. Needs the photo `front`; without one of the back, the back is cut as the front
/// is. `Arrange` puts the pieces around the body.
#[stage(
    role = Style,
    version = 12,
    source = "fitting: Chen and Medioni 1992, Geman and McClure 1985; blocks: Aldrich 2008",
    example = "Block(style: TShirt)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Block {
    /// What the garment is.
    #[param(default = BlockStyle::Auto)]
    style: BlockStyle,
    /// How far the outline may stray from the template, as a share of the garment's size (the root
    /// of its area); 19 of 20 of its points lie nearer. Half of it where the outline alone tells
    /// what the garment is.
    #[param(default = 0.05, min = 0.001, max = 0.5)]
    stray: f64,
    /// Whether the half that the frame cuts is completed by the mirror image of the other. The
    /// binariser must let the garment touch the frame for it, as `Auto` does.
    #[param(default = Complete::Mirror)]
    complete: Complete,
    /// Whether both halves are cut as each other's mirror image, sleeves as the one that lies
    /// better, or each as it lies.
    #[param(default = Sides::Alike)]
    sides: Sides,
    /// How a skirt is held at the waist.
    #[param(default = Waist::Plain)]
    waist: Waist,
    /// Whether the front is one piece, or two halves that are closed along the middle.
    #[param(default = Front::Whole)]
    front: Front,
    /// Whether a network looks at the photo, too: at what the garment is, where nobody says it, and
    /// at where sleeves and legs end that lie against the rest.
    #[param(default = true)]
    network: bool,
    /// Where a person sees landmarks in the photo of the front, as shares of its width and height
    /// from its top left corner: `{"armpit_left": (0.7, 0.42)}`. Each is held at the nearest place
    /// of the outline; left and right are the wearer's. There are `neck`, `shoulder`, `armpit`,
    /// `waist`, `hip` and `hem` with `_left` or `_right`, `cuff_left_outer`, `cuff_left_inner`,
    /// `leg_left_outer`, `leg_left_inner`, the same with `right`, and `fork`, of which a garment
    /// has its own. In the photo of the back: `back.armpit_left`. One that is said of one side
    /// alone holds for both where they are cut alike.
    #[param(default = BTreeMap::new(), min = 0.0, max = 1.0)]
    landmarks: BTreeMap<String, (f64, f64)>,
}

#[stage]
impl Block {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        body: &Body,
        #[original] photos: Option<Set<Photo>>,
        cx: &Context,
    ) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
        let front = outlines.get(FRONT).ok_or_else(refusal::no_front)?;
        for (name, _) in outlines.iter().filter(|(n, _)| *n != FRONT && *n != BACK) {
            cx.warn(format!("a block is cut from \"front\" and \"back\"; the photo \"{name}\" is not used"));
        }
        let photo = |name: &str| {
            let photo = photos.as_ref().and_then(|all| all.get(name).or_else(|| all.get(FRONT)));
            photo.map(|photo| SeenPhoto::of(photo, self.network)).transpose()
        };
        let seen = photo(FRONT)?;
        let forms = template::said::with_all(self.style.forms(), &self.landmarks)?;
        let found = self.fitted(FRONT, front, seen.as_ref(), forms, cx)?;
        self.tell(FRONT, front, &found, cx);
        self.explains(FRONT, &found, cx)?;
        let (name, form, before) = found;
        if self.style == BlockStyle::Auto {
            cx.note(format!(
                "\"front\" is taken for {}; to say what it is: --set 'style.style={name}'",
                form.word
            ));
        }
        let mut before = before;
        for (what, [lies, cut]) in elastic::all_stretched(&mut before.fit, form, body) {
            cx.note(format!(
                "{what} measures {:.0} cm around as it lies: it is cut {:.0} cm wide, as its wearer needs it",
                lies * 100.0,
                cut * 100.0
            ));
        }
        for (what, by) in elastic::all_shortened(&mut before.fit, form, body) {
            cx.note(format!("{:.0} cm are cut off {what}", by * 100.0));
        }
        check_wearable(name, form, &before.fit, body, seen.as_ref().map(|s| s.photo))?;
        let behind = match outlines.get(BACK).filter(|back| !lay::is_mirrored(back, front)) {
            None => {
                template::said::none_of(BACK, &self.landmarks)?;
                let frame = outlines.get(BACK).map_or_else(|| mirrored(front).frame, |back| back.frame);
                before.mirrored(frame)
            }
            Some(back) => {
                let found = self.fitted(BACK, back, photo(BACK)?.as_ref(), vec![(name, form)], cx)?;
                self.tell(BACK, back, &found, cx);
                if !back.frame.is_some_and(|f| f.mirrored) {
                    self.explains(BACK, &found, cx)?;
                }
                let (.., mut behind) = found;
                elastic::all_stretched(&mut behind.fit, form, body);
                elastic::all_shortened(&mut behind.fit, form, body);
                behind
            }
        };
        cx.check()?;
        let layers = [(Layer::Front, before), (Layer::Back, behind)];
        pattern(
            form,
            &layers,
            Making {
                waist: self.waist,
                front: self.front,
                head: hood::head(body),
                rise: wearable::rise(body),
            },
            body,
            cx,
        )
    }

    /// Landmarks that no garment has.
    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        template::said::known(&self.landmarks).err().into_iter().collect()
    }
}

/// What is looked for in an outline.
struct Sought<'a> {
    forms: Vec<(&'static str, &'static Form)>,
    /// How likely each is, where that is known.
    likely: Option<&'a Likely>,
    /// Whether somebody has said what it is.
    is_said: bool,
    /// Whether the outline was opened between limbs and what they touch.
    is_opened: bool,
}

impl Block {
    /// What lays a template over an outline that is cut as it lies.
    pub(super) fn as_it_lies(style: BlockStyle) -> Self {
        Block { style, sides: Sides::AsTheyLie, ..Block::default() }
    }

    /// The best of the forms, fitted; to the outline at another scale where the frame cut its
    /// width.
    fn fitted(
        &self,
        panel: &str,
        outline: &Outline,
        photo: Option<&SeenPhoto<'_>>,
        forms: Vec<(&'static str, &'static Form)>,
        cx: &Context,
    ) -> Result<(&'static str, &'static Form, Fitted), StageError> {
        let found = self.best(panel, outline, photo, forms, cx)?;
        let (name, form, Fitted { upright, fit, .. }) = &found;
        let times =
            match upright.unseen.contains(&true) && photo.is_some_and(|p| p.photo.garment_width.is_some()) {
                true => template::complete::widened(fit, upright, outline),
                false => 1.0,
            };
        match times == 1.0 {
            true => Ok(found),
            false => {
                self.best(panel, &template::complete::scaled(outline, times), photo, vec![(*name, *form)], cx)
            }
        }
    }

    /// The best of the forms, fitted to the outline as it is, or opened where the network sees that
    /// a limb lies against the rest. The likeliest are tried first, and the others only where none
    /// of those fits.
    pub(super) fn best(
        &self,
        panel: &str,
        outline: &Outline,
        photo: Option<&SeenPhoto<'_>>,
        forms: Vec<(&'static str, &'static Form)>,
        cx: &Context,
    ) -> Result<(&'static str, &'static Form, Fitted), StageError> {
        let seen = photo.and_then(|photo| photo.seen.as_ref());
        let likely = seen.filter(|_| forms.len() > 1).map(Likely::of);
        let is_said = forms.len() == 1;
        let likeliest: Vec<_> = forms
            .iter()
            .copied()
            .filter(|(name, _)| likely.as_ref().is_none_or(|l| l.is_likely(name)))
            .collect();
        let of = |forms| {
            self.best_of(
                panel,
                outline,
                photo,
                &Sought { forms, likely: likely.as_ref(), is_said, is_opened: false },
                cx,
            )
        };
        match likeliest.len() < forms.len() {
            true => of(likeliest).or_else(|_| of(forms)),
            false => of(forms),
        }
    }

    /// The best of the forms that are sought.
    fn best_of(
        &self,
        panel: &str,
        outline: &Outline,
        photo: Option<&SeenPhoto<'_>>,
        sought: &Sought<'_>,
        cx: &Context,
    ) -> Result<(&'static str, &'static Form, Fitted), StageError> {
        let whole = self.laid(panel, outline, photo, sought, cx);
        let seen = photo.and_then(|photo| photo.seen.as_ref());
        let Some(opened) = seen.and_then(|seen| apart::opened(outline, seen)) else { return whole };
        let apart = Sought { is_opened: true, forms: sought.forms.clone(), ..*sought };
        let apart = self.laid(panel, &opened.outline, photo, &apart, cx);
        let apart =
            apart.map(|(name, form, fitted)| (name, form, Fitted { apart: opened.what.clone(), ..fitted }));
        let price = |(name, _, fitted): &(&str, &Form, Fitted)| {
            fitted.lying.score + sought.likely.map_or(0.0, |l| l.price(name))
        };
        match (whole, apart) {
            (Ok(whole), Ok(apart)) => {
                let has_none = whole.1.underarm().is_none();
                let unseen = if has_none { SLEEVE_SEEN * opened.sleeves as f64 } else { 0.0 };
                let is_better = price(&apart) + OPENED < price(&whole) + GROUND * opened.ground + unseen;
                Ok(if is_better { apart } else { whole })
            }
            (whole, apart) => whole.or(apart),
        }
    }

    /// The best of the forms, fitted to an outline.
    fn laid(
        &self,
        panel: &str,
        outline: &Outline,
        photo: Option<&SeenPhoto<'_>>,
        Sought { forms, likely, is_said, is_opened }: &Sought<'_>,
        cx: &Context,
    ) -> Result<(&'static str, &'static Form, Fitted), StageError> {
        let mut upright = Upright::of(outline).ok_or_else(|| refusal::no_axis(panel))?;
        if let Some(photo) = photo.filter(|_| self.complete == Complete::Mirror) {
            template::complete::mark(&mut upright, outline, photo.photo.pixels.dimensions(), panel)?;
        }
        let seen = photo.and_then(|photo| photo.seen.as_ref()).zip(outline.frame.as_ref());
        let corners =
            |upright: &Upright| seen.map(|(seen, frame)| SeenCorners::of(seen, upright, frame, *is_opened));
        let marks = SaidCorners::of(&self.landmarks, panel, outline, photo.map(|p| p.photo), &upright)?;
        cx.check()?;
        let said = |name: &str| *is_said || likely.is_some_and(|l| l.is_sure_of(name));
        let size = upright.size;
        let limit = |name: &str| self.stray * size * if said(name) { 1.0 } else { UNSAID };
        let found = tried(&upright, panel, forms, Halves::Both, *likely, corners(&upright).as_ref(), &marks)
            .and_then(|best| match strays(&best.2) > limit(best.0) {
                true => Err(refusal::strays(panel, best.1, &best.2, strays(&best.2), !is_said)),
                false => Ok(best),
            });
        let doubtful = match &found {
            Ok((_, form, fit)) => template::alike::differ(fit, form, upright.size),
            Err(_) => true,
        };
        let one = || {
            let upright = upright.about_its_rows()?;
            let best =
                tried(&upright, panel, forms, Halves::Better, *likely, corners(&upright).as_ref(), &marks)
                    .ok()?;
            let (other, limit) = (1 - best.2.judged?, limit(best.0));
            let is_sound = strays(&best.2) <= limit * HALF && best.2.near(&upright, other, limit) >= OTHER;
            is_sound.then_some((best, upright))
        };
        // Sides that are to be kept apart are not mirrored.
        let may_mirror = self.sides == Sides::Alike && !upright.unseen.contains(&true);
        let by_half = if doubtful && may_mirror { one() } else { None };
        let ((name, form, fit), upright) = match by_half {
            Some(found) => found,
            None => (found?, upright),
        };
        if let Some((kind, p)) = likely.and_then(|l| l.instead_of(name)) {
            return Err(refusal::another(panel, form, likely::word(kind), p));
        }
        let mut cut = fit.clone();
        template::stance::stood(&mut cut, form);
        if self.sides == Sides::Alike {
            let said = marks.pulls(form, &upright);
            template::alike::alike(&mut cut, form, fit.astray(&upright, form), &said);
        }
        Ok((name, form, Fitted { upright, fit: cut, lying: fit, frame: outline.frame, apart: Vec::new() }))
    }

    /// Refuses or tells what the template does not explain.
    pub(super) fn explains(
        &self,
        panel: &str,
        (_, form, fitted): &(&str, &Form, Fitted),
        cx: &Context,
    ) -> Result<(), StageError> {
        let Fitted { upright, lying, .. } = fitted;
        if upright.unseen.contains(&true) {
            return Ok(());
        }
        let left = Leftover::of(upright, form, lying);
        left.figures(panel, cx);
        left.judge(panel, form, upright.size, self.style == BlockStyle::Auto, cx)
    }

    /// Tells how the fit lies.
    fn tell(&self, panel: &str, outline: &Outline, (_, form, fitted): &(&str, &Form, Fitted), cx: &Context) {
        let Fitted { upright, lying: fit, apart, .. } = fitted;
        tell::figures(panel, form, fit, cx);
        // What is seen in a mirror is told once.
        if panel == FRONT || !outline.frame.is_some_and(|f| f.mirrored) {
            tell::astray(panel, form, fit, upright.size, cx);
            tell::apart(panel, apart, cx);
            match fit.judged {
                Some(side) => tell::one_half(panel, form, side, cx),
                None => tell::uneven(panel, form, fit, upright.size, self.sides, cx),
            }
            if upright.unseen.contains(&true) {
                cx.note(format!("what the frame cuts off \"{panel}\" is the mirror image of its other half"));
            }
        }
    }
}

/// How far 19 of 20 points of the outline lie from a template at most, metres.
fn strays(fit: &Fit) -> f64 {
    at_95(&fit.misses.iter().flatten().copied().collect::<Vec<f64>>())
}

/// The best of the forms, fitted; the reason of each where none can be.
fn tried<'f>(
    upright: &Upright,
    panel: &str,
    forms: &[(&'static str, &'f Form)],
    halves: Halves,
    likely: Option<&Likely>,
    corners: Option<&SeenCorners>,
    said: &SaidCorners,
) -> Result<(&'static str, &'f Form, Fit), StageError> {
    let is_sure = |name: &str| likely.is_some_and(|l| l.is_sure_of(name));
    let try_one = |(name, form): &(&'static str, &'f Form)| {
        let pulls = said.pulls(form, upright);
        sound(upright, form, halves, corners, &pulls, is_sure(name))
    };
    let tried: Vec<_> = forms.par_iter().map(try_one).collect();
    let (mut found, mut reasons) = (Vec::new(), Vec::new());
    for ((name, form), result) in forms.iter().zip(tried) {
        match result {
            Ok(fit) => found.push((*name, *form, fit)),
            Err(reason) => reasons.push((*form, reason)),
        }
    }
    let price = |(name, _, fit): &(&str, &Form, Fit)| fit.score + likely.map_or(0.0, |l| l.price(name));
    // What the network is sure that it is not comes last, however well it fits.
    let is_another = |(name, ..): &(&str, &Form, Fit)| likely.is_some_and(|l| l.instead_of(name).is_some());
    let order = |a: &_, b: &_| is_another(a).cmp(&is_another(b)).then(price(a).total_cmp(&price(b)));
    let best = found.into_iter().min_by(order);
    best.ok_or_else(|| refusal::none(panel, &reasons))
}

/// The better fit of those that the form allows, or why there is none. Legs of a form that the
/// network `is_sure` of may be as short as they like.
fn sound(
    upright: &Upright,
    form: &Form,
    halves: Halves,
    corners: Option<&SeenCorners>,
    said: &[CornerPull],
    is_sure: bool,
) -> Result<Fit, &'static str> {
    let corners = corners.map(|c| c.clone().corrected(form, said));
    let corners = corners.as_ref();
    let mut reason = "its edges are not in their usual places";
    let mut allowed = Vec::new();
    for fit in fits(upright, form, halves, corners, said) {
        let corner = |side: usize, k: usize| {
            fit.judged.is_none_or(|judged| judged == side).then(|| fit.corner(side, k))
        };
        let astray = corners.map_or(0.0, |c| c.astray(form, upright.size, corner));
        let fit = Fit { score: fit.score + LANDMARKS * astray, ..fit };
        let counts = |m: &&Mark| !(is_sure && matches!(m, Mark::Below(0, ..)));
        match form.marks.iter().filter(counts).find_map(|m| missing(&fit, m)) {
            Some(lacks) => reason = lacks,
            None => allowed.push(fit),
        }
    }
    allowed.into_iter().min_by(|a, b| a.score.total_cmp(&b.score)).ok_or(reason)
}
