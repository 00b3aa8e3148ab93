//! From the fits of both layers to a pattern, and where its pieces lie in the photos.

use super::pieces::{self, Making};
use super::{hood, seams, stand};
use crate::style::block::template::fit::Fit;
use crate::style::block::template::flat::Flat;
use crate::style::block::template::form::Form;
use crate::style::block::template::halves::Upright;
use crate::style::block::template::piece_role::{Layer, PieceRole};
use nalgebra::Rotation2;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::prelude::*;

/// Points this near to each other are one, metres.
const SAME: f64 = 1e-4;

/// A fit with the upright outline that it belongs to, and where that lies in its photo.
pub(in crate::style) struct Fitted {
    pub upright: Upright,
    /// The template that is cut.
    pub fit: Fit,
    /// The template as the garment lies.
    pub lying: Fit,
    pub frame: Option<PhotoFrame>,
    /// What was taken apart in the outline, in words.
    pub apart: Vec<&'static str>,
}

impl Fitted {
    /// The fit to the same outline seen from the other side, in that one's frame.
    pub(super) fn mirrored(&self, frame: Option<PhotoFrame>) -> Fitted {
        let (fit, lying) = (self.fit.mirrored(), self.lying.mirrored());
        Fitted { upright: self.upright.mirrored(), fit, lying, frame, apart: self.apart.clone() }
    }
}

/// Whether an outline is another one seen from the other side, as that of a photo that is a mirror
/// image is.
pub(super) fn is_mirrored(outline: &Outline, other: &Outline) -> bool {
    let (a, b) = (&outline.outer.points, &mirrored(other).outer.points);
    let same = |(p, q): (&Point2, &Point2)| (p - q).norm() < SAME;
    // Both begin anywhere.
    let first = a.first().and_then(|p| b.iter().position(|q| same((p, q))));
    a.len() == b.len() && first.is_some_and(|k| a.iter().zip(b.iter().cycle().skip(k)).all(same))
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
    Outline { outer, holes: Vec::new(), edges: Vec::new(), inner: Vec::new(), frame, lies: Vec::new() }
}

/// The pattern of both layers, its outlines with their places in the photos, and its sewing plan.
pub(super) fn pattern(
    form: &Form,
    layers: &[(Layer, Fitted)],
    making: Making,
    body: &Body,
    cx: &Context,
) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
    let hung = if form.hangs_from_neck() { Hand::Left.name("neck") } else { "waist_front".to_owned() };
    for (_, fitted) in layers {
        let edges = &fitted.fit.sides[0];
        let [top, low] =
            [edges.last().map(|e| e.a), edges.first().map(|e| e.b)].map(Option::unwrap_or_default);
        making.waist.check(form, top.y - low.y, 2.0 * top.x)?;
        making.front.check(form)?;
    }
    let (mut flats, mut pieces, mut photos) = (Vec::new(), Vec::new(), BTreeMap::new());
    for (layer, fitted) in layers {
        let top = fitted.fit.sides[0].last().map_or(0.0, |neck| neck.a.y);
        let stand = stand::Stand::of(body, &hung, top)?;
        let lying = pieces::layer(&fitted.lying, form, making, *layer, false);
        for (flat, lying) in pieces::layer(&fitted.fit, form, making, *layer, true).into_iter().zip(lying) {
            let pose = match flat.role {
                PieceRole::Hood(hand) => hood::pose(body, hand)?,
                _ => stand.pose(flat.origin, flat.turn, *layer),
            };
            let piece = Piece { pose: Some(pose), ..flat.piece() };
            photos.insert(piece.name.clone(), fitted.frame.map(|f| Lying::of(f, fitted, &lying)));
            pieces.push(piece);
            flats.push(flat);
        }
    }
    let pattern =
        Pattern { name: "block".into(), pieces, seams: seams::seams(&flats, form, making.waist.fold()) };
    let lowered = pattern.lower().map_err(|e| StageError::invalid(e.to_string()).hint(e.remedy()))?;
    lowered.notes.into_iter().for_each(|what| cx.note(what));
    let framed = |(name, o): (String, Outline)| {
        let photo = photos.get(&name).and_then(Option::as_ref);
        let lies = photo.map_or_else(Vec::new, |lying| lying.lies(&o));
        (name, Arc::new(Outline { frame: photo.map(|p| p.frame), lies, ..o }))
    };
    Ok((pattern, Set(lowered.outlines.into_iter().map(framed).collect()), lowered.plan))
}

