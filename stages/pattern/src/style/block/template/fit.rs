//! A form's template fitted to a whole outline by least squares.
//!
//! Method: the template is symmetric about an axis whose tilt and place are sought with it, as far
//! as the outline lets it: corners of both sides are believed to mirror each other to 2 % of the
//! size, but those of sleeves and legs, which lie as they fall. It starts from the cuts of both
//! halves ([`crate::style::block::template::segment`]), or, where they differ, from each alone.
//! Then every point of the outline is drawn to the nearest place of the template, and places of the
//! template to the outline, along the distance between them (point to line: Chen and Medioni 1992),
//! by damped Gauss-Newton steps. Far-off points count less (Geman and McClure 1985), so that a fold
//! or a rag moves no edge. Cost: some milliseconds a form. Limits: a fold along the whole of a side
//! is taken for the side.

use crate::style::block::template::bow::{Bow, SampledBow};
use crate::style::block::template::form::{EdgeForm, Form};
use crate::style::block::template::halves::Upright;
use crate::style::block::template::seen::{CornerPull, SeenCorners};
use crate::style::block::template::segment::{self, Cut, belief, cut};
use nalgebra::{DMatrix, DVector, Rotation2};
use toile_core::artifact::{EdgeRole, Point2, Vector2};

/// The heights of the hip and of the seat above the fork, as shares of the rise.
const HIP: f64 = 0.25;
/// And the former of short legs, which flare.
const HIP_OF_SHORTS: f64 = 0.5;
/// Legs are short where their inseam is shorter than this share of the outseam.
pub(crate) const SHORT: f64 = 0.3;
pub(crate) const SEAT: f64 = 0.35;
/// Spread of an outline about its template, as a share of the garment's size.
const SPREAD: f64 = 0.006;
/// Distances, in spreads, beyond which points count less and less: at first, and at last.
const FAR: [f64; 2] = [5.0, 2.0];
/// Steps.
const STEPS: usize = 30;
/// Weight of beliefs about bows beside a point of the outline.
const BELIEF: f64 = 0.3;
/// How far corners of both sides differ, as a share of the size; and bows.
const ALIKE: [f64; 2] = [0.02, 0.05];
/// Places on each edge that are drawn to the outline, and their weight.
const PLACES: usize = 8;
const PULL: f64 = 0.5;
/// Spread of corners about those that are seen, as a share of the size, and about those that a
/// person has set: these hold.
const SEEN: f64 = 0.04;
const SAID: f64 = 0.0005;
/// Squared spreads that a point adds to the score at most.
const MOST: f64 = 16.0;
/// What the sum of squares of the cut adds to the score, for each of its points; and what every
/// corner adds, since more corners fit better.
const UNUSUAL: f64 = 0.5;
const CORNER: f64 = 0.1;
/// What a half that reaches farther from the axis by the garment's size is worth.
const REACH: f64 = 3.0;
/// A fit of this score is taken from its first start.
const WELL: f64 = 1.0;
/// A step that moves every corner by less than this share of the size is the last, once far points
/// have their last weight.
const LAST: f64 = 2e-5;
/// Share of the steps in which far points come to their last weight.
const SETTLES: f64 = 0.4;
/// Step of a difference quotient.
const DIFFERENCE: f64 = 1e-6;

/// Which halves of the outline a template is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Halves {
    /// Both; sleeves and legs lie as they fall.
    Both,
    /// Both, as each other's mirror image, and judged by the half that it fits better: the other
    /// may be folded, or hidden in part.
    Better,
}

/// A fitted template.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// The edges of the half at positive u, and of the other in a mirror; each in the frame of the
    /// fitted axis.
    pub sides: [Vec<Bow>; 2],
    /// How far the axis is turned, counter-clockwise, radians, and where it stands, from the
    /// upright outline's.
    pub turn: f64,
    pub shift: f64,
    /// Distances of the outline's points from the template, by edges, metres.
    pub misses: Vec<Vec<f64>>,
    /// What the template leaves over: mean squared spreads of points and places, and how unusual it
    /// is.
    pub score: f64,
    /// The half that it is judged by; none where both count.
    pub judged: Option<usize>,
}

impl Fit {
    /// A place of a side in the frame of the upright outline.
    pub(crate) fn laid(&self, p: Point2, side: usize) -> Point2 {
        let u = if side == 0 { p.x + self.shift } else { self.shift - p.x };
        Rotation2::new(self.turn) * Point2::new(u, p.y)
    }

