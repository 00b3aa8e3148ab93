//! Corners of a garment where a person says that they lie.
//!
//! A landmark is named as tailors name it: left and right are the wearer's. The place that is said
//! is somewhere near the outline; what counts is the nearest place of it, at which the corner of
//! the template is held. What is said far off the outline, or on the wrong side, is refused.

use crate::mesh::predicates::{distance_to_segment, inside};
use crate::style::block::template::form::Form;
use crate::style::block::template::halves::Upright;
use crate::style::block::template::piece_role::Layer;
use crate::style::block::template::seen::{CornerPull, named};
use std::collections::BTreeMap;
use toile_core::nearest;
use toile_core::prelude::*;

/// Where landmarks are said to lie, as shares of a photo's width and height.
type SaidPlaces = BTreeMap<String, (f64, f64)>;
/// The forms of garments with their names.
type NamedForms = Vec<(&'static str, &'static Form)>;

/// What has no hand.
const FORK: &str = "fork";
/// Names of landmarks before and behind the word of the hand.
const PARTS: [(&str, &str); 10] = [
    ("neck", ""),
    ("shoulder", ""),
    ("armpit", ""),
    ("cuff", "_outer"),
    ("cuff", "_inner"),
    ("waist", ""),
    ("hip", ""),
    ("hem", ""),
    ("leg", "_outer"),
    ("leg", "_inner"),
];
/// A landmark is said no farther from the outline than this share of the garment's size (the root
/// of its area).
const FAR: f64 = 0.15;
/// And no farther on the other side of the axis.
const BEYOND: f64 = 0.03;

/// The names of all landmarks.
fn names() -> Vec<String> {
    let both = PARTS.iter().flat_map(|(of, end)| Hand::BOTH.map(|hand| format!("{of}_{hand}{end}")));
    both.chain([FORK.to_owned()]).collect()
}

/// The landmark at which an edge of a form ends; none on the axis.
fn name(form: &Form, k: usize, hand: Hand) -> Option<String> {
    let next = form.edges.get(k + 1)?;
    let seen = named(form, k).map(|l| l.name().replace(Hand::Right.word(), hand.word()));
    seen.or_else(|| (next.role == EdgeRole::Hip).then(|| hand.name("hip")))
}

/// The landmarks of a form.
fn names_of(form: &Form) -> Vec<String> {
    let ends = (0..form.edges.len()).flat_map(|k| Hand::BOTH.map(|hand| name(form, k, hand)));
    let fork = form.begins_at_fork().then(|| FORK.to_owned());
    ends.flatten().chain(fork).collect()
}

/// The photo and the landmark of a key such as `back.armpit_left`.
fn parted(key: &str) -> (Layer, &str) {
    let behind = key.strip_prefix(Layer::Back.word()).and_then(|rest| rest.strip_prefix('.'));
    match behind {
        Some(name) => (Layer::Back, name),
        None => (Layer::Front, key),
    }
}

fn at(e: StageError, key: &str) -> StageError {
    e.at("landmarks").within(key)
}

/// Refuses names that no garment has.
pub(crate) fn known(said: &SaidPlaces) -> Result<(), StageError> {
    let all = names();
    let Some(key) = said.keys().find(|key| !all.iter().any(|n| n == parted(key).1)) else { return Ok(()) };
    let wrong = parted(key).1;
    let hint = match nearest(wrong, all.iter().map(String::as_str)) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("the landmarks are {}", all.join(", ")),
    };
    let e = StageError::new(ErrorCode::InvalidParameter, format!("there is no landmark \"{wrong}\""));
    Err(at(e.hint(hint), key))
}

/// The forms that have every landmark that is said.
///
/// # Errors
/// None of them has; or a name that no garment has.
pub(crate) fn with_all(forms: NamedForms, said: &SaidPlaces) -> Result<NamedForms, StageError> {
    known(said)?;
    let lacking = |form: &Form| {
        let own = names_of(form);
        said.keys().find(|key| !own.iter().any(|n| n == parted(key).1))
    };
    let left: NamedForms = forms.iter().copied().filter(|(_, form)| lacking(form).is_none()).collect();
    match (left.is_empty(), &forms[..]) {
        (false, _) => Ok(left),
        (true, [(_, form)]) => {
            let key = lacking(form).cloned().unwrap_or_default();
            let e = StageError::invalid(format!("{} has no landmark \"{}\"", form.word, parted(&key).1))
                .hint(format!("its landmarks are {}", names_of(form).join(", ")));
            Err(at(e, &key))
        }
        (true, _) => {
            let all: Vec<String> = said.keys().map(|key| format!("\"{key}\"")).collect();
            let e = StageError::invalid(format!("no garment has all of these landmarks: {}", all.join(", ")));
            Err(e.hint("take those out that it does not have").at("landmarks"))
        }
    }
}

