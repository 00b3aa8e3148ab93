//! Both halves of a fitted template made alike: a garment is its own mirror image, however its
//! sleeves and legs lie in the photo.
//!
//! Corners of trunk, waist and legs become the mean of both sides. Sleeves, which lie as they fall
//! and may lie folded, are taken from one side: the one that the template fits better, and where
//! both fit alike, the one with the wider cuff, since a fold only narrows it. One that is nearly
//! twice as wide is none: there a side of the sleeve was taken for its cuff, and the other one is
//! right. What a person has said of one side alone holds for both.

use crate::style::block::template::bow::Bow;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use crate::style::block::template::seen::CornerPull;
use toile_core::prelude::*;

/// A side fits better where its misses are smaller by so many times.
const BETTER: f64 = 1.5;

/// A cuff is not so many times as wide as the other.
const TWICE: f64 = 1.7;

/// Lengths differ much from this share of the garment's size on.
const APART: f64 = 0.12;

/// How the halves of a garment are cut.
#[choice]
#[derive(Copy, Eq)]
pub enum Sides {
    /// As each other's mirror image.
    Alike,
    /// Each as it lies in the photo.
    AsTheyLie,
}

/// Makes both sides of a fit alike. `misses` is how far the outline strays from the sleeves of each
/// side; `said` are corners that a person has set.
pub(crate) fn alike(fit: &mut Fit, form: &Form, misses: [f64; 2], said: &[CornerPull]) {
    let is_sleeve = |k: &usize| form.edges[*k].own_end && form.underarm().is_some_and(|arm| *k >= arm);
    let own: Vec<usize> = (0..form.edges.len()).filter(is_sleeve).collect();
    let are_said = |side: usize| said.iter().any(|p| p.side == side && own.contains(&p.edge) && !p.is_start);
    let by_word = match [0, 1].map(are_said) {
        [true, false] => Some(0),
        [false, true] => Some(1),
        _ => None,
    };
    let chosen = by_word.or(fit.judged).unwrap_or_else(|| chosen(fit, &own, misses));
    let mut means: Vec<Bow> =
        (0..form.edges.len()).map(|k| mean(&fit.sides[0][k], &fit.sides[1][k])).collect();
    for p in said.iter().filter(|p| !p.is_start && p.edge + 1 < form.edges.len()) {
        if !said.iter().any(|q| q.edge == p.edge && q.side != p.side && !q.is_start) {
            let corner = fit.sides[p.side][p.edge].b;
            (means[p.edge].b, means[p.edge + 1].a) = (corner, corner);
        }
    }
    let mut edges = means.clone();
    if let (Some(&first), Some(&last)) = (own.first(), own.last()) {
        let side = &fit.sides[chosen];
        let shift = means[first].a - side[first].a;
        for k in first..=last {
            edges[k] = Bow { a: side[k].a + shift, b: side[k].b + shift, ..side[k] };
        }
        edges[last + 1] = Bow { a: edges[last].b, bow: side[last + 1].bow, ..means[last + 1] };
    }
    fit.sides = [edges.clone(), edges];
}

/// Whether what lies as it falls is so different on both sides that one of them cannot be what it
/// was taken for.
pub(crate) fn differ(fit: &Fit, form: &Form, size: f64) -> bool {
    let lengths = |k: usize| [0, 1].map(|side: usize| fit.sides[side][k].length());
    let own = (0..form.edges.len()).filter(|k| form.edges[*k].own_end);
    own.map(lengths).any(|[a, b]| a.max(b) > TWICE * a.min(b) && (a - b).abs() > APART * size)
}

/// The side whose sleeve is taken.
fn chosen(fit: &Fit, own: &[usize], [right, left]: [f64; 2]) -> usize {
    let width = |side: usize| own.last().map_or(0.0, |&k| fit.sides[side][k].length());
    let wider = usize::from(width(1) > width(0));
    match (right > BETTER * left, left > BETTER * right) {
        (true, _) => 1,
        (_, true) => 0,
        _ if width(wider) > TWICE * width(1 - wider) => 1 - wider,
        _ => wider,
    }
}

fn mean(one: &Bow, other: &Bow) -> Bow {
    let between = |p: Point2, q: Point2| nalgebra::center(&p, &q);
    let bow = [0, 1].map(|i| 0.5 * (one.bow[i] + other.bow[i]));
    Bow { a: between(one.a, other.a), b: between(one.b, other.b), bow }
}
