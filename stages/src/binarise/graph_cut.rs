//! The cheapest boundary between two colour models.
//!
//! Start: the mask of `Background`. Then, a few times over: fit a mixture of Gaussians to the colours
//! inside and one to those outside, and cut the grid of pixels where
//! `sum over pixels of -ln p(colour | its side) + gamma sum over parted neighbours of exp(-beta |dI|^2) / distance`
//! is least (Boykov and Jolly, Interactive graph cuts, ICCV 2001; Rother, Kolmogorov and Blake, GrabCut,
//! SIGGRAPH 2004). No user draws a box: the frame's rim is ground, and a pixel is the likelier garment the
//! further it lies from the frame.
//!
//! All this is done at a reduced size; the boundary is set again at the photo's own size (`refine`).
//!
//! Cost: about 0.1 s a round at 400 px. Limits: needs some difference of colour; a strong cast shadow
//! may be taken for garment.

use super::background::{background, clean, rim_width};
use super::cut::{Grid, STEPS};
use super::finish::{Finish, cut_out, finish, has_pixels, no_garment};
use super::mixture::Mixture;
use super::refine::refine;
use super::small::{Lab, Small};
use toile_core::prelude::*;

/// Finds the boundary that parts two colour models at the least cost.
///
/// The most robust of the binarisers on real photos: patterned grounds, prints, soft shadows. The
/// frame's rim must show ground. Transparent pixels are ground.
#[stage(
    role = Binariser,
    source = "Boykov and Jolly, 2001; Rother, Kolmogorov and Blake, 2004",
    example = "GraphCut(rounds: 4)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct GraphCut {
    /// How many colours garment and ground may have, each.
    #[param(default = 6, min = 1, max = 16)]
    modes: u32,
    /// Rounds of fitting and cutting.
    #[param(default = 4, min = 1, max = 20, trades)]
    rounds: u32,
    /// What a step of boundary costs, against the colours: more gives a smoother outline.
    #[param(default = 50.0, min = 0.0, max = 1000.0)]
    gamma: f64,
    /// Width of the rim that is taken for ground, as a share of the shorter side.
    #[param(default = 0.03, min = 0.005, max = 0.2)]
    rim: f64,
    /// The longer side at which the cut is made.
    #[param(default = 400, min = 64, max = 2000, unit = "px", trades)]
    size: u32,
    /// Holes up to this share of the garment's area are filled.
    #[param(default = 1.0, min = 0.0, max = 1.0)]
    holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side.
    #[param(default = 0.05, min = 0.0, max = 4.0)]
    touch: f64,
}

#[stage]
impl GraphCut {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        has_pixels(photo)?;
        let settings = Finish { open: 0, close: 0, holes: self.holes, touch: self.touch };
        if let Some(mask) = cut_out(photo) {
            return finish(mask, photo, settings, cx);
        }
        let small = Small::of(photo, self.size);
        cx.check()?;
        let one_colour = || no_garment(photo, "it has the colours of the frame's rim all over");
        let links = Links::of(&small, self.gamma);
        let (inside, outside) = start(&small, self.modes as usize, self.rim);
        let mask = self.cut(&small, &inside, &outside, &links, cx)?;
        let mut mask = clean(&small, &mask).ok_or_else(one_colour)?;
        for round in 0..self.rounds {
            let share = f64::from(round) / f64::from(self.rounds);
            cx.progress(share, format!("cut {} of {}", round + 1, self.rounds));
            let next = self.cut(&small, &mask, &mask.iter().map(|v| !v).collect::<Vec<_>>(), &links, cx)?;
            let next = clean(&small, &next).ok_or_else(one_colour)?;
            if next == mask {
                break;
            }
            mask = next;
        }
        finish(refine(photo, &small, &mask, cx)?, photo, settings, cx)
    }

    /// One round: both models from the mask, then the cut.
    fn cut(
        &self,
        small: &Small,
        mask: &[bool],
        other: &[bool],
        links: &Links,
        cx: &Context,
    ) -> Result<Vec<bool>, StageError> {
        let side = |of: &[bool]| -> Vec<Lab> {
            let pixels = small.lab.iter().zip(of).zip(&small.seen);
            pixels.filter(|((_, m), seen)| **m && **seen).map(|((c, _), _)| *c).collect()
        };
        let models = (
            Mixture::fit(&side(mask), self.modes as usize, 0.0),
            Mixture::fit(&side(other), self.modes as usize, 0.0),
        );
        let (Some(garment), Some(ground)) = models else { return Ok(mask.to_vec()) };
        let rim = rim_width(small, self.rim);
        let mut grid = Grid::new(small.w, small.h);
        for (i, colour) in small.lab.iter().enumerate() {
            let gain = ground.cost(colour) - garment.cost(colour) + place(small, i);
            let gain = if !small.seen[i] || small.depth(i) < rim { gain.min(0.0) - RIM_COST } else { gain };
            grid.set_terminal(i, units(gain));
        }
        links.put(&mut grid);
        grid.solve(|| cx.check())
    }
}

