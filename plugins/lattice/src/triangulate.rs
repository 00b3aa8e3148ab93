//! Constrained Delaunay triangulation, and vertices near the border moved to better places.
//!
//! Method: `spade` triangulates all points with every segment as a constraint; triangles inside are
//! found by flood fill from those on the left of the loops. In each round free vertices near the
//! border move to where the least angle around them is greatest (pattern search, Freitag and
//! Ollivier-Gooch 1997) and all is triangulated anew. Between the rounds circumcentres of poor
//! triangles are added where they are clear of everything (Ruppert 1995, without splitting
//! segments). Cost: n log n a round. Limits: an angle that two segments of the outline force stays.

use crate::check::orient;
use crate::divide::MeshSegments;
use crate::fill::Seed;
use spade::{ConstrainedDelaunayTriangulation, Triangulation};
use toile_core::prelude::*;

/// Rounds of moving and adding; later ones change little.
const ROUNDS: usize = 6;
/// Triangles below this angle (degrees) ask for a new vertex.
const POOR: f64 = 28.0;
/// A new vertex keeps this share of the shortest side around it from every vertex.
const SPACING: f64 = 0.7;
/// A move must gain this much (radians).
const GAIN: f64 = 2e-3;
/// Around a vertex whose angles are all above this (degrees) the mean counts, and it moves to its
/// neighbours' middle.
const FINE: f64 = 38.0;
/// A move to the middle that is shorter than this share of the spokes is none.
const STILL: f64 = 0.01;

/// Vertices, the division's first, and triangles.
pub(crate) struct LatticeMesh {
    pub(crate) points: Vec<Point2>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Meshes a division and its seeds at an edge length `h`.
pub(crate) fn mesh(
    division: &MeshSegments,
    seeds: Vec<Seed>,
    h: f64,
    cx: &Context,
) -> Result<LatticeMesh, StageError> {
    let fixed = division.points.len();
    let mut points = division.points.clone();
    points.extend(seeds.iter().map(|s| s.at));
    let mut near: Vec<bool> = vec![false; fixed];
    near.extend(seeds.iter().map(|s| s.near));
    let (loops, segments) = (division.loop_segments(), division.segments());
    let mut triangles = inside_triangles(&points, &loops, &segments, cx)?;
    for round in 0..ROUNDS {
        cx.progress(0.3 + 0.6 * round as f64 / ROUNDS as f64, format!("{} triangles", triangles.len()));
        let moved = relax(&mut points, &triangles, &near, cx)?;
        let added = if round + 2 < ROUNDS { add(&mut points, &triangles, h) } else { 0 };
        near.resize(points.len(), true);
        if !moved && added == 0 {
            break;
        }
        triangles = inside_triangles(&points, &loops, &segments, cx)?;
    }
    let (points, triangles) = without_unused(points, triangles, fixed);
    Ok(LatticeMesh { points, triangles })
}

fn inside_triangles(
    points: &[Point2],
    loops: &[[u32; 2]],
    segments: &[[u32; 2]],
    cx: &Context,
) -> Result<Vec<[u32; 3]>, StageError> {
    let hull = hull_triangles(points, segments, cx)?;
    cx.check()?;
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * hull.len());
    for (t, [a, b, c]) in hull.iter().enumerate() {
        sides.extend([[*a, *b], [*b, *c], [*c, *a]].map(|s| (s, t as u32)));
    }
    sides.sort_unstable();
    let left_of = |s: [u32; 2]| sides.binary_search_by_key(&s, |e| e.0).ok().map(|k| sides[k].1);
    let mut walls: Vec<[u32; 2]> = loops.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
    walls.sort_unstable();
    let mut inside = vec![false; hull.len()];
    let mut open: Vec<u32> = loops.iter().filter_map(|&s| left_of(s)).collect();
    open.iter().for_each(|&t| inside[t as usize] = true);
    while let Some(t) = open.pop() {
        let [a, b, c] = hull[t as usize];
        for side in [[b, a], [c, b], [a, c]] {
            let free = walls.binary_search(&side).is_err();
            if let Some(n) = left_of(side).filter(|&n| free && !inside[n as usize]) {
                inside[n as usize] = true;
                open.push(n);
            }
        }
    }
    Ok(hull.into_iter().zip(inside).filter(|(_, inside)| *inside).map(|(t, _)| t).collect())
}

/// Vertices entered between two looks at the stop flag: a few milliseconds.
const CHECK_EVERY: usize = 2000;

