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

/// Landmarks of both sides in the frame of an upright outline, the left side seen in a mirror.
pub(crate) struct SeenCorners([Vec<(Landmark, Point2)>; 2]);

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

impl SeenCorners {
    /// Of what is seen in the photo of an outline that lies there like `frame`.
    pub(crate) fn of(seen: &SeenGarment, upright: &Upright, frame: &PhotoFrame) -> Self {
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
        SeenCorners([side(0), side(1)])
    }

    /// A landmark of a side.
    fn at(&self, side: usize, name: Landmark) -> Option<Point2> {
        self.0[side].iter().find(|(other, _)| *other == name).map(|(_, p)| *p)
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
        let last = match form.ends_at(EdgeRole::Neck) {
            true => at(Landmark::NeckFront)?.y,
            false => at(Landmark::WaistRight)?.y,
        };
        let mut from = Point2::new(0.0, first);
        let mut edges = Vec::with_capacity(form.edges.len());
        for (k, e) in form.edges.iter().enumerate() {
            let next = form.edges.get(k + 1).map(|e| e.role);
            let between = |low: Point2, high: Point2, share: f64| low + (high - low) * share;
            let end = match (e.role, next) {
                (_, None) => Point2::new(0.0, last),
                (EdgeRole::Hem, _) if form.begins_at_fork() => at(Landmark::LegRightOuter)?,
                (EdgeRole::Hem, _) => at(Landmark::HemRight)?,
                (EdgeRole::Inseam, _) => at(Landmark::LegRightInner)?,
                (EdgeRole::Skirt | EdgeRole::Hip, _) => at(Landmark::WaistRight)?,
                (EdgeRole::Side, Some(EdgeRole::Hip)) => between(from, at(Landmark::WaistRight)?, HIP[0]),
                (EdgeRole::Outseam, _) => {
                    let waist = at(Landmark::WaistRight)?;
                    let beside = (first - from.y) / (waist.y - from.y).max(f64::MIN_POSITIVE);
                    between(from, waist, beside.clamp(0.0, 1.0) * (1.0 - HIP[1]) + HIP[1])
                }
                (EdgeRole::Side, Some(EdgeRole::Cuff)) => at(Landmark::CuffRightInner)?,
                (EdgeRole::Side, _) => at(Landmark::ArmpitRight)?,
                (EdgeRole::Underarm, _) => at(Landmark::CuffRightInner)?,
                (EdgeRole::Cuff, _) => at(Landmark::CuffRightOuter)?,
                (EdgeRole::Top | EdgeRole::Armhole, _) => at(Landmark::ShoulderRight)?,
                (EdgeRole::Shoulder, _) => at(Landmark::NeckRight)?,
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

    #[test]
    fn a_template_runs_through_all_landmarks_of_its_form() {
        let [right, left] = SeenCorners([shirt(), shirt()]).edges(&form::TEE, 0.0).unwrap();
        assert_eq!(right, left);
        let ends: Vec<Point2> = right.iter().map(|e| e.b).collect();
        assert_eq!(ends, shirt().into_iter().map(|(_, p)| p).collect::<Vec<_>>());
        assert_eq!(right[0].a, Point2::new(0.0, 0.0));
    }

    #[test]
    fn the_axis_runs_half_way_between_the_ends_of_the_hem() {
        let moved = |by: f64| shirt().into_iter().map(|(n, p)| (n, p + Vector2::new(by, 0.0))).collect();
        let corners = SeenCorners([moved(0.03), moved(-0.03)]);
        let shift = corners.shift(&form::TEE).unwrap();
        assert!((shift - 0.03).abs() < 1e-12, "{shift}");
        let [right, left] = corners.edges(&form::TEE, shift).unwrap();
        assert!((right[0].b - left[0].b).norm() < 1e-12 && (right[0].b.x - 0.26).abs() < 1e-12);
    }

    #[test]
    fn a_form_with_a_corner_that_is_not_seen_has_no_start() {
        let without = |name: Landmark| shirt().into_iter().filter(|(n, _)| *n != name).collect::<Vec<_>>();
        let corners = SeenCorners([shirt(), without(Landmark::ArmpitRight)]);
        assert_eq!(corners.edges(&form::TEE, 0.0), None);
        assert_eq!(SeenCorners([shirt(), shirt()]).edges(&form::TROUSERS, 0.0), None);
    }
}
