//! From a pattern to what meshers and placements take: outlines and a sewing plan.
//!
//! Method: the edges of every seam are cut until they meet one to one ([`super::chain`]); each part
//! becomes a named edge of its piece's outline, and each pair of parts a seam. Parts that are sewn
//! to each other, directly or through others, share one [`Gauge`], so that meshers divide all of
//! them alike. Layers of pleats are sewn first ([`super::pleats`]). Cost: linear in the length of
//! the edges, a few milliseconds a piece. Limits: holes keep their edges unsewn; a slit is not cut,
//! which is told.

use super::super::{
    Edge, EdgeRef, Gauge, InnerKind, InnerLine, Loop, Outline, Point2, Seam, SeamKind, SewingPlan,
};
use super::chain::{ChainLink, EdgeCuts};
use super::{EdgePath, LinePurpose, LoweringError, Pattern, PatternSeam, Piece};
use crate::parallel;
use std::collections::{BTreeMap, BTreeSet};

/// Sides of a matched seam whose lengths differ by more than this share of the longer are gathered.
const EASE: f64 = 0.03;

/// An edge that turns by more than this at one point has a corner there, degrees.
const BEND: f64 = 30.0;

/// What a pattern becomes.
#[derive(Debug, Clone)]
pub struct Lowered {
    /// The outline of each piece, its edges named; in the piece's own coordinates.
    pub outlines: BTreeMap<String, Outline>,
    /// The seams, edge to edge; no placements, which are another stage's work.
    pub plan: SewingPlan,
    /// What was decided on the way, a sentence each: seams that are gathered.
    pub notes: Vec<String>,
    /// What is left out, a sentence each: slits.
    pub warnings: Vec<String>,
}

impl Pattern {
    /// Its outlines and sewing plan.
    ///
    /// Errors: a pattern that is not sound, an edge sewn to itself, chains that divide each other
    /// without end.
    pub fn lower(&self) -> Result<Lowered, LoweringError> {
        super::check::check(self).map_err(LoweringError::Unsound)?;
        match self.pleated() {
            Some(pleated) => pleated.lowered(),
            None => self.lowered(),
        }
    }

    fn lowered(&self) -> Result<Lowered, LoweringError> {
        self.seams.iter().try_for_each(not_itself)?;
        let cuts = EdgeCuts::of(self)?;
        let names: Vec<PartNames> = self.pieces.iter().map(|p| PartNames::of(p, &cuts)).collect();
        let sewn: BTreeSet<&EdgeRef> =
            self.seams.iter().flat_map(|s| s.sides.iter().flatten()).map(|u| &u.edge).collect();
        let (mut notes, mut warnings) = (Vec::new(), Vec::new());
        let drawn = parallel::map(self.pieces.len(), parallel::each, |k| {
            let p = &self.pieces[k];
            (p.name.clone(), outline(p, &names[k], &cuts, &sewn))
        });
        let mut outlines: BTreeMap<String, Outline> = drawn.into_iter().collect();
        for p in &self.pieces {
            let slits = p.lines.iter().filter(|l| l.purpose == LinePurpose::Cut);
            warnings
                .extend(slits.map(|l| format!("the slit \"{}\" of piece \"{}\" is not cut", l.name, p.name)));
        }
        let by_name: BTreeMap<&str, &PartNames> =
            self.pieces.iter().zip(&names).map(|(p, n)| (p.name.as_str(), n)).collect();
        let (mut seams, mut gathers) = (Vec::new(), Vec::new());
        for s in &self.seams {
            let kind = kind(self, s, &mut gathers);
            let first = cuts.links(&s.sides[0]);
            if s.sides.len() == 1 {
                // A band along one edge: the edge with itself, start to start.
                seams.extend(first.iter().map(|a| seam(a, a, kind, &by_name)));
            }
            for other in &s.sides[1..] {
                let pairs = first.iter().zip(cuts.links(other));
                seams.extend(pairs.map(|(a, b)| seam(a, &b, kind, &by_name)));
            }
        }
        share_gauges(&mut outlines, &seams);
        notes.extend(told(&gathers));
        Ok(Lowered { outlines, plan: SewingPlan { seams, placements: BTreeMap::new() }, notes, warnings })
    }
}

fn not_itself(s: &PatternSeam) -> Result<(), LoweringError> {
    let mut seen = BTreeSet::new();
    match s.sides.iter().flatten().find(|u| !seen.insert(&u.edge)) {
        Some(u) => Err(LoweringError::Itself { seam: s.name.clone(), edge: u.edge.clone() }),
        None => Ok(()),
    }
}

/// A seam whose longer side is gathered because nothing else was said of it, with both lengths,
/// metres.
struct Gather<'a> {
    seam: &'a str,
    long: f64,
    short: f64,
}

