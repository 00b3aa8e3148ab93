//! Better angles without touching what is fixed.
//!
//! Method: triangles whose least angle falls short are mended one by one, worst first in each pass:
//! a new vertex at the circumcentre (Ruppert 1995), over a side (as Üngör's off-centres, 2004) or
//! between two sides is inserted where the constrained Delaunay cavity around it then has a better
//! least angle than before; a free corner is moved to where the least angle around it is greatest
//! (pattern search, Freitag and Ollivier-Gooch 1997); a free corner is drawn onto a neighbour where
//! that is better still. Every change raises the least angle of what it touches, so passes cannot
//! undo each other. Cost: proportional to the number of poor triangles. Limits: segments are never
//! split (their counts are agreed with other panels), so a triangle that fixed segments force stays
//! as it is.

use super::trimesh::TriMesh;
use nalgebra::Rotation2;
use toile_core::artifact::{Point2, Vector2};
use toile_core::{Context, StageError};

/// Passes over the poor triangles; four suffice nearly always.
const PASSES: usize = 12;

/// Triangles mended between two looks at the stop flag (well under 50 ms).
const CHECK_EVERY: usize = 500;

/// A change must raise the least angle by this (radians), or small gains never end.
const GAIN: f64 = 0.2 * std::f64::consts::PI / 180.0;

/// Mends triangles with an angle below `target` (radians).
pub(crate) fn improve(mesh: &mut TriMesh, target: f64, cx: &Context) -> Result<(), StageError> {
    let mut poor: Vec<u32> = mesh.living().filter(|&t| mesh.angle(t) < target).collect();
    mesh.take_touched();
    for _ in 0..PASSES {
        sort_by_angle(mesh, &mut poor);
        for (k, &t) in poor.iter().enumerate() {
            if k % CHECK_EVERY == 0 {
                cx.check()?;
            }
            if mesh.lives(t) && mesh.angle(t) < target {
                mend(mesh, t, target);
            }
        }
        let changed = mesh.take_touched();
        if changed.is_empty() {
            break;
        }
        poor.extend(changed);
        poor.sort_unstable();
        poor.dedup();
        poor.retain(|&t| mesh.lives(t) && mesh.angle(t) < target);
    }
    Ok(())
}

fn sort_by_angle(mesh: &TriMesh, poor: &mut Vec<u32>) {
    let mut keyed: Vec<(f64, u32)> = poor.iter().map(|&t| (mesh.angle(t), t)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    *poor = keyed.into_iter().map(|k| k.1).collect();
}

/// Tries the three remedies in turn until one helps.
fn mend(mesh: &mut TriMesh, t: u32, target: f64) {
    let corners = mesh.tris[t as usize];
    for v in corners {
        if mesh.free[v as usize] && shift(mesh, v) && !(mesh.lives(t) && mesh.angle(t) < target) {
            return;
        }
    }
    if !mesh.lives(t) || mesh.tris[t as usize] != corners {
        return;
    }
    if add(mesh, t) {
        return;
    }
    for v in corners {
        if mesh.free[v as usize] && remove(mesh, v) {
            return;
        }
    }
}

/// Moves `v` to where the least angle around it is greatest; true where that gained.
pub(crate) fn shift(mesh: &mut TriMesh, v: u32) -> bool {
    let star = mesh.star(v);
    if star.is_empty() {
        return false;
    }
    let start = mesh.points[v as usize];
    let before = mesh.star_angle(&star, v, start);
    let (p, after) = best_place(mesh, &star, v, before);
    if after < before + GAIN {
        return false;
    }
    mesh.put(&star, v, p);
    mesh.legalise(&star);
    true
}

/// Pattern search: eight directions, steps halved from half the mean spoke.
fn best_place(mesh: &TriMesh, star: &[u32], v: u32, before: f64) -> (Point2, f64) {
    let start = mesh.points[v as usize];
    let ring = mesh.ring(star, v);
    let spoke = |w: &u32| (mesh.points[*w as usize] - start).norm();
    let mean = ring.iter().map(spoke).sum::<f64>() / ring.len() as f64;
    let centre = ring.iter().map(|&w| mesh.points[w as usize].coords).sum::<Vector2>() / ring.len() as f64;
    let (mut best, mut angle) = (start, before);
    let mut take = |p: Point2, best: &mut Point2| {
        let there = mesh.star_angle_above(star, v, p, angle);
        if let Some(there) = there {
            (*best, angle) = (p, there);
        }
        there.is_some()
    };
    take(Point2::from(centre), &mut best);
    let mut step = 0.5 * mean;
    while step > 0.02 * mean {
        let from = best;
        let mut any = false;
        for k in 0..8 {
            let way = Rotation2::new(f64::from(k) * std::f64::consts::FRAC_PI_4) * Vector2::x();
            any |= take(from + way * step, &mut best);
        }
        step = if any { step } else { step / 2.0 };
    }
    (best, angle)
}

/// Inserts a vertex that improves the angles around it; true where there is such a vertex.
fn add(mesh: &mut TriMesh, t: u32) -> bool {
    let mut best: Option<(f64, u32, Point2)> = None;
    for p in candidates(mesh.corners(t)) {
        let Some(at) = mesh.walk(t, p) else { continue };
        let Some(gained) = mesh.try_insert(at, p, GAIN) else { continue };
        if best.is_none_or(|b| gained > b.0) {
            best = Some((gained, at, p));
        }
    }
    let Some((_, at, p)) = best else { return false };
    let v = mesh.insert(at, p);
    shift(mesh, v);
    true
}

/// Where a new vertex may help: the circumcentre, points over the middle of each side whose
/// triangle over that side has good angles, and points between two sides.
fn candidates(corners: [Point2; 3]) -> Vec<Point2> {
    let mut out = Vec::with_capacity(13);
    out.extend(circumcentre(corners));
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let inward = Vector2::new(a.y - b.y, b.x - a.x);
        let middle = nalgebra::center(&a, &b);
        // Heights of triangles with apex angles of 90, 60 and 40 degrees.
        out.extend([0.5, 0.87, 1.37].map(|height| middle + inward * height));
        out.extend(between(a, b, corners[(k + 2) % 3]));
    }
    out
}

