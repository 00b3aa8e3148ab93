//! Left and right pieces whose meshes differ: their outlines become mirror images.
//!
//! Two pieces are a pair if the mirrored boundary of one lies near that of the other in space,
//! about the plane half-way between their centres (one plane for the whole garment), and their flat
//! outlines lie near each other, too. The first is solved for near the mean outline; the second
//! slides along the first one's outline, then is held on it. In turn the first is held on the mean
//! of both and the second on the first, until no vertex of the one is far off the other or for a
//! few rounds. Cost O(n^2) for n boundary vertices of each pair, and three to seven solutions a
//! piece.

use super::chains::corner_vertices;
use super::laid::{LaidPair, PairSide, Pull};
use super::outline::{Correspondence, MeasuredOutline, align, fit};
use crate::error::FlattenError;
use crate::flatteners::Flattening;
use crate::islands::SurfacePieces;
use crate::newton::QuadraticTerm;
use crate::surface::PieceSurface;
use nalgebra::{Point2, Point3, Vector2, Vector3};

/// Two pieces whose outlines are mirror images, nearly before and exactly after.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlinePair {
    /// The piece of lower number.
    pub a: usize,
    /// The other piece.
    pub b: usize,
    /// The largest distance of vertices of one outline from the mirrored other, before.
    pub before: f64,
    /// The same, after.
    pub after: f64,
}

/// The mirror plane of a garment: a point and the normal.
type MirrorPlane = (Point3<f64>, Vector3<f64>);

/// How far the planes of two pairs may differ: the sine of the angle, and the distance as a share
/// of a piece's diagonal.
const SAME_PLANE: f64 = 0.1;

/// Most boundary points of a piece that are compared in space.
const MOST_POINTS: usize = 400;

/// Areas and outline lengths of a pair differ by less than this share.
const LIKE: f64 = 0.05;

/// How often the motion that lays two outlines over each other is fitted.
const FITS: usize = 4;

/// Weight that draws a vertex to a place: as stiff as a triangle, so that the piece gives way for
/// its seams.
const DRAW_WEIGHT: f64 = 1.0;

/// Weight that holds an outline: a thousand times the stiffness of a triangle; only seam lengths
/// still move it.
const HOLD_WEIGHT: f64 = 1e3;

/// The share of a corner's angle that is enough to lay outlines over each other by.
const KNOT: f64 = 0.25;

/// How often the second outline slides along the first before it is held.
const SLIDES: usize = 2;

/// How often the one is held on the other and the other on the mean of both, at most: what only one
/// of the two meshes can draw is halved each time.
const ROUNDS: usize = 6;

/// Outlines that are so near are mirror images, a share of a piece's diagonal: 0.4 mm on one of a
/// metre.
const NEAR: f64 = 4e-4;

/// Pairs of pieces that are not in `taken`; `tolerance` is a share of a piece's diagonal.
pub(super) fn outline_pairs(pieces: &SurfacePieces, taken: &[bool], tolerance: f64) -> Vec<[usize; 2]> {
    let mut candidates = Vec::new();
    for a in 0..pieces.pieces.len() {
        for b in a + 1..pieces.pieces.len() {
            let (s, t) = (&pieces.pieces[a].surface, &pieces.pieces[b].surface);
            if taken[a] || taken[b] || !alike(s, t) {
                continue;
            }
            if let Some((distance, plane)) = mirrored_distance(s, t).filter(|(d, _)| *d <= tolerance) {
                candidates.push((distance, [a, b], plane, diagonal(s)));
            }
        }
    }
    candidates.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    let Some(&(_, _, first, _)) = candidates.first() else { return Vec::new() };
    let mut taken = taken.to_vec();
    let mut pairs = Vec::new();
    for (_, [a, b], plane, size) in candidates {
        if !taken[a] && !taken[b] && same_plane(&first, &plane, size) {
            (taken[a], taken[b]) = (true, true);
            pairs.push([a, b]);
        }
    }
    pairs
}

fn alike(s: &PieceSurface, t: &PieceSurface) -> bool {
    let near = |x: f64, y: f64| (x - y).abs() <= LIKE * x.max(y);
    s.loops().len() == 1 && t.loops().len() == 1 && near(s.area(), t.area())
}

fn same_plane(first: &MirrorPlane, other: &MirrorPlane, size: f64) -> bool {
    first.1.cross(&other.1).norm() <= SAME_PLANE
        && (other.0 - first.0).dot(&first.1).abs() <= SAME_PLANE * size
}