/// One sentence of all seams that are gathered.
fn told(gathers: &[Gather<'_>]) -> Option<String> {
    let ratio = |g: &Gather<'_>| g.long / g.short;
    let most = gathers.iter().reduce(|a, b| if ratio(b) > ratio(a) { b } else { a })?;
    let (seam, long, short) = (most.seam, most.long * 1e3, most.short * 1e3);
    let what = match gathers.len() {
        1 => format!("the seam \"{seam}\" joins {long:.1} mm to {short:.1} mm: the longer side is gathered"),
        n => format!(
            "{n} seams join sides of unlike length, of which the longer is gathered: most of all \"{seam}\", {long:.1} mm to {short:.1} mm,"
        ),
    };
    Some(format!("{what} in the ratio {:.3}", ratio(most)))
}

/// The kind of a seam: matched sides of very different lengths are gathered, which is told.
fn kind<'a>(pattern: &Pattern, s: &'a PatternSeam, gathers: &mut Vec<Gather<'a>>) -> SeamKind {
    match s.kind {
        SeamKind::Matched => {}
        SeamKind::Gathered
        | SeamKind::Dart
        | SeamKind::Pleat(_)
        | SeamKind::Elastic { .. }
        | SeamKind::Patch
        | SeamKind::Folded { .. } => return s.kind,
    }
    let lengths: Vec<f64> = s.sides.iter().map(|side| pattern.side_length(side)).collect();
    let (long, short) =
        (lengths.iter().copied().fold(0.0, f64::max), lengths.iter().copied().fold(f64::INFINITY, f64::min));
    if long - short <= EASE * long {
        return SeamKind::Matched;
    }
    gathers.push(Gather { seam: &s.name, long, short });
    SeamKind::Gathered
}

/// The names of the parts of a piece's edges and lines.
struct PartNames(BTreeMap<String, Vec<String>>);

impl PartNames {
    /// An edge in one part keeps its name; parts are numbered from 1, and no name is given twice.
    fn of(piece: &Piece, cuts: &EdgeCuts<'_>) -> Self {
        let all = piece.outer.edges.iter().map(|e| &e.name).chain(piece.lines.iter().map(|l| &l.name));
        let mut taken: BTreeSet<String> = all.clone().cloned().collect();
        let mut parts = BTreeMap::new();
        for name in all {
            let at = EdgeRef { panel: piece.name.clone(), edge: name.clone() };
            let n = cuts.at(&at).len() + 1;
            let mut named = |k: usize| {
                let mut part = format!("{name}_{}", k + 1);
                while !taken.insert(part.clone()) {
                    part.push('\'');
                }
                part
            };
            let list = if n == 1 { vec![name.clone()] } else { (0..n).map(&mut named).collect() };
            parts.insert(name.clone(), list);
        }
        PartNames(parts)
    }

    fn part(&self, edge: &str, part: usize) -> String {
        self.0.get(edge).and_then(|p| p.get(part)).map_or_else(|| edge.to_owned(), Clone::clone)
    }
}

fn seam(a: &ChainLink<'_>, b: &ChainLink<'_>, kind: SeamKind, names: &BTreeMap<&str, &PartNames>) -> Seam {
    let of = |l: &ChainLink<'_>| {
        let panel = l.edge.panel.as_str();
        let edge = names.get(panel).map_or_else(|| l.edge.edge.clone(), |n| n.part(&l.edge.edge, l.part));
        EdgeRef { panel: panel.to_owned(), edge }
    };
    // Sides run alike; a plan's seam pairs the start of one edge with the end of the other unless
    // it is reversed.
    Seam { a: of(a), b: of(b), kind, reversed: a.reversed == b.reversed }
}