/// All triangles of the hull, counter-clockwise. Points come row by row, so entering them one by
/// one costs little more than all at once, and can be stopped.
fn hull_triangles(
    points: &[Point2],
    segments: &[[u32; 2]],
    cx: &Context,
) -> Result<Vec<[u32; 3]>, StageError> {
    let fault = |what: &str| StageError::internal(format!("the triangulation failed: {what}"));
    // spade's exact predicates underflow at numbers below.
    let tiny = |x: f64| if x.abs() < 1e-40 { 0.0 } else { x };
    let mut cdt = ConstrainedDelaunayTriangulation::<spade::Point2<f64>>::new();
    let mut handles = Vec::with_capacity(points.len());
    for (k, p) in points.iter().enumerate() {
        if k % CHECK_EVERY == 0 {
            cx.check()?;
        }
        let handle =
            cdt.insert(spade::Point2::new(tiny(p.x), tiny(p.y))).map_err(|e| fault(&e.to_string()))?;
        if handle.index() != k {
            return Err(fault("points coincide"));
        }
        handles.push(handle);
    }
    for [a, b] in segments.iter().map(|s| s.map(|v| handles[v as usize])) {
        if !cdt.can_add_constraint(a, b) {
            return Err(fault("segments cross"));
        }
        cdt.add_constraint(a, b);
    }
    Ok(cdt.inner_faces().map(|f| f.vertices().map(|v| v.index() as u32)).collect())
}

/// The triangles round every vertex, as offsets into one list.
fn stars(points: usize, triangles: &[[u32; 3]]) -> (Vec<usize>, Vec<u32>) {
    let mut start = vec![0; points + 1];
    triangles.iter().flatten().for_each(|&v| start[v as usize + 1] += 1);
    (0..points).for_each(|v| start[v + 1] += start[v]);
    let (mut next, mut of) = (start.clone(), vec![0; 3 * triangles.len()]);
    for (t, tri) in triangles.iter().enumerate() {
        for &v in tri {
            of[next[v as usize]] = t as u32;
            next[v as usize] += 1;
        }
    }
    (start, of)
}

/// Moves free vertices near the border one after the other; true where any moved.
fn relax(
    points: &mut [Point2],
    triangles: &[[u32; 3]],
    near: &[bool],
    cx: &Context,
) -> Result<bool, StageError> {
    let (start, of) = stars(points.len(), triangles);
    let mut any = false;
    for v in (0..points.len()).filter(|&v| near[v]) {
        if v % 512 == 0 {
            cx.check()?;
        }
        let star = &of[start[v]..start[v + 1]];
        any |= !star.is_empty() && shift(points, triangles, star, v);
    }
    Ok(any)
}

/// Pattern search for the greatest least angle around `v`.
fn shift(points: &mut [Point2], triangles: &[[u32; 3]], star: &[u32], v: usize) -> bool {
    let rim: Vec<[Point2; 2]> = star
        .iter()
        .map(|&t| {
            let tri = triangles[t as usize];
            let k = tri.iter().position(|&w| w as usize == v).unwrap_or(0);
            [points[tri[(k + 1) % 3] as usize], points[tri[(k + 2) % 3] as usize]]
        })
        .collect();
    let quality = |p: Point2| rim.iter().map(|[a, b]| least_angle(p, *a, *b)).fold(f64::INFINITY, f64::min);
    let from = points[v];
    let (mut best, mut angle) = (from, quality(from));
    let before = angle;
    let centre = rim.iter().fold(Vector2::zeros(), |s, [a, _]| s + a.coords) / rim.len() as f64;
    let mut step = rim.iter().map(|[a, _]| (a - from).norm()).sum::<f64>() / rim.len() as f64 / 2.0;
    let least = step / 16.0;
    let mut take = |p: Point2, best: &mut Point2| {
        let there = quality(p);
        let better = there > angle;
        if better {
            (*best, angle) = (p, there);
        }
        better
    };
    let middle = Point2::from(centre);
    if before > FINE.to_radians() && quality(middle) > FINE.to_radians() {
        let moved = (middle - from).norm() > STILL * 2.0 * step;
        if moved {
            points[v] = middle;
        }
        return moved;
    }
    take(middle, &mut best);
    while step > least {
        let at = best;
        let ways = [
            [1.0, 0.0],
            [0.0, 1.0],
            [-1.0, 0.0],
            [0.0, -1.0],
            [0.7, 0.7],
            [-0.7, 0.7],
            [-0.7, -0.7],
            [0.7, -0.7],
        ];
        // All eight are tried, so that none is preferred for its place in the list.
        let gained = ways.iter().filter(|w| take(at + Vector2::new(w[0], w[1]) * step, &mut best)).count();
        step = if gained > 0 { step } else { step / 2.0 };
    }
    let moved = angle > before + GAIN;
    if moved {
        points[v] = best;
    }
    moved
}

