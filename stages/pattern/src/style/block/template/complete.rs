//! A garment that the frame cuts on one side, completed by the other side's mirror image.
//!
//! Points of the outline that lie along the photo's frame are not the garment's own. They draw no
//! template; what they leave open the symmetry of the template closes. Where the scale comes from
//! the garment's stated width, the outline, which is narrower than the garment, is scaled anew once
//! the template shows how wide the garment is.

use crate::style::block::template::fit::Fit;
use crate::style::block::template::halves::Upright;
use toile_core::prelude::*;

/// What of a garment that the frame cuts is added.
#[choice]
#[derive(Copy, Eq)]
pub enum Complete {
    /// Nothing: it is cut as the photo shows it.
    Nothing,
    /// What the frame cuts off one half is taken from the other.
    Mirror,
}

impl Complete {
    /// As it is written.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Complete::Nothing => "Nothing",
            Complete::Mirror => "Mirror",
        }
    }
}

/// Points nearer to the frame than this share of the photo's shorter side lie on it: the outline is
/// smoothed there.
const ON_FRAME: f64 = 0.008;
/// And at least so many pixels.
const LEAST: f64 = 3.0;
/// Places of both halves are each other's mirror image within this share of the garment's size.
const SAME: f64 = 0.04;
/// The share of the outline that may be cut on both sides at one height: a stray point is no cut.
const BOTH: f64 = 0.02;
/// What touches the frame over no more than this share of the photo's shorter side is not cut by
/// it.
const TOUCHES: f64 = 0.05;

/// Marks the points where the frame cuts the garment. `size` is the photo's, pixels.
///
/// # Errors
/// Both halves are cut at the same place.
pub(crate) fn mark(
    upright: &mut Upright,
    outline: &Outline,
    size: (u32, u32),
    panel: &str,
) -> Result<(), StageError> {
    let Some(frame) = outline.frame else { return Ok(()) };
    let (w, h) = (f64::from(size.0), f64::from(size.1));
    let near = (ON_FRAME * w.min(h)).max(LEAST);
    let on_frame = |p: &Point2| {
        let px = frame.to_px(upright.given(*p));
        px.x < near || px.y < near || px.x > w - near || px.y > h - near
    };
    let unseen: Vec<bool> = upright.points.iter().map(on_frame).collect();
    let n = unseen.len();
    let lies = (0..n).filter(|k| unseen[*k] && unseen[(k + 1) % n]);
    let along = lies.map(|k| (upright.points[(k + 1) % n] - upright.points[k]).norm()).sum::<f64>();
    if along * frame.px_per_metre <= TOUCHES * w.min(h) {
        return Ok(());
    }
    let cut = || upright.points.iter().zip(&unseen).filter(|(_, unseen)| **unseen).map(|(p, _)| *p);
    let same = |p: Point2| cut().any(|q| (Point2::new(-p.x, p.y) - q).norm() < SAME * upright.size);
    let both = cut().filter(|p| same(*p)).count();
    if both as f64 > BOTH * unseen.len() as f64 {
        return Err(StageError::invalid(format!("the frame cuts both halves of \"{panel}\" at the same place"))
            .hint("only what one half shows whole can be completed; photograph the garment with ground on all four sides"));
    }
    upright.unseen = unseen;
    Ok(())
}

/// How many times as wide the fitted garment is as its outline in the photo.
pub(crate) fn widened(fit: &Fit, upright: &Upright, outline: &Outline) -> f64 {
    let place = |p: Point2, side: usize| upright.given(fit.laid(p, side)).x;
    let sides = fit.sides.iter().enumerate();
    let template = sides.flat_map(|(side, edges)| {
        edges.iter().flat_map(move |bow| (0..=8).map(move |k| place(bow.at(f64::from(k) / 8.0), side)))
    });
    let own = outline.outer.points.iter().map(|p| p.x);
    width(template) / width(own.clone()).max(f64::MIN_POSITIVE)
}

fn width(xs: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    (high - low).max(0.0)
}

/// The outline with all lengths divided by `times`, at the same place in its photo.
pub(crate) fn scaled(outline: &Outline, times: f64) -> Outline {
    let to = |p: &Point2| Point2::from(p.coords / times);
    let outer = Loop { points: outline.outer.points.iter().map(to).collect(), ..outline.outer.clone() };
    let frame = outline.frame.map(|f| PhotoFrame { px_per_metre: f.px_per_metre * times, ..f });
    Outline { outer, frame, ..outline.clone() }
}
