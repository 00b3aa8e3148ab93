//! Pieces folded along their pleats before they are placed.
//!
//! Method: a pleat's two lines and the fold lines between them (the middle; of a box pleat the
//! quarter points) divide the piece into zones, and each zone is turned over about the fold that it
//! lies behind, as paper is folded; what lies beyond a pleat moves with its last zone. Each layer
//! starts a little behind the one before it. Lines count as straight, from their first point to
//! their last, and as going on over the whole piece. Cost: linear in vertices times pleats. Limits:
//! pleats of one piece may not cross.

use super::patches::outsides;
use crate::place::sew::Offsets;
use nalgebra::{Affine2, Matrix3};
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// How far a layer starts behind the one before it, metres.
const DEEP: f64 = 0.006;
/// Behind a fold it gets there within this, metres.
const STEP: f64 = 0.01;
/// And beyond a pleat back again within this, metres.
const RAMP: f64 = 0.03;

/// A folded piece.
pub(super) struct Folded {
    /// The panel with its flat points where folding brings them.
    pub(super) panel: Panel,
    /// How far each of them starts inside of the outermost layer, metres.
    depth: Vec<f64>,
    /// A word on what was folded.
    pub(super) told: String,
}

/// How a pleat is laid, and the ends of its two lines.
type Lines = (PleatFold, [Point2; 2], [Point2; 2]);

/// A straight line as a point and a unit direction.
#[derive(Clone, Copy)]
struct PleatLine {
    at: Point2,
    way: Vector2,
}

impl PleatLine {
    fn between(a: Point2, b: Point2) -> Self {
        PleatLine { at: a, way: (b - a).try_normalize(0.0).unwrap_or_else(Vector2::y) }
    }

    /// Signed distance of a point, metres.
    fn side(&self, p: Point2) -> f64 {
        self.way.perp(&(p - self.at))
    }

    /// Turning over about it.
    fn turn(&self) -> Affine2<f64> {
        let (x, y) = (self.way.x, self.way.y);
        let (a, b) = (2.0 * x * x - 1.0, 2.0 * x * y);
        let by = self.at.coords - Vector2::new(a * self.at.x + b * self.at.y, b * self.at.x - a * self.at.y);
        Affine2::from_matrix_unchecked(Matrix3::new(a, b, by.x, b, -a, by.y, 0.0, 0.0, 1.0))
    }
}

/// A pleat: where the cloth is folded, in their order, and how each zone moves.
struct Pleat {
    folds: Vec<PleatLine>,
    /// One more than folds; the first or the last of them stays.
    zones: Vec<Affine2<f64>>,
    /// The far line of a knife pleat, which is no fold.
    under: Option<PleatLine>,
    /// 1 where zones follow each other from left to right of the first line, else -1.
    sign: f64,
    /// Whether the zone before the first fold is the one that stays.
    forward: bool,
    /// Where it begins along the piece.
    from: f64,
    /// How much narrower it makes the piece, metres.
    width: f64,
}

impl Pleat {
    fn new(fold: PleatFold, a: [Point2; 2], b: [Point2; 2], across: Vector2) -> Self {
        let part = |s: f64| PleatLine::between(a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s);
        let shares: &[f64] = match fold {
            PleatFold::Knife => &[0.0, 0.5],
            PleatFold::Box => &[0.0, 0.25, 0.75, 1.0],
        };
        let folds: Vec<PleatLine> = shares.iter().map(|s| part(*s)).collect();
        let mut zones = vec![Affine2::identity()];
        folds.iter().for_each(|l| zones.push(zones[zones.len() - 1] * l.turn()));
        let middle = |l: [Point2; 2]| nalgebra::center(&l[0], &l[1]);
        let (from, to) = (across.dot(&middle(a).coords), across.dot(&middle(b).coords));
        let forward = from <= to;
        if !forward {
            let back = zones[zones.len() - 1].inverse();
            zones.iter_mut().for_each(|z| *z = back * *z);
        }
        let under = matches!(fold, PleatFold::Knife).then(|| part(1.0));
        let sign = if folds[0].side(middle(b)) < 0.0 { -1.0 } else { 1.0 };
        Pleat {
            folds,
            zones,
            under,
            sign,
            forward,
            from: from.min(to),
            width: (middle(b) - middle(a)).norm(),
        }
    }

    /// The zone of a point.
    fn zone(&self, p: Point2) -> usize {
        self.folds.iter().take_while(|l| self.sign * l.side(p) > 0.0).count()
    }

    /// Whether a zone lies on the far side of the pleat from where the piece stays.
    fn is_beyond(&self, zone: usize) -> bool {
        zone == if self.forward { self.folds.len() } else { 0 }
    }

    /// How all of it beyond the pleat moves.
    fn beyond(&self) -> Affine2<f64> {
        self.zones[if self.forward { self.folds.len() } else { 0 }]
    }

