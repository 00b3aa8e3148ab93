//! A garment for tests: two curved panels around a body, with photos on a green ground.

use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::Set;
use toile_core::artifact::*;

/// The ground on which the garment lies: nothing on the cloth is as green.
pub(crate) const GROUND: [u8; 3] = [20, 220, 40];
/// Photo scale, px per metre.
pub(crate) const SCALE: f64 = 600.0;
/// Size of a panel, metres.
const SIZE: [f64; 2] = [0.48, 0.6];
/// Photo pixels to the left of and above the panel.
const BORDER: f64 = 40.5;

/// Front and back, `n` cells wide, joined at their sides, hanging in folds around [`body`].
pub(crate) fn garment(n: usize) -> Garment {
    let fabric = Arc::new(fabric());
    let (front, back) = (panel(n, 0.0), panel(n, std::f64::consts::PI));
    let count = front.0.len();
    let triangles = |first: usize| {
        let cell = move |i: usize, j: usize| {
            let at = |i: usize, j: usize| (first + j * (n + 1) + i) as u32;
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        };
        (0..n).flat_map(move |j| (0..n).flat_map(move |i| cell(i, j)))
    };
    let all: Vec<[u32; 3]> = triangles(0).chain(triangles(count)).collect();
    let part = |name: &str, k: usize| GarmentPanel {
        name: name.to_owned(),
        vertices: k * count..(k + 1) * count,
        triangles: k * all.len() / 2..(k + 1) * all.len() / 2,
        boundary: boundary(n, k * count),
        photo_px: front.1.iter().map(|p| to_px(p, k == 1)).collect(),
        fabric: fabric.clone(),
    };
    let right = |j: usize| (j * (n + 1) + n) as u32;
    let left = |j: usize| (j * (n + 1)) as u32;
    let seam = |name: &str, pairs: Vec<[u32; 2]>| GarmentSeam {
        name: name.to_owned(),
        kind: SeamKind::Matched,
        pairs,
        state: SeamState::Closed,
    };
    let shift = count as u32;
    let seams = vec![
        seam("front.side_left + back.side_left", (0..=n).map(|j| [right(j), left(j) + shift]).collect()),
        seam("front.side_right + back.side_right", (0..=n).map(|j| [left(j), right(j) + shift]).collect()),
    ];
    let mut positions = [front.0, back.0].concat();
    let mut weld: Vec<u32> = (0..2 * shift).collect();
    for [a, b] in seams.iter().flat_map(|s| &s.pairs) {
        weld[*b as usize] = *a;
        positions[*b as usize] = positions[*a as usize];
    }
    Garment {
        velocities: vec![Vector3::zeros(); positions.len()],
        rest: [front.1.clone(), front.1.clone()].concat(),
        triangles: all.clone(),
        panels: vec![part("front", 0), part("back", 1)],
        seams,
        weld,
        pinned: Vec::new(),
        status: SolveStatus {
            steps: 120,
            converged: true,
            energy: 0.4,
            max_speed: 1e-4,
            on_body: Vec::new(),
            held: Held::default(),
        },
        positions,
    }
}

/// A panel's vertices in space and in the plane.
fn panel(n: usize, turn: f64) -> (Vec<Point3>, Vec<Point2>) {
    let at = |i: usize, j: usize| {
        let (s, t) = (i as f64 / n as f64, j as f64 / n as f64);
        let angle = turn + (s - 0.5) * std::f64::consts::PI;
        let fold = 1.0 + (1.0 - t) * 0.05 * (9.0 * angle).cos() + 0.22 * (1.0 - t);
        let point = Point3::new(0.15 * fold * angle.sin(), 0.85 + SIZE[1] * t, 0.105 * fold * angle.cos());
        (point, Point2::new(SIZE[0] * s, SIZE[1] * t))
    };
    (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| at(i, j)).unzip()
}

fn boundary(n: usize, first: usize) -> Vec<u32> {
    let at = |i: usize, j: usize| (first + j * (n + 1) + i) as u32;
    let bottom = (0..n).map(|i| at(i, 0));
    let right = (0..n).map(|j| at(n, j));
    let top = (0..n).map(|i| at(n - i, n));
    let left = (0..n).map(|j| at(0, n - j));
    bottom.chain(right).chain(top).chain(left).collect()
}

