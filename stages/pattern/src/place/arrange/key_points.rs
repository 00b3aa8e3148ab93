//! Pieces that the user places: points of their edges at landmarks of the body.
//!
//! Method: the rigid move that brings the points nearest to their landmarks (Kabsch 1976). Turns
//! that the points leave open, where there is one or all lie on a line, are as small as can be from
//! where the pattern has the piece, or else from a piece that looks away from the body. The piece
//! is then moved outwards. Cost: linear in vertices. Limits: a piece stays flat.

use super::{PiecePlaces, unknown};
use crate::place::sew::{Offsets, vertices};
use nalgebra::Matrix3;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::prelude::*;

/// The weight of the turn that a piece has before, as a share of that of its key points.
const BEFORE: f64 = 1e-9;

/// A point of a piece, and where on the body it goes.
#[choice]
pub struct KeyPoint {
    /// The edge or inner line on which it lies, `"piece.edge"`.
    pub edge: EdgeRef,
    /// Its share of the way along the edge: 0 at the start, 1 at the end.
    pub at: f64,
    /// The landmark of the body, such as `"neck_base_back"`.
    pub landmark: String,
}

/// The pieces that have key points.
pub(super) fn names(key_points: &[KeyPoint]) -> BTreeSet<String> {
    key_points.iter().map(|k| k.edge.panel.clone()).collect()
}

/// Where the vertices of those pieces stand, and a sentence for each.
///
/// Errors: pieces, edges and landmarks that do not exist.
pub(super) fn place(
    key_points: &[KeyPoint],
    pattern: &Pattern,
    flat: &Offsets,
    body: &Body,
    clearance: f64,
) -> Result<(PiecePlaces, Vec<String>), StageError> {
    let mut pairs: BTreeMap<&str, Vec<(Point2, Point3)>> = BTreeMap::new();
    for k in key_points {
        let pair = (point(k, flat).map_err(at_key_points)?, landmark(k, body)?);
        pairs.entry(&k.edge.panel).or_default().push(pair);
    }
    let (mut places, mut told) = (PiecePlaces::new(), Vec::new());
    for (name, pairs) in &pairs {
        let Some((_, panel)) = flat.get(name) else { return Err(unknown(name)) };
        let before = pattern.piece(name).and_then(|p| p.pose).unwrap_or_else(|| away(pairs, body));
        let pose = nearest(pairs, &before);
        let off = pairs.iter().map(|(p, q)| (pose.at(*p) - q).norm()).fold(0.0, f64::max);
        told.push(match pairs.len() {
            1 => format!("\"{name}\" hangs at its key point"),
            n => format!(
                "\"{name}\" stands at its {n} key points, at most {:.0} mm from their landmarks",
                off * 1e3
            ),
        });
        let outwards = pose.outside() * clearance;
        places.insert((*name).to_owned(), panel.positions.iter().map(|p| pose.at(*p) + outwards).collect());
    }
    Ok((places, told))
}

fn at_key_points(e: StageError) -> StageError {
    e.at("key_points")
}

/// Where a key point lies in its piece.
fn point(key: &KeyPoint, flat: &Offsets) -> Result<Point2, StageError> {
    let on_edge = vertices(&key.edge, flat)?;
    let Some((first, panel)) = flat.get(key.edge.panel.as_str()) else {
        return Err(unknown(&key.edge.panel));
    };
    let points = on_edge.iter().map(|v| panel.positions[*v as usize - first]).collect();
    let path = EdgePath::polyline(points);
    Ok(path.at(key.at * path.length()))
}

fn landmark(key: &KeyPoint, body: &Body) -> Result<Point3, StageError> {
    body.landmarks.get(&key.landmark).copied().ok_or_else(|| {
        let known: Vec<String> = body.landmarks.keys().map(|name| format!("\"{name}\"")).collect();
        let hint = match known.is_empty() {
            true => {
                "this body has no landmarks: take a Mannequin, or a body of which they are found".to_owned()
            }
            false => format!("its landmarks are {}", known.join(", ")),
        };
        at_key_points(StageError::invalid(format!("the body has no landmark \"{}\"", key.landmark)))
            .hint(hint)
    })
}

/// A piece that stands upright and looks away from the body: forwards, where its key points lie
/// before the middle of the body, and backwards where they lie behind it.
fn away(pairs: &[(Point2, Point3)], body: &Body) -> Pose {
    let mean = |z: &mut dyn Iterator<Item = f64>, n: usize| z.sum::<f64>() / n.max(1) as f64;
    let middle = mean(&mut body.positions.iter().map(|p| p.z), body.positions.len());
    let own = mean(&mut pairs.iter().map(|(_, q)| q.z), pairs.len());
    let across = if own < middle { -Vector3::x() } else { Vector3::x() };
    Pose { origin: Point3::origin(), across, along: Vector3::y() }
}

