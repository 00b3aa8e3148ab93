//! From a mask and an edge operator to the outline: what all edge detectors share.
//!
//! Lengths are shares of the garment's size (the root of its area), with a floor in pixels, so that
//! a small photo and a large one of the same garment, and a child's vest and a man's, are treated
//! alike.

use super::band::TileBand;
use super::corners::{self, CornerScale};
use super::crossing;
use super::curve::{self, Closed, Smoothing};
use super::operator::Operator;
use super::refine::refine;
use super::trace::{CrackLoop, loops};
use crate::binarise::OPAQUE;
use toile_core::prelude::*;

/// Parts of the garment's size; the millimetres are those of a vest (size 0.5 m).
struct Lengths {
    /// Search along the normal: 1.2 mm.
    reach: f64,
    /// Corner arms: 20 mm.
    arm: f64,
    /// Not trusted beside a corner: 1.5 mm.
    gap: f64,
    /// Smoothing window: 8 mm.
    window: f64,
    /// Sampling of the working curve: 0.5 mm.
    step: f64,
    /// Sampling of the result: 1 mm.
    spacing: f64,
}

impl Lengths {
    fn of(size: f64) -> Self {
        Lengths {
            reach: (size / 420.0).clamp(3.0, 8.0),
            arm: (size / 25.0).max(18.0),
            gap: (size / 330.0).max(3.5),
            window: (size / 62.0).max(5.0),
            step: (size / 1000.0).max(0.5),
            spacing: (size / 500.0).max(0.5),
        }
    }
}

/// Least turn of a corner: seams of garments meet at more, folds and wrinkles of the rim at less.
const LEAST_TURN: f64 = 32.0 * std::f64::consts::PI / 180.0;
/// Holes below this share of the garment's area are flaws of the mask: about 1 cm2 of a vest.
const TINY_HOLE: f64 = 4e-4;
/// A second piece above this share of the first is another garment.
const SECOND_PIECE: f64 = 0.2;
/// A mask that is the photo's opacity differs from it by this share at most, after clean-up: holes
/// that were filled, specks.
const MOST_BESIDE: f64 = 0.1;
/// Fewer pixels than this have no outline to speak of.
const LEAST_AREA: f64 = 400.0;

/// The outline of the mask's garment at the operator's edges.
pub(crate) fn detect(
    operator: &dyn Operator,
    photo: &Photo,
    mask: &Mask,
    cx: &Context,
) -> Result<Outline, StageError> {
    check_frame(photo, mask, cx)?;
    let mut found = loops(&mask.pixels);
    cx.check()?;
    let outer = take_outer(&mut found)?;
    let mut lengths = Lengths::of(outer.area.sqrt());
    lengths.window *= operator.smooth();
    found.retain(|l| -l.area > TINY_HOLE * outer.area);
    cx.progress(0.2, "looking for edges");
    let cracks: Vec<Point2> =
        std::iter::once(&outer).chain(&found).flat_map(|l| l.points.iter().copied()).collect();
    let size = [mask.pixels.width() as usize, mask.pixels.height() as usize];
    let band = TileBand::around(size, &cracks, lengths.reach + 3.0);
    let response = operator.respond(&photo.pixels, &band);
    cx.check()?;
    cx.progress(0.6, "finding corners");
    let mut seen = Vec::new();
    let mut finish = |l: &CrackLoop| {
        let refined = refine(&l.points, &response, lengths.reach);
        seen.push(refined.seen);
        cx.check()?;
        smooth_loop(&refined.points, &lengths)
    };
    let outer = finish(&outer)?;
    let holes = found.iter().map(&mut finish).collect::<Result<Vec<_>, _>>()?;
    cx.figure("edge_seen", seen[0], "");
    cx.figure("corners", outer.corners.len() as f64, "");
    let outline = in_metres(photo, outer, holes)?;
    cx.check()?;
    check_crossings(&outline)?;
    Ok(outline)
}

fn check_frame(photo: &Photo, mask: &Mask, cx: &Context) -> Result<(), StageError> {
    let (p, m) = (photo.pixels.dimensions(), mask.pixels.dimensions());
    if p != m {
        let text = format!("the mask has {} x {} pixels, its photo {} x {}", m.0, m.1, p.0, p.1);
        return Err(StageError::invalid(text));
    }
    let Some([left, top, right, bottom]) = mask.bounds() else {
        return Err(StageError::invalid("the mask is empty: no garment was found in the photo")
            .hint("try another binariser, such as `Background()`"));
    };
    let touched =
        [(left == 0, "left"), (top == 0, "upper"), (right + 1 == m.0, "right"), (bottom + 1 == m.1, "lower")];
    // How far a garment may touch the frame is the binariser's affair.
    // Of a mirror image it was told of its photo.
    for (_, side) in touched.iter().filter(|t| t.0 && !photo.mirrored && !is_opacity(photo, mask)) {
        cx.warn(format!(
            "the garment in \"{}\" touches the photo's {side} border, and ends there",
            photo.file
        ));
    }
    Ok(())
}

/// Whether a mask is the photo's opacity: a garment whose ground was cut away ends where it is seen
/// to end, at the frame too.
fn is_opacity(photo: &Photo, mask: &Mask) -> bool {
    let Some(alpha) = photo.alpha.as_deref().filter(|a| a.dimensions() == mask.pixels.dimensions()) else {
        return false;
    };
    let both = || mask.pixels.as_raw().iter().zip(alpha.as_raw());
    let differ = both().filter(|(m, a)| (**m != 0) != (**a >= OPAQUE)).count();
    let garment = both().filter(|(m, _)| **m != 0).count();
    differ as f64 <= MOST_BESIDE * garment as f64
}