    /// Where an edge of a side ends, in the frame of the upright outline, the second side seen in a
    /// mirror.
    pub(crate) fn corner(&self, side: usize, edge: usize) -> Point2 {
        let p = self.laid(self.sides[side][edge].b, side);
        Point2::new(if side == 0 { p.x } else { -p.x }, p.y)
    }

    /// The same template over the outline's mirror image.
    pub(crate) fn mirrored(&self) -> Fit {
        let [right, left] = self.sides.clone();
        let judged = self.judged.map(|side| 1 - side);
        Fit { sides: [left, right], turn: -self.turn, shift: -self.shift, judged, ..self.clone() }
    }

    /// With what its edges cost: how unusual they are, and how many.
    fn priced(self, unusual: f64, form: &Form) -> Fit {
        Fit { score: self.score + UNUSUAL * unusual + CORNER * form.edges.len() as f64, ..self }
    }

    /// Around the garment where its hip is widest, as it lies; of trousers not near the fork, since
    /// legs may flare. `None` for what has no hip.
    pub(crate) fn hip(&self, form: &Form) -> Option<f64> {
        let edges = || {
            form.edges
                .iter()
                .enumerate()
                .filter(|(_, e)| e.role == EdgeRole::Hip || e.role == EdgeRole::Outseam)
        };
        edges().next()?;
        let widest = |s: &Vec<Bow>| {
            let (fork, waist) = (s[0].a.y, s[s.len() - 1].b.y);
            let outer: f64 = edges().map(|(k, _)| s[k].length()).sum();
            let share = if s[0].length() < SHORT * outer { HIP_OF_SHORTS } else { HIP };
            let low = if form.has_legs() { fork + share * (waist - fork) } else { f64::NEG_INFINITY };
            let points = edges().flat_map(|(k, _)| s[k].points());
            points.filter(|p| p.y >= low).map(|p| p.x).fold(0.0, f64::max)
        };
        Some(2.0 * self.sides.iter().map(widest).sum::<f64>())
    }

    /// How far the outline strays from the sleeves or legs of each side: the mean distance of their
    /// points, metres.
    pub(crate) fn astray(&self, upright: &Upright, form: &Form) -> [f64; 2] {
        let m = TemplateModel { sides: self.sides.clone(), turn: self.turn, shift: self.shift };
        let mut sums = [(0.0, 0.0); 2];
        let sampled = m.sampled();
        for p in &upright.points {
            let (side, edge, _, off) = nearest(&m, &sampled, *p);
            if own(form.edges, edge) {
                sums[side].0 += off.norm();
                sums[side].1 += 1.0;
            }
        }
        sums.map(|(sum, count)| sum / f64::max(count, 1.0))
    }

    /// The share of the outline's points on a side that lie nearer to the template than `reach`,
    /// metres.
    pub(crate) fn near(&self, upright: &Upright, side: usize, reach: f64) -> f64 {
        let m = TemplateModel { sides: self.sides.clone(), turn: self.turn, shift: self.shift };
        let (mut near, mut all) = (0.0, 0.0);
        let sampled = m.sampled();
        let nearest = upright.points.iter().map(|p| nearest(&m, &sampled, *p));
        for off in nearest.filter(|n| n.0 == side).map(|n| n.3.norm()) {
            all += 1.0;
            near += if off < reach { 1.0 } else { 0.0 };
        }
        near / f64::max(all, 1.0)
    }

    /// Around the garment at the armpits, as it lies: where sleeves are cut in one with it, where
    /// its sides are narrowest. `None` for what hangs from the waist.
    pub(crate) fn chest(&self, form: &Form) -> Option<f64> {
        let sides = || self.sides.iter();
        if let Some(k) = form.armpit() {
            return Some(2.0 * sides().map(|s| s[k].a.x).sum::<f64>());
        }
        let k = form.at(EdgeRole::Cuff)?;
        let narrowest = |s: &Vec<Bow>| s[k - 1].points().iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
        Some(2.0 * sides().map(narrowest).sum::<f64>())
    }
}

