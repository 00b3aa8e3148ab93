//! Narrow gaps between arm and trunk, bridged.
//!
//! Cloth cannot rest in the crease of an armpit: in a gap narrower than its own two layers the skin
//! nearest to a point switches between arm and trunk from step to step, and no state is at rest
//! with both. So for cloth the skin is led over the gap, as a taut sheet would be.
//!
//! Method: a vertex is in the gap where another one near it faces it. The vertices of the gap relax
//! to the mean of their neighbours (Gauss-Seidel on the membrane, in the order of their numbers) as
//! far as the body lets them: the obstacle problem. Connectivity stays. Cost: up to 300 distances
//! for each vertex of the gap, and a comparison of all pairs of vertices near an armpit: 0.4 s for
//! a body of 24,000 vertices (docs/log/2026-11-26-sewing-tried.md). Limits: only near the landmarks
//! of the armpits, creases elsewhere stay; where the body still comes through the skin after the
//! last raising, that is left to the check of the finished garment against the body.

use crate::skin::topology::neighbours;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use toile_cloth::contact::body::Body as Solid;
use toile_core::prelude::*;

/// Vertices farther from an armpit than this share of the body's height stay.
const NEAR: f64 = 0.12;

/// Cosine of the angle between normals that face each other, at most.
const FACING_COSINE: f64 = -0.2;

/// Cosine of the angle between a normal and the way to the other vertex, at least.
const WAY_COSINE: f64 = 0.4;

/// Rings of vertices by which the gap is widened and narrowed again, so that its bottom counts with
/// its walls.
const RINGS: usize = 3;

/// Rounds of relaxation at most.
const RELAX_ROUNDS: usize = 300;

/// Relaxation ends where no vertex moves this far, metres.
const LEAST_MOVE: f64 = 2e-5;

/// The skin over a gap stays this far outside the body, metres.
const CLEAR: f64 = 1e-3;

/// Where the body still comes through the bridge, the bridge is raised by as much and this
/// distance, metres.
const RAISE_MORE: f64 = 2e-4;

/// The bridge is raised at most so many times.
const RAISE_ROUNDS: usize = 8;

/// The body is looked for up to [`SEEN`] outside the skin, metres, and counts as outside from
/// [`OUT`] on, metres; the [`CORNERS`] vertices of the gap that are nearest to such a place are
/// raised.
const SEEN: f64 = 0.01;
const OUT: f64 = 1e-6;
const CORNERS: usize = 3;

/// The body with gaps between arm and trunk narrower than `width` (metres) bridged; nothing where
/// it has no landmarks of armpits.
///
/// # Errors
/// When it is cancelled.
pub fn bridged(body: &Body, width: f64, cx: &Context) -> Result<Option<Body>, StageError> {
    let height = body.positions.iter().map(|p| p.y).fold(0.0, f64::max);
    let armpits: Vec<Point3> = Hand::BOTH.iter().filter_map(|hand| body.landmark("armpit", *hand)).collect();
    if armpits.is_empty() {
        return Ok(None);
    }
    let is_near = |p: &Point3| armpits.iter().any(|a| (p - a).norm() < NEAR * height);
    let near: Vec<u32> =
        (0..body.positions.len() as u32).filter(|v| is_near(&body.positions[*v as usize])).collect();
    let beside = neighbours(body.positions.len(), &body.triangles);
    let walls = facing(body, &near, width);
    let grown = (0..RINGS).fold(walls, |set, _| grow(&set, &beside));
    let gap = (1..RINGS).fold(grown, |set, _| shrink(&set, &beside));
    let mut over = body.clone();
    relax(&mut over, &gap, &beside, cx)?;
    raise(&mut over, body, &near, &gap, cx)?;
    Ok(Some(over))
}

/// The vertices of `near` that face another of them within `width`.
fn facing(body: &Body, near: &[u32], width: f64) -> BTreeSet<u32> {
    let normals = body.vertex_normals();
    let sees = |a: &u32, b: &u32| {
        let way = body.positions[*b as usize] - body.positions[*a as usize];
        let (na, nb) = (normals[*a as usize], normals[*b as usize]);
        let length = way.norm();
        length > 0.0
            && length < width
            && na.dot(&nb) < FACING_COSINE
            && way.dot(&na) > WAY_COSINE * length
            && -way.dot(&nb) > WAY_COSINE * length
    };
    near.par_iter().filter(|a| near.iter().any(|b| sees(a, b))).copied().collect()
}

fn grow(set: &BTreeSet<u32>, beside: &[BTreeSet<u32>]) -> BTreeSet<u32> {
    set.iter().flat_map(|v| beside[*v as usize].iter().copied()).chain(set.iter().copied()).collect()
}

fn shrink(set: &BTreeSet<u32>, beside: &[BTreeSet<u32>]) -> BTreeSet<u32> {
    set.iter().filter(|v| beside[**v as usize].iter().all(|w| set.contains(w))).copied().collect()
}

