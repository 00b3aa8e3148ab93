//! `DepthView`: the view between two photos around an object, by depth.

use super::orbit::OrbitCameras;
use super::photos::{pair, view};
use super::sweep::{SweepPlanes, depths};
use crate::panorama::Lens;
use crate::picture::{GreyPlane, by_rows, cubic};
use image::RgbImage;
use toile_core::prelude::*;

/// Depth is found on photos reduced to this length, px.
const LONGEST_PX: usize = 640;
/// Inverse depths that differ by less than so many planes are the same.
const SAME_PLANES: f64 = 2.0;

/// Colours so near to the border of something nearer are partly its own, px; they count so much
/// where the other photo has a better one.
const BESIDE_PX: f64 = 2.0;
const BESIDE: f32 = 1e-3;

/// Makes the view from a place between two photos of an object, by the depth of what they show.
///
/// The camera went around the object, or the object turned on its stand, by an angle that is given;
/// so what one photo shows at a pixel lies in the other on a line, the epipolar line, and where on
/// it says how deep it is. Depth is found by matching along these lines, each photo's against the
/// other's; then both photos are drawn from the new place, the nearer before the farther, and what
/// one alone shows is taken from that one. The result is a photo named `view`.
///
/// Limits: both photos look at the axis of the turn from the same distance, upright. On a turntable
/// the ground behind does not turn with the object: photograph it before plain ground.
#[stage(
    role = ViewInterpolator,
    source = "garment modelling thesis, 2012: view interpolation; Chen, Williams 1993; Collins 1996; Hirschmuller 2008",
    example = "DepthView(turn: 12, lens: Degrees(40))",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct DepthView {
    /// The angle from the first photo's camera to the second one's, positive where the camera went
    /// to the right or the object turned to the left.
    #[param(min = -60.0, max = 60.0, unit = "deg")]
    turn: f64,
    /// The focal length of the camera; it is not estimated.
    #[param(default = Lens::Equivalent(26.0))]
    lens: Lens,
    /// The place: 0 is that of the first photo in the order of their names, 1 that of the second.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    at: f64,
    /// The nearest that is seen, in distances from the camera to the axis of the turn.
    #[param(default = 0.6, min = 0.05, max = 0.99)]
    near: f64,
    /// The farthest that is seen, in distances from the camera to the axis of the turn.
    #[param(default = 3.0, min = 1.01, max = 1000.0)]
    far: f64,
}

#[stage]
impl DepthView {
    pub(super) fn run(&self, photos: Set<Photo>, cx: &Context) -> Result<Set<Photo>, StageError> {
        let [a, b] = pair(&photos)?;
        let size = [a.width(), a.height()];
        let focal = self.lens.focal(size)?.ok_or_else(unknown_lens)?;
        let scene =
            DepthScene::of([&a, &b], focal, self.turn.to_radians(), [1.0 / self.far, 1.0 / self.near], cx)?;
        cx.progress(0.9, "view");
        let colours = scene.seen_from(self.at, cx)?;
        Ok(view(&colours, size))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        let unknown = matches!(self.lens, Lens::Estimate).then(unknown_lens);
        self.lens.fault().or(unknown).into_iter().collect()
    }
}

fn unknown_lens() -> StageError {
    StageError::new(ErrorCode::InvalidParameter, "two photos around an object do not tell the focal length")
        .hint("give `lens` what the camera's data sheet says, as `Equivalent(26)`, or its angle, as `Degrees(40)`")
        .at("lens")
}

/// Two photos with their depths.
struct DepthScene<'a> {
    photos: [&'a RgbImage; 2],
    orbit: OrbitCameras,
    /// From the first camera to the second, radians.
    turn: f64,
    /// Inverse depths of the reduced photos, their width, and pixels a pixel of theirs.
    depths: [Vec<f32>; 2],
    width: usize,
    factor: f64,
    step: f64,
}

/// Where a pixel of the view lies: its inverse depth, and whether both photos agree on it.
type ViewPlace = Option<(f32, bool)>;

