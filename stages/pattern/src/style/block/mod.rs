//! `Block`: a garment template fitted to the outline of a flat garment, cut into the pieces of a
//! sewing pattern.
//!
//! [`form`] says which edges a garment has, [`segment`] finds them on each half of the outline,
//! [`fit`] lays the whole template over the whole outline, [`stance`] stands spread legs under the
//! hips, [`pieces`] cuts it, [`waist`] gathers a skirt to a band or lays it in pleats ([`pleat`]),
//! [`front`] cuts a front in halves, [`seams`] sews it, [`stand`] puts it around the body, if one
//! can wear it ([`wearable`]); [`fitting`] finds a body that can. Cost: a tenth of a second a form.

mod fitting;
mod front;
mod lay;
mod leftover;
mod likely;
mod pieces;
mod pleat;
mod refusal;
mod seams;
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
use likely::Likely;
use pieces::Making;
use rayon::prelude::*;
pub(super) use refusal::{LAY, no_front};
pub(super) use stand::Stand;
pub(crate) use stand::{TRUNK_BOTTOM, TRUNK_TOP};
use tell::at_95;
pub use template::alike::Sides;
pub use template::complete::Complete;
use template::fit::{Fit, Halves, fit};
use template::form::Form;
use template::halves::Upright;
use template::marks::missing;
pub(super) use template::piece_role::Layer;
use toile_core::prelude::*;
pub use waist::Waist;
pub(super) use wearable::check as check_wearable;

/// The photos that a block is cut from.
const FRONT: &str = Layer::Front.word();
const BACK: &str = Layer::Back.word();

/// The share of the limit for a garment of which nobody has said what it is: a top whose sleeves
/// lie against it looks a little like a skirt.
const UNSAID: f64 = 0.5;

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
    const NAMED: [(BlockStyle, &'static str, &'static Form); 10] = [
        (BlockStyle::Vest, "Vest", &template::form::VEST),
        (BlockStyle::TShirt, "TShirt", &template::form::TEE),
        (BlockStyle::LongSleeve, "LongSleeve", &template::form::LONG),
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
    version = 9,
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
    /// binariser must let the garment touch the frame for it.
    #[param(default = Complete::Nothing)]
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
    /// Whether a network looks at the photo, too, where nobody says what the garment is.
    #[param(default = true)]
    network: bool,
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
        let photo = |name: &str| photos.as_ref().and_then(|all| all.get(name).or_else(|| all.get(FRONT)));
        let found = self.fitted(FRONT, front, photo(FRONT), self.style.forms(), cx)?;
        self.tell(FRONT, front, &found, cx);
        self.explains(FRONT, &found, cx)?;
        let (name, form, before) = found;
        if self.style == BlockStyle::Auto {
            cx.note(format!(
                "\"front\" is taken for {}; to say what it is: --set 'style.style={name}'",
                form.word
            ));
        }
        check_wearable(name, form, &before.fit, body, photo(FRONT))?;
        let mirrored = mirrored(front);
        let back = outlines.get(BACK).unwrap_or(&mirrored);
        let found = self.fitted(BACK, back, photo(BACK), vec![(name, form)], cx)?;
        self.tell(BACK, back, &found, cx);
        if outlines.get(BACK).is_some_and(|o| !o.frame.is_some_and(|f| f.mirrored)) {
            self.explains(BACK, &found, cx)?;
        }
        let (.., behind) = found;
        cx.check()?;
        let layers = [(Layer::Front, before), (Layer::Back, behind)];
        pattern(form, &layers, Making { waist: self.waist, front: self.front }, body, cx)
    }
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
        photo: Option<&Photo>,
        forms: Vec<(&'static str, &'static Form)>,
        cx: &Context,
    ) -> Result<(&'static str, &'static Form, Fitted), StageError> {
        let found = self.best(panel, outline, photo, forms, cx)?;
        let (name, form, Fitted { upright, fit, .. }) = &found;
        let times = match upright.unseen.contains(&true) && photo.is_some_and(|p| p.garment_width.is_some()) {
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

    /// The best of the forms, fitted.
    pub(super) fn best(
        &self,
        panel: &str,
        outline: &Outline,
        photo: Option<&Photo>,
        forms: Vec<(&'static str, &'static Form)>,
        cx: &Context,
    ) -> Result<(&'static str, &'static Form, Fitted), StageError> {
        let auto = forms.len() > 1;
        let likely = photo.filter(|_| auto && self.network).map(Likely::of).transpose()?;
        let mut upright = Upright::of(outline).ok_or_else(|| refusal::no_axis(panel))?;
        if self.complete == Complete::Mirror {
            let photo = photo.ok_or_else(|| template::complete::no_frame(panel))?;
            template::complete::mark(&mut upright, outline, photo.pixels.dimensions(), panel)?;
        }
        cx.check()?;
        let said = |name: &str| !auto || likely.as_ref().is_some_and(|l| l.is_sure_of(name));
        let size = upright.size;
        let limit = |name: &str| self.stray * size * if said(name) { 1.0 } else { UNSAID };
        let found =
            tried(&upright, panel, &forms, Halves::Both, likely.as_ref()).and_then(|best| {
                match strays(&best.2) > limit(best.0) {
                    true => Err(refusal::strays(panel, best.1, &best.2, strays(&best.2), auto)),
                    false => Ok(best),
                }
            });
        let doubtful = match &found {
            Ok((_, form, fit)) => template::alike::differ(fit, form, upright.size),
            Err(_) => true,
        };
        let one = || {
            let upright = upright.about_its_rows()?;
            let best = tried(&upright, panel, &forms, Halves::Better, likely.as_ref()).ok()?;
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
        if let Some((kind, p)) = likely.as_ref().and_then(|l| l.instead_of(name)) {
            return Err(refusal::another(panel, form, likely::word(kind), p));
        }
        let mut cut = fit.clone();
        template::stance::stood(&mut cut, form);
        if self.sides == Sides::Alike {
            template::alike::alike(&mut cut, form, fit.astray(&upright, form));
        }
        Ok((name, form, Fitted { upright, fit: cut, lying: fit, frame: outline.frame }))
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
        let Fitted { upright, lying: fit, .. } = fitted;
        tell::figures(panel, form, fit, cx);
        // What is seen in a mirror is told once.
        if panel == FRONT || !outline.frame.is_some_and(|f| f.mirrored) {
            tell::astray(panel, form, fit, upright.size, cx);
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
) -> Result<(&'static str, &'f Form, Fit), StageError> {
    let tried: Vec<_> = forms.par_iter().map(|(_, form)| sound(upright, form, halves)).collect();
    let (mut found, mut reasons) = (Vec::new(), Vec::new());
    for ((name, form), result) in forms.iter().zip(tried) {
        match result {
            Ok(fit) => found.push((*name, *form, fit)),
            Err(reason) => reasons.push((*form, reason)),
        }
    }
    let price = |(name, _, fit): &(&str, &Form, Fit)| fit.score + likely.map_or(0.0, |l| l.price(name));
    let best = found.into_iter().min_by(|a, b| price(a).total_cmp(&price(b)));
    best.ok_or_else(|| refusal::none(panel, &reasons))
}

/// A fit that the form allows, or why there is none.
fn sound(upright: &Upright, form: &Form, halves: Halves) -> Result<Fit, &'static str> {
    let fit = fit(upright, form, halves).ok_or("its edges are not in their usual places")?;
    match form.marks.iter().find_map(|m| missing(&fit, m)) {
        Some(reason) => Err(reason),
        None => Ok(fit),
    }
}
