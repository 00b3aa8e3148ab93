//! Rulers: the spacing of marks along a straight edge.
//!
//! Straight segments of the reduced photo are taken for edges. Grey levels along lines beside an
//! edge are tested for a period by autocorrelation (`period`). Marks are told from weaves and
//! stripes by their shape: the period is there beside the edge, not beyond it, and deeper inside it
//! gives way to five or ten times as much (millimetres) or to nothing (centimetres). The spacing is
//! then followed along the edge by its phase, and a parabola through the phases gives it and its
//! change.
//!
//! Limits: the scale holds along the ruler; a tilt across it is not seen. Marks need 4 pixels each.
//! Rulers in inches are refused where their marks are halved again and again (two, four, eight).

mod period;
mod strip;

use crate::found::{Found, ScaleKind, middle};
use crate::pixels::ReducedPhoto;
use crate::ridges::SlopeRidges;
use crate::segments::{Segment, segments};
use crate::{KnownObject, ScaleError};
use image::RgbImage;
use nalgebra::{Matrix3, Point2, Rotation2};
use period::{MarkPhase, Period, autocorrelation, first_period};
use strip::Strip;

/// Longer sides of the reduced copies, pixels.
const SIZES: [usize; 2] = [1400, 600];
/// Edges that are looked at, the longest first.
const EDGES: usize = 90;
/// The least length of an edge at the reduced size, pixels.
const LEAST: f64 = 24.0;
/// The least autocorrelation of marks.
const CLEAR: f64 = 0.4;
/// The most change of the spacing along a ruler.
const CHANGE: f64 = 0.02;

/// Marks along an edge.
#[derive(Debug, Clone)]
struct RulerMarks {
    strip: Strip,
    /// Metres from a mark to the next.
    unit: f64,
    phase: MarkPhase,
    /// How well they are seen, the better the larger.
    merit: f64,
    /// Depths between which all marks lie, pixels.
    ends: [f64; 2],
}

/// Finds a ruler.
pub(crate) fn find(photo: &RgbImage, object: KnownObject) -> Result<Found, ScaleError> {
    let edges = edges(photo);
    let mut all: Vec<RulerMarks> = edges.iter().filter_map(|e| marks(photo, e)).collect();
    all.sort_by(|a, b| b.merit.total_cmp(&a.merit));
    let none = || {
        edges.iter().find_map(|e| fine(photo, e)).unwrap_or(ScaleError::NoneFound { object: object.name() })
    };
    let best = all.first().ok_or_else(none)?;
    let found = found(best, object);
    if best.phase.change.abs() > CHANGE && best.phase.spacing < LEAST_APART {
        let (place, apart) = (middle(&found.corners), best.phase.spacing);
        return Err(ScaleError::RulerFine { place, apart, least: LEAST_APART });
    }
    if best.phase.change.abs() > CHANGE {
        let percent = 100.0 * best.phase.change.abs();
        return Err(ScaleError::RulerTilted { place: middle(&found.corners), percent });
    }
    alone(&all, &found, object)?;
    Ok(found)
}

/// The least distance of marks that are told for sure, pixels.
const LEAST_APART: f64 = 4.0;

/// Marks along an edge that are too fine to be told: their period is there, and gone on both sides.
fn fine(photo: &RgbImage, edge: &Segment) -> Option<ScaleError> {
    let strip = Strip::of(edge)?;
    let (depth, p) = starts(photo, &strip).into_iter().find(|(_, p)| p.lag < LEAST_APART)?;
    let across = Across::of(photo, &strip, p.lag);
    let most = across.clear(depth);
    let [low, high] = [across.end(depth, -1.0, most)?, across.end(depth, 1.0, most)?];
    let at = strip.place(0.5 * strip.length as f64, 0.5 * (low + high));
    Some(ScaleError::RulerFine { place: [at.x, at.y], apart: p.lag, least: LEAST_APART })
}

/// Refuses where another ruler is as good: one whose middle is more than a ruler's width off the
/// line.
fn alone(all: &[RulerMarks], best: &Found, object: KnownObject) -> Result<(), ScaleError> {
    let mut places = vec![middle(&best.corners)];
    let Some(along) = (best.corners[1] - best.corners[0]).try_normalize(1e-9) else { return Ok(()) };
    for other in all.iter().skip(1).filter(|m| m.merit > 0.8 * all[0].merit) {
        let at = middle(&found(other, object).corners);
        let off = along.perp(&(Point2::from(at) - best.corners[0])).abs();
        if off > 0.07 * best.px_per_metre {
            places.push(at);
        }
    }
    match places.len() {
        1 => Ok(()),
        _ => Err(ScaleError::Several { object: object.name(), places }),
    }
}