/// The fits of a form: the best from the outline, and that from the landmarks that are seen; none
/// where its edges cannot be laid over the outline at all. Corners that are `said` lie where they
/// are said to.
pub(crate) fn fits(
    upright: &Upright,
    form: &Form,
    halves: Halves,
    corners: Option<&SeenCorners>,
    said: &[CornerPull],
) -> Vec<Fit> {
    let mut pulls = corners.map_or_else(Vec::new, |corners| corners.pulls(form));
    let is_said = |p: &CornerPull| said.iter().any(|s| (s.side, s.edge) == (p.side, p.edge) && !s.is_start);
    pulls.retain(|p| !is_said(p));
    pulls.extend(said);
    let corners = corners.filter(|_| halves == Halves::Both);
    let by_landmarks = corners.and_then(|corners| by_landmarks(upright, form, corners, &pulls));
    by_outline(upright, form, halves, &pulls).into_iter().chain(by_landmarks).collect()
}

/// The fit from the landmarks that are seen.
fn by_landmarks(upright: &Upright, form: &Form, corners: &SeenCorners, pulls: &[CornerPull]) -> Option<Fit> {
    let shift = corners.shift(form)?;
    let [one, other] = corners.edges(form, shift)?.map(|edges| Cut { edges, cost: 0.0 });
    let mut problem = Problem::new(upright, form, [&one, &other], None, pulls);
    problem.at[SHIFT] = shift;
    let fit = problem.solve();
    let unusual = |(bow, e): (&Bow, &EdgeForm)| {
        let bows = bow.bow.iter().map(|b| ((b - e.bow[0]) / e.bow[1]).powi(2)).sum::<f64>();
        belief(e, bow.a, bow.b, upright.size) + bows
    };
    let edges = fit.sides.iter().flat_map(|side| side.iter().zip(form.edges)).map(unusual).sum::<f64>();
    let missed = fit.score * 0.5 * (SPREAD / segment::SPREAD).powi(2);
    let points = upright.points.len() as f64;
    (edges < segment::NEVER).then(|| fit.priced(edges / points + missed, form))
}

/// The best fit of a form from the cuts of both halves of the outline.
fn by_outline(upright: &Upright, form: &Form, halves: Halves, pulls: &[CornerPull]) -> Option<Fit> {
    let cuts = [0, 1].map(|k| cut(&upright.halves[k], form, upright.size));
    let points = upright.halves[0].len() as f64;
    if halves == Halves::Better {
        return better(upright, form, &cuts, pulls);
    }
    let [Some(a), Some(b)] = cuts else { return None };
    let unusual = (a.cost + b.cost) / (2.0 * points);
    let mut best = Problem::new(upright, form, [&a, &b], None, pulls).solve();
    // Halves that differ: what only one of them shows is looked for from that one alone.
    if best.score > WELL || upright.unseen.contains(&true) {
        for alone in [&a, &b] {
            let other = Problem::new(upright, form, [alone, alone], None, pulls).solve();
            best = if other.score < best.score { other } else { best };
        }
    }
    Some(best.priced(unusual, form))
}

/// The best fit that is judged by one half, from the cut of that half.
fn better(upright: &Upright, form: &Form, cuts: &[Option<Cut>; 2], pulls: &[CornerPull]) -> Option<Fit> {
    let points = upright.halves[0].len() as f64;
    let solve = |(side, cut): (usize, &Option<Cut>)| {
        let cut = cut.as_ref()?;
        let mut fit = Problem::new(upright, form, [cut, cut], Some(side), pulls).solve();
        fit.sides[1 - side] = fit.sides[side].clone();
        Some(fit.priced(cut.cost / points, form))
    };
    // A half on which corners are said is the one to judge by.
    let said = [0, 1].map(|side: usize| pulls.iter().filter(|p| p.is_said && p.side == side).count());
    let most = said.into_iter().max().unwrap_or(0);
    let fits = cuts.iter().enumerate().filter(|(side, _)| said[*side] == most).filter_map(solve);
    // What is folded or tucked away makes a half narrower.
    let reach = |fit: &Fit| {
        let half = upright.halves[fit.judged.unwrap_or(0)].iter();
        half.map(|p| p.x).fold(0.0, f64::max) / upright.size
    };
    let price = |fit: &Fit| fit.score - REACH * reach(fit);
    fits.min_by(|a, b| price(a).total_cmp(&price(b)))
}

/// Where a point of the outline, or a place of the template, is drawn to.
struct FitPair {
    side: usize,
    edge: usize,
    t: f64,
    /// The point of the outline.
    point: Point2,
    /// The direction in which they are compared, of length 1.
    along: Vector2,
    weight: f64,
}

struct Problem<'a> {
    upright: &'a Upright,
    form: &'a Form,
    spread: f64,
    at: DVector<f64>,
    judged: Option<usize>,
    pulls: &'a [CornerPull],
}

