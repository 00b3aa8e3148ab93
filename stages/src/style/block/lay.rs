//! From the fits of both layers to a pattern, and where its pieces lie in the photos.

use super::fit::Fit;
use super::form::Form;
use super::halves::Upright;
use super::pieces::{self, Flat, Layer};
use super::{seams, stand};
use nalgebra::Rotation2;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::prelude::*;

/// A fit with the upright outline that it belongs to, and where that lies in its photo.
pub(super) struct Fitted {
    pub upright: Upright,
    /// The template that is cut.
    pub fit: Fit,
    /// The template as the garment lies.
    pub lying: Fit,
    pub frame: Option<PhotoFrame>,
}

/// The outline seen from the other side: what its photo's mirror image shows.
pub(super) fn mirrored(outline: &Outline) -> Outline {
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
pub(super) fn pattern(
    form: &Form,
    layers: &[(Layer, Fitted)],
    body: &Body,
    cx: &Context,
) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
    let hung = if form.edges.last().is_some_and(|e| e.name == "neck") { "neck_left" } else { "waist_front" };
    let (mut flats, mut pieces, mut frames) = (Vec::new(), Vec::new(), BTreeMap::new());
    for (layer, fitted) in layers {
        let top = fitted.fit.sides[0].last().map_or(0.0, |neck| neck.a.y);
        let stand = stand::Stand::of(body, hung, top)?;
        let lying = pieces::layer(&fitted.lying, form, *layer);
        for (flat, lying) in pieces::layer(&fitted.fit, form, *layer).into_iter().zip(lying) {
            let pose = Some(stand.pose(&flat, *layer));
            pieces.push(Piece { pose, ..flat.piece() });
            frames.insert(flat.name.clone(), fitted.frame.map(|f| frame(f, fitted, &lying)));
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
