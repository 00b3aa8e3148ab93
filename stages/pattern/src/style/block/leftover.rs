//! What of a garment its template does not explain: a hood above the neck, a bodice above a skirt,
//! a bag in front.
//!
//! Outline and template are painted, and what only one of them covers is opened, so that the thin
//! strips of an uneven border do not count. Of what is left the largest piece is looked at: how
//! large it is and where. A template can also reach where no garment of its kind does: an upper
//! border that stands far above the shoulders is a hood and no neckline. Cost: two pictures of 200
//! pixels, a millisecond. Limits: what lies within the template (a pocket, a belt) is not seen.

use super::refusal::LAY;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use crate::style::block::template::halves::Upright;
use image::{GrayImage, Luma};
use imageproc::drawing::draw_polygon_mut;
use imageproc::point::Point;
use nalgebra::Rotation2;
use toile_core::prelude::*;
use toile_image::binarise::{Regions, open};

/// Pixels along the longer side.
const SIDE: f64 = 200.0;
/// What is thinner than twice this share of the garment's size is its uneven border.
const THIN: f64 = 0.025;

/// A neckline stands no higher above its ends than this share of the garment's size: what does is a
/// hood. From the lesser one on it is a collar that stands.
const HOOD: f64 = 0.16;
const COLLAR: f64 = 0.1;
/// A piece of this share of the garment's area is more than a fold; under `Auto` it is refused.
/// From the lesser one on it is told.
const PART: f64 = 0.06;
const FOLD: f64 = 0.03;

/// What a template leaves over, as shares of the garment's size or area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leftover {
    /// The area of the largest piece of the garment that the template does not cover.
    pub beyond: f64,
    /// The area of the largest piece of the template that is no garment.
    pub lacking: f64,
    /// Where the first of them lies.
    pub place: &'static str,
    /// How far the upper border stands above its ends in the middle, negative where it dips: of a
    /// neck or a waist.
    pub rise: f64,
}

impl Leftover {
    /// As figures.
    pub(super) fn figures(&self, panel: &str, cx: &Context) {
        cx.figure(&format!("beyond_{panel}"), 100.0 * self.beyond, "% of its area");
        cx.figure(&format!("lacking_{panel}"), 100.0 * self.lacking, "% of its area");
        cx.figure(&format!("rise_{panel}"), 100.0 * self.rise, "% of its size");
    }

    /// Refuses what no garment of this kind has, and tells what is odd in one. `auto`: nobody has
    /// said what the garment is.
    pub(super) fn judge(
        &self,
        panel: &str,
        form: &Form,
        size: f64,
        auto: bool,
        cx: &Context,
    ) -> Result<(), StageError> {
        let has_neck = form.ends_at(EdgeRole::Neck);
        let cm = 100.0 * self.rise * size;
        if has_neck && self.rise > HOOD {
            return Err(StageError::invalid(format!(
                "what stands {cm:.0} cm above the shoulders of \"{panel}\" is no neckline of {}: a hood, or a collar that stands",
                form.word
            ))
            .hint("say that it has a hood: --set 'style.style=Hooded' --set 'body.style=Hooded'; or fold what stands there back behind the garment, and take the photo again"));
        }
        if has_neck && self.rise > COLLAR {
            cx.warn(format!(
                "the neckline of \"{panel}\" stands {cm:.0} cm above its shoulders, and is cut so: a collar that stands is better folded back behind the garment"
            ));
        }
        let what = format!(
            "{:.0} % of what \"{panel}\" shows, {} the rest, is no part of {}",
            100.0 * self.beyond,
            self.place,
            form.word
        );
        if self.beyond > PART && auto {
            let say = "or say what it is: --set 'style.style=Vest' --set 'body.style=Vest'";
            return Err(StageError::invalid(format!("{what}, which it looks most like"))
                .hint(format!("{LAY}; {say}")));
        }
        if self.beyond > FOLD {
            cx.warn(format!("{what}, and is not sewn"));
        }
        if self.lacking > FOLD {
            cx.warn(format!(
                "{:.0} % of {} does not show in \"{panel}\", and is cut all the same",
                100.0 * self.lacking,
                form.word
            ));
        }
        Ok(())
    }

