//! `Block`: a garment template fitted to the outline of a flat garment, cut into the pieces of a sewing pattern.
//!
//! [`form`] says which edges a garment has, [`segment`] finds them on each half of the outline, [`fit`] lays the whole template over the whole
//! outline, [`pieces`] cuts it, [`seams`] sews it, [`stand`] puts it around the body. Cost: a tenth of a second a form.

mod bow;
mod curve;
mod fit;
mod form;
mod halves;
mod marks;
mod pieces;
mod refusal;
mod seams;
mod segment;
mod stand;
#[cfg(test)]
mod tests;

use fit::{Fit, fit};
use form::Form;
use halves::Upright;
use marks::missing;
use nalgebra::Rotation2;
use pieces::{Flat, Layer};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::prelude::*;

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
    /// From waist to hem.
    Skirt,
    /// Two legs, long or short.
    Trousers,
}

impl BlockStyle {
    /// All that can be named, with their forms.
    const NAMED: [(BlockStyle, &'static str, &'static Form); 6] = [
        (BlockStyle::Vest, "Vest", &form::VEST),
        (BlockStyle::TShirt, "TShirt", &form::TEE),
        (BlockStyle::LongSleeve, "LongSleeve", &form::LONG),
        (BlockStyle::Dress, "Dress", &form::DRESS),
        (BlockStyle::Skirt, "Skirt", &form::SKIRT),
        (BlockStyle::Trousers, "Trousers", &form::TROUSERS),
    ];

    /// The forms that come into question, with their names.
    fn forms(self) -> Vec<(&'static str, &'static Form)> {
        let asked = |s: &BlockStyle| self == BlockStyle::Auto || *s == self;
        Self::NAMED.into_iter().filter(|(s, ..)| asked(s)).map(|(_, name, form)| (name, form)).collect()
    }
}

/// Cuts a sewing pattern to the outline of a garment that lies flat.
///
/// A template with a garment's landmarks (a block) is fitted to the whole outline by least squares, symmetric about its own axis, so
/// that folds and rags do little and a garment that lies askew is straightened. The pieces are front and back, and sleeves that are
/// set into armholes of their caps' length. How far the outline strays from the template is told by edges. Needs the
/// photo `front`; without one of the back, the back is cut as the front is.
#[stage(
    role = Style,
    source = "fitting: Chen and Medioni 1992, Geman and McClure 1985; blocks: Aldrich 2008",
    example = "Block(style: TShirt)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Block {
    /// What the garment is.
    #[param(default = BlockStyle::Auto)]
    style: BlockStyle,
    /// How far the outline may stray from the template, as a share of the garment's size (the root of its area); 19 of 20 of its points lie nearer.
    #[param(default = 0.05, min = 0.001, max = 0.5)]
    stray: f64,
}

#[stage]
impl Block {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        body: &Body,
        cx: &Context,
    ) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
        let front = outlines.get("front").ok_or_else(refusal::no_front)?;
        for (name, _) in outlines.iter().filter(|(n, _)| *n != "front" && *n != "back") {
            cx.warn(format!("a block is cut from \"front\" and \"back\"; the photo \"{name}\" is not used"));
        }
        let (name, form, before) = self.fitted("front", front, self.style.forms(), cx)?;
        if self.style == BlockStyle::Auto {
            cx.warn(format!("\"front\" is taken for {}; `Block(style: {name})` settles it", form.word));
        }
        let mirrored = mirrored(front);
        let back = outlines.get("back").unwrap_or(&mirrored);
        let (.., behind) = self.fitted("back", back, vec![(name, form)], cx)?;
        cx.check()?;
        let layers = [(Layer::Front, front, before), (Layer::Back, back, behind)];
        pattern(form, &layers, body, cx)
    }
}

/// A fit with the upright outline that it belongs to.
struct Fitted {
    upright: Upright,
    fit: Fit,
}

impl Block {
    /// The best of the forms, fitted.
    fn fitted(
        &self,
        panel: &str,
        outline: &Outline,
        forms: Vec<(&'static str, &'static Form)>,
        cx: &Context,
    ) -> Result<(&'static str, &'static Form, Fitted), StageError> {
        let auto = forms.len() > 1;
        let upright = Upright::of(outline).ok_or_else(|| refusal::no_axis(panel))?;
        cx.check()?;
        let tried: Vec<_> = forms.par_iter().map(|(_, form)| sound(&upright, form)).collect();
        let mut found: Vec<_> = Vec::new();
        let mut reasons = Vec::new();
        for ((name, form), result) in forms.into_iter().zip(tried) {
            match result {
                Ok(fit) => found.push((name, form, fit)),
                Err(reason) => reasons.push((form, reason)),
            }
        }
        let best = found.into_iter().min_by(|a, b| a.2.score.total_cmp(&b.2.score));
        let Some((name, form, fit)) = best else { return Err(refusal::none(panel, &reasons)) };
        let all: Vec<f64> = fit.misses.iter().flatten().copied().collect();
        let stray = at_95(&all);
        if stray > self.stray * upright.size {
            return Err(refusal::strays(panel, form, &fit, stray, auto));
        }
        tell(panel, form, &fit, upright.size, cx);
        tell_uneven(panel, form, &fit, upright.size, cx);
        Ok((name, form, Fitted { upright, fit }))
    }
}

