//! Small loops and spikes of an outline, which are left out.
//!
//! Where the legs of a dart touch before its tip, or a node lies just beside the curve that it
//! follows, an outline crosses itself or runs back on itself. Seamly2D and Valentina cut such loops
//! off when they lay a piece out; so does this, up to a share of the outline. Method: every two
//! parts are tested for crossings; of the two ways around a crossing the shorter is left out, and
//! the search begins again. Cost: parts squared. Limits: [`MOST`] loops; outlines of more than
//! [`MOST_LINKS`] parts are left as they are; one part that crosses itself is not seen.

use super::super::plane::{DraftCurve, DraftStroke, crossings};
use super::path::{DraftedPath, Nearness, OutlinePart};
use kurbo::{CubicBez, Point, Rect};

/// Loops of one outline.
const MOST: usize = 40;
/// Parts of an outline that is searched.
const MOST_LINKS: usize = 2000;
/// Loops of up to this share of the outline are left out.
const SHARE: f64 = 0.03;
/// Cosine of the angle between two parts that run back on each other.
const BACK: f64 = -0.98;

/// A part of an outline with its start, as a curve.
#[derive(Clone)]
struct LoopLink {
    from: String,
    straight: bool,
    curve: DraftCurve,
}

impl LoopLink {
    fn length(&self) -> f64 {
        self.curve.length()
    }

    /// The part of it between two lengths; `from` is empty where its start is cut off.
    fn between(&self, from: f64, to: f64) -> Self {
        let name = if from > 0.0 { String::new() } else { self.from.clone() };
        LoopLink { from: name, straight: self.straight, curve: self.curve.between([from, to], ["", ""]) }
    }

    fn bounds(&self) -> Rect {
        let all =
            self.curve.strokes.iter().flat_map(DraftStroke::cubics).flat_map(|c| [c.p0, c.p1, c.p2, c.p3]);
        let start = self.curve.start();
        all.fold(Rect::from_points(start, start), |r, p| r.union_pt(p))
    }
}

/// Takes small loops out of a closed path; the lengths of those that were taken.
pub(super) fn without_loops(path: &mut DraftedPath, near: Nearness, boxes: &mut usize) -> Vec<f64> {
    if path.parts.len() > MOST_LINKS {
        return Vec::new();
    }
    let mut links = links(path);
    let most = SHARE * links.iter().map(LoopLink::length).sum::<f64>();
    let mut taken = Vec::new();
    while taken.len() < MOST && links.len() > 2 {
        let found = spike(&links, near, most).or_else(|| crossed(&links, near, most, boxes));
        let Some((rest, length)) = found else { break };
        links = rest;
        links.retain(|l| l.length() > near.same);
        taken.push(length);
    }
    if !taken.is_empty() {
        *path = joined(&links);
    }
    taken
}

fn links(path: &DraftedPath) -> Vec<LoopLink> {
    let mut from = path.start;
    let one = |part: &OutlinePart| {
        let third = (part.end - from) / 3.0;
        let line = DraftStroke::Cubic(CubicBez::new(from, from + third, part.end - third, part.end));
        from = part.end;
        let curve = DraftCurve::single(part.stroke.unwrap_or(line), "", "");
        LoopLink { from: part.from.clone(), straight: part.stroke.is_none(), curve }
    };
    path.parts.iter().map(one).collect()
}

fn joined(links: &[LoopLink]) -> DraftedPath {
    let start = links.first().map_or(Point::ZERO, |l| l.curve.start());
    let last = links.len().saturating_sub(1);
    let part = |(k, l): (usize, &LoopLink)| OutlinePart {
        from: l.from.clone(),
        stroke: l.curve.strokes.first().copied().filter(|_| !l.straight),
        end: if k == last { start } else { l.curve.end() },
    };
    DraftedPath { start, parts: links.iter().enumerate().map(part).collect() }
}

/// The path without a part that runs back on the one before it, or that the next one runs back on.
fn spike(links: &[LoopLink], near: Nearness, most: f64) -> Option<(Vec<LoopLink>, f64)> {
    let n = links.len();
    (0..n).find_map(|k| {
        let next = (k + 1) % n;
        let (one, other) = (&links[k], &links[next]);
        let into = -one.curve.strokes.last()?.reversed().leaves();
        let out = other.curve.strokes.first()?.leaves();
        if into.dot(out) > BACK * into.hypot() * out.hypot() {
            return None;
        }
        let mut rest = links.to_vec();
        let (far, along) = one.curve.nearest(other.curve.end());
        let (beside, ahead) = other.curve.nearest(one.curve.start());
        let length = if far <= near.on {
            rest[k] = one.between(0.0, along);
            rest.remove(next);
            one.length() - along + other.length()
        } else if beside <= near.on {
            rest[next] = other.between(ahead, other.length());
            rest.remove(k);
            one.length() + ahead
        } else {
            return None;
        };
        (length <= most).then_some((rest, length))
    })
}

/// The path without the shorter way around the first crossing that is short enough.
fn crossed(links: &[LoopLink], near: Nearness, most: f64, boxes: &mut usize) -> Option<(Vec<LoopLink>, f64)> {
    let n = links.len();
    let bounds: Vec<Rect> = links.iter().map(|l| l.bounds().inflate(near.same, near.same)).collect();
    let lengths: Vec<f64> = links.iter().map(LoopLink::length).collect();
    let whole: f64 = lengths.iter().sum();
    for i in 0..n {
        for j in i + 1..n {
            if bounds[i].intersect(bounds[j]).is_zero_area() {
                continue;
            }
            let joint = |p: &Point| {
                let at = |q: Point| (*p - q).hypot() <= 10.0 * near.same;
                (j == i + 1 && at(links[i].curve.end()))
                    || (i == 0 && j == n - 1 && at(links[i].curve.start()))
            };
            for p in crossings(&links[i].curve, &links[j].curve, boxes) {
                if joint(&p) {
                    continue;
                }
                let (s, t) = (links[i].curve.nearest(p).1, links[j].curve.nearest(p).1);
                let inner = lengths[i] - s + lengths[i + 1..j].iter().sum::<f64>() + t;
                if inner <= most {
                    let mut rest = links[..i].to_vec();
                    rest.extend([links[i].between(0.0, s), links[j].between(t, lengths[j])]);
                    rest.extend_from_slice(&links[j + 1..]);
                    return Some((rest, inner));
                }
                if whole - inner <= most {
                    let mut rest = vec![links[i].between(s, lengths[i])];
                    rest.extend_from_slice(&links[i + 1..j]);
                    rest.push(links[j].between(0.0, t));
                    return Some((rest, whole - inner));
                }
            }
        }
    }
    None
}