/// Straight edges in photo pixels, from two reduced copies, as the texture of the ground is gone in
/// one of them.
fn edges(photo: &RgbImage) -> Vec<Segment> {
    let longer = photo.width().max(photo.height()) as usize;
    let mut ks = SIZES.map(|s| longer.div_ceil(s)).to_vec();
    ks.dedup();
    ks.into_iter().flat_map(|k| edges_at(photo, k)).collect()
}

/// The longest edges of the photo reduced by `k`, those alike once, each a tenth longer at both
/// ends.
fn edges_at(photo: &RgbImage, k: usize) -> Vec<Segment> {
    let small = ReducedPhoto::of(photo, k);
    let mut kept: Vec<Segment> = Vec::new();
    for s in segments(&SlopeRidges::of(&small, 2.0), LEAST) {
        if !kept.iter().any(|k| part_of(&s, k)) {
            kept.push(s);
        }
        if kept.len() == EDGES {
            break;
        }
    }
    let full = |s: &Segment| {
        let more = (s.b - s.a) * 0.1;
        Segment { a: small.to_photo(s.a - more), b: small.to_photo(s.b + more), seen: s.seen * k as f64 }
    };
    kept.iter().map(full).collect()
}

/// Whether a segment lies on a longer one.
fn part_of(s: &Segment, long: &Segment) -> bool {
    let middle = nalgebra::center(&s.a, &s.b);
    let t = long.along().dot(&(middle - long.a));
    long.off(s.a) < 1.5 && long.off(s.b) < 1.5 && t > 0.0 && t < long.length()
}

/// The marks on lines beside an edge, wherever they are within a ruler's width; millimetres before
/// others.
fn marks(photo: &RgbImage, edge: &Segment) -> Option<RulerMarks> {
    let strip = Strip::of(edge)?;
    let starts = starts(photo, &strip);
    let all: Vec<RulerMarks> = starts.iter().filter_map(|s| marks_of(photo, &strip, *s)).collect();
    let metric = |m: &RulerMarks| m.unit < 0.004 || of_centimetres(&starts, m.phase.spacing);
    all.into_iter().filter(metric).min_by(|a, b| a.unit.total_cmp(&b.unit).then(b.merit.total_cmp(&a.merit)))
}

/// The marks about a depth with a period.
fn marks_of(photo: &RgbImage, strip: &Strip, (middle, p): (f64, Period)) -> Option<RulerMarks> {
    let across = Across::of(photo, strip, p.lag);
    let most = across.clear(middle);
    // Marks end on both sides: the period is gone beyond the edge, and deeper inside.
    let ends = [across.end(middle, -1.0, most)?, across.end(middle, 1.0, most)?];
    let outer = [across.beyond(ends[0], -1.0), across.beyond(ends[1], 1.0)];
    let gone = outer.iter().flatten().map(|r| period::at(r, p.lag)).fold(0.0, f64::max);
    if gone > 0.7 * most {
        return None;
    }
    let unit = told([unit(&outer[0], p.lag), unit(&outer[1], p.lag)])?;
    let depths = [0.125, 0.375, 0.625, 0.875].map(|t| ends[0] + (ends[1] - ends[0]) * t);
    let phase = MarkPhase::follow(strip, photo, &depths, p.lag).filter(|f| regular(f, unit))?;
    let merit = p.clear * phase.periods.sqrt() * if unit < 0.004 { 1.0 } else { 2.0 };
    Some(RulerMarks { strip: strip.clone(), unit, phase, merit, ends })
}

/// Millimetres are told on one side; centimetres where neither side has another period.
fn told(units: [Option<f64>; 2]) -> Option<f64> {
    match units {
        [Some(a), Some(b)] => Some(a.min(b)),
        [Some(a), None] | [None, Some(a)] if a < 0.004 => Some(a),
        _ => None,
    }
}

/// Whether there are enough marks and they are evenly apart.
fn regular(phase: &MarkPhase, unit: f64) -> bool {
    let least = if unit < 0.004 { 25.0 } else { 7.0 };
    phase.periods >= least && phase.residual <= 0.12 * phase.spacing && phase.change.abs() <= 0.4
}

/// A period looked for on lines at depths across a strip.
#[derive(Debug)]
struct Across<'a> {
    photo: &'a RgbImage,
    strip: &'a Strip,
    lag: f64,
    /// The largest lag of the autocorrelations, pixels.
    lags: usize,
    /// Distance of the lines, pixels.
    step: f64,
}

impl<'a> Across<'a> {
    fn of(photo: &'a RgbImage, strip: &'a Strip, lag: f64) -> Self {
        let lags = ((11.0 * lag) as usize).min(strip.length / 4).clamp(8, 300);
        Across { photo, strip, lag, lags, step: (lag * 0.3).clamp(1.0, 6.0) }
    }

    fn look(&self, depth: f64) -> Vec<f64> {
        autocorrelation(&self.strip.profile(self.photo, depth), self.lags)
    }

    /// How clear the period is at a depth.
    fn clear(&self, depth: f64) -> f64 {
        period::at(&self.look(depth), self.lag)
    }

