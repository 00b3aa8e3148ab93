//! `Neckline`: finds the front's neckline in its photo.
//!
//! A shirt laid flat shows the inside of its back above the front's neckline, so the outline's
//! upper border is the back's neckline, and a front cut along it has no room for the throat.
//! Method: a family of curves from neck point to neck point, from V to U and of all depths, is laid
//! over the photo, and the one across which the colour changes most evenly wins (deformable
//! templates: Yuille, Hallinan, Cohen, 1992). The median along the curve counts, so that a label or
//! a print beneath part of it does not, and beside it the lower quartile, so that a curve which
//! follows the neckline half of the way does not. Cost: some thousand curves of 40 points, a few
//! milliseconds. Limits: a curve that is symmetric about the middle of the neck points; a garment
//! photographed closed and without any seam at its neck gets the usual depth, with a warning.

use super::block::{Layer, ellipse};
use super::closed_front::ClosedFront;
use super::drawn::redrawn;
use super::replaced::replaced;
use rayon::prelude::*;
use toile_core::prelude::*;

/// The first depth that is tried, as a share of the neck's width.
const FIRST_DEPTH: f64 = 0.28;
/// The last depth that is tried, as a share of the neck's width.
const LAST_DEPTH: f64 = 1.3;
/// The step between depths that are tried, as a share of the neck's width.
const DEPTH_STEP: f64 = 0.01;
/// Powers of the curves `depth (1 - |s|^p)`: from nearly V to U.
const POWERS: [f64; 6] = [1.2, 1.6, 2.0, 2.5, 3.2, 4.0];
/// The likeliest depth, as a share of the neck's width.
const USUAL_DEPTH: f64 = 0.5;
/// How far off the likeliest depth a curve must be to count half, as a share of the neck's width.
const HALF_COUNT_OFF: f64 = 0.3;
/// A neck edge that dips by this share of its width is the front's neckline already.
const DIPS: f64 = 0.3;
/// Points of a curve at which colours are compared, over this share of its width: near its ends all
/// curves meet.
const SAMPLES: usize = 40;
const WITHIN: f64 = 0.86;
/// Half the distance across the curve at which colours are compared, as a share of the neck's
/// width.
const ACROSS: f64 = 0.025;
/// Half the least distance across the curve at which colours are compared, px.
const LEAST_ACROSS: f64 = 1.5;
/// How far below the present edge a curve must lie, in such half distances, and over which part of
/// its width: a back's collar is no neckline of the front.
const MARGIN: f64 = 2.5;
const INSIDE: f64 = 0.7;
/// Of a front with armholes, the share of the height from armpits to neck points above which its
/// neckline ends: what shows below is a print.
const ABOVE_ARMPITS: f64 = 0.8;
/// A neck that is closed is no tighter than this share of the body's: a rib stretches so far.
const TIGHTEST: f64 = 0.95;
/// The least power of a neckline that is cut for the body, and the halvings that find its depth.
const ROUND: f64 = 2.0;
const HALVINGS: usize = 40;
/// A neckline that is cut deeper than its photo shows it by more than this is to be looked at,
/// metres.
const MUCH: f64 = 0.04;
/// What is proposed beyond a depth, metres.
const MORE: f64 = 0.02;
/// A neckline reaches down no further than this share of its piece.
const DEEPEST: f64 = 0.7;
/// Least change of colour across the curve, in levels of 0 to 255.
const LEAST_CHANGE: f64 = 3.0;
/// Depths that are tried to either side of the curve that was found, and how far they reach, in
/// half distances of comparison.
const REFINE: i32 = 40;
const REFINE_REACH: f64 = 4.0;
/// Distance of the points of the new edge, metres.
const SPACING: f64 = 1e-3;

/// Cuts the front along the neckline that its photo shows.
///
/// Use it where the photo of the front shows the inside of the back above the neckline, as with
/// most shirts laid flat. The back keeps its outline. A front whose outline dips at the neck
/// already is left as it is. Where front and back together would not reach around the body's neck,
/// the front is cut deeper than its photo shows it, with a warning. The pattern is cut with the
/// outlines, so that what is written is what is sewn; of outlines without a pattern it is drawn.
#[stage(
    role = Style,
    version = 4,
    source = "deformable templates: Yuille, Hallinan, Cohen, 1992",
    example = "Neckline(depth: \"8 cm\")",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Neckline {
    /// How deep the neckline lies below its ends; found in the photo where it is not given.
    #[param(default = None, min = 0.0, max = 1.0)]
    depth: Option<Length>,
    /// The depth that is taken where nothing is found, as a share of the neck's width.
    #[param(default = 0.45, min = 0.05, max = 2.0)]
    usual: f64,
}

