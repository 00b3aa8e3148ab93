//! The standard scenes, made by program: a square that hangs, falls or drapes on a sphere, and a
//! skirt sewn on a form.
//!
//! They are what tests and measurements use, so that neither needs files.

mod sewn;
mod worn;

pub use sewn::{banded, dart, folded, gathered, pleat, pocket, three_sheets};
pub use worn::{layered, sleeve};

use super::{Held, Panel, Phase, Scene, SceneBody, Seam};
use crate::fabric::{Curve, Fabric};
use nalgebra::{Vector2, Vector3};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// A light woven cloth, the same in every standard scene.
#[must_use]
pub fn cloth() -> Fabric {
    let shear = Curve::linear(50.0);
    Fabric { thickness: 1e-3, friction: 0.4, shear, ..Fabric::isotropic(0.15, 500.0, 0.0, 1e-5) }
}

/// A flat patch: rest coordinates in the unit square and triangles.
type FlatPatch = (Vec<Vector2<f64>>, Vec<[u32; 3]>);

/// `nx` by `ny` cells of the unit square, their diagonals alternating.
fn patch(nx: u32, ny: u32) -> FlatPatch {
    let at = |i: u32, j: u32| j * (nx + 1) + i;
    let points = (0..=ny)
        .flat_map(|j| {
            (0..=nx).map(move |i| Vector2::new(f64::from(i) / f64::from(nx), f64::from(j) / f64::from(ny)))
        })
        .collect();
    let cell = |i: u32, j: u32| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if (i + j).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    (points, (0..ny).flat_map(|j| (0..nx).flat_map(move |i| cell(i, j))).collect())
}

/// A square metre lying level at height `y`, `cells` by `cells`.
fn square(name: String, cells: u32, y: f64) -> Scene {
    let (points, triangles) = patch(cells, cells);
    let rest: Vec<Vector2<f64>> = points.iter().map(|p| p.add_scalar(-0.5)).collect();
    let positions: Vec<Vector3<f64>> = rest.iter().map(|p| Vector3::new(p.x, y, -p.y)).collect();
    let panels = vec![Panel::new("square", 0..rest.len(), 0..triangles.len())];
    Scene {
        name,
        rest,
        positions,
        triangles,
        panels,
        seams: vec![],
        bands: vec![],
        pinned: vec![],
        body: None,
        material: cloth(),
        strain_limit: None,
        phases: vec![phase("drape", 2.0, 9.81)],
        self_collision: false,
        held: Held::default(),
    }
}

fn phase(name: &str, seconds: f64, gravity: f64) -> Phase {
    Phase { name: name.into(), seconds, gravity: Vector3::new(0.0, -gravity, 0.0), air: None }
}

/// A square metre held at the two corners of its far edge.
#[must_use]
pub fn hang(cells: u32) -> Scene {
    let corners = vec![cells * (cells + 1), cells * (cells + 1) + cells];
    Scene { pinned: corners, ..square(format!("hang_{cells}"), cells, 1.0) }
}

/// A square metre below two pins of no triangle, 5 cm above its upper corners, to which these are
/// to be sewn.
#[must_use]
pub fn curtain(cells: u32) -> Scene {
    let hung = hang(cells);
    let mut scene = Scene { name: format!("curtain_{cells}"), self_collision: true, ..hung };
    scene.positions = scene.rest.iter().map(|p| Vector3::new(p.x, p.y + 0.5, 0.0)).collect();
    let n = scene.rest.len() as u32;
    let corners = std::mem::replace(&mut scene.pinned, vec![n, n + 1]);
    for &corner in &corners {
        scene.rest.push(scene.rest[corner as usize]);
        scene.positions.push(scene.positions[corner as usize] + Vector3::new(0.0, 0.05, 0.0));
    }
    scene.panels[0].vertices.end += 2;
    scene.seams.push(Seam::new("rail", vec![[corners[0], n], [corners[1], n + 1]]));
    scene
}

/// A ball of 0.3 m radius as a body, with `around` meridians.
#[must_use]
pub fn ball(around: u32) -> SceneBody {
    let (vertices, triangles) = sphere(0.3, around);
    SceneBody { vertices, triangles, friction: 0.4 }
}