    /// The depth, one way from the middle, where the period is gone on three lines; a gap of two,
    /// as between marks and numbers, is no end.
    fn end(&self, middle: f64, way: f64, most: f64) -> Option<f64> {
        let lines = ((11.0 * self.lag).min(150.0) / self.step) as i32;
        let depth = |n: i32| middle + way * f64::from(n) * self.step;
        let mut low = 0;
        for n in 1..lines {
            low = if self.clear(depth(n)) < 0.5 * most { low + 1 } else { 0 };
            if low == 3 {
                return Some(depth(n - 2));
            }
        }
        None
    }

    /// Autocorrelations on lines from an end outwards.
    fn beyond(&self, from: f64, way: f64) -> Vec<Vec<f64>> {
        (0..14).map(|n| self.look(from + way * f64::from(n) * self.step)).collect()
    }
}

/// Distance of the lines on which a period is first looked for, pixels.
const APART: f64 = 7.0;

/// Periods beside an edge, the shortest first, each with the depth at which it is clearest.
fn starts(photo: &RgbImage, strip: &Strip) -> Vec<(f64, Period)> {
    let lags = (strip.length / 5).clamp(8, 96);
    let rows = ((0.2 * strip.length as f64).min(150.0) / APART) as i32;
    let of = |n: i32| {
        let depth = f64::from(n) * APART;
        Some((depth, first_period(&autocorrelation(&strip.profile(photo, depth), lags))?))
    };
    let mut kept: Vec<(f64, Period)> = Vec::new();
    for (depth, p) in (-rows..=rows).filter_map(of).filter(|(_, p)| p.clear >= CLEAR) {
        match kept.iter_mut().find(|k| (k.1.lag / p.lag - 1.0).abs() < 0.03) {
            Some(k) if k.1.clear < p.clear => *k = (depth, p),
            Some(_) => {}
            None => kept.push((depth, p)),
        }
    }
    kept.sort_by(|a, b| a.1.lag.total_cmp(&b.1.lag));
    kept.truncate(5);
    kept
}

/// Metres between marks, by the periods deeper inside: ten or five times as much tells millimetres,
/// none tells centimetres; others are refused, as half centimetres and parts of an inch look alike.
fn unit(deep: &[Vec<f64>], lag: f64) -> Option<f64> {
    let best = |times: f64| deep.iter().map(|r| period::peak_at(r, lag * times)).fold(0.0, f64::max);
    let [two, four, five, eight, ten] = [2.0, 4.0, 5.0, 8.0, 10.0].map(best);
    let halved = two.max(four).max(eight);
    if ten.max(five) > TOLD {
        return (ten.max(five) > halved && two < TOLD).then_some(0.001);
    }
    (halved < TOLD && lag >= 6.0).then_some(0.01)
}

/// The least autocorrelation of a period deeper inside.
const TOLD: f64 = 0.35;

/// Whether the shorter periods beside an edge are those of a ruler of centimetres: halves, fifths,
/// tenths.
fn of_centimetres(starts: &[(f64, Period)], lag: f64) -> bool {
    let metric = |p: &Period| {
        let times = lag / p.lag;
        times < 1.2 || [2.0, 5.0, 10.0].iter().any(|t| (times / t - 1.0).abs() < 0.11)
    };
    starts.iter().all(|(_, p)| metric(p))
}

/// The finding of marks.
fn found(marks: &RulerMarks, object: KnownObject) -> Found {
    let (strip, phase) = (&marks.strip, &marks.phase);
    let at = |x: f64, depth: f64| strip.place(x, depth);
    let (a, b) = (phase.marks[0], phase.marks[phase.marks.len() - 1]);
    let [low, high] = marks.ends;
    let corners = [at(a, low), at(b, low), at(b, high), at(a, high)];
    let px_per_metre = phase.spacing / marks.unit;
    let places: Vec<Point2<f64>> = phase.marks.iter().map(|x| at(*x, 0.5 * (low + high))).collect();
    let confidence = phase.seen;
    let centre = Point2::from(middle(&corners));
    let homography = upright(centre, strip, px_per_metre);
    Found {
        object,
        kind: ScaleKind::Line,
        corners,
        marks: places,
        homography,
        px_per_metre,
        residual: phase.residual,
        confidence,
        tilt: None,
    }
}

/// Pixels to metres by a turn that lays the ruler along x, and a scale.
fn upright(centre: Point2<f64>, strip: &Strip, px_per_metre: f64) -> Matrix3<f64> {
    let turn = Rotation2::new(-strip.along.y.atan2(strip.along.x));
    let m = turn.matrix() / px_per_metre;
    let shift = -(m * centre.coords);
    Matrix3::new(m[(0, 0)], m[(0, 1)], shift.x, m[(1, 0)], m[(1, 1)], shift.y, 0.0, 0.0, 1.0)
}
