//! Outlines, photos, masks and flat panels of the suite.

use crate::artifact::*;
use image::{GrayImage, Luma, Rgb, RgbImage};
use std::f64::consts::TAU;

/// Scale of the photos, px per metre: a vest is about 90 px wide.
pub const SCALE: f64 = 160.0;
/// Pixels between a garment and the frame of its photo.
const MARGIN: f64 = 12.0;
/// The ground, and the cloth that lies on it.
const GROUND: [u8; 3] = [52, 60, 58];
const CLOTH: [u8; 3] = [196, 178, 150];

/// A point.
pub fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// A cubic curve as a fine polyline, both ends included.
pub fn curve(a: Point2, b: Point2, c: Point2, d: Point2) -> Vec<Point2> {
    let at = |t: f64| {
        let s = 1.0 - t;
        let sum = a.coords * (s * s * s) + b.coords * (3.0 * s * s * t) + c.coords * (3.0 * s * t * t);
        Point2::from(sum + d.coords * (t * t * t))
    };
    (0..=60).map(|k| at(f64::from(k) / 60.0)).collect()
}

fn mirrored(edge: &[Point2]) -> Vec<Point2> {
    edge.iter().rev().map(|q| p(-q.x, q.y)).collect()
}

/// An outline of named edges, each of which starts where the one before it ends.
pub fn named(edges: &[(&str, Vec<Point2>)]) -> Outline {
    let (mut points, mut named, mut corners) = (Vec::new(), Vec::new(), Vec::new());
    for (name, line) in edges {
        let start = points.len();
        corners.push(start);
        points.extend_from_slice(&line[..line.len() - 1]);
        named.push(Edge { name: (*name).into(), start, end: points.len(), gauge: Gauge::of(line, &[]) });
    }
    let n = points.len();
    named.iter_mut().for_each(|e| e.end %= n);
    Outline {
        outer: Loop { points, corners },
        holes: vec![],
        edges: named,
        inner: vec![],
        frame: None,
        lies: vec![],
    }
}

/// An outline without names.
pub fn plain(points: Vec<Point2>, corners: Vec<usize>) -> Outline {
    Outline {
        outer: Loop { points, corners },
        holes: vec![],
        edges: vec![],
        inner: vec![],
        frame: None,
        lies: vec![],
    }
}

/// A sleeveless vest with named edges, 52 by 66 cm.
pub fn outline() -> Outline {
    vest(0.5)
}

/// A vest whose neck dips to that height, metres, of 0.66.
pub fn vest(neck: f64) -> Outline {
    let side = curve(p(0.25, 0.0), p(0.235, 0.15), p(0.25, 0.3), p(0.26, 0.4));
    let armhole = curve(p(0.26, 0.4), p(0.2, 0.42), p(0.17, 0.5), p(0.185, 0.62));
    let shoulder = vec![p(0.185, 0.62), p(0.095, 0.66)];
    named(&[
        ("hem", vec![p(-0.25, 0.0), p(0.25, 0.0)]),
        ("side_left", side.clone()),
        ("armhole_left", armhole.clone()),
        ("shoulder_left", shoulder.clone()),
        ("neck", curve(p(0.095, 0.66), p(0.08, neck), p(-0.08, neck), p(-0.095, 0.66))),
        ("shoulder_right", mirrored(&shoulder)),
        ("armhole_right", mirrored(&armhole)),
        ("side_right", mirrored(&side)),
    ])
}

/// A T-shirt, sleeves and all, 86 by 70 cm.
pub fn tshirt() -> Outline {
    let side = vec![p(0.25, 0.0), p(0.26, 0.45)];
    let underarm = vec![p(0.26, 0.45), p(0.36, 0.4)];
    let cuff = vec![p(0.36, 0.4), p(0.43, 0.54)];
    let shoulder = curve(p(0.43, 0.54), p(0.3, 0.65), p(0.2, 0.68), p(0.09, 0.7));
    named(&[
        ("hem", vec![p(-0.25, 0.0), p(0.25, 0.0)]),
        ("side_left", side.clone()),
        ("underarm_left", underarm.clone()),
        ("cuff_left", cuff.clone()),
        ("shoulder_left", shoulder.clone()),
        ("neck", curve(p(0.09, 0.7), p(0.07, 0.6), p(-0.07, 0.6), p(-0.09, 0.7))),
        ("shoulder_right", mirrored(&shoulder)),
        ("cuff_right", mirrored(&cuff)),
        ("underarm_right", mirrored(&underarm)),
        ("side_right", mirrored(&side)),
    ])
}