/// An edge that strays by more than this share of the size is told.
const TOLD: f64 = 0.025;

/// A fit that the form allows, or why there is none.
fn sound(upright: &Upright, form: &Form) -> Result<Fit, &'static str> {
    let fit = fit(upright, form).ok_or("its edges are not in their usual places")?;
    match form.marks.iter().find_map(|m| missing(&fit, m)) {
        Some(reason) => Err(reason),
        None => Ok(fit),
    }
}

/// The value that 19 of 20 do not exceed.
fn at_95(misses: &[f64]) -> f64 {
    let mut sorted = misses.to_vec();
    sorted.sort_by(f64::total_cmp);
    quantile(&sorted, 0.95)
}

/// Tells how far the outline strays from the template.
fn tell(panel: &str, form: &Form, fit: &Fit, size: f64, cx: &Context) {
    for (e, misses) in form.edges.iter().zip(&fit.misses).filter(|(_, m)| !m.is_empty()) {
        let stray = at_95(misses);
        cx.figure(&format!("stray_{panel}_{}", e.name), stray * 1e3, "mm");
        if stray > TOLD * size {
            cx.warn(format!(
                "the {} of \"{panel}\" strays by {:.0} mm from that of {}; it is cut as the block has it",
                e.name,
                stray * 1e3,
                form.word
            ));
        }
    }
}

/// Tells edges that are longer on one side: the garment lies uneven.
fn tell_uneven(panel: &str, form: &Form, fit: &Fit, size: f64, cx: &Context) {
    for (k, e) in form.edges.iter().enumerate() {
        let [a, b] = [0, 1].map(|s: usize| fit.sides[s][k].length());
        if (a - b).abs() > TOLD * size {
            cx.warn(format!(
                "\"{panel}\" lies uneven: its {} measures {:.0} mm on one side and {:.0} mm on the other; it is cut as it lies",
                e.name,
                a * 1e3,
                b * 1e3
            ));
        }
    }
}

/// The outline seen from the other side: what its photo's mirror image shows.
fn mirrored(outline: &Outline) -> Outline {
    let n = outline.outer.points.len();
    let flip = |p: &Point2| Point2::new(-p.x, p.y);
    let frame = outline.frame.map(|f| PhotoFrame { mirrored: !f.mirrored, turn: -f.turn, ..f });
    let outer = Loop {
        points: outline.outer.points.iter().rev().map(flip).collect(),
        corners: outline.outer.corners.iter().rev().map(|c| n - 1 - c).collect(),
    };
    Outline { outer, holes: Vec::new(), edges: Vec::new(), inner: Vec::new(), frame }
}

/// The pattern of both layers, its outlines with their places in the photos, and its sewing plan.
fn pattern(
    form: &Form,
    layers: &[(Layer, &Outline, Fitted)],
    body: &Body,
    cx: &Context,
) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
    let hung = if form.edges.last().is_some_and(|e| e.name == "neck") { "neck_left" } else { "waist_front" };
    let (mut flats, mut pieces, mut frames) = (Vec::new(), Vec::new(), BTreeMap::new());
    for (layer, outline, fitted) in layers {
        let top = fitted.fit.sides[0].last().map_or(0.0, |neck| neck.a.y);
        let stand = stand::Stand::of(body, hung, top)?;
        for flat in pieces::layer(&fitted.fit, form, *layer) {
            let pose = Some(stand.pose(&flat, *layer));
            pieces.push(Piece { pose, ..flat.piece() });
            frames.insert(flat.name.clone(), outline.frame.map(|f| frame(f, fitted, &flat)));
            flats.push(flat);
        }
    }
    let pattern = Pattern { name: "block".into(), pieces, seams: seams::seams(&flats, form) };
    let lowered = pattern.lower().map_err(|e| StageError::invalid(e.to_string()).hint(e.remedy()))?;
    lowered.notes.into_iter().for_each(|what| cx.warn(what));
    let framed = |(name, o): (String, Outline)| {
        let frame = frames.get(&name).copied().flatten();
        (name, Arc::new(Outline { frame, ..o }))
    };
    Ok((pattern, Set(lowered.outlines.into_iter().map(framed).collect()), lowered.plan))
}

/// Where a piece lies in the photo of its layer.
fn frame(photo: PhotoFrame, fitted: &Fitted, flat: &Flat) -> PhotoFrame {
    let turn = fitted.upright.tilt.to_radians() + fitted.fit.turn;
    let origin = Rotation2::new(turn) * (flat.origin + Vector2::new(fitted.fit.shift, 0.0));
    let at = fitted.upright.centre + origin.coords;
    PhotoFrame { origin_px: photo.to_px(at), turn: photo.turn + turn + flat.turn, ..photo }
}