/// The template of a vector of parameters.
struct TemplateModel {
    sides: [Vec<Bow>; 2],
    turn: f64,
    shift: f64,
}

impl TemplateModel {
    fn sampled(&self) -> [Vec<SampledBow>; 2] {
        [0, 1].map(|s: usize| self.sides[s].iter().copied().map(SampledBow::from).collect())
    }

    /// A point of the upright outline in the frame of the axis, seen from a side.
    fn seen(&self, p: Point2, side: usize) -> Point2 {
        let q = Rotation2::new(-self.turn) * p;
        Point2::new(if side == 0 { q.x - self.shift } else { self.shift - q.x }, q.y)
    }
}

impl<'a> Problem<'a> {
    fn new(
        upright: &'a Upright,
        form: &'a Form,
        start: [&Cut; 2],
        judged: Option<usize>,
        pulls: &'a [CornerPull],
    ) -> Self {
        let at = packed(form, [&start[0].edges, &start[1].edges]);
        Problem { upright, form, spread: SPREAD * upright.size, at, judged, pulls }
    }

    fn solve(mut self) -> Fit {
        self.begin_as_said();
        let mut damping = 1e-3;
        for step in 0..STEPS {
            let share = (step as f64 / (STEPS as f64 * SETTLES)).min(1.0);
            let far = FAR[0] + (FAR[1] - FAR[0]) * share;
            let pairs = self.pairs(&model(self.form, &self.at), far);
            let before = self.rest(&self.at, &pairs);
            let slopes = self.slopes(&pairs, &before);
            let (normal, right) = (slopes.tr_mul(&slopes), slopes.tr_mul(&before));
            let mut moved = 0.0;
            for _ in 0..6 {
                let mut damped = normal.clone();
                (0..damped.nrows()).for_each(|k| damped[(k, k)] += damping * (1e-9 + normal[(k, k)]));
                let Some(way) = damped.cholesky().map(|c| c.solve(&right)) else { break };
                let next = &self.at - &way;
                if self.rest(&next, &pairs).norm_squared() <= before.norm_squared() {
                    self.at = next;
                    moved = way.amax();
                    damping = (damping * 0.3).max(1e-9);
                    break;
                }
                damping = (damping * 10.0).min(1e3);
            }
            if share >= 1.0 && moved < LAST * self.upright.size {
                break;
            }
        }
        self.found()
    }

    /// Starts with the corners that are said where they are said to lie.
    fn begin_as_said(&mut self) {
        let last = self.form.edges.len() - 1;
        let m = model(self.form, &self.at);
        for p in self.pulls.iter().filter(|p| p.is_said) {
            let place = m.seen(p.seen, p.side);
            if p.is_start {
                self.at[2] = place.y;
            } else if p.edge < last {
                let k = AXIS + p.side * (PER_EDGE * last + 2) + p.edge * PER_EDGE + 2;
                (self.at[k], self.at[k + 1]) = (place.x, place.y);
            }
        }
    }

    /// What is drawn to what; far points count less.
    fn pairs(&self, m: &TemplateModel, far: f64) -> Vec<FitPair> {
        let trust = |r: f64| 1.0 / (1.0 + (r / (far * self.spread)).powi(2));
        let mut pairs = Vec::new();
        let sampled = m.sampled();
        for (p, unseen) in self.upright.points.iter().zip(&self.upright.unseen) {
            let (side, edge, t, off) = nearest(m, &sampled, *p);
            let on = &m.sides[side][edge];
            let along = unit(off, on.direction(t));
            let weight = if *unseen { 0.0 } else { trust(off.norm()) };
            pairs.push(FitPair { side, edge, t, point: *p, along, weight });
        }
        for (side, edges) in m.sides.iter().enumerate() {
            let outline: Vec<Point2> = self.upright.points.iter().map(|p| m.seen(*p, side)).collect();
            for (edge, bow) in edges.iter().enumerate() {
                for k in 0..=PLACES {
                    let t = k as f64 / PLACES as f64;
                    let place = bow.at(t);
                    let (i, share) = nearest_of(&outline, place);
                    let on = |q: &[Point2]| q[i] + (q[(i + 1) % q.len()] - q[i]) * share;
                    let off = on(&outline) - place;
                    let (point, along) = (on(&self.upright.points), unit(off, bow.direction(t)));
                    let unseen = self.unseen(i);
                    let weight = if unseen { 0.0 } else { PULL * trust(off.norm()) };
                    pairs.push(FitPair { side, edge, t, point, along, weight });
                }
            }
        }
        pairs
    }