/// A square metre above a sphere of 0.3 m radius.
#[must_use]
pub fn drape(cells: u32) -> Scene {
    Scene { body: Some(ball(48)), self_collision: true, ..square(format!("drape_{cells}"), cells, 0.32) }
}

/// A box from `low` to `high` as a body, two triangles per face: a table, a plate, a blade.
#[must_use]
pub fn block(low: [f64; 3], high: [f64; 3]) -> SceneBody {
    let corner = |i: usize| Vector3::from_fn(|k, _| if i >> k & 1 == 1 { high[k] } else { low[k] });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    SceneBody { vertices: (0..8).map(corner).collect(), triangles, friction: 0.4 }
}

/// A square metre above a body whose top lies at height 0, turned about the vertical, rad.
#[must_use]
pub fn cover(body: SceneBody, cells: u32, turn: f64) -> Scene {
    let (sin, cos) = turn.sin_cos();
    let mut scene =
        Scene { body: Some(body), self_collision: true, ..square(format!("cover_{cells}"), cells, 0.02) };
    scene.positions.iter_mut().for_each(|p| (p.x, p.z) = (cos * p.x + sin * p.z, cos * p.z - sin * p.x));
    scene
}

/// `layers` square sheets of half the size over each other, 4 mm apart, above the ball of
/// [`drape`].
#[must_use]
pub fn stack(layers: usize, cells: u32) -> Scene {
    let mut scene = drape(cells);
    let (rest, triangles) = (scene.rest.iter().map(|p| 0.5 * p).collect::<Vec<_>>(), scene.triangles.clone());
    let level = |k: usize| -> Vec<Vector3<f64>> {
        rest.iter().map(|p| Vector3::new(p.x, 0.31 + 0.004 * k as f64, -p.y)).collect()
    };
    (scene.rest, scene.positions) = (rest.clone(), level(0));
    for k in 1..layers {
        scene.add_panel(format!("layer {k}"), &rest, &level(k), &triangles);
    }
    scene
}

/// Two panels of `nx` by `ny` cells before and behind a form, to be sewn at their sides into a
/// skirt.
#[must_use]
pub fn tube(nx: u32, ny: u32) -> Scene {
    let (top, hem, height, waist, depth) = (0.40, 0.62, 0.55, 1.05, 0.17);
    let (points, cells) = patch(nx, ny);
    let flat: Vec<Vector2<f64>> =
        points.iter().map(|p| Vector2::new((p.x - 0.5) * (hem + (top - hem) * p.y), p.y * height)).collect();
    let n = flat.len();
    let rest = flat.iter().copied().chain(flat.iter().map(|p| p + Vector2::new(1.0, 0.0))).collect();
    let place = |p: &Vector2<f64>, side: f64| Vector3::new(side * p.x, waist - height + p.y, side * depth);
    let positions = flat.iter().map(|p| place(p, 1.0)).chain(flat.iter().map(|p| place(p, -1.0))).collect();
    let back = cells.iter().map(|t| t.map(|v| v + n as u32));
    let triangles: Vec<[u32; 3]> = cells.iter().copied().chain(back).collect();
    let (t, column) = (cells.len(), |i: u32| (0..=ny).map(move |j| j * (nx + 1) + i));
    let sew = |name: &str, front: u32, back: u32| {
        Seam::new(name, column(front).zip(column(back)).map(|(a, b)| [a, b + n as u32]).collect())
    };
    let (vertices, faces) = form(96, 84);
    Scene {
        name: format!("tube_{nx}x{ny}"),
        rest,
        positions,
        triangles,
        panels: vec![Panel::new("front", 0..n, 0..t), Panel::new("back", n..2 * n, t..2 * t)],
        seams: vec![sew("side_left", 0, nx), sew("side_right", nx, 0)],
        bands: vec![],
        pinned: vec![],
        body: Some(SceneBody { vertices, triangles: faces, friction: 0.4 }),
        material: cloth(),
        strain_limit: None,
        phases: vec![phase("sew", 0.5, 0.0), phase("drape", 1.5, 9.81)],
        self_collision: true,
        held: Held::default(),
    }
}