/// A piece as it lies in its photo.
struct Lying {
    frame: PhotoFrame,
    piece: Piece,
    /// Where the piece's origin lies and how far it is turned, in the frame of the garment's axis,
    /// for a sleeve of the half that the photo does not show well: it is seen in the other one,
    /// mirrored.
    mirrored: Option<(Point2, f64)>,
}

impl Lying {
    fn of(photo: PhotoFrame, fitted: &Fitted, flat: &Flat) -> Self {
        let hidden = |judged: usize| (flat.origin.x > 0.0) == (judged == 1);
        let is_seen = flat.role.part() != BodyPart::Arm || !fitted.fit.judged.is_some_and(hidden);
        let mirrored = (!is_seen).then_some((flat.origin, flat.turn));
        Lying { frame: frame(photo, fitted, flat), piece: flat.piece(), mirrored }
    }

    /// Where the points of the piece's outline lie: on the same edges as it lies, at the same
    /// shares of their lengths. Nothing where it lies as it is cut.
    fn lies(&self, outline: &Outline) -> Vec<Point2> {
        let n = outline.outer.points.len();
        let mut found = vec![None; n];
        let lengths: Vec<f64> =
            outline.edges.iter().map(|e| polyline_length(&outline.edge_points(e))).collect();
        let length_of = |whole: &str, edges: &[Edge]| -> f64 {
            let parts = edges.iter().zip(&lengths).filter(|(e, _)| self.whole(&e.name) == whole);
            parts.map(|(_, length)| length).sum()
        };
        for (number, edge) in outline.edges.iter().enumerate() {
            let whole = self.whole(&edge.name);
            let Some(path) = self.piece.path(whole) else { return Vec::new() };
            let all = length_of(whole, &outline.edges).max(f64::MIN_POSITIVE);
            let mut along = length_of(whole, &outline.edges[..number]);
            let points = outline.edge_points(edge);
            for (k, p) in points.iter().enumerate() {
                along += if k > 0 { (p - points[k - 1]).norm() } else { 0.0 };
                found[(edge.start + k) % n] = Some(self.seen(path.at(along / all * path.length())));
            }
        }
        let same = |(p, q): (&Point2, &Option<Point2>)| q.is_some_and(|q| (p - q).norm() < SAME);
        if outline.outer.points.iter().zip(&found).all(same) {
            return Vec::new();
        }
        found.into_iter().collect::<Option<_>>().unwrap_or_default()
    }

    /// The edge of the piece that an edge of its outline is, or is one of the numbered parts of.
    fn whole<'a>(&self, name: &'a str) -> &'a str {
        let is_number = |part: &str| part.trim_end_matches('\'').parse::<usize>().is_ok();
        match name.rsplit_once('_') {
            Some((whole, part)) if self.piece.path(name).is_none() && is_number(part) => whole,
            _ => name,
        }
    }

    /// Where a point of the piece is seen.
    fn seen(&self, p: Point2) -> Point2 {
        let Some((origin, turn)) = self.mirrored else { return p };
        let turn = Rotation2::new(turn);
        let at = origin + (turn * p).coords;
        turn.inverse() * Point2::from(Point2::new(-at.x, at.y) - origin)
    }
}

/// Where a piece lies in the photo of its layer.
fn frame(photo: PhotoFrame, fitted: &Fitted, flat: &Flat) -> PhotoFrame {
    let turn = fitted.upright.tilt.to_radians() + fitted.fit.turn;
    let origin = Rotation2::new(turn) * (flat.origin + Vector2::new(fitted.fit.shift, 0.0));
    let at = fitted.upright.centre + origin.coords;
    PhotoFrame { origin_px: photo.to_px(at), turn: photo.turn + turn + flat.turn, ..photo }
}