    /// Whether a segment of the outline lies where the frame cut the garment off.
    fn unseen(&self, i: usize) -> bool {
        let all = &self.upright.unseen;
        all[i] || all[(i + 1) % all.len()]
    }

    /// What is left over of a pair, weighted.
    fn left(&self, m: &TemplateModel, p: &FitPair) -> f64 {
        let off = m.seen(p.point, p.side) - m.sides[p.side][p.edge].at(p.t);
        p.weight * off.dot(&p.along) / self.spread
    }

    /// What is left over, weighted: of each pair, then of the beliefs.
    fn rest(&self, at: &DVector<f64>, pairs: &[FitPair]) -> DVector<f64> {
        let m = model(self.form, at);
        let mut all: Vec<f64> = pairs.iter().map(|p| self.left(&m, p)).collect();
        self.believed(&m, &mut all);
        DVector::from_vec(all)
    }

    fn believed(&self, m: &TemplateModel, all: &mut Vec<f64>) {
        // What one half does not show is taken from the other, sleeves and legs too.
        let completes = self.judged.is_some() || self.upright.unseen.contains(&true);
        for (k, e) in self.form.edges.iter().enumerate() {
            let [one, other] = [0, 1].map(|s: usize| m.sides[s][k]);
            for bow in [one.bow, other.bow] {
                all.extend(bow.map(|b| BELIEF * (b - e.bow[0]) / e.bow[1]));
            }
            let corner = if e.own_end && !completes { Vector2::zeros() } else { one.b - other.b };
            let bows = if own(self.form.edges, k) && !completes {
                [0.0; 2]
            } else {
                [0, 1].map(|i| one.bow[i] - other.bow[i])
            };
            all.extend(corner.iter().map(|c| c / (ALIKE[0] * self.upright.size)));
            all.extend(bows.map(|b| b / ALIKE[1]));
        }
        for CornerPull { side, edge, is_start, seen, is_said } in self.pulls {
            let bow = &m.sides[*side][*edge];
            let off = if *is_start { bow.a } else { bow.b } - m.seen(*seen, *side);
            let spread = if *is_said { SAID } else { SEEN };
            all.extend(off.iter().map(|d| d / (spread * self.upright.size)));
        }
    }

    /// By how much `before`, what is left over, changes with each parameter.
    fn slopes(&self, pairs: &[FitPair], before: &DVector<f64>) -> DMatrix<f64> {
        let mut slopes = DMatrix::zeros(before.len(), self.at.len());
        let mut believed = Vec::new();
        for k in 0..self.at.len() {
            let mut moved = self.at.clone();
            moved[k] += DIFFERENCE;
            let m = model(self.form, &moved);
            for (i, p) in pairs.iter().enumerate().filter(|(_, p)| moves(self.form, k, p)) {
                slopes[(i, k)] = (self.left(&m, p) - before[i]) / DIFFERENCE;
            }
            believed.clear();
            self.believed(&m, &mut believed);
            for (i, rest) in (pairs.len()..).zip(&believed) {
                slopes[(i, k)] = (rest - before[i]) / DIFFERENCE;
            }
        }
        slopes
    }

    fn found(self) -> Fit {
        let m = model(self.form, &self.at);
        let mut misses = vec![Vec::new(); self.form.edges.len()];
        let mut sum = 0.0;
        let mut count = 0.0;
        let counts = |side: usize| self.judged.is_none_or(|only| only == side);
        let sampled = m.sampled();
        for (p, _) in self.upright.points.iter().zip(&self.upright.unseen).filter(|(_, unseen)| !**unseen) {
            let (side, edge, _, off) = nearest(&m, &sampled, *p);
            if counts(side) {
                misses[edge].push(off.norm());
                sum += (off.norm() / self.spread).powi(2).min(MOST);
                count += 1.0;
            }
        }
        let count = f64::max(count, 1.0);
        let places = self.pairs(&m, FAR[1]).into_iter().skip(self.upright.points.len());
        let (mut pull, mut n) = (0.0, 0.0);
        for p in places.filter(|p| p.weight > 0.0 && counts(p.side)) {
            let off = m.seen(p.point, p.side) - m.sides[p.side][p.edge].at(p.t);
            pull += (off.norm() / self.spread).powi(2).min(MOST);
            n += 1.0;
        }
        let TemplateModel { sides, turn, shift } = m;
        let score = sum / count + pull / f64::max(n, 1.0);
        Fit { sides, turn, shift, misses, score, judged: self.judged }
    }
}