/// The mean distance of the mirrored boundary of `s` from that of `t`, as a share of the diagonal,
/// and the plane.
fn mirrored_distance(s: &PieceSurface, t: &PieceSurface) -> Option<(f64, MirrorPlane)> {
    let (a, b) = (boundary(s), boundary(t));
    let centre = |p: &[Point3<f64>]| p.iter().fold(Vector3::zeros(), |m, p| m + p.coords) / p.len() as f64;
    let (from, to) = (centre(&a), centre(&b));
    let size = diagonal(s);
    let normal = (to - from).try_normalize(1e-6 * size)?;
    let middle = Point3::from((from + to) / 2.0);
    let nearest = |p: &Point3<f64>| {
        let image = p - normal * (2.0 * (p - middle).dot(&normal));
        b.iter().map(|q| (q - image).norm()).fold(f64::INFINITY, f64::min)
    };
    let mean = a.iter().map(nearest).sum::<f64>() / a.len() as f64;
    Some((mean / size, (middle, normal)))
}

fn boundary(s: &PieceSurface) -> Vec<Point3<f64>> {
    let outline = &s.loops()[0];
    let step = outline.len().div_ceil(MOST_POINTS);
    outline.iter().step_by(step).map(|&v| s.positions()[v as usize]).collect()
}

fn diagonal(s: &PieceSurface) -> f64 {
    let first = s.positions()[0];
    let (low, high) = s.positions().iter().fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
    (high - low).norm()
}

/// What a pair is made equal with.
pub(super) struct OutlineMirror<'a> {
    pub(super) pieces: &'a SurfacePieces,
    /// An angle (radians) that makes a corner.
    pub(super) corner: f64,
    /// Farthest that outlines may lie apart, a share of the piece's diagonal.
    pub(super) tolerance: f64,
}