impl<'a> DepthScene<'a> {
    fn of(
        photos: [&'a RgbImage; 2],
        focal: f64,
        turn: f64,
        [far, near]: [f64; 2],
        cx: &Context,
    ) -> Result<Self, StageError> {
        let mut planes = [GreyPlane::of(photos[0], cx)?, GreyPlane::of(photos[1], cx)?];
        let mut factor = 1.0;
        while planes[0].width.max(planes[0].height) > LONGEST_PX {
            planes = [planes[0].half(), planes[1].half()];
            factor *= 2.0;
        }
        let size = [photos[0].width() as usize, photos[0].height() as usize];
        let orbit = OrbitCameras::new(focal, size);
        let reduced =
            OrbitCameras { focal: focal / factor, centre: orbit.centre.map(|c| (c + 0.5) / factor - 0.5) };
        let sweep = SweepPlanes::new(far, near, &reduced, turn);
        cx.progress(0.0, "depth of the first photo");
        let [a, b] = &planes;
        let of_a = depths(a, b, &reduced, turn, sweep, cx)?;
        cx.progress(0.45, "depth of the second photo");
        let of_b = depths(b, a, &reduced, -turn, sweep, cx)?;
        cx.figure("planes", sweep.count as f64, "");
        Ok(DepthScene { photos, orbit, turn, depths: [of_a, of_b], width: a.width, factor, step: sweep.step })
    }

    /// The inverse depth of a photo at a place.
    fn depth(&self, side: usize, [x, y]: [f64; 2]) -> Option<f64> {
        let [w, h] = [self.photos[side].width(), self.photos[side].height()].map(f64::from);
        if !(x > -0.5 && y > -0.5 && x < w - 0.5 && y < h - 0.5) {
            return None;
        }
        let of = |v: f64| (((v + 0.5) / self.factor).floor()).max(0.0) as usize;
        let rows = self.depths[side].len() / self.width.max(1);
        let (x, y) = (of(x).min(self.width - 1), of(y).min(rows.saturating_sub(1)));
        self.depths[side].get(y * self.width + x).map(|d| f64::from(*d))
    }

    /// Whether a photo shows what lies at a place of it with that inverse depth.
    fn shows(&self, side: usize, at: [f64; 2], depth: f64) -> bool {
        self.depth(side, at).is_some_and(|d| (d - depth).abs() <= SAME_PLANES * self.step)
    }

    /// Whether something nearer is beside a place of a photo, whose colour it then has in part.
    fn beside_nearer(&self, side: usize, [x, y]: [f64; 2], depth: f64) -> bool {
        let beside = BESIDE_PX.max(self.factor);
        let around = [[x - beside, y], [x + beside, y], [x, y - beside], [x, y + beside]];
        around.iter().any(|p| self.depth(side, *p).is_some_and(|d| d - depth > SAME_PLANES * self.step))
    }

    /// The turn from a photo's camera to a place between.
    fn to_place(&self, side: usize, at: f64) -> f64 {
        if side == 0 { at * self.turn } else { (at - 1.0) * self.turn }
    }

    /// The colours from a place between.
    fn seen_from(&self, at: f64, cx: &Context) -> Result<Vec<[f32; 3]>, StageError> {
        let (w, h) = self.photos[0].dimensions();
        let (w, h) = (w as usize, h as usize);
        let mut places: Vec<ViewPlace> = vec![None; w * h];
        for side in 0..2 {
            for y in 0..h {
                if y % 16 == 0 {
                    cx.check()?;
                }
                (0..w).for_each(|x| self.lay(side, [x as f64, y as f64], at, &mut places, [w, h]));
            }
        }
        let share = |n: usize| n as f64 / (w * h).max(1) as f64;
        let alone = places.iter().flatten().filter(|p| !p.1).count();
        cx.figure("one_photo_alone", share(alone), "share of pixels");
        cx.figure("unseen", share(places.iter().filter(|p| p.is_none()).count()), "share of pixels");
        let depths = filled(&places, w);
        let colour = |k: usize| self.colour([(k % w) as f64, (k / w) as f64], f64::from(depths[k]), at);
        by_rows(w, h, cx, colour)
    }

    /// Lays a pixel of a photo where it is in the view: what both agree on before what one alone
    /// shows; of the former the nearer, of the latter the farther.
    fn lay(&self, side: usize, pixel: [f64; 2], at: f64, places: &mut [ViewPlace], [w, h]: [usize; 2]) {
        let Some(depth) = self.depth(side, pixel) else { return };
        let across = if side == 0 { self.turn } else { -self.turn };
        let agreed =
            self.orbit.seen(pixel, depth, across).is_some_and(|(there, d)| self.shows(1 - side, there, d));
        let Some(([x, y], seen)) = self.orbit.seen(pixel, depth, self.to_place(side, at)) else { return };
        let seen = seen as f32;
        for (x, y) in
            [(x.floor(), y.floor()), (x.ceil(), y.floor()), (x.floor(), y.ceil()), (x.ceil(), y.ceil())]
        {
            if x < 0.0 || y < 0.0 || x >= w as f64 || y >= h as f64 {
                continue;
            }
            let Some(place) = places.get_mut(y as usize * w + x as usize) else { continue };
            let wins = place.is_none_or(|(d, both)| match (agreed, both) {
                (true, true) => seen > d,
                // What comes into sight beside an object is mostly what lies behind it.
                (false, false) => seen < d,
                (one, _) => one,
            });
            if wins {
                *place = Some((seen, agreed));
            }
        }
    }

    fn colour(&self, pixel: [f64; 2], depth: f64, at: f64) -> [f32; 3] {
        let of = |side: usize| {
            let (there, seen) = self.orbit.seen(pixel, depth, -self.to_place(side, at))?;
            let photo = self.photos[side];
            let shows = self.shows(side, there, seen);
            // Beyond the frame of both, the border's pixels go on.
            let last = [photo.width(), photo.height()].map(|n| f64::from(n) - 1.0);
            let [x, y] = [0, 1].map(|c| there[c].clamp(0.0, last[c]));
            let own = if shows && self.beside_nearer(side, there, seen) { BESIDE } else { 1.0 };
            Some((cubic(photo, x, y)?, shows, own))
        };
        let weights = [1.0 - at as f32, at as f32];
        let both = [of(0), of(1)];
        let shown = both.iter().flatten().any(|(_, shows, _)| *shows);
        let (mut sum, mut total) = ([0f32; 3], 0f32);
        for (colour, weight) in both.iter().zip(weights).filter_map(|(s, w)| Some((s.as_ref()?, w))) {
            if shown && !colour.1 {
                continue;
            }
            // The photo that is not there still counts where the other shows nothing.
            let weight = colour.2 * (weight + 1e-4);
            (0..3).for_each(|c| sum[c] += weight * colour.0[c]);
            total += weight;
        }
        if total > 0.0 { sum.map(|s| s / total) } else { [0.0; 3] }
    }
}

/// Inverse depths of a row; holes take that of the farther side, which is what comes into sight.
fn filled(places: &[ViewPlace], w: usize) -> Vec<f32> {
    let mut out = Vec::with_capacity(places.len());
    for row in places.chunks(w.max(1)) {
        let left = row.iter().scan(None, |last: &mut Option<f32>, p| {
            *last = p.map(|p| p.0).or(*last);
            Some(*last)
        });
        let left: Vec<Option<f32>> = left.collect();
        let mut right: Vec<Option<f32>> = Vec::with_capacity(row.len());
        let mut last = None;
        for p in row.iter().rev() {
            last = p.map(|p| p.0).or(last);
            right.push(last);
        }
        out.extend(left.iter().zip(right.iter().rev()).map(|(l, r)| match (l, r) {
            (Some(l), Some(r)) => l.min(*r),
            (one, other) => one.or(*other).unwrap_or(1.0),
        }));
    }
    out
}
