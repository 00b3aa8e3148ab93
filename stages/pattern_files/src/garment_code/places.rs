//! Where pieces stand in the file; the format wants a place for each.
//!
//! Pieces that have none stand side by side, to the right of those that have one. Method: each is
//! turned so that its stitches do not run against the way in which it stands: readers take the
//! wrong direction of a stitch from the edges' directions in space. Of the 24 turns about the axes
//! the first is taken with which the fewest stitches run so, beginning with the piece that has most
//! stitches to those that stand already; then each is looked at again. Cost: pieces squared times
//! stitches. Limits: there may be no such turn; and the places are no garment around a body, which
//! is told.

use super::stitches::{CurveStitch, CurvesOfEdges};
use toile_core::artifact::{Piece, Point3, Pose, Vector2, Vector3};

/// Between pieces that have no place, metres.
const GAP: f64 = 0.1;
/// A stitch runs against its edges where their directions agree by more than this cosine; readers
/// ask for 0.5.
const AGAINST: f64 = 0.45;
/// Readers do not look at shorter edges, metres.
const SHORT: f64 = 0.04;
/// How often every piece is looked at again.
const ROUNDS: usize = 4;

/// The place of each piece; that some have none is told.
pub(super) fn poses(
    pieces: &[Piece],
    curves: &CurvesOfEdges,
    stitches: &[CurveStitch],
    notes: &mut Vec<String>,
) -> Vec<Pose> {
    let missing = pieces.iter().filter(|p| p.pose.is_none()).count();
    if missing > 0 {
        notes.push(format!("{missing} pieces have no place around the body: put side by side in the file"));
    }
    let mut poses = turned(pieces, &chords(curves, stitches));
    let placed = pieces.iter().zip(&poses).filter(|(p, _)| p.pose.is_some());
    let right = placed.flat_map(|(p, pose)| p.outer.corners.iter().map(|c| pose.at(*c).x));
    let right = right.fold(f64::NEG_INFINITY, f64::max);
    let mut x = if right.is_finite() { right + GAP } else { 0.0 };
    for (p, pose) in pieces.iter().zip(&mut poses).filter(|(p, _)| p.pose.is_none()) {
        let xs: Vec<f64> = p.outer.corners.iter().map(|c| pose.at(*c).x).collect();
        let low = xs.iter().copied().fold(f64::INFINITY, f64::min);
        let high = xs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        pose.origin.x = x - low;
        x += high - low + GAP;
    }
    poses
}

/// A stitch between two pieces: the directions of its edges, the second turned around where starts
/// meet ends do.
struct StitchDirections {
    pieces: [usize; 2],
    ways: [Vector2; 2],
}

/// The stitches whose directions readers look at.
fn chords(curves: &CurvesOfEdges, stitches: &[CurveStitch]) -> Vec<StitchDirections> {
    let one = |s: &CurveStitch| {
        let way = |(piece, edge, k): (usize, usize, usize)| {
            let c = &curves[piece][edge][k];
            c.end - c.start
        };
        let [a, b] = s.sides.map(way);
        let looked = a.norm().min(b.norm()) > SHORT && s.sides[0].0 != s.sides[1].0;
        let b = if s.right_wrong { -b } else { b };
        looked.then(|| StitchDirections {
            pieces: s.sides.map(|side| side.0),
            ways: [a.normalize(), b.normalize()],
        })
    };
    stitches.iter().filter_map(one).collect()
}

/// The poses of all pieces; those without a place are turned, and stand at the origin.
fn turned(pieces: &[Piece], chords: &[StitchDirections]) -> Vec<Pose> {
    let turns = turns();
    let mut found: Vec<Option<Pose>> = pieces.iter().map(|p| p.pose).collect();
    let open: Vec<usize> = (0..pieces.len()).filter(|&k| pieces[k].pose.is_none()).collect();
    let joined = |found: &[Option<Pose>], k: usize| {
        let other = |c: &&StitchDirections| {
            c.pieces.contains(&k) && c.pieces.iter().any(|p| *p != k && found[*p].is_some())
        };
        chords.iter().filter(other).count()
    };
    for _ in 0..open.len() {
        let rest = open.iter().copied().filter(|&k| found[k].is_none());
        let next = rest.max_by_key(|&k| (joined(&found, k), std::cmp::Reverse(k)));
        if let Some(k) = next {
            found[k] = best(k, &turns, &found, chords);
        }
    }
    for _ in 0..ROUNDS {
        for &k in &open {
            found[k] = best(k, &turns, &found, chords);
        }
    }
    found.into_iter().map(|pose| pose.unwrap_or(turns[0])).collect()
}

/// The first of the turns with which the fewest stitches of a piece run against the others' places.
fn best(k: usize, turns: &[Pose], found: &[Option<Pose>], chords: &[StitchDirections]) -> Option<Pose> {
    let in_space = |pose: &Pose, way: Vector2| pose.across * way.x + pose.along * way.y;
    let against = |turn: &Pose| {
        let of = |c: &&StitchDirections| {
            let pose = |p: usize| if p == k { Some(*turn) } else { found[p] };
            let [a, b] = [0, 1].map(|i| pose(c.pieces[i]).map(|pose| in_space(&pose, c.ways[i])));
            a.zip(b).is_some_and(|(a, b)| a.dot(&b) > AGAINST)
        };
        chords.iter().filter(|c| c.pieces.contains(&k)).filter(of).count()
    };
    turns.iter().min_by_key(|turn| against(turn)).copied()
}

/// All turns about the axes: upright before and behind the body first, then head down, then the
/// others.
fn turns() -> Vec<Pose> {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let mut out: Vec<Pose> = Vec::with_capacity(24);
    for (across, along) in [(x, y), (z, y), (x, z), (y, x), (y, z), (z, x)] {
        for (a, b) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
            out.push(Pose { origin: Point3::origin(), across: across * a, along: along * b });
        }
    }
    out
}