/// The direction of a distance, or the left of a curve where there is none.
fn unit(off: Vector2, direction: Vector2) -> Vector2 {
    let left = Vector2::new(-direction.y, direction.x);
    off.try_normalize(1e-7).or_else(|| left.try_normalize(1e-12)).unwrap_or_else(Vector2::y)
}

/// Side, edge and parameter of the template's place nearest to a point, and the way from it to the
/// point. `sampled` are the template's edges.
fn nearest(m: &TemplateModel, sampled: &[Vec<SampledBow>; 2], p: Point2) -> (usize, usize, f64, Vector2) {
    let mut best = (0, 0, 0.0, Vector2::repeat(f64::INFINITY));
    for (side, edges) in sampled.iter().enumerate() {
        let q = m.seen(p, side);
        for (k, bow) in edges.iter().enumerate() {
            let nearer = bow.nearest(q, best.3.norm());
            if let Some((t, off)) = nearer.filter(|(_, off)| off.norm_squared() < best.3.norm_squared()) {
                best = (side, k, t, off);
            }
        }
    }
    best
}

/// The segment of a closed loop that is nearest to a point, and where on it.
fn nearest_of(points: &[Point2], p: Point2) -> (usize, f64) {
    let n = points.len();
    let mut best = (0, 0.0, f64::INFINITY);
    for i in 0..n {
        let (a, d) = (points[i], points[(i + 1) % n] - points[i]);
        let t = ((p - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let far = (a + d * t - p).norm_squared();
        if far < best.2 {
            best = (i, t, far);
        }
    }
    (best.0, best.1)
}

/// Whether an edge runs on each side by itself.
fn own(edges: &[EdgeForm], k: usize) -> bool {
    edges[k].own_end || (k > 0 && edges[k - 1].own_end)
}

/// Which parameter of a template is the place of its axis, how many there are of the axis and its
/// ends, and how many of an edge: two of its bow and two of its end.
const SHIFT: usize = 1;
const AXIS: usize = 4;
const PER_EDGE: usize = 4;

/// Parameters of a template: the axis, the heights of its ends on the axis, and corners and bows of
/// each side.
fn packed(form: &Form, sides: [&[Bow]; 2]) -> DVector<f64> {
    let last = form.edges.len() - 1;
    let mean = |a: f64, b: f64| 0.5 * (a + b);
    let low = mean(sides[0][0].a.y, sides[1][0].a.y);
    let mut at = vec![0.0, 0.0, low, mean(sides[0][last].b.y, sides[1][last].b.y)];
    for side in sides {
        for (k, bow) in side.iter().enumerate() {
            at.extend(bow.bow);
            if k < last {
                at.extend([bow.b.x, bow.b.y]);
            }
        }
    }
    DVector::from_vec(at)
}

/// Whether a parameter, by its number, moves what a pair compares.
fn moves(form: &Form, k: usize, pair: &FitPair) -> bool {
    let last = form.edges.len() - 1;
    match k.checked_sub(AXIS) {
        // The ends on the axis, of both sides.
        None => k <= SHIFT || pair.edge == if k == AXIS - 1 { last } else { 0 },
        Some(k) => {
            let (side, k) = (k / (PER_EDGE * last + 2), k % (PER_EDGE * last + 2));
            let (edge, is_bow) = (k / PER_EDGE, k % PER_EDGE < 2);
            side == pair.side && (edge == pair.edge || (!is_bow && edge + 1 == pair.edge))
        }
    }
}

fn model(form: &Form, at: &DVector<f64>) -> TemplateModel {
    let last = form.edges.len() - 1;
    let mut numbers = at.iter().skip(AXIS).copied();
    let mut two = || [0, 1].map(|_| numbers.next().unwrap_or(0.0));
    let sides = [0, 1].map(|_| {
        let mut from = Point2::new(0.0, at[2]);
        let edge = |k: usize| {
            let bow = two();
            let end = if k < last { Point2::from(two()) } else { Point2::new(0.0, at[3]) };
            Bow { a: std::mem::replace(&mut from, end), b: end, bow }
        };
        (0..=last).map(edge).collect()
    });
    TemplateModel { sides, turn: at[0], shift: at[SHIFT] }
}