/// Refuses landmarks of a photo that there is not.
pub(crate) fn none_of(panel: &str, said: &SaidPlaces) -> Result<(), StageError> {
    let of = |key: &&String| parted(key).0 == Layer::of_name(panel);
    match said.keys().find(of) {
        Some(key) => {
            let e = StageError::invalid(format!(
                "\"{key}\" is said of the {panel}, which has no photo of its own"
            ))
            .hint(format!("it is cut as the front is: say \"{}\"", parted(key).1));
            Err(at(e, key))
        }
        None => Ok(()),
    }
}

/// The landmarks that are said of a photo, at the nearest places of its outline.
pub(crate) struct SaidCorners {
    layer: Layer,
    /// In the outline as it is given, metres.
    at: Vec<(String, Point2)>,
}

impl SaidCorners {
    /// Of the photo of a panel, in which its outline lies.
    ///
    /// # Errors
    /// A landmark far from the outline, or on the other side of the garment.
    pub(crate) fn of(
        said: &SaidPlaces,
        panel: &str,
        outline: &Outline,
        photo: Option<&Photo>,
        upright: &Upright,
    ) -> Result<Self, StageError> {
        let layer = Layer::of_name(panel);
        let mut found = Vec::new();
        for (key, (x, y)) in said.iter().filter(|(key, _)| parted(key).0 == layer) {
            let Some((photo, frame)) = photo.zip(outline.frame) else {
                let e =
                    StageError::invalid(format!("there is no photo of the {panel} in which \"{key}\" lies"));
                return Err(at(e.hint("take `landmarks` out"), key));
            };
            let frame = frame.joined(photo.joined);
            let (w, h) = photo.pixels.dimensions();
            let place = frame.to_metres(Point2::new(x * f64::from(w) - 0.5, y * f64::from(h) - 0.5));
            let (near, off) = nearest_place(&outline.outer.points, place);
            if off > FAR * upright.size {
                let px = frame.to_px(near);
                let share = [(px.x + 0.5) / f64::from(w), (px.y + 0.5) / f64::from(h)];
                return Err(at(far(key, &outline.outer.points, place, off, share), key));
            }
            let name = parted(key).1;
            let side = side(name, layer);
            let across = upright.stood(near).x * if side == Some(1) { -1.0 } else { 1.0 };
            if side.is_some() && across < -BEYOND * upright.size {
                return Err(at(other_side(key, name), key));
            }
            found.push((name.to_owned(), near));
        }
        Ok(SaidCorners { layer, at: found })
    }

    /// The corners of a form that are held.
    pub(crate) fn pulls(&self, form: &Form, upright: &Upright) -> Vec<CornerPull> {
        let pull = |(said, place): &(String, Point2)| {
            let seen = upright.stood(*place);
            if said == FORK {
                return Some(CornerPull { side: 0, edge: 0, is_start: true, seen, is_said: true });
            }
            let side = side(said, self.layer)?;
            let hand = self.layer.hand(side);
            let edge = (0..form.edges.len()).find(|k| name(form, *k, hand).as_ref() == Some(said))?;
            Some(CornerPull { side, edge, is_start: false, seen, is_said: true })
        };
        self.at.iter().filter_map(pull).collect()
    }
}

/// The side of the template on which a landmark lies; none for one on the axis.
fn side(name: &str, layer: Layer) -> Option<usize> {
    let is_of = |side: &usize| name.split('_').any(|word| word == layer.hand(*side).word());
    (0..2).find(is_of)
}

/// The nearest place of a closed line, and how far it is.
fn nearest_place(points: &[Point2], p: Point2) -> (Point2, f64) {
    let n = points.len();
    let mut best = (p, f64::INFINITY);
    for i in 0..n {
        let (a, b) = (points[i], points[(i + 1) % n]);
        let (off, t) = distance_to_segment(p, a, b);
        if off < best.1 {
            best = (a + (b - a) * t, off);
        }
    }
    best
}