#[stage]
impl Neckline {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        pattern: Option<&Pattern>,
        plan: Option<&SewingPlan>,
        photos: Set<Photo>,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<(Set<Outline>, Pattern), StageError> {
        let cut = self.cut_all(&outlines, &photos, body, cx)?;
        let pattern = match pattern {
            Some(pattern) => redrawn(pattern, &outlines, &cut)?,
            None => Pattern::of_outlines("outlines", cut.iter(), plan.map_or(&[], |plan| &plan.seams)),
        };
        Ok((cut, pattern))
    }
}

impl Neckline {
    /// The outlines with the necks of the fronts cut.
    fn cut_all(
        &self,
        outlines: &Set<Outline>,
        photos: &Set<Photo>,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Set<Outline>, StageError> {
        if let Some((name, _)) = outlines.iter().find(|(_, o)| o.outer.points.len() < 3) {
            return Err(StageError::invalid(format!("the outline of \"{name}\" has no points")));
        }
        if let Some((name, _)) = photos.iter().find(|(_, p)| p.pixels.as_raw().is_empty()) {
            return Err(StageError::invalid(format!("the photo of \"{name}\" has no pixels")));
        }
        for (name, outline) in outlines.iter().filter(|(name, _)| Layer::of_name(name) == Layer::Front) {
            let chord = neck(outline).and_then(|neck| Chord::of(outline, neck));
            self.depth.zip(chord).map_or(Ok(()), |(depth, chord)| chord.holds(depth, name, outline))?;
        }
        let around = |o: &Outline| Some(polyline_length(&o.edge_points(neck(o)?)));
        let mut backs = outlines.iter().filter(|(name, _)| Layer::of_name(name) == Layer::Back);
        let behind = backs.find_map(|(_, o)| around(o));
        let least =
            body.and_then(throat).zip(behind).map_or(0.0, |(throat, behind)| TIGHTEST * throat - behind);
        let closed = ClosedFront::among(outlines);
        let both = closed.as_ref().and_then(|front| {
            let name = Layer::Front.word();
            front.halved(&self.cut(name, &front.whole, photos.get(name), least, cx)?)
        });
        let is_half = |name: &str| both.is_some() && closed.as_ref().is_some_and(|f| f.is_half(name));
        let others = outlines.iter().filter(|(name, _)| !is_half(name)).map(|(name, o)| {
            cx.check()?;
            let photo = photos.get(name);
            Ok((name.to_owned(), self.cut(name, o, photo, least, cx).unwrap_or_else(|| o.clone())))
        });
        others.chain(both.clone().into_iter().flatten().map(Ok)).collect()
    }

    /// The outline with its neck cut, no shorter than `least`, or nothing where it stays as it is.
    fn cut(
        &self,
        name: &str,
        outline: &Outline,
        photo: Option<&Photo>,
        least: f64,
        cx: &Context,
    ) -> Option<Outline> {
        let neck = neck(outline).filter(|_| Layer::of_name(name) == Layer::Front)?;
        let chord = Chord::of(outline, neck)?;
        let collar = chord.profile(&outline.edge_points(neck));
        let lowest = collar.iter().copied().fold(0.0, f64::max);
        let dips = lowest > DIPS * chord.width;
        let set = |depth: f64| format!("--set 'stages.{}.depth=\"{:.0} mm\"'", cx.stage(), depth * 1e3);
        if self.depth.is_none() && dips && polyline_length(&outline.edge_points(neck)) >= least {
            cx.note(format!(
                "the neck of \"{name}\" dips by {:.0} mm as it lies, and stays so ({} cuts it anew)",
                lowest * 1e3,
                set(lowest + MORE)
            ));
            return None;
        }
        let most = if self.depth.is_some() { f64::INFINITY } else { chord.deepest(outline) };
        let usual = (self.usual * chord.width).min(most);
        let found = match self.depth {
            Some(depth) => Some(NeckCurve { depth: depth.metres(), power: 2.0 }),
            None if dips => Some(NeckCurve { depth: lowest, power: 2.0 }),
            None => photo
                .zip(outline.frame)
                .and_then(|(p, frame)| chord.find(p, frame.joined(p.joined), &collar, most)),
        };
        let curve = found.unwrap_or_else(|| {
            cx.warn(format!(
                "the photo of \"{name}\" shows no neckline; it is cut {:.0} mm deep ({} cuts it deeper)",
                usual * 1e3,
                set(usual + MORE)
            ));
            NeckCurve { depth: usual, power: 2.0 }
        });
        let mut curve = NeckCurve { depth: curve.depth.min(most), ..curve };
        if self.depth.is_none() && chord.length(&curve) < least {
            let shown = curve.depth;
            curve = chord.long_enough(curve, least, most.min(LAST_DEPTH * chord.width));
            let text = format!(
                "the neck of \"{name}\" would be too tight for the body: its front is cut {:.0} mm deep, and not {:.0} ({} keeps that)",
                curve.depth * 1e3,
                shown * 1e3,
                set(shown)
            );
            if curve.depth - shown > MUCH { cx.warn(text) } else { cx.note(text) }
        }
        cx.figure("depth", curve.depth, "m");
        Some(replaced(outline, neck, &chord.points(&curve)))
    }
}

/// The neck of a front or back from side to side.
fn neck(outline: &Outline) -> Option<&Edge> {
    outline.edge_of(EdgeRole::Neck, None)
}

/// Around the neck of a body, where a neckline lies: an ellipse through its sides, its front and
/// its back, metres.
fn throat(body: &Body) -> Option<f64> {
    let at = |name: &str| body.landmarks.get(name).copied();
    let [left, right] = Hand::BOTH.map(|hand| body.landmark("neck", hand));
    let (left, right) = (left?, right?);
    let (front, back) = (at("neck_base_front")?, at("neck_base_back")?);
    let (a, b) = (0.5 * (left - right).norm(), 0.5 * (front - back).norm());
    Some(ellipse(a, b))
}

/// A neckline: depth below the chord at `s` from -1 to 1 is `depth (1 - |s|^power)`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct NeckCurve {
    depth: f64,
    power: f64,
}