/// The pose that brings the points nearest to their landmarks.
fn nearest(pairs: &[(Point2, Point3)], before: &Pose) -> Pose {
    let n = pairs.len().max(1) as f64;
    let from = pairs.iter().map(|(p, _)| p.coords).sum::<Vector2>() / n;
    let to = pairs.iter().map(|(_, q)| q.coords).sum::<Vector3>() / n;
    let prior = Matrix3::from_columns(&[before.across, before.along, before.outside()]);
    let (mut sum, mut size) = (Matrix3::zeros(), 0.0);
    for (p, q) in pairs {
        let (p, q) = (p.coords - from, q.coords - to);
        sum += q * Vector3::new(p.x, p.y, 0.0).transpose();
        size += q.norm() * p.norm();
    }
    let svd = (sum + prior * (BEFORE * size).max(f64::MIN_POSITIVE.sqrt())).svd(true, true);
    let turn = match (svd.u, svd.v_t) {
        (Some(mut u), Some(v_t)) => {
            // The least singular value comes last, and gives way where a mirror image fits better.
            let mirrored = (u * v_t).determinant() < 0.0;
            u.column_mut(2).scale_mut(if mirrored { -1.0 } else { 1.0 });
            u * v_t
        }
        _ => prior,
    };
    let (across, along) = (turn.column(0).into_owned(), turn.column(1).into_owned());
    Pose { origin: Point3::from(to - across * from.x - along * from.y), across, along }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn body(landmarks: &[(&str, Point3)]) -> Body {
        Body {
            positions: vec![Point3::origin()],
            triangles: vec![],
            landmarks: landmarks.iter().map(|(n, p)| ((*n).to_owned(), *p)).collect(),
            measurements: BTreeMap::new(),
        }
    }

    fn upright() -> Pose {
        away(&[(Point2::origin(), Point3::new(0.0, 0.0, 1.0))], &body(&[]))
    }

    #[test]
    fn one_key_point_moves_a_piece_and_does_not_turn_it() {
        let landmark = Point3::new(0.1, 1.4, 0.12);
        let pose = nearest(&[(Point2::new(0.3, 0.2), landmark)], &upright());
        assert!((pose.at(Point2::new(0.3, 0.2)) - landmark).norm() < 1e-12);
        assert!((pose.outside() - Vector3::z()).norm() < 1e-12);
    }

    #[test]
    fn two_key_points_turn_it_no_more_than_they_must() {
        let pairs = [
            (Point2::new(-0.1, 0.0), Point3::new(0.0, 1.0, 0.1)),
            (Point2::new(0.1, 0.0), Point3::new(0.0, 1.2, 0.1)),
        ];
        let pose = nearest(&pairs, &upright());
        pairs.iter().for_each(|(p, q)| assert!((pose.at(*p) - q).norm() < 1e-6));
        assert!((pose.outside() - Vector3::z()).norm() < 1e-5);
    }

    #[test]
    fn a_piece_behind_the_body_looks_backwards() {
        let behind = away(&[(Point2::origin(), Point3::new(0.0, 1.0, -0.1))], &body(&[]));
        assert_eq!(behind.outside(), -Vector3::z());
    }

    #[test]
    fn a_landmark_that_the_body_has_not_is_told_with_those_that_it_has() {
        let edge = EdgeRef { panel: "front".into(), edge: "neck".into() };
        let key = |landmark: &str| KeyPoint { edge: edge.clone(), at: 0.5, landmark: landmark.into() };
        let own = body(&[("crotch", Point3::origin()), ("neck_left", Point3::origin())]);
        let e = landmark(&key("nek_left"), &own).unwrap_err();
        assert_eq!(e.message, "the body has no landmark \"nek_left\"");
        assert_eq!(e.hint.unwrap(), "its landmarks are \"crotch\", \"neck_left\"");
    }

    proptest! {
        #[test]
        fn points_that_were_moved_rigidly_are_met(
            (x, y, z) in (-3.0f64..3.0, -3.0f64..3.0, -3.0f64..3.0),
            flat in prop::collection::vec((-0.5f64..0.5, -0.5f64..0.5), 3..7),
        ) {
            let turn = nalgebra::Rotation3::from_euler_angles(x, y, z);
            let moved = |p: &Point2| turn * Point3::new(p.x, p.y, 0.0) + Vector3::new(x, y, z);
            let pairs: Vec<(Point2, Point3)> =
                flat.iter().map(|(x, y)| Point2::new(*x, *y)).map(|p| (p, moved(&p))).collect();
            let pose = nearest(&pairs, &upright());
            let size = flat.iter().map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
            for (p, q) in &pairs {
                prop_assert!((pose.at(*p) - q).norm() < 1e-4 * size.max(1e-3));
            }
            prop_assert!((pose.across.norm() - 1.0).abs() < 1e-9);
            prop_assert!(pose.across.dot(&pose.along).abs() < 1e-9);
        }
    }
}