impl OutlineMirror<'_> {
    /// Makes both outlines mirror images; none if the flat ones are too far apart.
    ///
    /// `solve` moves a piece near places, with a weight, whatever else it must fulfil.
    pub(super) fn equalise(
        &self,
        [a, b]: [usize; 2],
        flats: &mut [Flattening],
        solve: impl Fn(usize, &[QuadraticTerm], Pull, &mut Flattening) -> Result<(), FlattenError>,
    ) -> Result<Option<OutlinePair>, FlattenError> {
        let laid = self.lay([a, b], flats);
        let before = laid.distance();
        if before > self.reach(a) {
            return Ok(None);
        }
        let draw = |laid: &LaidPair, side: PairSide, pull: Pull, flats: &mut [Flattening]| {
            let piece = laid.pieces[side as usize];
            solve(piece, &self.drawn(laid, side, pull), pull, &mut flats[piece])
        };
        draw(&laid, PairSide::First, Pull::Slide, flats)?;
        for _ in 0..SLIDES {
            draw(&self.lay([a, b], flats), PairSide::Second, Pull::Slide, flats)?;
        }
        let mut laid = self.lay([a, b], flats);
        for round in 0..ROUNDS {
            if round > 0 {
                draw(&laid, PairSide::First, Pull::Hold, flats)?;
                laid = self.lay([a, b], flats);
            }
            draw(&laid, PairSide::Second, Pull::Hold, flats)?;
            laid = self.lay([a, b], flats);
            if laid.is_near() {
                break;
            }
        }
        if !laid.is_near() {
            draw(&laid, PairSide::Second, Pull::Fit, flats)?;
            laid = self.lay([a, b], flats);
        }
        let after = laid.distance();
        // Both turn by half of what keeps them from standing like mirror images.
        let half = laid.motion.half_turned_back();
        [a, b].into_iter().for_each(|i| flats[i].points.iter_mut().for_each(|p| *p = half * *p));
        Ok(Some(OutlinePair { a, b, before, after }))
    }

    /// Seams of the one piece with the seams of the other that are their mirror images.
    pub(super) fn seam_partners(&self, [a, b]: [usize; 2], flats: &[Flattening]) -> Vec<[usize; 2]> {
        let laid = self.lay([a, b], flats);
        let outline_b = &self.pieces.pieces[b].surface.loops()[0];
        let of_a = |v: u32| Some(flats[a].points[v as usize]);
        let of_b = |v: u32| {
            let k = outline_b.iter().position(|&u| u == v)?;
            Some(laid.b.places()[outline_b.len() - 1 - k])
        };
        let (sides_a, sides_b) = (self.chain_ends(a, of_a), self.chain_ends(b, of_b));
        let mut partners = Vec::new();
        for (i, [p, q]) in sides_a {
            let distance = |r: &[Point2<f64>; 2]| {
                let same = (p - r[0]).norm().max((q - r[1]).norm());
                same.min((p - r[1]).norm().max((q - r[0]).norm()))
            };
            let nearest = sides_b.iter().min_by(|x, y| distance(&x.1).total_cmp(&distance(&y.1)));
            partners.extend(nearest.filter(|x| distance(&x.1) <= self.reach(a)).map(|x| [i, x.0]));
        }
        partners
    }

    /// Seams of a piece with the places of the ends of its chain.
    fn chain_ends(
        &self,
        piece: usize,
        place: impl Fn(u32) -> Option<Point2<f64>>,
    ) -> Vec<(usize, [Point2<f64>; 2])> {
        let mut ends = Vec::new();
        for (i, seam) in self.pieces.seams.iter().enumerate() {
            for chain in [&seam.a, &seam.b].into_iter().filter(|c| c.piece == piece) {
                let (first, last) = (chain.vertices[0], chain.vertices[chain.vertices.len() - 1]);
                if let (Some(p), Some(q)) = (place(first), place(last)) {
                    ends.push((i, [p, q]));
                }
            }
        }
        ends
    }

    fn reach(&self, piece: usize) -> f64 {
        self.tolerance * diagonal(&self.pieces.pieces[piece].surface)
    }

    fn lay(&self, [a, b]: [usize; 2], flats: &[Flattening]) -> LaidPair {
        let outline = &self.pieces.pieces[a].surface.loops()[0];
        let first = MeasuredOutline::new(outline.iter().map(|&v| flats[a].points[v as usize]).collect());
        let reversed = self.pieces.pieces[b].surface.loops()[0].iter().rev();
        let mirror = |&v: &u32| Point2::new(-flats[b].points[v as usize].x, flats[b].points[v as usize].y);
        let second = MeasuredOutline::new(reversed.map(mirror).collect());
        let (mut motion, shift) = align(&first, &second);
        let count = self.pieces.pieces[b].surface.loops()[0].len();
        let reversed = |knots: Vec<usize>| knots.into_iter().map(|k| count - 1 - k).collect::<Vec<_>>();
        let knots = [f64::INFINITY, KNOT * self.corner]
            .map(|least| [self.ends(a, flats, least), reversed(self.ends(b, flats, least))]);
        let reach = self.reach(a);
        // Each fit of the motion improves the knots, and they the fit (Besl and McKay 1992).
        for _ in 0..FITS {
            let map = Correspondence::new(&first, &second.moved(&motion), &knots, shift, reach);
            let images: Vec<_> =
                (0..first.places().len()).map(|i| second.at(map.forward(first.arc(i)))).collect();
            motion = fit(first.places(), &images);
        }
        for _ in 0..FITS {
            motion = motion.nearer(&first, &second);
        }
        let moved = second.moved(&motion);
        let map = Correspondence::new(&first, &moved, &knots, shift, reach);
        let ends = [self.ends(a, flats, self.corner), reversed(self.ends(b, flats, self.corner))];
        let near = NEAR * diagonal(&self.pieces.pieces[a].surface);
        LaidPair { pieces: [a, b], a: first, b: moved, ends, near, motion, map }
    }

    /// Terms that draw one outline to the other: the first to the mean of both, the second onto the
    /// first.
    fn drawn(&self, laid: &LaidPair, side: PairSide, pull: Pull) -> Vec<QuadraticTerm> {
        let outline = &self.pieces.pieces[laid.pieces[side as usize]].surface.loops()[0];
        let weight = if (side, pull) == (PairSide::First, Pull::Slide) { DRAW_WEIGHT } else { HOLD_WEIGHT };
        let targets = laid.targets(side, pull);
        let places: Vec<_> = targets.iter().map(|t| t.0).collect();
        let term = |(k, &v): (usize, &u32)| {
            let slides = pull == Pull::Slide && !targets[k].1;
            match normal(&places, k).filter(|_| slides) {
                Some(normal) => QuadraticTerm::on_line(v, places[k], normal, weight),
                None => QuadraticTerm::at(v, places[k], weight),
            }
        };
        outline.iter().enumerate().map(term).collect()
    }

    /// Places in the outline of corners of at least this angle, and of seam ends.
    fn ends(&self, piece: usize, flats: &[Flattening], corner: f64) -> Vec<usize> {
        let surface = &self.pieces.pieces[piece].surface;
        let mut is_knot = corner_vertices(surface, &flats[piece].points, corner);
        for chain in self.pieces.seams.iter().flat_map(|s| [&s.a, &s.b]).filter(|c| c.piece == piece) {
            is_knot[chain.vertices[0] as usize] = true;
            is_knot[chain.vertices[chain.vertices.len() - 1] as usize] = true;
        }
        let outline = surface.loops()[0].iter().enumerate();
        outline.filter(|(_, v)| is_knot[**v as usize]).map(|(k, _)| k).collect()
    }
}

/// The normal of a closed line at one of its points; none where its neighbours coincide.
fn normal(places: &[Point2<f64>], k: usize) -> Option<Vector2<f64>> {
    let n = places.len();
    let along = places[(k + 1) % n] - places[(k + n - 1) % n];
    Vector2::new(along.y, -along.x).try_normalize(0.0)
}