impl NeckCurve {
    fn depth_at(&self, s: f64) -> f64 {
        self.depth * (1.0 - s.abs().powf(self.power))
    }
}

/// Places along a curve at which colours are compared.
fn places() -> impl Iterator<Item = f64> {
    (0..SAMPLES).map(|k| WITHIN * (2.0 * k as f64 / (SAMPLES - 1) as f64 - 1.0))
}

/// The line between the neck points.
struct Chord {
    middle: Point2,
    /// Half of it, towards the neck's end.
    half: Vector2,
    down: Vector2,
    width: f64,
}

impl Chord {
    fn of(outline: &Outline, neck: &Edge) -> Option<Chord> {
        let (a, b) = (outline.outer.points[neck.start], outline.outer.points[neck.end]);
        let half = (b - a) / 2.0;
        // The garment lies to the left of a counter-clockwise edge.
        let down = Vector2::new(-half.y, half.x).try_normalize(1e-9)?;
        Some(Chord { middle: nalgebra::center(&a, &b), half, down, width: 2.0 * half.norm() })
    }

    /// The depth of the present edge at each place where colours are compared: its lowest point
    /// near there.
    fn profile(&self, edge: &[Point2]) -> Vec<f64> {
        let across = |p: &Point2| (p - self.middle).dot(&self.half) / self.half.norm_squared();
        let near = |s: f64| {
            let close = edge.iter().filter(|p| (across(p) - s).abs() <= 2.0 / SAMPLES as f64);
            close.map(|p| (p - self.middle).dot(&self.down)).fold(0.0, f64::max)
        };
        places().map(near).collect()
    }

    fn at(&self, curve: &NeckCurve, s: f64) -> Point2 {
        self.middle + self.half * s + self.down * curve.depth_at(s)
    }

    fn length(&self, curve: &NeckCurve) -> f64 {
        let points: Vec<Point2> = (0..=200).map(|k| self.at(curve, f64::from(k) / 100.0 - 1.0)).collect();
        polyline_length(&points)
    }