/// What it costs to take a pixel of the rim for garment.
const RIM_COST: f64 = 10.0;

/// Costs as whole numbers; the bound keeps sums far below the largest.
fn units(cost: f64) -> i32 {
    (cost * 1000.0).clamp(-1e8, 1e8) as i32
}

fn start(small: &Small, modes: usize, rim: f64) -> (Vec<bool>, Vec<bool>) {
    let middle: Vec<bool> = (0..small.lab.len()).map(|i| in_middle(small, i)).collect();
    let covers = |mask: &Vec<bool>| {
        let both = mask.iter().zip(&middle).filter(|(a, b)| **a && **b).count();
        both as f64 >= 0.8 * middle.iter().filter(|m| **m).count() as f64
    };
    match background(small, modes, rim, 0.5).filter(covers) {
        Some(mask) => (mask.iter().zip(&middle).map(|(a, b)| *a || *b).collect(), mask.iter().map(|on| !on).collect()),
        None => (middle, (0..small.lab.len()).map(|i| small.depth(i) < rim_width(small, rim)).collect()),
    }
}

fn in_middle(small: &Small, i: usize) -> bool {
    let (x, y) = ((i % small.w) as f64 / small.w as f64 - 0.5, (i / small.w) as f64 / small.h as f64 - 0.5);
    (x / 0.2).powi(2) + (y / 0.2).powi(2) < 1.0
}

/// ln of how much likelier garment is than ground at a pixel, by its place alone.
fn place(small: &Small, i: usize) -> f64 {
    let depth = small.depth(i) as f64 / small.w.min(small.h) as f64;
    ((depth - 0.1) * 10.0).clamp(-1.0, 1.0)
}

/// What it costs to part each pixel from its neighbours to the right and below.
struct Links(Vec<[i32; 4]>);

/// The directions of the links that each pixel keeps: the second half of [`STEPS`].
const KEPT: std::ops::Range<usize> = 4..8;

impl Links {
    fn of(small: &Small, gamma: f64) -> Links {
        let difference = |i: usize, d: usize| {
            let (x, y) = ((i % small.w) as isize + STEPS[d].0, (i / small.w) as isize + STEPS[d].1);
            let inside = x >= 0 && (x as usize) < small.w && (y as usize) < small.h;
            inside.then(|| (small.lab[i] - small.lab[y as usize * small.w + x as usize]).norm_squared())
        };
        let all = (0..small.lab.len()).flat_map(|i| KEPT.filter_map(move |d| difference(i, d)));
        let (sum, count) = all.fold((0.0, 0.0), |(s, n), d| (s + d, n + 1.0));
        let beta = if sum > 0.0 { count / (2.0 * sum) } else { 0.0 };
        let cost = |i: usize, d: usize| {
            let far = f64::hypot(STEPS[d].0 as f64, STEPS[d].1 as f64);
            difference(i, d).map_or(0, |x| units(gamma * (-beta * x).exp() / far))
        };
        Links((0..small.lab.len()).map(|i| std::array::from_fn(|k| cost(i, KEPT.start + k))).collect())
    }

    fn put(&self, grid: &mut Grid) {
        for (i, costs) in self.0.iter().enumerate() {
            for (d, &cost) in KEPT.zip(costs).filter(|(_, c)| **c > 0) {
                grid.set_link(i, d, cost);
            }
        }
    }
}
