//! Left and right: pieces that are mirror images in space become mirror images in the plane.
//!
//! For two pieces the mirror is the plane half-way between their centres; for one piece with itself
//! it is a plane through its centre across one of its axes of inertia. Each mirrored vertex must
//! meet a vertex, one to one, within a tolerance. Then both flat pieces become the mean of the one
//! and the mirrored other, laid over each other by the best rigid motion. Cost O(n log n) a pair.

use crate::islands::SurfacePiece;
use crate::surface::PieceSurface;
use nalgebra::{Matrix3, Point2, Point3, Rotation2, Vector2, Vector3};
use std::collections::BTreeMap;

/// Two pieces that are mirror images in space; or one, with itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MirrorPair {
    /// The piece of lower number.
    pub a: usize,
    /// The other, or the same.
    pub b: usize,
    /// For each vertex of `a` the vertex of `b` that it is the image of.
    pub partner: Vec<u32>,
    /// Whether the triangles are mirror images, too: only then are their solutions.
    pub exact: bool,
}

/// All pairs, each piece in one at most; `tolerance` is a share of the diagonal of a piece's box,
/// such as 0.0001.
#[must_use]
pub fn mirror_pairs(pieces: &[SurfacePiece], tolerance: f64) -> Vec<MirrorPair> {
    let mut taken = vec![false; pieces.len()];
    let mut pairs = Vec::new();
    for a in 0..pieces.len() {
        let found = (a..pieces.len()).filter(|&b| !taken[a] && !taken[b]).find_map(|b| {
            let partner = partners(&pieces[a].surface, &pieces[b].surface, a == b, tolerance)?;
            let exact = maps_triangles(&pieces[a].surface, &pieces[b].surface, &partner);
            Some(MirrorPair { a, b, partner, exact })
        });
        if let Some(pair) = found {
            (taken[pair.a], taken[pair.b]) = (true, true);
            pairs.push(pair);
        }
    }
    pairs
}

fn partners(a: &PieceSurface, b: &PieceSurface, same: bool, tolerance: f64) -> Option<Vec<u32>> {
    if a.positions().len() != b.positions().len() || a.triangles().len() != b.triangles().len() {
        return None;
    }
    let (centre_a, centre_b) = (centre(a), centre(b));
    let middle = Point3::from((centre_a + centre_b) / 2.0);
    let size = tolerance * diagonal(a);
    let normals = if same {
        axes(a, &centre_a).to_vec()
    } else {
        (centre_b - centre_a).try_normalize(size).into_iter().collect()
    };
    normals.iter().find_map(|n| match_vertices(a, b, &middle, n, size))
}

/// Pairs the mirrored vertices of `a` with those of `b`, one to one.
fn match_vertices(
    a: &PieceSurface,
    b: &PieceSurface,
    middle: &Point3<f64>,
    n: &Vector3<f64>,
    size: f64,
) -> Option<Vec<u32>> {
    let cell = |p: &Point3<f64>| [p.x, p.y, p.z].map(|x| (x / size).floor() as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    for (v, p) in b.positions().iter().enumerate() {
        cells.entry(cell(p)).or_default().push(v as u32);
    }
    let mut taken = vec![false; b.positions().len()];
    let mut partner = Vec::with_capacity(taken.len());
    for p in a.positions() {
        let image = p - n * (2.0 * (p - middle).dot(n));
        let [x, y, z] = cell(&image);
        let around =
            (0..27).filter_map(|k| cells.get(&[x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1])).flatten();
        let distance = |v: u32| (b.positions()[v as usize] - image).norm();
        let nearest = around.copied().filter(|&v| !taken[v as usize] && distance(v) <= size);
        let v = nearest.min_by(|&u, &v| distance(u).total_cmp(&distance(v)))?;
        taken[v as usize] = true;
        partner.push(v);
    }
    Some(partner)
}

/// Whether every triangle of `a` is one of `b`.
fn maps_triangles(a: &PieceSurface, b: &PieceSurface, partner: &[u32]) -> bool {
    let sorted = |mut t: [u32; 3]| {
        t.sort_unstable();
        t
    };
    let mut images: Vec<_> = a.triangles().iter().map(|t| sorted(t.map(|v| partner[v as usize]))).collect();
    let mut others: Vec<_> = b.triangles().iter().map(|&t| sorted(t)).collect();
    images.sort_unstable();
    others.sort_unstable();
    images == others
}

fn centre(surface: &PieceSurface) -> Vector3<f64> {
    let sum = surface.positions().iter().fold(Vector3::zeros(), |s, p| s + p.coords);
    sum / surface.positions().len() as f64
}

fn diagonal(surface: &PieceSurface) -> f64 {
    let first = surface.positions()[0];
    let (low, high) = surface.positions().iter().fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
    (high - low).norm()
}

/// The axes of inertia.
fn axes(surface: &PieceSurface, centre: &Vector3<f64>) -> [Vector3<f64>; 3] {
    let spread = surface.positions().iter().fold(Matrix3::zeros(), |sum, p| {
        let d = p.coords - centre;
        sum + d * d.transpose()
    });
    let eigen = spread.symmetric_eigen();
    [0, 1, 2].map(|k| eigen.eigenvectors.column(k).into_owned())
}

/// The largest distance of a flat piece from the mirror image of its partner, laid over it.
#[must_use]
pub fn mirror_distance(pair: &MirrorPair, a: &[Point2<f64>], b: &[Point2<f64>]) -> f64 {
    let image = mirrored_partner(pair, a, b);
    a.iter().zip(&image).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max)
}

/// The partner's places in the order of `a`, mirrored and laid over `a`.
fn mirrored_partner(pair: &MirrorPair, a: &[Point2<f64>], b: &[Point2<f64>]) -> Vec<Point2<f64>> {
    let image: Vec<Point2<f64>> =
        pair.partner.iter().map(|&v| Point2::new(-b[v as usize].x, b[v as usize].y)).collect();
    let middle = |points: &[Point2<f64>]| {
        points.iter().fold(Vector2::zeros(), |s, p| s + p.coords) / points.len().max(1) as f64
    };
    let (to, from) = (middle(a), middle(&image));
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (p, q) in a.iter().zip(&image) {
        let (p, q) = (p.coords - to, q.coords - from);
        cosine += q.dot(&p);
        sine += q.perp(&p);
    }
    let turn = Rotation2::new(f64::atan2(sine, cosine));
    image.iter().map(|q| Point2::from(turn * (q.coords - from) + to)).collect()
}

/// Both places as the mean of one and the mirrored other; the first keeps its grain upright, the
/// second is its image.
pub(super) fn mean(pair: &MirrorPair, a: &[Point2<f64>], b: &[Point2<f64>]) -> [Vec<Point2<f64>>; 2] {
    let image = mirrored_partner(pair, a, b);
    let first: Vec<_> = a.iter().zip(&image).map(|(p, q)| nalgebra::center(p, q)).collect();
    let mut second = b.to_vec();
    for (p, &v) in first.iter().zip(&pair.partner) {
        second[v as usize] = Point2::new(-p.x, p.y);
    }
    [first, second]
}