    /// The curve made round and so deep that it is as long as `least`; as deep as `most` where that
    /// is not enough.
    fn long_enough(&self, curve: NeckCurve, least: f64, most: f64) -> NeckCurve {
        let at = |depth: f64| NeckCurve { depth, power: curve.power.max(ROUND) };
        let (mut low, mut high) = (curve.depth, most.max(curve.depth));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.length(&at(middle)) < least { low = middle } else { high = middle }
        }
        at(high)
    }

    /// The curve's points without its ends.
    fn points(&self, curve: &NeckCurve) -> Vec<Point2> {
        // Even in s would be sparse where the curve is steep; a fine polyline is thinned instead.
        let fine: Vec<Point2> = (0..=4000).map(|k| self.at(curve, f64::from(k) / 2000.0 - 1.0)).collect();
        let length = polyline_length(&fine);
        let count = ((length / SPACING).round() as usize).max(8);
        let mut points = Vec::with_capacity(count);
        let mut passed = 0.0;
        for w in fine.windows(2) {
            passed += (w[1] - w[0]).norm();
            if passed >= length * (points.len() + 1) as f64 / count as f64 && points.len() + 1 < count {
                points.push(w[1]);
            }
        }
        points
    }

    /// Half the distance across a curve at which colours are compared.
    fn across(&self, frame: PhotoFrame) -> f64 {
        (ACROSS * self.width).max(LEAST_ACROSS / frame.px_per_metre)
    }

    /// How deep a neckline may be at most: it ends above the armpits, where the outline has
    /// armholes.
    fn deepest(&self, outline: &Outline) -> f64 {
        let holes = Hand::BOTH.into_iter().filter_map(|hand| outline.edge_of(EdgeRole::Armhole, Some(hand)));
        let points = &outline.outer.points;
        let depth = |i: usize| (points[i] - self.middle).dot(&self.down);
        let armpits = holes.map(|e| depth(e.start).max(depth(e.end)));
        ABOVE_ARMPITS * armpits.fold(f64::INFINITY, f64::min)
    }

    /// Refuses a depth that would reach through the piece.
    fn holds(&self, depth: Length, name: &str, outline: &Outline) -> Result<(), StageError> {
        let down = |p: &Point2| (p - self.middle).dot(&self.down);
        let most = DEEPEST * outline.outer.points.iter().map(down).fold(0.0, f64::max);
        if depth.metres() <= most {
            return Ok(());
        }
        let most = Length::cm((most * 1e2 + 1e-6).floor());
        Err(StageError::invalid(format!("a neck {depth} deep leaves nothing of \"{name}\""))
            .hint(format!("{most} is the most"))
            .at("depth"))
    }

    /// The curve of the most even change of colour below the present edge, and no deeper than
    /// `most`.
    fn find(&self, photo: &Photo, frame: PhotoFrame, collar: &[f64], most: f64) -> Option<NeckCurve> {
        let steps = ((LAST_DEPTH - FIRST_DEPTH) / DEPTH_STEP) as usize;
        let depths =
            (0..=steps).map(|k| (FIRST_DEPTH + k as f64 * DEPTH_STEP) * self.width).filter(|d| *d <= most);
        // Above the collar lies the ground, whose border is no neckline.
        let clear = MARGIN * self.across(frame);
        let inside = |c: &NeckCurve| {
            let mut both = places().zip(collar).filter(|(s, _)| s.abs() < INSIDE);
            both.all(|(s, above)| c.depth_at(s) > above + clear)
        };
        let curves: Vec<NeckCurve> = depths
            .flat_map(|depth| POWERS.iter().map(move |&power| NeckCurve { depth, power }))
            .filter(inside)
            .collect();
        let across = self.across(frame);
        let changes: Vec<Change> = curves.par_iter().map(|c| self.change(photo, frame, c, across)).collect();
        // Prints have even edges too, but not where necklines are.
        let likely =
            |c: &NeckCurve| 1.0 / (1.0 + ((c.depth / self.width - USUAL_DEPTH) / HALF_COUNT_OFF).powi(2));
        let score = |i: &usize| changes[*i].score() * likely(&curves[*i]);
        let seen = (0..curves.len()).filter(|i| changes[*i].median >= LEAST_CHANGE);
        let best = seen.max_by(|a, b| score(a).total_cmp(&score(b))).map(|i| curves[i])?;
        Some(self.refined(photo, frame, best))
    }

    /// The best curve beside one that was found: colours compared over a quarter of the distance.
    fn refined(&self, photo: &Photo, frame: PhotoFrame, found: NeckCurve) -> NeckCurve {
        let (far, near) = (self.across(frame), self.across(frame) / 4.0);
        let step = REFINE_REACH * far / f64::from(REFINE);
        let depths = (-REFINE..=REFINE).map(|k| found.depth + step * f64::from(k));
        let curves: Vec<NeckCurve> =
            depths.flat_map(|depth| POWERS.iter().map(move |&power| NeckCurve { depth, power })).collect();
        let score = |c: &NeckCurve| self.change(photo, frame, c, near).score();
        let scores: Vec<f64> = curves.par_iter().map(score).collect();
        // Of equal ones that in the middle of the plateau, nearest to what was found.
        let off = |i: &usize| {
            (curves[*i].depth - found.depth).abs() + (curves[*i].power - found.power).abs() * near
        };
        let best = (0..curves.len())
            .max_by(|a, b| scores[*a].total_cmp(&scores[*b]).then(off(b).total_cmp(&off(a))));
        best.map_or(found, |i| curves[i])
    }

    /// The change of colour from below a curve to above, `across` metres to either side.
    fn change(&self, photo: &Photo, frame: PhotoFrame, curve: &NeckCurve, across: f64) -> Change {
        let mut changes: Vec<nalgebra::Vector3<f64>> = Vec::with_capacity(SAMPLES);
        for s in places() {
            let tangent = self.at(curve, s + 0.01) - self.at(curve, s - 0.01);
            let Some(normal) = Vector2::new(-tangent.y, tangent.x).try_normalize(1e-12) else {
                return Change::default();
            };
            let p = self.at(curve, s);
            let (below, above) = (frame.to_px(p + normal * across), frame.to_px(p - normal * across));
            let (below, above) = (colour(photo, below), colour(photo, above));
            changes.push(std::array::from_fn::<f64, 3, _>(|c| below[c] - above[c]).into());
        }
        Change::of(&changes)
    }
}