    /// Of a fit to an outline.
    pub(super) fn of(upright: &Upright, form: &Form, fit: &Fit) -> Self {
        let outline = &upright.points;
        let template = polygon(fit);
        let mut low = Point2::new(f64::INFINITY, f64::INFINITY);
        let mut high = Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY);
        for p in outline.iter().chain(&template) {
            (low, high) = (low.inf(p), high.sup(p));
        }
        let scale = SIDE / (high - low).max().max(f64::MIN_POSITIVE);
        let painted = |points: &[Point2]| {
            let (w, h) = (((high.x - low.x) * scale) as u32 + 3, ((high.y - low.y) * scale) as u32 + 3);
            let mut picture = GrayImage::new(w, h);
            let at = |p: &Point2| {
                Point::new(((p.x - low.x) * scale) as i32 + 1, ((high.y - p.y) * scale) as i32 + 1)
            };
            let mut corners: Vec<Point<i32>> = points.iter().map(at).collect();
            corners.dedup();
            if corners.len() > 2 && corners.first() == corners.last() {
                corners.pop();
            }
            if corners.len() > 2 {
                draw_polygon_mut(&mut picture, &corners, Luma([255]));
            }
            picture
        };
        let (garment, block) = (painted(outline), painted(&template));
        let radius = ((THIN * upright.size * scale).round() as u32).max(1);
        let area = garment.iter().filter(|v| **v != 0).count().max(1) as f64;
        let only = |a: &GrayImage, b: &GrayImage| {
            let mut rest = a.clone();
            rest.iter_mut().zip(b.iter()).filter(|(_, b)| **b != 0).for_each(|(v, _)| *v = 0);
            // Of a template that is judged by one half, the other may lie folded.
            if let Some(judged) = fit.judged {
                let axis = axis(fit);
                for (x, y, v) in rest.enumerate_pixels_mut() {
                    let p = Point2::new(
                        low.x + (f64::from(x) - 1.0) / scale,
                        high.y - (f64::from(y) - 1.0) / scale,
                    );
                    let side = usize::from(axis(p) < 0.0);
                    *v = if side == judged { *v } else { Luma([0]) };
                }
            }
            Regions::of(&open(&rest, radius))
        };
        let (beyond, lacking) = (only(&garment, &block), only(&block, &garment));
        let share = |r: &Regions| r.by_size().first().map_or(0.0, |i| r.pieces[*i].area as f64 / area);
        let shown = beyond.by_size().first().map(|first| beyond.paint(|k, _| k == *first));
        let height = |row: u32| high.y - (f64::from(row) - 1.0) / scale;
        let place = shown.map_or("", |shown| {
            let on = || shown.enumerate_pixels().filter(|(.., v)| v.0[0] != 0);
            let middle = height(on().map(|p| p.1).sum::<u32>() / (on().count().max(1) as u32));
            let last = form.edges.len() - 1;
            let ends = fit.sides.iter().map(|s| s[last].a.y);
            let top = ends.fold(f64::INFINITY, f64::min);
            let foot = fit.sides.iter().map(|s| s[0].a.y).fold(f64::INFINITY, f64::min);
            match () {
                () if middle > top => "above",
                () if middle < foot => "below",
                () => "beside",
            }
        });
        let last = form.edges.len() - 1;
        let rises = fit.sides.iter().map(|s| {
            let high = s[last].points().iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
            let middle = s[last].b.y;
            if middle < s[last].a.y { middle - s[last].a.y } else { high - s[last].a.y }
        });
        let rise = 0.5 * rises.sum::<f64>() / upright.size;
        Leftover { beyond: share(&beyond), lacking: share(&lacking), place, rise }
    }
}

/// How far a point lies to the right of the template's axis.
fn axis(fit: &Fit) -> impl Fn(Point2) -> f64 + '_ {
    move |p| (Rotation2::new(-fit.turn) * p).x - fit.shift
}

/// The template as a closed line in the frame of the upright outline.
fn polygon(fit: &Fit) -> Vec<Point2> {
    let points =
        |side: usize| fit.sides[side].iter().flat_map(|b| b.points()).map(move |p| fit.laid(p, side));
    points(0).chain(points(1).collect::<Vec<_>>().into_iter().rev()).collect()
}