/// Between the sides from `a` to `b` and `c`: the point on their bisector at their geometric mean,
/// which bridges sides of very different lengths best.
fn between(a: Point2, b: Point2, c: Point2) -> Option<Point2> {
    let (u, v) = (b - a, c - a);
    let way = (u.try_normalize(0.0)? + v.try_normalize(0.0)?).try_normalize(0.0)?;
    Some(a + way * (u.norm() * v.norm()).sqrt())
}

fn circumcentre([a, b, c]: [Point2; 3]) -> Option<Point2> {
    let (u, v) = (b - a, c - a);
    let twice = 2.0 * u.perp(&v);
    let d = Vector2::new(
        v.y * u.norm_squared() - u.y * v.norm_squared(),
        u.x * v.norm_squared() - v.x * u.norm_squared(),
    ) / twice;
    d.x.is_finite().then(|| a + d).filter(|p| p.x.is_finite() && p.y.is_finite())
}

/// Draws `v` onto the neighbour that leaves the best angles; true where that is better than now.
fn remove(mesh: &mut TriMesh, v: u32) -> bool {
    let star = mesh.star(v);
    let before = mesh.star_angle(&star, v, mesh.points[v as usize]);
    let ring = mesh.ring(&star, v);
    let rated = ring.iter().map(|&w| (mesh.collapse_angle(&star, v, w), w));
    let Some((angle, w)) = rated.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1))) else { return false };
    if angle < before + GAIN {
        return false;
    }
    mesh.collapse(&star, v, w);
    let rest: Vec<u32> = star.into_iter().filter(|&t| mesh.lives(t)).collect();
    mesh.legalise(&rest);
    true
}

/// Moves the free vertices of `which` towards the middle of their neighbours, `rounds` times; a
/// move that would bring an angle below both `floor` (radians) and what it was is left out.
pub(crate) fn relax(
    mesh: &mut TriMesh,
    which: &[u32],
    rounds: usize,
    floor: f64,
    cx: &Context,
) -> Result<(), StageError> {
    for _ in 0..rounds {
        for (k, &v) in which.iter().enumerate() {
            if k % CHECK_EVERY == 0 {
                cx.check()?;
            }
            if mesh.free[v as usize] {
                relax_vertex(mesh, v, floor);
            }
        }
    }
    Ok(())
}

fn relax_vertex(mesh: &mut TriMesh, v: u32, floor: f64) {
    let star = mesh.star(v);
    if star.is_empty() {
        return;
    }
    let middle = weighted_middle(mesh, &star);
    let before = mesh.star_angle(&star, v, mesh.points[v as usize]);
    if mesh.star_angle(&star, v, middle) >= before.min(floor) {
        mesh.put(&star, v, middle);
        mesh.legalise(&star);
    }
}

/// The area-weighted mean of the centres of the triangles round a vertex: equal areas draw it, so
/// that spacing evens out (Chen's optimal Delaunay smoothing, 2004, with centroids).
fn weighted_middle(mesh: &TriMesh, star: &[u32]) -> Point2 {
    let (mut sum, mut weight) = (Vector2::zeros(), 0.0);
    for &t in star {
        let [a, b, c] = mesh.corners(t);
        let area = (b - a).perp(&(c - a));
        sum += (a.coords + b.coords + c.coords) * (area / 3.0);
        weight += area;
    }
    Point2::from(sum / weight)
}