/// The outline of a piece, each edge with the gauge that suits it alone.
fn outline(piece: &Piece, names: &PartNames, cuts: &EdgeCuts<'_>, sewn: &BTreeSet<&EdgeRef>) -> Outline {
    let (mut points, mut starts, mut drawn, mut corners) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (k, e) in piece.outer.edges.iter().enumerate() {
        let ends = [piece.outer.corners[k], piece.outer.corners[(k + 1) % piece.outer.corners.len()]];
        for (i, part) in parts(&piece.outer.path(k), piece, &e.name, cuts, Some(ends)).into_iter().enumerate()
        {
            starts.push((names.part(&e.name, i), points.len()));
            corners.push(points.len());
            corners.extend(bends(&part).iter().map(|k| points.len() + k));
            points.extend(&part[..part.len() - 1]);
            drawn.push(part);
        }
    }
    let n = starts.len();
    let edges = (0..n).map(|k| {
        let (name, start) = starts[k].clone();
        Edge { name, start, end: starts[(k + 1) % n].1, gauge: gauge(&drawn[k]) }
    });
    let edges = edges.collect();
    let inner = piece.lines.iter().flat_map(|l| {
        let at = EdgeRef { panel: piece.name.clone(), edge: l.name.clone() };
        let kind = match l.purpose {
            LinePurpose::Dart => Some(InnerKind::Dart),
            LinePurpose::Pleat => Some(InnerKind::Pleat),
            LinePurpose::Fold => Some(InnerKind::Fold),
            LinePurpose::Placement | LinePurpose::Cut | LinePurpose::Mark => {
                sewn.contains(&at).then_some(InnerKind::Placement)
            }
        };
        let parts = kind.map(|_| parts(&EdgePath::polyline(l.points.clone()), piece, &l.name, cuts, None));
        let line = move |(i, points): (usize, Vec<Point2>)| {
            let gauge = sewn.contains(&at).then(|| gauge(&points));
            kind.map(|kind| InnerLine { name: names.part(&l.name, i), kind, points, gauge })
        };
        parts.unwrap_or_default().into_iter().enumerate().filter_map(line).collect::<Vec<_>>()
    });
    let holes = piece.holes.iter().map(|h| {
        let (points, corners) = h.points();
        Loop { points, corners }
    });
    Outline {
        outer: Loop { points, corners },
        holes: holes.collect(),
        edges,
        inner: inner.collect(),
        frame: None,
        lies: Vec::new(),
    }
}

/// The points of each part of an edge, both ends included; the edge's own ends to the last bit.
fn parts(
    path: &EdgePath,
    piece: &Piece,
    name: &str,
    cuts: &EdgeCuts<'_>,
    ends: Option<[Point2; 2]>,
) -> Vec<Vec<Point2>> {
    let at = EdgeRef { panel: piece.name.clone(), edge: name.to_owned() };
    let stops: Vec<f64> =
        std::iter::once(0.0).chain(cuts.at(&at).iter().copied()).chain([path.length()]).collect();
    let mut parts: Vec<Vec<Point2>> = stops.windows(2).map(|w| path.between(w[0], w[1])).collect();
    if let Some([start, end]) = ends {
        let last = parts.len() - 1;
        parts[0][0] = start;
        if let Some(p) = parts[last].last_mut() {
            *p = end;
        }
    }
    parts
}

fn gauge(points: &[Point2]) -> Gauge {
    match points {
        [a, b] => Gauge::straight((b - a).norm()),
        _ => Gauge::of(points, &bends(points)),
    }
}

/// The inner points at which an edge turns sharply: corners of a polyline, not samples of a curve.
fn bends(points: &[Point2]) -> Vec<usize> {
    let sharp = |k: &usize| {
        let (u, v) = (points[*k] - points[k - 1], points[k + 1] - points[*k]);
        u.perp(&v).atan2(u.dot(&v)).abs() > BEND.to_radians()
    };
    (1..points.len().saturating_sub(1)).filter(sharp).collect()
}

/// Edges that are sewn to each other, directly or through others, take what any of them needs.
fn share_gauges(outlines: &mut BTreeMap<String, Outline>, seams: &[Seam]) {
    let all: BTreeSet<&EdgeRef> = seams.iter().flat_map(|s| [&s.a, &s.b]).collect();
    let number: BTreeMap<&EdgeRef, usize> = all.iter().enumerate().map(|(i, e)| (*e, i)).collect();
    let mut parent: Vec<usize> = (0..all.len()).collect();
    for s in seams {
        let (a, b) = (root(&mut parent, number[&s.a]), root(&mut parent, number[&s.b]));
        parent[a.max(b)] = a.min(b);
    }
    let mut shared: BTreeMap<usize, Gauge> = BTreeMap::new();
    for (e, i) in &number {
        if let Some(gauge) = gauge_of(outlines, e).map(|g| *g) {
            let all = shared.entry(root(&mut parent, *i)).or_insert(gauge);
            *all = all.shared(&gauge);
        }
    }
    for (e, i) in &number {
        if let (Some(to), Some(gauge)) = (gauge_of(outlines, e), shared.get(&root(&mut parent, *i))) {
            *to = *gauge;
        }
    }
}

fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}

fn gauge_of<'a>(outlines: &'a mut BTreeMap<String, Outline>, at: &EdgeRef) -> Option<&'a mut Gauge> {
    let outline = outlines.get_mut(&at.panel)?;
    let edge = outline.edges.iter_mut().find(|e| e.name == at.edge).map(|e| &mut e.gauge);
    edge.or_else(|| outline.inner.iter_mut().find(|l| l.name == at.edge).and_then(|l| l.gauge.as_mut()))
}