/// How colours change across a curve, in levels of 0 to 255.
#[derive(Debug, Clone, Copy, Default)]
struct Change {
    /// The median over the curve.
    median: f64,
    /// The lower quartile of the changes in the median's direction.
    quartile: f64,
}

impl Change {
    fn of(changes: &[nalgebra::Vector3<f64>]) -> Change {
        let channel = |c: usize| quantile_of(changes.iter().map(|v| v[c]), 0.5);
        let typical = nalgebra::Vector3::new(channel(0), channel(1), channel(2));
        match typical.try_normalize(1e-9) {
            Some(along) => Change {
                median: typical.norm(),
                quartile: quantile_of(changes.iter().map(|v| v.dot(&along)), 0.25),
            },
            None => Change::default(),
        }
    }

    fn score(&self) -> f64 {
        (self.median + self.quartile.max(0.0)) / 2.0
    }
}

fn quantile_of(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    quantile(&sorted, share)
}

/// The colour at a place between four pixels; the picture goes on beyond its frame.
fn colour(photo: &Photo, p: Point2) -> [f64; 3] {
    let (w, h) = photo.pixels.dimensions();
    let (x, y) = (p.x.clamp(0.0, f64::from(w - 1)), p.y.clamp(0.0, f64::from(h - 1)));
    let (i, j) = (x as u32, y as u32);
    let (right, below) = ((i + 1).min(w - 1), (j + 1).min(h - 1));
    let (fx, fy) = (x.fract(), y.fract());
    let at = |x: u32, y: u32| photo.pixels.get_pixel(x, y).0.map(f64::from);
    let (a, b, c, d) = (at(i, j), at(right, j), at(i, below), at(right, below));
    std::array::from_fn(|k| {
        (a[k] * (1.0 - fx) + b[k] * fx) * (1.0 - fy) + (c[k] * (1.0 - fx) + d[k] * fx) * fy
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use image::{Rgb, RgbImage};
    use std::sync::Arc;

    /// A plain square shirt, 40 cm wide and 50 cm high, at 500 pixels a metre; its neck is 16 cm
    /// wide.
    fn shirt() -> Outline {
        let corners = [(0.2, 0.0), (0.2, 0.48), (0.08, 0.5), (-0.08, 0.5), (-0.2, 0.48), (-0.2, 0.0)];
        let points = corners.map(|(x, y)| Point2::new(x, y)).to_vec();
        let names = ["side_left", "shoulder_left", "neck", "shoulder_right", "side_right", "hem"];
        let gauge = Gauge::straight(0.1);
        let edge = |i: usize| Edge { name: names[i].into(), start: i, end: (i + 1) % 6, gauge };
        Outline {
            outer: Loop { points, corners: (0..6).collect() },
            holes: Vec::new(),
            edges: (0..6).map(edge).collect(),
            inner: Vec::new(),
            frame: Some(PhotoFrame {
                origin_px: Point2::new(150.0, 290.0),
                px_per_metre: 500.0,
                mirrored: false,
                turn: 0.0,
            }),
            lies: Vec::new(),
        }
    }

    /// A photo of it: the inside of the back shows above a parabola `depth` deep.
    fn photo(depth: f64) -> Photo {
        let pixels = RgbImage::from_fn(300, 320, |x, y| {
            let (u, v) = ((f64::from(x) - 150.0) / 500.0, (290.0 - f64::from(y)) / 500.0);
            let inside = u.abs() < 0.08 && v > 0.5 - depth * (1.0 - (u / 0.08).powi(2));
            Rgb(if inside { [90, 80, 70] } else { [120, 110, 100] })
        });
        Photo {
            pixels: Shared::new(pixels),
            alpha: None,
            px_per_metre: None,
            garment_width: None,
            mirrored: false,
            joined: 1,
            file: "front.jpg".into(),
        }
    }

    fn both<T: Clone>(value: &T) -> Set<T> {
        Set(["front", "back"].map(|n| (n.to_owned(), Arc::new(value.clone()))).into())
    }

    fn run(stage: &Neckline, depth: f64) -> Set<Outline> {
        stage.cut_all(&both(&shirt()), &both(&photo(depth)), None, &Context::quiet()).unwrap()
    }

    fn lowest(o: &Outline) -> f64 {
        o.edge_points(o.edge("neck").unwrap()).iter().map(|p| 0.5 - p.y).fold(0.0, f64::max)
    }

    /// The shirt, cut in halves along its middle.
    fn halves() -> Set<Outline> {
        let part = |name: &str, corners: &[(f64, f64)], names: &[&str]| {
            let n = corners.len();
            let gauge = Gauge::straight(0.1);
            let edge = |i: usize| Edge { name: names[i].into(), start: i, end: (i + 1) % n, gauge };
            let points = corners.iter().map(|(x, y)| Point2::new(*x, *y)).collect();
            let outer = Loop { points, corners: (0..n).collect() };
            let edges = (0..n).map(edge).collect();
            (name.to_owned(), Arc::new(Outline { outer, edges, ..shirt() }))
        };
        let left = [(0.0, 0.0), (0.2, 0.0), (0.2, 0.48), (0.08, 0.5), (0.0, 0.5)];
        let right = [(0.0, 0.0), (0.0, 0.5), (-0.08, 0.5), (-0.2, 0.48), (-0.2, 0.0)];
        let left = part(
            "left_front",
            &left,
            &["hem_left", "side_left", "shoulder_left", "neck_left", "middle_left"],
        );
        let right = part(
            "right_front",
            &right,
            &["middle_right", "neck_right", "shoulder_right", "side_right", "hem_right"],
        );
        Set([left, right].into_iter().collect())
    }

    #[test]
    fn a_front_in_halves_gets_one_neckline() {
        let stage = Neckline { depth: Some(Length::m(0.1)), usual: 0.45 };
        let cut = stage
            .cut_all(&halves(), &Set(std::collections::BTreeMap::new()), None, &Context::quiet())
            .unwrap();
        let ends = |panel: &str, edge: &str| {
            let o = cut.get(panel).unwrap();
            let points = o.edge_points(o.edge(edge).unwrap());
            (points[0], points[points.len() - 1], polyline_length(&points))
        };
        let (left, right) = (ends("left_front", "neck_left"), ends("right_front", "neck_right"));
        assert!(
            (left.1 - Point2::new(0.0, 0.4)).norm() < 1e-9 && left.1 == right.0,
            "{} {}",
            left.1,
            right.0
        );
        assert!((left.2 - right.2).abs() < 1e-6 && left.2 > 0.12, "{} {}", left.2, right.2);
        let (a, b) = (ends("left_front", "middle_left"), ends("right_front", "middle_right"));
        assert!((a.2 - 0.4).abs() < 1e-9 && (a.2 - b.2).abs() < 1e-9);
        assert_eq!(cut.0.len(), 2);
    }

    #[test]
    fn the_front_is_cut_where_the_photo_changes_colour_and_the_back_is_not() {
        for depth in [0.05, 0.09, 0.16] {
            let cut = run(&Neckline::default(), depth);
            let front = cut.get("front").unwrap();
            assert!((lowest(front) - depth).abs() < 0.004, "{depth}: {}", lowest(front));
            assert_eq!(cut.get("back").unwrap().outer, shirt().outer);
        }
    }

    #[test]
    fn all_other_edges_keep_their_points_and_gauges() {
        let (before, cut) = (shirt(), run(&Neckline::default(), 0.08));
        let front = cut.get("front").unwrap();
        for e in before.edges.iter().filter(|e| e.name != "neck") {
            let now = front.edge(&e.name).unwrap();
            assert_eq!(front.edge_points(now), before.edge_points(e), "{}", e.name);
            assert_eq!(now.gauge, e.gauge);
        }
        let neck = front.edge("neck").unwrap();
        assert!((neck.gauge.length - polyline_length(&front.edge_points(neck))).abs() < 1e-9);
        assert!(polygon_area(&front.outer.points) < polygon_area(&before.outer.points));
        assert_eq!(front.outer.corners.len(), 6);
    }

    /// The edges of the pattern's pieces are those of the outlines, and it lowers to them.
    fn assert_drawn(pattern: &Pattern, outlines: &Set<Outline>) {
        for piece in &pattern.pieces {
            let outline = outlines.get(&piece.name).unwrap();
            for e in &outline.edges {
                let length = polyline_length(&outline.edge_points(e));
                let drawn = piece.path(&e.name).unwrap().length();
                assert!((length - drawn).abs() < 1e-9, "{}.{}: {length} {drawn}", piece.name, e.name);
            }
        }
        let lowered = pattern.lower().unwrap().outlines;
        for (name, o) in outlines.iter() {
            assert!((polygon_area(&lowered[name].outer.points) - polygon_area(&o.outer.points)).abs() < 1e-9);
        }
    }

    #[test]
    fn what_is_drawn_is_what_is_cut() {
        let deep = Neckline { depth: Some(Length::m(0.1)), ..Neckline::default() };
        for outlines in [both(&shirt()), halves()] {
            let photos = || both(&photo(0.05));
            let (uncut, own) = (Pattern::of_outlines("shirt", outlines.iter(), &[]), Context::quiet());
            let (cut, pattern) =
                deep.run(outlines.clone(), Some(&uncut), None, photos(), None, &own).unwrap();
            assert_ne!(pattern, uncut);
            assert_drawn(&pattern, &cut);
            let (cut, pattern) = deep.run(outlines, None, None, photos(), None, &own).unwrap();
            assert_drawn(&pattern, &cut);
        }
    }

    #[test]
    fn a_pattern_of_other_pieces_is_refused() {
        let deep = Neckline { depth: Some(Length::m(0.1)), ..Neckline::default() };
        let other = Pattern::of_outlines("shirt", halves().iter(), &[]);
        let e = deep
            .run(both(&shirt()), Some(&other), None, both(&photo(0.05)), None, &Context::quiet())
            .unwrap_err();
        assert_eq!(e.to_string(), "the outline \"front\" was cut anew, and the pattern has no such piece");
        assert_eq!(
            e.hint.as_deref(),
            Some("put the stage that makes the pattern right before the one that cuts its necks")
        );
    }

    #[test]
    fn a_given_depth_is_taken() {
        let stage = Neckline { depth: Some(Length::cm(12.0)), ..Neckline::default() };
        assert!((lowest(run(&stage, 0.05).get("front").unwrap()) - 0.12).abs() < 1e-3);
    }

    #[test]
    fn a_depth_that_leaves_nothing_of_the_front_is_refused() {
        let stage = Neckline { depth: Some(Length::cm(45.0)), ..Neckline::default() };
        let e = stage.cut_all(&both(&shirt()), &both(&photo(0.05)), None, &Context::quiet()).unwrap_err();
        assert_eq!(e.to_string(), "a neck 45 cm deep leaves nothing of \"front\"");
        assert_eq!(e.hint.as_deref(), Some("35 cm is the most"));
    }

    #[test]
    fn a_neck_that_dips_already_stays() {
        let once = run(&Neckline::default(), 0.08);
        let again = Neckline::default().cut_all(&once, &both(&photo(0.08)), None, &Context::quiet()).unwrap();
        assert_eq!(once.get("front").unwrap().outer, again.get("front").unwrap().outer);
    }

    #[test]
    fn a_print_below_the_armpits_is_no_neckline() {
        let mut armholed = shirt();
        for (name, side) in [("armhole_left", "side_left"), ("armhole_right", "side_right")] {
            armholed.edges.iter_mut().filter(|e| e.name == side).for_each(|e| e.name = name.into());
        }
        // An armhole from 20 cm below the neck points: half of the side.
        armholed.outer.points[0].y = 0.3;
        armholed.outer.points[5].y = 0.3;
        let cut = Neckline::default()
            .cut_all(&both(&armholed), &both(&photo(0.18)), None, &Context::quiet())
            .unwrap();
        assert!(lowest(cut.get("front").unwrap()) < 0.16 + 1e-9);
        assert!((lowest(run(&Neckline::default(), 0.18).get("front").unwrap()) - 0.18).abs() < 0.004);
    }

    /// A body whose neck is that wide and that deep.
    fn necked(wide: f64, deep: f64) -> Body {
        let marks = [
            ("neck_left", [wide / 2.0, 1.4, 0.0]),
            ("neck_right", [-wide / 2.0, 1.4, 0.0]),
            ("neck_base_front", [0.0, 1.4, deep / 2.0]),
            ("neck_base_back", [0.0, 1.4, -deep / 2.0]),
        ];
        Body {
            positions: vec![],
            triangles: vec![],
            landmarks: marks.map(|(n, [x, y, z])| (n.to_owned(), Point3::new(x, y, z))).into(),
            measurements: [].into(),
        }
    }

    #[test]
    fn a_neck_too_tight_for_the_body_is_cut_deeper_and_told() {
        let cx = Context::quiet();
        // A circle of 12 cm: 377 mm around, of which the back spans 160.
        let body = necked(0.12, 0.12);
        let cut =
            Neckline::default().cut_all(&both(&shirt()), &both(&photo(0.05)), Some(&body), &cx).unwrap();
        let front = cut.get("front").unwrap();
        let around = polyline_length(&front.edge_points(front.edge("neck").unwrap())) + 0.16;
        assert!((around - 0.95 * 0.377).abs() < 2e-3, "{around}");
        let depth = 1e3 * lowest(front);
        let told = cx.take_remarks();
        let start = format!(
            "the neck of \"front\" would be too tight for the body: its front is cut {depth:.0} mm deep, and not "
        );
        // By a few millimetres: nothing to look at.
        assert!(told.notes[0].starts_with(&start) && told.warnings.is_empty(), "{told:?}");
        let set = format!("(--set 'stages.{}.depth=\"", cx.stage());
        assert!(told.notes[0].contains(&set) && told.notes[0].ends_with(" mm\"' keeps that)"), "{told:?}");
        let wide = necked(0.08, 0.08);
        let kept =
            Neckline::default().cut_all(&both(&shirt()), &both(&photo(0.05)), Some(&wide), &cx).unwrap();
        assert!((lowest(kept.get("front").unwrap()) - 0.05).abs() < 0.004);
    }

    #[test]
    fn a_photo_without_a_neckline_gets_the_usual_depth() {
        let front = run(&Neckline::default(), 0.0);
        assert!((lowest(front.get("front").unwrap()) - 0.45 * 0.16).abs() < 1e-3);
    }
}