/// The least angle of a triangle, radians; negative where it is turned over.
fn least_angle(a: Point2, b: Point2, c: Point2) -> f64 {
    let at = |p: Point2, q: Point2, r: Point2| (q - p).perp(&(r - p)).atan2((q - p).dot(&(r - p)));
    at(a, b, c).min(at(b, c, a)).min(at(c, a, b))
}

/// Adds circumcentres of poor triangles that lie within the triangle or a neighbour, worst first;
/// says how many.
fn add(points: &mut Vec<Point2>, triangles: &[[u32; 3]], h: f64) -> usize {
    let corners = |t: &[u32; 3]| t.map(|v| points[v as usize]);
    let mut poor: Vec<(f64, usize)> = triangles
        .iter()
        .enumerate()
        .map(|(k, t)| (least_angle(corners(t)[0], corners(t)[1], corners(t)[2]), k))
        .filter(|(angle, _)| *angle < POOR.to_radians())
        .collect();
    poor.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (start, of) = stars(points.len(), triangles);
    let mut touched = vec![false; points.len()];
    let mut new: Vec<Point2> = Vec::new();
    for (_, k) in poor {
        let t = triangles[k];
        if t.iter().any(|&v| touched[v as usize]) {
            continue;
        }
        let around = t.iter().flat_map(|&v| &of[start[v as usize]..start[v as usize + 1]]);
        let Some((p, home)) = candidates(t.map(|v| points[v as usize])).into_iter().find_map(|p| {
            let holds = |u: &&u32| contains(triangles[**u as usize].map(|v| points[v as usize]), p);
            around.clone().find(holds).map(|u| (p, triangles[*u as usize]))
        }) else {
            continue;
        };
        let shortest = (0..3).map(|i| (points[t[i] as usize] - points[t[(i + 1) % 3] as usize]).norm());
        let shortest = shortest.fold(h, f64::min);
        let clear = |q: &Point2| (p - q).norm() > SPACING * shortest;
        let free = around.clone().flat_map(|&u| triangles[u as usize]).all(|v| clear(&points[v as usize]));
        if free && new.iter().all(clear) {
            t.iter().chain(&home).for_each(|&v| touched[v as usize] = true);
            new.push(p);
        }
    }
    points.extend(&new);
    new.len()
}

/// The circumcentre, and the tip of an equilateral triangle over the shortest side.
fn candidates([a, b, c]: [Point2; 3]) -> Vec<Point2> {
    let (u, v) = (b - a, c - a);
    let (twice, uu, vv) = (2.0 * u.perp(&v), u.norm_squared(), v.norm_squared());
    let centre = a + Vector2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
    let sides = [(a, b), (b, c), (c, a)];
    let shortest =
        sides.iter().fold(sides[0], |s, t| if (t.1 - t.0).norm() < (s.1 - s.0).norm() { *t } else { s });
    let along = shortest.1 - shortest.0;
    let tip = nalgebra::center(&shortest.0, &shortest.1) + Vector2::new(-along.y, along.x) * 0.75f64.sqrt();
    [centre, tip].into_iter().filter(|p| p.coords.iter().all(|x| x.is_finite())).collect()
}

fn contains([a, b, c]: [Point2; 3], p: Point2) -> bool {
    orient(a, b, p) > 0.0 && orient(b, c, p) > 0.0 && orient(c, a, p) > 0.0
}

/// The first `fixed` vertices keep their numbers, others that no triangle uses are dropped.
fn without_unused(
    points: Vec<Point2>,
    triangles: Vec<[u32; 3]>,
    fixed: usize,
) -> (Vec<Point2>, Vec<[u32; 3]>) {
    let mut used = vec![false; points.len()];
    triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    used[..fixed].fill(true);
    let mut number = vec![0; points.len()];
    let mut kept = Vec::with_capacity(points.len());
    for (v, p) in points.into_iter().enumerate().filter(|(v, _)| used[*v]) {
        number[v] = kept.len() as u32;
        kept.push(p);
    }
    (kept, triangles.into_iter().map(|t| t.map(|v| number[v as usize])).collect())
}