/// Draws the skin taut over the gap.
fn relax(
    body: &mut Body,
    gap: &BTreeSet<u32>,
    beside: &[BTreeSet<u32>],
    cx: &Context,
) -> Result<(), StageError> {
    let solid = Solid::new(body.positions.iter().map(|p| p.coords).collect(), &body.triangles);
    // Where each vertex was seen last, and how far from the body.
    let mut seen: Vec<(Point3, f64)> = body.positions.iter().map(|p| (*p, 0.0)).collect();
    for _ in 0..RELAX_ROUNDS {
        cx.check()?;
        let mut farthest = 0.0f64;
        for &v in gap {
            let around = &beside[v as usize];
            let sum: Vector3 = around.iter().map(|w| body.positions[*w as usize].coords).sum();
            let mut p = Point3::from(sum / around.len() as f64);
            let (at, distance) = seen[v as usize];
            if distance - (p - at).norm() < CLEAR
                && let Some(n) = solid.nearest(&p.coords, f64::INFINITY)
            {
                seen[v as usize] = (p, n.distance);
                if n.distance < CLEAR {
                    p = Point3::from(n.point + n.normal * CLEAR);
                }
            }
            farthest = farthest.max((p - body.positions[v as usize]).norm());
            body.positions[v as usize] = p;
        }
        if farthest < LEAST_MOVE {
            break;
        }
    }
    Ok(())
}

/// Raises the skin `over` a gap where `body` comes through it between its vertices.
fn raise(
    over: &mut Body,
    body: &Body,
    near: &[u32],
    gap: &BTreeSet<u32>,
    cx: &Context,
) -> Result<(), StageError> {
    let near: BTreeSet<u32> = near.iter().copied().collect();
    let at = |t: &[u32; 3]| t.map(|v| body.positions[v as usize].coords);
    let about = body.triangles.iter().filter(|t| t.iter().any(|v| near.contains(v)));
    // Corners and middles of triangles and their sides.
    let points: Vec<Vector3> = about
        .map(at)
        .flat_map(|[a, b, c]| [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0])
        .collect();
    let mut nearest: Vec<u32> = gap.iter().copied().collect();
    for _ in 0..RAISE_ROUNDS {
        cx.check()?;
        let solid = Solid::new(over.positions.iter().map(|p| p.coords).collect(), &over.triangles);
        let mut raised: BTreeMap<u32, Vector3> = BTreeMap::new();
        let found: Vec<_> = points.par_iter().map(|p| solid.nearest(p, SEEN)).collect();
        for n in found.into_iter().flatten().filter(|n| n.distance > OUT) {
            let far = |v: &u32| (over.positions[*v as usize].coords - n.point).norm_squared();
            let by = n.normal * (n.distance + RAISE_MORE);
            if nearest.len() > CORNERS {
                nearest.select_nth_unstable_by(CORNERS, |a, b| far(a).total_cmp(&far(b)).then(a.cmp(b)));
            }
            for &v in nearest.iter().take(CORNERS) {
                let known = raised.entry(v).or_insert(by);
                if by.norm_squared() > known.norm_squared() {
                    *known = by;
                }
            }
        }
        if raised.is_empty() {
            break;
        }
        raised.into_iter().for_each(|(v, by)| over.positions[v as usize] += by);
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn figure() -> Body {
        let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
        crate::tests::mannequin(lengths).unwrap()
    }

    #[test]
    fn the_skin_is_led_over_the_armpits_outside_the_body_and_stays_elsewhere() {
        let body = figure();
        let wide = bridged(&body, 0.08, &Context::quiet()).unwrap().unwrap();
        let solid = Solid::new(body.positions.iter().map(|p| p.coords).collect(), &body.triangles);
        let moved: Vec<usize> =
            (0..body.positions.len()).filter(|v| wide.positions[*v] != body.positions[*v]).collect();
        assert!(!moved.is_empty());
        for v in moved {
            let p = wide.positions[v];
            assert!(solid.nearest(&p.coords, 1.0).unwrap().distance > 0.5 * CLEAR, "{p}");
            let near =
                Hand::BOTH.iter().any(|hand| (p - body.landmark("armpit", *hand).unwrap()).norm() < 0.25);
            assert!(near, "{p}");
        }
        let over = Solid::new(wide.positions.iter().map(|p| p.coords).collect(), &wide.triangles);
        let out = body.positions.iter().filter_map(|p| over.nearest(&p.coords, 0.01)).map(|n| n.distance);
        assert!(out.fold(0.0, f64::max) < 1e-4, "the body stays inside");
        assert!(wide.volume() > body.volume());
        assert_eq!(wide.triangles, body.triangles);
    }

    #[test]
    fn no_gap_is_as_narrow_as_nothing_and_no_armpit_is_bridged_without_landmarks() {
        let mut body = figure();
        let cx = Context::quiet();
        assert_eq!(bridged(&body, 0.0, &cx).unwrap().unwrap().positions, body.positions);
        body.landmarks.clear();
        assert!(bridged(&body, 0.08, &cx).unwrap().is_none());
    }
}
