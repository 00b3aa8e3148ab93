//! A template's start from the landmarks that the network sees.
//!
//! Each edge of a form ends at a corner that has a name in the photo: an armpit, the end of a cuff,
//! the fork. Where the network sees all of them, a template is laid through them, and fitted from
//! there. It finds what the cut of an outline ([`crate::style::block::template::segment`]) does
//! not: a sleeve that lies along the body, a cuff among folds. Limits: corners that have no name (a
//! hip) are set at a usual share between those that have one.

use crate::style::block::template::bow::Bow;
use crate::style::block::template::form::Form;
use crate::style::block::template::halves::Upright;
use toile_core::artifact::{EdgeRole, PhotoFrame, Point2, Vector2};
use toile_recognise::{Landmark, SeenGarment};

/// Where a hip begins, as a share of the way from the hem of a skirt, or from the height of the
/// fork, to the waist.
const HIP: [f64; 2] = [0.75, 0.35];

/// Spread of seen corners about those of the right template, as a share of the garment's size, and
/// the square, in spreads, that one counts at most.
const SPREAD: f64 = 0.05;
const MOST: f64 = 9.0;

/// Landmarks of both sides in the frame of an upright outline, the left side seen in a mirror.
#[derive(Clone)]
pub(crate) struct SeenCorners {
    sides: [Vec<(Landmark, Point2)>; 2],
    /// Whether corners are drawn to them, beside the outline.
    are_pulled: bool,
}

/// A corner of a template that is drawn to where it is seen, or held where it is said to lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CornerPull {
    pub side: usize,
    /// The edge that ends there, or starts there where that is said.
    pub edge: usize,
    pub is_start: bool,
    /// In the frame of the upright outline.
    pub seen: Point2,
    /// Whether a person has said it.
    pub is_said: bool,
}

/// The landmarks of the right side of a picture, and those of its left.
const SIDES: [[Landmark; 9]; 2] = [
    [
        Landmark::NeckRight,
        Landmark::ShoulderRight,
        Landmark::ArmpitRight,
        Landmark::CuffRightOuter,
        Landmark::CuffRightInner,
        Landmark::WaistRight,
        Landmark::HemRight,
        Landmark::LegRightOuter,
        Landmark::LegRightInner,
    ],
    [
        Landmark::NeckLeft,
        Landmark::ShoulderLeft,
        Landmark::ArmpitLeft,
        Landmark::CuffLeftOuter,
        Landmark::CuffLeftInner,
        Landmark::WaistLeft,
        Landmark::HemLeft,
        Landmark::LegLeftOuter,
        Landmark::LegLeftInner,
    ],
];

/// Landmarks that lie on the axis.
const MIDDLE: [Landmark; 2] = [Landmark::NeckFront, Landmark::Fork];

/// The landmark, on the right side, at which an edge of a form ends; none where it has no name, or
/// lies on the axis.
pub(crate) fn named(form: &Form, k: usize) -> Option<Landmark> {
    let next = form.edges.get(k + 1).map(|e| e.role)?;
    match (form.edges[k].role, next) {
        (EdgeRole::Hem, _) if form.begins_at_fork() => Some(Landmark::LegRightOuter),
        (EdgeRole::Hem, _) => Some(Landmark::HemRight),
        (EdgeRole::Inseam, _) => Some(Landmark::LegRightInner),
        (EdgeRole::Skirt | EdgeRole::Hip, _) => Some(Landmark::WaistRight),
        (EdgeRole::Side, EdgeRole::Hip) => None,
        (EdgeRole::Side, EdgeRole::Cuff) => Some(Landmark::CuffRightInner),
        (EdgeRole::Side, _) => Some(Landmark::ArmpitRight),
        (EdgeRole::Underarm, _) => Some(Landmark::CuffRightInner),
        (EdgeRole::Cuff, _) => Some(Landmark::CuffRightOuter),
        (EdgeRole::Top | EdgeRole::Armhole, _) => Some(Landmark::ShoulderRight),
        (EdgeRole::Shoulder, _) => Some(Landmark::NeckRight),
        _ => None,
    }
}