fn far(key: &str, outline: &[Point2], place: Point2, off: f64, [x, y]: [f64; 2]) -> StageError {
    let mm = off * 1e3;
    let what = match inside(outline, place) {
        true => format!(
            "\"{key}\" is said to lie {mm:.0} mm within the garment, and landmarks lie on its outline"
        ),
        false => format!("\"{key}\" is said to lie {mm:.0} mm outside of the garment"),
    };
    StageError::invalid(what).hint(format!(
        "the nearest place of its outline is ({x:.3}, {y:.3}): shares of the photo's width and height, from its top left corner"
    ))
}

fn other_side(key: &str, name: &str) -> StageError {
    let (left, right) = (Hand::Left.word(), Hand::Right.word());
    let other = match name.contains(left) {
        true => name.replace(left, right),
        false => name.replace(right, left),
    };
    StageError::invalid(format!("\"{key}\" is said to lie on the other side of the garment"))
        .hint(format!("left and right are the wearer's: call it \"{other}\""))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::style::block::template::form;

    fn said(keys: &[&str]) -> SaidPlaces {
        keys.iter().map(|k| ((*k).to_owned(), (0.5, 0.5))).collect()
    }

    #[test]
    fn landmarks_are_named_as_tailors_name_them() {
        assert_eq!(
            names_of(&form::TEE),
            [
                "hem_left",
                "hem_right",
                "armpit_left",
                "armpit_right",
                "cuff_left_inner",
                "cuff_right_inner",
                "cuff_left_outer",
                "cuff_right_outer",
                "shoulder_left",
                "shoulder_right",
                "neck_left",
                "neck_right"
            ]
        );
        assert_eq!(
            names_of(&form::TROUSERS),
            [
                "leg_left_inner",
                "leg_right_inner",
                "leg_left_outer",
                "leg_right_outer",
                "hip_left",
                "hip_right",
                "waist_left",
                "waist_right",
                "fork"
            ]
        );
    }

    #[test]
    fn every_landmark_of_a_form_is_known() {
        for form in [&form::VEST, &form::DRESS, &form::LONG, &form::GROWN, &form::SKIRT, &form::ONEPIECE] {
            assert!(names_of(form).iter().all(|n| names().contains(n)), "{}", form.word);
        }
    }

    #[test]
    fn a_name_that_no_garment_has_is_refused_with_the_nearest() {
        let e = known(&said(&["armpit_lft"])).unwrap_err();
        assert_eq!(e.message, "there is no landmark \"armpit_lft\"");
        assert_eq!(e.hint.as_deref(), Some("did you mean \"armpit_left\"?"));
        let e = known(&said(&["back.elbow"])).unwrap_err();
        assert_eq!(e.message, "there is no landmark \"elbow\"");
        assert!(e.hint.unwrap().starts_with("the landmarks are neck_left, neck_right, shoulder_left,"));
        assert_eq!(known(&said(&["armpit_left", "back.fork"])), Ok(()));
    }

    #[test]
    fn only_forms_that_have_what_is_said_come_into_question() {
        let forms = || vec![("TShirt", &form::TEE), ("Skirt", &form::SKIRT)];
        let left = |keys: &[&str]| with_all(forms(), &said(keys));
        let names = |forms: NamedForms| forms.iter().map(|f| f.0).collect::<Vec<_>>();
        assert_eq!(names(left(&["armpit_left"]).unwrap()), ["TShirt"]);
        assert_eq!(names(left(&["hem_left"]).unwrap()), ["TShirt", "Skirt"]);
        let e = left(&["armpit_left", "hip_left"]).unwrap_err();
        assert_eq!(e.message, "no garment has all of these landmarks: \"armpit_left\", \"hip_left\"");
        let e = with_all(vec![("Skirt", &form::SKIRT)], &said(&["armpit_left"])).unwrap_err();
        assert_eq!(e.message, "a skirt has no landmark \"armpit_left\"");
        assert_eq!(
            e.hint.as_deref(),
            Some("its landmarks are hem_left, hem_right, hip_left, hip_right, waist_left, waist_right")
        );
    }
}