/// The outline without its edges' names, as an edge detector gives it.
pub fn unnamed(outline: &Outline) -> Outline {
    Outline { edges: vec![], ..outline.clone() }
}

/// The outline moved and scaled about the origin.
pub fn scaled(outline: &Outline, by: f64) -> Outline {
    let map =
        |l: &Loop| Loop { points: l.points.iter().map(|q| q * by).collect(), corners: l.corners.clone() };
    let mut out = Outline {
        outer: map(&outline.outer),
        holes: outline.holes.iter().map(map).collect(),
        frame: None,
        lies: vec![],
        ..outline.clone()
    };
    out.inner.iter_mut().for_each(|l| l.points.iter_mut().for_each(|q| *q *= by));
    let gauges: Vec<Gauge> = out.edges.iter().map(|e| Gauge::of(&out.edge_points(e), &[])).collect();
    out.edges.iter_mut().zip(gauges).for_each(|(e, gauge)| e.gauge = gauge);
    out
}

fn circle(radius: f64, n: usize) -> Vec<Point2> {
    let at = |k: usize| TAU * k as f64 / n as f64;
    (0..n).map(|k| p(radius * at(k).cos(), radius * at(k).sin())).collect()
}

/// A disc with a round hole, 40 cm across.
pub fn holed() -> Outline {
    let mut hole = circle(0.07, 90);
    hole.reverse();
    let holes = vec![Loop { points: hole, corners: vec![] }];
    Outline { holes, ..plain(circle(0.2, 180), vec![]) }
}

/// A five-pointed star: deep notches and sharp tips.
pub fn star() -> Outline {
    let at = |k: usize| {
        let (a, r) = (TAU * k as f64 / 10.0 + 0.1, if k.is_multiple_of(2) { 0.3 } else { 0.115 });
        p(r * a.cos(), r * a.sin())
    };
    plain((0..10).map(at).collect(), (0..10).collect())
}

/// A belt: 60 cm by 1 cm.
pub fn sliver() -> Outline {
    plain(vec![p(0.0, 0.0), p(0.6, 0.0), p(0.6, 0.01), p(0.0, 0.01)], vec![0, 1, 2, 3])
}

/// A skirt front with a dart from its waist and a fold.
pub fn darted() -> Outline {
    let waist = curve(p(0.24, 0.6), p(0.1, 0.58), p(-0.1, 0.58), p(-0.24, 0.6));
    let (a, b, tip) = (waist[20], waist[15], p(0.105, 0.45));
    let mut outline = named(&[
        ("hem", vec![p(-0.3, 0.0), p(0.3, 0.0)]),
        ("side_left", vec![p(0.3, 0.0), p(0.24, 0.6)]),
        ("waist", waist),
        ("side_right", vec![p(-0.24, 0.6), p(-0.3, 0.0)]),
    ]);
    let line = |name: &str, kind, points| InnerLine { name: name.into(), kind, points, gauge: None };
    outline.inner = vec![
        line("dart_a", InnerKind::Dart, vec![a, tip]),
        line("dart_b", InnerKind::Dart, vec![tip, b]),
        line("fold", InnerKind::Fold, vec![p(-0.1, 0.1), p(-0.08, 0.25), p(-0.09, 0.4)]),
    ];
    outline
}

/// An outline of nothing.
pub fn nothing() -> Outline {
    plain(vec![], vec![])
}

