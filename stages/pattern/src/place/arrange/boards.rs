//! Pieces that stand flat before the body and behind it, and the seams between them.
//!
//! A garment that starts with its shoulder seams in the shoulders would be sewn through them, and
//! slide down. It is raised as a whole until they are free. Cost: some milliseconds.

use super::PiecePlaces;
use crate::place::sew::Offsets;
use toile_body::DepthMap;
use toile_core::prelude::*;

/// The most steps by which a garment is raised.
const MOST_STEPS: u32 = 30;
/// One of them, metres.
const STEP: f64 = 0.005;
/// Depth within which a piece counts as flat, metres.
const FLAT: f64 = 1e-6;

/// A piece that stands flat.
pub(super) struct Board<'a> {
    points: &'a [Point3],
    first: usize,
    is_leg: bool,
}

impl Board<'_> {
    /// True before the body.
    fn is_before(&self) -> bool {
        self.points.first().is_some_and(|p| p.z > 0.0)
    }

    fn place(&self, v: u32) -> Option<Point3> {
        self.points.get((v as usize).checked_sub(self.first)?).copied()
    }
}

/// The pieces of trunk and legs, where all of them stand flat; none where one of them does not,
/// unless `some` are asked for: a collar that lies around the neck and the ring of a skirt's panels
/// say nothing against a trunk that stands flat. `sleeves` are known by other means.
pub(super) fn boards<'a>(
    pattern: &Pattern,
    sleeves: &[String],
    places: &'a PiecePlaces,
    offsets: &Offsets,
    some: bool,
) -> Vec<Board<'a>> {
    let part = |name: &str| pattern.piece(name).and_then(|p| p.body_part);
    let is_worn_there = |name: &str| {
        !matches!(part(name), Some(BodyPart::Arm | BodyPart::Head)) && !sleeves.iter().any(|s| s == name)
    };
    let board = |(name, points): (&'a String, &'a Vec<Point3>)| {
        let (first, _) = *offsets.get(name.as_str())?;
        let z = points.first()?.z;
        points.iter().all(|p| (p.z - z).abs() < FLAT).then_some(Board {
            points,
            first,
            is_leg: part(name) == Some(BodyPart::Leg),
        })
    };
    let found = places.iter().filter(|(name, _)| is_worn_there(name)).map(board);
    match some {
        true => found.flatten().collect(),
        false => found.collect::<Option<_>>().unwrap_or_default(),
    }
}

/// The places of the pairs of seams between pieces on either side of the trunk.
fn threads(boards: &[Board<'_>], seams: &[GarmentSeam]) -> Vec<[Point3; 2]> {
    let trunk = || boards.iter().filter(|b| !b.is_leg);
    let find = |v: u32| trunk().find_map(|b| Some((b.is_before(), b.place(v)?)));
    let across = |[a, b]: &[u32; 2]| {
        let ((one, p), (other, q)) = (find(*a)?, find(*b)?);
        (one != other).then_some([p, q])
    };
    seams.iter().flat_map(|s| &s.pairs).filter_map(across).collect()
}

/// How far the garment must be raised for its shoulder seams to be free, or most of them, metres.
pub(super) fn raise(boards: &[Board<'_>], seams: &[GarmentSeam], body: &Body) -> f64 {
    let [shoulder, armpit] = ["shoulder", "armpit"].map(|name| body.landmark(name, Hand::Left));
    let (Some(shoulder), Some(armpit)) = (shoulder, armpit) else { return 0.0 };
    let (threads, depths) = (threads(boards, seams), DepthMap::new(body));
    let blocked = |by: f64| {
        let is_blocked = |ends: &&[Point3; 2]| {
            let [p, q] = ends.map(|p| p + Vector3::new(0.0, by, 0.0));
            let middle = nalgebra::center(&p, &q);
            middle.x.abs() <= shoulder.x.abs() && middle.y > armpit.y && depths.is_between(&p, &q)
        };
        threads.iter().filter(is_blocked).count()
    };
    let mut best = (blocked(0.0), 0);
    for k in 1..=MOST_STEPS {
        if best.0 == 0 {
            break;
        }
        best = best.min((blocked(f64::from(k) * STEP), k));
    }
    f64::from(best.1) * STEP
}