impl SeenCorners {
    /// How far the corners of a template lie from where they are seen: the mean of squares, in
    /// spreads; 0 where none of them is seen. `corner` gives the end of an edge of a side, where it
    /// counts.
    pub(crate) fn astray(
        &self,
        form: &Form,
        size: f64,
        corner: impl Fn(usize, usize) -> Option<Point2>,
    ) -> f64 {
        let edges = (0..2).flat_map(|side| (0..form.edges.len()).map(move |k| (side, k)));
        let off = |(side, k): (usize, usize)| {
            let seen = self.at(side, named(form, k)?)?;
            Some(((corner(side, k)? - seen).norm() / (SPREAD * size)).powi(2).min(MOST))
        };
        let all: Vec<f64> = edges.filter_map(off).collect();
        all.iter().sum::<f64>() / all.len().max(1) as f64
    }

    /// Of what is seen in the photo of an outline that lies there like `frame`.
    /// In an outline that was opened along what the network sees (`are_pulled`) its corners are
    /// drawn to where it sees them: how far up it is opened does not show.
    pub(crate) fn of(seen: &SeenGarment, upright: &Upright, frame: &PhotoFrame, are_pulled: bool) -> Self {
        let place = |landmark: Landmark| {
            let found = seen.landmark(landmark)?;
            Some(upright.stood(frame.to_metres(found.place)))
        };
        let side = |k: usize| {
            let there = if frame.mirrored { 1 - k } else { k };
            // By the names of the right side.
            let pairs = SIDES[0].iter().zip(SIDES[there]);
            let outer = pairs.filter_map(|(name, seen)| Some((*name, place(seen)?)));
            let middle = MIDDLE.iter().filter_map(|name| Some((*name, place(*name)?)));
            let mirror = |p: Point2| Point2::new(if k == 0 { p.x } else { -p.x }, p.y);
            outer.chain(middle).map(|(name, p)| (name, mirror(p))).collect()
        };
        SeenCorners { sides: [side(0), side(1)], are_pulled }
    }

    /// With the corners of a form where a person has said that they lie.
    pub(crate) fn corrected(mut self, form: &Form, said: &[CornerPull]) -> Self {
        for pull in said {
            let name = if pull.is_start { Some(Landmark::Fork) } else { named(form, pull.edge) };
            let Some(name) = name else { continue };
            // The fork is a landmark of both sides.
            let sides = [0, 1].into_iter().filter(|side| pull.is_start || *side == pull.side);
            for side in sides {
                let place = Point2::new(if side == 0 { pull.seen.x } else { -pull.seen.x }, pull.seen.y);
                self.sides[side].retain(|(other, _)| *other != name);
                self.sides[side].push((name, place));
            }
        }
        self
    }

    /// A landmark of a side.
    fn at(&self, side: usize, name: Landmark) -> Option<Point2> {
        self.sides[side].iter().find(|(other, _)| *other == name).map(|(_, p)| *p)
    }

    /// The corners of a form that are drawn to where they are seen.
    pub(crate) fn pulls(&self, form: &Form) -> Vec<CornerPull> {
        let edges = (0..2).flat_map(|side| (0..form.edges.len()).map(move |edge| (side, edge)));
        let pull = |(side, edge): (usize, usize)| {
            let p = self.at(side, named(form, edge)?)?;
            let seen = Point2::new(if side == 0 { p.x } else { -p.x }, p.y);
            Some(CornerPull { side, edge, is_start: false, seen, is_said: false })
        };
        edges.filter(|_| self.are_pulled).filter_map(pull).collect()
    }

    /// Where the axis of a form runs: through the fork, or half-way between the ends of the hem.
    pub(crate) fn shift(&self, form: &Form) -> Option<f64> {
        let hem = |side: usize| Some(self.at(side, Landmark::HemRight)?.x);
        match form.begins_at_fork() {
            true => Some(self.at(0, Landmark::Fork)?.x),
            false => Some(0.5 * (hem(0)? - hem(1)?)),
        }
    }

    /// The edges of a form on both sides through the landmarks, in the frame of an axis at `shift`;
    /// `None` where one of them is not seen, or lies on the wrong side of the axis.
    pub(crate) fn edges(&self, form: &Form, shift: f64) -> Option<[Vec<Bow>; 2]> {
        Some([self.side(form, 0, shift)?, self.side(form, 1, -shift)?])
    }