/// Photo coordinates of a panel point; the back's photo is mirrored.
fn to_px(p: &Point2, mirrored: bool) -> Point2 {
    let x = if mirrored { SIZE[0] - p.x } else { p.x };
    Point2::new(BORDER + x * SCALE, BORDER + (SIZE[1] - p.y) * SCALE)
}

/// Photos of both panels: striped and dotted cloth on green ground.
pub(crate) fn photos() -> Set<Photo> {
    [("front", [196, 66, 58]), ("back", [70, 92, 170])]
        .into_iter()
        .map(|(n, c)| (n.to_owned(), photo(c)))
        .collect()
}

fn photo(colour: [u8; 3]) -> Photo {
    let [w, h] = SIZE.map(|s| s * SCALE);
    let size = [w, h].map(|s| (s + 2.0 * BORDER) as u32);
    let pixels = image::RgbImage::from_fn(size[0], size[1], |x, y| {
        let (u, v) = (f64::from(x) - BORDER, f64::from(y) - BORDER);
        let cloth = (0.0..=w).contains(&u) && (0.0..=h).contains(&v);
        let stripe = (u / 24.0).rem_euclid(2.0) < 1.0;
        let dot = ((u / 48.0).fract() - 0.5).hypot((v / 48.0).fract() - 0.5) < 0.16;
        image::Rgb(match (cloth, dot, stripe) {
            (false, ..) => GROUND,
            (_, true, _) => [240, 236, 224],
            (_, _, true) => colour,
            _ => colour.map(|c| c / 4 * 3),
        })
    });
    Photo {
        pixels: Shared::new(pixels),
        alpha: None,
        px_per_metre: Some(SCALE),
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: "photo.png".to_owned(),
    }
}

/// A tapered column with a head.
pub(crate) fn body() -> Body {
    let profile = [
        (0.0, 0.02),
        (0.02, 0.11),
        (0.5, 0.12),
        (0.9, 0.17),
        (1.05, 0.13),
        (1.3, 0.155),
        (1.44, 0.15),
        (1.47, 0.07),
        (1.54, 0.06),
        (1.6, 0.09),
        (1.68, 0.085),
        (1.74, 0.01),
    ];
    let sides = 48;
    let ring = |&(y, r): &(f64, f64)| {
        (0..sides).map(move |k| {
            let (s, c) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            let flat = if y > 1.46 { 1.0 } else { 0.68 };
            Point3::new(r * 0.85 * s, y, r * 0.85 * flat * c)
        })
    };
    let mut positions: Vec<Point3> = profile.iter().flat_map(ring).collect();
    let (bottom, top) = (positions.len() as u32, positions.len() as u32 + 1);
    positions.extend([Point3::origin(), Point3::new(0.0, 1.745, 0.0)]);
    let n = sides as u32;
    let last = (profile.len() as u32 - 1) * n;
    let mut triangles = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        for r in 0..profile.len() as u32 - 1 {
            let [a, b, c, d] = [r * n + k, r * n + next, (r + 1) * n + next, (r + 1) * n + k];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.extend([[bottom, next, k], [top, last + k, last + next]]);
    }
    let landmarks = BTreeMap::from([("neck_base_front".to_owned(), Point3::new(0.0, 1.46, 0.06))]);
    let measurements = BTreeMap::from([("height".to_owned(), 1.745)]);
    Body { positions, triangles, landmarks, measurements }
}

fn fabric() -> Fabric {
    Fabric {
        name: "test cloth".to_owned(),
        area_density: 0.15,
        warp: Curve::linear(1000.0),
        weft: Curve::linear(1000.0),
        shear: Curve::linear(100.0),
        bending_warp: 1e-6,
        bending_weft: 1e-6,
        bending_friction_warp: 0.0,
        bending_friction_weft: 0.0,
        thickness: 4e-4,
        friction: 0.3,
        damping: 1.0,
        source: "none".to_owned(),
    }
}

/// Parameters of a texturer, with cloth alike on both sides and edges without thickness: a mesh a
/// panel, and no others.
pub(crate) fn one_sheet(params: &str) -> String {
    let rest = params.strip_prefix('(').unwrap_or(params);
    format!("(edge: \"0 mm\", wrong_side: Same, {rest}")
}
