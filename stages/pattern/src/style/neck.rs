//! Where the shoulders end and the neckline begins.
//!
//! Method: a photo of the front shows the back's collar behind the neckline, so a garment's upper
//! border may be level, or even rise, between its neck points, and the highest point is no
//! landmark. Instead candidates of both halves are paired: corners and extreme points near the top,
//! and the mirror images of the other half's. The pair wins that bends most, lies symmetrically,
//! and lies inwards. Cost: some tens of candidates, each with each. Limits: a neckline that runs
//! into the shoulders without any bend is placed by its other half alone.

use super::shape::Shape;
use toile_core::artifact::{Point2, Vector2};

/// How far below the garment's top the neck points may lie, as a share of its height.
const TOP: f64 = 0.13;
/// Least distance of a neck point from the axis, as a share of the garment's width: half of the
/// narrowest neck opening.
const LEAST: f64 = 0.04;
/// Greatest such distance: half of the widest neck opening.
const MOST: f64 = 0.375;
/// Slopes of the directions in which extreme points are looked for.
const SLOPES: [f64; 6] = [-0.15, -0.05, 0.05, 0.15, 0.25, 0.35];
/// A mirrored candidate this near to one of the half's own is left out, as a share of the size.
const NEAR: f64 = 0.04;
/// Length over which a bend is measured, as a share of the size: beyond labels and wrinkles.
const ARM: f64 = 0.07;
/// Bends count up to this many degrees: a strap has two sharp corners, the inner one is meant.
const ENOUGH: f64 = 50.0;
/// Degrees of bend that a whole size of asymmetry outweighs.
const ASYMMETRY: f64 = 300.0;
/// Degrees of bend that a whole width of distance from the axis outweighs.
const OUTWARDS: f64 = 80.0;

/// The neck points of a shape and of its mirror image, in their own indices.
pub(super) fn neck_points(shape: &Shape, mirror: &Shape) -> Option<[usize; 2]> {
    let own = [candidates(shape), candidates(mirror)];
    let both =
        [with_mirrored(shape, &own[0], mirror, &own[1]), with_mirrored(mirror, &own[1], shape, &own[0])];
    let bends = |s: &Shape, list: &[usize]| -> Vec<f64> {
        list.iter().map(|&i| s.turn_over(i, ARM).to_degrees().clamp(-ENOUGH, ENOUGH)).collect()
    };
    let turns = [bends(shape, &both[0]), bends(mirror, &both[1])];
    let mut best: Option<(f64, [usize; 2])> = None;
    for (&a, turn_a) in both[0].iter().zip(&turns[0]) {
        for (&b, turn_b) in both[1].iter().zip(&turns[1]) {
            let (p, q) = (shape.at(a), mirror.at(b));
            let out = (p.x + q.x) / 2.0 / shape.width();
            let score = (turn_a + turn_b) / 2.0 - ASYMMETRY * (p - q).norm() / shape.size - OUTWARDS * out;
            if best.is_none_or(|(s, _)| score > s) {
                best = Some((score, [a, b]));
            }
        }
    }
    best.map(|(_, pair)| pair)
}

fn allowed(shape: &Shape, p: Point2) -> bool {
    (LEAST * shape.width()..=MOST * shape.width()).contains(&p.x)
        && p.y >= shape.bounds[1].y - TOP * shape.height()
}

/// Corners and extreme points of the half at positive u.
fn candidates(shape: &Shape) -> Vec<usize> {
    let extremes = SLOPES.iter().filter_map(|s| shape.extreme_right(Vector2::new(*s, 1.0)));
    let mut found: Vec<usize> =
        shape.corners().iter().copied().chain(extremes).filter(|&i| allowed(shape, shape.at(i))).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The candidates of one half and the points nearest to those of the other; where a candidate lies
/// near, it stands for the point.
fn with_mirrored(shape: &Shape, own: &[usize], other: &Shape, others: &[usize]) -> Vec<usize> {
    let far = |i: usize, j: &&usize| (shape.at(i) - shape.at(**j)).norm();
    let lone = |i: &usize| own.iter().all(|j| far(*i, &j) > NEAR * shape.size);
    let mirrored = others.iter().filter_map(|&i| shape.nearest(other.at(i)));
    let mirrored = mirrored.filter(|&i| allowed(shape, shape.at(i))).filter(lone);
    let mut all: Vec<usize> = own.iter().copied().chain(mirrored).collect();
    all.sort_unstable();
    all.dedup();
    all
}
