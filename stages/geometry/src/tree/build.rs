//! How the tree divides its things.

use super::{MAX_DEPTH, TreePart, VolumeTree};
use crate::volume::{Aabb, BoundingVolume};
use crate::{Corners, Vec3};

/// Bins of the surface-area heuristic: more make slightly better trees, slower.
const BINS: usize = 12;

impl VolumeTree {
    /// The tree over triangles, at most `leaf` of them together, and their numbers in its order. A
    /// corner that is no finite number must not be among them.
    #[must_use]
    pub fn over(corners: &[Corners], leaf: usize) -> (Self, Vec<u32>) {
        let boxes: Vec<(Aabb, Vec3)> =
            corners.iter().map(|c| Aabb::fit(c)).map(|b| (b, b.center())).collect();
        let mut order: Vec<u32> = (0..corners.len() as u32).collect();
        let mut parts = Vec::with_capacity(corners.len());
        if !order.is_empty() {
            grow(&mut parts, &mut order, 0, leaf.max(1), &boxes, 0);
        }
        (Self { parts }, order)
    }
}

/// Appends the subtree over `order`, which starts at `first` of the whole list.
fn grow(
    parts: &mut Vec<TreePart>,
    order: &mut [u32],
    first: usize,
    leaf: usize,
    boxes: &[(Aabb, Vec3)],
    depth: usize,
) {
    if order.len() <= leaf {
        parts.push(TreePart { first: first as u32, count: order.len() as u32, right: 0 });
        return;
    }
    let middle = split(order, boxes, depth);
    let part = parts.len();
    parts.push(TreePart { first: 0, count: 0, right: 0 });
    let (left, right) = order.split_at_mut(middle);
    grow(parts, left, first, leaf, boxes, depth + 1);
    parts[part].right = parts.len() as u32;
    grow(parts, right, first + middle, leaf, boxes, depth + 1);
}

/// Orders the things in two parts, neither empty, and returns where the second starts.
fn split(order: &mut [u32], boxes: &[(Aabb, Vec3)], depth: usize) -> usize {
    let center = |i: u32| boxes[i as usize].1;
    let span = order.iter().fold(Aabb::empty(), |b, &i| b.with(&center(i)));
    let axis = span.extent().imax();
    let width = span.extent()[axis];
    if depth < MAX_DEPTH && width > 0.0 && width.is_finite() {
        let scale = BINS as f64 / width;
        let bin = |i: u32| (((center(i)[axis] - span.min[axis]) * scale) as usize).min(BINS - 1);
        let bins: Vec<u8> = order.iter().map(|&i| bin(i) as u8).collect();
        if let Some(cut) = best_cut(order, &bins, boxes) {
            return part(order, |k| usize::from(bins[k]) < cut);
        }
    }
    let middle = order.len() / 2;
    order
        .select_nth_unstable_by(middle, |&i, &j| center(i)[axis].total_cmp(&center(j)[axis]).then(i.cmp(&j)));
    middle
}

/// Those that go first before the others, each in their order; returns how many.
fn part(order: &mut [u32], is_first: impl Fn(usize) -> bool) -> usize {
    let mut others = Vec::with_capacity(order.len());
    let mut count = 0;
    for k in 0..order.len() {
        if is_first(k) {
            order[count] = order[k];
            count += 1;
        } else {
            others.push(order[k]);
        }
    }
    order[count..].copy_from_slice(&others);
    count
}

/// The bin before which to cut, by least sum of surface times count; `None` where all is in one
/// bin.
fn best_cut(order: &[u32], bins: &[u8], boxes: &[(Aabb, Vec3)]) -> Option<usize> {
    let mut filled = [(Aabb::empty(), 0usize); BINS];
    for (&i, &bin) in order.iter().zip(bins) {
        let b = &mut filled[usize::from(bin)];
        *b = (b.0.merge(&boxes[i as usize].0), b.1 + 1);
    }
    let mut above = [(Aabb::empty(), 0usize); BINS];
    let mut sum = (Aabb::empty(), 0);
    for k in (0..BINS).rev() {
        sum = (sum.0.merge(&filled[k].0), sum.1 + filled[k].1);
        above[k] = sum;
    }
    let cost = |s: &(Aabb, usize)| s.0.half_area() * s.1 as f64;
    let (mut below, mut best) = ((Aabb::empty(), 0), None);
    for cut in 1..BINS {
        below = (below.0.merge(&filled[cut - 1].0), below.1 + filled[cut - 1].1);
        if below.1 == 0 || above[cut].1 == 0 {
            continue;
        }
        let at = cost(&below) + cost(&above[cut]);
        if best.is_none_or(|(least, _)| at < least) {
            best = Some((at, cut));
        }
    }
    best.map(|b| b.1)
}