    fn side(&self, form: &Form, side: usize, shift: f64) -> Option<Vec<Bow>> {
        let at = |name: Landmark| Some(self.at(side, name)? - Vector2::new(shift, 0.0));
        let first = match form.begins_at_fork() {
            true => at(Landmark::Fork)?.y,
            false => at(Landmark::HemRight)?.y,
        };
        let last = match form.edges.last()?.role {
            EdgeRole::Neck => at(Landmark::NeckFront)?.y,
            // The top of a hood has no name.
            EdgeRole::Crown => return None,
            _ => at(Landmark::WaistRight)?.y,
        };
        let mut from = Point2::new(0.0, first);
        let mut edges = Vec::with_capacity(form.edges.len());
        for (k, e) in form.edges.iter().enumerate() {
            let next = form.edges.get(k + 1).map(|e| e.role);
            let between = |low: Point2, high: Point2, share: f64| low + (high - low) * share;
            let end = match (named(form, k), e.role) {
                (Some(name), _) => at(name)?,
                (None, EdgeRole::Side) => between(from, at(Landmark::WaistRight)?, HIP[0]),
                (None, EdgeRole::Outseam) => {
                    let waist = at(Landmark::WaistRight)?;
                    let beside = (first - from.y) / (waist.y - from.y).max(f64::MIN_POSITIVE);
                    between(from, waist, beside.clamp(0.0, 1.0) * (1.0 - HIP[1]) + HIP[1])
                }
                (None, _) if next.is_none() => Point2::new(0.0, last),
                _ => return None,
            };
            let is_astray = next.is_some() && e.role != EdgeRole::Inseam && end.x <= 0.0;
            if is_astray || !(end - from).norm().is_normal() {
                return None;
            }
            edges.push(Bow { a: from, b: end, bow: [e.bow[0]; 2] });
            from = end;
        }
        Some(edges)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::style::block::template::form;

    /// The landmarks of a T-shirt, the same on both sides.
    fn shirt() -> Vec<(Landmark, Point2)> {
        let places = [
            (Landmark::HemRight, [0.26, 0.0]),
            (Landmark::ArmpitRight, [0.25, 0.42]),
            (Landmark::CuffRightInner, [0.36, 0.36]),
            (Landmark::CuffRightOuter, [0.44, 0.5]),
            (Landmark::ShoulderRight, [0.23, 0.64]),
            (Landmark::NeckRight, [0.09, 0.68]),
            (Landmark::NeckFront, [0.0, 0.6]),
        ];
        places.map(|(name, [x, y])| (name, Point2::new(x, y))).to_vec()
    }

    fn corners(sides: [Vec<(Landmark, Point2)>; 2]) -> SeenCorners {
        SeenCorners { sides, are_pulled: true }
    }

    #[test]
    fn a_template_runs_through_all_landmarks_of_its_form() {
        let [right, left] = corners([shirt(), shirt()]).edges(&form::TEE, 0.0).unwrap();
        assert_eq!(right, left);
        let ends: Vec<Point2> = right.iter().map(|e| e.b).collect();
        assert_eq!(ends, shirt().into_iter().map(|(_, p)| p).collect::<Vec<_>>());
        assert_eq!(right[0].a, Point2::new(0.0, 0.0));
    }

    #[test]
    fn the_axis_runs_half_way_between_the_ends_of_the_hem() {
        let moved = |by: f64| shirt().into_iter().map(|(n, p)| (n, p + Vector2::new(by, 0.0))).collect();
        let seen = corners([moved(0.03), moved(-0.03)]);
        let shift = seen.shift(&form::TEE).unwrap();
        assert!((shift - 0.03).abs() < 1e-12, "{shift}");
        let [right, left] = seen.edges(&form::TEE, shift).unwrap();
        assert!((right[0].b - left[0].b).norm() < 1e-12 && (right[0].b.x - 0.26).abs() < 1e-12);
    }

    #[test]
    fn a_template_through_the_landmarks_is_not_astray() {
        let seen = corners([shirt(), shirt()]);
        let edges = seen.edges(&form::TEE, 0.0).unwrap();
        let astray =
            |by: f64| seen.astray(&form::TEE, 0.5, |side, k| Some(edges[side][k].b + Vector2::new(0.0, by)));
        assert_eq!(astray(0.0), 0.0);
        assert!((astray(0.05) - 4.0).abs() < 1e-9 && (astray(1.0) - MOST).abs() < 1e-12);
    }

    #[test]
    fn a_form_with_a_corner_that_is_not_seen_has_no_start() {
        let without = |name: Landmark| shirt().into_iter().filter(|(n, _)| *n != name).collect::<Vec<_>>();
        let seen = corners([shirt(), without(Landmark::ArmpitRight)]);
        assert_eq!(seen.edges(&form::TEE, 0.0), None);
        assert_eq!(corners([shirt(), shirt()]).edges(&form::TROUSERS, 0.0), None);
    }
}