/// Rings of `around` vertices between two poles, closed and facing outwards.
fn lathe(
    rings: &[Vec<Vector3<f64>>],
    bottom: Vector3<f64>,
    top: Vector3<f64>,
) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let around = rings.first().map_or(0, Vec::len) as u32;
    let mut vertices: Vec<_> = rings.iter().flatten().copied().collect();
    let (low, high) = (vertices.len() as u32, vertices.len() as u32 + 1);
    vertices.extend([bottom, top]);
    let mut triangles = Vec::new();
    let last = (rings.len() as u32).saturating_sub(1) * around;
    for i in 0..around {
        let next = (i + 1) % around;
        triangles.push([low, i, next]);
        triangles.push([high, last + next, last + i]);
        for j in (0..last).step_by(around as usize) {
            triangles.push([j + i, j + around + i, j + around + next]);
            triangles.push([j + i, j + around + next, j + next]);
        }
    }
    (vertices, triangles)
}

/// A sphere about the origin with `around` meridians.
fn sphere(radius: f64, around: u32) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let rings: Vec<Vec<Vector3<f64>>> = (1..around / 2)
        .map(|k| PI * f64::from(k) / f64::from(around / 2))
        .map(|polar| ring(radius * polar.sin(), radius * polar.sin(), -radius * polar.cos(), around))
        .collect();
    lathe(&rings, Vector3::new(0.0, -radius, 0.0), Vector3::new(0.0, radius, 0.0))
}

fn ring(a: f64, b: f64, y: f64, around: u32) -> Vec<Vector3<f64>> {
    let angle = |i: u32| TAU * f64::from(i) / f64::from(around);
    (0..around).map(|i| Vector3::new(a * angle(i).cos(), y, b * angle(i).sin())).collect()
}

/// Height, half width and half depth of a dress form, m.
const PROFILE: [[f64; 3]; 9] = [
    [0.35, 0.150, 0.110],
    [0.60, 0.165, 0.120],
    [0.80, 0.178, 0.128],
    [0.88, 0.172, 0.124],
    [0.98, 0.145, 0.106],
    [1.06, 0.130, 0.096],
    [1.14, 0.137, 0.100],
    [1.28, 0.160, 0.115],
    [1.40, 0.150, 0.100],
];

/// A dress form from the knees to the shoulders.
fn form(around: u32, rings: usize) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let (low, high) = (PROFILE[0][0], PROFILE[PROFILE.len() - 1][0]);
    let heights: Vec<f64> = (0..rings).map(|k| low + (high - low) * k as f64 / (rings - 1) as f64).collect();
    let smooth = |column: usize| {
        let mut v: Vec<f64> = heights.iter().map(|&y| profile(y, column)).collect();
        for _ in 0..12 {
            let old = v.clone();
            (1..rings - 1).for_each(|k| v[k] = 0.25 * old[k - 1] + 0.5 * old[k] + 0.25 * old[k + 1]);
        }
        v
    };
    let (a, b) = (smooth(1), smooth(2));
    let rows: Vec<_> = (0..rings).map(|k| ring(a[k], b[k], heights[k], around)).collect();
    lathe(&rows, Vector3::new(0.0, low, 0.0), Vector3::new(0.0, high, 0.0))
}

fn profile(y: f64, column: usize) -> f64 {
    let k = (1..PROFILE.len() - 1).find(|&k| y <= PROFILE[k][0]).unwrap_or(PROFILE.len() - 1);
    let (a, b) = (PROFILE[k - 1], PROFILE[k]);
    a[column] + (b[column] - a[column]) * (y - a[0]) / (b[0] - a[0])
}

/// Moves every vertex that is not pinned by up to `by` metres along each axis, by a seeded
/// sequence.
pub fn jitter(scene: &mut Scene, by: f64, seed: u64) {
    let mut state: BTreeMap<u32, ()> = BTreeMap::new();
    scene.pinned.iter().for_each(|&p| {
        state.insert(p, ());
    });
    let mut random = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03;
    for (i, p) in scene.positions.iter_mut().enumerate() {
        for c in 0..3 {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            if !state.contains_key(&(i as u32)) {
                p[c] += by * ((random >> 11) as f64 / (1u64 << 52) as f64 - 1.0);
            }
        }
    }
}
