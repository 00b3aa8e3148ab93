//! The independent methods, all on one grid of small pixels.

use super::super::background::{SHADOW, background, clean, in_middle};
use super::super::graph_cut::{GraphCut, start};
use super::super::small::SmallPhoto;
use super::colour_split::colour_split;
use super::ground_distance::ground_distance;
use super::network::with_odds;
use super::walker::walk;
use toile_core::prelude::*;
use toile_recognise::SeenGarment;

/// A method's mask.
#[derive(Debug, Clone)]
pub(super) struct MethodMask {
    /// The method, as a user would name it.
    pub name: &'static str,
    /// The mask, a small pixel a value.
    pub mask: Vec<bool>,
}

/// What each method finds; a method that finds nothing is left out.
/// `given` is the mask of an earlier stage, brought to the small size; `seen` what a network sees.
pub(super) fn methods(
    small: &SmallPhoto,
    given: Option<Vec<bool>>,
    seen: Option<&SeenGarment>,
    cx: &Context,
) -> Result<Vec<MethodMask>, StageError> {
    let cut = GraphCut::default();
    let modes = cut.modes as usize;
    let mut found = Vec::new();
    let mut add = |name, mask: Option<Vec<bool>>| found.extend(mask.map(|mask| MethodMask { name, mask }));
    let first = cut.settle(small.clone(), start(small, modes, cut.rim), cx)?;
    add("graph cut", first.map(|c| c.mask));
    add("background", background(small, modes, cut.rim, SHADOW));
    add("colour split", colour_split(small, cut.rim).and_then(|raw| clean(small, &raw)));
    add("ground distance", ground_distance(small, modes, cut.rim).and_then(|raw| clean(small, &raw)));
    let middle: Vec<bool> = (0..small.lab.len()).map(|i| in_middle(small, i)).collect();
    let chance = walk(small, &middle, cut.rim, cx)?;
    let walked: Vec<bool> = chance.iter().map(|c| *c > 0.5).collect();
    let walked = clean(small, &walked);
    add("random walk", walked.clone());
    if let Some(walked) = walked {
        let outside: Vec<bool> = walked.iter().map(|on| !on).collect();
        let again = cut.settle(small.clone(), (walked, outside), cx)?;
        add("graph cut from edges", again.map(|c| c.mask));
    }
    if let Some(seen) = seen {
        let small = with_odds(small.clone(), seen);
        let start: Vec<bool> = small.odds.iter().flatten().map(|odds| *odds > 0.0).collect();
        let outside: Vec<bool> = start.iter().map(|on| !on).collect();
        if start.contains(&true) && outside.contains(&true) {
            add("network", cut.settle(small, (start, outside), cx)?.map(|c| c.mask));
        }
    }
    add("mask given", given.and_then(|raw| clean(small, &raw)));
    Ok(found)
}
