//! Pieces that stand flat before the body and behind it, and the seams between them.
//!
//! A garment that starts with its shoulder seams in the shoulders would be sewn through them. It is
//! raised as a whole until they are free. Where the body stands between the sides of another seam,
//! as an arm does that is spread otherwise than the sleeve, it is told. Cost: some milliseconds.

use super::PiecePlaces;
use super::depth::DepthMap;
use crate::place::sew::Offsets;
use toile_core::prelude::*;

/// How far a garment is raised at most, and in what steps, metres.
const RAISES: (u32, f64) = (30, 0.005);
/// Distance that a seam should keep from the skin on its way, metres.
const CLEARANCE: f64 = 0.006;
/// Share of a seam's pairs that may have flesh between them; the cloth slips off a little.
const MAX_BLOCKED: f64 = 0.5;
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

/// The pieces of trunk and legs, where all of them stand flat; none where one of them does not.
/// `sleeves` are known by other means.
pub(super) fn boards<'a>(
    pattern: &Pattern,
    sleeves: &[String],
    places: &'a PiecePlaces,
    offsets: &Offsets,
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
    let found: Option<Vec<Board<'a>>> =
        places.iter().filter(|(name, _)| is_worn_there(name)).map(board).collect();
    found.unwrap_or_default()
}

/// For each seam the places of its pairs that lie on either side of the trunk.
type Threads<'s> = Vec<(&'s str, Vec<[Point3; 2]>)>;

fn threads<'s>(boards: &[Board<'_>], seams: &'s [GarmentSeam]) -> Threads<'s> {
    let trunk = || boards.iter().filter(|b| !b.is_leg);
    let find = |v: u32| trunk().find_map(|b| Some((b.is_before(), b.place(v)?)));
    let across = |[a, b]: &[u32; 2]| {
        let ((one, p), (other, q)) = (find(*a)?, find(*b)?);
        (one != other).then_some([p, q])
    };
    seams.iter().map(|s| (s.name.as_str(), s.pairs.iter().filter_map(across).collect())).collect()
}

/// How far the garment must be raised for its shoulder seams to be free, or most of them, metres.
pub(super) fn raise(boards: &[Board<'_>], seams: &[GarmentSeam], body: &Body) -> f64 {
    let [shoulder, armpit] = ["shoulder", "armpit"].map(|name| body.landmark(name, Hand::Left));
    let (Some(shoulder), Some(armpit)) = (shoulder, armpit) else { return 0.0 };
    let (threads, depths) = (threads(boards, seams), DepthMap::new(body));
    let blocked = |by: f64| {
        let over = |[p, q]: &&[Point3; 2]| {
            let middle = nalgebra::center(p, q);
            middle.x.abs() <= shoulder.x.abs() && middle.y + by > armpit.y
        };
        let pairs = threads.iter().flat_map(|t| &t.1).filter(over);
        pairs.filter(|pair| is_blocked(&depths, pair, by)).count()
    };
    let (most, step) = RAISES;
    let mut best = (blocked(0.0), 0);
    for k in 1..=most {
        if best.0 == 0 {
            break;
        }
        best = best.min((blocked(f64::from(k) * step), k));
    }
    f64::from(best.1) * step
}

/// Whether the body stands between two places, raised by so much.
fn is_blocked(depths: &DepthMap, [p, q]: &[Point3; 2], by: f64) -> bool {
    let middle = nalgebra::center(p, q);
    let (near, far) = (p.z.min(q.z), p.z.max(q.z));
    let span = |dy: f64| depths.span(middle.x, middle.y + by + dy);
    [-CLEARANCE, CLEARANCE].into_iter().filter_map(span).any(|(lo, hi)| near < hi && lo < far)
}

/// A sentence for each seam that starts with the body between its sides.
pub(super) fn in_the_way(boards: &[Board<'_>], seams: &[GarmentSeam], body: &Body) -> Vec<String> {
    let depths = DepthMap::new(body);
    let told = |(name, pairs): (&str, Vec<[Point3; 2]>)| {
        let blocked = pairs.iter().filter(|pair| is_blocked(&depths, pair, 0.0)).count();
        (blocked as f64 > MAX_BLOCKED * pairs.len() as f64).then(|| {
            format!(
                "the seam {name} starts with the body between {blocked} of its {} pairs; arms spread like the \
                 sleeves would free it (the mannequin's `arm_angle`)",
                pairs.len()
            )
        })
    };
    threads(boards, seams).into_iter().filter_map(told).collect()
}