/// Where an outline lies in the photo that [`photo_of`] makes of it.
pub fn frame(outline: &Outline) -> PhotoFrame {
    let (lo, hi) = outline.bounds();
    let origin_px = p((MARGIN - lo.x * SCALE).round(), (MARGIN + hi.y * SCALE).round());
    PhotoFrame { origin_px, px_per_metre: SCALE, mirrored: false, turn: 0.0 }
}

/// The cloth's share of the pixel around a place, 0 to 1, from 4 by 4 samples.
fn cover(outline: &Outline, frame: &PhotoFrame, x: u32, y: u32) -> f64 {
    let sample = |k: u32| {
        let off = |i: u32| (f64::from(i) - 1.5) / 4.0;
        let at = frame.to_metres(p(f64::from(x) + off(k % 4), f64::from(y) + off(k / 4)));
        let inside = |l: &Loop| within(&l.points, at);
        inside(&outline.outer) && !outline.holes.iter().any(inside)
    };
    (0..16).filter(|&k| sample(k)).count() as f64 / 16.0
}

fn within(polygon: &[Point2], q: Point2) -> bool {
    let n = polygon.len();
    let crosses = |i: &usize| {
        let (a, b) = (polygon[*i], polygon[(*i + 1) % n]);
        (a.y <= q.y) != (b.y <= q.y) && q.x < a.x + (b.x - a.x) * (q.y - a.y) / (b.y - a.y)
    };
    (0..n).filter(crosses).count() % 2 == 1
}

/// Numbers from 0 to 255 that look random and are the same at every run.
fn grain(x: u32, y: u32) -> u8 {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    (h >> 16) as u8
}

/// A photo of an outline's garment with a little grain, and its mask.
pub fn photo_of(outline: &Outline) -> (Photo, Mask) {
    let frame = frame(outline);
    let (lo, hi) = outline.bounds();
    let side = |span: f64| (span * SCALE + 2.0 * MARGIN).ceil() as u32;
    let (w, h) = (side(hi.x - lo.x), side(hi.y - lo.y));
    let share: Vec<f64> = (0..w * h).map(|k| cover(outline, &frame, k % w, k / w)).collect();
    let at = |x: u32, y: u32| share[(y * w + x) as usize];
    let colour = |x, y| {
        let (s, noise) = (at(x, y), f64::from(grain(x, y) % 9) - 4.0);
        let mix = |c: usize| f64::from(GROUND[c]) * (1.0 - s) + f64::from(CLOTH[c]) * s + noise;
        Rgb([0, 1, 2].map(|c| mix(c).round() as u8))
    };
    let level = |x, y| Luma([if at(x, y) >= 0.5 { 255 } else { 0 }]);
    (photo_from(RgbImage::from_fn(w, h, colour)), mask_from(GrayImage::from_fn(w, h, level)))
}

/// A photo with the suite's scale.
pub fn photo_from(pixels: RgbImage) -> Photo {
    Photo {
        pixels: Shared::new(pixels),
        alpha: None,
        px_per_metre: Some(SCALE),
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: "suite.png".into(),
    }
}

/// A mask of these pixels.
pub fn mask_from(pixels: GrayImage) -> Mask {
    Mask { pixels: Shared::new(pixels) }
}

/// A vest on a dark ground, about 110 by 130 px.
pub fn photo() -> Photo {
    photo_of(&outline()).0
}

/// The ground of [`photo`] without the vest.
pub fn ground() -> Photo {
    let photo = photo();
    let noise = |x, y| (f64::from(grain(y, x) % 9) - 4.0) as i16;
    let colour = |x, y| Rgb(GROUND.map(|v| (i16::from(v) + noise(x, y)).clamp(0, 255) as u8));
    photo_from(RgbImage::from_fn(photo.pixels.width(), photo.pixels.height(), colour))
}

/// The mask of [`photo`].
pub fn mask() -> Mask {
    photo_of(&outline()).1
}

/// Nothing but noise.
pub fn noisy_photo(width: u32, height: u32) -> Photo {
    let level = |x: u32, y: u32| Rgb([grain(x, y), grain(y, x), grain(x ^ y, x)]);
    photo_from(RgbImage::from_fn(width, height, level))
}