/// Takes the largest piece out of the loops and refuses a second garment.
fn take_outer(found: &mut Vec<CrackLoop>) -> Result<CrackLoop, StageError> {
    let order = |a: &CrackLoop, b: &CrackLoop| b.area.total_cmp(&a.area);
    found.sort_by(order);
    let second = found.get(1).map_or(0.0, |l| l.area);
    if found.first().is_none_or(|l| l.area < LEAST_AREA) {
        let area = found.first().map_or(0.0, |l| l.area);
        return Err(StageError::invalid(format!(
            "the garment covers {area:.0} pixels only, too few for an outline"
        ))
        .hint("use a larger photo, or another binariser"));
    }
    let outer = found.remove(0);
    if second > SECOND_PIECE * outer.area {
        let share = 100.0 * second / outer.area;
        return Err(StageError::invalid(format!(
            "the mask holds two pieces; the second is {share:.0} % as large as the first"
        ))
        .hint("photograph one garment at a time"));
    }
    Ok(outer)
}

/// Corners, smoothing and even spacing of one loop, in pixels.
fn smooth_loop(points: &[Point2], lengths: &Lengths) -> Result<Loop, StageError> {
    let Lengths { arm, gap, window, spacing, .. } = *lengths;
    let small = || StageError::invalid("a loop of the outline is too short to be smoothed");
    let curve = Closed::sample(points, lengths.step).ok_or_else(small)?;
    let mut corners = corners::find(&curve, CornerScale { arm, gap, least_turn: LEAST_TURN });
    loop {
        let smooth = curve::smooth(&curve, &corners, Smoothing { window, gap, spacing });
        // Ragged borders can feign corners whose stretches cross each other: the one nearest to the
        // place goes.
        let Some(p) = crossing::first(std::iter::once(&smooth)) else { return Ok(smooth) };
        let far = |c: &curve::CurveCorner| (c.point - p).norm();
        let nearest = (0..corners.len()).min_by(|a, b| far(&corners[*a]).total_cmp(&far(&corners[*b])));
        match nearest.filter(|i| far(&corners[*i]) <= arm) {
            Some(i) => drop(corners.remove(i)),
            None => return Ok(crossing::without_small_loops(smooth, (2.0 * arm / spacing) as usize)),
        }
    }
}

/// From pixels (y up) to metres: the origin lies in the middle of the garment's box, at its bottom.
fn in_metres(photo: &Photo, outer: Loop, holes: Vec<Loop>) -> Result<Outline, StageError> {
    let xs = || outer.points.iter().map(|p| p.x);
    let (left, right) = (xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max));
    let bottom = outer.points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let frame = PhotoFrame {
        origin_px: Point2::new((left + right) / 2.0, -bottom),
        px_per_metre: scale(photo, right - left)?,
        mirrored: photo.mirrored,
        turn: 0.0,
    };
    let convert = |l: Loop| {
        let to = |p: &Point2| frame.to_metres(Point2::new(p.x, -p.y));
        let points = l.points.iter().map(to).collect();
        if frame.mirrored {
            reversed(Loop { points, corners: l.corners })
        } else {
            Loop { points, corners: l.corners }
        }
    };
    Ok(Outline {
        outer: convert(outer),
        holes: holes.into_iter().map(convert).collect(),
        edges: Vec::new(),
        inner: Vec::new(),
        frame: Some(frame),
        lies: Vec::new(),
    })
}

/// What lies in a photo is this wide, metres: a doll's sleeve, a tent.
const WIDEST: std::ops::Range<f64> = 1e-3..1e3;

fn scale(photo: &Photo, width_px: f64) -> Result<f64, StageError> {
    let given = photo.px_per_metre.or_else(|| photo.garment_width.map(|w| width_px / w));
    match given {
        Some(s) if s > 0.0 && WIDEST.contains(&(width_px / s)) => Ok(s),
        Some(s) => Err(StageError::invalid(format!("the photo's scale is {s:?} pixels per metre"))
            .hint("give the garment's real width, like `width: \"52 cm\"`")),
        None => Err(StageError::invalid("the photo's scale is not known")
            .hint("give the garment's real width beside its file, like `width: \"52 cm\"`")),
    }
}

/// A mirrored loop runs the other way round; the first point stays the first.
fn reversed(l: Loop) -> Loop {
    let n = l.points.len();
    let mut points = l.points;
    points[1..].reverse();
    let mut corners: Vec<usize> = l.corners.iter().map(|&c| (n - c) % n).collect();
    corners.sort_unstable();
    Loop { points, corners }
}

fn check_crossings(outline: &Outline) -> Result<(), StageError> {
    match crossing::first(std::iter::once(&outline.outer).chain(&outline.holes)) {
        None => Ok(()),
        Some(p) => Err(StageError::new(
            ErrorCode::DegenerateTriangles,
            format!("the outline crosses itself {:.0} mm right of and {:.0} mm above the middle of its lower border", p.x * 1e3, p.y * 1e3),
        )
        .hint("smooth the garment's rim in the photo, or try another binariser")),
    }
}
