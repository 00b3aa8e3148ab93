//! Where the landmarks of a garment lie in its photos, by its outlines.
//!
//! A landmark is the corner between two edges that have their names from the template.

use crate::style::block::template::piece_role::Layer;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// A landmark in a photo.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoLandmark {
    /// Its name, as `Block` takes it: `armpit_left`; left and right are the wearer's.
    pub name: String,
    /// The photo: `front` or `back`.
    pub photo: &'static str,
    /// The pixel of the photo's file, from its top left corner.
    pub place: Point2,
}

/// Two edges that meet in a landmark: its name before and behind the word of the hand.
const CORNERS: [([&str; 2], [&str; 2]); 21] = [
    (["side", "armhole"], ["armpit", ""]),
    (["side", "underarm"], ["armpit", ""]),
    (["armhole", "shoulder"], ["shoulder", ""]),
    (["shoulder", "neck"], ["neck", ""]),
    (["underarm", "cuff"], ["cuff", "_inner"]),
    (["side", "cuff"], ["cuff", "_inner"]),
    (["cuff", "top"], ["cuff", "_outer"]),
    (["cuff", "shoulder"], ["cuff", "_outer"]),
    (["hem", "side"], ["hem", ""]),
    (["hem", "skirt"], ["hem", ""]),
    (["skirt", "side"], ["waist", ""]),
    (["side", "waist"], ["waist", ""]),
    (["hip", "waist"], ["waist", ""]),
    (["side", "hip"], ["hip", ""]),
    (["outseam", "hip"], ["hip", ""]),
    (["inseam", "hem"], ["leg", "_inner"]),
    (["hem", "outseam"], ["leg", "_outer"]),
    (["inseam", "inseam"], ["fork", ""]),
    (["inseam", "rise"], ["fork", ""]),
    (["outseam", "waist"], ["waist", ""]),
    (["underarm", "cap"], ["armpit", ""]),
];

/// Where the landmarks of a garment lie in the photos that it was cut from, by the outlines of its
/// pieces as a style leaves them; each once for a photo, in the order of their names.
pub fn landmarks<'a>(outlines: impl IntoIterator<Item = (&'a str, &'a Outline)>) -> Vec<PhotoLandmark> {
    let mut found: BTreeMap<(&'static str, String), Point2> = BTreeMap::new();
    for (piece, outline) in outlines {
        let photo = Layer::of_name(piece).word();
        let of_piece = Hand::BOTH.into_iter().find(|hand| piece.starts_with(hand.word()));
        let has_legs = outline.edges.iter().any(|e| stem(&e.name).0 == "inseam");
        for (k, edge) in outline.edges.iter().enumerate() {
            let next = &outline.edges[(k + 1) % outline.edges.len()];
            let Some(place) = outline.to_px(outline.outer.points[edge.end]) else { continue };
            let ((a, hand), (b, other)) = (stem(&edge.name), stem(&next.name));
            if let Some(name) = corner([a, b], hand.or(other).or(of_piece), has_legs) {
                found.entry((photo, name)).or_insert(place);
            }
        }
    }
    found.into_iter().map(|((photo, name), place)| PhotoLandmark { name, photo, place }).collect()
}

/// The word of an edge and its hand, without the number of its part.
fn stem(edge: &str) -> (&str, Option<Hand>) {
    let is_number = |part: &str| part.trim_end_matches('\'').parse::<usize>().is_ok();
    let whole = edge.rsplit_once('_').filter(|(_, part)| is_number(part)).map_or(edge, |(whole, _)| whole);
    Hand::split(whole)
}

/// The landmark in which two edges meet; the sides of what has legs end at their hems.
fn corner(edges: [&str; 2], hand: Option<Hand>, has_legs: bool) -> Option<String> {
    let is_of = |pair: &[&str; 2]| *pair == edges || [pair[1], pair[0]] == edges;
    let (_, [of, end]) = CORNERS.iter().find(|(pair, _)| is_of(pair))?;
    Some(match (*of, hand) {
        ("fork", _) => "fork".to_owned(),
        ("hem", Some(hand)) if has_legs => format!("leg_{hand}_outer"),
        (of, Some(hand)) => format!("{of}_{hand}{end}"),
        (_, None) => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_named_whichever_way_their_edges_run() {
        let named = |a, b, hand, legs| corner([stem(a).0, stem(b).0], hand, legs);
        let left = Some(Hand::Left);
        assert_eq!(named("side_left", "armhole_left", left, false).as_deref(), Some("armpit_left"));
        assert_eq!(
            named("armhole_right", "side_right", Some(Hand::Right), false).as_deref(),
            Some("armpit_right")
        );
        assert_eq!(named("cuff", "top", left, false).as_deref(), Some("cuff_left_outer"));
        assert_eq!(named("hem_left", "side_left", left, true).as_deref(), Some("leg_left_outer"));
        assert_eq!(named("inseam_left", "inseam_right", left, true).as_deref(), Some("fork"));
        assert_eq!(named("neck_1", "neck_2", None, false), None);
        assert_eq!(stem("neck_left_2'"), ("neck", left));
    }
}
