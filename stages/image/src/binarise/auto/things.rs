//! The things that lie in a photo, apart from each other: two garments on one sheet.
//!
//! What is far from the colours along the frame (`ground_distance`) is cut into its connected
//! pieces. A piece is a thing where it is large, does not touch the frame, and has an edge of the
//! photo nearly all along its outline: so patches of a patterned ground are none. Cost: a fit of
//! the frame's colours and a look at every small pixel. Limits: garments that touch or cover each
//! other are one thing; one of the ground's colours is none.

use super::super::background::CLEAN;
use super::super::beside::{SECOND, SIDE, Thing};
use super::super::finish::fill_holes;
use super::super::graph_cut::GraphCut;
use super::super::morphology::{close, open};
use super::super::regions::Regions;
use super::super::small::SmallPhoto;
use super::contour::support;
use super::grid::{bits, picture};
use super::ground_distance::ground_distance;
use toile_core::prelude::*;

/// A thing covers at least this share of the photo.
const LEAST: f64 = 0.02;
/// And has an edge along this share of its outline.
const OUTLINE: f64 = 0.8;

/// The things of a photo, from the largest to the smallest; those that are small beside the largest
/// are left out.
pub(super) fn things(photo: &Photo) -> Vec<Thing> {
    let small = SmallPhoto::of(photo, SIDE);
    let cut = GraphCut::default();
    let Some(raw) = ground_distance(&small, cut.modes as usize, cut.rim) else { return Vec::new() };
    let radius = (CLEAN * small.w.max(small.h) as f64 / 400.0).round() as u32;
    let mask = open(&close(&picture(&raw, small.w, small.h), radius), radius);
    let regions = Regions::of(&mask);
    let all = (small.w * small.h) as f64;
    let is_large = |i: &usize| {
        let piece = &regions.pieces[*i];
        piece.frame == 0 && piece.area as f64 >= LEAST * all
    };
    let solid = |i: usize| bits(&fill_holes(regions.paint(|k, _| k == i), 1.0));
    let whole = regions.by_size().into_iter().filter(is_large).map(solid);
    let found: Vec<Thing> =
        whole.filter(|mask| support(&small, mask) >= OUTLINE).map(|mask| Thing::of(mask, &small)).collect();
    let largest = found.iter().map(|t| t.area).fold(0.0, f64::max);
    found.into_iter().filter(|t| t.area >= SECOND * largest).collect()
}