/// A rectangular panel of `columns` by `rows` cells, `width` by `height` metres, its lower middle
/// at the origin.
///
/// Edges: `hem`, `side_left`, `shoulder_left`, `neck`, `shoulder_right`, `side_right`; the neck is
/// the middle third of the top. Inner vertices are a little off their places, so that a smoother
/// has something to do.
pub fn panel(columns: usize, rows: usize, width: f64, height: f64) -> Panel {
    let at = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
    let inner = |i: usize, j: usize| i > 0 && i < columns && j > 0 && j < rows;
    let place = |i: usize, j: usize| {
        let off = |k: u32| if inner(i, j) { (f64::from(grain(k, k + 7)) / 255.0 - 0.5) * 0.3 } else { 0.0 };
        let (x, y) = (i as f64 + off(at(i, j)), j as f64 + off(at(j, i) + 999));
        p(width * (x / columns as f64 - 0.5), height * y / rows as f64)
    };
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let split = |(i, j): (usize, usize)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let hem: Vec<u32> = (0..=columns).map(|i| at(i, 0)).collect();
    let left: Vec<u32> = (0..=rows).map(|j| at(columns, j)).collect();
    let top: Vec<u32> = (0..=columns).rev().map(|i| at(i, rows)).collect();
    let right: Vec<u32> = (0..=rows).rev().map(|j| at(0, j)).collect();
    let third = columns / 3;
    let edge = |name: &str, vertices: &[u32]| PanelEdge { name: name.into(), vertices: vertices.to_vec() };
    let edges = vec![
        edge("hem", &hem),
        edge("side_left", &left),
        edge("shoulder_left", &top[..=third]),
        edge("neck", &top[third..=columns - third]),
        edge("shoulder_right", &top[columns - third..]),
        edge("side_right", &right),
    ];
    let around = [&hem, &left, &top, &right];
    let positions: Vec<Point2> =
        (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j))).map(|(i, j)| place(i, j)).collect();
    let origin = p(MARGIN + width * SCALE / 2.0, MARGIN + height * SCALE);
    let frame = PhotoFrame { origin_px: origin, px_per_metre: SCALE, mirrored: false, turn: 0.0 };
    Panel {
        photo_px: positions.iter().map(|q| frame.to_px(*q)).collect(),
        triangles: cells.flat_map(split).collect(),
        boundary: around.iter().flat_map(|side| side[..side.len() - 1].to_vec()).collect(),
        holes: vec![],
        edges,
        inner: vec![],
        outline_area: width * height,
        outline_length: 2.0 * (width + height),
        positions,
    }
}

/// A ring-shaped panel: a boundary and a hole.
pub fn ring() -> Panel {
    let (around, rings) = (36, 5);
    let at = |r: usize, k: usize| (r * around + k % around) as u32;
    let place = |r: usize, k: usize| {
        let (a, radius) = (TAU * k as f64 / around as f64, 0.07 + 0.03 * r as f64);
        let off =
            if r > 0 && r + 1 < rings { (f64::from(grain(at(r, k), 3)) / 255.0 - 0.5) * 0.01 } else { 0.0 };
        p((radius + off) * a.cos(), (radius + off) * a.sin())
    };
    let cells = (0..rings - 1).flat_map(|r| (0..around).map(move |k| (r, k)));
    let split = |(r, k): (usize, usize)| {
        [[at(r, k), at(r + 1, k), at(r + 1, k + 1)], [at(r, k), at(r + 1, k + 1), at(r, k + 1)]]
    };
    Panel {
        positions: (0..rings)
            .flat_map(|r| (0..around).map(move |k| (r, k)))
            .map(|(r, k)| place(r, k))
            .collect(),
        triangles: cells.flat_map(split).collect(),
        boundary: (0..around).map(|k| at(rings - 1, k)).collect(),
        holes: vec![(0..around).rev().map(|k| at(0, k)).collect()],
        edges: vec![],
        inner: vec![],
        photo_px: vec![],
        outline_area: std::f64::consts::PI * (0.19f64.powi(2) - 0.07f64.powi(2)),
        outline_length: TAU * 0.19,
    }
}