    /// How far a point starts inside, metres.
    fn depth(&self, p: Point2) -> f64 {
        // From 0 at a line to 1 beyond it; or from 0 before a line to 1 at it.
        let past = |l: &PleatLine, over: f64| (self.sign * l.side(p) / over).clamp(0.0, 1.0);
        let before = |l: &PleatLine| (self.sign * l.side(p) / STEP + 1.0).clamp(0.0, 1.0);
        match (&self.folds[..], &self.under) {
            ([a, m], Some(under)) => DEEP * (past(a, STEP) + past(m, STEP) - 2.0 * past(under, RAMP)),
            ([a, m, n, b], _) => DEEP * (past(a, STEP) + past(m, STEP) - before(n) - before(b)),
            _ => 0.0,
        }
    }
}

/// The pieces that have pleats, folded.
///
/// Errors: a pleat whose sides are not two lines of one piece.
pub(super) fn fold(pattern: &Pattern, offsets: &Offsets) -> Result<BTreeMap<String, Folded>, StageError> {
    let mut of_piece: BTreeMap<&str, Vec<Lines>> = BTreeMap::new();
    for s in &pattern.seams {
        let SeamKind::Pleat(kind) = s.kind else { continue };
        let [[a], [b]] = [&s.sides[0][..], &s.sides[s.sides.len() - 1][..]] else { return Err(lines(s)) };
        if a.edge.panel != b.edge.panel || s.sides.len() != 2 {
            return Err(lines(s));
        }
        if let (Some(from), Some(to)) = (ends(pattern, a), ends(pattern, b)) {
            of_piece.entry(a.edge.panel.as_str()).or_default().push((kind, from, to));
        }
    }
    let known = of_piece.into_iter().filter_map(|(name, all)| Some((name, offsets.get(name)?.1, all)));
    Ok(known.map(|(name, panel, all)| (name.to_owned(), folded(panel, &all))).collect())
}

fn lines(s: &PatternSeam) -> StageError {
    StageError::invalid(format!("the pleat {} does not have two lines of one piece for its sides", s.name))
        .hint("give it the line of the fold and the line that this is laid on, each as one side of one line")
}

/// The first and last point of a line as its seam runs.
fn ends(pattern: &Pattern, u: &EdgeUse) -> Option<[Point2; 2]> {
    let path = pattern.piece(&u.edge.panel)?.path(&u.edge.edge)?;
    let ends = [path.at(0.0), path.at(path.length())];
    Some(if u.reversed { [ends[1], ends[0]] } else { ends })
}

fn folded(panel: &Panel, all: &[Lines]) -> Folded {
    let across = PleatLine::between(all[0].1[0], all[0].1[1]).way;
    // At right angles to the first line, to the right.
    let across = Vector2::new(across.y.abs(), -across.x * across.y.signum());
    let mut pleats: Vec<Pleat> = all.iter().map(|(kind, a, b)| Pleat::new(*kind, *a, *b, across)).collect();
    pleats.sort_by(|a, b| a.from.total_cmp(&b.from));
    let place = |p: &Point2| {
        let (mut before, mut depth) = (Affine2::identity(), 0.0);
        let mut at = None;
        for pleat in &pleats {
            depth += pleat.depth(*p);
            let zone = pleat.zone(*p);
            if at.is_none() {
                match pleat.is_beyond(zone) {
                    true => before *= pleat.beyond(),
                    false => at = Some(before * pleat.zones[zone]),
                }
            }
        }
        (at.unwrap_or(before) * p, depth)
    };
    let (mut points, depth): (Vec<Point2>, Vec<f64>) = panel.positions.iter().map(place).unzip();
    // Its middle stays where the middle of the piece was.
    let by = middle(&panel.positions) - middle(&points);
    points.iter_mut().for_each(|p| *p += by);
    let width: f64 = pleats.iter().map(|p| p.width).sum();
    let told = format!("folded at {} pleats, {:.0} mm narrower", pleats.len(), width * 1e3);
    Folded { panel: Panel { positions: points, ..panel.clone() }, depth, told }
}

/// The middle of the box around points.
fn middle(points: &[Point2]) -> Point2 {
    let far = Point2::new(f64::INFINITY, f64::INFINITY);
    let (lo, hi) = points.iter().fold((far, -far), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    nalgebra::center(&lo, &hi)
}

impl Folded {
    /// Moves its layers behind each other, where its flat points stand in space.
    pub(super) fn deepen(&self, places: &mut [Point3]) {
        let outside = outsides(&self.panel, places);
        for ((p, n), depth) in places.iter_mut().zip(outside).zip(&self.depth) {
            *p -= n * *depth;
        }
    }
}

#[cfg(test)]
mod tests;
